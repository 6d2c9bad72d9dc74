//! A contact on the way of `path.rs`: what it does, how far it is from doing something else, and how that changes with t.

use crate::{
    law::Part,
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
    /// E, m/s.
    error: [f64; D],
    /// `p - u`, m/s, and how it changes with t.
    z: [f64; D],
    rate: [f64; D],
    /// How p changes with t where u does not, m/s.
    pub push: [f64; D],
}

/// What a change adds to N: a sign times `left right'`. `back`: the edge by which it came.
pub(crate) struct Change<const D: usize> {
    pub back: usize,
    pub sign: f64,
    pub left: [f64; D],
    pub right: [f64; D],
}

impl<const D: usize> Place<D> {
    pub fn new<const B: usize>(system: &System<B, D>, state: &State<B, D>, k: usize, eps: f64) -> Self {
        let (local, u) = (&system.contacts[k], system.relative(k, &state.y));
        let p = state.p[k].map(|p| p * local.weight);
        let z: [f64; D] = std::array::from_fn(|i| p[i] - u[i]);
        let part = Part::of(local.friction, &z);
        let none = [0.0; D];
        let mut place =
            Self { part, sign: side_of(z[1]), friction: local.friction, error: none, z, rate: none, push: none };
        let obeys = place.impulse();
        place.error = std::array::from_fn(|i| p[i] - obeys[i]);
        place.find_push(eps);
        place
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

    fn find_push(&mut self, eps: f64) {
        let Self { error: e, sign, friction, .. } = *self;
        self.push = e.map(|e| -e);
        match self.part {
            Part::Parts => {}
            Part::Sticks => self.push.iter_mut().for_each(|push| *push /= eps),
            Part::Slides => {
                self.push[0] /= eps;
                self.push[1] += sign * friction * (self.push[0] + e[0]);
            }
        }
    }

    #[inline(always)]
    pub fn go(&mut self, t: f64) {
        (0..D).for_each(|i| self.z[i] += t * self.rate[i]);
    }

    /// From the rate of u.
    #[inline(always)]
    pub fn find_rate(&mut self, u: &[f64; D], eps: f64) {
        let Self { error: e, sign, friction, push, .. } = *self;
        match self.part {
            Part::Parts => (0..D).for_each(|i| self.rate[i] = (1.0 - eps) * push[i] - u[i]),
            Part::Sticks => (0..D).for_each(|i| self.rate[i] = push[i] - u[i] / eps + e[i]),
            Part::Slides => {
                self.rate[0] = push[0] - u[0] / eps + e[0];
                self.rate[1] = (1.0 - eps) * (push[1] - sign * friction * u[0] / eps) - u[1];
            }
        }
    }

    /// How far z is within the edges of what the contact does, and how fast that grows.
    #[inline(always)]
    pub fn edges(&self) -> [(f64, f64); 2] {
        const NONE: (f64, f64) = (1.0, 0.0);
        let along = |a: f64, b: f64| (a * self.z[0] + b * self.z[1], a * self.rate[0] + b * self.rate[1]);
        match self.part {
            Part::Parts => [along(-1.0, 0.0), NONE],
            Part::Sticks => [along(self.friction, -1.0), along(self.friction, 1.0)],
            Part::Slides if self.friction == 0.0 => [along(1.0, 0.0), NONE],
            Part::Slides => [along(1.0, 0.0), along(-self.friction, self.sign)],
        }
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
        self.find_push(eps);
        change
    }
}

fn side_of(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}
