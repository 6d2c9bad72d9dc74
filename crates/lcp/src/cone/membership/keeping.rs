//! What is kept: marks to return to, and the factor built again when its digits are worn.

use super::{Basic, Change, ConeSolver, ENTRIES, FILL, Mark, PIVOT, REPLACEMENTS, infeasible};

/// What is basic, wherever it stands: generators, and the unit columns of rows.
#[derive(Debug, Clone, Default)]
pub(super) struct BasisSet {
    pub columns: Vec<u32>,
    /// Whether the unit column of each row is basic.
    pub units: Vec<bool>,
}

impl BasisSet {
    fn put(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = true,
            Basic::Column(j) => self.columns.push(j),
        }
    }

    fn take(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = false,
            Basic::Column(j) => self.columns.retain(|&other| other != j),
        }
    }
}

impl ConeSolver {
    /// The state as it is, to come back to with [`Self::roll_back`]. Marks are taken back last first.
    pub fn mark(&mut self) -> Mark {
        let mark = Mark {
            changes: self.changes.len(),
            factor: self.factor.mark(),
            rebuilds: self.counts.refactorisations,
            behind: self.behind,
            feasible: self.suspects.is_empty(),
            shape: self.shape,
        };
        self.overwritten.clear();
        self.marked = true;
        self.last_mark = Some(mark);
        mark
    }

    /// Returns to a mark. To the latest one, the values come back bit for bit; to an earlier one they are computed
    /// again from its basis.
    ///
    /// # Panics
    /// If rows or columns came to the problem or went from it since.
    pub fn roll_back(&mut self, mark: Mark) {
        assert_eq!(mark.shape, self.shape, "a mark of another problem");
        let same_positions = mark.rebuilds == self.counts.refactorisations;
        let exact = self.last_mark == Some(mark);
        let mut gone = Vec::new();
        let mut basis = if same_positions { BasisSet::default() } else { self.basis_set() };
        while self.changes.len() > mark.changes
            && let Some(change) = self.changes.pop()
        {
            match change {
                Change::Pivot { position, entered, left } if same_positions => {
                    if let Basic::Column(j) = entered {
                        self.take_out(j);
                    }
                    self.put(position, left);
                }
                Change::Pivot { position, entered, left } => {
                    basis.take(position, entered);
                    basis.put(position, left);
                }
                Change::Gone { row, group } => {
                    let member = self.rows.iter().copied().find(|&other| self.factor.group(other) == group);
                    self.join_group(row, group, member);
                    self.bring_row(row);
                }
                Change::Bears(j) => self.bears[j as usize] = false,
                Change::Doubted(j) => self.bears[j as usize] = true,
                Change::Row(row) => {
                    self.take_row(row);
                    gone.push(row);
                }
            }
        }
        if same_positions {
            self.factor.undo_to(mark.factor);
        }
        if exact {
            self.suspects.clear();
            while let Some((position, value)) = self.overwritten.pop() {
                self.set_value(position, value);
            }
            self.behind |= mark.behind;
            if !mark.feasible {
                self.suspects.clone_from(&self.rows);
            }
        } else {
            if !same_positions {
                self.rebuild(&basis);
            }
            self.suspects.clear();
            self.recompute_values();
        }
        gone.retain(|&row| !self.present[row as usize]); // some had been there before
        self.forget_values(&gone);
        self.overwritten.clear();
        self.last_mark = exact.then_some(mark);
    }

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

    /// Notes a change, if there is a mark to go back to.
    pub(super) fn note(&mut self, change: Change) {
        if self.marked {
            self.changes.push(change);
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
        let stale = !self.marked && self.factor.mark() > REPLACEMENTS * self.basic.len();
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
        self.last_mark = None;
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

    pub(super) fn remember(&mut self, p: u32) {
        if self.last_mark.is_some() {
            self.overwritten.push((p, self.x[p as usize]));
        }
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
