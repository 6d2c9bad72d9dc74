//! Narrow phase: how two convex polygons touch.
//!
//! By the separating axis theorem two convex polygons are disjoint exactly when the line of some
//! face of one has the other wholly on its outer side. The face with the greatest separation is
//! the *reference*; the face of the other polygon that looks most against it is the *incident*
//! one. The incident face, clipped to the span of the reference face, gives the contact points.
//! The two polygons may swap roles under rounding; identities and points do not depend on that.
//!
//! ```text
//!             i0 ______________________ i1      incident face
//!        r0 ______|_________|______ r1          reference face, normal up
//!               low        ...  high            ends of the shared span
//! ```

use super::{
    id::Feature,
    rounding::{Local, Parting},
    touch::{Border, Touch},
};
use crate::{
    geometry::{Vector, Vector3},
    scene::Body,
};

/// A contact point relative to the first polygon's centroid.
pub(super) struct TouchPoint {
    pub feature: Feature,
    pub point: Vector,
    /// Unit vector from the first polygon into the second.
    pub normal: Vector,
    pub gap: f64,
}

/// A block's corners turned into world axes but still relative to its centroid (so that nothing
/// is lost far from the world's origin), with the outward unit normal of each face.
#[derive(Debug, Clone)]
pub struct Outline {
    pub vertices: Vec<Vector>,
    pub normals: Vec<Vector>,
}

impl Outline {
    pub fn of(body: &Body) -> Self {
        let vertices: Vec<Vector> = body.shape.vertices().iter().copied().map(body.pose.turn()).collect();
        let n = vertices.len();
        let normal = |k: usize| -(vertices[(k + 1) % n] - vertices[k]).normalize_or_zero().perp();
        let normals = (0..n).map(normal).collect();
        Self { vertices, normals }
    }

    pub fn next(&self, k: usize) -> usize {
        (k + 1) % self.vertices.len()
    }

    /// What the polygon is at a corner.
    fn local(&self, corner: usize) -> Local {
        let [before, after] = [(corner + self.vertices.len() - 1) % self.vertices.len(), self.next(corner)];
        let to = |other: usize| (self.vertices[other] - self.vertices[corner]).normalize_or_zero();
        let flat = |v: Vector| Vector3::new(v.x, v.y, 0.0);
        Local {
            faces: [before, corner].map(|face| flat(self.normals[face])).to_vec(),
            into: [before, after].map(|other| flat(to(other))).to_vec(),
        }
    }
}

/// How `a` and `b` touch, where `b`'s centroid is `offset` from `a`'s.
pub(super) fn touch(a: &Outline, b: &Outline, offset: Vector, tolerance: f64) -> Touch<TouchPoint> {
    let (face_a, separation_a) = greatest_separation(a, b, offset);
    let (face_b, separation_b) = greatest_separation(b, a, -offset);
    let separation = separation_a.max(separation_b);
    if separation > tolerance {
        return Touch::Apart;
    }
    if separation < -tolerance {
        return Touch::Overlap { depth: -separation };
    }
    let (role, span, origin) = if separation_a >= separation_b {
        (Role::ReferenceIsA, Span::clip(a, face_a, b, offset), Vector::ZERO)
    } else {
        (Role::ReferenceIsB, Span::clip(b, face_b, a, -offset), offset)
    };
    let points = span.points(role, tolerance, origin);
    match role {
        _ if !points.is_empty() => Touch::At(points),
        // Each of the two distances along and across the face may use the whole tolerance.
        _ if span.corner_distance > 2.0 * tolerance => Touch::Apart,
        Role::ReferenceIsA => Touch::AtBorders(at_corners([a, b], span.corners, offset).into_iter().collect()),
        Role::ReferenceIsB => {
            let [of_b, of_a] = span.corners;
            Touch::AtBorders(at_corners([a, b], [of_a, of_b], offset).into_iter().collect())
        }
    }
}

/// Where two corners meet.
pub(super) fn at_corners(
    [a, b]: [&Outline; 2],
    [of_a, of_b]: [usize; 2],
    offset: Vector,
) -> Option<Border<TouchPoint>> {
    let parting = Parting::of(&a.local(of_a), &b.local(of_b))?;
    let (on_a, on_b) = (a.vertices[of_a], b.vertices[of_b] + offset);
    let normal = Vector::new(parting.normal.x, parting.normal.y);
    let feature = Feature::Corners { a: of_a, b: of_b };
    let point = TouchPoint { feature, point: on_a.midpoint(on_b), normal, gap: normal.dot(on_b - on_a) };
    Some(Border { points: vec![point], parting })
}

/// The face of `reference` furthest from all of `other`, and that distance (negative: overlap
/// along this normal). Of equal faces the first.
pub(super) fn greatest_separation(reference: &Outline, other: &Outline, offset: Vector) -> (usize, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    for (face, (corner, normal)) in reference.vertices.iter().zip(&reference.normals).enumerate() {
        let shift = offset - *corner;
        let nearest = |v: &Vector| normal.dot(*v + shift);
        let separation = other.vertices.iter().map(nearest).fold(f64::INFINITY, f64::min);
        if separation > best.1 {
            best = (face, separation);
        }
    }
    best
}

#[derive(Clone, Copy, PartialEq)]
enum Role {
    ReferenceIsA,
    ReferenceIsB,
}

