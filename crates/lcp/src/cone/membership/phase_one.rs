//! Phase one of the primal simplex method, step by step: price, direction, ratio test, pivot.

use super::super::basis_factor::Replacement;
use super::{
    Basic, Blocking, Change, ConeSolver, DISAGREEMENT, GROWTH, Membership, OUT, PIVOT, PROGRESS, RATE, SAFE_PIVOT,
    SLACK, STALL, infeasible,
};

impl ConeSolver {
    /// Drives the infeasibility down until it is gone or cannot fall. None if a pivot was refused.
    pub(super) fn phase_one(&mut self, limit: usize) -> Option<Membership> {
        let (mut stalled, mut best) = (0, f64::INFINITY);
        let mut wear = self.fresh_wear();
        loop {
            self.tally.count(self.suspects.len());
            self.rebuild_if_worn(&mut wear)?;
            let x = &self.x;
            let (basic, zero) = (&self.basic, self.zero);
            self.suspects.retain(|&p| infeasible(basic[p as usize], x[p as usize], zero) != 0.0);
            if self.suspects.is_empty() {
                return Some(Membership::Inside);
            }
            if self.counts.pivots >= limit || self.is_exhausted() {
                return Some(Membership::PivotLimit);
            }
            self.multipliers();
            let infeasibility: f64 = self.suspects.iter().map(|&p| self.x[p as usize].abs()).sum();
            stalled = if infeasibility < best * (1.0 - PROGRESS) { 0 } else { stalled + 1 };
            best = best.min(infeasibility);
            if stalled == STALL {
                self.shaky = true; // a factor gone wrong is the likelier reason
                continue;
            }
            let least_index = stalled > STALL;
            let floor = RATE * self.y.largest();
            let (missing, position) = (&self.missing, &self.position);
            let allowed = |j: u32| missing[j as usize] == 0 && position[j as usize] == OUT;
            let Some(entering) = self.pricing.entering(&self.g, &self.y, allowed, floor, least_index) else {
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
        self.y.clear();
        let y = &mut self.y;
        self.suspects.retain(|&p| y.list(p)); // once each
        for &p in &self.suspects {
            self.y.set(p, infeasible(self.basic[p as usize], self.x[p as usize], self.zero));
        }
        self.factor.solve_transposed(&mut self.y);
    }

    /// `L^-1 g` of a column.
    pub(super) fn column_spike(&mut self, j: u32) {
        self.spike.clear();
        for &(row, value) in self.g.column(j) {
            self.spike.set(row, value);
        }
        self.factor.apply_operations(&mut self.spike);
    }

    /// The direction of a column whose spike is there, as far as it matters, and what blocks it.
    fn blocking_of(&mut self, entering: u32, least_index: bool) -> Option<Blocking> {
        if self.lazy {
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
        self.factor.solve_upper(&self.spike, &mut self.direction);
    }

    /// A row in balance that the spike alone shows to block the step at once, which saves the direction. Of several the
    /// one with the largest entry.
    pub(super) fn balanced_row(&self) -> Option<(u32, f64)> {
        let balanced = |p: u32| self.basic[p as usize] == Basic::Unit && self.x[p as usize].abs() <= self.zero;
        let entry = |p: u32| self.factor.first_solved(p, &self.spike).filter(|entry| entry.abs() > SAFE_PIVOT);
        self.spike
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
        self.blocking.clear();
        for &(p, rate) in &self.direction {
            let size = rate.abs();
            if size <= PIVOT {
                continue;
            }
            let (basic, value) = (self.basic[p as usize], self.x[p as usize]);
            let sign = infeasible(basic, value, self.zero);
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
                self.blocking.push(Blocking { position: p, ratio: room / size, rate });
                bound = bound.min(reach);
            }
        }
        let order = |b: &Blocking| {
            let unit = self.basic[b.position as usize] == Basic::Unit;
            (!unit, if least_index { 0.0 } else { -b.rate.abs() }, self.leaving_index(b.position))
        };
        self.blocking
            .iter()
            .filter(|b| b.ratio <= bound)
            .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal))
            .copied()
    }

    pub(super) fn leaving_index(&self, p: u32) -> u32 {
        match self.basic[p as usize] {
            Basic::Unit => p,
            Basic::Column(j) => j,
        }
    }

    pub(super) fn step(&mut self, step: f64) {
        if self.remembers {
            self.overwritten.extend(self.direction.iter().map(|&(p, _)| (p, self.x[p as usize])));
        }
        for k in 0..self.direction.len() {
            let (p, rate) = self.direction[k];
            let value = self.x[p as usize] - step * rate;
            self.set_value(p, value);
            if infeasible(self.basic[p as usize], value, self.zero) != 0.0 {
                self.suspects.push(p);
            }
        }
    }

    /// One pivot. None if the factor refuses it.
    pub(super) fn exchange(&mut self, entering: u32, leaving: u32, step: f64, rate: f64) -> Option<()> {
        let replacement = self.factor.replace(leaving, &self.spike)?;
        self.note_accuracy(replacement, rate);
        self.counts.pivots += 1;
        self.counts.major_cycles += 1;
        let left = self.basic[leaving as usize];
        if let Basic::Column(j) = left {
            self.take_out(j);
        }
        self.distrust(leaving);
        self.mixed |= self.column_group(entering) != self.groups;
        self.note(Change::Pivot { position: leaving, entered: Basic::Column(entering), left });
        self.put(leaving, Basic::Column(entering));
        self.remember(leaving);
        self.set_value(leaving, step);
        Some(())
    }

    /// The pivot as the replacement found it, and by another route: if they differ, digits are worn.
    pub(super) fn note_accuracy(&mut self, replacement: Replacement, rate: f64) {
        let disagreement = (replacement.rate - rate).abs() / rate.abs();
        self.shaky |= disagreement > DISAGREEMENT || replacement.growth > GROWTH;
    }

    /// A column is not basic any more.
    pub(super) fn take_out(&mut self, j: u32) {
        self.position[j as usize] = OUT;
        self.bears_no_more(j);
        self.set_force(j, 0.0);
    }

    pub(super) fn put(&mut self, position: u32, basic: Basic) {
        self.basic[position as usize] = basic;
        if let Basic::Column(j) = basic {
            self.position[j as usize] = position;
        }
    }
}
