//! What an answer in 64 bits must hold to count, and what decides where it does not (`extended.rs`).

use super::super::{
    answer::{MARGIN, Membership, OF_FORCE, OF_LOAD},
    basic::Basic,
    extended::{Decision, Extended},
};
use super::{ConeSolver, RATE, journal::Change, values::OF_LARGEST};

impl ConeSolver {
    /// Whether the forces balance every block: by the largest force in each row, and by the block's own load, which a load that
    /// passes through it must not hide.
    pub(super) fn balances(&self) -> bool {
        if self.residual * self.balance.size <= OF_FORCE && !self.problem.wide {
            return true; // of each block's own load, though the forces may be far larger
        }
        // What rounding left below zero is given out as zero.
        let force = |j: u32| self.values.force[j as usize].max(0.0);
        let balanced = |&row: &u32| {
            let (mut sum, mut largest) = (-self.problem.h[row as usize], self.problem.own[row as usize]);
            for &(j, value) in self.problem.g.columns_of(row) {
                sum += force(j) * value;
                largest = largest.max((force(j) * value).abs());
            }
            sum.abs() <= (OF_FORCE * largest).min(OF_LOAD * self.problem.own[row as usize])
        };
        self.present.rows.iter().all(balanced)
    }

    /// Whether y proves that `h` is outside: `y' g <= 0` for every present column, up to rounding, and a power `y' h` that is
    /// the infeasibility left, by another route (if they differ, the values are worn), and is above what would be left of a
    /// structure that stands: the imbalance that forces may leave, what the directions' rounding makes of the forces, and the
    /// work of the largest of them where a contact closes by rounding.
    pub(super) fn certifies(&self) -> bool {
        let (largest, power) = (self.pivot.multipliers.largest(), self.certificate_power());
        let infeasibility = self.values.infeasibility();
        let enough = power > 0.5 * infeasibility && power > 2.0 * OF_FORCE * largest;
        if !enough || self.problem.wide {
            return false; // if wide, a heavy block's row has only small entries: what they can do is easily overlooked
        }
        let (mut bound, mut closing) = (0.0, 0.0_f64);
        for (row, y) in self.pivot.multipliers.iter() {
            bound += OF_LARGEST * (y * self.problem.h[row as usize]).abs();
            for &(j, value) in self.problem.g.columns_of(row) {
                bound += OF_LARGEST * self.values.force[j as usize].max(0.0) * (y * value).abs();
                if self.present.takes_part(j) {
                    let rate: f64 = self
                        .problem
                        .g
                        .column(j)
                        .iter()
                        .map(|&(row, value)| value * self.pivot.multipliers.get(row))
                        .sum();
                    if rate > 10.0 * RATE * largest {
                        return false;
                    }
                    closing = closing.max(rate);
                }
            }
        }
        power > MARGIN * (bound + closing * self.balance.size)
    }

    /// Takes over a certificate that another method has found, (row, multiplier) in the units of [`Self::certificate`], if it
    /// proves that `h` is outside. `force` is the largest in that method's answer, in the caller's unit.
    pub fn adopt_certificate(&mut self, multipliers: &[(usize, f64)], force: f64) -> bool {
        self.pivot.multipliers.clear();
        for &(row, value) in multipliers.iter().filter(|&&(row, value)| self.present.is_there[row] && value != 0.0) {
            self.pivot.multipliers.set(row as u32, value / self.problem.row_scale[row]);
        }
        let largest = self.pivot.multipliers.largest();
        let scale = self.problem.column_scale.iter().fold(f64::INFINITY, |least, scale| least.min(*scale));
        let (mut bound, mut closing) = (0.0, 0.0_f64);
        for (row, y) in self.pivot.multipliers.iter() {
            bound += OF_LARGEST * (y * self.problem.h[row as usize]).abs();
            for &(j, _) in self.problem.g.columns_of(row).iter().filter(|(j, _)| self.present.takes_part(*j)) {
                let terms =
                    self.problem.g.column(j).iter().map(|&(row, value)| value * self.pivot.multipliers.get(row));
                closing = closing.max(terms.sum());
            }
        }
        let power = self.certificate_power();
        !self.problem.wide // as in `certifies`
            && closing <= 10.0 * RATE * largest
            && power > 2.0 * OF_FORCE * largest
            && power > MARGIN * (bound + closing * (force / scale + 1.0))
    }

    /// Decides in double-double arithmetic, from the basis as it is.
    pub(crate) fn decide_extended(&mut self) -> Membership {
        self.bearing.behind = false;
        if self.limits.only_in_64_bits {
            return Membership::NumericalTrouble;
        }
        if !self.rebuild(&self.basis.set(&self.present.rows)) {
            return Membership::NumericalTrouble;
        }
        let mut rows = self.present.rows.clone();
        rows.sort_unstable();
        let basis = rows.iter().map(|&row| self.basis.basic[row as usize]).collect();
        let free = |&j: &u32| self.present.takes_part(j) && self.basis.is_out(j);
        let columns = (0..self.problem.g.len() as u32).filter(free).collect();
        let decision =
            Extended::new(&self.problem.g, &self.problem.h, &self.problem.own, rows.clone(), basis, columns).decide();
        match decision {
            Some(decision) => self.take_over(&rows, decision),
            None => Membership::NumericalTrouble,
        }
    }

    /// The basis and the values of a decision become the solver's.
    fn take_over(&mut self, rows: &[u32], decision: Decision) -> Membership {
        let Decision { found, pivots, values, multipliers, doubt } = decision;
        self.doubt = doubt;
        let mut basis = self.basis.set(&self.present.rows);
        for (&position, &(entered, _)) in rows.iter().zip(&values) {
            let left = self.basis.basic[position as usize];
            if left != entered {
                self.journal.note(Change::Pivot { position, entered, left });
            }
            basis.take(position, left);
        }
        rows.iter().zip(&values).for_each(|(&position, &(entered, _))| basis.put(position, entered));
        self.counts.pivots += pivots;
        self.counts.major_cycles += pivots;
        if !self.rebuild(&basis) {
            return Membership::NumericalTrouble;
        }
        self.recompute_values();
        self.values.suspects.clear();
        for (&row, &(basic, value)) in rows.iter().zip(&values) {
            match basic {
                Basic::Unit => self.set_value(row, value),
                Basic::Column(j) if !self.basis.is_out(j) => {
                    self.set_value(self.basis.position[j as usize], value);
                }
                // The factor in 64 bits has left it out; a certificate has no need of it.
                Basic::Column(_) if found == Membership::Inside => return Membership::NumericalTrouble,
                Basic::Column(_) => {}
            }
        }
        self.sum_rows();
        self.residual = self.imbalance();
        if found == Membership::Inside {
            self.values.suspects.clear();
        }
        self.pivot.multipliers.clear();
        rows.iter()
            .zip(&multipliers)
            .filter(|(_, y)| **y != 0.0)
            .for_each(|(&row, &y)| self.pivot.multipliers.set(row, y));
        found
    }
}
