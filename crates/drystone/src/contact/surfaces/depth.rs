//! How deep one surface reaches into another.
//!
//! Two solids share room where a vertex of one is inside the other, where an edge of one goes through the other, or where faces
//! of both lie on one another and look the same way. From each such place a point inside both is taken; the depth there is its
//! distance from the surface that it has to get out of.

use super::{
    in_parts::in_parts,
    nearest::nearest,
    pair::{Pair, Seen},
};
use crate::{
    geometry::{Surface, Vector3},
    interrupt::poll,
};
use std::collections::BTreeSet;

/// Operations to look at a pair of triangles, about.
const LOOK: usize = 60;

/// The greatest depth found that is more than the tolerance, metres.
pub(super) fn depth(pair: &Pair, candidates: &[[u32; 2]]) -> Option<f64> {
    let mut deepest = 0.0_f64;
    for side in [0, 1] {
        let (one, other) = pair.seen_from(side);
        for vertex in one.shell_vertices() {
            deepest = deepest.max(within(&other, one.vertices()[vertex as usize], pair.tolerance));
        }
        deepest = deepest.max(through(pair, side, candidates));
    }
    let under = in_parts(candidates, |part| vec![same_side(pair, part)]);
    deepest = under.into_iter().fold(deepest, f64::max);
    (deepest > pair.tolerance).then_some(deepest)
}

/// How deep a point is inside of a surface, metres; zero if it is not by more than the tolerance.
fn within(other: &Seen, point: Vector3, tolerance: f64) -> f64 {
    match nearest(other.surface, point - other.at, f64::MAX) {
        Some(found) if found.inside && found.distance > tolerance => found.distance,
        _ => 0.0,
    }
}

/// The greatest depth along edges of one surface that go through triangles of the other, and at vertices behind these.
fn through(pair: &Pair, side: usize, candidates: &[[u32; 2]]) -> f64 {
    let (one, other) = pair.seen_from(side);
    let crossings = in_parts(candidates, |part| crossings(pair, side, part));
    let behind: BTreeSet<u32> = crossings.iter().map(|&(_, _, end)| end).collect();
    let mut crossed: Vec<(u32, f64)> = crossings.into_iter().map(|(edge, share, _)| (edge, share)).collect();
    crossed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut deepest = 0.0_f64;
    for edge in crossed.chunk_by(|a, b| a.0 == b.0) {
        let [from, to] = one.edges()[edge[0].0 as usize].ends.map(|k| one.vertices()[k as usize]);
        let shares: Vec<f64> = [0.0].into_iter().chain(edge.iter().map(|crossing| crossing.1)).chain([1.0]).collect();
        for stretch in shares.windows(2) {
            let middle = from + 0.5 * (stretch[0] + stretch[1]) * (to - from);
            deepest = deepest.max(within(&other, middle, pair.tolerance));
        }
    }
    deepest.max(behind_them(one, &other, behind, pair.tolerance))
}

/// Edges of one surface that go through triangles of the other: where, as a share of the edge, and the end behind.
fn crossings(pair: &Pair, side: usize, candidates: &[[u32; 2]]) -> Vec<(u32, f64, u32)> {
    let (one, other) = pair.seen_from(side);
    let mut crossed = Vec::new();
    for candidate in candidates {
        poll(LOOK);
        let (own, against) = (candidate[side], candidate[1 - side]);
        let corners = other.surface.corners(against).map(|p| p + other.at);
        let normal = other.surface.normal(against);
        for edge in one.sides(own) {
            let found = one.edges()[edge as usize];
            if found.triangles[0] != own {
                continue;
            }
            let ends = found.ends.map(|k| one.vertices()[k as usize]);
            let heights = ends.map(|p| normal.dot(p - corners[0]));
            let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
            // What goes no deeper than the tolerance under the plane is no deeper here.
            if low >= -pair.tolerance || high <= -pair.tolerance {
                continue;
            }
            let share = (heights[0] + pair.tolerance) / (heights[0] - heights[1]);
            if !is_over(ends[0] + share * (ends[1] - ends[0]), &corners, normal, pair.tolerance) {
                continue;
            }
            crossed.push((edge, share, found.ends[if heights[0] < heights[1] { 0 } else { 1 }]));
        }
    }
    crossed
}

