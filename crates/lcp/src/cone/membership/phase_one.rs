//! Phase one of the primal simplex method, step by step: price, direction, ratio test, pivot.

use super::{
    Basic, ConeSolver, Membership, PIVOT, PROGRESS, RATE, SAFE_PIVOT, SLACK, STALL, basis::OUT, infeasible,
    journal::Change,
};
use crate::cone::sparse_vector::SparseVector;
use serde::{Deserialize, Serialize};

/// What a pivot is computed from; between two pivots only the multipliers mean something.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Pivot {
    /// `y = B^-T c`; after an answer that it is outside, the certificate.
    pub multipliers: SparseVector,
    /// `L^-1 g` of the entering column.
    pub spike: SparseVector,
    /// `B^-1 g` as (position, rate); nothing that is zero.
    pub direction: Vec<(u32, f64)>,
    /// Values that limit the step.
    blocking: Vec<Blocking>,
}

/// A basic value that limits the step.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Blocking {
    pub position: u32,
    pub ratio: f64,
    pub rate: f64,
}

impl Pivot {
    pub fn none(rows: usize) -> Self {
        let zero = || SparseVector::zero(rows);
        Self { multipliers: zero(), spike: zero(), direction: Vec::new(), blocking: Vec::new() }
    }

    pub fn resize(&mut self, rows: usize) {
        self.multipliers.resize(rows);
        self.spike.resize(rows);
        self.direction.clear();
    }
}

impl ConeSolver {
    /// Drives the infeasibility down until it is gone or cannot fall. None if a pivot was refused.
    pub(super) fn phase_one(&mut self, limit: usize) -> Option<Membership> {
        let (mut stalled, mut best) = (0, f64::INFINITY);
        let mut wear = self.fresh_wear();
        loop {
            self.tally.count(self.values.suspects.len());
            self.rebuild_if_worn(&mut wear)?;
            let x = &self.values.basic;
            let (basic, zero) = (&self.basis.basic, self.values.zero);
            self.values.suspects.retain(|&p| infeasible(basic[p as usize], x[p as usize], zero) != 0.0);
            if self.values.suspects.is_empty() {
                return Some(Membership::Inside);
            }
            if self.counts.pivots >= limit || self.is_exhausted() {
                return Some(Membership::PivotLimit);
            }
            self.multipliers();
            let infeasibility = self.values.infeasibility();
            stalled = if infeasibility < best * (1.0 - PROGRESS) { 0 } else { stalled + 1 };
            best = best.min(infeasibility);
            if stalled == STALL {
                self.basis.shaky = true; // a factor gone wrong is the likelier reason
                continue;
            }
            let least_index = stalled > STALL;
            let floor = RATE * self.pivot.multipliers.largest();
            let (present, basis) = (&self.present, &self.basis);
            let allowed = |j: u32| present.takes_part(j) && basis.is_out(j);
            let Some(entering) =
                self.pricing.entering(&self.problem.g, &self.pivot.multipliers, allowed, floor, least_index)
            else {
                return Some(Membership::Outside);
            };
            self.column_spike(entering);
            let (step, leaving, rate) = match self.balanced_row() {
                Some((row, rate)) => (0.0, row, rate),
                None => {
                    let blocking = self.blocking_of(entering, least_index)?;
                    (blocking.ratio, blocking.position, blocking.rate)
                }
            };
            if step > 0.0 {
                self.step(step);
            }
            self.exchange(entering, leaving, step, rate)?;
        }
    }

    /// `y = B^-T c` with c the rate at which the infeasibility grows with each basic value.
    pub(super) fn multipliers(&mut self) {
        self.pivot.multipliers.clear();
        let y = &mut self.pivot.multipliers;
        self.values.suspects.retain(|&p| y.list(p)); // once each
        for &p in &self.values.suspects {
            self.pivot.multipliers.set(p, self.values.infeasible(p, self.basis.basic[p as usize]));
        }
        self.basis.factor.solve_transposed(&mut self.pivot.multipliers);
    }

    /// `L^-1 g` of a column.
    pub(super) fn column_spike(&mut self, j: u32) {
        self.pivot.spike.clear();
        for &(row, value) in self.problem.g.column(j) {
            self.pivot.spike.set(row, value);
        }
        self.basis.factor.apply_operations(&mut self.pivot.spike);
    }

