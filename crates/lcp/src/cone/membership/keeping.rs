//! What is kept: the factor, built again when it is worn, and the values.

use super::{Basic, Change, ConeSolver, ENTRIES, FILL, PIVOT, REPLACEMENTS, infeasible};

/// What is basic, wherever it stands: generators, and the unit columns of rows.
#[derive(Debug, Clone, Default)]
pub(super) struct BasisSet {
    pub columns: Vec<u32>,
    /// Whether the unit column of each row is basic.
    pub units: Vec<bool>,
}

impl BasisSet {
    pub fn put(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = true,
            Basic::Column(j) => self.columns.push(j),
        }
    }

    pub fn take(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = false,
            Basic::Column(j) => self.columns.retain(|&other| other != j),
        }
    }
}

impl ConeSolver {
    /// The basis as a set.
    pub(super) fn basis_set(&self) -> BasisSet {
        let units = (0..self.basic.len() as u32).map(|p| self.column_in(p).is_none()).collect();
        BasisSet { columns: self.rows.iter().filter_map(|&p| self.column_in(p)).collect(), units }
    }

    /// The column that is basic in a position, if it is not the unit column.
    pub(super) fn column_in(&self, position: u32) -> Option<u32> {
        match self.basic[position as usize] {
            Basic::Column(j) => Some(j),
            Basic::Unit => None,
        }
    }

    /// A column is not known to bear any more.
    pub(super) fn doubt(&mut self, j: u32) {
        if std::mem::take(&mut self.bears[j as usize]) {
            self.note(Change::Doubted(j));
        }
    }

    /// Builds the factor again if a pivot showed lost digits, or if it has filled up. None if that fails.
    pub(super) fn rebuild_if_worn(&mut self) -> Option<()> {
        let full = self.factor.stored() > self.most_entries.max(ENTRIES * self.rows.len());
        let stale = self.factor.left_behind() > REPLACEMENTS * self.basic.len();
        if std::mem::take(&mut self.shaky) || full || stale {
            if !self.rebuild(&self.basis_set()) {
                return None;
            }
            self.recompute_values();
            self.shaky = false;
        }
        Some(())
    }

    /// Builds the factor again from a basis. The columns go in group by group, the oldest first, which keeps the factor
    /// sparse: the columns of a group press on older ones. One that depends on those before it stays out. What bears has
    /// to be found out anew. False if the factor refuses a column.
    pub(super) fn rebuild(&mut self, basis: &BasisSet) -> bool {
        self.counts.refactorisations += 1;
        self.lose_values();
        self.mixed = true;
        self.factor.reset();
        self.suspects.clear();
        for p in 0..self.basic.len() as u32 {
            if let Some(j) = self.column_in(p) {
                self.take_out(j);
                self.put(p, Basic::Unit);
            }
        }
        let mut columns = basis.columns.clone();
        columns.sort_unstable_by_key(|&j| (self.column_group(j), j));
        (0..self.bears.len() as u32).for_each(|j| self.doubt(j));
        for j in columns {
            self.column_spike(j);
            self.direction_from_spike();
            let free = |&&(p, _): &&(u32, f64)| !basis.units[p as usize] && self.basic[p as usize] == Basic::Unit;
            let best = self.direction.iter().filter(free).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let Some(&(p, _)) = best.filter(|best| best.1.abs() > PIVOT) else { continue };
            if self.factor.replace(p, &self.spike).is_none() {
                return false;
            }
            self.put(p, Basic::Column(j));
        }
        self.most_entries = FILL * self.factor.stored();
        true
    }

    /// `x = B^-1 h` on the present rows.
    pub(super) fn recompute_values(&mut self) {
        self.spike.clear();
        for &row in &self.rows {
            self.spike.set(row, self.h[row as usize]);
        }
        self.factor.apply_operations(&mut self.spike);
        self.direction_from_spike();
        for k in 0..self.rows.len() {
            let row = self.rows[k];
            self.remember(row);
            self.set_value(row, 0.0);
        }
        for k in 0..self.direction.len() {
            let (p, value) = self.direction[k];
            self.set_value(p, value);
            if infeasible(self.basic[p as usize], value) != 0.0 {
                self.suspects.push(p);
            }
        }
        self.sum_rows();
        self.behind = false;
    }
}
