//! A problem that gets further rows and columns, such as a structure of which nobody knows yet what it will be.

use super::ConeSolver;
use crate::{cone::Columns, error::LcpError};

impl ConeSolver {
    /// Puts rows and columns behind those that are there. No new row is present; what is present stays as it is, with its
    /// basis and factor. `more` holds the new columns, with all rows; `h` and `unit` are those of the new rows. Marks
    /// end here.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn append(&mut self, more: Columns, h: &[f64], unit: &[f64]) -> Result<(), LcpError> {
        let more = self.problem.append(more, h, unit)?;
        self.present.append(&more);
        self.resize();
        Ok(())
    }

    /// Leaves only the first rows and columns of the problem: none of the rows that go may be present, and with them go all
    /// columns that touch one. Marks end here.
    ///
    /// # Panics
    /// If a row that goes is present, or one of the first columns touches it.
    pub fn truncate(&mut self, rows: usize, columns: usize) {
        assert!(!self.present.is_there[rows..].contains(&true), "a row that goes is present");
        let touches = |row: usize| self.problem.g.columns_of(row as u32).iter().any(|&(j, _)| (j as usize) < columns);
        assert!(!(rows..self.problem.g.rows()).any(touches), "a column that stays touches a row that goes");
        assert!((columns..self.problem.g.len()).all(|j| self.basis.is_out(j as u32)), "a column that goes is basic");
        self.problem.truncate(rows, columns);
        self.present.truncate(rows, columns);
        self.resize();
    }

    /// Everything else gets the size of the problem.
    fn resize(&mut self) {
        let (m, n) = (self.problem.g.rows(), self.problem.g.len());
        self.basis.resize(m, n);
        self.values.resize(m, n);
        self.balance.resize(m, n);
        self.bearing.resize(m, n);
        self.pricing.resize(n);
        self.pivot.resize(m);
        self.forget();
    }
}
