//! The checks on an answer: the imbalance of forces, the signs of a certificate, refinement.

use super::{Basic, ConeSolver, OUT, RATE};

impl ConeSolver {
    /// Largest `|G f - h|` of a present row, relative to the largest column times its value, from `f` itself. If few
    /// values changed since the last time, only the rows of their columns are summed again; the others' stands.
    pub(super) fn imbalance(&mut self) -> f64 {
        if 4 * self.changed.len() > self.rows.len() {
            self.sum_all_rows();
        } else {
            self.sum_changed_rows();
        }
        for &position in &self.changed {
            self.is_changed[position as usize] = false;
        }
        self.changed.clear();
        self.left.clear();
        self.worst / self.size
    }

    pub(super) fn sum_all_rows(&mut self) {
        for &row in &self.rows {
            self.balance[row as usize] = -self.h[row as usize];
        }
        self.size = 1.0;
        for &p in &self.rows {
            if let Basic::Column(j) = self.basic[p as usize] {
                let f = self.x[p as usize].max(0.0);
                self.size = self.size.max(f);
                for &(row, value) in self.g.column(j) {
                    self.balance[row as usize] += f * value;
                }
            }
        }
        self.worst = self.rows.iter().fold(0.0_f64, |worst, &row| worst.max(self.balance[row as usize].abs()));
    }

    pub(super) fn sum_changed_rows(&mut self) {
        self.stale.clear();
        self.stale.extend(&self.changed);
        for &position in &self.changed {
            self.is_changed[position as usize] = false;
            if let Basic::Column(j) = self.basic[position as usize] {
                self.size = self.size.max(self.x[position as usize]);
                self.left.push(j);
            }
        }
        for &j in &self.left {
            self.stale.extend(self.g.column(j).iter().map(|&(row, _)| row));
        }
        for &row in &self.stale {
            if std::mem::replace(&mut self.is_changed[row as usize], true) || !self.present[row as usize] {
                continue;
            }
            let force = |&(j, value): &(u32, f64)| match self.position[j as usize] {
                OUT => 0.0,
                position => value * self.x[position as usize].max(0.0),
            };
            let sum: f64 = self.g.columns_of(row).iter().map(force).sum();
            self.balance[row as usize] = sum - self.h[row as usize];
            self.worst = self.worst.max(self.balance[row as usize].abs());
        }
        for &row in &self.stale {
            self.is_changed[row as usize] = false;
        }
    }

    /// Every row is to be summed again.
    pub(super) fn recheck_all(&mut self) {
        for k in 0..self.rows.len() {
            self.change(self.rows[k]);
        }
    }

    /// Notes that the value in a position is about to change.
    pub(super) fn change(&mut self, position: u32) {
        if !std::mem::replace(&mut self.is_changed[position as usize], true) {
            self.changed.push(position);
        }
    }

    /// One step of iterative refinement on every basic value, from the imbalance just computed.
    pub(super) fn refine(&mut self) {
        self.direction.clear();
        for k in 0..self.rows.len() {
            let row = self.rows[k];
            let unit = if self.basic[row as usize] == Basic::Unit { self.x[row as usize] } else { 0.0 };
            self.direction.set(row, -self.balance[row as usize] - unit);
        }
        self.factor.apply_operations(&mut self.direction);
        self.factor.solve_upper(&mut self.direction);
        self.step(-1.0);
    }

    /// Whether y proves that `h` is outside: `y' g <= 0` for every present column, up to rounding, and `y' h > 0`.
    pub(super) fn certifies(&self) -> bool {
        let size = self.y.iter().fold(0.0_f64, |size, (_, value)| size.max(value.abs()));
        let power: f64 = self.y.iter().map(|(row, value)| value * self.h[row as usize]).sum();
        let rises = |&(j, _): &(u32, f64)| {
            let rate: f64 = self.g.column(j).iter().map(|&(row, value)| value * self.y.get(row)).sum();
            self.missing[j as usize] == 0 && rate > 10.0 * RATE * size
        };
        power > 0.0 && !self.y.iter().any(|(row, _)| self.g.columns_of(row).iter().any(rises))
    }
}
