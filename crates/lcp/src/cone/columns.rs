//! Generators as sparse columns, with the columns of every row.

use crate::error::LcpError;

/// A sparse matrix G (rows x n) by columns and by rows.
#[derive(Debug, Clone)]
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
        let mut latest = vec![usize::MAX; rows];
        for column in 0..indptr.len() - 1 {
            for p in indptr[column]..indptr[column + 1] {
                let (row, value) = (indices[p], data[p]);
                if !value.is_finite() {
                    return Err(LcpError::MatrixNotFinite { row, column, value });
                }
                if std::mem::replace(&mut latest[row], column) == column {
                    return structure(format!("entry [{row}, {column}] is given twice"));
                }
            }
        }
        let mut row_starts = vec![0; rows + 1];
        indices.iter().for_each(|&row| row_starts[row + 1] += 1);
        (0..rows).for_each(|row| row_starts[row + 1] += row_starts[row]);
        let mut next = row_starts.clone();
        let mut row_columns = vec![(0, 0.0); indices.len()];
        for column in 0..indptr.len() - 1 {
            for p in indptr[column]..indptr[column + 1] {
                row_columns[next[indices[p]]] = (column as u32, data[p]);
                next[indices[p]] += 1;
            }
        }
        // Row by row, so that every column has its rows in order, whatever order they came in: sums over them are then
        // the same for all columns.
        let mut next = indptr.to_vec();
        let mut entries = vec![(0, 0.0); indices.len()];
        for row in 0..rows {
            for &(column, value) in &row_columns[row_starts[row]..row_starts[row + 1]] {
                entries[next[column as usize]] = (row as u32, value);
                next[column as usize] += 1;
            }
        }
        Ok(Self { rows, starts: indptr.to_vec(), entries, row_starts, row_columns })
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
        let mut column_scale = Vec::with_capacity(self.len());
        for j in 0..self.len() {
            let column = &mut self.entries[self.starts[j]..self.starts[j + 1]];
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
