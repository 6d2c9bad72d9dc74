//! Contacts of solids: the whole polygon of a shared face, and edges that cross.

use super::{
    ContactSet, Feature,
    borders::at_borders,
    broad_phase::candidate_pairs,
    id::{SolidFeature, SolidPart},
    placed::{Placed, TouchPoint},
    separation::{Between, Separation, along_edges, along_faces, direction},
    shared_face::{SharedCorner, shared_corners},
    surfaces::{self, Sheets},
    touch::{Border, Meetings, Overlap, Pressing, Touch},
};
use crate::{
    error::SceneError,
    geometry::{Edge, Polyhedron, Solid, Vector3, convex_outline},
    scene::SceneOf,
};
use std::cell::OnceCell;

/// Finds all contacts between the blocks of a scene in space; see [`super::find_contacts`].
///
/// # Errors
/// [`SceneError::Overlap`].
pub fn find_solid_contacts(scene: &SceneOf<Solid>) -> Result<ContactSet, SceneError> {
    meetings(scene).contacts(scene)
}

/// Every pair of solids that overlap; see [`super::find_overlaps`].
pub fn find_solid_overlaps(scene: &SceneOf<Solid>) -> Vec<Overlap> {
    meetings(scene).overlaps
}

fn meetings(scene: &SceneOf<Solid>) -> Meetings {
    let bodies = scene.bodies();
    let placed: Vec<Placed> = bodies.iter().map(Placed::of).collect();
    let sheets: Vec<OnceCell<Sheets>> = vec![OnceCell::new(); bodies.len()];
    Meetings::of(scene, &candidate_pairs(scene), |[a, b], tolerance| {
        let origin = Vector3::from_array(bodies[a].pose.position);
        let offset = Vector3::from_array(bodies[b].pose.position) - origin;
        if [a, b].into_iter().any(|body| bodies[body].shape.surface().is_some()) {
            let [of_a, of_b] = [a, b].map(|body| sheets[body].get_or_init(|| Sheets::of(&bodies[body])));
            return surfaces::touch(of_a, of_b, offset, tolerance).map(|p| Pressing {
                feature: p.feature,
                point: (origin + p.point).to_array(),
                normal: p.normal.to_array(),
                gap: p.gap,
            });
        }
        let touch = touch_of_bodies(&placed[a], &placed[b], offset, tolerance);
        let at_borders = matches!(touch, Touch::AtBorders(_));
        let feature = |[a, b]: [SolidFeature; 2]| match at_borders {
            true => Feature::Borders { a, b },
            false => Feature::Solids { a, b },
        };
        touch.map(|p| Pressing {
            feature: feature(p.features),
            point: (origin + p.point).to_array(),
            normal: p.normal.to_array(),
            gap: p.gap,
        })
    })
}

/// The first two pieces of a solid that overlap by more than the tolerance, and by how much.
pub(crate) fn overlapping_pieces(solid: &Solid, tolerance: f64) -> Option<([usize; 2], f64)> {
    let pieces = solid.pieces();
    let pairs = (0..pieces.len()).flat_map(|a| (a + 1..pieces.len()).map(move |b| [a, b]));
    pairs.into_iter().find_map(|[a, b]| match touch([&pieces[a], &pieces[b]], [a, b], Vector3::ZERO, tolerance) {
        Touch::Overlap { depth } => Some(([a, b], depth)),
        _ => None,
    })
}

fn bounds(points: impl Iterator<Item = Vector3>) -> [Vector3; 2] {
    let nothing = [Vector3::INFINITY, Vector3::NEG_INFINITY];
    points.fold(nothing, |[low, high], v| [low.min(v), high.max(v)])
}

