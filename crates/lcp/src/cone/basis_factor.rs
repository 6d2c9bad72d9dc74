//! `B = L U` of a basis that changes one column at a time, touching only what the change reaches.
//!
//! Forrest and Tomlin, Updated triangular factors of the basis to maintain sparsity in the product form simplex
//! method (1972): the new column of `U` is the *spike* `L^-1 a`; its row is eliminated by one row of `L` and moves to the
//! end. Solves visit only entries that can differ from zero (Gilbert and Peierls, Sparse partial pivoting in time
//! proportional to arithmetic operations, 1988). Every change can be undone, last first.
//!
//! Rows and basis positions share one index: position p starts as the unit column of row p.

use super::{due::Due, sparse_vector::SparseVector};

type Entries = Vec<(u32, f64)>;

/// Row operation `x[target] -= sum of factor * x[row]`.
#[derive(Debug, Clone)]
struct RowOperation {
    target: u32,
    terms: Entries,
}

/// What one replacement took away.
#[derive(Debug, Clone)]
struct Undo {
    position: u32,
    column: Entries,
    row: Entries,
    diagonal: f64,
    operation: bool,
}

#[derive(Debug, Clone)]
pub(super) struct BasisFactor {
    /// Column p of `U` above its diagonal: (row, value).
    columns: Vec<Entries>,
    /// Row p of `U` right of its diagonal: (column, value).
    rows: Vec<Entries>,
    diagonal: Vec<f64>,
    operations: Vec<RowOperation>,
    /// Operations that read a row, ascending.
    readers: Vec<Vec<u32>>,
    /// Operations that write a row, ascending.
    writers: Vec<Vec<u32>>,
    undo: Vec<Undo>,
    due: Due,
    visited: Vec<bool>,
    order: Vec<u32>,
    stack: Vec<(u32, u32)>,
    work: SparseVector,
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
            columns: vec![Vec::new(); n],
            rows: vec![Vec::new(); n],
            diagonal: vec![1.0; n],
            operations: Vec::new(),
            readers: vec![Vec::new(); n],
            writers: vec![Vec::new(); n],
            undo: Vec::new(),
            due: Due::default(),
            visited: vec![false; n],
            order: Vec::new(),
            stack: Vec::new(),
            work: SparseVector::zero(n),
        }
    }

    /// `L^-1 a` in place: the spike of a column.
    pub fn apply_operations(&mut self, x: &mut SparseVector) {
        let Self { operations, readers, due, .. } = self;
        due.reset(operations.len());
        x.index().iter().for_each(|&i| due.insert_all(&readers[i as usize], 0..u32::MAX));
        while let Some(id) = due.take_first() {
            let operation = &operations[id as usize];
            let sum: f64 = operation.terms.iter().map(|&(row, factor)| factor * x.get(row)).sum();
            if sum != 0.0 {
                if x.list(operation.target) {
                    due.insert_all(&readers[operation.target as usize], id + 1..u32::MAX);
                }
                x.add(operation.target, -sum);
            }
        }
    }

    /// `U^-1 x` in place.
    pub fn solve_upper(&mut self, x: &mut SparseVector) {
        self.topological(x.index(), Side::Columns);
        x.list_all(&self.order);
        back_substitute(&self.order, &self.columns, &self.diagonal, x.values());
    }

    /// The entry of `B^-1 a` at a position that no later column of `U` reaches, straight from the spike.
    pub fn first_solved(&self, position: u32, spike: &SparseVector) -> Option<f64> {
        let p = position as usize;
        self.rows[p].is_empty().then(|| spike.get(position) / self.diagonal[p])
    }

    /// `B^-T c` in place.
    pub fn solve_transposed(&mut self, y: &mut SparseVector) {
        self.topological(y.index(), Side::Rows);
        y.list_all(&self.order);
        back_substitute(&self.order, &self.rows, &self.diagonal, y.values());
        let Self { operations, writers, due, .. } = self;
        due.reset(operations.len());
        y.index().iter().for_each(|&i| due.insert_all(&writers[i as usize], 0..u32::MAX));
        while let Some(id) = due.take_last() {
            let operation = &operations[id as usize];
            let value = y.get(operation.target);
            if value != 0.0 {
                for &(row, factor) in &operation.terms {
                    if y.list(row) {
                        due.insert_all(&writers[row as usize], 0..id);
                    }
                    y.add(row, -factor * value);
                }
            }
        }
    }

    /// Replaces the column at a position by the one with this spike.
    ///
    /// None (and no change) if the basis would become singular.
    pub fn replace(&mut self, position: u32, spike: &SparseVector) -> Option<Replacement> {
        let p = position as usize;
        let terms = self.eliminate_row(position);
        let diagonal = spike.get(position) - terms.iter().map(|&(q, r)| r * spike.get(q)).sum::<f64>();
        if diagonal.is_nan() || diagonal.abs() <= SINGULAR {
            return None;
        }
        let column: Entries = spike.iter().filter(|&(i, value)| i != position && value != 0.0).collect();
        let old_column = std::mem::replace(&mut self.columns[p], column);
        for &(i, _) in &old_column {
            drop_entry(&mut self.rows[i as usize], position);
        }
        let old_row = std::mem::take(&mut self.rows[p]);
        for &(q, _) in &old_row {
            drop_entry(&mut self.columns[q as usize], position);
        }
        for k in 0..self.columns[p].len() {
            let (i, value) = self.columns[p][k];
            self.rows[i as usize].push((position, value));
        }
        let operation = !terms.is_empty();
        let growth = terms.iter().fold(0.0_f64, |growth, (_, factor)| growth.max(factor.abs()));
        if operation {
            let id = self.operations.len() as u32;
            terms.iter().for_each(|&(row, _)| self.readers[row as usize].push(id));
            self.writers[p].push(id);
            self.operations.push(RowOperation { target: position, terms });
        }
        let old_diagonal = std::mem::replace(&mut self.diagonal[p], diagonal);
        self.undo.push(Undo { position, column: old_column, row: old_row, diagonal: old_diagonal, operation });
        Some(Replacement { rate: diagonal / old_diagonal, growth })
    }

    /// The combination r of other rows of `U` with `row p - sum r_q row q = 0` right of the diagonal.
    fn eliminate_row(&mut self, position: u32) -> Entries {
        let mut v = std::mem::take(&mut self.work);
        for &(q, value) in &self.rows[position as usize] {
            v.set(q, value);
        }
        self.topological(v.index(), Side::Rows);
        v.list_all(&self.order);
        back_substitute(&self.order, &self.rows, &self.diagonal, v.values());
        let terms = v.iter().filter(|&(_, factor)| factor != 0.0).collect();
        v.clear();
        self.work = v;
        terms
    }

    /// Number of replacements made, to come back to with [`Self::undo_to`].
    pub fn mark(&self) -> usize {
        self.undo.len()
    }

    /// Takes back replacements, the last first.
    pub fn undo_to(&mut self, mark: usize) {
        while self.undo.len() > mark
            && let Some(Undo { position, column, row, diagonal, operation }) = self.undo.pop()
        {
            let p = position as usize;
            if operation && let Some(last) = self.operations.pop() {
                for (row, _) in last.terms {
                    self.readers[row as usize].pop();
                }
                self.writers[p].pop();
            }
            for (i, _) in std::mem::take(&mut self.columns[p]) {
                drop_entry(&mut self.rows[i as usize], position);
            }
            column.iter().for_each(|&(i, value)| self.rows[i as usize].push((position, value)));
            row.iter().for_each(|&(q, value)| self.columns[q as usize].push((position, value)));
            self.columns[p] = column;
            self.rows[p] = row;
            self.diagonal[p] = diagonal;
        }
    }

    /// Back to the identity; nothing before can be undone.
    pub fn reset(&mut self) {
        *self = Self::identity(self.diagonal.len());
    }

    /// Stored numbers.
    pub fn entries(&self) -> usize {
        let upper: usize = self.columns.iter().map(Vec::len).sum();
        upper + self.diagonal.len() + self.operations.iter().map(|operation| operation.terms.len()).sum::<usize>()
    }

    /// Everything reachable from the seeds, in postorder: reversed, every entry comes before those it changes.
    fn topological(&mut self, seeds: &[u32], side: Side) {
        self.order.clear();
        let lists = if side == Side::Columns { &self.columns } else { &self.rows };
        for &seed in seeds {
            if std::mem::replace(&mut self.visited[seed as usize], true) {
                continue;
            }
            self.stack.push((seed, 0));
            while let Some((node, next)) = self.stack.last_mut() {
                match lists[*node as usize].get(*next as usize) {
                    Some(&(child, _)) => {
                        *next += 1;
                        if !std::mem::replace(&mut self.visited[child as usize], true) {
                            self.stack.push((child, 0));
                        }
                    }
                    None => {
                        self.order.push(*node);
                        self.stack.pop();
                    }
                }
            }
        }
        for &node in &self.order {
            self.visited[node as usize] = false;
        }
    }
}

/// Solves with a triangle whose entries that matter are listed in postorder.
fn back_substitute(order: &[u32], lists: &[Entries], diagonal: &[f64], x: &mut [f64]) {
    for &p in order.iter().rev() {
        let value = x[p as usize] / diagonal[p as usize];
        x[p as usize] = value;
        if value != 0.0 {
            for &(i, u) in &lists[p as usize] {
                x[i as usize] -= u * value;
            }
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Columns,
    Rows,
}

/// Removes the first entry with this index.
fn drop_entry(entries: &mut Entries, index: u32) {
    if let Some(place) = entries.iter().position(|&(i, _)| i == index) {
        entries.swap_remove(place);
    }
}
