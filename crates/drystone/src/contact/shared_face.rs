//! What two convex polyhedra share of a face of one of them: the whole polygon, every corner of it named.
//!
//! The face is the *reference*. What of the other polyhedron lies on its plane, within tolerance, is the *print*: a face, an
//! edge or a corner. The corners of their intersection are corners of the print within the face, corners of the face
//! within the print, and crossings of their edges. Where two of them coincide, that is one contact.

use super::id::SolidPart;
use crate::geometry::{Polyhedron, Vector3, convex_outline};

/// A corner of the shared polygon.
#[derive(Debug, Clone, Copy)]
pub(super) struct SharedCorner {
    /// In the frame of the reference polyhedron, on the reference face.
    pub point: Vector3,
    /// Distance of the other polyhedron there, metres.
    pub gap: f64,
    pub reference: SolidPart,
    pub other: SolidPart,
}

/// A point of the print or of the face in the face's plane.
#[derive(Debug, Clone, Copy)]
struct Flat {
    vertex: usize,
    at: [f64; 2],
    /// Height above the face, metres.
    height: f64,
}

/// The plane of the reference face.
struct Plane {
    origin: Vector3,
    normal: Vector3,
    u: Vector3,
    v: Vector3,
}

impl Plane {
    fn of(reference: &Polyhedron, face: usize) -> Self {
        let (corners, normal) = (&reference.faces()[face], reference.normals()[face]);
        let origin = reference.vertices()[corners[0]];
        let u = (reference.vertices()[corners[1]] - origin).normalize_or_zero();
        Self { origin, normal, u, v: normal.cross(u) }
    }

    fn flat(&self, vertex: usize, point: Vector3) -> Flat {
        let from = point - self.origin;
        Flat { vertex, at: [self.u.dot(from), self.v.dot(from)], height: self.normal.dot(from) }
    }

    fn point(&self, [x, y]: [f64; 2]) -> Vector3 {
        self.origin + x * self.u + y * self.v
    }
}

/// The corners of what the polyhedra share of a face of `reference`; `other` stands at `offset` from it. Empty where they
/// only share a part of the face's border: an edge beside an edge has no normal of its own.
pub(super) fn shared_corners(
    reference: &Polyhedron,
    face: usize,
    other: &Polyhedron,
    offset: Vector3,
    tolerance: f64,
) -> Vec<SharedCorner> {
    let plane = Plane::of(reference, face);
    let flat = other.vertices().iter().enumerate().map(|(k, v)| plane.flat(k, *v + offset));
    let print = print_of(flat.filter(|flat| flat.height <= tolerance).collect());
    // What an inner point of the print belongs to: its edge, or the face of the other that looks against this one.
    let inner = match print[..] {
        [a, b] => corner_or_edge([a.vertex, b.vertex]),
        _ => SolidPart::Face(most_opposed(other, 0..other.faces().len(), plane.normal)),
    };
    common(&plane, (reference, face), (&print, inner), tolerance)
}

/// The same of what is before the face, at whatever height. The print is a face of `other` at its lowest corner: the one that
/// looks most against the reference.
pub(super) fn facing_corners(
    reference: &Polyhedron,
    face: usize,
    other: &Polyhedron,
    offset: Vector3,
    tolerance: f64,
) -> Vec<SharedCorner> {
    let plane = Plane::of(reference, face);
    let lowest = other.lowest(plane.normal);
    let at_lowest = (0..other.faces().len()).filter(|&face| other.faces()[face].contains(&lowest));
    let opposed = most_opposed(other, at_lowest, plane.normal);
    let near = other.faces()[opposed].iter().map(|&k| plane.flat(k, other.vertices()[k] + offset)).collect();
    common(&plane, (reference, face), (&print_of(near), SolidPart::Face(opposed)), tolerance)
}

/// The corners of the intersection of a face with a print on its plane; `inner` is what points within the print belong to.
fn common(
    plane: &Plane,
    (reference, face): (&Polyhedron, usize),
    (print, inner): (&[Flat], SolidPart),
    tolerance: f64,
) -> Vec<SharedCorner> {
    let corners = &reference.faces()[face];
    let outline: Vec<Flat> = corners.iter().map(|&k| plane.flat(k, reference.vertices()[k])).collect();
    let shared = intersection(&outline, print, tolerance);
    if !reaches_inside(&shared, &outline, tolerance) {
        return Vec::new();
    }
    let on_face = |named: Option<[usize; 2]>| match named {
        None => SolidPart::Face(face),
        Some(ends) => corner_or_edge(ends),
    };
    let corner = |meeting: &Meeting| SharedCorner {
        point: plane.point(meeting.at),
        gap: meeting.height,
        reference: on_face(meeting.outline),
        other: meeting.print.map_or(inner, corner_or_edge),
    };
    shared.iter().map(corner).collect()
}

fn corner_or_edge([a, b]: [usize; 2]) -> SolidPart {
    if a == b { SolidPart::Corner(a) } else { SolidPart::Edge([a.min(b), a.max(b)]) }
}

/// Of some faces the one whose normal looks most against a direction. Of equal faces the first.
fn most_opposed(of: &Polyhedron, faces: impl Iterator<Item = usize>, direction: Vector3) -> usize {
    let alignments = faces.map(|face| (face, of.normals()[face].dot(direction)));
    alignments.fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best }).0
}

/// The outline of corners of the other polyhedron on the plane, counter-clockwise.
fn print_of(near: Vec<Flat>) -> Vec<Flat> {
    let outline = convex_outline(near.iter().enumerate().map(|(k, flat)| (k, flat.at)).collect(), 0.0);
    outline.into_iter().map(|k| near[k]).collect()
}