/// All pieces of one body against all of another.
fn touch_of_bodies(a: &Placed, b: &Placed, offset: Vector3, tolerance: f64) -> Touch<TouchPoint> {
    let met = |numbers: [usize; 2]| at_borders([a, b], numbers, offset, tolerance);
    if let ([one], [other]) = (&a.pieces[..], &b.pieces[..]) {
        return match touch([one, other], [0, 0], offset, tolerance) {
            Touch::AtBorders(_) => Touch::AtBorders(met([0, 0]).into_iter().collect()),
            touch => touch,
        };
    }
    let boxes = |placed: &Placed, by: Vector3| -> Vec<[Vector3; 2]> {
        placed.pieces.iter().map(|piece| bounds(piece.vertices().iter().map(|v| *v + by))).collect()
    };
    let (boxes_a, boxes_b) = (boxes(a, Vector3::ZERO), boxes(b, offset));
    let apart = |[low, high]: [Vector3; 2], [other_low, other_high]: [Vector3; 2]| {
        (other_low - high).max(low - other_high).max_element() > tolerance
    };
    let (mut points, mut border_pairs, mut deepest) = (Vec::new(), Vec::new(), 0.0_f64);
    for (i, piece) in a.pieces.iter().enumerate() {
        for (j, other) in b.pieces.iter().enumerate().filter(|(j, _)| !apart(boxes_a[i], boxes_b[*j])) {
            match touch([piece, other], [i, j], offset, tolerance) {
                Touch::Apart => {}
                Touch::AtBorders(_) => border_pairs.push([i, j]),
                Touch::Overlap { depth } => deepest = deepest.max(depth),
                Touch::At(found) => points.extend(found),
            }
        }
    }
    match () {
        () if deepest > 0.0 => Touch::Overlap { depth: deepest },
        () if !points.is_empty() => Touch::At(without_inner(points, tolerance)),
        () if !border_pairs.is_empty() => {
            Touch::AtBorders(without_doubles(border_pairs.into_iter().filter_map(met), tolerance))
        }
        () => Touch::Apart,
    }
}

/// Leaves out borders of which every point is one of those before: where two pieces of one body meet, both do.
fn without_doubles(met: impl Iterator<Item = Border<TouchPoint>>, tolerance: f64) -> Vec<Border<TouchPoint>> {
    let mut kept: Vec<Border<TouchPoint>> = Vec::new();
    for border in met {
        let known = || kept.iter().flat_map(|known| &known.points);
        let new = |point: &TouchPoint| known().all(|other| other.point.distance(point.point) > 2.0 * tolerance);
        if border.points.iter().any(new) {
            kept.push(border);
        }
    }
    kept
}

/// How two convex pieces touch; the second stands at `offset` from the first.
fn touch(pieces: [&Polyhedron; 2], numbers: [usize; 2], offset: Vector3, tolerance: f64) -> Touch<TouchPoint> {
    let [a, b] = pieces;
    let faces = along_faces(a, b, offset, 0.0);
    if faces.distance > tolerance {
        return Touch::Apart;
    }
    let edges = along_edges(a, b, offset);
    let greatest = edges.filter(|edges| edges.distance > faces.distance).unwrap_or(faces);
    if greatest.distance > tolerance {
        return Touch::Apart;
    }
    if greatest.distance < -tolerance {
        return Touch::Overlap { depth: -greatest.distance };
    }
    // Where a face parts them within tolerance it does so for all its points; edges that part them as well are its border.
    let points = if faces.distance >= -tolerance {
        at_face(pieces, numbers, offset, faces, tolerance)
    } else {
        at_edges(pieces, numbers, offset, greatest, tolerance).into_iter().collect()
    };
    if points.is_empty() { Touch::AtBorders(Vec::new()) } else { Touch::At(points) }
}

