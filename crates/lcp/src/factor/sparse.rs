//! Sparse `L D L'` of the active block on the static pattern of the complete matrix.
//!
//! Rows enter and leave along paths of the elimination tree: Davis and Hager, Row modifications of a sparse
//! Cholesky factorization (2005). An inactive row is a row and column of the identity.

use super::{ActiveFactor, FactorNumbers, LOST, RankOne, SingularBlock, symbolic::Symbolic};
use crate::{interrupt::poll, matrix::SparseColumns};
use std::sync::Arc;

/// Values of `L` and `D` on a `Symbolic` pattern that is shared by all clones.
#[derive(Debug, Clone)]
pub struct SparseFactor {
    symbolic: Arc<Symbolic>,
    l: Vec<f64>,
    d: Vec<f64>,
    active: Vec<bool>,
    rows_active: usize,
    scratch: Vec<f64>,
}

impl SparseFactor {
    /// Analyses the complete matrix; the active set is empty.
    pub fn new(m: &SparseColumns) -> Self {
        let symbolic = Symbolic::new(m);
        let (n, entries) = (symbolic.len(), symbolic.rows.len());
        Self {
            symbolic: Arc::new(symbolic),
            l: vec![0.0; entries],
            d: vec![1.0; n],
            active: vec![false; n],
            rows_active: 0,
            scratch: vec![0.0; n],
        }
    }

    /// Scatters row `k` of the active block into the scratch vector; returns the diagonal.
    fn scatter(&mut self, m: &SparseColumns, i: usize) -> f64 {
        let (rows, values) = m.column(i);
        let mut diagonal = 0.0;
        for (&j, &value) in rows.iter().zip(values) {
            let p = self.symbolic.position[j];
            if j == i {
                diagonal = value;
            } else if self.active[p] {
                self.scratch[p] = value;
            }
        }
        diagonal
    }

    /// Adds `alpha w w'` to the part of `L D L'` below and right of column `first`; `w` is in the scratch vector and
    /// is cleared. Only the path from `first` to the root of the elimination tree is touched. Returns the least ratio
    /// of a new diagonal to its old one.
    fn rank_one(&mut self, first: Option<usize>, alpha: f64) -> f64 {
        let symbolic = Arc::clone(&self.symbolic);
        let mut change = RankOne { alpha };
        let mut least = 1.0_f64;
        let (mut at, mut work) = (first, 0);
        while let Some(j) = at {
            let wj = std::mem::take(&mut self.scratch[j]);
            if wj != 0.0 {
                let (d, beta) = change.pass(self.d[j], wj);
                least = least.min(d / self.d[j]);
                self.d[j] = d;
                let column = symbolic.column(j);
                work += 2 * column.len();
                for (&i, l) in symbolic.rows[column.clone()].iter().zip(&mut self.l[column]) {
                    let w = &mut self.scratch[i as usize];
                    *w -= wj * *l;
                    *l += beta * *w;
                }
            }
            at = symbolic.parent(j);
        }
        poll(work);
        least
    }
}

impl ActiveFactor for SparseFactor {
    fn insert(&mut self, m: &SparseColumns, i: usize) -> Result<f64, SingularBlock> {
        let symbolic = Arc::clone(&self.symbolic);
        let k = symbolic.position[i];
        let diagonal = self.scatter(m, i);
        // Row k of L, and the column below it, in one pass over the columns that row k reaches.
        let (mut pivot, mut work) = (diagonal, 0);
        for &(j, place) in symbolic.row(k) {
            let j = j as usize;
            let y = std::mem::take(&mut self.scratch[j]);
            if y == 0.0 {
                continue;
            }
            let l = y / self.d[j];
            pivot -= l * y;
            work += symbolic.column(j).len();
            for p in place as usize + 1..symbolic.starts[j + 1] {
                self.scratch[symbolic.rows[p] as usize] -= self.l[p] * y;
            }
            for p in symbolic.starts[j]..place as usize {
                self.scratch[symbolic.rows[p] as usize] -= self.l[p] * y;
            }
            self.l[place as usize] = l;
        }
        poll(work);
        if pivot.is_nan() || pivot <= LOST * diagonal {
            for &(_, place) in symbolic.row(k) {
                self.l[place as usize] = 0.0;
            }
            for p in symbolic.column(k) {
                self.scratch[symbolic.rows[p] as usize] = 0.0;
            }
            return Err(SingularBlock { row: i, pivot });
        }
        for p in symbolic.column(k) {
            // The scratch vector keeps w = l_k for the downdate that follows.
            let w = &mut self.scratch[symbolic.rows[p] as usize];
            *w /= pivot;
            self.l[p] = *w;
        }
        self.d[k] = pivot;
        self.active[k] = true;
        self.rows_active += 1;
        let least = self.rank_one(symbolic.parent(k), -pivot);
        if least > LOST {
            return Ok(pivot);
        }
        self.remove(i);
        Err(SingularBlock { row: i, pivot: least * pivot })
    }

