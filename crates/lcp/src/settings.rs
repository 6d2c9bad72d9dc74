//! Every tolerance: what it bounds, in which unit, and why it has that value.

use serde::{Deserialize, Serialize};

/// Tolerances and limits of a solve.
///
/// The problem is scaled first so that M has a unit diagonal; "own scale" below is the larger of the largest
/// entry of the scaled `q` and the largest entry of the scaled `z`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// A row is violated when `w_i` is below minus this, in the problem's own scale. Rounding in `M z + q` with
    /// a few hundred terms is near 1e-14; 1e-11 leaves room for it and stays 100 times under `residual`.
    pub feasibility: f64,
    /// A Schur complement at or below this (unit diagonal, times the direction's largest entry) counts as
    /// zero: the row depends on the active ones. Two contact points 1e-6 of a block apart give 1e-12.
    pub singular: f64,
    /// A component of a pivoting direction at or below this, relative to the direction's largest entry, does
    /// not block a step: it is rounding, and a pivot on it would lose all accuracy.
    pub pivot: f64,
    /// A solve counts as solved when its residual, in the problem's own scale, is at most this.
    pub residual: f64,
    /// Most pivots in one solve; `None` means 50 n + 1000, in Lemke's method for each of its paths. Principal pivoting ends by itself (it never cycles), but its
    /// worst case is exponential (Murty 1978). With a limit no pivots are made beyond it to prove what rounding leaves in doubt: such a solve
    /// ends with numerical trouble sooner.
    pub pivot_limit: Option<usize>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { feasibility: 1e-11, singular: 1e-12, pivot: 1e-10, residual: 1e-9, pivot_limit: None }
    }
}

impl Settings {
    pub(crate) fn pivot_limit_for(&self, n: usize) -> usize {
        self.pivot_limit.unwrap_or(50 * n + 1000)
    }
}

/// Least `-q' y` for y with the sum 1 of a ray that counts, where the largest entry of q is 1 on the rows that share an entry
/// of M with y. If `M = G' G` and `q = -G' h`, the problem has a solution, and still `-q' y = h' G y` is as large as the root of `y' M y`: what rounding hides in M, sixteen units in the last place,
/// hides 6e-8 in q. Below this no ray says anything.
pub(crate) const PROGRESS: f64 = 1e-7;
