//! Convex polyhedra: the hull of points, with the whole of each flat face in one piece.

use super::{
    Face, Vector3,
    hull::{FLAT, Outlined, STRAIGHT, outlined},
    solid_fault::SolidFault,
};
use std::collections::BTreeMap;

/// An edge between two faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its vertices, in the order in which the first face goes round.
    pub ends: [usize; 2],
    /// The faces on either side.
    pub faces: [usize; 2],
}

/// A convex polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyhedron {
    vertices: Vec<Vector3>,
    /// Vertices of each face, counter-clockwise from outside.
    faces: Vec<Vec<usize>>,
    normals: Vec<Vector3>,
    edges: Vec<Edge>,
}

impl Polyhedron {
    /// The cuboid about the origin with these sides.
    ///
    /// Vertex k has the signs of k's bits: 0 is the corner of the smallest coordinates, 1 the next along x, 2 along y, 4 along
    /// z. Sizes must be finite and positive (the scene checks them).
    pub fn cuboid(size: [f64; 3]) -> Self {
        let sign = |k: usize, axis: usize| if k >> axis & 1 == 1 { 0.5 } else { -0.5 };
        let corner = |k| Vector3::new(sign(k, 0) * size[0], sign(k, 1) * size[1], sign(k, 2) * size[2]);
        let faces = [[0, 1, 5, 4], [0, 2, 3, 1], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [4, 5, 7, 6]];
        let faces = faces.map(|face| face.to_vec()).to_vec();
        Self::of((0..8).map(corner).collect(), faces).expect("a cuboid is closed")
    }

    /// The convex hull of points, in metres. Points within the hull, within a face or within an edge are left out; the
    /// others keep their order.
    ///
    /// # Errors
    /// [`SolidFault`].
    pub fn hull(points: &[Vector3]) -> Result<Self, SolidFault> {
        let Outlined { corners, mut faces, extent } = outlined(points)?;
        let mut kept: Vec<usize> = faces.iter().flatten().copied().collect();
        kept.sort_unstable();
        kept.dedup();
        let place: BTreeMap<usize, usize> = kept.iter().enumerate().map(|(new, &old)| (old, new)).collect();
        faces.iter_mut().flatten().for_each(|vertex| *vertex = place[vertex]);
        let hull = Self::of(kept.into_iter().map(|k| corners[k]).collect(), faces)?;
        hull.holds(&corners, extent)?;
        Ok(hull)
    }

    /// Refuses a hull that leaves points outside, or is too flat to have a volume.
    fn holds(&self, points: &[Vector3], extent: f64) -> Result<(), SolidFault> {
        for (face, normal) in self.faces.iter().zip(&self.normals) {
            let offset = normal.dot(self.vertices[face[0]]);
            let [least, most] = points
                .iter()
                .map(|p| normal.dot(*p) - offset)
                .fold([0.0_f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
            if -least <= FLAT * extent {
                return Err(SolidFault::ZeroVolume);
            }
            // The plane of a face of many corners may be this far from each of them, on either side.
            if most > 4.0 * STRAIGHT * extent {
                let reason = format!("a vertex is {most:.1e} m outside");
                return Err(SolidFault::NoHull { reason });
            }
        }
        Ok(())
    }

    fn of(vertices: Vec<Vector3>, faces: Vec<Vec<usize>>) -> Result<Self, SolidFault> {
        let normals = faces.iter().map(|face| newell(face, &vertices).normalize_or_zero()).collect();
        let edges = edges(&faces)?;
        Ok(Self { vertices, faces, normals, edges })
    }

    /// Corners, metres.
    pub fn vertices(&self) -> &[Vector3] {
        &self.vertices
    }

    /// Vertices of each face, counter-clockwise from outside.
    pub fn faces(&self) -> &[Vec<usize>] {
        &self.faces
    }

    /// Outward unit normal of each face.
    pub fn normals(&self) -> &[Vector3] {
        &self.normals
    }

    /// Area of each face, square metres.
    pub fn areas(&self) -> impl Iterator<Item = f64> + '_ {
        self.faces.iter().map(|face| newell(face, &self.vertices).length() / 2.0)
    }

    /// The faces with their areas and centroids.
    pub fn surface(&self) -> impl Iterator<Item = Face<[f64; 3]>> + '_ {
        self.faces.iter().zip(&self.normals).map(|(face, normal)| {
            let first = self.vertices[face[0]];
            let (mut area, mut moment) = (0.0, Vector3::ZERO);
            for pair in face[1..].windows(2) {
                let (a, b) = (self.vertices[pair[0]] - first, self.vertices[pair[1]] - first);
                let part = 0.5 * a.cross(b).dot(*normal);
                area += part;
                moment += part / 3.0 * (a + b);
            }
            Face { normal: normal.to_array(), area, middle: (first + moment / area).to_array() }
        })
    }

    /// Every edge once.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The same, moved.
    pub fn shifted(&self, by: Vector3) -> Self {
        Self { vertices: self.vertices.iter().map(|v| *v + by).collect(), ..self.clone() }
    }

    /// The same with its vertices and normals put through a rotation.
    pub(crate) fn turned(&self, rotate: impl Fn(Vector3) -> Vector3) -> Self {
        let turned = |vectors: &[Vector3]| vectors.iter().map(|&v| rotate(v)).collect();
        Self { vertices: turned(&self.vertices), normals: turned(&self.normals), ..self.clone() }
    }

    /// The faces as triangles, three vertices each, counter-clockwise from outside.
    pub fn triangles(&self) -> impl Iterator<Item = [Vector3; 3]> + '_ {
        let fan = |face: &'_ Vec<usize>| {
            let corners: Vec<Vector3> = face.iter().map(|&k| self.vertices[k]).collect();
            (1..corners.len() - 1).map(move |k| [corners[0], corners[k], corners[k + 1]]).collect::<Vec<_>>()
        };
        self.faces.iter().flat_map(fan)
    }

    /// The corner that reaches least far along a direction; of equal ones the first.
    pub(crate) fn lowest(&self, direction: Vector3) -> usize {
        let height = |k: usize| direction.dot(self.vertices[k]);
        (1..self.vertices.len()).fold(0, |low, k| if height(k) < height(low) { k } else { low })
    }

    /// Extent along a direction: the least and the greatest coordinate.
    pub fn span(&self, direction: Vector3) -> [f64; 2] {
        let along = self.vertices.iter().map(|v| direction.dot(*v));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }
}

/// Twice the area of a flat polygon, along its normal.
fn newell(face: &[usize], vertices: &[Vector3]) -> Vector3 {
    let first = vertices[face[0]];
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).map(|(&a, &b)| (vertices[a] - first).cross(vertices[b] - first)).sum()
}

/// Every edge once. A closed surface has each of them in two faces, once either way.
fn edges(faces: &[Vec<usize>]) -> Result<Vec<Edge>, SolidFault> {
    let no_hull = |reason: &str| SolidFault::NoHull { reason: reason.to_owned() };
    if faces.iter().any(|face| face.len() < 3) {
        return Err(no_hull("a face has no area"));
    }
    let mut beside: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (index, face) in faces.iter().enumerate() {
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            if beside.insert([a, b], index).is_some() {
                return Err(no_hull("two faces run the same way along an edge"));
            }
        }
    }
    let mut edges = Vec::new();
    for (&[a, b], &face) in &beside {
        match beside.get(&[b, a]) {
            None => return Err(no_hull("an edge has one face only")),
            Some(&other) if a < b => edges.push(Edge { ends: [a, b], faces: [face, other] }),
            Some(_) => {}
        }
    }
    Ok(edges)
}
