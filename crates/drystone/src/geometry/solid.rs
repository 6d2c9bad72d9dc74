//! Rigid shapes in space: convex pieces, or a closed surface, about their centre of mass.

use super::{
    Face, PoseInSpace, Shape, Surface, Vector3, closed::check_numbers, crossing::crossing, polyhedron::Polyhedron,
    principal, solid_fault::SolidFault, surface::PLANE,
};
use crate::interrupt::poll;
use std::sync::Arc;

/// One rigid shape of convex pieces, or within one closed surface of triangles, in the frame of its centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// None of a shape that has a surface.
    pieces: Vec<Polyhedron>,
    surface: Option<Arc<Surface>>,
    centroid: Vector3,
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

    /// The convex hull of each list of points, in metres, and the centroid of all.
    ///
    /// Points whose centroid is the origin (to rounding) are kept bit for bit, so that a stored solid comes back as it was. Where
    /// pieces overlap, volume, centroid and moments count each of them in full.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn from_pieces(pieces: &[Vec<[f64; 3]>]) -> Result<(Self, [f64; 3]), SolidFault> {
        let (local, centroid) = centred(hulls(pieces)?)?;
        Ok((Self::measured(local), centroid.to_array()))
    }

    /// The same with its origin at a centre of mass, metres, which may be anywhere. About the origin the points are kept bit
    /// for bit.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn about(pieces: &[Vec<[f64; 3]>], center_of_mass: [f64; 3]) -> Result<Self, SolidFault> {
        let center = Vector3::from_array(center_of_mass);
        let mut pieces = hulls(pieces)?;
        if center != Vector3::ZERO {
            pieces = pieces.iter().map(|piece| piece.shifted(-center)).collect();
        }
        // Measured about the centroid, so that nothing is lost however far away it is.
        let (near, centroid) = centred(pieces.clone())?;
        let radius = furthest(&pieces);
        Ok(Self { pieces, centroid, radius, ..Self::measured(near) })
    }

    fn measured(pieces: Vec<Polyhedron>) -> Self {
        let Inertia { volume, moments, axes } = Inertia::of(triangles(&pieces));
        let width = least_width(&pieces);
        let radius = furthest(&pieces);
        Self { pieces, surface: None, centroid: Vector3::ZERO, volume, moments, axes, radius, width }
    }

    /// What a closed surface of triangles encloses, and its centroid; vertices in metres, triangles counter-clockwise from
    /// outside. A hollow is a shell of its own whose triangles look into it.
    ///
    /// Vertices whose centroid is the origin (to rounding) are kept bit for bit.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn from_surface(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(Self, [f64; 3]), SolidFault> {
        let (near, centroid) = centred_vertices(vertices, triangles)?;
        Ok((Self::within(surface_of(near, triangles)?), centroid.to_array()))
    }

    /// The same with its origin at a centre of mass, metres, which may be anywhere. About the origin the vertices are kept bit
    /// for bit.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn surface_about(
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        center_of_mass: [f64; 3],
    ) -> Result<Self, SolidFault> {
        let (near, _) = centred_vertices(vertices, triangles)?;
        let measured = Self::within(surface_of(near, triangles)?);
        let center = Vector3::from_array(center_of_mass);
        let about: Vec<Vector3> = vertices.iter().map(|v| Vector3::from_array(*v) - center).collect();
        let (_, centroid) = centred_vertices(&about.iter().map(|v| v.to_array()).collect::<Vec<_>>(), triangles)?;
        let radius = furthest_of(&about);
        let surface = Some(Arc::new(Surface::new(about, triangles.to_vec())?));
        Ok(Self { surface, centroid, radius, ..measured })
    }

    fn within(surface: Surface) -> Self {
        let Inertia { volume, moments, axes } = Inertia::of(triangles_of(&surface));
        let width = least_width_of(&surface, axes);
        let radius = furthest_of(surface.vertices());
        let surface = Some(Arc::new(surface));
        Self { pieces: Vec::new(), surface, centroid: Vector3::ZERO, volume, moments, axes, radius, width }
    }

    /// The surface of a shape that is not given by convex pieces.
    pub fn surface(&self) -> Option<&Arc<Surface>> {
        self.surface.as_ref()
    }

    /// The convex pieces, about the centre of mass; none of a shape that has a surface.
    pub fn pieces(&self) -> &[Polyhedron] {
        &self.pieces
    }

    /// Every corner of every piece, or of the surface.
    pub fn vertices(&self) -> impl Iterator<Item = Vector3> + '_ {
        let of_surface = self.surface.iter().flat_map(|surface| surface.vertices());
        self.pieces.iter().flat_map(Polyhedron::vertices).chain(of_surface).copied()
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

    fn axes(&self) -> [Vector3; 3] {
        self.axes
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn width(&self) -> f64 {
        self.width
    }

    fn centroid(&self) -> [f64; 3] {
        self.centroid.to_array()
    }

    fn place(pose: &PoseInSpace) -> [f64; 3] {
        pose.position
    }

    fn turned(pose: &PoseInSpace, vector: [f64; 3]) -> [f64; 3] {
        pose.rotate(Vector3::from_array(vector)).to_array()
    }

    fn seen_from(pose: &PoseInSpace, point: [f64; 3]) -> [f64; 3] {
        let from = Vector3::from_array(point) - Vector3::from_array(pose.position);
        pose.axes().map(|axis| axis.dot(from))
    }

    fn faces(&self) -> Vec<Face<[f64; 3]>> {
        let triangles = self.surface.iter().flat_map(|surface| surface.plane_parts());
        self.pieces.iter().flat_map(Polyhedron::surface).chain(triangles).collect()
    }

    fn placed(pose: PoseInSpace, position: [f64; 3]) -> PoseInSpace {
        PoseInSpace { position, ..pose }
    }

    fn bounds(&self, pose: &PoseInSpace) -> [[f64; 3]; 2] {
        let (place, [x, y, z]) = (Vector3::from_array(pose.position), pose.axes());
        let corners = || self.vertices().map(|v| v.x * x + v.y * y + v.z * z + place);
        let least = corners().fold(Vector3::INFINITY, Vector3::min);
        let most = corners().fold(Vector3::NEG_INFINITY, Vector3::max);
        [least.to_array(), most.to_array()]
    }
}

