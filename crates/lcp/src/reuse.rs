//! Computation reuse: a solve started from the solution of a principal sub-problem.
//!
//! Theorem 1 of Loomis and Balkcom (2006): if `(z1, w1)` solves the principal sub-problem `(M11, q1)` on k indices, then
//! `([z1 0], [w1, M21 z1 + q2])` is complementary for `(M, q)` and at most n - k rows are violated, so Dantzig's
//! method ends in at most n - k major cycles. Valid when `M11` and `q1` are exactly the rows and columns of `M` and `q` on
//! those indices; that is checked, because a start from another problem gives a violated row among them.

use crate::{
    error::StartError,
    interrupt::{apart, poll},
    problem::Problem,
    scaling::Scaling,
};
use faer::{Mat, linalg::solvers::Solve};
use serde::{Deserialize, Serialize};

/// A named start: `z` solves the principal sub-problem on `indices`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Rows of the complete problem that the sub-problem has, in its order (k).
    pub indices: Vec<usize>,
    /// Solution of the sub-problem (k).
    pub z: Vec<f64>,
}

/// A pair with both sides above this, in the problem's own scale, is not complementary (validity of a start).
const TOLERANCE: f64 = 1e-9;

impl Start {
    /// A start from a guess which rows have `z > 0`: `M_CC z_C = -q_C` on those rows C solves the sub-problem on them if no
    /// `z` is negative. None if one is, or if the rows depend on one another. Any M; dense, by LU.
    pub fn from_active(problem: &Problem, active: &[usize]) -> Option<Self> {
        let k = active.len();
        let entry = |i: usize, j: usize| {
            poll(16);
            problem.m().get(active[i], active[j])
        };
        let block = Mat::from_fn(k, k, entry);
        let right = Mat::from_fn(k, 1, |i, _| -problem.q()[active[i]]);
        let (block, right, solved) = apart(k * k * k, move || {
            let solved = block.partial_piv_lu().solve(&right);
            (block, right, solved)
        });
        let d = Scaling::new(problem).d;
        let size = (0..k).map(|i| (solved[(i, 0)] / d[active[i]]).abs().max((right[(i, 0)] * d[active[i]]).abs()));
        let zero = TOLERANCE * size.fold(0.0, f64::max);
        let rest = &right - &block * &solved;
        let holds = |i: usize| (d[active[i]] * rest[(i, 0)]).abs() <= zero && solved[(i, 0)] / d[active[i]] >= -zero;
        let z = (0..k).map(|i| solved[(i, 0)].max(0.0)).collect();
        (0..k).all(holds).then_some(Self { indices: active.to_vec(), z })
    }

    /// z of a complete problem of n rows: zero on those that the sub-problem does not have.
    ///
    /// # Panics
    /// If an index is not below n.
    pub fn spread(&self, n: usize) -> Vec<f64> {
        let mut z = vec![0.0; n];
        self.indices.iter().zip(&self.z).for_each(|(&row, &value)| z[row] = value);
        z
    }

    /// Checks what can be checked without the matrix.
    ///
    /// # Errors
    /// The first [`StartError`] found.
    pub(crate) fn require_well_formed(&self, n: usize) -> Result<(), StartError> {
        if self.indices.len() != self.z.len() {
            return Err(StartError::Length { indices: self.indices.len(), values: self.z.len() });
        }
        let mut seen = vec![false; n];
        for (&index, &value) in self.indices.iter().zip(&self.z) {
            if index >= n {
                return Err(StartError::OutOfRange { index, n });
            }
            if std::mem::replace(&mut seen[index], true) {
                return Err(StartError::Repeated { index });
            }
            if !value.is_finite() || value < 0.0 {
                return Err(StartError::Infeasible { index, value });
            }
        }
        Ok(())
    }

    /// Checks that a pair, scaled to a unit diagonal by `d` (n), solves the sub-problem. `q_size` is its largest scaled `q`.
    ///
    /// # Errors
    /// The first [`StartError`] found.
    pub(crate) fn require_complementary(&self, z: &[f64], w: &[f64], d: &[f64], q_size: f64) -> Result<(), StartError> {
        let tolerance = TOLERANCE * self.indices.iter().fold(q_size, |size, &i| size.max(z[i].abs()));
        for &index in &self.indices {
            let unscaled = w[index] / d[index];
            if w[index] < -tolerance {
                return Err(StartError::Violated { index, w: unscaled });
            }
            if z[index] > tolerance && w[index] > tolerance {
                return Err(StartError::NotComplementary { index, z: z[index] * d[index], w: unscaled });
            }
        }
        Ok(())
    }
}
