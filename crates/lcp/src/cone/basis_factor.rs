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

mod solving;
mod undoing;

use super::{due::Due, lists::Lists, sparse_vector::SparseVector};
use crate::interrupt::Tally;
use serde::{Deserialize, Serialize};
use std::ops::Range;

type Entries = Vec<(u32, f64)>;

/// Row operation `x[target] -= sum of factor * x[row]`, and where its terms (row, factor) are.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct RowOperation {
    target: u32,
    start: u32,
    end: u32,
}

impl RowOperation {
    fn range(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// One replacement: the stage that the position had before, and whether it needed a row operation.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Undo {
    position: u32,
    stage: u32,
    operation: bool,
}

/// A column of `U`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
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

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct BasisFactor {
    stages: Vec<Stage>,
    /// Stage of the column in each position.
    stage: Vec<u32>,
    /// Entries of the columns of `U` above the diagonal: (stage, value).
    above: Entries,
    /// Row of `U` right of its diagonal, by stage: (stage, value).
    rows: Lists<(u32, f64)>,
    operations: Vec<RowOperation>,
    /// Terms of all operations, one after the other.
    terms: Entries,
    /// Operations that read a row, ascending.
    readers: Lists<u32>,
    /// Operations that write a row, ascending.
    writers: Lists<u32>,
    undo: Vec<Undo>,
    /// Rows that came together have one number, later ones a larger one.
    group: Vec<u32>,
    /// Numbers stored off the diagonal of `U`, and in the row operations.
    stored: usize,
    /// Numbers read by triangular solves.
    read: usize,
    /// Numbers read in row operations.
    read_below: usize,
    due: Due,
    /// By stage; zero between solves.
    work: Vec<f64>,
    #[serde(skip)]
    tally: Tally,
    /// Numbers read that have been counted there.
    #[serde(skip)]
    counted: usize,
}

/// How far a value is passed on in a walk through `U`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// To every row of its column.
    All,
    /// To the rows of its own group only.
    Group,
    /// To none.
    Nowhere,
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

/// Operations of the walks of a pivot beside the numbers that they read.
const WALKS: usize = 128;

impl BasisFactor {
    pub fn identity(n: usize) -> Self {
        // Room for a column in every position.
        let mut stages = Vec::with_capacity(2 * n);
        stages.extend((0..n as u32).map(Stage::unit));
        Self {
            stages,
            stage: (0..n as u32).collect(),
            above: Vec::with_capacity(4 * n),
            rows: Lists::empty(n),
            operations: Vec::new(),
            terms: Vec::new(),
            readers: Lists::empty(n),
            writers: Lists::empty(n),
            undo: Vec::new(),
            group: vec![0; n],
            stored: 0,
            read: 0,
            read_below: 0,
            due: Due::default(),
            work: vec![0.0; n],
            tally: Tally::default(),
            counted: 0,
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

    /// Replaces the column at a position by the one with this spike.
    ///
    /// None (and no change) if the basis would become singular.
    pub fn replace(&mut self, position: u32, spike: &SparseVector) -> Option<Replacement> {
        self.count_walks();
        let p = position as usize;
        let old = self.stage[p];
        let first = self.terms.len();
        self.eliminate_row(old);
        let terms = &self.terms[first..];
        let diagonal = spike.get(position) - terms.iter().map(|&(q, r)| r * spike.get(q)).sum::<f64>();
        if diagonal.is_nan() || diagonal.abs() <= SINGULAR {
            self.terms.truncate(first);
            return None;
        }
        let rate = diagonal * self.stages[old as usize].reciprocal;
        let growth = terms.iter().fold(0.0_f64, |growth, (_, factor)| growth.max(factor.abs()));
        self.undo.push(Undo { position, stage: old, operation: !terms.is_empty() });
        if !terms.is_empty() {
            let id = self.operations.len() as u32;
            self.stored += terms.len();
            terms.iter().for_each(|&(row, _)| self.readers.push(row, id));
            self.writers.push(position, id);
            let (start, end) = (first as u32, self.terms.len() as u32);
            self.operations.push(RowOperation { target: position, start, end });
        }
        self.unlink(old);
        let (new, start) = (self.stages.len() as u32, self.above.len());
        for (i, value) in spike.iter().filter(|&(i, value)| i != position && value != 0.0) {
            let stage = self.stage[i as usize];
            self.above.push((stage, value));
            self.rows.push(stage, (new, value));
        }
        let len = (self.above.len() - start) as u32;
        self.stored += len as usize;
        self.stages.push(Stage { position, start: start as u32, len, reciprocal: diagonal.recip() });
        self.rows.push_list();
        self.work.push(0.0);
        self.stage[p] = new;
        Some(Replacement { rate, growth })
    }

    /// Takes a stage's column out of the rows it stands in, and its row out of the columns.
    fn unlink(&mut self, stage: u32) {
        self.stored -= self.entries_of(stage);
        let Self { stages, above, rows, .. } = self;
        above[stages[stage as usize].range()].iter().for_each(|&(i, _)| drop_entry(rows, i, stage));
        for &(q, _) in rows.of(stage) {
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
        self.stages[stage as usize].len as usize + self.rows.len_of(stage)
    }

    /// Puts behind the terms of the operations the combination r of other rows of `U` with `row - sum r_q row q = 0` right of
    /// the diagonal; rows by position.
    fn eliminate_row(&mut self, stage: u32) {
        self.due.reset(self.stages.len());
        for &(q, value) in self.rows.of(stage) {
            self.work[q as usize] = value;
            self.due.insert(q);
        }
        let mut terms = std::mem::take(&mut self.terms);
        self.solve_rows(|position, factor| terms.push((position, factor)));
        self.terms = terms;
    }

    /// Back to the identity; nothing before can be undone.
    pub fn reset(&mut self) {
        let Self { read, read_below, tally, counted, .. } = *self;
        let group = std::mem::take(&mut self.group);
        *self = Self { group, read, read_below, tally, counted, ..Self::identity(self.stage.len()) };
    }

    /// Numbers read by triangular solves since the factor was made.
    pub fn read(&self) -> usize {
        self.read
    }

    /// Numbers read in all since the factor was made.
    pub fn effort(&self) -> usize {
        self.read + self.read_below
    }

    /// Counts what walks have read since this was last done ([`crate::interrupt`]).
    pub fn count_walks(&mut self) {
        let effort = self.effort();
        self.tally.count(WALKS + effort - std::mem::replace(&mut self.counted, effort));
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

/// Removes a row's entry with this index.
fn drop_entry(rows: &mut Lists<(u32, f64)>, row: u32, index: u32) {
    if let Some(place) = rows.of(row).iter().position(|&(i, _)| i == index) {
        rows.swap_remove(row, place);
    }
}
