//! The imbalance of forces, and refinement.

use super::{Basic, ConeSolver, OF_LARGEST, ZERO};
use crate::interrupt::poll;

/// Checks between two summations of every row from nothing. In between the sums are carried along with the forces that
/// change; each change rounds by 1e-16 of the largest force, so that they stay right to some 1e-12.
const CARRIED: usize = 1000;

/// Operations to sum a row, about.
const ROW: usize = 16;

impl ConeSolver {
    /// Largest `|G f - h|` of a present row, relative to the largest column times its value. Only the rows of columns
    /// whose force changed since the last check are looked at; the others' worst stands. While values are behind, only
    /// the rows that came are.
    pub(super) fn imbalance(&mut self) -> f64 {
        self.new_rows.retain(|&row| self.present[row as usize]); // some may have gone again
        if self.behind {
            let largest = self.new_rows.iter().fold(0.0, |worst, &row| larger(worst, self.balance[row as usize].abs()));
            self.new_rows.clear();
            self.changed.clear();
            return largest / self.size;
        }
        self.answers_behind = 0;
        if self.carried >= CARRIED {
            self.sum_rows();
        }
        self.carried += 1;
        let mut worst = self.worst;
        let mut look_at = |row: u32| {
            if self.present[row as usize] {
                worst = larger(worst, self.balance[row as usize].abs());
            }
        };
        if 3 * self.changed.len() > self.rows.len() {
            self.rows.iter().for_each(|&row| look_at(row));
        } else {
            self.new_rows.iter().for_each(|&row| look_at(row));
            self.changed.iter().for_each(|&j| self.g.column(j).iter().for_each(|&(row, _)| look_at(row)));
        }
        // What rounding left below zero is given out as zero.
        let pulling = |&j: &u32| (-self.force[j as usize]).max(0.0);
        let pull: f64 = self.changed.iter().map(pulling).sum();
        self.changed.clear();
        self.new_rows.clear();
        self.worst = worst;
        (worst + pull) / self.size
    }

    /// Sums every row from nothing.
    pub(super) fn sum_rows(&mut self) {
        poll(ROW * self.rows.len());
        (self.carried, self.worst, self.size) = (0, 0.0, 1.0);
        for &row in &self.rows {
            self.balance[row as usize] = -self.h[row as usize];
        }
        for &p in &self.rows {
            if let Basic::Column(j) = self.basic[p as usize] {
                let force = self.force[j as usize];
                self.size = self.size.max(force);
                for &(row, value) in self.g.column(j) {
                    self.balance[row as usize] += force * value;
                }
            }
        }
        self.zero = ZERO.max(OF_LARGEST * self.size);
        self.new_rows.clone_from(&self.rows);
    }

    /// Sets a basic value.
    pub(super) fn set_value(&mut self, position: u32, value: f64) {
        self.x[position as usize] = value;
        if let Basic::Column(j) = self.basic[position as usize] {
            self.set_force(j, value);
        }
    }

    /// Sets the force of a column, and what its rows feel of it.
    pub(super) fn set_force(&mut self, j: u32, force: f64) {
        let change = force - std::mem::replace(&mut self.force[j as usize], force);
        if force > self.size {
            self.size = force;
            self.zero = ZERO.max(OF_LARGEST * force);
        }
        for &(row, value) in self.g.column(j) {
            self.balance[row as usize] += change * value;
        }
        self.changed.push(j);
    }

    /// One step of iterative refinement on every basic value, from the sums of the rows.
    pub(super) fn refine(&mut self) {
        let rows = std::mem::take(&mut self.rows);
        self.pass_on(&rows);
        self.rows = rows;
    }

    /// Balances some rows, by changing whatever values that takes.
    pub(super) fn pass_on(&mut self, rows: &[u32]) {
        self.spike.clear();
        for &row in rows.iter().filter(|&&row| self.present[row as usize]) {
            let unit = if self.basic[row as usize] == Basic::Unit { self.x[row as usize] } else { 0.0 };
            let lacking = -self.balance[row as usize] - unit;
            if lacking != 0.0 {
                self.spike.set(row, lacking);
            }
        }
        self.factor.apply_operations(&mut self.spike);
        self.direction_from_spike();
        self.step(-1.0);
    }
}

/// The larger one, infinite for NaN. A branch that is seldom taken: in a long row of numbers it waits for none of those
/// before, as `f64::max` does.
fn larger(so_far: f64, value: f64) -> f64 {
    if value <= so_far {
        so_far
    } else if value.is_nan() {
        f64::INFINITY
    } else {
        value
    }
}
