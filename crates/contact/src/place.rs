//! A contact on a way (`way.rs`): what it does, how far it is from doing something else, and how that changes with t.

use crate::{
    law::{Part, dot},
    softened::Softened,
    system::{State, System},
};

/// A contact on the way.
#[derive(Clone, Copy)]
pub(crate) struct Place<const D: usize> {
    pub part: Part,
    /// The side to which it slides, or would.
    sign: f64,
    friction: f64,
    /// What is taken away of p, and of u, as t grows, m/s.
    off: [f64; D],
    off_of_u: [f64; D],
    /// `p - u` without what is taken away later, m/s, and how it changes with t.
    z: [f64; D],
    rate: [f64; D],
    /// How p changes with t where u does not, m/s.
    pub push: [f64; D],
    /// How z does: so much, less so many times the rate of u.
    base: [f64; D],
    by: [[f64; D]; D],
    /// How far z is within the two edges of what the contact does: so many times z. None is zero.
    edges: [[f64; D]; 2],
}

/// What a change adds to N: a sign times `left right'`. `back`: the edge by which it came.
pub(crate) struct Change<const D: usize> {
    pub back: usize,
    pub sign: f64,
    pub left: [f64; D],
    pub right: [f64; D],
}

impl<const D: usize> Place<D> {
    /// At a state that is in error: the error of the natural map goes, of p and of u.
    pub fn in_error<const B: usize>(system: &System<B, D>, state: &State<B, D>, k: usize, eps: f64) -> Self {
        let (local, u) = (&system.contacts[k], system.relative(k, &state.y));
        let p = state.p[k].map(|p| p * local.weight);
        let mut place = Self::at(local.friction, std::array::from_fn(|i| p[i] - u[i]));
        let obeys = place.impulse();
        place.off = std::array::from_fn(|i| p[i] - obeys[i]);
        place.off_of_u = place.off;
        place.settle(eps);
        place
    }

    /// Where nothing bears yet: `u` is the velocity there, and `raised` goes, which is added to it at t = 0.
    pub fn raised(friction: f64, u: &[f64; D], raised: &[f64; D], eps: f64) -> Self {
        let mut place = Self::at(friction, std::array::from_fn(|i| -u[i] - raised[i]));
        place.off_of_u = raised.map(|raised| -raised);
        place.settle(eps);
        place
    }

    fn at(friction: f64, z: [f64; D]) -> Self {
        let none = [0.0; D];
        let (part, sign) = (Part::of(friction, &z), side_of(z[1]));
        let (by, edges) = ([none; D], [none; 2]);
        Self { part, sign, friction, off: none, off_of_u: none, z, rate: none, push: none, base: none, by, edges }
    }

    /// `P(z)`, the impulse at t = 1, m/s.
    pub fn impulse(&self) -> [f64; D] {
        let mut p = [0.0; D];
        match self.part {
            Part::Parts => {}
            Part::Sticks => p = self.z,
            Part::Slides => (p[0], p[1]) = (self.z[0], self.sign * self.friction * self.z[0]),
        }
        p
    }

    /// For its N.
    pub fn softened(&self) -> Softened<D> {
        let mut z = self.z;
        z[1] = self.sign;
        Softened::with(self.part, self.friction, &z)
    }

    /// Finds all that depends on what the contact does.
    fn settle(&mut self, eps: f64) {
        let Self { off, off_of_u, sign, friction, .. } = *self;
        let none = [0.0; D];
        (self.push, self.by, self.edges) = (off.map(|off| -off), [none; D], [none; 2]);
        match self.part {
            Part::Parts => {
                for i in 0..D {
                    self.base[i] = (1.0 - eps) * self.push[i] + (off[i] - off_of_u[i]);
                    self.by[i][i] = 1.0;
                }
                self.edges[0][0] = -1.0;
            }
            Part::Sticks => {
                self.push = off_of_u.map(|off| -off / eps);
                for i in 0..D {
                    self.base[i] = self.push[i] + off[i];
                    self.by[i][i] = 1.0 / eps;
                }
                (self.edges[0][0], self.edges[0][1]) = (friction, -1.0);
                (self.edges[1][0], self.edges[1][1]) = (friction, 1.0);
            }
            Part::Slides => {
                self.push[0] = -off_of_u[0] / eps;
                self.push[1] += sign * friction * (self.push[0] + off[0]);
                self.base[0] = self.push[0] + off[0];
                self.base[1] = (1.0 - eps) * self.push[1] + (off[1] - off_of_u[1]);
                self.by[0][0] = 1.0 / eps;
                (self.by[1][0], self.by[1][1]) = ((1.0 - eps) * sign * friction / eps, 1.0);
                self.edges[0][0] = 1.0;
                if friction > 0.0 {
                    (self.edges[1][0], self.edges[1][1]) = (-friction, sign);
                }
            }
        }
    }

    #[inline(always)]
    pub fn go(&mut self, t: f64) {
        (0..D).for_each(|i| self.z[i] += t * self.rate[i]);
    }

    /// From the rate of u.
    #[inline(always)]
    pub fn find_rate(&mut self, u: &[f64; D]) {
        (0..D).for_each(|i| self.rate[i] = self.base[i] - dot(&self.by[i], u));
    }

    /// How far z is within the edges of what the contact does, and how fast that grows.
    #[inline(always)]
    pub fn edges(&self) -> [(f64, f64); 2] {
        self.edges.map(|edge| (dot(&edge, &self.z), dot(&edge, &self.rate)))
    }

    pub fn cross(&mut self, edge: usize, eps: f64) -> Change<D> {
        let (mut normal, mut tangent) = ([0.0; D], [0.0; D]);
        (normal[0], tangent[1]) = (1.0, 1.0);
        let change = match (self.part, edge) {
            (Part::Parts, _) | (Part::Slides, 0) => {
                let bears = self.part == Part::Parts;
                self.part = if bears { Part::Slides } else { Part::Parts };
                if bears {
                    self.sign = side_of(self.z[1]);
                }
                normal[1] = self.sign * self.friction;
                let mut right = normal;
                right[1] = 0.0;
                Change { back: 0, sign: if bears { 1.0 } else { -1.0 }, left: normal, right }
            }
            _ => {
                let sticks = self.part == Part::Slides;
                if sticks {
                    self.part = Part::Sticks;
                } else {
                    (self.part, self.sign) = (Part::Slides, [1.0, -1.0][edge]);
                }
                let mut right = tangent;
                right[0] = -self.sign * self.friction;
                let back = if sticks { usize::from(self.sign < 0.0) } else { 1 };
                Change { back, sign: if sticks { 1.0 } else { -1.0 }, left: tangent, right }
            }
        };
        self.settle(eps);
        change
    }
}

fn side_of(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}
