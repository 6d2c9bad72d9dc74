//! `B = L U` of a basis that changes one column at a time, touching only what the change reaches.
//!
//! Forrest and Tomlin, Updated triangular factors of the basis to maintain sparsity in the product form simplex
//! method (1972): the new column of `U` is the *spike* `L^-1 a`; its row is eliminated by one row of `L` and moves to the
//! end. Solves visit only entries that can differ from zero, as in Gilbert and Peierls, Sparse partial pivoting in time
//! proportional to arithmetic operations (1988). Every change can be undone, last first.
//!
//! Rows and basis positions share one index: position p starts as the unit column of row p. Each column put in gets the
//! next *stage*, a number that it keeps for good, and takes its row along: `U` is upper triangular in the order of the
//! stages, and its entries join stages. What a replaced column was stays behind under its old stage, to be put back.

use super::{due::Due, sparse_vector::SparseVector};
use std::ops::Range;

type Entries = Vec<(u32, f64)>;

/// Row operation `x[target] -= sum of factor * x[row]`.
#[derive(Debug, Clone)]
struct RowOperation {
    target: u32,
    terms: Entries,
}

/// One replacement: the stage that the position had before, and whether it needed a row operation.
#[derive(Debug, Clone, Copy)]
struct Undo {
    position: u32,
    stage: u32,
    operation: bool,
}

/// A column of `U`.
#[derive(Debug, Clone, Copy)]
struct Stage {
    position: u32,
    /// Where its entries above the diagonal are, and how many. It never has more than when it was put in.
    start: u32,
    len: u32,
    /// One over the diagonal entry: a multiplication is sooner done than a division.
    reciprocal: f64,
}

impl Stage {
    fn unit(position: u32) -> Self {
        Self { position, start: 0, len: 0, reciprocal: 1.0 }
    }

    fn range(&self) -> Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
}

#[derive(Debug, Clone)]
pub(super) struct BasisFactor {
    stages: Vec<Stage>,
    /// Stage of the column in each position.
    stage: Vec<u32>,
    /// Entries of the columns of `U` above the diagonal: (stage, value).
    above: Entries,
    /// Row of `U` right of its diagonal, by stage: (stage, value).
    rows: Vec<Entries>,
    operations: Vec<RowOperation>,
    /// Operations that read a row, ascending.
    readers: Vec<Vec<u32>>,
    /// Operations that write a row, ascending.
    writers: Vec<Vec<u32>>,
    undo: Vec<Undo>,
    /// Rows that came together have one number, later ones a larger one.
    group: Vec<u32>,
    /// Numbers stored off the diagonal of `U`, and in the row operations.
    stored: usize,
    /// Numbers read by triangular solves.
    read: usize,
    due: Due,
    /// By stage; zero between solves.
    work: Vec<f64>,
}

/// How far a value is passed on in a walk through `U`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// To every row of its column.
    All,
    /// To the rows of its own group only.
    Group,
}

/// What a replacement says about its accuracy.
#[derive(Debug, Clone, Copy)]
pub(super) struct Replacement {
    /// New pivot over old one: equals the entry of `B^-1 a` at the position, by another route.
    pub rate: f64,
    /// Largest factor of the row operation: errors grow by it.
    pub growth: f64,
}

/// A replacement whose pivot is at or below this (columns have a largest entry of one) would make the basis singular.
const SINGULAR: f64 = 1e-11;

impl BasisFactor {
    pub fn identity(n: usize) -> Self {
        Self {
            stages: (0..n as u32).map(Stage::unit).collect(),
            stage: (0..n as u32).collect(),
            above: Vec::new(),
            rows: vec![Vec::new(); n],
            operations: Vec::new(),
            readers: vec![Vec::new(); n],
            writers: vec![Vec::new(); n],
            undo: Vec::new(),
            group: vec![0; n],
            stored: 0,
            read: 0,
            due: Due::default(),
            work: vec![0.0; n],
        }
    }

