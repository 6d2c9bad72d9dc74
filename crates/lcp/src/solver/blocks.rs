//! Block principal pivoting: all infeasible rows are exchanged at once, while that gets anywhere.
//!
//! On an active set C take `z_C = -M_CC^-1 q_C`, and `w = M z + q` elsewhere. All rows with `z_i < 0` leave C and all with
//! `w_j < 0` enter it, until there are none. That may run in a circle, so it is given up after some exchanges without
//! progress, and Dantzig's method, which ends, goes on from the best state with z >= 0 on the way.
//!
//! With a singular M a row enters only if the block clearly stays nonsingular, which is looked at row by row as they
//! enter, the most violated first. Rows that depend on C wait: where `q` lies in the range of `M`, as in contact problems,
//! their `w` is zero whenever `w_C` is.
//!
//! Kostreva, Block pivot methods for solving the complementarity problem (1978); Judice and Pires, A block principal
//! pivoting algorithm for large-scale strictly monotone linear complementarity problems (1994); Kim and Park, Fast
//! nonnegative matrix factorization: an active-set-like method and comparisons (2011).

use super::{Ends, Role, Snapshot, Solver, largest};
use crate::{error::LcpError, solution::Status};

/// Exchanges without progress after which the block method is given up. Judice and Pires allow 10 and Kim and Park 3; with
/// singular matrices the exchanges that lead nowhere are the larger part, so a smaller number costs less
/// (`docs/theory/block-pivoting.md`). Definite ones need a second chance now and then.
const PATIENCE: usize = 2;
/// A lower energy counts as progress if it is lower by more than this share of it: above rounding.
const LOWER: f64 = 1e-12;
/// A row enters with a Schur complement above this share of the direction's squared size (unit diagonal), far above the
/// rounding in it. Rows that are nearly dependent are left to Dantzig's method, which looks more closely.
const CLEAR: f64 = 1e-8;
/// Corrections of `z_C` after each exchange; each gains the digits that the factor has.
const CORRECTIONS: usize = 3;

/// What tells that block exchanges do not run in a circle.
///
/// Either the number of infeasible rows is less than ever before, or z is feasible, and so the minimum of the energy
/// `z' M z / 2 + q' z` over all vectors that are zero outside C, and lower than all such minima before. The first can
/// happen n times, the second at most once for every C: so the exchanges end.
struct Progress {
    infeasible: usize,
    energy: f64,
    patience: usize,
}

impl Progress {
    fn new() -> Self {
        Self { infeasible: usize::MAX, energy: f64::INFINITY, patience: PATIENCE }
    }

    /// Whether to go on from a state with so many infeasible rows and, if its z is feasible, this energy.
    fn goes_on(&mut self, infeasible: usize, energy: Option<f64>) -> bool {
        let energy = energy.unwrap_or(f64::INFINITY);
        let lower = energy < self.energy && (self.energy.is_infinite() || self.energy - energy > LOWER * energy.abs());
        if infeasible < self.infeasible || lower {
            self.infeasible = self.infeasible.min(infeasible);
            self.energy = self.energy.min(energy);
            self.patience = PATIENCE;
            return true;
        }
        self.patience -= 1;
        self.patience > 0
    }
}

impl Solver {
    /// As [`Self::solve`], with block exchanges first: all infeasible rows at once. The answer is the same, `w` is unique.
    ///
    /// Counts: a block exchange is a major cycle, every row that it moves a pivot. Where Dantzig's method takes over, its
    /// cycles count as always.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_by_blocks(&mut self) -> Result<Status, LcpError> {
        let solved = self.answer(|solver, limit| {
            solver.exchange_blocks(limit);
            solver.solve_present(Ends::at(limit), &mut || true)
        });
        Ok(solved?.expect("nobody stops it"))
    }

    /// Exchanges blocks until nothing is infeasible, or else goes back to the best of the complementary states on the way.
    fn exchange_blocks(&mut self, limit: usize) {
        if !self.settled {
            self.settle();
        }
        let mut progress = Progress::new();
        let mut best = self.snapshot();
        while self.balance_active() {
            let (leaving, entering) = (self.negative_z(), self.violated_rows());
            let infeasible = leaving.len() + entering.len();
            if infeasible == 0 {
                return;
            }
            let energy = leaving.is_empty().then(|| self.energy());
            if energy.is_some_and(|energy| energy < progress.energy) {
                best = self.snapshot();
            }
            // After the exchange there may be all of its active rows to take out again, and those of the best state to put in.
            let back = self.active.members().len() + entering.len() + best.active.len();
            if self.counts.pivots + infeasible + back > limit || !progress.goes_on(infeasible, energy) {
                break;
            }
            if !self.exchange_block(&leaving, &entering) {
                break;
            }
        }
        self.go_back(&best);
    }

    /// Returns to a state on the way. Every row moved is a pivot here too.
    fn go_back(&mut self, state: &Snapshot) {
        let before = self.counts.factor_rows;
        self.restore(state).expect("a snapshot of this solver");
        self.counts.pivots += self.counts.factor_rows - before;
        self.settled = false;
    }

    /// Moves the active `z` so that the active `w` vanish, whatever the signs of z. False if the factor has lost its meaning.
    fn balance_active(&mut self) -> bool {
        for _ in 0..CORRECTIONS {
            if self.active_residual() <= super::ROUNDING * self.own_scale() {
                break;
            }
            let mut correction = vec![0.0; self.z.len()];
            for &j in self.active.members() {
                correction[j] = -self.w[j];
            }
            self.counts.entries_solved += self.factor.solve(&mut correction);
            for &j in self.active.members() {
                self.z[j] += correction[j];
            }
            self.recompute_w();
        }
        self.active.members().iter().all(|&j| self.z[j].is_finite() && self.w[j].is_finite())
    }

    /// Active rows with `z < 0`.
    fn negative_z(&self) -> Vec<usize> {
        let threshold = self.violation();
        self.active.members().iter().copied().filter(|&j| self.z[j] < -threshold).collect()
    }

    /// Rows with `w < 0` outside the active set, the most violated first, the least index among equals.
    fn violated_rows(&self) -> Vec<usize> {
        let threshold = self.violation();
        let violated = |&j: &usize| self.role[j] != Role::Absent && !self.active.contains(j) && self.w[j] < -threshold;
        let mut rows: Vec<usize> = (0..self.w.len()).filter(violated).collect();
        rows.sort_by(|&a, &b| self.w[a].total_cmp(&self.w[b]).then(a.cmp(&b)));
        rows
    }

    /// `z' M z / 2 + q' z` where `w_C = 0`.
    fn energy(&self) -> f64 {
        self.active.members().iter().map(|&j| 0.5 * self.load.scaled[j] * self.z[j]).sum()
    }

    /// One block exchange. False if nothing moved, because all that is infeasible depends on the active rows.
    fn exchange_block(&mut self, leaving: &[usize], entering: &[usize]) -> bool {
        let before = self.counts.pivots;
        self.counts.major_cycles += 1;
        for &j in leaving {
            self.leave(j);
            self.counts.pivots += 1;
        }
        for &j in entering {
            if self.is_independent(j) && self.insert_or_refactor(j) {
                self.role[j] = Role::Considered;
                self.counts.pivots += 1;
            }
        }
        self.recompute_w();
        self.counts.pivots > before
    }

    /// Whether the active block clearly stays nonsingular with row i.
    fn is_independent(&mut self, i: usize) -> bool {
        self.solve_direction(i);
        let size = largest(&self.dz, self.active.members()).max(1.0);
        self.m.column_dot(i, &self.dz) > CLEAR * size * size
    }
}
