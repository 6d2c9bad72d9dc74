//! Where a triangle of one surface lies on a triangle of another: the polygon that both share.

use crate::geometry::{Surface, Vector3};

/// Radians. Triangles that look against each other within this conform if all of what they share is within tolerance: the facets
/// of a peg and its hole, of a ball and its socket. A curve of fewer than nine facets is an edge.
pub(super) const CONFORM: f64 = 0.35;

/// Radians. Planes that differ by less are taken as one where they are within tolerance, even if they part beyond.
pub(super) const LEVEL: f64 = 0.01;

/// A polygon thinner than this share of its thinner triangle, and than the tolerance, is a shared border.
const THIN: f64 = 0.05;

/// What two triangles share.
pub(super) struct Shared {
    /// Unit vector from the first into the second.
    pub normal: Vector3,
    /// Corners halfway across the gap, each with the gap, metres.
    pub corners: Vec<(Vector3, f64)>,
}

/// A point of the plane between both, with the heights of the two above it.
type Flat = [f64; 2];

/// The corners of the part of both triangles where they are within tolerance, if they look against each other.
pub(super) fn shared([a, b]: [&Surface; 2], [ta, tb]: [u32; 2], offset: Vector3, tolerance: f64) -> Option<Shared> {
    let [na, nb] = [a.normal(ta), b.normal(tb)];
    let against = -na.dot(nb);
    if against < CONFORM.cos() {
        return None;
    }
    let angle = na.cross(nb).length().atan2(against);
    let normal = (na - nb).normalize_or_zero();
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let (of_a, of_b) = (a.corners(ta), b.corners(tb).map(|p| p + offset));
    let origin = of_a[0];
    let flat = |p: Vector3| [u.dot(p - origin), v.dot(p - origin)];
    // Seen against the normal the second goes round the other way.
    let [b0, b1, b2] = of_b.map(flat);
    let first: Vec<Flat> = of_a.map(flat).to_vec();
    let second: [Flat; 3] = [b0, b2, b1];
    let mut polygon = clipped(first.clone(), &second);
    let height = |n: Vector3, through: Vector3, [x, y]: Flat| {
        let base = n.dot(through - origin);
        (base - x * n.dot(u) - y * n.dot(v)) / n.dot(normal)
    };
    let gap = |p: Flat| height(nb, of_b[0], p) - height(na, origin, p);
    if polygon.iter().any(|&p| gap(p).abs() > tolerance) {
        if angle > LEVEL {
            return None;
        }
        polygon = below(polygon, |p| gap(p) - tolerance);
        polygon = below(polygon, |p| -gap(p) - tolerance);
    }
    let least = tolerance.min(THIN * width(&first).min(width(&second)));
    if polygon.len() < 3 || width(&polygon) <= least {
        return None;
    }
    let point = |&p: &Flat| {
        let middle = 0.5 * (height(na, origin, p) + height(nb, of_b[0], p));
        (origin + p[0] * u + p[1] * v + middle * normal, gap(p))
    };
    Some(Shared { normal, corners: polygon.iter().map(point).collect() })
}

/// A convex polygon within another, both counter-clockwise.
fn clipped(mut polygon: Vec<Flat>, by: &[Flat]) -> Vec<Flat> {
    for (k, &[px, py]) in by.iter().enumerate() {
        let [qx, qy] = by[(k + 1) % by.len()];
        let (dx, dy) = (qx - px, qy - py);
        polygon = below(polygon, |[x, y]| dy * (x - px) - dx * (y - py));
    }
    polygon
}

/// The part of a convex polygon where an affine function is not positive.
fn below(polygon: Vec<Flat>, value: impl Fn(Flat) -> f64) -> Vec<Flat> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (here, there) = (value(p), value(q));
        if here <= 0.0 {
            kept.push(p);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            let share = here / (here - there);
            kept.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
        }
    }
    kept
}

/// Twice the area over the greatest distance of two corners: for thin polygons their width.
fn width(polygon: &[Flat]) -> f64 {
    let Some(&[ox, oy]) = polygon.first() else { return 0.0 };
    let twice = |k: usize| {
        let ([px, py], [qx, qy]) = (polygon[k], polygon[k + 1]);
        (px - ox) * (qy - oy) - (py - oy) * (qx - ox)
    };
    let area: f64 = (1..polygon.len().saturating_sub(1)).map(twice).sum();
    let apart = polygon.iter().flat_map(|p| polygon.iter().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1])));
    let longest = apart.fold(0.0, f64::max);
    if longest > 0.0 { area.abs() / longest } else { 0.0 }
}
