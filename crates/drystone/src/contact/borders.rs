//! Solids that meet at borders only: a corner on a corner or an edge, an edge along an edge.

use super::{
    id::{SolidFeature, SolidPart},
    placed::{Placed, TouchPoint},
    rounding::{Local, Parting},
    separation::direction,
    touch::Border,
};
use crate::geometry::{Edge, Polyhedron, Vector3};

/// A corner of one piece near a corner or an edge of another.
struct Met {
    parts: [SolidPart; 2],
    /// On the border of either, both seen from the first body's centroid.
    on: [Vector3; 2],
}

/// Where two pieces, which part at borders only, meet within tolerance; the second body stands at `offset` from the first.
/// What there is between them is what the whole bodies are there: an edge between two pieces may be no edge of the body.
pub(super) fn at_borders(
    bodies: [&Placed; 2],
    numbers: [usize; 2],
    offset: Vector3,
    tolerance: f64,
) -> Option<Border<TouchPoint>> {
    let pieces = [0, 1].map(|side| &bodies[side].pieces[numbers[side]]);
    let ends = furthest(met(pieces, offset, tolerance), tolerance);
    let local =
        |on: [Vector3; 2]| [local_at(bodies[0], on[0], tolerance), local_at(bodies[1], on[1] - offset, tolerance)];
    let [a, b] = match &ends[..] {
        [] => return None,
        [only] => local(only.on),
        [first, .., last] => {
            let along = common_direction(pieces, offset, [first, last])?;
            local([0, 1].map(|side| first.on[side].midpoint(last.on[side]))).map(|local| local.across(along))
        }
    };
    let parting = Parting::of(&a, &b)?;
    let normal = parting.normal;
    let point = |met: &Met| TouchPoint {
        features: [0, 1].map(|side| SolidFeature { piece: numbers[side], part: met.parts[side] }),
        point: met.on[0].midpoint(met.on[1]),
        normal,
        gap: normal.dot(met.on[1] - met.on[0]),
    };
    Some(Border { points: ends.iter().map(point).collect(), parting })
}

/// Every corner of one near a corner or an edge of the other, in the order of the parts. Each of the two distances, along and
/// across, may use the whole tolerance.
fn met([a, b]: [&Polyhedron; 2], offset: Vector3, tolerance: f64) -> Vec<Met> {
    let near = 2.0 * tolerance;
    let corners = |of: &Polyhedron, at: Vector3| -> Vec<(usize, Vector3)> {
        of.vertices().iter().map(|v| *v + at).enumerate().collect()
    };
    let (of_a, of_b) = (corners(a, Vector3::ZERO), corners(b, offset));
    let mut found = Vec::new();
    let (mut used_a, mut used_b) = (vec![false; of_a.len()], vec![false; of_b.len()]);
    for (i, on_a) in &of_a {
        for (j, on_b) in of_b.iter().filter(|(_, on_b)| on_a.distance(*on_b) <= near) {
            (used_a[*i], used_b[*j]) = (true, true);
            found.push(Met { parts: [SolidPart::Corner(*i), SolidPart::Corner(*j)], on: [*on_a, *on_b] });
        }
    }
    for (i, on_a) in of_a.iter().filter(|(i, _)| !used_a[*i]) {
        let on_edge = nearest_edge(b, *on_a - offset).filter(|(_, foot)| on_a.distance(*foot + offset) <= near);
        found.extend(
            on_edge
                .map(|(edge, foot)| Met { parts: [SolidPart::Corner(*i), named(&edge)], on: [*on_a, foot + offset] }),
        );
    }
    for (j, on_b) in of_b.iter().filter(|(j, _)| !used_b[*j]) {
        let on_edge = nearest_edge(a, *on_b).filter(|(_, foot)| on_b.distance(*foot) <= near);
        found.extend(
            on_edge.map(|(edge, foot)| Met { parts: [named(&edge), SolidPart::Corner(*j)], on: [foot, *on_b] }),
        );
    }
    found.sort_by_key(|met| met.parts);
    found
}

fn named(edge: &Edge) -> SolidPart {
    let [i, j] = edge.ends;
    SolidPart::Edge([i.min(j), i.max(j)])
}

