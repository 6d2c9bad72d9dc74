//! The imbalance of forces, and refinement.

use super::{Basic, ConeSolver, values::Values};
use crate::{cone::Columns, interrupt::poll};
use serde::{Deserialize, Serialize};

/// `G f - h` of every present row, carried along with the forces; since all were summed from nothing the worst of them and the
/// largest force.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Balance {
    pub sums: Vec<f64>,
    worst: f64,
    /// The largest force, at least one.
    pub size: f64,
    /// Columns whose force changed since the last check, and rows that came since.
    pub changed: Vec<u32>,
    pub new_rows: Vec<u32>,
    /// Checks since every row was summed from nothing.
    carried: usize,
}

impl Balance {
    pub fn of_nothing(rows: usize) -> Self {
        Self { sums: vec![0.0; rows], worst: 0.0, size: 1.0, changed: Vec::new(), new_rows: Vec::new(), carried: 0 }
    }

    /// A column's force has changed by so much, to this.
    fn feel(&mut self, g: &Columns, values: &mut Values, j: u32, change: f64, force: f64) {
        if force > self.size {
            self.size = force;
            values.round_by(force);
        }
        for &(row, value) in g.column(j) {
            self.sums[row as usize] += change * value;
        }
        self.changed.push(j);
    }

    pub fn resize(&mut self, rows: usize, columns: usize) {
        self.sums.resize(rows, 0.0);
        self.changed.retain(|&j| (j as usize) < columns);
        self.new_rows.retain(|&row| (row as usize) < rows);
    }
}

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
        self.balance.new_rows.retain(|&row| self.present.is_there[row as usize]); // some may have gone again
        if self.bearing.behind {
            let largest = self
                .balance
                .new_rows
                .iter()
                .fold(0.0, |worst, &row| larger(worst, self.balance.sums[row as usize].abs()));
            self.balance.new_rows.clear();
            self.balance.changed.clear();
            return largest / self.balance.size;
        }
        self.bearing.answers_behind = 0;
        if self.balance.carried >= CARRIED {
            self.sum_rows();
        }
        self.balance.carried += 1;
        let mut worst = self.balance.worst;
        let mut look_at = |row: u32| {
            if self.present.is_there[row as usize] {
                worst = larger(worst, self.balance.sums[row as usize].abs());
            }
        };
        if 3 * self.balance.changed.len() > self.present.rows.len() {
            self.present.rows.iter().for_each(|&row| look_at(row));
        } else {
            self.balance.new_rows.iter().for_each(|&row| look_at(row));
            self.balance
                .changed
                .iter()
                .for_each(|&j| self.problem.g.column(j).iter().for_each(|&(row, _)| look_at(row)));
        }
        // What rounding left below zero is given out as zero.
        let pulling = |&j: &u32| (-self.values.force[j as usize]).max(0.0);
        let pull: f64 = self.balance.changed.iter().map(pulling).sum();
        self.balance.changed.clear();
        self.balance.new_rows.clear();
        self.balance.worst = worst;
        (worst + pull) / self.balance.size
    }

    /// Sums every row from nothing.
    pub(super) fn sum_rows(&mut self) {
        poll(ROW * self.present.rows.len());
        (self.balance.carried, self.balance.worst, self.balance.size) = (0, 0.0, 1.0);
        for &row in &self.present.rows {
            self.balance.sums[row as usize] = -self.problem.h[row as usize];
        }
        for &p in &self.present.rows {
            if let Basic::Column(j) = self.basis.basic[p as usize] {
                let force = self.values.force[j as usize];
                self.balance.size = self.balance.size.max(force);
                for &(row, value) in self.problem.g.column(j) {
                    self.balance.sums[row as usize] += force * value;
                }
            }
        }
        self.values.round_by(self.balance.size);
        self.balance.new_rows.clone_from(&self.present.rows);
    }

    /// Sets a basic value.
    pub(super) fn set_value(&mut self, position: u32, value: f64) {
        self.values.basic[position as usize] = value;
        if let Basic::Column(j) = self.basis.basic[position as usize] {
            self.set_force(j, value);
        }
    }

    /// Sets the force of a column, and what its rows feel of it.
    pub(super) fn set_force(&mut self, j: u32, force: f64) {
        let change = force - std::mem::replace(&mut self.values.force[j as usize], force);
        self.balance.feel(&self.problem.g, &mut self.values, j, change, force);
    }

    /// One step of iterative refinement on every basic value, from the sums of the rows.
    pub(super) fn refine(&mut self) {
        let rows = std::mem::take(&mut self.present.rows);
        self.pass_on(&rows);
        self.present.rows = rows;
    }

    /// Balances some rows, by changing whatever values that takes.
    pub(super) fn pass_on(&mut self, rows: &[u32]) {
        self.pivot.spike.clear();
        for &row in rows.iter().filter(|&&row| self.present.is_there[row as usize]) {
            let unit = if self.basis.is_unit(row) { self.values.basic[row as usize] } else { 0.0 };
            let lacking = -self.balance.sums[row as usize] - unit;
            if lacking != 0.0 {
                self.pivot.spike.set(row, lacking);
            }
        }
        self.basis.factor.apply_operations(&mut self.pivot.spike);
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