fn at_face(
    [a, b]: [&Polyhedron; 2],
    numbers: [usize; 2],
    offset: Vector3,
    separation: Separation,
    tolerance: f64,
) -> Vec<TouchPoint> {
    let named = |side: usize, part: SolidPart| SolidFeature { piece: numbers[side], part };
    let normal = separation.normal;
    match separation.between {
        Between::FaceOfA(face) => {
            let at = |c: SharedCorner| TouchPoint {
                features: [named(0, c.reference), named(1, c.other)],
                point: c.point + 0.5 * c.gap * normal,
                normal,
                gap: c.gap,
            };
            shared_corners(a, face, b, offset, tolerance).into_iter().map(at).collect()
        }
        Between::FaceOfB(face) => {
            let at = |c: SharedCorner| TouchPoint {
                features: [named(0, c.other), named(1, c.reference)],
                point: c.point + offset - 0.5 * c.gap * normal,
                normal,
                gap: c.gap,
            };
            shared_corners(b, face, a, -offset, tolerance).into_iter().map(at).collect()
        }
        Between::Edges(..) => Vec::new(),
    }
}

/// The point where two edges cross, if it lies within both by more than the tolerance.
pub(super) fn at_edges(
    [a, b]: [&Polyhedron; 2],
    numbers: [usize; 2],
    offset: Vector3,
    separation: Separation,
    tolerance: f64,
) -> Option<TouchPoint> {
    let Between::Edges(edge_a, edge_b) = separation.between else { return None };
    let (from_a, from_b) = (a.vertices()[edge_a.ends[0]], b.vertices()[edge_b.ends[0]] + offset);
    let (along_a, along_b) = (direction(a, &edge_a), direction(b, &edge_b));
    // Closest points of two lines.
    let (between, cosine) = (from_b - from_a, along_a.dot(along_b));
    let square = 1.0 - cosine * cosine;
    let s = (along_a.dot(between) - cosine * along_b.dot(between)) / square;
    let t = (cosine * along_a.dot(between) - along_b.dot(between)) / square;
    let length = |of: &Polyhedron, edge: &Edge| of.vertices()[edge.ends[0]].distance(of.vertices()[edge.ends[1]]);
    let within = |x: f64, length: f64| x > tolerance && x < length - tolerance;
    let inside = within(s, length(a, &edge_a)) && within(t, length(b, &edge_b));
    let named = |side: usize, [i, j]: [usize; 2]| SolidFeature {
        piece: numbers[side],
        part: SolidPart::Edge([i.min(j), i.max(j)]),
    };
    inside.then(|| TouchPoint {
        features: [named(0, edge_a.ends), named(1, edge_b.ends)],
        point: 0.5 * (from_a + s * along_a + from_b + t * along_b),
        normal: separation.normal,
        gap: separation.distance,
    })
}

/// Normals that differ by less than this, per axis, are those of one plane.
const SAME_NORMAL: f64 = 1e-9;

/// Leaves out points within the hull of others on the same plane: a force there is a sum of forces in the same directions
/// at the hull's corners, with the same resultant and the same moment, so that nothing is lost.
fn without_inner(points: Vec<TouchPoint>, tolerance: f64) -> Vec<TouchPoint> {
    let mut planes: Vec<Vec<TouchPoint>> = Vec::new();
    for point in points {
        let on = |plane: &Vec<TouchPoint>| {
            let first = plane[0];
            (first.normal - point.normal).abs().max_element() <= SAME_NORMAL
                && first.normal.dot(point.point - first.point).abs() <= tolerance
        };
        match planes.iter().position(on) {
            Some(plane) => planes[plane].push(point),
            None => planes.push(vec![point]),
        }
    }
    planes.iter().flat_map(|plane| hull_of(plane, tolerance)).collect()
}

fn hull_of(plane: &[TouchPoint], tolerance: f64) -> Vec<TouchPoint> {
    let u = plane[0].normal.any_orthonormal_vector();
    let v = plane[0].normal.cross(u);
    let mut apart: Vec<TouchPoint> = Vec::new();
    for point in plane {
        if apart.iter().all(|known| known.point.distance(point.point) > tolerance) {
            apart.push(*point);
        }
    }
    let flat = apart.iter().enumerate().map(|(k, p)| (k, [u.dot(p.point), v.dot(p.point)])).collect();
    convex_outline(flat, tolerance).into_iter().map(|k| apart[k]).collect()
}
