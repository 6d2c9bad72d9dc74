//! Contacts that are closed, or that may close within a time step: a corner of one block before a face of another.
//!
//! `find_contacts` says what touches now; a time step also needs what will touch before it ends. Blocks that are
//! disjoint have a face with the other wholly on its outer side (separating axes, `narrow_phase.rs`); the two ends of the span
//! it shares with the other block's most opposed face are the points where they can meet first. Each end is a corner of one
//! of them before a face of the other, and its gap is the corner's distance from that face's line:
//!
//! ```text
//!     gap = n . (corner - face),     d gap / dt = n . (velocity of b at the corner - velocity of a at the corner)
//! ```
//!
//! exactly, turning of the face included, because the velocity of the face's block is taken at the corner too. A corner
//! beyond the face's ends is left out unless the bodies' motion takes it before the face and through it within the step: the
//! face does not reach beyond its ends, and a block that falls past an edge must not be held by it. Blocks that meet at a
//! corner of each on their way, however far in the step, have the approach at the face where they meet.

use super::{
    ContactId, Feature, broad_phase,
    narrow_phase::{Outline, greatest_separation, most_opposed},
    pair_tolerance,
};
use crate::geometry::{Shape, Vector};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// A corner of one block before a face of another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Approach {
    /// Which corner and which face; `bodies` are the indices of the two blocks, the lower first.
    pub id: ContactId,
    /// Unit vector from `bodies[0]` into `bodies[1]`: the face's normal or its opposite.
    pub normal: [f64; 2],
    /// The corner, world coordinates, metres.
    pub corner: [f64; 2],
    /// From each block's centroid to the corner, metres.
    pub arms: [[f64; 2]; 2],
    /// Distance of the corner from the face's line, metres; negative within the block.
    pub gap: f64,
    /// Coefficient of friction of the pair.
    pub friction: f64,
}

impl Approach {
    /// Whether the generators are the same: everything but the gap.
    pub fn same_geometry(&self, other: &Self) -> bool {
        (self.id, self.normal, self.arms, self.friction) == (other.id, other.normal, other.arms, other.friction)
    }
}

/// How a body moves if nothing stops it: metres and radians within the step.
pub type Travel = [f64; 3];

/// Approaches of a scene at one moment, in the order of (body, body, feature), kept pair by pair.
#[derive(Debug, Clone, Default)]
pub struct ApproachFinder {
    outlines: Vec<Outline>,
    /// What the outlines and pairs were found for.
    seen: Vec<([f64; 3], Travel)>,
    pairs: Vec<Pair>,
    /// Pairs looked at since the finder was made: a measure of the work done.
    pub pairs_looked_at: usize,
}

#[derive(Debug, Clone)]
struct Pair {
    bodies: [usize; 2],
    approaches: Vec<Approach>,
    /// The greatest separation over the faces, metres: negative by the depth of an overlap.
    separation: f64,
    /// One of them that turns too far in the step for its corners' ways to be straight.
    whirls: Option<usize>,
}

impl ApproachFinder {
    /// Finds every approach within the bodies' travel. Pairs of which neither the place nor the travel has changed since the
    /// last call are not looked at again.
    pub fn find(&mut self, scene: &Scene, travel: &[Travel]) {
        let bodies = scene.bodies();
        let key = |i: usize| {
            let pose = bodies[i].pose;
            ([pose.position[0], pose.position[1], pose.angle], travel[i])
        };
        let keys: Vec<_> = (0..bodies.len()).map(key).collect();
        if keys == self.seen {
            return;
        }
        let changed: Vec<bool> = (0..keys.len()).map(|i| self.seen.get(i) != Some(&keys[i])).collect();
        self.outlines.truncate(bodies.len());
        for (i, body) in bodies.iter().enumerate() {
            match self.outlines.get_mut(i) {
                Some(outline) if self.seen[i].0 != keys[i].0 => *outline = Outline::of(body),
                Some(_) => {}
                None => self.outlines.push(Outline::of(body)),
            }
        }
        let before = std::mem::take(&mut self.pairs);
        let mut known = before.into_iter().peekable();
        for pair in broad_phase::pairs_within(bodies, |i| reach(scene, i, &travel[i])) {
            while known.next_if(|old| old.bodies < pair).is_some() {}
            let old = known.next_if(|old| old.bodies == pair);
            let kept = old.filter(|_| pair.iter().all(|&i| !changed[i]));
            let found = kept.unwrap_or_else(|| {
                self.pairs_looked_at += 1;
                self.look_at(scene, pair, travel)
            });
            self.pairs.push(found);
        }
        self.seen = keys;
    }

