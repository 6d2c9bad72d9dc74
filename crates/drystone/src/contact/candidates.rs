//! Contacts that are closed, or that may close within a time step: a point of one block before a face of another.
//!
//! `find_contacts` says what touches now; a time step also needs what will touch before it ends. A candidate is a material point
//! where two blocks may press, a normal, and how far it is from closing there:
//!
//! ```text
//!     gap = n . (point - face),     d gap / dt = n . (velocity of b at the point - velocity of a at the point)
//! ```
//!
//! exactly, turning of the face included, because the velocity of the face's block is taken at the same point. Which points
//! there are is a matter of the shape: `candidates_in_plane.rs`, `candidates_in_space.rs`. Here they are kept pair by pair.

use super::{ContactId, broad_phase, pair_tolerance, tolerance_of};
use crate::bounds::MOST_FRICTION_IN_MOTION;
use crate::{
    geometry::{Numbers, Shape, norm},
    interrupt::poll,
    scene::{Body, SceneOf},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// A point where two blocks may press on one another within the step. `V` is a vector, `L` the levers of a point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CandidateContact<V = [f64; 2], L = [[f64; 2]; 1]> {
    /// Which features meet; `bodies` are the indices of the two blocks, the lower first.
    pub id: ContactId,
    /// Unit vector from `bodies[0]` into `bodies[1]`.
    pub normal: V,
    /// The point, world coordinates, metres.
    pub point: V,
    /// Of either block: the velocity of the point for one radian per second of each of its turnings, metres.
    pub levers: [L; 2],
    /// Distance of the point from the face, metres; negative within the block.
    pub gap: f64,
    /// Coefficient of friction of the pair.
    pub friction: f64,
}

/// The candidate of a shape.
pub type CandidateOf<S> = CandidateContact<<S as Shape>::Vector, <S as Colliding>::Levers>;

impl<V: PartialEq, L: PartialEq> CandidateContact<V, L> {
    /// Whether the generators are the same: everything but the gap.
    pub fn same_geometry(&self, other: &Self) -> bool {
        self.id == other.id
            && self.normal == other.normal
            && self.levers == other.levers
            && self.friction == other.friction
    }
}

