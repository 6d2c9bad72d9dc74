//! Rigid shapes in space: convex pieces that touch, about their common centroid.

use super::{
    PoseInSpace, Shape, Vector3,
    polyhedron::{Polyhedron, SolidFault},
};
use faer::{Mat, Side};

/// One rigid shape of convex pieces, in the frame of its centroid.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    pieces: Vec<Polyhedron>,
    volume: f64,
    /// Principal second moments for a density of one, m^5.
    moments: [f64; 3],
    /// Unit vectors of the principal axes in the body's frame.
    axes: [Vector3; 3],
    radius: f64,
    width: f64,
}

impl Solid {
    /// The cuboid with these sides, metres.
    pub fn cuboid(size: [f64; 3]) -> Self {
        Self::measured(vec![Polyhedron::cuboid(size)])
    }

    /// The convex hull of each list of points, in metres, and the centroid of all. Pieces may touch but not overlap, which
    /// [`Solid::overlap`](crate::contact) checks when the scene takes the solid.
    ///
    /// Points whose centroid is the origin (to rounding) are kept bit for bit, so that a stored solid comes back as it was.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn from_pieces(pieces: &[Vec<[f64; 3]>]) -> Result<(Self, [f64; 3]), SolidFault> {
        let hull = |points: &Vec<[f64; 3]>| {
            let points: Vec<Vector3> = points.iter().copied().map(Vector3::from_array).collect();
            Polyhedron::hull(&points)
        };
        let pieces = pieces.iter().map(hull).collect::<Result<Vec<_>, _>>()?;
        let Some(first) = pieces.first() else { return Err(SolidFault::NoPieces) };
        // The shift is found about a corner, so that it is as exact far from the world's origin as near it.
        let corner = first.vertices()[0];
        let near: Vec<Polyhedron> = pieces.iter().map(|piece| piece.shifted(-corner)).collect();
        let (volume, first_moment, _) = integrals(&near);
        if volume <= 0.0 {
            return Err(SolidFault::ZeroVolume);
        }
        let offset = first_moment / volume;
        let centroid = corner + offset;
        let extent = near.iter().flat_map(Polyhedron::vertices).fold(0.0, |most, v| v.length().max(most));
        if centroid.length() <= 1e-14 * extent {
            return Ok((Self::measured(pieces), [0.0; 3]));
        }
        let local = near.iter().map(|piece| piece.shifted(-offset)).collect();
        Ok((Self::measured(local), centroid.to_array()))
    }

    fn measured(pieces: Vec<Polyhedron>) -> Self {
        let (volume, _, second) = integrals(&pieces);
        let (moments, axes) = principal(second);
        let width = least_width(&pieces);
        let radius = pieces.iter().flat_map(Polyhedron::vertices).fold(0.0, |radius, v| v.length().max(radius));
        Self { pieces, volume, moments, axes, radius, width }
    }

    /// The convex pieces, about the centroid.
    pub fn pieces(&self) -> &[Polyhedron] {
        &self.pieces
    }

    /// Unit vectors of the principal axes in the body's frame, in the order of the moments.
    pub fn principal_axes(&self) -> [Vector3; 3] {
        self.axes
    }

    /// Every corner of every piece.
    pub fn vertices(&self) -> impl Iterator<Item = Vector3> + '_ {
        self.pieces.iter().flat_map(Polyhedron::vertices).copied()
    }
}

impl Shape for Solid {
    type Vector = [f64; 3];
    type Pose = PoseInSpace;

    fn measure(&self) -> f64 {
        self.volume
    }

    fn moments(&self) -> Vec<f64> {
        self.moments.to_vec()
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn width(&self) -> f64 {
        self.width
    }

    fn place(pose: &PoseInSpace) -> [f64; 3] {
        pose.position
    }

    fn bounds(&self, pose: &PoseInSpace) -> [[f64; 3]; 2] {
        let (place, [x, y, z]) = (Vector3::from_array(pose.position), pose.axes());
        let corners = || self.vertices().map(|v| v.x * x + v.y * y + v.z * z + place);
        let least = corners().fold(Vector3::INFINITY, Vector3::min);
        let most = corners().fold(Vector3::NEG_INFINITY, Vector3::max);
        [least.to_array(), most.to_array()]
    }
}

/// Symmetric: xx, yy, zz, xy, xz, yz.
type Symmetric = [f64; 6];

/// Volume, `int x dV` and `int x x' dV`, over the tetrahedra that the faces' triangles make with the origin.
fn integrals(pieces: &[Polyhedron]) -> (f64, Vector3, Symmetric) {
    let (mut volume, mut first, mut second) = (0.0, Vector3::ZERO, [0.0; 6]);
    for [a, b, c] in pieces.iter().flat_map(Polyhedron::triangles) {
        let part = a.dot(b.cross(c)) / 6.0;
        let sum = a + b + c;
        volume += part;
        first += 0.25 * part * sum;
        for (entry, [i, j]) in second.iter_mut().zip([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]) {
            *entry += 0.05 * part * [a, b, c, sum].iter().map(|v| v[i] * v[j]).sum::<f64>();
        }
    }
    (volume, first, second)
}

/// Products of inertia below this share of the moments are rounding: the body's own axes are principal then, and wrenches
/// along them have fewer entries.
const ALIGNED: f64 = 1e-13;

/// Principal second moments and axes.
fn principal([xx, yy, zz, xy, xz, yz]: Symmetric) -> ([f64; 3], [Vector3; 3]) {
    let diagonal = [yy + zz, xx + zz, xx + yy];
    let largest = diagonal.into_iter().fold(0.0, f64::max);
    let aligned = (diagonal, [Vector3::X, Vector3::Y, Vector3::Z]);
    if [xy, xz, yz].iter().all(|product| product.abs() <= ALIGNED * largest) {
        return aligned;
    }
    let tensor = [[diagonal[0], -xy, -xz], [-xy, diagonal[1], -yz], [-xz, -yz, diagonal[2]]];
    let tensor = Mat::from_fn(3, 3, |i, j| tensor[i][j]);
    let Ok(eigen) = tensor.self_adjoint_eigen(Side::Lower) else { return aligned };
    let axis = |k: usize| Vector3::new(eigen.U()[(0, k)], eigen.U()[(1, k)], eigen.U()[(2, k)]);
    ([0, 1, 2].map(|k| eigen.S()[k]), [axis(0), axis(1), axis(2)])
}

/// The least extent of the whole along the normal of a face.
fn least_width(pieces: &[Polyhedron]) -> f64 {
    let across = |normal: &Vector3| {
        let spans = pieces.iter().map(|piece| piece.span(*normal));
        let [low, high] = spans.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| [a.min(c), b.max(d)]);
        high - low
    };
    pieces.iter().flat_map(Polyhedron::normals).map(across).fold(f64::INFINITY, f64::min)
}
