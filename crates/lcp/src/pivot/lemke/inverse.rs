//! The explicit inverse of a basis, which the lexicographic rule reads row by row.

use faer::{
    Mat,
    linalg::solvers::{DenseSolveCore, Solve},
};

/// `B^-1`, n x n by rows. One exchange costs n^2 operations (Gauss and Jordan); [`Self::rebuild`] factors B anew.
#[derive(Debug)]
pub(super) struct BasisInverse {
    n: usize,
    rows: Vec<f64>,
    /// Exchanges since the inverse was computed from B itself.
    pub age: usize,
}

impl BasisInverse {
    /// The inverse of the identity.
    pub fn identity(n: usize) -> Self {
        let mut rows = vec![0.0; n * n];
        rows.iter_mut().step_by(n + 1).for_each(|diagonal| *diagonal = 1.0);
        Self { n, rows, age: 0 }
    }

    /// Row `r` (n).
    pub fn row(&self, r: usize) -> &[f64] {
        &self.rows[r * self.n..(r + 1) * self.n]
    }

    /// `B^-1 a` for a sparse `a`.
    pub fn apply(&self, (indices, values): (&[usize], &[f64])) -> Vec<f64> {
        let dot = |row: &[f64]| indices.iter().zip(values).map(|(&i, value)| row[i] * value).sum();
        (0..self.n).map(|r| dot(self.row(r))).collect()
    }

    /// The column at place `r` of B is replaced by `a`, with `direction = B^-1 a`.
    pub fn exchange(&mut self, r: usize, direction: &[f64]) {
        let n = self.n;
        let mut pivot_row: Vec<f64> = self.row(r).to_vec();
        pivot_row.iter_mut().for_each(|value| *value /= direction[r]);
        for (i, &d) in direction.iter().enumerate() {
            if i != r && d != 0.0 {
                for (value, p) in self.rows[i * n..(i + 1) * n].iter_mut().zip(&pivot_row) {
                    *value -= d * p;
                }
            }
        }
        self.rows[r * n..(r + 1) * n].copy_from_slice(&pivot_row);
        self.age += 1;
    }

    /// Computes the inverse from B itself by LU with partial pivoting, and `B^-1 q` with one step of iterative
    /// refinement. `None` if B is numerically singular.
    pub fn rebuild(&mut self, b: &Mat<f64>, q: &[f64]) -> Option<Vec<f64>> {
        let lu = b.partial_piv_lu();
        let inverse = lu.inverse();
        for (r, row) in self.rows.chunks_exact_mut(self.n).enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = inverse[(r, j)];
            }
        }
        self.age = 0;
        let right = Mat::from_fn(self.n, 1, |i, _| q[i]);
        let mut x = lu.solve(&right);
        let correction = lu.solve(&right - b * &x);
        x += correction;
        let x: Vec<f64> = (0..self.n).map(|i| x[(i, 0)]).collect();
        (self.rows.iter().chain(&x).all(|value| value.is_finite())).then_some(x)
    }
}
