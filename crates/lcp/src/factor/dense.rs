//! Dense `L D L'` of the active block, rows in the order in which they entered.

use super::{ActiveFactor, FactorNumbers, LOST, RankOne, SingularBlock};
use crate::{interrupt::poll, matrix::SparseColumns};

/// Unit lower triangular `L` by rows and diagonal `D`. Insertion appends a row, k^2 / 2 operations for k active rows;
/// removal of the row at position p updates the (k - p)^2 / 2 entries below it.
#[derive(Debug, Clone)]
pub struct DenseFactor {
    /// Matrix index of every factor row, in order of entry.
    order: Vec<usize>,
    /// Row r holds its r entries left of the diagonal.
    l: Vec<Vec<f64>>,
    d: Vec<f64>,
    /// Factor row of every matrix index, or `OUT`.
    place: Vec<usize>,
}

const OUT: usize = usize::MAX;

impl DenseFactor {
    /// An empty active set within a matrix of `n` rows.
    pub fn new(n: usize) -> Self {
        Self { order: Vec::new(), l: Vec::new(), d: Vec::new(), place: vec![OUT; n] }
    }

    fn gather(&self, x: &[f64]) -> Vec<f64> {
        self.order.iter().map(|&i| x[i]).collect()
    }

    fn find_places(&mut self) {
        for (place, &index) in self.order.iter().enumerate() {
            self.place[index] = place;
        }
    }

    /// `L y = b` in place.
    fn forward(&self, b: &mut [f64]) {
        for (r, row) in self.l.iter().enumerate() {
            let dot: f64 = row.iter().zip(&b[..r]).map(|(l, y)| l * y).sum();
            b[r] -= dot;
        }
    }

    /// `L' x = b` in place.
    fn backward(&self, b: &mut [f64]) {
        for r in (0..self.l.len()).rev() {
            let x = b[r];
            for (l, y) in self.l[r].iter().zip(&mut b[..r]) {
                *y -= l * x;
            }
        }
    }

    /// `L D L' += alpha w w'` for the rows from `first` on; `w` starts there.
    fn rank_one(&mut self, first: usize, w: &mut [f64], alpha: f64) {
        poll(w.len() * w.len());
        let mut change = RankOne { alpha };
        let mut betas = Vec::with_capacity(w.len());
        for r in first..self.l.len() {
            let mut wr = w[r - first];
            for ((l, &wj), &beta) in self.l[r][first..].iter_mut().zip(&w[..r - first]).zip(&betas) {
                wr -= wj * *l;
                *l += beta * wr;
            }
            w[r - first] = wr;
            let (d, beta) = change.pass(self.d[r], wr);
            self.d[r] = d;
            betas.push(beta);
        }
    }
}

impl ActiveFactor for DenseFactor {
    fn insert(&mut self, m: &SparseColumns, i: usize) -> Result<f64, SingularBlock> {
        poll(self.order.len() * self.order.len() / 2);
        let mut row = vec![0.0; self.order.len()];
        let (rows, values) = m.column(i);
        let mut diagonal = 0.0;
        for (&j, &value) in rows.iter().zip(values) {
            if j == i {
                diagonal = value;
            } else if self.place[j] != OUT {
                row[self.place[j]] = value;
            }
        }
        self.forward(&mut row);
        let mut pivot = diagonal;
        for (y, d) in row.iter_mut().zip(&self.d) {
            let l = *y / d;
            pivot -= l * *y;
            *y = l;
        }
        if pivot.is_nan() || pivot <= LOST * diagonal {
            return Err(SingularBlock { row: i, pivot });
        }
        self.place[i] = self.order.len();
        self.order.push(i);
        self.l.push(row);
        self.d.push(pivot);
        Ok(pivot)
    }

    fn remove(&mut self, i: usize) {
        let p = std::mem::replace(&mut self.place[i], OUT);
        if p == OUT {
            return;
        }
        self.order.remove(p);
        self.l.remove(p);
        let alpha = self.d.remove(p);
        let mut w: Vec<f64> = self.l[p..].iter_mut().map(|row| row.remove(p)).collect();
        self.rank_one(p, &mut w, alpha);
        self.find_places();
    }

    fn solve(&self, x: &mut [f64]) -> usize {
        let mut b = self.gather(x);
        self.forward(&mut b);
        for (value, d) in b.iter_mut().zip(&self.d) {
            *value /= d;
        }
        self.backward(&mut b);
        for (&i, value) in self.order.iter().zip(b) {
            x[i] = value;
        }
        let k = self.order.len();
        poll(k * k);
        k * k
    }

    fn clear(&mut self) {
        for &i in &self.order {
            self.place[i] = OUT;
        }
        self.order.clear();
        self.l.clear();
        self.d.clear();
    }

    fn rows(&self) -> Vec<usize> {
        let mut rows = self.order.clone();
        rows.sort_unstable();
        rows
    }

    fn len(&self) -> usize {
        self.order.len()
    }

    fn entries(&self) -> usize {
        self.l.iter().map(Vec::len).sum::<usize>() + self.d.len()
    }

    fn renumbered(&self, n: usize, place: &[Option<usize>]) -> Option<Box<dyn ActiveFactor>> {
        let order: Vec<usize> = self.order.iter().map(|&i| place[i]).collect::<Option<_>>()?;
        let mut moved = Self { order, l: self.l.clone(), d: self.d.clone(), place: vec![OUT; n] };
        moved.find_places();
        Some(Box::new(moved))
    }

    fn boxed(&self) -> Box<dyn ActiveFactor> {
        Box::new(self.clone())
    }

    fn numbers(&self) -> FactorNumbers {
        FactorNumbers::Dense { order: self.order.clone(), l: self.l.clone(), d: self.d.clone() }
    }

    fn take_numbers(&mut self, numbers: &FactorNumbers) -> bool {
        self.clear();
        let FactorNumbers::Dense { order, l, d } = numbers else { return false };
        let n = self.place.len();
        let triangular = l.iter().enumerate().all(|(r, row)| row.len() == r);
        if order.len() != d.len() || l.len() != d.len() || !triangular || order.iter().any(|&i| i >= n) {
            return false;
        }
        (self.order, self.l, self.d) = (order.clone(), l.clone(), d.clone());
        self.find_places();
        true
    }
}
