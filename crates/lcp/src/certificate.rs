//! What proves that there is no solution: the one rule, for every method.
//!
//! Exactly, `y >= 0` with `M' y <= 0` and `q' y < 0` is a proof: `z >= 0` with `M z + q >= 0` would give
//! `0 <= y' (M z + q) = (M' y)' z + q' y < 0`. In floating point neither sign is ever exact, and a `y` that holds but for
//! 1e-9 proves only that a solution is larger than 1e9 `|q' y|`: a definite M with a least eigenvalue of 1e-9 has such
//! solutions. So `M' y` must be rounding, and `q' y` clearly more than what passes for zero in a solution.

use crate::{interrupt::apart, matrix::SparseColumns, settings::PROGRESS};
use faer::Mat;

/// Largest `(M' y)_j` that is rounding beyond doubt, as a share of y's length, where the entries of M are at most about 1: that
/// of M's own entries, sixteen units in the last place each.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Largest `(M' y)_j` that may be rounding, as a share of y's largest entry. Between the two a solution comes first, if one is
/// found: its size is at least the progress by this.
const RISE: f64 = 1e-12;
/// Entries of a ray at or below this, relative to the largest, are rounding of the direction that it was computed from: first
/// the more likely, then the most accurate.
const SUPPORTS: [f64; 2] = [1e-10, 1e-14];
/// Where `M' y` is below minus this, relative to y's largest entry, it is truly negative and need not vanish.
const NEGATIVE: f64 = 1e-3;
/// Largest `(M' y)_j`, relative to y's largest entry, of a ray that rounding may have spoiled: that of a matrix written with six
/// decimals.
const NEARLY: f64 = 1e-6;
/// Times a ray is projected again without the entries that became negative.
const PROJECTIONS: usize = 8;
/// Rows of a ray up to which it is worth the dense decomposition that refines it.
const LARGEST_REFINED: usize = 1500;

/// A problem, scaled so that the entries of M are at most about 1, on the rows that count.
pub(crate) struct Scaled<'a> {
    pub m: &'a SparseColumns,
    pub q: &'a [f64],
    /// Rows that are part of the problem, ascending.
    pub rows: &'a [usize],
}

/// A proof that there is no solution.
pub(crate) struct Certificate {
    /// (n), scaled as the problem is.
    pub y: Vec<f64>,
    /// Whether `M' y` is rounding beyond doubt.
    pub is_clear: bool,
}

impl Scaled<'_> {
    /// The certificate that a ray is, or becomes when it is refined. Entries of `ray` (n) on other rows must be zero.
    pub fn certificate(&self, ray: &[f64]) -> Option<Certificate> {
        let y: Vec<f64> = ray.iter().map(|&value| value.max(0.0)).collect();
        match self.judge(&y) {
            Some(true) => Some(Certificate { y, is_clear: true }),
            plain => SUPPORTS
                .iter()
                .find_map(|&support| self.refined(&y, support))
                .or_else(|| plain.map(|is_clear| Certificate { y, is_clear })),
        }
    }

    /// Whether a ray that is no certificate may be one spoiled by rounding.
    pub fn is_nearly(&self, ray: &[f64]) -> bool {
        let size = self.rows.iter().fold(0.0_f64, |size, &i| size.max(ray[i]));
        self.rows.iter().all(|&j| self.m.column_dot(j, ray) <= NEARLY * size)
    }

    /// The rule. `M' y` is at most rounding, and `-q' y` clearly more: then every z whose size is not far beyond what
    /// rounding can tell has an entry of `M z + q` further below zero than a solution may have. None if y is no
    /// certificate, else whether it is a clear one.
    fn judge(&self, y: &[f64]) -> Option<bool> {
        let (mut size, mut sum, mut squares) = (0.0_f64, 0.0, 0.0);
        for &i in self.rows {
            (size, sum, squares) = (size.max(y[i]), sum + y[i], squares + y[i] * y[i]);
        }
        if !(size > 0.0 && squares.is_finite()) {
            return None;
        }
        let rise = self.rows.iter().map(|&j| self.m.column_dot(j, y)).fold(0.0, f64::max);
        let progress: f64 = self.rows.iter().map(|&i| -self.q[i] * y[i]).sum();
        let meets = |&j: &usize| y[j] > 0.0 || self.m.column(j).0.iter().any(|&i| y[i] > 0.0);
        let q_size = self.rows.iter().copied().filter(meets).fold(0.0_f64, |size, j| size.max(self.q[j].abs()));
        let clear = rise <= ROUNDING * squares.sqrt();
        (progress > PROGRESS * q_size * sum && (clear || rise <= RISE * size)).then_some(clear)
    }

    /// A ray is computed from the active rows alone, by a factor that may be nearly singular; the error is what `M' y`
    /// shows. Its part in the null space of all rows that should vanish has no such error.
    fn refined(&self, ray: &[f64], least: f64) -> Option<Certificate> {
        let mut y = ray.to_vec();
        for _ in 0..PROJECTIONS {
            let size = y.iter().fold(0.0, |size: f64, &y| size.max(y));
            let support: Vec<usize> = self.rows.iter().copied().filter(|&i| y[i] > least * size).collect();
            if support.is_empty() || support.len() > LARGEST_REFINED || !size.is_finite() {
                return None;
            }
            let vanishing: Vec<usize> =
                self.rows.iter().copied().filter(|&j| self.m.column_dot(j, &y) >= -NEGATIVE * size).collect();
            let projected = self.projected(&y, &support, &vanishing)?;
            y.fill(0.0);
            support.iter().zip(&projected).for_each(|(&i, &value)| y[i] = value.max(0.0));
            if let Some(is_clear) = self.judge(&y) {
                return Some(Certificate { y, is_clear });
            }
            if projected.iter().all(|&value| value > 0.0) {
                return None;
            }
        }
        None
    }

    /// The part of y that M' maps to zero on the rows `vanishing`, within the vectors on `support`.
    fn projected(&self, y: &[f64], support: &[usize], vanishing: &[usize]) -> Option<Vec<f64>> {
        let mut place = vec![None; y.len()];
        support.iter().enumerate().for_each(|(k, &i)| place[i] = Some(k));
        let mut image = Mat::<f64>::zeros(vanishing.len(), support.len());
        for (r, &j) in vanishing.iter().enumerate() {
            let (rows, values) = self.m.column(j);
            for (&i, &value) in rows.iter().zip(values) {
                if let Some(k) = place[i] {
                    image[(r, k)] = value;
                }
            }
        }
        let work = 10 * vanishing.len() * support.len() * support.len();
        let svd = apart(work, move || image.thin_svd()).ok()?;
        let mut rest: Vec<f64> = support.iter().map(|&i| y[i]).collect();
        for (c, &sigma) in svd.S().column_vector().iter().enumerate() {
            if sigma > RISE {
                let v = svd.V().col(c);
                let part: f64 = v.iter().zip(support).map(|(v, &i)| v * y[i]).sum();
                rest.iter_mut().zip(v.iter()).for_each(|(rest, v)| *rest -= part * v);
            }
        }
        Some(rest)
    }
}