/// Vertices looked at behind those where a surface goes in: enough to say how deep, if not always the deepest.
const MOST_BEHIND: usize = 20_000;

/// The greatest depth of vertices that edges lead to from some of them, without leaving the other.
fn behind_them(one: &Surface, other: &Seen, first: BTreeSet<u32>, tolerance: f64) -> f64 {
    let mut seen = first.clone();
    let mut waiting: Vec<u32> = first.into_iter().collect();
    let mut deepest = 0.0_f64;
    while let Some(vertex) = waiting.pop().filter(|_| seen.len() < MOST_BEHIND) {
        let depth = within(other, one.vertices()[vertex as usize], tolerance);
        if depth > 0.0 {
            deepest = deepest.max(depth);
            let next = one.edges_at(vertex).flat_map(|edge| edge.ends);
            waiting.extend(next.filter(|&end| seen.insert(end)));
        }
    }
    deepest
}

/// Whether a point is over a triangle, or within the tolerance of that.
fn is_over(point: Vector3, corners: &[Vector3; 3], normal: Vector3, tolerance: f64) -> bool {
    (0..3).all(|k| {
        let along = corners[(k + 1) % 3] - corners[k];
        normal.cross(along).normalize_or_zero().dot(point - corners[k]) >= -tolerance
    })
}

/// How deep the balls are in both bodies that are begun under faces which lie on one another and look the same way.
fn same_side(pair: &Pair, candidates: &[[u32; 2]]) -> f64 {
    let [a, b] = pair.surfaces;
    let of_b = Seen { surface: b, at: pair.offset };
    let mut deepest = 0.0_f64;
    for &[ta, tb] in candidates {
        poll(LOOK);
        let (na, nb) = (a.normal(ta), b.normal(tb));
        if na.dot(nb) < 0.99 {
            continue;
        }
        let (of_first, of_second) = (a.corners(ta), b.corners(tb).map(|p| p + pair.offset));
        if of_second.iter().all(|p| na.dot(*p - of_first[0]).abs() > pair.tolerance) {
            continue;
        }
        let Some(middle) = common_middle(&of_first, &of_second, na, pair.tolerance) else { continue };
        let mut reach = 4.0 * pair.tolerance;
        while let Some(ball) = ball_in_both(a, &of_b, middle - reach * na, pair.tolerance) {
            deepest = deepest.max(2.0 * ball);
            reach *= 2.0;
        }
    }
    deepest
}

/// The radius of the ball about a point that is inside of both, metres, if that is more than the tolerance.
fn ball_in_both(a: &Surface, b: &Seen, point: Vector3, tolerance: f64) -> Option<f64> {
    let first = Seen { surface: a, at: Vector3::ZERO };
    let radius = within(&first, point, tolerance).min(within(b, point, tolerance));
    (radius > 0.0).then_some(radius)
}

/// The middle of what two triangles share, seen along a normal, if it is more than a border.
fn common_middle(a: &[Vector3; 3], b: &[Vector3; 3], normal: Vector3, tolerance: f64) -> Option<Vector3> {
    let mut polygon: Vec<Vector3> = a.to_vec();
    for k in 0..3 {
        let inwards = normal.cross(b[(k + 1) % 3] - b[k]).normalize_or_zero();
        let height = |p: Vector3| inwards.dot(p - b[k]) - 2.0 * tolerance;
        let mut kept = Vec::new();
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            let (here, there) = (height(p), height(q));
            if here >= 0.0 {
                kept.push(p);
            }
            if here * there < 0.0 {
                kept.push(p + here / (here - there) * (q - p));
            }
        }
        polygon = kept;
    }
    let count = polygon.len() as f64;
    (polygon.len() > 2).then(|| polygon.iter().copied().sum::<Vector3>() / count)
}
