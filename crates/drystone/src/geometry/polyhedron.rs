//! Convex polyhedra: the hull of points, with the whole of each flat face in one piece.

use super::Vector3;
use faer::{Mat, Side};
use parry3d_f64::transformation::try_convex_hull;
use std::collections::BTreeMap;
use thiserror::Error;

/// A vertex this close to a face's plane, as a share of the largest extent, is on it. As in the plane
/// (`polygon.rs`): far below the contact tolerance of a compact block, far above the rounding of coordinates.
const STRAIGHT: f64 = 1e-9;

/// A polyhedron narrower than this share of its largest extent has no volume to speak of.
const FLAT: f64 = 1e-8;

/// Most points of one convex piece. Contacts cost edges times edges.
pub const MOST_POINTS: usize = 2000;

/// What is wrong with the points of a convex piece, and what to do about it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SolidFault {
    /// No pieces.
    #[error("a solid has no pieces: give at least one list of corners")]
    NoPieces,
    /// Fewer than four points.
    #[error("{count} vertices do not make a polyhedron: give at least four")]
    TooFewVertices {
        /// Vertices given.
        count: usize,
    },
    /// More points than contacts can be found for in reasonable time.
    #[error("{count} vertices in one convex piece: simplify the mesh to at most {MOST_POINTS}")]
    TooManyVertices {
        /// Vertices given.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite: give finite coordinates in metres")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// All vertices lie in a plane.
    #[error("the polyhedron has zero volume: give corners that are not all in one plane")]
    ZeroVolume,
    /// The hull of the points could not be computed.
    #[error("the convex hull of the vertices is not a closed surface ({reason}): merge vertices that nearly coincide")]
    NoHull {
        /// What went wrong.
        reason: String,
    },
    /// Two pieces of one solid occupy the same place.
    #[error(
        "pieces {first} and {second} overlap by {depth:.3e} m: their mass would count twice; give pieces that only touch"
    )]
    PiecesOverlap {
        /// Index of the first of them.
        first: usize,
        /// Index of the other.
        second: usize,
        /// The shortest way to part them, metres.
        depth: f64,
    },
}

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
        let extent = check_points(points)?;
        let corners = distinct(points, extent);
        let mut faces = flat_faces(&corners, &hull_triangles(&corners)?, extent)?;
        drop_inner_corners(&mut faces);
        faces.iter_mut().for_each(|face| start_at_least(face));
        faces.sort();
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

    /// Extent along a direction: the least and the greatest coordinate.
    pub fn span(&self, direction: Vector3) -> [f64; 2] {
        let along = self.vertices.iter().map(|v| direction.dot(*v));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }
}

/// Refuses what is no polyhedron at all; returns the largest side of the bounding box.
fn check_points(points: &[Vector3]) -> Result<f64, SolidFault> {
    if points.len() < 4 {
        return Err(SolidFault::TooFewVertices { count: points.len() });
    }
    if points.len() > MOST_POINTS {
        return Err(SolidFault::TooManyVertices { count: points.len() });
    }
    if let Some(vertex) = points.iter().position(|v| !v.is_finite()) {
        return Err(SolidFault::NotFinite { vertex });
    }
    let low = points.iter().fold(points[0], |low, v| low.min(*v));
    let high = points.iter().fold(points[0], |high, v| high.max(*v));
    Ok((high - low).max_element())
}

/// The points without those that coincide with an earlier one.
fn distinct(points: &[Vector3], extent: f64) -> Vec<Vector3> {
    let mut kept: Vec<Vector3> = Vec::with_capacity(points.len());
    for point in points {
        if kept.iter().all(|k| k.distance(*point) > STRAIGHT * extent) {
            kept.push(*point);
        }
    }
    kept
}

/// The triangles of the hull of points, by their numbers.
fn hull_triangles(points: &[Vector3]) -> Result<Vec<[usize; 3]>, SolidFault> {
    let round = rounded(points)?;
    let hull = std::panic::catch_unwind(|| try_convex_hull(&round));
    let (vertices, triangles) = match hull {
        Ok(Ok(hull)) => hull,
        Ok(Err(error)) => return Err(SolidFault::NoHull { reason: error.to_string() }),
        Err(_) => return Err(SolidFault::NoHull { reason: "the search for it failed".into() }),
    };
    // The hull's vertices are copies of the points.
    let bits = |v: &Vector3| v.to_array().map(f64::to_bits);
    let number: BTreeMap<[u64; 3], usize> = round.iter().enumerate().map(|(k, v)| (bits(v), k)).collect();
    Ok(triangles.into_iter().map(|triangle| triangle.map(|k| number[&bits(&vertices[k as usize])])).collect())
}

/// The points mapped so that they spread alike in all directions: the search for a hull takes what is a thousand times
/// wider than thick for flat, and an affine map changes no hull.
fn rounded(points: &[Vector3]) -> Result<Vec<Vector3>, SolidFault> {
    let count = points.len() as f64;
    let mean = points.iter().map(|p| *p - points[0]).sum::<Vector3>() / count + points[0];
    let near: Vec<Vector3> = points.iter().map(|p| *p - mean).collect();
    let spread = Mat::from_fn(3, 3, |i, j| near.iter().map(|v| v[i] * v[j]).sum::<f64>() / count);
    let no_hull = |_| SolidFault::NoHull { reason: "its axes were not found".into() };
    let eigen = spread.self_adjoint_eigen(Side::Lower).map_err(no_hull)?;
    let axis = |k: usize| Vector3::new(eigen.U()[(0, k)], eigen.U()[(1, k)], eigen.U()[(2, k)]);
    // Right-handed, so that triangles keep their outside.
    let axes = [axis(0), axis(1), axis(0).cross(axis(1))];
    // From the points, not from the spread: its least eigenvalue has lost what is a hundred millionth as thick as wide.
    let reach = axes.map(|axis| near.iter().map(|v| axis.dot(*v).abs()).fold(0.0, f64::max));
    let widest = reach.into_iter().fold(0.0, f64::max);
    if reach.iter().any(|&reach| reach <= FLAT * widest) {
        return Err(SolidFault::ZeroVolume);
    }
    let round = |v: &Vector3| Vector3::from_array([0, 1, 2].map(|k| axes[k].dot(*v) / reach[k]));
    Ok(near.iter().map(round).collect())
}

