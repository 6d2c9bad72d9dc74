//! One way through the sets of contacts that part, stick and slide, one change after the other; in the plane.
//!
//! Along it `p - (1 - t) a` and `u - (1 - t) b` obey the law; a and b say where it begins. In the plane all is linear in t as long as no contact
//! changes what it does, and `z`, the difference of these two, tells which one does so first. Then it changes, and the way goes on, forward
//! or backward in t, until t = 1. So Lemke's method goes through complementary bases, and a parametric active-set method through active sets.
//!
//! Each contact gives way by eps about its impulses at the beginning, so that every set has one solution. A change is one of rank one to the
//! matrix of Newton's method, whose factors are updated.
//!
//! Lemke, Bimatrix equilibrium points and mathematical programming, 1965; Eaves and Scarf, The solution of systems of piecewise linear
//! equations, 1976.

use crate::{
    law::Part,
    newton::Newton,
    place::{Change, Place},
    system::{State, System},
};
use drystone_lcp::interrupt::poll;

/// A change of the same contact at the same t, to this, with all contacts doing what they did then, is the same one: the way is closed, and t = 1 is
/// not on it.
const SAME: f64 = 1e-12;
/// How far back t may go.
const BACK: f64 = -10.0;
/// Updates of the factors after which they are made anew.
const UPDATES: usize = 40;

/// Where the way is.
pub(crate) struct Way<'a, const B: usize, const D: usize> {
    system: &'a System<B, D>,
    newton: &'a mut Newton<B, D>,
    eps: f64,
    places: Vec<Place<D>>,
    /// How velocities change with t where no contact gives way to them: the right side of Newton's method.
    push: Vec<[f64; B]>,
    /// Updates since the matrix was factored.
    updates: usize,
    /// What is updated: buffer.
    sides: Vec<(u32, [f64; B], [f64; B])>,
}

impl<'a, const B: usize, const D: usize> Way<'a, B, D> {
    /// From where every contact is, each made with the same eps.
    pub fn new(system: &'a System<B, D>, newton: &'a mut Newton<B, D>, places: Vec<Place<D>>, eps: f64) -> Self {
        let push = vec![[0.0; B]; system.free.len()];
        let mut way = Self { system, newton, eps, places, push, updates: UPDATES, sides: Vec::new() };
        (0..system.len()).for_each(|k| way.push(k, 1.0));
        way
    }

    /// Follows the way to t = 1, in `most` changes, and leaves there what contacts do, and its matrix. `state` is where it ends then. Counts the matrices.
    /// False if it does not arrive, as where it is a loop.
    pub fn follow(mut self, state: &mut State<B, D>, most: usize, steps: &mut usize) -> bool {
        let (mut t, mut gone) = (0.0, 0.0);
        let mut changed: Option<(usize, usize)> = None;
        // Where it was after 1, 2, 4, ... changes (Brent's way to find a cycle). Forces may differ where velocities are the same.
        let (mut mark, mut parts) = ((usize::MAX, f64::NAN), Vec::new());
        for made in 0..most {
            *steps += 1;
            if !self.find_direction() {
                return false;
            }
            let forward = changed.is_none_or(|(k, edge)| self.grows(k, edge));
            let (direction, longest) = if forward { (1.0, 1.0 - t) } else { (-1.0, f64::INFINITY) };
            let (length, first) = self.first_change(gone, changed.map(|(k, _)| k), direction, longest);
            gone = direction * length;
            t += gone;
            if t.is_nan() || t < BACK {
                return false;
            }
            let Some((k, edge)) = first else {
                self.end(state, gone);
                return true;
            };
            if mark.0 == k && (t - mark.1).abs() < SAME && self.parts().eq(parts.iter().copied()) {
                return false;
            }
            if made.is_power_of_two() {
                mark = (k, t);
                parts.clear();
                parts.extend(self.parts());
            }
            changed = Some((k, self.change(k, edge, gone)));
        }
        false
    }

    /// What contacts do.
    fn parts(&self) -> impl Iterator<Item = Part> {
        self.places.iter().map(|place| place.part)
    }

    /// Adds a contact's part of `push`, or takes it away.
    fn push(&mut self, k: usize, sign: f64) {
        let weight = sign / self.system.contacts[k].weight;
        self.system.give(k, &self.places[k].push.map(|p| p * weight), &mut self.push);
    }

    /// How velocities change with t. False if the matrix has no inverse.
    fn find_direction(&mut self) -> bool {
        let Self { system, newton, eps, places, .. } = self;
        poll(16 * B * B * system.len());
        if self.updates == UPDATES {
            newton.contacts.clear();
            newton.contacts.extend(places.iter().map(Place::softened));
            newton.assemble(system, *eps);
            if !newton.matrix.factor() {
                return false;
            }
            self.updates = 0;
        }
        newton.left.clone_from(&self.push);
        newton.matrix.solve(&mut newton.left);
        true
    }

    /// Whether a contact that has crossed an edge goes on into what it does now as t grows.
    fn grows(&mut self, k: usize, edge: usize) -> bool {
        let u = self.system.change(k, &self.newton.left);
        self.places[k].find_rate(&u);
        self.places[k].edges()[edge].1 >= 0.0
    }

    /// Goes to where the last direction ended, but for the contact that is there already; then how far t may go in this one until a contact
    /// changes, or `longest`, which one does so, and at which edge.
    fn first_change(
        &mut self,
        gone: f64,
        there: Option<usize>,
        direction: f64,
        longest: f64,
    ) -> (f64, Option<(usize, usize)>) {
        let (mut length, mut first) = (longest, None);
        for (k, place) in self.places.iter_mut().enumerate() {
            if there != Some(k) {
                place.go(gone);
            }
            place.find_rate(&self.system.change(k, &self.newton.left));
            for (edge, (distance, rate)) in place.edges().into_iter().enumerate() {
                let rate = direction * rate;
                if rate < 0.0 && distance < -rate * length {
                    (length, first) = (distance.max(0.0) / -rate, Some((k, edge)));
                }
            }
        }
        (length, first)
    }

    /// A contact crosses an edge of what it does, which it has come to. Returns which edge that is of what it does then.
    fn change(&mut self, k: usize, edge: usize, gone: f64) -> usize {
        self.places[k].go(gone);
        self.push(k, -1.0);
        let Change { back, sign, left, right } = self.places[k].cross(edge, self.eps);
        self.push(k, 1.0);
        let system = self.system;
        let along = |rows: &[[f64; B]; D], by: &[f64; D]| -> [f64; B] {
            std::array::from_fn(|c| (0..D).map(|d| by[d] * rows[d][c]).sum())
        };
        let side = |at: usize| (system.chunks[at], along(&system.rows[at], &left), along(&system.rows[at], &right));
        self.sides.clear();
        self.sides.extend(system.sides(k).map(side));
        let updated = self.newton.matrix.update(sign / (self.eps * system.contacts[k].weight), &self.sides);
        self.updates = if updated { self.updates + 1 } else { UPDATES };
        back
    }

    fn end(&mut self, state: &mut State<B, D>, gone: f64) {
        self.places.iter_mut().for_each(|place| place.go(gone));
        self.newton.parts.clear();
        self.newton.parts.extend(self.places.iter().map(|place| place.part));
        for ((p, place), local) in state.p.iter_mut().zip(&self.places).zip(&self.system.contacts) {
            *p = place.impulse().map(|p| p / local.weight);
        }
        self.system.move_by(state);
    }
}