    /// Forgets everything, so that the next call looks at every pair.
    pub fn clear(&mut self) {
        *self = Self { pairs_looked_at: self.pairs_looked_at, ..Self::default() };
    }

    /// The approaches found, in order.
    pub fn approaches(&self) -> impl Iterator<Item = &Approach> {
        self.pairs.iter().flat_map(|pair| &pair.approaches)
    }

    /// The deepest overlap, metres; zero without one.
    pub fn penetration(&self) -> f64 {
        self.pairs.iter().fold(0.0, |deepest, pair| (-pair.separation).max(deepest))
    }

    /// Pairs that overlap, with the depth, metres.
    pub fn overlaps(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        self.pairs.iter().filter(|pair| pair.separation < 0.0).map(|pair| (pair.bodies, -pair.separation))
    }

    /// A body that turns by more than [`MOST_TURN`] within reach of another, and the pair.
    pub fn whirling(&self) -> Option<(usize, [usize; 2])> {
        self.pairs.iter().find_map(|pair| Some((pair.whirls?, pair.bodies)))
    }

    fn look_at(&self, scene: &Scene, bodies: [usize; 2], travel: &[Travel]) -> Pair {
        let [a, b] = bodies;
        let place = |i: usize| Vector::from_array(scene.bodies()[i].pose.position);
        let offset = place(b) - place(a);
        let near = Near {
            outlines: [&self.outlines[a], &self.outlines[b]],
            origin: place(a),
            offset,
            tolerance: pair_tolerance(scene, &scene.bodies()[a], &scene.bodies()[b]),
            reach: reach(scene, a, &travel[a]) + reach(scene, b, &travel[b]),
            travel: [travel[a], travel[b]],
            bodies,
            friction: scene.pair_friction(a, b),
        };
        near.pair()
    }
}

/// Radians: beyond this the straight ways of the corners say nothing about where they go.
pub const MOST_TURN: f64 = 1.0;

/// How far beyond its outline a body may come within the step, metres, with the contact tolerance. No turn takes a corner
/// further than across.
fn reach(scene: &Scene, i: usize, [x, y, turn]: &Travel) -> f64 {
    let body = &scene.bodies()[i];
    super::tolerance_of(scene, body)
        + if body.fixed { 0.0 } else { x.hypot(*y) + turn.abs().min(2.0) * body.shape.radius() }
}

