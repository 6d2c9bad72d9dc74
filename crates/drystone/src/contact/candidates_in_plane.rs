//! Where polygons may meet within a time step: a corner of one before a face of the other.
//!
//! Blocks that are disjoint have a face with the other wholly on its outer side (separating axes, `narrow_phase.rs`); the two
//! ends of the span it shares with the other block's most opposed face are the points where they can meet first. Each end is a
//! corner of one of them before a face of the other, and its gap is the corner's distance from that face's line. A corner
//! beyond the face's ends is left out unless the bodies' motion takes it before the face and through it within the step: the
//! face does not reach beyond its ends, and a block that falls past an edge must not be held by it.
//!
//! Blocks that share a corner or nothing there may yet meet on their way: moved in a straight line, at that face of their
//! Minkowski difference which is entered last, however far in the step. That is looked for on the ways that come out of a solve
//! without such a contact (docs/theory/seams.md). Corners that are on one another by then have the normal of slightly rounded
//! ones, as they have at rest (docs/theory/touching-at-borders.md).

use super::{
    ContactId, Feature,
    candidates::{CandidateContact, Colliding, FirstMet, Meeting, Near},
    narrow_phase::{Outline, at_corners, greatest_separation, most_opposed},
};
use crate::{
    geometry::{Polygon, Vector},
    scene::Body,
};

impl Colliding for Polygon {
    type Velocity = [f64; 3];
    type Levers = [[f64; 2]; 1];
    type Outline = Outline;

    fn outline(body: &Body) -> Outline {
        Outline::of(body)
    }

    fn levers(_: &Outline, [x, y]: [f64; 2]) -> [[f64; 2]; 1] {
        [[-y, x]]
    }

    fn meet(near: &Near<'_, Self>) -> Meeting<Self> {
        let [a, b] = near.places.map(Vector::from_array);
        Corners { near, origin: a, offset: b - a }.meet()
    }

    fn first_met(near: &Near<'_, Self>, _: [usize; 2], allowed: f64) -> Vec<CandidateContact> {
        let [a, b] = near.places.map(Vector::from_array);
        let corners = Corners { near, origin: a, offset: b - a };
        let met = corners.first_met(allowed);
        let at_face = |(owner, face)| corners.between(owner, &corners.end(owner, face, corners.closest(owner, face)));
        met.map(|met| corners.at_corners().unwrap_or_else(|| at_face(met))).into_iter().collect()
    }
}

/// Two polygons.
struct Corners<'a> {
    near: &'a Near<'a, Polygon>,
    /// The first centroid in the world.
    origin: Vector,
    /// The second, seen from there.
    offset: Vector,
}

/// A corner against a face of the other body, and what is between them.
struct End {
    corner: usize,
    face: usize,
    /// Corner relative to the first body's centroid.
    at: Vector,
    /// The face's outward normal.
    normal: Vector,
    gap: f64,
    /// Place along the face, from 0 to its length where the corner is before it.
    along: f64,
    length: f64,
}