    /// `L^-1 a` in place: the spike of a column.
    pub fn apply_operations(&mut self, x: &mut SparseVector) {
        let Self { operations, readers, due, .. } = self;
        due.reset(operations.len());
        x.index().iter().for_each(|&i| due.insert_all(&readers[i as usize]));
        let mut due = due.upward();
        while let Some(id) = due.take() {
            let operation = &operations[id as usize];
            let sum: f64 = operation.terms.iter().map(|&(row, factor)| factor * x.get(row)).sum();
            if sum != 0.0 {
                if x.list(operation.target) {
                    due.insert_after(id, &readers[operation.target as usize]);
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
            match visit(stage.position, value) {
                Reach::All => above[stage.range()].iter().for_each(|&(i, u)| pass_on(i, u)),
                Reach::Group => {
                    let of = |stage: &Stage| group[stage.position as usize];
                    let inside = |&&(i, _): &&(u32, f64)| of(&stages[i as usize]) == of(stage);
                    above[stage.range()].iter().filter(inside).for_each(|&(i, u)| pass_on(i, u));
                }
            }
        }
    }

    /// Puts a row into a group, whose number must be larger than all before.
    pub fn set_group(&mut self, row: u32, group: u32) {
        self.group[row as usize] = group;
    }

    /// The group of a row.
    pub fn group(&self, row: u32) -> u32 {
        self.group[row as usize]
    }

    /// The entry of `B^-1 a` at a position that no later column of `U` reaches, straight from the spike.
    pub fn first_solved(&self, position: u32, spike: &SparseVector) -> Option<f64> {
        let s = self.stage[position as usize] as usize;
        self.rows[s].is_empty().then(|| spike.get(position) * self.stages[s].reciprocal)
    }

    /// `B^-T c` in place.
    pub fn solve_transposed(&mut self, y: &mut SparseVector) {
        self.seed(y);
        y.clear();
        self.solve_rows(|position, value| y.set(position, value));
        let Self { operations, writers, due, .. } = self;
        due.reset(operations.len());
        y.index().iter().for_each(|&i| due.insert_all(&writers[i as usize]));
        let mut due = due.downward();
        while let Some(id) = due.take() {
            let operation = &operations[id as usize];
            let value = y.get(operation.target);
            if value != 0.0 {
                for &(row, factor) in &operation.terms {
                    if y.list(row) {
                        due.insert_before(id, &writers[row as usize]);
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
    fn solve_rows(&mut self, mut found: impl FnMut(u32, f64)) {
        let Self { stages, rows, due, work, read, .. } = self;
        let mut due = due.upward();
        while let Some(s) = due.take() {
            let stage = &stages[s as usize];
            let value = std::mem::take(&mut work[s as usize]) * stage.reciprocal;
            if value != 0.0 {
                found(stage.position, value);
                *read += 1 + rows[s as usize].len();
                for &(right, u) in &rows[s as usize] {
                    work[right as usize] -= u * value;
                    due.insert(right);
                }
            }
        }
    }

    /// Replaces the column at a position by the one with this spike.
    ///
    /// None (and no change) if the basis would become singular.
    pub fn replace(&mut self, position: u32, spike: &SparseVector) -> Option<Replacement> {
        let p = position as usize;
        let old = self.stage[p];
        let terms = self.eliminate_row(old);
        let diagonal = spike.get(position) - terms.iter().map(|&(q, r)| r * spike.get(q)).sum::<f64>();
        if diagonal.is_nan() || diagonal.abs() <= SINGULAR {
            return None;
        }
        self.unlink(old);
        let rate = diagonal * self.stages[old as usize].reciprocal;
        let growth = terms.iter().fold(0.0_f64, |growth, (_, factor)| growth.max(factor.abs()));
        self.undo.push(Undo { position, stage: old, operation: !terms.is_empty() });
        if !terms.is_empty() {
            let id = self.operations.len() as u32;
            self.stored += terms.len();
            terms.iter().for_each(|&(row, _)| self.readers[row as usize].push(id));
            self.writers[p].push(id);
            self.operations.push(RowOperation { target: position, terms });
        }
        let (new, start) = (self.stages.len() as u32, self.above.len());
        for (i, value) in spike.iter().filter(|&(i, value)| i != position && value != 0.0) {
            let stage = self.stage[i as usize];
            self.above.push((stage, value));
            self.rows[stage as usize].push((new, value));
        }
        let len = (self.above.len() - start) as u32;
        self.stored += len as usize;
        self.stages.push(Stage { position, start: start as u32, len, reciprocal: diagonal.recip() });
        self.rows.push(Vec::new());
        self.work.push(0.0);
        self.stage[p] = new;
        Some(Replacement { rate, growth })
    }

    /// Takes a stage's column out of the rows it stands in, and its row out of the columns.
    fn unlink(&mut self, stage: u32) {
        self.stored -= self.entries_of(stage);
        let Self { stages, above, rows, .. } = self;
        above[stages[stage as usize].range()].iter().for_each(|&(i, _)| drop_entry(&mut rows[i as usize], stage));
        for &(q, _) in &rows[stage as usize] {
            let column = &mut stages[q as usize];
            let entries = &mut above[column.range()];
            if let Some(place) = entries.iter().position(|&(i, _)| i == stage) {
                entries.swap(place, column.len as usize - 1);
                column.len -= 1;
            }
        }
    }

    /// Numbers in the column and in the row of a stage.
    fn entries_of(&self, stage: u32) -> usize {
        self.stages[stage as usize].len as usize + self.rows[stage as usize].len()
    }

    /// Undoes [`Self::unlink`].
    fn link(&mut self, stage: u32) {
        self.stored += self.entries_of(stage);
        let Self { stages, above, rows, .. } = self;
        above[stages[stage as usize].range()].iter().for_each(|&(i, value)| rows[i as usize].push((stage, value)));
        for &(q, value) in &rows[stage as usize] {
            let column = &mut stages[q as usize];
            column.len += 1;
            above[column.range().end - 1] = (stage, value);
        }
    }

    /// The combination r of other rows of `U` with `row - sum r_q row q = 0` right of the diagonal; rows by position.
    fn eliminate_row(&mut self, stage: u32) -> Entries {
        self.due.reset(self.stages.len());
        for &(q, value) in &self.rows[stage as usize] {
            self.work[q as usize] = value;
            self.due.insert(q);
        }
        let mut terms = Vec::new();
        self.solve_rows(|position, factor| terms.push((position, factor)));
        terms
    }

    /// Changes the number of rows; nothing before can be undone. New rows have their unit columns, and so must those that go.
    pub fn resize(&mut self, n: usize) {
        for position in self.stage.len()..n {
            self.stage.push(self.stages.len() as u32);
            self.stages.push(Stage::unit(position as u32));
            self.rows.push(Vec::new());
            self.work.push(0.0);
        }
        self.stage.truncate(n); // the stages stay behind, as those of replaced columns do
        self.readers.resize(n, Vec::new());
        self.writers.resize(n, Vec::new());
        self.group.resize(n, 0);
        self.forget();
    }

    /// Number of replacements made, to come back to with [`Self::undo_to`].
    pub fn mark(&self) -> usize {
        self.undo.len()
    }

    /// Nobody takes replacements back from here.
    pub fn forget(&mut self) {
        self.undo.clear();
    }

    /// Replaced columns that are still kept.
    pub fn left_behind(&self) -> usize {
        self.stages.len() - self.stage.len()
    }

    /// Takes back replacements, the last first.
    pub fn undo_to(&mut self, mark: usize) {
        while self.undo.len() > mark
            && let Some(Undo { position, stage, operation }) = self.undo.pop()
        {
            let p = position as usize;
            if operation && let Some(last) = self.operations.pop() {
                self.stored -= last.terms.len();
                for (row, _) in last.terms {
                    self.readers[row as usize].pop();
                }
                self.writers[p].pop();
            }
            let new = self.stage[p];
            self.unlink(new);
            self.above.truncate(self.stages[new as usize].start as usize);
            self.stages.pop();
            self.rows.pop();
            self.work.pop();
            self.link(stage);
            self.stage[p] = stage;
        }
    }

    /// Back to the identity; nothing before can be undone.
    pub fn reset(&mut self) {
        let (group, read) = (std::mem::take(&mut self.group), self.read);
        *self = Self { group, read, ..Self::identity(self.stage.len()) };
    }

    /// Numbers read by triangular solves since the factor was made.
    pub fn read(&self) -> usize {
        self.read
    }

    /// Stored numbers without the diagonal of `U`.
    pub fn stored(&self) -> usize {
        self.stored
    }

    /// Stored numbers.
    pub fn entries(&self) -> usize {
        self.stage.len() + self.stored
    }
}

/// Removes the entry with this index.
fn drop_entry(entries: &mut Entries, index: u32) {
    if let Some(place) = entries.iter().position(|&(i, _)| i == index) {
        entries.swap_remove(place);
    }
}