/// The convex hull of each list of points.
fn hulls(pieces: &[Vec<[f64; 3]>]) -> Result<Vec<Polyhedron>, SolidFault> {
    let hull = |points: &Vec<[f64; 3]>| {
        let points: Vec<Vector3> = points.iter().copied().map(Vector3::from_array).collect();
        Polyhedron::hull(&points)
    };
    pieces.iter().map(hull).collect()
}

/// The pieces about their common centroid, and where that was. What is there to rounding is kept bit for bit.
fn centred(pieces: Vec<Polyhedron>) -> Result<(Vec<Polyhedron>, Vector3), SolidFault> {
    let Some(first) = pieces.first() else { return Err(SolidFault::NoPieces) };
    // The shift is found about a corner, so that it is as exact far from the world's origin as near it.
    let corner = first.vertices()[0];
    let near: Vec<Polyhedron> = pieces.iter().map(|piece| piece.shifted(-corner)).collect();
    let (volume, first_moment, _) = integrals(triangles(&near));
    if volume <= 0.0 {
        return Err(SolidFault::ZeroVolume);
    }
    let offset = first_moment / volume;
    let centroid = corner + offset;
    if centroid.length() <= 1e-14 * furthest(&near) {
        return Ok((pieces, Vector3::ZERO));
    }
    Ok((near.iter().map(|piece| piece.shifted(-offset)).collect(), centroid))
}

/// The greatest distance of a corner from the origin.
fn furthest(pieces: &[Polyhedron]) -> f64 {
    pieces.iter().flat_map(Polyhedron::vertices).fold(0.0, |radius, v| v.length().max(radius))
}

/// Symmetric: xx, yy, zz, xy, xz, yz.
type Symmetric = [f64; 6];

/// Volume, and principal moments and axes for a density of one.
struct Inertia {
    volume: f64,
    moments: [f64; 3],
    axes: [Vector3; 3],
}

