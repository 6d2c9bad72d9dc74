//! The problem: `M` and `q`, validated once and fixed during a solve.

use crate::{error::LcpError, interrupt::poll, matrix::SparseColumns};

/// `w = M z + q`, `0 <= z` complementary to `w >= 0`.
#[derive(Debug, Clone)]
pub struct Problem {
    m: SparseColumns,
    q: Vec<f64>,
    /// `M` is symmetric positive semidefinite by the way it was made.
    gram: bool,
}

/// How `M` was made makes no difference.
impl PartialEq for Problem {
    fn eq(&self, other: &Self) -> bool {
        self.m == other.m && self.q == other.q
    }
}

/// Two mirrored entries of a symmetric matrix may differ by this much, relative to `sqrt(M_ii M_jj)`: what
/// rounding leaves in a product `G' M^-1 G` that was summed in two different orders.
const SYMMETRY: f64 = 1e-12;

/// `|M_ij|` may exceed `sqrt(M_ii M_jj)` by this much of it; rounding in `G' M^-1 G` with repeated columns is near 1e-15.
const SEMIDEFINITE: f64 = 1e-9;

/// Operations to find an entry of a column, about.
const SEARCH: usize = 16;

impl Problem {
    /// Takes a sparse matrix (n x n) and a vector (n).
    ///
    /// # Errors
    /// [`LcpError::Shape`] if they do not fit, [`LcpError::VectorNotFinite`] for a NaN or infinity in `q`.
    pub fn new(m: SparseColumns, q: Vec<f64>) -> Result<Self, LcpError> {
        if m.len() != q.len() {
            return Err(LcpError::Shape { rows: m.len(), columns: m.len(), q: q.len() });
        }
        if let Some(index) = q.iter().position(|value| !value.is_finite()) {
            return Err(LcpError::VectorNotFinite { index, value: q[index] });
        }
        Ok(Self { m, q, gram: false })
    }

    /// The same, where `M` is a product `G' W G` in exact symmetry: nobody needs to look again.
    pub(crate) fn of_gram(m: SparseColumns, q: Vec<f64>) -> Result<Self, LcpError> {
        Ok(Self { gram: true, ..Self::new(m, q)? })
    }

    /// Whether `M` is known to be such a product.
    pub(crate) fn is_gram(&self) -> bool {
        self.gram
    }

    /// Takes a dense matrix, n x n in row-major order.
    ///
    /// # Errors
    /// As [`Self::new`] and [`SparseColumns::from_dense`].
    pub fn from_dense(m: &[f64], q: Vec<f64>) -> Result<Self, LcpError> {
        if m.len() != q.len() * q.len() {
            let columns = m.len().checked_div(q.len()).unwrap_or(0);
            return Err(LcpError::Shape { rows: q.len(), columns, q: q.len() });
        }
        Self::new(SparseColumns::from_dense(m)?, q)
    }

    /// Number of complementary pairs, n.
    pub fn len(&self) -> usize {
        self.q.len()
    }

    /// Whether there are no pairs.
    pub fn is_empty(&self) -> bool {
        self.q.is_empty()
    }

    /// The matrix `M`.
    pub fn m(&self) -> &SparseColumns {
        &self.m
    }

    /// The vector `q`.
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// Replaces `q` by finite values of the same number.
    pub(crate) fn set_q(&mut self, q: &[f64]) {
        self.q.copy_from_slice(q);
    }

    /// `M z + q`.
    pub fn w(&self, z: &[f64]) -> Vec<f64> {
        self.m.multiply_add(z, &self.q)
    }

    /// The principal sub-problem on `indices` (Theorem 1 of Loomis and Balkcom starts from its solution).
    pub fn principal(&self, indices: &[usize]) -> Self {
        let q = indices.iter().map(|&i| self.q[i]).collect();
        Self { m: self.m.principal(indices), q, gram: self.gram }
    }

    /// Checks that `M` is symmetric and that no principal block of order one or two is indefinite, as principal pivoting
    /// needs. Larger indefinite blocks show up in a solve.
    ///
    /// # Errors
    /// [`LcpError::NotSymmetric`] or [`LcpError::NotSemidefinite`], naming the first offending entry.
    pub fn require_symmetric(&self) -> Result<(), LcpError> {
        if self.gram {
            return Ok(());
        }
        let diagonal: Vec<f64> = (0..self.len()).map(|i| self.m.get(i, i)).collect();
        if let Some(index) = diagonal.iter().position(|&value| value < 0.0) {
            return Err(LcpError::NotSemidefinite { index, eigenvalue: diagonal[index] });
        }
        for column in 0..self.len() {
            let (rows, values) = self.m.column(column);
            poll(SEARCH * rows.len());
            for (&row, &value) in rows.iter().zip(values) {
                let mirror = self.m.get(column, row);
                let size = (diagonal[row] * diagonal[column]).sqrt().max(value.abs());
                if (value - mirror).abs() > SYMMETRY * size {
                    return Err(LcpError::NotSymmetric { row, column, value, mirror });
                }
            }
        }
        self.require_small_blocks_semidefinite(&diagonal)
    }

    /// `|M_ij| <= sqrt(M_ii M_jj)`: else `y = e_i / sqrt(M_ii) -+ e_j / sqrt(M_jj)` has negative curvature.
    fn require_small_blocks_semidefinite(&self, diagonal: &[f64]) -> Result<(), LcpError> {
        for column in 0..self.len() {
            let (rows, values) = self.m.column(column);
            poll(SEARCH * rows.len());
            for (&index, value) in rows.iter().zip(values) {
                let bound = diagonal[index].sqrt() * diagonal[column].sqrt();
                if value.abs() > bound * (1.0 + SEMIDEFINITE) {
                    let (a, b) = (diagonal[index], diagonal[column]);
                    return Err(LcpError::NotSemidefinite { index, eigenvalue: least_eigenvalue(a, *value, b) });
                }
            }
        }
        Ok(())
    }
}

/// Of the block `[a v; v b]`, scaled to a unit diagonal where that is positive.
fn least_eigenvalue(a: f64, v: f64, b: f64) -> f64 {
    let unit = |d: f64| -> (f64, f64) { if d > 0.0 { (d.sqrt(), 1.0) } else { (1.0, 0.0) } };
    let ((da, a), (db, b)) = (unit(a), unit(b));
    (a + b) / 2.0 - ((a - b) / 2.0).hypot(v.abs() / da / db)
}