impl Corners<'_> {
    fn meet(&self) -> Meeting<Polygon> {
        let [a, b] = self.near.outlines;
        let (face_a, separation_a) = greatest_separation(a, b, self.offset);
        let (face_b, separation_b) = greatest_separation(b, a, -self.offset);
        let separation = separation_a.max(separation_b);
        let (mut candidates, mut cornered) = (Vec::new(), false);
        if separation > self.near.reach {
            return Meeting { candidates, open: Vec::new(), separation };
        }
        // Of equal faces the first body's, so that rounding does not decide.
        let second = separation_b > separation_a + self.near.tolerance;
        let (reference, face) = if second { (1, face_b) } else { (0, face_a) };
        let [low, high] = self.span(reference, face);
        if high - low > self.near.tolerance {
            let ends = self.ends(reference, face);
            cornered = separation > -self.near.tolerance && self.cornered(&ends);
            let bears = |end: &End| !cornered || end.gap > self.near.tolerance;
            let ends = ends.into_iter().filter(|(_, end)| bears(end));
            candidates.extend(ends.filter_map(|(owner, end)| self.candidate(owner, &end)));
        }
        let open = cornered || candidates.is_empty() && separation > -self.near.tolerance;
        Meeting { candidates, open: if open { vec![[0, 0]] } else { Vec::new() }, separation }
    }

    /// What the face shares with the other body's most opposed one, along it, metres: the end is not above the beginning
    /// where they share a corner or nothing.
    fn span(&self, reference: usize, face: usize) -> [f64; 2] {
        let other = self.near.outlines[1 - reference];
        let opposed = most_opposed(other, self.near.outlines[reference].normals[face]);
        let [low, high] = [other.next(opposed), opposed].map(|corner| self.end(reference, face, corner));
        [low.along.max(0.0), high.along.min(high.length)]
    }

    /// Both ends of the shared span, each with the body (0 or 1) that owns the face.
    fn ends(&self, reference: usize, face: usize) -> [(usize, End); 2] {
        let incident = 1 - reference;
        let opposed = most_opposed(self.near.outlines[incident], self.near.outlines[reference].normals[face]);
        // Faces run counter-clockwise, so the incident one runs against the reference.
        let low = self.end(reference, face, self.near.outlines[incident].next(opposed));
        let high = self.end(reference, face, opposed);
        let beyond_low = low.along < -self.near.tolerance;
        let beyond_high = high.along > high.length + self.near.tolerance;
        let own = |corner: usize| (incident, self.end(incident, opposed, corner));
        [
            if beyond_low { own(face) } else { (reference, low) },
            if beyond_high { own(self.near.outlines[reference].next(face)) } else { (reference, high) },
        ]
    }

    /// The other body's corner against a face of `owner`.
    fn end(&self, owner: usize, face: usize, corner: usize) -> End {
        let origin = [Vector::ZERO, self.offset];
        let (outline, other) = (self.near.outlines[owner], self.near.outlines[1 - owner]);
        let at = origin[1 - owner] + other.vertices[corner];
        let start = origin[owner] + outline.vertices[face];
        let normal = outline.normals[face];
        let side = outline.vertices[outline.next(face)] - outline.vertices[face];
        let tangent = normal.perp();
        let from_start = at - start;
        End {
            corner,
            face,
            at,
            normal,
            gap: normal.dot(from_start),
            along: tangent.dot(from_start),
            length: tangent.dot(side),
        }
    }

    fn candidate(&self, owner: usize, end: &End) -> Option<CandidateContact> {
        if end.gap > self.near.reach || !self.meets(owner, end) {
            return None;
        }
        Some(self.between(owner, end))
    }

    fn between(&self, owner: usize, end: &End) -> CandidateContact {
        let (feature, normal) = match owner {
            0 => (Feature::CornerOfB { a: end.face, b: end.corner }, end.normal),
            _ => (Feature::CornerOfA { a: end.corner, b: end.face }, -end.normal),
        };
        CandidateContact {
            id: ContactId { bodies: self.near.bodies, feature },
            normal: normal.to_array(),
            point: (self.origin + end.at).to_array(),
            levers: [end.at, end.at - self.offset].map(|arm| [arm.perp().to_array()]),
            gap: end.gap,
            friction: self.near.friction,
        }
    }

    /// Whether the corner is before the face, or comes to be so and through it within the step.
    fn meets(&self, owner: usize, end: &End) -> bool {
        let before = |along: f64| along >= -self.near.tolerance && along <= end.length + self.near.tolerance;
        if before(end.along) {
            return true;
        }
        // The first body's motion is subtracted; seen from the face's owner the corner moves by this.
        let shift = if owner == 0 { self.shift(end.at) } else { -self.shift(end.at) };
        before(end.along + end.normal.perp().dot(shift)) && end.gap + end.normal.dot(shift) < -self.near.tolerance
    }

    /// How far the second body's point goes relative to the first's, to first order.
    fn shift(&self, at: Vector) -> Vector {
        let of = |k: usize, arm: Vector| {
            let [x, y, turn] = self.near.travel[k];
            Vector::new(x, y) + turn * arm.perp()
        };
        of(1, at - self.offset) - of(0, at)
    }

    /// The face (of body 0 or 1) at which the second body, moved in a straight line, first meets the first: that of their
    /// Minkowski difference which is entered last, or one on which they touch already. None if they do not meet.
    fn first_met(&self, allowed: f64) -> Option<(usize, usize)> {
        let mut met = FirstMet::new(self.near.tolerance, allowed);
        for (owner, face) in [0, 1].into_iter().flat_map(|owner| self.faces(owner).map(move |face| (owner, face))) {
            let gaps = self.faces(1 - owner).map(|corner| {
                let end = self.end(owner, face, corner);
                // How far the corner moves outwards, seen from the face's owner.
                let shift = end.normal.dot(self.shift(end.at));
                [end.gap, end.gap + if owner == 0 { shift } else { -shift }]
            });
            let [now, then] = gaps.fold([f64::INFINITY; 2], |[now, then], [a, b]| [now.min(a), then.min(b)]);
            met.see((owner, face), now, then - now)?;
        }
        met.found().map(|(face, _)| face)
    }

    /// Whether the one end that is on a face is at the end of that face: a corner on a corner, for which no face is the right one.
    fn cornered(&self, ends: &[(usize, End)]) -> bool {
        let tolerance = self.near.tolerance;
        let mut closed = ends.iter().map(|(_, end)| end).filter(|end| end.gap <= tolerance);
        let inside = |end: &End| end.along > tolerance && end.along < end.length - tolerance;
        matches!((closed.next(), closed.next()), (Some(end), None) if !inside(end))
    }

    /// A corner that is on a corner already: each of two distances, along and across a face, may use the whole tolerance.
    fn at_corners(&self) -> Option<CandidateContact> {
        let [a, b] = self.near.outlines;
        let apart = |[i, j]: [usize; 2]| a.vertices[i].distance(b.vertices[j] + self.offset);
        let pairs = self.faces(0).flat_map(|i| self.faces(1).map(move |j| [i, j]));
        let nearest = pairs.min_by(|&p, &q| apart(p).total_cmp(&apart(q)))?;
        let border =
            at_corners([a, b], nearest, self.offset).filter(|_| apart(nearest) <= 2.0 * self.near.tolerance)?;
        let met = border.points.first()?;
        Some(CandidateContact {
            id: ContactId { bodies: self.near.bodies, feature: met.feature },
            normal: met.normal.to_array(),
            point: (self.origin + met.point).to_array(),
            levers: [met.point, met.point - self.offset].map(|arm| [arm.perp().to_array()]),
            gap: met.gap,
            friction: self.near.friction,
        })
    }

    fn faces(&self, owner: usize) -> std::ops::Range<usize> {
        0..self.near.outlines[owner].normals.len()
    }

    /// The other body's corner closest to the line of a face.
    fn closest(&self, owner: usize, face: usize) -> usize {
        let normal = self.near.outlines[owner].normals[face];
        let height = |k: &usize| normal.dot(self.near.outlines[1 - owner].vertices[*k]);
        self.faces(1 - owner).min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(0)
    }
}