impl Inertia {
    /// Of what triangles enclose, about the origin.
    fn of(triangles: impl Iterator<Item = [Vector3; 3]>) -> Self {
        let (volume, _, second) = integrals(triangles);
        let [xx, yy, zz, xy, xz, yz] = second;
        let (moments, axes) = principal([[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]]);
        Self { volume, moments, axes }
    }
}

fn triangles(pieces: &[Polyhedron]) -> impl Iterator<Item = [Vector3; 3]> + '_ {
    pieces.iter().flat_map(Polyhedron::triangles)
}

fn triangles_of(surface: &Surface) -> impl Iterator<Item = [Vector3; 3]> + '_ {
    (0..surface.triangles().len() as u32).map(|k| surface.corners(k))
}

fn surface_of(vertices: Vec<Vector3>, triangles: &[[u32; 3]]) -> Result<Surface, SolidFault> {
    let surface = Surface::new(vertices, triangles.to_vec())?;
    match crossing(&surface) {
        Some(at) => Err(SolidFault::ThroughItself { at: at.to_array() }),
        None => Ok(surface),
    }
}

/// Vertices about the centroid of what their triangles enclose, and where that was. What is there to rounding is kept bit for bit.
fn centred_vertices(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(Vec<Vector3>, Vector3), SolidFault> {
    let points: Vec<Vector3> = vertices.iter().copied().map(Vector3::from_array).collect();
    check_numbers(&points, triangles)?;
    let corner = points[triangles[0][0] as usize];
    let near: Vec<Vector3> = points.iter().map(|v| *v - corner).collect();
    let each = || triangles.iter().map(|triangle| triangle.map(|k| near[k as usize]));
    let (volume, first_moment, _) = integrals(each());
    let area: f64 = each().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
    // As for meshes: what is thinner than the rounding of single precision has no volume to speak of.
    let thin = PLANE * furthest_of(&near) * area;
    if volume <= thin {
        // What is not closed is neither thin nor inside out.
        Surface::new(points, triangles.to_vec())?;
        return Err(if volume < -thin { SolidFault::InsideOut } else { SolidFault::ZeroVolume });
    }
    let offset = first_moment / volume;
    let centroid = corner + offset;
    if centroid.length() <= 1e-14 * furthest_of(&points) {
        return Ok((points, Vector3::ZERO));
    }
    Ok((near.iter().map(|v| *v - offset).collect(), centroid))
}

fn furthest_of(points: &[Vector3]) -> f64 {
    points.iter().fold(0.0, |radius, v| v.length().max(radius))
}

/// Faces whose normals are looked along for a width: a surface may have a million, the largest of them decide.
const WIDEST_FACES: usize = 64;

/// The least extent along the principal axes and the normals of the largest flat faces.
fn least_width_of(surface: &Surface, axes: [Vector3; 3]) -> f64 {
    let mut faces: Vec<(Vector3, f64)> = surface.flat_faces().collect();
    faces.sort_by(|a, b| b.1.total_cmp(&a.1));
    poll(8 * WIDEST_FACES * surface.vertices().len());
    let across = |normal: Vector3| {
        let heights = surface.vertices().iter().map(|v| normal.dot(*v));
        let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        high - low
    };
    let normals = faces.iter().take(WIDEST_FACES).map(|face| face.0).filter(|normal| *normal != Vector3::ZERO);
    axes.into_iter().chain(normals).map(across).fold(f64::INFINITY, f64::min)
}

/// Volume, `int x dV` and `int x x' dV`, over the tetrahedra that the faces' triangles make with the origin.
fn integrals(triangles: impl Iterator<Item = [Vector3; 3]>) -> (f64, Vector3, Symmetric) {
    let (mut volume, mut first, mut second) = (0.0, Vector3::ZERO, [0.0; 6]);
    for [a, b, c] in triangles {
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

/// The least extent of the whole along the normal of a face.
fn least_width(pieces: &[Polyhedron]) -> f64 {
    let across = |normal: &Vector3| {
        let spans = pieces.iter().map(|piece| piece.span(*normal));
        let [low, high] = spans.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| [a.min(c), b.max(d)]);
        high - low
    };
    pieces.iter().flat_map(Polyhedron::normals).map(across).fold(f64::INFINITY, f64::min)
}