/// The edge nearest to a point, and the point of it that is. Of equal edges the first.
fn nearest_edge(of: &Polyhedron, point: Vector3) -> Option<(Edge, Vector3)> {
    let feet = of.edges().iter().map(|edge| (*edge, foot(of, edge, point)));
    feet.min_by(|(_, p), (_, q)| p.distance(point).total_cmp(&q.distance(point)))
}

/// The point of an edge nearest to another point.
fn foot(of: &Polyhedron, edge: &Edge, point: Vector3) -> Vector3 {
    let [from, to] = edge.ends.map(|k| of.vertices()[k]);
    let (along, length) = (direction(of, edge), from.distance(to));
    from + along.dot(point - from).clamp(0.0, length) * along
}

/// The two that are furthest apart, or one if all are at one place.
fn furthest(mut found: Vec<Met>, tolerance: f64) -> Vec<Met> {
    let apart = |i: usize, j: usize| found[i].on[0].distance(found[j].on[0]);
    let pairs = (0..found.len()).flat_map(|i| (i + 1..found.len()).map(move |j| [i, j]));
    let most = pairs.max_by(|&[i, j], &[k, l]| apart(i, j).total_cmp(&apart(k, l)));
    match most {
        Some([i, j]) if apart(i, j) > 2.0 * tolerance => {
            let last = found.swap_remove(j);
            vec![found.swap_remove(i), last]
        }
        _ => {
            found.truncate(1);
            found
        }
    }
}

/// The direction of the two edges that both points lie on, halfway between these.
fn common_direction(pieces: [&Polyhedron; 2], offset: Vector3, ends: [&Met; 2]) -> Option<Vector3> {
    let along = |side: usize| -> Option<Vector3> {
        let points = ends.map(|met| met.on[side] - if side == 1 { offset } else { Vector3::ZERO });
        let miss =
            |edge: &Edge| points.map(|p| foot(pieces[side], edge, p).distance(p)).into_iter().fold(0.0, f64::max);
        let edge = pieces[side].edges().iter().min_by(|d, e| miss(d).total_cmp(&miss(e)))?;
        Some(direction(pieces[side], edge))
    };
    let (of_a, of_b) = (along(0)?, along(1)?);
    (of_a + of_a.dot(of_b).signum() * of_b).try_normalize()
}

/// What a body is at a point of its border, seen from its centroid: of all pieces there, but for faces that two of them share.
fn local_at(body: &Placed, point: Vector3, tolerance: f64) -> Local {
    let mut local = Local::default();
    for piece in &body.pieces {
        piece_at(piece, point, tolerance, &mut local);
    }
    let faces = std::mem::take(&mut local.faces);
    let inner = |face: &Vector3| faces.iter().any(|other| (*face + *other).abs().max_element() <= SAME);
    local.faces = faces.iter().filter(|face| !inner(face)).copied().collect();
    local
}

/// Unit normals of two pieces' faces that lie on one another differ by less, per axis.
const SAME: f64 = 1e-6;

fn piece_at(piece: &Polyhedron, point: Vector3, tolerance: f64, local: &mut Local) {
    let height = |face: usize| piece.normals()[face].dot(point - piece.vertices()[piece.faces()[face][0]]);
    let faces = 0..piece.faces().len();
    if faces.clone().any(|face| height(face) > tolerance) {
        return;
    }
    let there: Vec<usize> = faces.filter(|&face| height(face) >= -tolerance).collect();
    local.faces.extend(there.iter().map(|&face| piece.normals()[face]));
    let meet = |edge: &&Edge| edge.faces.iter().all(|face| there.contains(face));
    for edge in piece.edges().iter().filter(meet) {
        let along = direction(piece, edge);
        let [at_start, at_end] = edge.ends.map(|k| piece.vertices()[k].distance(point) <= tolerance);
        if !at_end {
            local.into.push(along);
        }
        if !at_start {
            local.into.push(-along);
        }
        if !at_start && !at_end {
            // Within the edge: away from it on either face. The first goes round along it.
            let [first, second] = edge.faces.map(|face| piece.normals()[face].cross(along));
            local.into.extend([first, -second]);
        }
    }
    if let [face] = there[..] {
        let normal = piece.normals()[face];
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        local.into.extend([u, -u, v, -v, -normal]);
    }
}
