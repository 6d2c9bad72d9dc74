//! A certificate looked for among all vectors, where pivots met none.
//!
//! After the first attempts among those that M maps to zero but for rounding: where columns of M agree but for their last digits, no
//! basis has them. At the very end among all:
//!
//! ```text
//! z >= 0, w >= 0 with (-M, I) (z, w) = q,   or y >= 0 with M' y <= 0 and q' y < 0   (Farkas: exactly one of them exists)
//! ```
//!
//! Whether q is in the cone of the columns of (-M, I) is what [`ConeSolver`] decides: its multipliers are -y. If `M' y` of a basis
//! in 64 bits is not the rounding that a certificate must be (`certificate.rs`), the last pivots are made in 32 digits.

use super::{
    Solver,
    doubt::{EIGENVALUE_ROUNDING, LARGEST_DENSE},
};
use crate::{
    cone::{Columns, ConeSolver, Membership},
    error::LcpError,
    pivot::lemke_on,
    problem::Problem,
};
use faer::Mat;

impl Solver {
    /// Looks for a certificate among all vectors that M maps to zero, N the basis of these: the projection y of -q onto the cone
    /// of those that are not negative. By Moreau's theorem `q'y = -y'y`, so there is none if y = 0. It is `y = N N' (x - q)`
    /// where x >= 0 and y >= 0 are complementary: a problem with the matrix of a projection, whatever M is.
    /// True if a clear one was found, and kept. Not looked for where the caller limits the pivots: those for it would be beyond.
    ///
    /// # Errors
    /// [`LcpError::VectorNotFinite`], if scaling made an entry too large.
    pub(super) fn certify_in_null_space(&mut self) -> Result<bool, LcpError> {
        if self.settings.pivot_limit.is_some() {
            return Ok(false);
        }
        let rows = self.rows();
        let Some(null) = self.null_space(&rows).filter(|null| null.ncols() > 0) else { return Ok(false) };
        let q = Mat::from_fn(rows.len(), 1, |i, _| self.load.scaled[rows[i]]);
        let projection = &null * null.transpose();
        let image = &projection * &q;
        let entries: Vec<f64> = (0..rows.len())
            .flat_map(|i| (0..rows.len()).map(move |j| (i.min(j), i.max(j))))
            .map(|(i, j)| projection[(i, j)])
            .collect();
        let problem = Problem::from_dense(&entries, (0..rows.len()).map(|i| -image[(i, 0)]).collect())?;
        let found = lemke_on(&problem, &self.settings)?;
        let mut y = vec![0.0; self.z.len()];
        rows.iter().zip(found.w.iter().zip(&found.z)).filter(|(_, (w, z))| w > z).for_each(|(&i, (&w, _))| y[i] = w);
        Ok(self.take_certificate(&y))
    }

    /// An orthonormal basis of the vectors that M maps to zero but for rounding. None if it is too large to look.
    fn null_space(&self, rows: &[usize]) -> Option<Mat<f64>> {
        if rows.len() > LARGEST_DENSE {
            return None;
        }
        let eigen = self.eigen(rows)?;
        let rounding = EIGENVALUE_ROUNDING * rows.len() as f64;
        let null: Vec<usize> = (0..rows.len()).filter(|&k| eigen.S().column_vector()[k].abs() <= rounding).collect();
        Some(Mat::from_fn(rows.len(), null.len(), |i, k| eigen.U()[(i, null[k])]))
    }

    /// Asks whether q is in the cone of the columns of (-M, I). True if a clear certificate was found, and kept. Far slower than an
    /// attempt where 32 digits are needed.
    ///
    /// # Errors
    /// [`LcpError::MatrixNotFinite`] or [`LcpError::VectorNotFinite`], if scaling made an entry too large.
    pub(super) fn certify_by_simplex(&mut self, rows: &[usize]) -> Result<bool, LcpError> {
        let q: Vec<f64> = rows.iter().map(|&i| self.load.scaled[i]).collect();
        let mut cone = ConeSolver::new(self.columns_with_slacks(rows)?, &q, &vec![1.0; rows.len()])?;
        cone.add_rows(&(0..rows.len()).collect::<Vec<_>>());
        for decide in [ConeSolver::solve, ConeSolver::decide_extended] {
            if decide(&mut cone) == Membership::Inside {
                return Ok(false);
            }
            let mut y = vec![0.0; self.z.len()];
            cone.certificate().iter().for_each(|&(k, multiplier)| y[rows[k]] = -multiplier);
            if self.take_certificate(&y) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// (-M, I) on some rows.
    fn columns_with_slacks(&self, rows: &[usize]) -> Result<Columns, LcpError> {
        let n = rows.len();
        let part = self.m.principal(rows);
        let (mut starts, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            let (places, values) = part.column(j);
            indices.extend_from_slice(places);
            data.extend(values.iter().map(|value| -value));
            starts.push(indices.len());
        }
        starts.extend((1..=n).map(|i| indices.len() + i));
        indices.extend(0..n);
        data.resize(indices.len(), 1.0);
        Columns::new(n, &starts, &indices, &data)
    }
}
