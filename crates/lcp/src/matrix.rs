//! A square matrix in compressed columns: the one matrix type of this crate.

use crate::{error::LcpError, interrupt::poll};

/// A square sparse matrix, column by column, with sorted row indices and no duplicates.
///
/// `indptr` has n + 1 entries; column j holds the rows `indices[indptr[j]..indptr[j + 1]]` with the values in
/// `data` at the same places. A dense matrix is the case in which every row is listed.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseColumns {
    n: usize,
    indptr: Vec<usize>,
    indices: Vec<usize>,
    data: Vec<f64>,
}

impl SparseColumns {
    /// Takes compressed-column arrays. Rows of a column may come in any order; duplicates are an error.
    ///
    /// # Errors
    /// [`LcpError::Structure`] if the arrays do not describe an n x n matrix,
    /// [`LcpError::MatrixNotFinite`] for a NaN or an infinity.
    pub fn new(n: usize, indptr: Vec<usize>, indices: Vec<usize>, data: Vec<f64>) -> Result<Self, LcpError> {
        let structure = |reason: String| Err(LcpError::Structure { reason });
        if indptr.len() != n + 1 || indptr[0] != 0 || indptr[n] != indices.len() {
            return structure(format!(
                "indptr must have {} entries running from 0 to the number of stored entries",
                n + 1
            ));
        }
        if indices.len() != data.len() {
            return structure(format!("{} row indices but {} values", indices.len(), data.len()));
        }
        if let Some(j) = (0..n).find(|&j| indptr[j] > indptr[j + 1]) {
            return structure(format!("indptr falls at column {j}"));
        }
        let mut matrix = Self { n, indptr, indices, data };
        matrix.sort_columns();
        for j in 0..n {
            let (rows, _) = matrix.column(j);
            if let Some(&row) = rows.iter().find(|&&row| row >= n) {
                return structure(format!("row index {row} in column {j} of a matrix with {n} rows"));
            }
            if let Some(pair) = rows.windows(2).find(|pair| pair[0] == pair[1]) {
                return structure(format!("entry [{}, {j}] is given twice", pair[0]));
            }
        }
        matrix.finite()
    }

    /// The same of arrays that were made in order: only the values are looked at.
    pub(crate) fn sorted(indptr: Vec<usize>, indices: Vec<usize>, data: Vec<f64>) -> Result<Self, LcpError> {
        Self { n: indptr.len() - 1, indptr, indices, data }.finite()
    }

    /// Checks that every value is a number.
    pub(crate) fn finite(self) -> Result<Self, LcpError> {
        let Some(place) = self.data.iter().position(|value| !value.is_finite()) else { return Ok(self) };
        let column = self.indptr.partition_point(|&start| start <= place) - 1;
        Err(LcpError::MatrixNotFinite { row: self.indices[place], column, value: self.data[place] })
    }