/// The outlines of the flat faces of a closed surface of triangles: from the largest triangle on, each takes its
/// neighbours in as long as they lie on its plane.
fn flat_faces(points: &[Vector3], triangles: &[[usize; 3]], extent: f64) -> Result<Vec<Vec<usize>>, SolidFault> {
    let square = |k: usize| {
        let [a, b, c] = triangles[k].map(|k| points[k]);
        (b - a).cross(c - a)
    };
    let sides = |k: usize| [0, 1, 2].map(|side| [triangles[k][side], triangles[k][(side + 1) % 3]]);
    let beside: BTreeMap<[usize; 2], usize> =
        (0..triangles.len()).flat_map(|k| sides(k).into_iter().map(move |side| (side, k))).collect();
    let mut largest: Vec<usize> = (0..triangles.len()).collect();
    largest.sort_by(|&i, &j| square(j).length().total_cmp(&square(i).length()).then(i.cmp(&j)));
    let mut face_of: Vec<Option<usize>> = vec![None; triangles.len()];
    let mut faces = Vec::new();
    for &first in &largest {
        if face_of[first].is_some() {
            continue;
        }
        let (normal, corner) = (square(first).normalize_or_zero(), points[triangles[first][0]]);
        let on_plane = |k: usize| normal.dot(points[k] - corner).abs() <= STRAIGHT * extent;
        let mut members = vec![first];
        face_of[first] = Some(faces.len());
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            for [a, b] in sides(member) {
                let Some(&other) = beside.get(&[b, a]) else {
                    return Err(SolidFault::NoHull { reason: "it is open".into() });
                };
                // Not round a sharp edge, of which both sides may lie on the plane of a piece that is thin there.
                let along = square(other).dot(normal) >= 0.0;
                if face_of[other].is_none() && along && triangles[other].iter().all(|&k| on_plane(k)) {
                    face_of[other] = Some(faces.len());
                    members.push(other);
                }
            }
        }
        faces.push(members);
    }
    let border = |(face, members): (usize, &Vec<usize>)| {
        let inner = |side: &[usize; 2]| face_of[beside[&[side[1], side[0]]]] == Some(face);
        outline(members.iter().flat_map(|&k| sides(k)).filter(|side| !inner(side)))
    };
    faces.iter().enumerate().map(border).collect()
}

/// Sides as one closed loop.
fn outline(sides: impl Iterator<Item = [usize; 2]>) -> Result<Vec<usize>, SolidFault> {
    let next: BTreeMap<usize, usize> = sides.map(|[a, b]| (a, b)).collect();
    let first = next.keys().next().copied().unwrap_or_default();
    let mut corners = vec![first];
    while let Some(&corner) = next.get(&corners[corners.len() - 1])
        && corner != first
        && corners.len() <= next.len()
    {
        corners.push(corner);
    }
    match corners.len() == next.len() {
        true => Ok(corners),
        false => Err(SolidFault::NoHull { reason: "a face has a hole".into() }),
    }
}

/// Drops corners of two faces only: they lie within an edge.
fn drop_inner_corners(faces: &mut [Vec<usize>]) {
    let mut count: BTreeMap<usize, usize> = BTreeMap::new();
    faces.iter().flatten().for_each(|&corner| *count.entry(corner).or_default() += 1);
    faces.iter_mut().for_each(|face| face.retain(|corner| count[corner] > 2));
}

/// Turns a loop so that it begins with its least number.
fn start_at_least(face: &mut [usize]) {
    let least = (0..face.len()).min_by_key(|&k| face[k]).unwrap_or(0);
    face.rotate_left(least);
}

/// The corners of the convex hull of numbered points in the plane, counter-clockwise; points within `tolerance` of a straight
/// line between others are no corners. Andrew's monotone chain.
pub(crate) fn convex_outline(mut points: Vec<(usize, [f64; 2])>, tolerance: f64) -> Vec<usize> {
    points.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let straight = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        let (ux, uy) = (c[0] - a[0], c[1] - a[1]);
        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        turn <= tolerance * ux.hypot(uy)
    };
    let chain = |points: &mut dyn Iterator<Item = (usize, [f64; 2])>| {
        let mut kept: Vec<(usize, [f64; 2])> = Vec::new();
        for point in points {
            while let [.., a, b] = kept[..]
                && straight(a.1, b.1, point.1)
            {
                kept.pop();
            }
            kept.push(point);
        }
        kept.pop();
        kept
    };
    if points.len() < 3 {
        return points.into_iter().map(|(k, _)| k).collect();
    }
    let lower = chain(&mut points.iter().copied());
    let upper = chain(&mut points.iter().rev().copied());
    lower.into_iter().chain(upper).map(|(k, _)| k).collect()
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
