//! The problem in its own unknowns `y = M^1/2 v`: the mass matrix is one, and a contact's rows are `J M^-1/2`.
//!
//! Unknowns lie in chunks of B: a rigid body is one, what a general mass matrix couples is as many as it needs. A contact has rows on
//! the chunks that it touches.

use crate::{
    law::{self, dot},
    local::Local,
    settings::MOST_FRICTION,
};

/// Contacts of D components over chunks of B unknowns.
#[derive(Debug, Clone, Default)]
pub(crate) struct System<const B: usize, const D: usize> {
    /// `M^1/2 v*`.
    pub free: Vec<[f64; B]>,
    pub contacts: Vec<Local<D>>,
    pub offsets: Vec<f64>,
    /// Cosine and sine by which the caller's tangents were turned.
    turns: Vec<[f64; 2]>,
    /// First side of every contact, and the number of sides.
    pub starts: Vec<u32>,
    /// Of every side its chunk and its rows.
    pub chunks: Vec<u32>,
    pub rows: Vec<[[f64; B]; D]>,
}

/// Velocities, impulses, and where sliding was found last.
#[derive(Debug, Clone, Default)]
pub(crate) struct State<const B: usize, const D: usize> {
    pub y: Vec<[f64; B]>,
    pub p: Vec<[f64; D]>,
    pub alpha: Vec<f64>,
}

impl<const B: usize, const D: usize> System<B, D> {
    pub fn new(free: Vec<[f64; B]>) -> Self {
        Self { free, starts: vec![0], ..Self::default() }
    }

    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Adds a contact whose rows on several chunks are these.
    pub fn push(&mut self, friction: f64, offset: f64, sides: impl Iterator<Item = (usize, [[f64; B]; D])>) {
        let first = self.rows.len();
        for (chunk, rows) in sides {
            self.chunks.push(chunk as u32);
            self.rows.push(rows);
        }
        let own = |rows: &[[[f64; B]; D]], i: usize, j: usize| rows.iter().map(|r| dot(&r[i], &r[j])).sum::<f64>();
        let mut turn = [1.0, 0.0];
        if D == 3 {
            let rows = &mut self.rows[first..];
            let (a, b, c) = (own(rows, 1, 1), own(rows, 1, 2), own(rows, 2, 2));
            // Jacobi's rotation: the smaller of the two angles.
            let angle = if b == 0.0 { 0.0 } else { 0.5 * (2.0 * b).atan2(a - c) };
            turn = [angle.cos(), angle.sin()];
            for side in rows {
                let (one, two) = (side[1], side[2]);
                for k in 0..B {
                    side[1][k] = turn[0] * one[k] + turn[1] * two[k];
                    side[2][k] = turn[0] * two[k] - turn[1] * one[k];
                }
            }
        }
        let rows = &self.rows[first..];
        let normal = std::array::from_fn(|k| own(rows, 0, k));
        let tangent = std::array::from_fn(|k| own(rows, k, k));
        self.contacts.push(Local::new(friction.min(MOST_FRICTION), normal, tangent));
        self.offsets.push(offset);
        self.turns.push(turn);
        self.starts.push(self.rows.len() as u32);
    }

    pub fn sides(&self, k: usize) -> std::ops::Range<usize> {
        self.starts[k] as usize..self.starts[k + 1] as usize
    }

    /// Relative velocity at a contact, the offset in its normal component.
    #[inline(always)]
    pub fn relative(&self, k: usize, y: &[[f64; B]]) -> [f64; D] {
        let mut u = self.change(k, y);
        u[0] += self.offsets[k];
        u
    }

    /// The same for a change of y: without the offset.
    #[inline(always)]
    pub fn change(&self, k: usize, y: &[[f64; B]]) -> [f64; D] {
        let mut u = [0.0; D];
        for side in self.sides(k) {
            let y = &y[self.chunks[side] as usize];
            for (u, row) in u.iter_mut().zip(&self.rows[side]) {
                *u += dot(row, y);
            }
        }
        u
    }

    /// Gives an impulse.
    #[inline(always)]
    pub fn give(&self, k: usize, p: &[f64; D], y: &mut [[f64; B]]) {
        for side in self.sides(k) {
            let y = &mut y[self.chunks[side] as usize];
            for (p, row) in p.iter().zip(&self.rows[side]) {
                for (y, row) in y.iter_mut().zip(row) {
                    *y += p * row;
                }
            }
        }
    }

    /// `y = y* + J' p`.
    pub fn move_by(&self, state: &mut State<B, D>) {
        state.y.copy_from_slice(&self.free);
        for (k, p) in state.p.iter().enumerate() {
            self.give(k, p, &mut state.y);
        }
    }

    pub fn state(&self) -> State<B, D> {
        State { y: self.free.clone(), p: vec![[0.0; D]; self.len()], alpha: vec![0.0; self.len()] }
    }

    /// Error of Coulomb's law at a contact, m/s.
    pub fn error_at(&self, k: usize, state: &State<B, D>) -> f64 {
        let local = &self.contacts[k];
        law::error(local.friction, &self.relative(k, &state.y), &state.p[k], local.weight)
    }

    /// The largest. Not a number where there is one that is not.
    pub fn error(&self, state: &State<B, D>) -> f64 {
        (0..self.len())
            .map(|k| self.error_at(k, state))
            .fold(0.0, |worst: f64, e| if worst.is_nan() || e <= worst { worst } else { e })
    }

    /// From the caller's tangents, or back to them.
    pub fn turned(&self, k: usize, p: &[f64; D], back: bool) -> [f64; D] {
        let mut turned = *p;
        if D == 3 {
            let [cos, sin] = self.turns[k];
            let sin = if back { -sin } else { sin };
            turned[1] = cos * p[1] + sin * p[2];
            turned[2] = cos * p[2] - sin * p[1];
        }
        turned
    }

    /// The contacts that are listed, over the chunks that are listed; `place` says where in the second list a chunk is.
    pub fn part(&self, contacts: &[usize], chunks: &[usize], place: &[u32]) -> Self {
        let mut part = Self::new(chunks.iter().map(|&chunk| self.free[chunk]).collect());
        for &k in contacts {
            part.contacts.push(self.contacts[k]);
            part.offsets.push(self.offsets[k]);
            part.turns.push(self.turns[k]);
            for side in self.sides(k) {
                part.chunks.push(place[self.chunks[side] as usize]);
                part.rows.push(self.rows[side]);
            }
            part.starts.push(part.rows.len() as u32);
        }
        part
    }
}
