//! The system that Lemke's method pivots on, `w - M z - c z0 = q`, by its columns.

use crate::matrix::SparseColumns;

/// A variable, which is to say a column of the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variable {
    W(usize),
    Z(usize),
    /// The artificial `z0` with the covering vector c.
    Cover,
}

/// Entries of one column.
pub(super) struct Column {
    pub indices: Vec<usize>,
    pub values: Vec<f64>,
}

impl Column {
    /// Adds `factor` times the column to `y`.
    pub fn add_to(&self, y: &mut [f64], factor: f64) {
        for (&i, value) in self.indices.iter().zip(&self.values) {
            y[i] += factor * value;
        }
    }

    /// Its inner product with a row.
    pub fn dot(&self, row: &[f64]) -> f64 {
        self.indices.iter().zip(&self.values).map(|(&i, value)| row[i] * value).sum()
    }
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

    pub fn column(&self, variable: Variable) -> Column {
        match variable {
            Variable::W(i) => Column { indices: vec![i], values: vec![1.0] },
            Variable::Z(j) => {
                let (indices, values) = self.m.column(j);
                Column { indices: indices.to_vec(), values: values.iter().map(|value| -value).collect() }
            }
            Variable::Cover => {
                let covered = || self.cover.iter().enumerate().filter(|&(_, &c)| c != 0.0);
                Column { indices: covered().map(|(i, _)| i).collect(), values: covered().map(|(_, c)| -c).collect() }
            }
        }
    }

    /// `right - B x` for the basic variables of B and their values.
    pub fn difference(&self, basic: &[Variable], x: &[f64], right: &[f64]) -> Vec<f64> {
        let mut difference = right.to_vec();
        for (&variable, &x) in basic.iter().zip(x) {
            self.column(variable).add_to(&mut difference, -x);
        }
        difference
    }
}
