//! A basis factored in 64 bits, whose solutions are refined to double-double numbers.

use super::super::{basic::Basic, columns::Columns};
use crate::refined::{Square, refined};
use twofloat::TwoFloat;

/// Replacements carried as factors of their own until the basis is factored anew.
const REPLACEMENTS: usize = 16;

/// `B`, by columns in the order of the rows' places, and its factor.
pub(super) struct Factored<'a> {
    g: &'a Columns,
    /// Place of each row of the complete problem.
    place: Vec<usize>,
    square: Square,
    /// Columns replaced since it was factored: where, and `B^-1 g` of the column that came.
    replaced: Vec<(usize, Vec<f64>)>,
}

impl<'a> Factored<'a> {
    /// None if the basis is singular to working precision.
    pub fn new(g: &'a Columns, rows: &[u32], basis: &[Basic]) -> Option<Self> {
        let mut place = vec![usize::MAX; g.rows()];
        rows.iter().enumerate().for_each(|(k, &row)| place[row as usize] = k);
        let column = |(k, basic): (usize, &Basic)| match *basic {
            Basic::Unit => vec![(k, 1.0)],
            Basic::Column(j) => g.column(j).iter().map(|&(row, value)| (place[row as usize], value)).collect(),
        };
        let square = Square::new(basis.iter().enumerate().map(column).collect())?;
        Some(Self { g, place, square, replaced: Vec::new() })
    }

    /// A column of G by place.
    pub fn scattered(&self, j: u32) -> Vec<TwoFloat> {
        let mut column = vec![TwoFloat::from(0.0); self.square.len()];
        self.g.column(j).iter().for_each(|&(row, value)| column[self.place[row as usize]] = value.into());
        column
    }

    /// Column j takes a place; `direction` is its `B^-1 g`. None if that makes the basis singular.
    pub fn replace(&mut self, place: usize, j: u32, direction: &[TwoFloat]) -> Option<()> {
        let column = self.g.column(j).iter().map(|&(row, value)| (self.place[row as usize], value)).collect();
        self.square.put_column(place, column);
        self.replaced.push((place, direction.iter().map(|d| d.hi()).collect()));
        if self.replaced.len() > REPLACEMENTS { self.factor_anew() } else { Some(()) }
    }

    fn factor_anew(&mut self) -> Option<()> {
        self.replaced.clear();
        self.square.factor()
    }

    /// `B x = b`.
    pub fn solve(&mut self, b: &[TwoFloat]) -> Option<Vec<TwoFloat>> {
        self.or_anew(|of| refined(b, |r| of.solve_roughly(r), |x| of.square.residual(b, x)))
    }

    /// `B' y = c`.
    pub fn solve_transposed(&mut self, c: &[TwoFloat]) -> Option<Vec<TwoFloat>> {
        self.or_anew(|of| refined(c, |r| of.solve_transposed_roughly(r), |y| of.square.residual_transposed(c, y)))
    }

    /// Solves, once more with a new factor if this one is worn.
    fn or_anew<T>(&mut self, solve: impl Fn(&Self) -> Option<T>) -> Option<T> {
        let solved = solve(self);
        if solved.is_some() || self.replaced.is_empty() {
            return solved;
        }
        self.factor_anew()?;
        solve(self)
    }

    fn solve_roughly(&self, b: &[f64]) -> Vec<f64> {
        let mut x = self.square.solve_roughly(b);
        for (place, direction) in &self.replaced {
            let pivot = x[*place] / direction[*place];
            x.iter_mut().zip(direction).for_each(|(x, d)| *x -= d * pivot);
            x[*place] = pivot;
        }
        x
    }

    fn solve_transposed_roughly(&self, c: &[f64]) -> Vec<f64> {
        let mut y = c.to_vec();
        for (place, direction) in self.replaced.iter().rev() {
            let others: f64 = (0..y.len()).filter(|k| k != place).map(|k| y[k] * direction[k]).sum();
            y[*place] = (y[*place] - others) / direction[*place];
        }
        self.square.solve_transposed_roughly(&y)
    }
}
