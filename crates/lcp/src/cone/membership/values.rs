//! The values of what is basic.

use crate::cone::basic::{Basic, ZERO, infeasible};
use serde::{Deserialize, Serialize};

/// Rounding of a value, relative to the largest force.
pub(super) const OF_LARGEST: f64 = 8.0 * f64::EPSILON;

/// Basic values by position, and the same by column: a force is its column's basic value, zero where that is not basic.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Values {
    pub basic: Vec<f64>,
    pub force: Vec<f64>,
    /// Positions that may be infeasible: all that are, and others.
    pub suspects: Vec<u32>,
    /// A basic value within this of zero is zero: [`ZERO`], or what rounding leaves of the largest force.
    pub zero: f64,
}

impl Values {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { basic: vec![0.0; rows], force: vec![0.0; columns], suspects: Vec::new(), zero: ZERO }
    }

    /// The rate at which the infeasibility grows with the value in a position: 0 where that is feasible.
    pub fn infeasible(&self, position: u32, basic: Basic) -> f64 {
        infeasible(basic, self.basic[position as usize], self.zero)
    }

    /// Sum of the values that are suspected.
    pub fn infeasibility(&self) -> f64 {
        self.suspects.iter().map(|&p| self.basic[p as usize].abs()).sum()
    }

    /// The largest force is this.
    pub fn round_by(&mut self, largest: f64) {
        self.zero = ZERO.max(OF_LARGEST * largest);
    }

    /// The unit columns of rows that are absent have no value: rounding may touch them later, and must not find them out of
    /// balance.
    pub fn forget(&mut self, rows: &[u32]) {
        rows.iter().for_each(|&row| self.basic[row as usize] = 0.0);
    }

    pub fn resize(&mut self, rows: usize, columns: usize) {
        self.basic.resize(rows, 0.0);
        self.force.resize(columns, 0.0);
        self.suspects.retain(|&p| (p as usize) < rows);
    }
}