/// One end of the shared span: always a corner of one of the two faces.
#[derive(Clone, Copy)]
struct End {
    /// Coordinate along the reference face, from r0, metres.
    along: f64,
    /// Height of the incident face above the reference face, metres.
    gap: f64,
    /// The corner's place, relative to the reference polygon's centroid.
    corner: Vector,
    /// The incident polygon's corner number, if it is one of its.
    incident: Option<usize>,
}

/// The part of the incident face above the reference face.
struct Span {
    reference_face: usize,
    incident_face: usize,
    normal: Vector,
    /// Length of the reference face, metres.
    length: f64,
    low: End,
    high: End,
    /// The nearest corners of the two faces, first the reference's, and their distance, metres.
    corners: [usize; 2],
    corner_distance: f64,
}

impl Span {
    /// Clips the incident face of `other` (at `offset`) to the reference face's span.
    fn clip(reference: &Outline, face: usize, other: &Outline, offset: Vector) -> Self {
        let normal = reference.normals[face];
        let [r0, r1] = [face, reference.next(face)].map(|k| reference.vertices[k]);
        let incident_face = most_opposed(other, normal);
        // Faces run counter-clockwise, so the incident one runs against the reference.
        let [k0, k1] = [other.next(incident_face), incident_face];
        let [i0, i1] = [k0, k1].map(|k| other.vertices[k] + offset);

        let tangent = normal.perp();
        let length = tangent.dot(r1 - r0);
        let [s0, s1] = [i0, i1].map(|v| tangent.dot(v - r0));
        let [h0, h1] = [i0, i1].map(|v| normal.dot(v - r0));
        let gap_at = |s: f64| {
            if s1 > s0 { h0 + (h1 - h0) * ((s - s0) / (s1 - s0)) } else { h0 }
        };

        let incident = |along, gap, corner, k| End { along, gap, corner, incident: Some(k) };
        let own = |along, corner| End { along, gap: gap_at(along), corner, incident: None };
        let low = if s0 >= 0.0 { incident(s0, h0, i0, k0) } else { own(0.0, r0) };
        let high = if s1 <= length { incident(s1, h1, i1, k1) } else { own(length, r1) };
        let own_corners = [(face, r0), (reference.next(face), r1)];
        let pairs =
            own_corners.into_iter().flat_map(|(r, at)| [([r, k0], i0.distance(at)), ([r, k1], i1.distance(at))]);
        let nearest = |best: ([usize; 2], f64), next: ([usize; 2], f64)| if next.1 < best.1 { next } else { best };
        let (corners, corner_distance) = pairs.fold(([face, k0], f64::INFINITY), nearest);
        Self { reference_face: face, incident_face, normal, length, low, high, corners, corner_distance }
    }

    /// Turns the span into contact points, if faces meet in it or a corner a face. `origin` is the reference polygon's centroid.
    fn points(&self, role: Role, tolerance: f64, origin: Vector) -> Vec<TouchPoint> {
        let closed = |end: &End| end.gap <= tolerance;
        let shared = self.high.along - self.low.along;
        if closed(&self.low) && closed(&self.high) && shared > tolerance {
            let ends = match role {
                Role::ReferenceIsA => [self.high, self.low],
                Role::ReferenceIsB => [self.low, self.high],
            };
            let numbered = ends.into_iter().enumerate();
            let points = numbered.map(|(k, end)| {
                let (r, i) = (self.reference_face, self.incident_face);
                let feature = match role {
                    Role::ReferenceIsA => Feature::Faces { a: r, b: i, end: k },
                    Role::ReferenceIsB => Feature::Faces { a: i, b: r, end: k },
                };
                self.point(role, feature, end, origin)
            });
            return points.collect();
        }
        let lowest = if self.high.gap < self.low.gap { self.high } else { self.low };
        let inside = lowest.along > tolerance && lowest.along < self.length - tolerance;
        match lowest.incident {
            Some(corner) if inside && closed(&lowest) => {
                let feature = match role {
                    Role::ReferenceIsA => Feature::CornerOfB { a: self.reference_face, b: corner },
                    Role::ReferenceIsB => Feature::CornerOfA { a: corner, b: self.reference_face },
                };
                vec![self.point(role, feature, lowest, origin)]
            }
            _ => Vec::new(),
        }
    }

    /// The point halfway across the gap.
    fn point(&self, role: Role, feature: Feature, end: End, origin: Vector) -> TouchPoint {
        // An incident corner lies `gap` above the reference face, a reference corner as far below
        // the incident one.
        let half = if end.incident.is_some() { -0.5 * end.gap } else { 0.5 * end.gap };
        let point = origin + end.corner + half * self.normal;
        let normal = match role {
            Role::ReferenceIsA => self.normal,
            Role::ReferenceIsB => -self.normal,
        };
        TouchPoint { feature, point, normal, gap: end.gap }
    }
}

/// The face of `outline` whose normal looks most against `direction`. Of equal faces the first.
pub(super) fn most_opposed(outline: &Outline, direction: Vector) -> usize {
    let mut best = (0, f64::INFINITY);
    for (face, normal) in outline.normals.iter().enumerate() {
        let alignment = normal.dot(direction);
        if alignment < best.1 {
            best = (face, alignment);
        }
    }
    best.0
}
