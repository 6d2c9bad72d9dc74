//! The system that Lemke's method pivots on, `w - M z - c z0 = q`, by its columns.

use crate::{interrupt::poll, matrix::SparseColumns};

/// A variable, which is to say a column of the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variable {
    W(usize),
    Z(usize),
    /// The artificial `z0` with the covering vector c.
    Cover,
}

/// `M` and `q`, equilibrated, and the covering vector.
#[derive(Debug)]
pub(super) struct System<'a> {
    pub m: &'a SparseColumns,
    pub q: &'a [f64],
    /// The covering vector c (n), not negative.
    pub cover: Vec<f64>,
}

impl System<'_> {
    /// Number of rows, n.
    pub fn len(&self) -> usize {
        self.q.len()
    }

    /// Calls `each` with row and value of the entries of a column.
    pub fn for_each(&self, variable: Variable, mut each: impl FnMut(usize, f64)) {
        match variable {
            Variable::W(i) => each(i, 1.0),
            Variable::Z(j) => {
                let (indices, values) = self.m.column(j);
                indices.iter().zip(values).for_each(|(&i, &value)| each(i, -value));
            }
            Variable::Cover => {
                let covered = self.cover.iter().enumerate().filter(|&(_, &c)| c != 0.0);
                covered.for_each(|(i, &c)| each(i, -c));
            }
        }
    }

    /// Adds `factor` times a column to `y`.
    pub fn add_to(&self, y: &mut [f64], variable: Variable, factor: f64) {
        self.for_each(variable, |i, value| y[i] += factor * value);
    }

    /// Inner product of a column with a row.
    pub fn dot(&self, variable: Variable, row: &[f64]) -> f64 {
        let mut dot = 0.0;
        self.for_each(variable, |i, value| dot += row[i] * value);
        dot
    }

    /// `right - B x` for the basic variables of B and their values.
    pub fn difference(&self, basic: &[Variable], x: &[f64], right: &[f64]) -> Vec<f64> {
        let mut difference = right.to_vec();
        poll(self.m.stored());
        basic.iter().zip(x).for_each(|(&variable, &x)| self.add_to(&mut difference, variable, -x));
        difference
    }
}