    fn remove(&mut self, i: usize) {
        let symbolic = Arc::clone(&self.symbolic);
        let k = symbolic.position[i];
        if !std::mem::replace(&mut self.active[k], false) {
            return;
        }
        self.rows_active -= 1;
        for &(_, place) in symbolic.row(k) {
            self.l[place as usize] = 0.0;
        }
        for p in symbolic.column(k) {
            self.scratch[symbolic.rows[p] as usize] = std::mem::take(&mut self.l[p]);
        }
        let pivot = std::mem::replace(&mut self.d[k], 1.0);
        self.rank_one(symbolic.parent(k), pivot);
    }

    fn solve(&self, x: &mut [f64]) -> usize {
        let mut read = 0;
        let symbolic = &self.symbolic;
        let mut y: Vec<f64> = symbolic.row_at.iter().map(|&i| x[i]).collect();
        for j in 0..y.len() {
            let yj = y[j];
            if yj != 0.0 {
                let column = symbolic.column(j);
                read += column.len();
                for (&i, l) in symbolic.rows[column.clone()].iter().zip(&self.l[column]) {
                    y[i as usize] -= l * yj;
                }
            }
        }
        for j in (0..y.len()).rev() {
            if self.active[j] {
                let column = symbolic.column(j);
                read += column.len() + 1;
                let dot: f64 =
                    symbolic.rows[column.clone()].iter().zip(&self.l[column]).map(|(&i, l)| l * y[i as usize]).sum();
                y[j] = y[j] / self.d[j] - dot;
            }
        }
        for (&i, y) in symbolic.row_at.iter().zip(y) {
            x[i] = y;
        }
        poll(read);
        read
    }

    fn clear(&mut self) {
        self.l.fill(0.0);
        self.d.fill(1.0);
        self.active.fill(false);
        self.rows_active = 0;
        self.scratch.fill(0.0); // a change may have been stopped on the way
    }

    fn rows(&self) -> Vec<usize> {
        let position = self.symbolic.position.iter().enumerate();
        position.filter(|&(_, &p)| self.active[p]).map(|(i, _)| i).collect()
    }

    fn len(&self) -> usize {
        self.rows_active
    }

    fn entries(&self) -> usize {
        self.l.len() + self.d.len()
    }

    fn renumbered(&self, _n: usize, _place: &[Option<usize>]) -> Option<Box<dyn ActiveFactor>> {
        None
    }

    fn boxed(&self) -> Box<dyn ActiveFactor> {
        Box::new(self.clone())
    }

    fn numbers(&self) -> FactorNumbers {
        FactorNumbers::Sparse { l: self.l.clone(), d: self.d.clone(), active: self.active.clone() }
    }

    fn take_numbers(&mut self, numbers: &FactorNumbers) -> bool {
        self.clear();
        let FactorNumbers::Sparse { l, d, active } = numbers else { return false };
        if (l.len(), d.len(), active.len()) != (self.l.len(), self.d.len(), self.d.len()) {
            return false;
        }
        (self.l, self.d, self.active) = (l.clone(), d.clone(), active.clone());
        self.rows_active = self.active.iter().filter(|&&active| active).count();
        true
    }
}
