//! What is basic, and its factor.

use crate::cone::{
    basic::Basic,
    basis_factor::{BasisFactor, Replacement},
};
use serde::{Deserialize, Serialize};

/// Of a column that is not basic.
pub(super) const OUT: u32 = u32::MAX;

/// A pivot computed along its row and along its column may differ by this share before the factor is built again.
const DISAGREEMENT: f64 = 1e-8;
/// Factors of a row operation above this cost too many digits.
const GROWTH: f64 = 1e6;

/// One basic variable in each row's position, and the factor of their columns: `position` is the inverse of `basic`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Basis {
    pub factor: BasisFactor,
    pub basic: Vec<Basic>,
    /// Of each column, or [`OUT`].
    pub position: Vec<u32>,
    /// The last pivots showed that digits were lost.
    pub shaky: bool,
    /// Entries of the factor above which it is built again in a sparser order.
    pub most_entries: usize,
}

/// The same as a set, wherever each stands.
#[derive(Debug, Clone, Default)]
pub(super) struct BasisSet {
    pub columns: Vec<u32>,
    /// Whether the unit column of each row is basic.
    pub units: Vec<bool>,
}

impl BasisSet {
    pub fn put(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = true,
            Basic::Column(j) => self.columns.push(j),
        }
    }

    pub fn take(&mut self, row: u32, basic: Basic) {
        match basic {
            Basic::Unit => self.units[row as usize] = false,
            Basic::Column(j) => self.columns.retain(|&other| other != j),
        }
    }
}

impl Basis {
    /// The unit columns.
    pub fn of_units(rows: usize, columns: usize) -> Self {
        Self {
            factor: BasisFactor::identity(rows),
            basic: vec![Basic::Unit; rows],
            position: vec![OUT; columns],
            shaky: false,
            most_entries: 0,
        }
    }

    pub fn is_out(&self, column: u32) -> bool {
        self.position[column as usize] == OUT
    }

    /// The column that is basic in a position, if it is not the unit column.
    pub fn column_in(&self, position: u32) -> Option<u32> {
        match self.basic[position as usize] {
            Basic::Column(j) => Some(j),
            Basic::Unit => None,
        }
    }

    /// By which least-index rules go.
    pub fn index_in(&self, position: u32) -> u32 {
        self.column_in(position).unwrap_or(position)
    }

    /// Whether the unit column of a row is basic in its own position.
    pub fn is_unit(&self, position: u32) -> bool {
        self.basic[position as usize] == Basic::Unit
    }

    /// The factor is told by [`BasisFactor::replace`], or built again.
    pub fn put(&mut self, position: u32, basic: Basic) {
        self.basic[position as usize] = basic;
        if let Basic::Column(j) = basic {
            self.position[j as usize] = position;
        }
    }

    /// As a set, `rows` being those that are present.
    pub fn set(&self, rows: &[u32]) -> BasisSet {
        let units = (0..self.basic.len() as u32).map(|p| self.is_unit(p)).collect();
        BasisSet { columns: rows.iter().filter_map(|&p| self.column_in(p)).collect(), units }
    }

    /// The pivot as the replacement found it, and by another route: if they differ, digits are worn.
    pub fn note_accuracy(&mut self, replacement: Replacement, rate: f64) {
        let disagreement = (replacement.rate - rate).abs() / rate.abs();
        self.shaky |= disagreement > DISAGREEMENT || replacement.growth > GROWTH;
    }

    pub fn resize(&mut self, rows: usize, columns: usize) {
        self.factor.resize(rows);
        self.basic.resize(rows, Basic::Unit);
        self.position.resize(columns, OUT);
    }
}
