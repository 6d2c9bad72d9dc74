//! A basis from nothing: its factor is built again, and the values are computed anew.

use super::{Basic, ConeSolver, FILL, PIVOT, SAFE_PIVOT, basis::BasisSet, infeasible};

impl ConeSolver {
    /// Begins from a basis of these columns, as far as all their rows are present: those that depend on others stay out, and
    /// unit columns take the places that are left. The next answer makes the pivots that remain. Marks end here. A factor that takes
    /// more than the [effort](Self::limit_effort) is none: the unit columns remain.
    pub fn start_from(&mut self, columns: impl IntoIterator<Item = usize>) {
        self.forget();
        let whole = |&j: &u32| self.present.takes_part(j);
        let columns = columns.into_iter().map(|j| j as u32).filter(whole).collect();
        let units: Vec<bool> = self.present.is_there.iter().map(|present| !present).collect();
        if !self.rebuild_while(&BasisSet { columns, units }, |solver| !solver.is_exhausted()) {
            self.rebuild(&BasisSet { columns: Vec::new(), units: vec![true; self.basis.basic.len()] });
        }
        self.recompute_values();
    }

    /// Builds the factor again from a basis. The columns go in group by group, the oldest first, which keeps the factor
    /// sparse: the columns of a group press on older ones. One that depends on those before it stays out. What bears has
    /// to be found out anew. False if the factor refuses a column.
    pub(super) fn rebuild(&mut self, basis: &BasisSet) -> bool {
        self.rebuild_while(basis, |_| true)
    }

    /// The same as long as `go_on`, asked before each column, says so; false if it does not.
    fn rebuild_while(&mut self, basis: &BasisSet, go_on: impl Fn(&Self) -> bool) -> bool {
        self.counts.refactorisations += 1;
        self.journal.lose_values();
        self.bearing.mixed = true;
        self.basis.factor.reset();
        self.values.suspects.clear();
        for p in 0..self.basis.basic.len() as u32 {
            if let Some(j) = self.basis.column_in(p) {
                self.take_out(j);
                self.basis.put(p, Basic::Unit);
            }
        }
        let mut columns = basis.columns.clone();
        columns.sort_by_cached_key(|&j| (self.column_group(j), j));
        (0..self.bearing.bears.len() as u32).for_each(|j| self.bearing.doubt(j, &mut self.journal));
        let (mut group, mut first) = (0, 0);
        for j in columns {
            if !go_on(self) {
                return false;
            }
            if self.column_group(j) != group {
                (group, first) = (self.column_group(j), self.basis.factor.stages());
            }
            self.column_spike(j);
            let place = self.place_in_group(group, first, basis).or_else(|| self.place_anywhere(basis));
            let Some(p) = place else { continue };
            if self.basis.factor.replace(p, &self.pivot.spike).is_none() {
                return false;
            }
            self.basis.put(p, Basic::Column(j));
        }
        self.basis.most_entries = FILL * self.basis.factor.stored();
        true
    }

    /// A place in the rows of its own group for a column whose spike is there, if there is a good one. No older column has an
    /// entry there: only the columns of the group, which are those from stage `first` on, are walked through.
    fn place_in_group(&mut self, group: u32, first: usize, basis: &BasisSet) -> Option<u32> {
        self.basis.factor.solve_newest(first, &self.pivot.spike, &mut self.pivot.direction);
        self.pivot.direction.retain(|&(p, _)| self.basis.factor.group(p) == group);
        self.largest_free(basis).filter(|best| best.1.abs() > SAFE_PIVOT).map(|best| best.0)
    }

    /// A place wherever such a column has an entry.
    fn place_anywhere(&mut self, basis: &BasisSet) -> Option<u32> {
        self.direction_from_spike();
        self.largest_free(basis).filter(|best| best.1.abs() > PIVOT).map(|best| best.0)
    }

    /// The largest entry of the direction in a row that has no column yet and is to have one.
    fn largest_free(&self, basis: &BasisSet) -> Option<(u32, f64)> {
        let free = |&&(p, _): &&(u32, f64)| !basis.units[p as usize] && self.basis.is_unit(p);
        self.pivot.direction.iter().filter(free).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).copied()
    }

    /// `x = B^-1 h` on the present rows.
    pub(super) fn recompute_values(&mut self) {
        self.pivot.spike.clear();
        for &row in &self.present.rows {
            self.pivot.spike.set(row, self.problem.h[row as usize]);
        }
        self.basis.factor.apply_operations(&mut self.pivot.spike);
        self.direction_from_spike();
        for k in 0..self.present.rows.len() {
            let row = self.present.rows[k];
            self.journal.remember(row, &self.values);
            self.set_value(row, 0.0);
        }
        for k in 0..self.pivot.direction.len() {
            let (p, value) = self.pivot.direction[k];
            self.set_value(p, value);
            if infeasible(self.basis.basic[p as usize], value, self.values.zero) != 0.0 {
                self.values.suspects.push(p);
            }
        }
        self.sum_rows();
        self.bearing.behind = false;
    }
}
