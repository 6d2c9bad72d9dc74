//! What is kept: the basis, whose factor can be built again, and the values.

use super::{Basic, Change, ConeSolver, FILL, PIVOT, SAFE_PIVOT, infeasible};

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
    /// Begins from a basis of these columns, as far as all their rows are present: those that depend on others stay out, and
    /// unit columns take the places that are left. The next answer makes the pivots that remain. Marks end here.
    pub fn start_from(&mut self, columns: impl IntoIterator<Item = usize>) {
        self.forget();
        let whole = |&j: &u32| self.missing[j as usize] == 0;
        let columns = columns.into_iter().map(|j| j as u32).filter(whole).collect();
        let units: Vec<bool> = self.present.iter().map(|present| !present).collect();
        if !self.rebuild(&BasisSet { columns, units }) {
            self.rebuild(&BasisSet { columns: Vec::new(), units: vec![true; self.basic.len()] });
        }
        self.recompute_values();
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

    /// A column is not known to bear any more.
    pub(super) fn bears_no_more(&mut self, j: u32) {
        if std::mem::take(&mut self.bears[j as usize]) {
            self.note(Change::Doubted(j));
        }
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
        columns.sort_by_cached_key(|&j| (self.column_group(j), j));
        (0..self.bears.len() as u32).for_each(|j| self.bears_no_more(j));
        let (mut group, mut first) = (0, 0);
        for j in columns {
            if self.column_group(j) != group {
                (group, first) = (self.column_group(j), self.factor.stages());
            }
            self.column_spike(j);
            let place = self.place_in_group(group, first, basis).or_else(|| self.place_anywhere(basis));
            let Some(p) = place else { continue };
            if self.factor.replace(p, &self.spike).is_none() {
                return false;
            }
            self.put(p, Basic::Column(j));
        }
        self.most_entries = FILL * self.factor.stored();
        true
    }

    /// A place in the rows of its own group for a column whose spike is there, if there is a good one. No older column has an
    /// entry there: only the columns of the group, which are those from stage `first` on, are walked through.
    fn place_in_group(&mut self, group: u32, first: usize, basis: &BasisSet) -> Option<u32> {
        self.factor.solve_newest(first, &self.spike, &mut self.direction);
        self.direction.retain(|&(p, _)| self.factor.group(p) == group);
        self.largest_free(basis).filter(|best| best.1.abs() > SAFE_PIVOT).map(|best| best.0)
    }

    /// A place wherever such a column has an entry.
    fn place_anywhere(&mut self, basis: &BasisSet) -> Option<u32> {
        self.direction_from_spike();
        self.largest_free(basis).filter(|best| best.1.abs() > PIVOT).map(|best| best.0)
    }

    /// The largest entry of the direction in a row that has no column yet and is to have one.
    fn largest_free(&self, basis: &BasisSet) -> Option<(u32, f64)> {
        let free = |&&(p, _): &&(u32, f64)| !basis.units[p as usize] && self.basic[p as usize] == Basic::Unit;
        self.direction.iter().filter(free).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).copied()
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
            if infeasible(self.basic[p as usize], value, self.zero) != 0.0 {
                self.suspects.push(p);
            }
        }
        self.sum_rows();
        self.behind = false;
    }
}
