//! Phase two: how large a column may become.
//!
//! ```text
//! max t   with   G f + d t = h,   f >= 0                                              (1)
//! min y' h   with   y' G >= 0,   y' d = 1                                            (2)
//! ```
//!
//! Primal simplex from the basis that is there, with the same pricing, ratio test and factor as phase one (Dantzig, Linear
//! Programming and Extensions, 1963, chapter 5). The load d is two columns, d and -d, so that t may have either sign.

use super::{Columns, ConeSolver, Membership, RATE, ROUNDING, STALL, basis::OUT};
use crate::error::LcpError;

/// How far a load may grow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Greatest {
    /// To this: then [`ConeSolver::certificate`] is y with `y' G <= 0` up to rounding, `y' d < 0` and `y' (h - d t) = 0`, so that
    /// more of the load is outside.
    Limited(f64),
    /// However far.
    Unlimited,
    /// Stopped by the limit of pivots or of effort.
    PivotLimit,
    /// Accuracy was lost and rebuilding the factor did not bring it back.
    NumericalTrouble,
}

/// The columns of a load.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    up: u32,
    down: u32,
}

impl Load {
    /// The same load the other way: its factor is minus that of this one.
    pub fn reversed(self) -> Self {
        Self { up: self.down, down: self.up }
    }
}

/// Times that rounding is taken out of the values and the pivots go on.
const ROUNDS: usize = 4;

impl ConeSolver {
    /// Adds a load that takes part with the factor t of either sign, from the next answer on. It must touch present rows only.
    /// Marks end here.
    ///
    /// # Errors
    /// [`LcpError`] for rows that do not exist, or numbers that are none.
    pub fn add_load(&mut self, load: &[(usize, f64)]) -> Result<Load, LcpError> {
        let rows: Vec<usize> = load.iter().chain(load).map(|entry| entry.0).collect();
        let values: Vec<f64> = load.iter().map(|entry| entry.1).chain(load.iter().map(|entry| -entry.1)).collect();
        let columns = Columns::new(self.problem.h.len(), &[0, load.len(), 2 * load.len()], &rows, &values)?;
        let up = self.problem.g.len() as u32;
        self.append(columns, &[], &[])?;
        Ok(Load { up, down: up + 1 })
    }

    /// The factor of a load in the last answer.
    pub fn factor_of(&self, load: Load) -> f64 {
        self.f(load.up as usize) - self.f(load.down as usize)
    }

    /// How large the factor of a load can become, from an answer [`Membership::Inside`].
    pub fn greatest(&mut self, load: Load) -> Greatest {
        let limit = self.counts.pivots + 1000 + 50 * self.present.rows.len();
        for _ in 0..ROUNDS {
            match self.phase_two(load, limit) {
                Some(Greatest::Limited(_)) => {}
                Some(end) => return end,
                None => {
                    if !self.rebuild(&self.basis.set(&self.present.rows)) {
                        return Greatest::NumericalTrouble;
                    }
                    self.recompute_values();
                    match self.phase_one(limit) {
                        Some(Membership::Inside) => continue,
                        Some(Membership::PivotLimit) => return Greatest::PivotLimit,
                        _ => return Greatest::NumericalTrouble,
                    }
                }
            }
            self.sum_rows();
            self.residual = self.imbalance();
            if self.residual > ROUNDING {
                self.refine();
                self.sum_rows();
                self.residual = self.imbalance();
            }
            match self.phase_one(limit) {
                Some(Membership::Inside) => {}
                Some(Membership::PivotLimit) => return Greatest::PivotLimit,
                _ => return Greatest::NumericalTrouble,
            }
            // Phase one has made no pivot if the multipliers are still those of the basis.
            if let Some(Greatest::Limited(factor)) = self.phase_two(load, limit)
                && self.balances()
            {
                return Greatest::Limited(factor);
            }
        }
        Greatest::NumericalTrouble
    }

    /// Pivots until no column makes the factor larger. None if a pivot was refused.
    fn phase_two(&mut self, load: Load, limit: usize) -> Option<Greatest> {
        let (mut stalled, mut best) = (0, f64::NEG_INFINITY);
        let mut wear = self.fresh_wear();
        loop {
            self.rebuild_if_worn(&mut wear)?;
            if self.counts.pivots >= limit || self.is_exhausted() {
                return Some(Greatest::PivotLimit);
            }
            let factor = self.factor_of(load);
            let progress = factor - best > ROUNDING * factor.abs().max(best.abs());
            stalled = if progress { 0 } else { stalled + 1 };
            best = best.max(factor);
            if stalled == STALL {
                self.basis.shaky = true;
                continue;
            }
            let least_index = stalled > STALL;
            let Some(entering) = self.that_raises(load, least_index) else {
                return Some(Greatest::Limited(factor));
            };
            self.column_spike(entering);
            let (step, leaving, rate) = match self.balanced_row() {
                Some((row, rate)) => (0.0, row, rate),
                None => {
                    self.direction_from_spike();
                    match self.ratio_test(least_index) {
                        Some(blocking) => (blocking.ratio, blocking.position, blocking.rate),
                        None => return Some(Greatest::Unlimited),
                    }
                }
            };
            if step > 0.0 {
                self.step(step);
            }
            self.exchange(entering, leaving, step, rate)?;
        }
    }

    /// The column that raises the factor fastest. Leaves the multipliers `y = -B^-T c`, c the factor's gradient.
    fn that_raises(&mut self, load: Load, least_index: bool) -> Option<u32> {
        self.pivot.multipliers.clear();
        if [load.up, load.down].iter().all(|&j| self.basis.is_out(j)) {
            return Some(load.up);
        }
        for (j, rate) in [(load.up, -1.0), (load.down, 1.0)] {
            let position = self.basis.position[j as usize];
            if position != OUT {
                self.pivot.multipliers.set(position, rate);
            }
        }
        self.basis.factor.solve_transposed(&mut self.pivot.multipliers);
        let floor = RATE * self.pivot.multipliers.largest();
        let (present, basis) = (&self.present, &self.basis);
        let allowed = |j: u32| j < load.up.min(load.down) && present.takes_part(j) && basis.is_out(j);
        self.pricing.entering(&self.problem.g, &self.pivot.multipliers, allowed, floor, least_index)
    }
}