/// Two bodies that may meet. Everything is relative to the first one's centroid.
struct Near<'a> {
    outlines: [&'a Outline; 2],
    /// The first centroid in the world.
    origin: Vector,
    offset: Vector,
    tolerance: f64,
    reach: f64,
    travel: [Travel; 2],
    bodies: [usize; 2],
    friction: f64,
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

impl Near<'_> {
    fn pair(&self) -> Pair {
        let [a, b] = self.outlines;
        let (face_a, separation_a) = greatest_separation(a, b, self.offset);
        let (face_b, separation_b) = greatest_separation(b, a, -self.offset);
        let separation = separation_a.max(separation_b);
        let mut pair = Pair { bodies: self.bodies, approaches: Vec::new(), separation, whirls: None };
        if separation > self.reach {
            return pair;
        }
        // Of equal faces the first body's, so that rounding does not decide.
        let (reference, face) = if separation_b > separation_a + self.tolerance { (1, face_b) } else { (0, face_a) };
        let ends = self.ends(reference, face);
        pair.approaches = ends.into_iter().filter_map(|(owner, end)| self.approach(owner, &end)).collect();
        pair.approaches.sort_by_key(|approach| approach.id);
        if pair.approaches.is_empty() && separation > 0.0 {
            let met = self.first_met().map(|(owner, face)| (owner, self.end(owner, face, self.closest(owner, face))));
            pair.approaches.extend(met.map(|(owner, end)| self.between(owner, &end)));
        }
        pair.whirls = (0..2).find(|&k| self.travel[k][2].abs() > MOST_TURN).map(|k| self.bodies[k]);
        pair
    }

    /// Both ends of the shared span, each with the body (0 or 1) that owns the face.
    fn ends(&self, reference: usize, face: usize) -> [(usize, End); 2] {
        let incident = 1 - reference;
        let opposed = most_opposed(self.outlines[incident], self.outlines[reference].normals[face]);
        // Faces run counter-clockwise, so the incident one runs against the reference.
        let low = self.end(reference, face, self.outlines[incident].next(opposed));
        let high = self.end(reference, face, opposed);
        let beyond_low = low.along < -self.tolerance;
        let beyond_high = high.along > high.length + self.tolerance;
        let own = |corner: usize| (incident, self.end(incident, opposed, corner));
        [
            if beyond_low { own(face) } else { (reference, low) },
            if beyond_high { own(self.outlines[reference].next(face)) } else { (reference, high) },
        ]
    }

    /// The other body's corner against a face of `owner`.
    fn end(&self, owner: usize, face: usize, corner: usize) -> End {
        let origin = [Vector::ZERO, self.offset];
        let (outline, other) = (self.outlines[owner], self.outlines[1 - owner]);
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

    fn approach(&self, owner: usize, end: &End) -> Option<Approach> {
        if end.gap > self.reach || !self.meets(owner, end) {
            return None;
        }
        Some(self.between(owner, end))
    }

    fn between(&self, owner: usize, end: &End) -> Approach {
        let (feature, normal) = match owner {
            0 => (Feature::CornerOfB { a: end.face, b: end.corner }, end.normal),
            _ => (Feature::CornerOfA { a: end.corner, b: end.face }, -end.normal),
        };
        Approach {
            id: ContactId { bodies: self.bodies, feature },
            normal: normal.to_array(),
            corner: (self.origin + end.at).to_array(),
            arms: [end.at.to_array(), (end.at - self.offset).to_array()],
            gap: end.gap,
            friction: self.friction,
        }
    }

    /// Whether the corner is before the face, or comes to be so and through it within the step.
    fn meets(&self, owner: usize, end: &End) -> bool {
        let before = |along: f64| along >= -self.tolerance && along <= end.length + self.tolerance;
        if before(end.along) {
            return true;
        }
        // The first body's motion is subtracted; seen from the face's owner the corner moves by this.
        let shift = if owner == 0 { self.shift(end.at) } else { -self.shift(end.at) };
        before(end.along + end.normal.perp().dot(shift)) && end.gap + end.normal.dot(shift) < -self.tolerance
    }

    /// How far the second body's point goes relative to the first's, to first order.
    fn shift(&self, at: Vector) -> Vector {
        let of = |k: usize, arm: Vector| {
            let [x, y, turn] = self.travel[k];
            Vector::new(x, y) + turn * arm.perp()
        };
        of(1, at - self.offset) - of(0, at)
    }

    /// How far the second centroid goes relative to the first.
    fn drift(&self) -> Vector {
        let [a, b] = self.travel;
        Vector::new(b[0] - a[0], b[1] - a[1])
    }

    /// The face (of body 0 or 1) at which the second body, moved in a straight line, first meets the first: separating
    /// axes over the time of the step. None if they do not meet.
    fn first_met(&self) -> Option<(usize, usize)> {
        let drift = self.drift();
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let mut met: Option<(f64, usize, usize)> = None;
        for (owner, face) in [0, 1].into_iter().flat_map(|owner| self.faces(owner).map(move |face| (owner, face))) {
            let normal = self.outlines[owner].normals[face];
            let span = |k: usize| {
                let origin = if k == 0 { Vector::ZERO } else { self.offset };
                let along = self.outlines[k].vertices.iter().map(|v| normal.dot(*v + origin));
                along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [x.min(low), x.max(high)])
            };
            let ([own_low, own_high], [low, high]) = (span(owner), span(1 - owner));
            // How fast the other body moves outwards, seen from the face's owner.
            let speed = if owner == 0 { normal.dot(drift) } else { -normal.dot(drift) };
            let outside = low >= own_high;
            if speed == 0.0 {
                if outside || high <= own_low {
                    return None;
                }
                continue;
            }
            let times = [(own_high - low) / speed, (own_low - high) / speed];
            let first = times[0].min(times[1]);
            leave = leave.min(times[0].max(times[1]));
            if outside && met.is_none_or(|(latest, ..)| first > latest) {
                met = Some((first, owner, face));
            }
            enter = enter.max(first);
        }
        met.filter(|_| enter < leave).map(|(_, owner, face)| (owner, face))
    }

    fn faces(&self, owner: usize) -> std::ops::Range<usize> {
        0..self.outlines[owner].normals.len()
    }

    /// The other body's corner closest to the line of a face.
    fn closest(&self, owner: usize, face: usize) -> usize {
        let normal = self.outlines[owner].normals[face];
        let height = |k: &usize| normal.dot(self.outlines[1 - owner].vertices[*k]);
        self.faces(1 - owner).min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(0)
    }
}
