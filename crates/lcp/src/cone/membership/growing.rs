//! A problem that gets further rows and columns, such as a structure of which nobody knows yet what it will be.

use super::{Basic, ConeSolver, OUT, check};
use crate::{cone::Columns, error::LcpError};

impl ConeSolver {
    /// Puts rows and columns behind those that are there. No new row is present; what is present stays as it is, with its
    /// basis and factor. `more` holds the new columns, with all rows; `h` and `unit` are those of the new rows. Marks
    /// end here.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn append(&mut self, mut more: Columns, h: &[f64], unit: &[f64]) -> Result<(), LcpError> {
        let old = self.h.len();
        if more.rows() < old {
            let reason = format!("the new columns have {} rows, fewer than the {old} there are", more.rows());
            return Err(LcpError::Structure { reason });
        }
        check(more.rows() - old, h, unit)?;
        self.row_scale.extend(unit.iter().map(|unit| unit.recip()));
        self.column_scale.extend(more.scale(&self.row_scale));
        self.h.extend(h.iter().zip(&self.row_scale[old..]).map(|(h, scale)| h * scale));
        let absent = |&&(row, _): &&(u32, f64)| !self.present.get(row as usize).copied().unwrap_or(false);
        let missing = (0..more.len() as u32).map(|j| more.column(j).iter().filter(absent).count() as u32);
        self.missing.extend(missing);
        self.g.append(&more);
        self.resize();
        Ok(())
    }

    /// Leaves only the first rows and columns of the problem: none of the rows that go may be present, and with them go all
    /// columns that touch one. Marks end here.
    ///
    /// # Panics
    /// If a row that goes is present, or one of the first columns touches it.
    pub fn truncate(&mut self, rows: usize, columns: usize) {
        assert!(!self.present[rows..].contains(&true), "a row that goes is present");
        let touches = |row: usize| self.g.columns_of(row as u32).iter().any(|&(j, _)| (j as usize) < columns);
        assert!(!(rows..self.g.rows()).any(touches), "a column that stays touches a row that goes");
        assert!(self.position[columns..].iter().all(|&position| position == OUT), "a column that goes is basic");
        self.g.truncate(rows, columns);
        self.h.truncate(rows);
        self.row_scale.truncate(rows);
        self.column_scale.truncate(columns);
        self.missing.truncate(columns);
        self.resize();
    }

    /// Everything else gets the size of the problem.
    fn resize(&mut self) {
        let (m, n) = (self.g.rows(), self.g.len());
        self.factor.resize(m);
        self.basic.resize(m, Basic::Unit);
        self.position.resize(n, OUT);
        self.own.resize(m, 1.0);
        self.present.resize(m, false);
        self.x.resize(m, 0.0);
        self.force.resize(n, 0.0);
        self.pricing.resize(n);
        self.y.resize(m);
        self.spike.resize(m);
        self.balance.resize(m, 0.0);
        self.bears.resize(n, false);
        self.next_in_group.resize(m, OUT);
        self.suspects.retain(|&p| (p as usize) < m);
        self.changed.retain(|&j| (j as usize) < n);
        self.new_rows.retain(|&row| (row as usize) < m);
        self.direction.clear();
        self.forget();
    }
}
