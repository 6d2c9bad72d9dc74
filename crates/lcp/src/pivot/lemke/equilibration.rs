//! Scaling of rows and columns apart, for a matrix that need not be symmetric.

use crate::{error::LcpError, interrupt::poll, matrix::SparseColumns, problem::Problem};

/// `w = R^-1 ws`, `z = C zs`: the problem becomes `ws = (R M C) zs + R q`, and complementary pairs stay complementary.
///
/// All factors are powers of two, so scaling rounds nothing and exact ties of the caller's data stay ties.
#[derive(Debug)]
pub(super) struct Equilibration {
    /// Diagonal of R (n).
    pub rows: Vec<f64>,
    /// Diagonal of C (n).
    pub columns: Vec<f64>,
}

/// Passes over the matrix; each takes the square root of the spread that is left (Ruiz 2001), so that eight of them
/// bring 24 orders of magnitude down to a factor of 1.3.
const PASSES: usize = 8;
/// Largest exponents of a factor of M, so that two of them times any usual entry stay a normal number, and of q.
const M_EXPONENT: f64 = 300.0;
const Q_EXPONENT: f64 = 1000.0;

impl Equilibration {
    /// Starts from a unit diagonal where it is positive, which is all that a semidefinite matrix needs, and then
    /// brings the largest entry of every row and column towards one.
    pub fn new(m: &SparseColumns) -> Self {
        let unit = |i: usize| Some(m.get(i, i)).filter(|&d| d > 0.0).map_or(1.0, |d| d.sqrt().recip());
        let mut rows: Vec<f64> = (0..m.len()).map(unit).collect();
        let mut columns = rows.clone();
        for _ in 0..PASSES {
            let (mut row_size, mut column_size) = (vec![0.0_f64; m.len()], vec![0.0_f64; m.len()]);
            for j in 0..m.len() {
                let (indices, values) = m.column(j);
                poll(indices.len());
                for (&i, value) in indices.iter().zip(values) {
                    let size = (value * rows[i] * columns[j]).abs();
                    row_size[i] = row_size[i].max(size);
                    column_size[j] = column_size[j].max(size);
                }
            }
            shrink(&mut rows, &row_size);
            shrink(&mut columns, &column_size);
        }
        rows.iter_mut().chain(&mut columns).for_each(|factor| *factor = power_of_two(*factor, M_EXPONENT));
        Self { rows, columns }
    }

    /// `R M C` and `R q`; the latter divided by a power of two, returned third, that brings its largest entry near one.
    pub fn apply(&self, problem: &Problem) -> Result<(SparseColumns, Vec<f64>, f64), LcpError> {
        let (m, n) = (problem.m(), problem.len());
        let mut data = Vec::with_capacity(m.stored());
        for j in 0..n {
            let (indices, values) = m.column(j);
            data.extend(indices.iter().zip(values).map(|(&i, value)| value * self.rows[i] * self.columns[j]));
        }
        let scaled = SparseColumns::new(n, m.indptr().to_vec(), m.indices().to_vec(), data)?;
        let mut q: Vec<f64> = problem.q().iter().zip(&self.rows).map(|(q, r)| q * r).collect();
        let unit = power_of_two(q.iter().fold(0.0, |size: f64, q| size.max(q.abs())), Q_EXPONENT);
        q.iter_mut().for_each(|q| *q /= unit);
        Ok((scaled, q, unit))
    }
}

fn shrink(factors: &mut [f64], sizes: &[f64]) {
    for (factor, &size) in factors.iter_mut().zip(sizes) {
        if size > 0.0 {
            *factor /= size.sqrt();
        }
    }
}

/// The power of two nearest to a positive number, 1 for zero.
fn power_of_two(value: f64, largest: f64) -> f64 {
    if value > 0.0 { value.log2().round().clamp(-largest, largest).exp2() } else { 1.0 }
}
