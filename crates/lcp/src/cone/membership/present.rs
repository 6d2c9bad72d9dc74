//! Which rows are there, and which columns take part.

use crate::cone::Columns;
use serde::{Deserialize, Serialize};

/// Rows that are present. A column takes part once all its rows are: `missing` is how many are not.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Present {
    /// As they came.
    pub rows: Vec<u32>,
    pub is_there: Vec<bool>,
    /// Of each column.
    pub missing: Vec<u32>,
}

impl Present {
    /// No row is.
    pub fn none(g: &Columns) -> Self {
        let missing = (0..g.len() as u32).map(|j| g.column(j).len() as u32).collect();
        Self { rows: Vec::new(), is_there: vec![false; g.rows()], missing }
    }

    /// Whether a column does.
    pub fn takes_part(&self, column: u32) -> bool {
        self.missing[column as usize] == 0
    }

    pub fn bring(&mut self, row: u32, g: &Columns) {
        self.is_there[row as usize] = true;
        self.rows.push(row);
        for &(j, _) in g.columns_of(row) {
            self.missing[j as usize] -= 1;
        }
    }

    pub fn take(&mut self, row: u32, g: &Columns) {
        self.is_there[row as usize] = false;
        for &(j, _) in g.columns_of(row) {
            self.missing[j as usize] += 1;
        }
        if let Some(place) = self.rows.iter().rposition(|&other| other == row) {
            self.rows.remove(place);
        }
    }

    /// `more` are columns that come to the problem.
    pub fn append(&mut self, more: &Columns) {
        let absent = |&&(row, _): &&(u32, f64)| !self.is_there.get(row as usize).copied().unwrap_or(false);
        let missing = (0..more.len() as u32).map(|j| more.column(j).iter().filter(absent).count() as u32);
        self.missing.extend(missing);
        self.is_there.resize(more.rows(), false);
    }

    pub fn truncate(&mut self, rows: usize, columns: usize) {
        self.is_there.truncate(rows);
        self.missing.truncate(columns);
    }
}