/// A corner of the intersection: on a corner (both ends equal) or an edge of the outline, of the print, or within them.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    at: [f64; 2],
    height: f64,
    outline: Option<[usize; 2]>,
    print: Option<[usize; 2]>,
}

fn intersection(outline: &[Flat], print: &[Flat], tolerance: f64) -> Vec<Meeting> {
    let mut found: Vec<Meeting> = Vec::new();
    // Corners on corners come first, then corners within, then crossings: of those that coincide the first stays.
    let mut add = |meeting: Meeting| {
        if found.iter().all(|known| distance(known.at, meeting.at) > tolerance) {
            found.push(meeting);
        }
    };
    let own = |corner: &Flat| Some([corner.vertex; 2]);
    for inner in print {
        if let Some(corner) = outline.iter().find(|corner| distance(corner.at, inner.at) <= tolerance) {
            add(Meeting { at: inner.at, height: inner.height, outline: own(corner), print: own(inner) });
        }
    }
    for inner in print.iter().filter(|inner| depth(outline, inner.at) >= -tolerance) {
        let edge = side_at(outline, inner.at, tolerance);
        add(Meeting { at: inner.at, height: inner.height, outline: edge, print: own(inner) });
    }
    if print.len() > 2 {
        for corner in outline.iter().filter(|corner| depth(print, corner.at) >= -tolerance) {
            let edge = side_at(print, corner.at, tolerance);
            let height = height_at(print, corner.at);
            add(Meeting { at: corner.at, height, outline: own(corner), print: edge });
        }
    }
    for [a, b] in sides(outline) {
        for [c, d] in sides(print) {
            if let Some((at, share)) = crossing([a.at, b.at], [c.at, d.at]) {
                let height = c.height + share * (d.height - c.height);
                let (outline, print) = (Some([a.vertex, b.vertex]), Some([c.vertex, d.vertex]));
                add(Meeting { at, height, outline, print });
            }
        }
    }
    let corners = convex_outline(found.iter().enumerate().map(|(k, m)| (k, m.at)).collect(), tolerance);
    corners.into_iter().map(|k| found[k]).collect()
}

fn sides(polygon: &[Flat]) -> impl Iterator<Item = [&Flat; 2]> {
    let count = if polygon.len() == 2 { 1 } else { polygon.len() };
    let count = if polygon.len() < 2 { 0 } else { count };
    (0..count).map(move |k| [&polygon[k], &polygon[(k + 1) % polygon.len()]])
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (bx - ax).hypot(by - ay)
}

/// How far a point lies to the left of a directed line, metres.
fn left_of([a, b]: [&Flat; 2], [x, y]: [f64; 2]) -> f64 {
    let (dx, dy) = (b.at[0] - a.at[0], b.at[1] - a.at[1]);
    (dx * (y - a.at[1]) - dy * (x - a.at[0])) / dx.hypot(dy)
}

/// Distance of a point from the nearest side's line of a convex polygon, negative outside.
fn depth(polygon: &[Flat], point: [f64; 2]) -> f64 {
    sides(polygon).map(|side| left_of(side, point)).fold(f64::INFINITY, f64::min)
}

/// The side of a polygon that a point lies on, if any.
fn side_at(polygon: &[Flat], point: [f64; 2], tolerance: f64) -> Option<[usize; 2]> {
    sides(polygon).find(|side| left_of(*side, point).abs() <= tolerance).map(|[a, b]| [a.vertex, b.vertex])
}

/// Height of a polygon's plane at a point, from the triangle of its first, its furthest and its most distant third corner.
fn height_at(print: &[Flat], [x, y]: [f64; 2]) -> f64 {
    let a = print[0];
    let area =
        |b: &Flat, c: &Flat| (b.at[0] - a.at[0]) * (c.at[1] - a.at[1]) - (b.at[1] - a.at[1]) * (c.at[0] - a.at[0]);
    let largest = (1..print.len() - 1)
        .max_by(|&i, &j| area(&print[i], &print[i + 1]).abs().total_cmp(&area(&print[j], &print[j + 1]).abs()));
    let Some(k) = largest else { return a.height };
    let (b, c) = (&print[k], &print[k + 1]);
    let whole = area(b, c);
    let here = Flat { vertex: 0, at: [x, y], height: 0.0 };
    let (to_b, to_c) = (area(&here, c) / whole, area(b, &here) / whole);
    a.height + to_b * (b.height - a.height) + to_c * (c.height - a.height)
}

/// Where two segments cross strictly within both, and the share of the second at which they do.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<([f64; 2], f64)> {
    let side = |p: [f64; 2], q: [f64; 2], x: [f64; 2]| (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0]);
    let (from, to) = (side(a, b, c), side(a, b, d));
    let (low, high) = (side(c, d, a), side(c, d, b));
    if from * to >= 0.0 || low * high >= 0.0 {
        return None;
    }
    let share = from / (from - to);
    Some(([c[0] + share * (d[0] - c[0]), c[1] + share * (d[1] - c[1])], share))
}

/// Whether the shared polygon, segment or point reaches into the face, and not only along its border.
fn reaches_inside(shared: &[Meeting], outline: &[Flat], tolerance: f64) -> bool {
    let count = shared.len() as f64;
    let middle = [0, 1].map(|k| shared.iter().map(|meeting| meeting.at[k]).sum::<f64>() / count);
    !shared.is_empty() && depth(outline, middle) > tolerance
}
