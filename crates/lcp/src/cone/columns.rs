//! Generators as sparse columns, with the columns of every row.

use crate::{
    error::LcpError,
    interrupt::{Tally, poll},
};
use serde::{Deserialize, Serialize};

/// A sparse matrix G (rows x n) by columns and by rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Columns {
    rows: usize,
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
    row_starts: Vec<usize>,
    row_columns: Vec<(u32, f64)>,
}

impl Columns {
    /// Takes compressed columns: column j has the rows `indices[indptr[j]..indptr[j + 1]]` and the values beside them.
    ///
    /// # Errors
    /// [`LcpError::Structure`] or [`LcpError::MatrixNotFinite`].
    pub fn new(rows: usize, indptr: &[usize], indices: &[usize], data: &[f64]) -> Result<Self, LcpError> {
        let structure = |reason: String| Err(LcpError::Structure { reason });
        if indptr.first() != Some(&0) || indptr.last() != Some(&indices.len()) || indices.len() != data.len() {
            return structure("indptr must run from 0 to the number of stored entries, one value an index".into());
        }
        if !indptr.is_sorted() {
            return structure("indptr falls".into());
        }
        if let Some(row) = indices.iter().find(|&&row| row >= rows) {
            return structure(format!("row index {row} in a matrix with {rows} rows"));
        }
        let column = |j: usize| indptr[j]..indptr[j + 1];
        let (mut ascending, mut tally) = (true, Tally::default());
        for j in 0..indptr.len() - 1 {
            let (rows, values) = (&indices[column(j)], &data[column(j)]);
            tally.count(8 * rows.len());
            if let Some(place) = values.iter().position(|value| !value.is_finite()) {
                return Err(LcpError::MatrixNotFinite { row: rows[place], column: j, value: values[place] });
            }
            ascending &= rows.windows(2).all(|pair| pair[0] < pair[1]);
        }
        let entries = indices.iter().zip(data).map(|(&row, &value)| (row as u32, value)).collect();
        let (row_starts, row_columns) = (Vec::new(), Vec::new());
        let mut columns = Self { rows, starts: indptr.to_vec(), entries, row_starts, row_columns };
        columns.index_rows();
        if !ascending {
            columns.order_entries();
            for j in 0..columns.len() {
                if let Some(pair) = columns.column(j as u32).windows(2).find(|pair| pair[0].0 == pair[1].0) {
                    return structure(format!("entry [{}, {j}] is given twice", pair[0].0));
                }
            }
        }
        Ok(columns)
    }

    /// Row by row, so that every column has its rows in order, whatever order they came in: sums over them are then
    /// the same for all columns.
    fn order_entries(&mut self) {
        let Self { rows, starts, entries, row_starts, row_columns } = self;
        let mut next = starts.clone();
        for row in 0..*rows {
            for &(column, value) in &row_columns[row_starts[row]..row_starts[row + 1]] {
                entries[next[column as usize]] = (row as u32, value);
                next[column as usize] += 1;
            }
        }
    }

    /// Lists the columns of every row.
    fn index_rows(&mut self) {
        let Self { rows, starts, entries, row_starts, row_columns } = self;
        poll(4 * entries.len());
        row_starts.clear();
        row_starts.resize(*rows + 1, 0);
        entries.iter().for_each(|&(row, _)| row_starts[row as usize + 1] += 1);
        (0..*rows).for_each(|row| row_starts[row + 1] += row_starts[row]);
        let mut next = row_starts.clone();
        row_columns.resize(entries.len(), (0, 0.0));
        for (column, range) in starts.windows(2).enumerate() {
            for &(row, value) in &entries[range[0]..range[1]] {
                row_columns[next[row as usize]] = (column as u32, value);
                next[row as usize] += 1;
            }
        }
    }

    /// Leaves only the first rows and columns, of which none has an entry in a row that goes.
    pub(super) fn truncate(&mut self, rows: usize, columns: usize) {
        self.rows = rows;
        self.starts.truncate(columns + 1);
        self.entries.truncate(self.starts[columns]);
        self.index_rows();
    }

    /// Puts rows and columns behind those that are there.
    pub(super) fn append(&mut self, more: &Self) {
        self.rows = more.rows;
        let entries = self.entries.len();
        self.starts.extend(more.starts[1..].iter().map(|start| entries + start));
        self.entries.extend_from_slice(&more.entries);
        self.index_rows();
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are no columns.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Entries (row, value) of column j, rows ascending.
    pub fn column(&self, j: u32) -> &[(u32, f64)] {
        &self.entries[self.starts[j as usize]..self.starts[j as usize + 1]]
    }

    /// Columns with an entry in a row, ascending, with the entry.
    pub fn columns_of(&self, row: u32) -> &[(u32, f64)] {
        &self.row_columns[self.row_starts[row as usize]..self.row_starts[row as usize + 1]]
    }

    /// Multiplies row r by `row_scale[r]`, then every column so that its largest entry is one. Returns the column
    /// scales.
    pub(super) fn scale(&mut self, row_scale: &[f64]) -> Vec<f64> {
        let (mut column_scale, mut tally) = (Vec::with_capacity(self.len()), Tally::default());
        for j in 0..self.len() {
            let column = &mut self.entries[self.starts[j]..self.starts[j + 1]];
            tally.count(8 * column.len());
            column.iter_mut().for_each(|(row, value)| *value *= row_scale[*row as usize]);
            let largest = column.iter().fold(0.0_f64, |largest, (_, value)| largest.max(value.abs()));
            let scale = if largest > 0.0 { largest.recip() } else { 1.0 };
            column.iter_mut().for_each(|(_, value)| *value *= scale);
            column_scale.push(scale);
        }
        for (row, &row_scale) in row_scale.iter().enumerate() {
            for (column, value) in &mut self.row_columns[self.row_starts[row]..self.row_starts[row + 1]] {
                *value *= row_scale;
                *value *= column_scale[*column as usize];
            }
        }
        column_scale
    }
}