    /// The direction of a column whose spike is there, as far as it matters, and what blocks it.
    fn blocking_of(&mut self, entering: u32, least_index: bool) -> Option<Blocking> {
        if self.bearing.lazy {
            self.direction_to_bearing();
            let blocking = self.ratio_test(least_index)?;
            if !self.is_behind(blocking.position) {
                return Some(blocking);
            }
            self.catch_up();
            self.column_spike(entering);
        }
        self.direction_from_spike();
        self.ratio_test(least_index)
    }

    /// `B^-1 g`.
    pub(super) fn direction_from_spike(&mut self) {
        self.basis.factor.solve_upper(&self.pivot.spike, &mut self.pivot.direction);
    }

    /// A row in balance that the spike alone shows to block the step at once, which saves the direction. Of several the
    /// one with the largest entry.
    pub(super) fn balanced_row(&self) -> Option<(u32, f64)> {
        let balanced = |p: u32| self.basis.is_unit(p) && self.values.basic[p as usize].abs() <= self.values.zero;
        let entry =
            |p: u32| self.basis.factor.first_solved(p, &self.pivot.spike).filter(|entry| entry.abs() > SAFE_PIVOT);
        self.pivot
            .spike
            .index()
            .iter()
            .filter(|&&p| balanced(p))
            .filter_map(|&p| Some((p, entry(p)?)))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()).then(b.0.cmp(&a.0)))
    }

    /// How far the entering column can go until a basic value reaches zero, and which. A unit column at zero allows
    /// no step: a balanced row stays balanced.
    pub(super) fn ratio_test(&mut self, least_index: bool) -> Option<Blocking> {
        let slack = if least_index { 0.0 } else { SLACK };
        let mut bound = f64::INFINITY;
        self.pivot.blocking.clear();
        for &(p, rate) in &self.pivot.direction {
            let size = rate.abs();
            if size <= PIVOT {
                continue;
            }
            let (basic, value) = (self.basis.basic[p as usize], self.values.basic[p as usize]);
            let sign = infeasible(basic, value, self.values.zero);
            let room = if sign != 0.0 {
                if sign * rate < 0.0 {
                    continue;
                }
                value.abs()
            } else if basic == Basic::Unit {
                0.0
            } else if rate > 0.0 {
                value.max(0.0)
            } else {
                continue;
            };
            let reach = (room + slack) / size;
            if room / size <= bound {
                self.pivot.blocking.push(Blocking { position: p, ratio: room / size, rate });
                bound = bound.min(reach);
            }
        }
        let order = |b: &Blocking| {
            let unit = self.basis.basic[b.position as usize] == Basic::Unit;
            (!unit, if least_index { 0.0 } else { -b.rate.abs() }, self.basis.index_in(b.position))
        };
        self.pivot
            .blocking
            .iter()
            .filter(|b| b.ratio <= bound)
            .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal))
            .copied()
    }

    pub(super) fn step(&mut self, step: f64) {
        self.journal.remember_all(self.pivot.direction.iter().map(|&(p, _)| p), &self.values);
        for k in 0..self.pivot.direction.len() {
            let (p, rate) = self.pivot.direction[k];
            let value = self.values.basic[p as usize] - step * rate;
            self.set_value(p, value);
            if infeasible(self.basis.basic[p as usize], value, self.values.zero) != 0.0 {
                self.values.suspects.push(p);
            }
        }
    }

    /// One pivot. None if the factor refuses it.
    pub(super) fn exchange(&mut self, entering: u32, leaving: u32, step: f64, rate: f64) -> Option<()> {
        let replacement = self.basis.factor.replace(leaving, &self.pivot.spike)?;
        self.basis.note_accuracy(replacement, rate);
        self.counts.pivots += 1;
        self.counts.major_cycles += 1;
        let left = self.basis.basic[leaving as usize];
        if let Basic::Column(j) = left {
            self.take_out(j);
        }
        self.distrust(leaving);
        self.bearing.mixed |= self.column_group(entering) != self.bearing.groups;
        self.journal.note(Change::Pivot { position: leaving, entered: Basic::Column(entering), left });
        self.basis.put(leaving, Basic::Column(entering));
        self.journal.remember(leaving, &self.values);
        self.set_value(leaving, step);
        Some(())
    }

    /// A column is not basic any more.
    pub(super) fn take_out(&mut self, j: u32) {
        self.basis.position[j as usize] = OUT;
        self.bearing.doubt(j, &mut self.journal);
        self.set_force(j, 0.0);
    }
}
