//! The complete problem, in the units in which it is solved.

use crate::{cone::Columns, error::LcpError};
use serde::{Deserialize, Serialize};

/// `G f = h` with every row in its own unit, and every column so that its largest entry is one.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Scaled {
    pub g: Columns,
    pub h: Vec<f64>,
    /// What rows and columns were multiplied by.
    pub row_scale: Vec<f64>,
    pub column_scale: Vec<f64>,
    /// The load of each row's own block in the unit of the row.
    pub own: Vec<f64>,
    /// Some blocks weigh so much less than others that their own load is small in the unit of their rows.
    pub wide: bool,
}

impl Scaled {
    /// `unit`: of each row.
    ///
    /// # Errors
    /// See [`ConeSolver::new`](super::ConeSolver::new).
    pub fn new(mut g: Columns, h: &[f64], unit: &[f64]) -> Result<Self, LcpError> {
        check(g.rows(), h, unit)?;
        let row_scale: Vec<f64> = unit.iter().map(|unit| unit.recip()).collect();
        let column_scale = g.scale(&row_scale);
        let own = vec![1.0; g.rows()];
        let h = h.iter().zip(&row_scale).map(|(h, scale)| h * scale).collect();
        Ok(Self { g, h, row_scale, column_scale, own, wide: false })
    }

    /// Whether generators, loads and units are the same.
    pub fn is_same(&self, other: &Self) -> bool {
        (&self.g, &self.h, &self.row_scale) == (&other.g, &other.h, &other.row_scale)
    }

    /// Puts new columns, which have all rows, and new rows behind those that are there. The new columns, scaled.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn append(&mut self, mut more: Columns, h: &[f64], unit: &[f64]) -> Result<Columns, LcpError> {
        let old = self.h.len();
        if more.rows() < old {
            let reason = format!("the new columns have {} rows, fewer than the {old} there are", more.rows());
            return Err(LcpError::Structure { reason });
        }
        check(more.rows() - old, h, unit)?;
        self.row_scale.extend(unit.iter().map(|unit| unit.recip()));
        self.column_scale.extend(more.scale(&self.row_scale));
        self.h.extend(h.iter().zip(&self.row_scale[old..]).map(|(h, scale)| h * scale));
        self.own.resize(more.rows(), 1.0);
        self.g.append(&more);
        Ok(more)
    }

    /// Leaves the first rows and columns; no column that stays has an entry in a row that goes.
    pub fn truncate(&mut self, rows: usize, columns: usize) {
        self.g.truncate(rows, columns);
        self.h.truncate(rows);
        self.own.truncate(rows);
        self.row_scale.truncate(rows);
        self.column_scale.truncate(columns);
    }
}

/// One finite entry of `h` and one positive unit for each row.
fn check(rows: usize, h: &[f64], unit: &[f64]) -> Result<(), LcpError> {
    if h.len() != rows || unit.len() != rows {
        let reason = format!("G has {rows} rows, h has {} and the units have {}", h.len(), unit.len());
        return Err(LcpError::Structure { reason });
    }
    if let Some(index) = h.iter().position(|value| !value.is_finite()) {
        return Err(LcpError::VectorNotFinite { index, value: h[index] });
    }
    match unit.iter().position(|&unit| unit.is_nan() || unit <= 0.0 || unit.is_infinite()) {
        Some(row) => Err(LcpError::Structure { reason: format!("the unit of row {row} is {}", unit[row]) }),
        None => Ok(()),
    }
}
