//! The factor of the active block `M_CC`: a row goes in, a row goes out, and it is never rebuilt for a pivot.

mod dense;
mod sparse;
mod symbolic;
#[cfg(test)]
mod tests;

pub use dense::DenseFactor;
pub use sparse::SparseFactor;

use crate::matrix::SparseColumns;
use serde::{Deserialize, Serialize};

/// A factorisation of the principal block of a symmetric positive semidefinite matrix on an active set C.
///
/// Rows are addressed by their index in the complete matrix, so callers never see an internal order. The
/// matrix passed to [`ActiveFactor::insert`] must be the same one every time.
pub trait ActiveFactor: std::fmt::Debug + Send + Sync {
    /// Adds row `i` to C and returns its pivot, the Schur complement of the rows before it.
    ///
    /// # Errors
    /// [`SingularBlock`] if the enlarged block would not be numerically positive definite. C is unchanged then, but
    /// the factor may have lost digits: build it again.
    fn insert(&mut self, m: &SparseColumns, i: usize) -> Result<f64, SingularBlock>;

    /// Removes row `i` from C; does nothing if it is not there.
    fn remove(&mut self, i: usize);

    /// Solves `M_CC x_C = b_C` in place. `x` is as long as the matrix; entries outside C must be zero and stay so. Returns
    /// the number of stored numbers read, of `L` in either direction and of `D`.
    fn solve(&self, x: &mut [f64]) -> usize;

    /// Empties C.
    fn clear(&mut self);

    /// The rows in C, ascending.
    fn rows(&self) -> Vec<usize>;

    /// Number of rows in C.
    fn len(&self) -> usize;

    /// Whether C is empty.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Stored numbers: what memory and one solve are proportional to.
    fn entries(&self) -> usize;

    /// The same factor for a matrix of `n` rows in which row i has become row `place[i]`; rows of C must be among those. None
    /// if the factor rests on an analysis of the old matrix.
    fn renumbered(&self, n: usize, place: &[Option<usize>]) -> Option<Box<dyn ActiveFactor>>;

    /// The same factor once more.
    fn boxed(&self) -> Box<dyn ActiveFactor>;

    /// Every number of the factor, to be kept outside of it.
    fn numbers(&self) -> FactorNumbers;

    /// Takes the numbers of a factor of the same kind, for the same matrix. False if they do not fit; C is empty then.
    fn take_numbers(&mut self, numbers: &FactorNumbers) -> bool;
}

impl Clone for Box<dyn ActiveFactor> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// The numbers of a factor: with the matrix they make the same factor again, bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum FactorNumbers {
    /// Of a [`DenseFactor`].
    Dense {
        /// Matrix index of every factor row, in order of entry.
        order: Vec<usize>,
        /// Row r holds the r entries of `L` left of the diagonal.
        l: Vec<Vec<f64>>,
        /// The diagonal `D`.
        d: Vec<f64>,
    },
    /// Of a [`SparseFactor`].
    Sparse {
        /// Entries of `L` on the static pattern.
        l: Vec<f64>,
        /// The diagonal `D`.
        d: Vec<f64>,
        /// Which positions are in C.
        active: Vec<bool>,
    },
}

/// The row depends, to working accuracy, on the rows already in the active block.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("row {row} depends on the active rows (pivot {pivot:e})")]
pub struct SingularBlock {
    /// The row that could not be added.
    pub row: usize,
    /// Its pivot (Schur complement).
    pub pivot: f64,
}

/// Below this share of the diagonal a pivot is rounding: the subtraction that made it lost all its digits.
const LOST: f64 = 1e-14;

/// The factor whose storage is smaller for this matrix: dense while the static fill is more than half of a full
/// triangle (or the matrix is tiny), sparse otherwise.
pub fn choose(m: &SparseColumns) -> Box<dyn ActiveFactor> {
    const TINY: usize = 48;
    if m.len() <= TINY {
        return Box::new(DenseFactor::new(m.len()));
    }
    let sparse = SparseFactor::new(m);
    if 4 * sparse.entries() > m.len() * m.len() {
        return Box::new(DenseFactor::new(m.len()));
    }
    Box::new(sparse)
}

/// State of a rank-one change `L D L' + alpha w w'` as it passes down the columns.
///
/// Gill, Golub, Murray and Saunders, Methods for modifying matrix factorizations (1974), method C1.
#[derive(Debug, Clone, Copy)]
struct RankOne {
    alpha: f64,
}

impl RankOne {
    /// Passes column j with diagonal `d` and entry `wj`: the new diagonal, and the factor beta for
    /// `w_i -= w_j L_ij; L_ij += beta w_i`.
    fn pass(&mut self, d: f64, wj: f64) -> (f64, f64) {
        let updated = d + self.alpha * wj * wj;
        let beta = self.alpha * wj / updated;
        self.alpha *= d / updated;
        (updated, beta)
    }
}
