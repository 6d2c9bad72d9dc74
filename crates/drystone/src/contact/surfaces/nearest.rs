//! The point of a surface nearest to another point, and whether that is inside; how far two surfaces are apart.

use crate::{
    geometry::{Surface, Vector3},
    interrupt::poll,
};
use parry3d_f64::partitioning::BvhNode;
use std::cell::Cell;

/// Operations to find the nearest point of a surface, about.
const QUERY: usize = 400;

/// Where on a triangle a point is nearest.
#[derive(Clone, Copy)]
enum On {
    Face,
    /// Between this vertex of the triangle and the next.
    Side(usize),
    Corner(usize),
}

/// The nearest point of a surface.
pub(super) struct Nearest {
    /// Metres.
    pub distance: f64,
    /// Whether the point asked for is on the inner side.
    pub inside: bool,
}

/// The nearest point of a surface, within a distance; None if there is none.
pub(super) fn nearest(surface: &Surface, point: Vector3, within: f64) -> Option<Nearest> {
    poll(QUERY);
    let apart = |node: &BvhNode, _| outside(node, point);
    let leaf = |triangle: u32, _| Some((point.distance(foot(surface.corners(triangle), point).0), triangle));
    let (_, (distance, triangle)) = surface.tree().find_best(within, apart, leaf)?;
    let (foot, on) = foot(surface.corners(triangle), point);
    let outwards = match on {
        On::Face => surface.normal(triangle),
        On::Corner(k) => surface.corner_normal(surface.triangles()[triangle as usize][k]),
        On::Side(k) => {
            let edge = surface.edges()[surface.sides(triangle)[k] as usize];
            edge.triangles.into_iter().map(|t| surface.normal(t)).sum()
        }
    };
    Some(Nearest { distance, inside: outwards.dot(point - foot) < 0.0 })
}

/// Distance of a point from a box, metres.
fn outside(node: &BvhNode, point: Vector3) -> f64 {
    (node.mins() - point).max(point - node.maxs()).max(Vector3::ZERO).length()
}

/// The point of a triangle nearest to another (C. Ericson, Real-Time Collision Detection, 5.1.5).
fn foot([a, b, c]: [Vector3; 3], p: Vector3) -> (Vector3, On) {
    let (ab, ac) = (b - a, c - a);
    let (to_a, to_b, to_c) = (p - a, p - b, p - c);
    let (d1, d2) = (ab.dot(to_a), ac.dot(to_a));
    let (d3, d4) = (ab.dot(to_b), ac.dot(to_b));
    let (d5, d6) = (ab.dot(to_c), ac.dot(to_c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, On::Corner(0));
    }
    if d3 >= 0.0 && d4 <= d3 {
        return (b, On::Corner(1));
    }
    if d6 >= 0.0 && d5 <= d6 {
        return (c, On::Corner(2));
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + d1 / (d1 - d3) * ab, On::Side(0));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + d2 / (d2 - d6) * ac, On::Side(2));
    }
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return (b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b), On::Side(1));
    }
    let whole = va + vb + vc;
    (a + vb / whole * ab + vc / whole * ac, On::Face)
}

/// Closest points of two segments, as shares of them (Ericson, 5.1.9).
pub(super) fn closest([p, q]: [Vector3; 2], [r, s]: [Vector3; 2]) -> [f64; 2] {
    let (d, e, between) = (q - p, s - r, p - r);
    let (dd, ee, ed) = (d.dot(d), e.dot(e), e.dot(between));
    let (de, db) = (d.dot(e), d.dot(between));
    let square = dd * ee - de * de;
    let first = if square > 0.0 { ((de * ed - db * ee) / square).clamp(0.0, 1.0) } else { 0.0 };
    let second = (de * first + ed) / ee;
    match second {
        _ if second < 0.0 => [(-db / dd).clamp(0.0, 1.0), 0.0],
        _ if second > 1.0 => [((de - db) / dd).clamp(0.0, 1.0), 1.0],
        _ => [first, second],
    }
}

/// Distance of two triangles that do not go through each other, metres.
fn apart(a: [Vector3; 3], b: [Vector3; 3]) -> f64 {
    let corners = |from: [Vector3; 3], to: [Vector3; 3]| from.map(|p| p.distance(foot(to, p).0));
    let side = |t: [Vector3; 3], k: usize| [t[k], t[(k + 1) % 3]];
    let sides = (0..9).map(|k| {
        let ([p, q], [r, s]) = (side(a, k / 3), side(b, k % 3));
        let [x, y] = closest([p, q], [r, s]);
        (p + x * (q - p)).distance(r + y * (s - r))
    });
    corners(a, b).into_iter().chain(corners(b, a)).chain(sides).fold(f64::INFINITY, f64::min)
}

/// Distance of two surfaces that do not go through each other, if it is less than `within`, metres; the second stands at `offset`.
pub(crate) fn distance(a: &Surface, b: &Surface, offset: Vector3, within: f64) -> Option<f64> {
    let least = Cell::new(within);
    let near = |m: &BvhNode, n: &BvhNode| {
        let between = (n.mins() + offset - m.maxs()).max(m.mins() - n.maxs() - offset);
        between.max(Vector3::ZERO).length() < least.get()
    };
    for (ta, tb) in a.tree().leaf_pairs(b.tree(), near) {
        poll(QUERY);
        least.set(least.get().min(apart(a.corners(ta), b.corners(tb).map(|p| p + offset))));
    }
    (least.get() < within).then(|| least.get())
}