    /// Takes a dense matrix, n x n in row-major order, and stores its nonzero entries.
    ///
    /// # Errors
    /// [`LcpError::Shape`] if the length is not a square, [`LcpError::MatrixNotFinite`] as in [`Self::new`].
    pub fn from_dense(values: &[f64]) -> Result<Self, LcpError> {
        let n = values.len().isqrt();
        if n * n != values.len() {
            let columns = values.len().checked_div(n).unwrap_or(0);
            return Err(LcpError::Shape { rows: n, columns, q: n });
        }
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            poll(4 * n);
            for i in 0..n {
                let value = values[i * n + j];
                if value != 0.0 {
                    indices.push(i);
                    data.push(value);
                }
            }
            indptr.push(indices.len());
        }
        Self::new(n, indptr, indices, data)
    }

    fn sort_columns(&mut self) {
        for j in 0..self.n {
            poll(self.indptr[j + 1] - self.indptr[j]);
            let range = self.indptr[j]..self.indptr[j + 1];
            if self.indices[range.clone()].is_sorted() {
                continue;
            }
            let mut entries: Vec<(usize, f64)> = range.clone().map(|p| (self.indices[p], self.data[p])).collect();
            entries.sort_by_key(|entry| entry.0);
            for (p, (row, value)) in range.zip(entries) {
                self.indices[p] = row;
                self.data[p] = value;
            }
        }
    }

    /// Number of rows and columns.
    pub fn len(&self) -> usize {
        self.n
    }

    /// Whether the matrix has no rows.
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.data.len()
    }

    /// Rows and values of column `j`.
    pub fn column(&self, j: usize) -> (&[usize], &[f64]) {
        let range = self.indptr[j]..self.indptr[j + 1];
        (&self.indices[range.clone()], &self.data[range])
    }

    /// Column starts, n + 1 entries.
    pub fn indptr(&self) -> &[usize] {
        &self.indptr
    }

    /// Row index of every stored entry.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// Value of every stored entry.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// Whether entries are stored at the same places.
    pub(crate) fn same_pattern(&self, other: &Self) -> bool {
        self.indptr == other.indptr && self.indices == other.indices
    }

    /// Replaces row and column `j` of a symmetric matrix by `values` (n) at the places `rows`. False, and perhaps half
    /// done, if entries are stored at other places.
    pub(crate) fn replace_symmetrically(&mut self, j: usize, rows: &[usize], values: &[f64]) -> bool {
        let column = self.indptr[j]..self.indptr[j + 1];
        if self.indices[column.clone()] != *rows {
            return false;
        }
        for (place, &i) in column.zip(rows) {
            self.data[place] = values[i];
            let mirror = self.indptr[i]..self.indptr[i + 1];
            let Ok(p) = self.indices[mirror.clone()].binary_search(&j) else { return false };
            self.data[mirror.start + p] = values[i];
        }
        true
    }

    /// Entry `[i, j]`, zero where none is stored.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (rows, values) = self.column(j);
        rows.binary_search(&i).map_or(0.0, |p| values[p])
    }

    /// `y + M x`, the products of each row added up in a fixed order.
    pub fn multiply_add(&self, x: &[f64], y: &[f64]) -> Vec<f64> {
        poll(self.stored());
        let mut result = y.to_vec();
        for (j, &xj) in x.iter().enumerate() {
            if xj != 0.0 {
                self.add_column(j, xj, &mut result);
            }
        }
        result
    }

    /// Adds `factor` times column `j` to `y`.
    pub(crate) fn add_column(&self, j: usize, factor: f64, y: &mut [f64]) {
        let (rows, values) = self.column(j);
        for (&i, &value) in rows.iter().zip(values) {
            y[i] += factor * value;
        }
    }

    /// Inner product of column `j` with a dense vector.
    pub(crate) fn column_dot(&self, j: usize, x: &[f64]) -> f64 {
        let (rows, values) = self.column(j);
        rows.iter().zip(values).map(|(&i, &value)| value * x[i]).sum()
    }

    /// The matrix with entry `[i, j]` multiplied by `d[i] d[j]`.
    pub(crate) fn scaled_symmetrically(&self, d: &[f64]) -> Self {
        let mut scaled = self.clone();
        for j in 0..self.n {
            poll(self.indptr[j + 1] - self.indptr[j]);
            for p in self.indptr[j]..self.indptr[j + 1] {
                scaled.data[p] *= d[self.indices[p]] * d[j];
            }
        }
        scaled
    }

    /// Makes this matrix, of the same pattern, the scaled form of another one where entries in rows and columns in `moved` are
    /// other than they were.
    pub(crate) fn scale_again(&mut self, other: &Self, d: &[f64], moved: impl Fn(usize) -> bool) {
        for j in 0..self.n {
            poll(self.indptr[j + 1] - self.indptr[j]);
            let whole = moved(j);
            for p in self.indptr[j]..self.indptr[j + 1] {
                let i = self.indices[p];
                if whole || moved(i) {
                    self.data[p] = other.data[p] * (d[i] * d[j]);
                }
            }
        }
    }

    /// The principal sub-matrix on `indices`, in that order.
    pub fn principal(&self, indices: &[usize]) -> Self {
        let mut place = vec![usize::MAX; self.n];
        for (k, &i) in indices.iter().enumerate() {
            place[i] = k;
        }
        let (mut indptr, mut rows_out, mut data) = (vec![0], Vec::new(), Vec::new());
        for &j in indices {
            let (rows, values) = self.column(j);
            poll(4 * rows.len());
            for (&i, &value) in rows.iter().zip(values) {
                if place[i] != usize::MAX {
                    rows_out.push(place[i]);
                    data.push(value);
                }
            }
            indptr.push(rows_out.len());
        }
        let mut sub = Self { n: indices.len(), indptr, indices: rows_out, data };
        sub.sort_columns();
        sub
    }
}
