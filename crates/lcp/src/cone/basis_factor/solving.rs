//! Solves with the factor that visit only what can be nonzero.

use super::{BasisFactor, Reach, Stage};
use crate::cone::sparse_vector::SparseVector;

impl BasisFactor {
    /// `L^-1 a` in place: the spike of a column.
    pub fn apply_operations(&mut self, x: &mut SparseVector) {
        let Self { operations, terms, readers, due, read_below, .. } = self;
        due.reset(operations.len());
        x.index().iter().for_each(|&i| due.insert_all(readers.of(i)));
        let mut due = due.upward();
        while let Some(id) = due.take() {
            let operation = &operations[id as usize];
            *read_below += operation.range().len();
            let sum: f64 = terms[operation.range()].iter().map(|&(row, factor)| factor * x.get(row)).sum();
            if sum != 0.0 {
                if x.list(operation.target) {
                    due.insert_after(id, readers.of(operation.target));
                }
                x.add(operation.target, -sum);
            }
        }
    }

    /// `U^-1 spike` as (position, value), the later stages first; nothing that is zero.
    pub fn solve_upper(&mut self, spike: &SparseVector, solution: &mut Vec<(u32, f64)>) {
        solution.clear();
        self.walk_upper(spike, |position, value| {
            solution.push((position, value));
            Reach::All
        });
    }

    /// `U^-1 spike`, the later stages first: `visit` sees each (position, value) that is not zero and says how far
    /// the value is passed on. What it keeps back is missing from the values that follow.
    pub fn walk_upper(&mut self, spike: &SparseVector, mut visit: impl FnMut(u32, f64) -> Reach) {
        self.walk(spike, |_, position, value| visit(position, value));
    }

    /// [`Self::solve_upper`] as if `U` had none but the columns from stage `first` on: exact where no older column has an
    /// entry.
    pub fn solve_newest(&mut self, first: usize, spike: &SparseVector, solution: &mut Vec<(u32, f64)>) {
        solution.clear();
        self.walk(spike, |stage, position, value| {
            solution.push((position, value));
            if stage as usize >= first { Reach::All } else { Reach::Nowhere }
        });
    }

    /// Stages given so far; the next column put in gets this number.
    pub fn stages(&self) -> usize {
        self.stages.len()
    }

    fn walk(&mut self, spike: &SparseVector, mut visit: impl FnMut(u32, u32, f64) -> Reach) {
        self.seed(spike);
        let Self { stages, above, due, work, group, read, .. } = self;
        let mut due = due.downward();
        while let Some(s) = due.take() {
            let stage = &stages[s as usize];
            let value = std::mem::take(&mut work[s as usize]) * stage.reciprocal;
            if value == 0.0 {
                continue;
            }
            *read += 1 + stage.len as usize;
            let mut pass_on = |i: u32, u: f64| {
                work[i as usize] -= u * value;
                due.insert(i);
            };
            match visit(s, stage.position, value) {
                Reach::All => above[stage.range()].iter().for_each(|&(i, u)| pass_on(i, u)),
                Reach::Nowhere => {}
                Reach::Group => {
                    let of = |stage: &Stage| group[stage.position as usize];
                    let inside = |&&(i, _): &&(u32, f64)| of(&stages[i as usize]) == of(stage);
                    above[stage.range()].iter().filter(inside).for_each(|&(i, u)| pass_on(i, u));
                }
            }
        }
    }

    /// The entry of `B^-1 a` at a position that no later column of `U` reaches, straight from the spike.
    pub fn first_solved(&self, position: u32, spike: &SparseVector) -> Option<f64> {
        let s = self.stage[position as usize];
        (self.rows.len_of(s) == 0).then(|| spike.get(position) * self.stages[s as usize].reciprocal)
    }

    /// `B^-T c` in place.
    pub fn solve_transposed(&mut self, y: &mut SparseVector) {
        self.seed(y);
        y.clear();
        self.solve_rows(|position, value| y.set(position, value));
        let Self { operations, terms, writers, due, read_below, .. } = self;
        due.reset(operations.len());
        y.index().iter().for_each(|&i| due.insert_all(writers.of(i)));
        let mut due = due.downward();
        while let Some(id) = due.take() {
            let operation = &operations[id as usize];
            let value = y.get(operation.target);
            if value != 0.0 {
                *read_below += operation.range().len();
                for &(row, factor) in &terms[operation.range()] {
                    if y.list(row) {
                        due.insert_before(id, writers.of(row));
                    }
                    y.add(row, -factor * value);
                }
            }
        }
    }

    /// Takes a right-hand side, by position, into the work vector.
    fn seed(&mut self, x: &SparseVector) {
        self.due.reset(self.stages.len());
        for (i, value) in x.iter() {
            let stage = self.stage[i as usize];
            self.work[stage as usize] = value;
            self.due.insert(stage);
        }
    }

    /// `U^-T` of the work vector: the values that are not zero, by position, the earlier stages first.
    pub(super) fn solve_rows(&mut self, mut found: impl FnMut(u32, f64)) {
        let Self { stages, rows, due, work, read, .. } = self;
        let mut due = due.upward();
        while let Some(s) = due.take() {
            let stage = &stages[s as usize];
            let value = std::mem::take(&mut work[s as usize]) * stage.reciprocal;
            if value != 0.0 {
                found(stage.position, value);
                *read += 1 + rows.len_of(s);
                for &(right, u) in rows.of(s) {
                    work[right as usize] -= u * value;
                    due.insert(right);
                }
            }
        }
    }
}