/// Shapes of which it is known where they can meet.
pub trait Colliding: Shape + Send + Sync + 'static {
    /// How fast a body moves, or how far: along the axes of the world (m/s or m), then its turning (rad/s or rad), in space about its
    /// principal axes.
    type Velocity: Numbers;

    /// One vector for each turning: what it gives a point.
    type Levers: Copy + Debug + PartialEq + AsRef<[Self::Vector]> + Serialize + DeserializeOwned + Send + Sync + 'static;

    /// A block turned into world axes, about its centroid, so that nothing is lost far from the world's origin.
    type Outline: Clone + Debug + Send + Sync;

    /// See [`Self::Outline`].
    fn outline(body: &Body<Self>) -> Self::Outline;

    /// The levers of a point at the end of `arm` from the centroid.
    fn levers(outline: &Self::Outline, arm: Self::Vector) -> Self::Levers;

    /// Where two blocks may meet.
    fn meet(near: &Near<'_, Self>) -> Meeting<Self>;

    /// Where two convex pieces of them, of which nothing is before a face of the other, first meet on the ways that
    /// `near.travel` says. They do not if they come to be no deeper than `allowed` in one another, metres.
    fn first_met(near: &Near<'_, Self>, pieces: [usize; 2], allowed: f64) -> Vec<CandidateOf<Self>>;
}

/// Two bodies that may meet. Everything is relative to the first one's centroid.
pub struct Near<'a, S: Colliding> {
    /// Indices of the two.
    pub bodies: [usize; 2],
    /// What they are.
    pub outlines: [&'a S::Outline; 2],
    /// The two centroids in the world, metres.
    pub places: [S::Vector; 2],
    /// Contact tolerance of the pair, metres.
    pub tolerance: f64,
    /// Nothing that is further apart can close within the step, metres.
    pub reach: f64,
    /// How far each goes if nothing stops it.
    pub travel: [S::Velocity; 2],
    /// Coefficient of friction of the pair.
    pub friction: f64,
}

/// What was found of a pair.
pub struct Meeting<S: Colliding> {
    /// In any order.
    pub candidates: Vec<CandidateOf<S>>,
    /// Convex pieces, of the first and of the second, that are not deeper in one another than the tolerance and of which nothing
    /// is before a face of the other. Whether and where they meet depends on their ways: [`Colliding::first_met`].
    pub open: Vec<[usize; 2]>,
    /// The greatest separation over all planes that may part them, metres: negative by the depth of an overlap.
    pub separation: f64,
}

/// Candidates of a scene at one moment, in the order of (body, body, feature), kept pair by pair.
#[derive(Debug, Clone)]
pub struct CandidateFinder<S: Colliding> {
    outlines: Vec<S::Outline>,
    /// What the outlines and pairs were found for.
    seen: Vec<(S::Pose, S::Velocity)>,
    pairs: Vec<Pair<S>>,
    /// Pairs looked at since the finder was made: a measure of the work done.
    pub pairs_looked_at: usize,
    /// Goes up whenever the candidates may have changed.
    pub revision: u64,
}

#[derive(Debug, Clone)]
struct Pair<S: Colliding> {
    bodies: [usize; 2],
    candidates: Vec<CandidateOf<S>>,
    /// See [`Meeting`].
    open: Vec<[usize; 2]>,
    /// See [`Meeting`].
    separation: f64,
    /// One of them that turns too far in the step for its points' ways to be straight.
    turns_too_far: Option<usize>,
}

impl<S: Colliding> Default for CandidateFinder<S> {
    fn default() -> Self {
        Self { outlines: Vec::new(), seen: Vec::new(), pairs: Vec::new(), pairs_looked_at: 0, revision: 0 }
    }
}

/// Operations to look at a pair, about.
const PAIR: usize = 1000;

impl<S: Colliding> CandidateFinder<S> {
    /// Finds every candidate within the bodies' travel. Pairs of which neither the place nor the travel has changed since the
    /// last call are not looked at again.
    pub fn find(&mut self, scene: &SceneOf<S>, travel: &[S::Velocity]) {
        let bodies = scene.bodies();
        let keys: Vec<_> = bodies.iter().zip(travel).map(|(body, travel)| (body.pose, *travel)).collect();
        if keys == self.seen {
            return;
        }
        self.revision += 1;
        let changed: Vec<bool> = (0..keys.len()).map(|i| self.seen.get(i) != Some(&keys[i])).collect();
        self.outlines.truncate(bodies.len());
        for (i, body) in bodies.iter().enumerate() {
            match self.outlines.get_mut(i) {
                Some(outline) if self.seen[i].0 != keys[i].0 => *outline = S::outline(body),
                Some(_) => {}
                None => self.outlines.push(S::outline(body)),
            }
        }
        let before = std::mem::take(&mut self.pairs);
        let mut known = before.into_iter().peekable();
        for pair in broad_phase::pairs_within(bodies, |i| reach(scene, i, &travel[i])) {
            poll(PAIR);
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
        *self = Self { pairs_looked_at: self.pairs_looked_at, revision: self.revision + 1, ..Self::default() };
    }

    /// The candidates found, in order.
    pub fn candidates(&self) -> impl Iterator<Item = &CandidateOf<S>> {
        self.pairs.iter().flat_map(|pair| &pair.candidates)
    }

    /// Where bodies meet that go these ways and of which nothing is before a face of the other. Which plane parts two corners or
    /// edges is a matter of the ways that the bodies really go: before what holds them is known, gravity would pull a block that
    /// slides over a floor through the top of its next tile, and so against the tile's side.
    ///
    /// Bodies that are at rest meet where they close at all, others where they come to be in one another by more than the contact
    /// tolerance: what slides goes over what is within it.
    pub fn met(
        &self,
        scene: &SceneOf<S>,
        travel: &[S::Velocity],
        at_rest: impl Fn(usize) -> bool,
    ) -> Vec<CandidateOf<S>> {
        let farthest = |&i: &usize| shift::<S>(&travel[i]) + turn::<S>(&travel[i]) * scene.bodies()[i].shape.radius();
        let mut met: Vec<CandidateOf<S>> = Vec::new();
        for pair in self.pairs.iter().filter(|pair| !pair.open.is_empty()) {
            let near = self.near(scene, pair.bodies, travel);
            let allowed = if pair.bodies.iter().all(|&i| at_rest(i)) { 0.0 } else { near.tolerance };
            let least = (pair.separation + allowed).max(CLOSES * near.tolerance);
            if pair.bodies.iter().map(farthest).sum::<f64>() > least {
                met.extend(pair.open.iter().flat_map(|&pieces| S::first_met(&near, pieces, allowed)));
            }
        }
        met
    }

    /// Whether what meets there was found by [`Self::met`].
    pub fn is_open(&self, id: &ContactId) -> bool {
        let pair = self.pairs.binary_search_by_key(&id.bodies, |pair| pair.bodies);
        pair.is_ok_and(|k| self.pairs[k].open.contains(&id.pieces()))
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
    pub fn turns_too_far(&self) -> Option<(usize, [usize; 2])> {
        self.pairs.iter().find_map(|pair| Some((pair.turns_too_far?, pair.bodies)))
    }

    fn look_at(&self, scene: &SceneOf<S>, bodies: [usize; 2], travel: &[S::Velocity]) -> Pair<S> {
        let near = self.near(scene, bodies, travel);
        let Meeting { mut candidates, open, separation } = S::meet(&near);
        candidates.sort_by_key(|candidate| candidate.id);
        let turns_too_far = bodies.into_iter().find(|&i| separation <= near.reach && turn::<S>(&travel[i]) > MOST_TURN);
        Pair { bodies, candidates, open, separation, turns_too_far }
    }

    fn near(&self, scene: &SceneOf<S>, bodies: [usize; 2], travel: &[S::Velocity]) -> Near<'_, S> {
        let [a, b] = bodies.map(|i| &scene.bodies()[i]);
        Near {
            bodies,
            outlines: bodies.map(|i| &self.outlines[i]),
            places: [a, b].map(|body| S::place(&body.pose)),
            tolerance: pair_tolerance(scene, a, b),
            reach: bodies.iter().map(|&i| reach(scene, i, &travel[i])).sum(),
            travel: bodies.map(|i| travel[i]),
            friction: scene.pair_friction(bodies[0], bodies[1]).min(MOST_FRICTION_IN_MOTION),
        }
    }
}

/// Finds where two convex bodies first meet on straight ways, from all faces of their Minkowski difference: at that beyond which
/// they are last by more than the contact tolerance.
pub(super) struct FirstMet<P> {
    tolerance: f64,
    allowed: f64,
    /// Times of entry and exit, in steps.
    enter: f64,
    leave: f64,
    last: Option<(f64, P)>,
}

/// A face that closes in a step by no more than this share of the contact tolerance does not close: what is left of the speeds of a
/// solved step, 1e-9 m/s, is of this size, and a weight without support closes by far more.
const CLOSES: f64 = 1e-6;

impl<P: Copy> FirstMet<P> {
    /// The tolerance, and how deep they may come to be in one another without meeting, metres.
    pub fn new(tolerance: f64, allowed: f64) -> Self {
        Self { tolerance, allowed, enter: 0.0, leave: 1.0, last: None }
    }

    /// Takes a face with its gap (m) and what is added to it in the step (m). None if they never meet because of it.
    pub fn see(&mut self, face: P, gap: f64, opening: f64) -> Option<()> {
        let before = gap + self.allowed;
        if gap > -self.tolerance {
            if opening >= -CLOSES * self.tolerance || before >= -opening {
                return None;
            }
            self.enter = self.enter.max(before / -opening);
            let beyond = (gap + self.tolerance) / -opening;
            if self.last.is_none_or(|(last, _)| beyond > last) {
                self.last = Some((beyond, face));
            }
        } else if opening > 0.0 {
            self.leave = self.leave.min(-before / opening);
        }
        Some(())
    }

    /// The face, and the time halfway between entry and exit; None if they do not meet within the step.
    pub fn found(self) -> Option<(P, f64)> {
        let (_, face) = self.last.filter(|_| self.enter < self.leave)?;
        Some((face, 0.5 * (self.enter + self.leave)))
    }
}

/// Radians: beyond this the straight ways of the points say nothing about where they go.
pub const MOST_TURN: f64 = 1.0;

/// How far a body turns, radians, or how fast, rad/s.
pub(crate) fn turn<S: Colliding>(velocity: &S::Velocity) -> f64 {
    norm(&velocity.as_ref()[S::Vector::default().as_ref().len()..])
}

/// How far a centroid goes, metres, or how fast, m/s.
pub(crate) fn shift<S: Colliding>(velocity: &S::Velocity) -> f64 {
    norm(&velocity.as_ref()[..S::Vector::default().as_ref().len()])
}

/// How far beyond its outline a body may come within the step, metres, with the contact tolerance. No turn takes a point
/// further than across.
fn reach<S: Colliding>(scene: &SceneOf<S>, i: usize, travel: &S::Velocity) -> f64 {
    let body = &scene.bodies()[i];
    let way = shift::<S>(travel) + turn::<S>(travel).min(2.0) * body.shape.radius();
    tolerance_of(scene, body) + if body.fixed { 0.0 } else { way }
}
