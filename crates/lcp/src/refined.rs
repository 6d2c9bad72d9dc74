//! `B x = b` to 32 digits: B is factored in 64 bits, and the solution refined with residuals in double-double arithmetic
//! (Wilkinson's iterative refinement, with the residual in twice the precision).

use faer::{
    Mat,
    linalg::solvers::Solve,
    sparse::{SparseColMat, Triplet, linalg::solvers::Lu},
};
use twofloat::TwoFloat;

/// Refinements at most; each gains as many digits as the factor is good for, and there are 32 to gain.
const REFINEMENTS: usize = 60;
/// A refinement that leaves more than this share of the residual is the last.
const GAIN: f64 = 0.7;
/// Residual of a solution, relative to the terms of its row, above which it is not one: six digits short of what
/// double-double numbers hold.
const RESIDUAL: f64 = 1e-26;
/// A row whose terms are all smaller than this share of the largest is measured by that: they may be rounding.
const FLOOR: f64 = 1e-6;
/// Rounds of equilibration: each takes the square root of what rows and columns differ by (Ruiz 2001).
const ROUNDS: usize = 6;

/// A square matrix by columns, and its factor.
#[derive(Debug)]
pub struct Square {
    columns: Vec<Vec<(usize, f64)>>,
    lu: Lu<usize, f64>,
    /// Of rows and columns, when it was factored: powers of two.
    scales: [Vec<f64>; 2],
}

impl Square {
    /// Takes the entries (row, value) of each column. None if the matrix is singular to working precision.
    pub fn new(columns: Vec<Vec<(usize, f64)>>) -> Option<Self> {
        let scales = equilibrated(&columns);
        let lu = factor(&columns, &scales)?;
        Some(Self { columns, lu, scales })
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// The unknowns `x` of `B x = b`, rounded to 64 bits. None if the matrix is too near to a singular one.
    pub fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        let right: Vec<TwoFloat> = b.iter().map(|&b| b.into()).collect();
        let x = refined(&right, |r| self.solve_roughly(r), |x| self.residual(&right, x))?;
        Some(x.iter().map(|x| x.hi()).collect())
    }

    pub(crate) fn put_column(&mut self, place: usize, column: Vec<(usize, f64)>) {
        self.columns[place] = column;
    }

    /// Factors the matrix as it is now.
    pub(crate) fn factor(&mut self) -> Option<()> {
        self.scales = equilibrated(&self.columns);
        self.lu = factor(&self.columns, &self.scales)?;
        Some(())
    }

    pub(crate) fn solve_roughly(&self, b: &[f64]) -> Vec<f64> {
        let [rows, columns] = &self.scales;
        let x = self.lu.solve(&scaled(b, rows));
        unscaled(&x, columns)
    }

    pub(crate) fn solve_transposed_roughly(&self, c: &[f64]) -> Vec<f64> {
        let [rows, columns] = &self.scales;
        let y = self.lu.solve_transpose(&scaled(c, columns));
        unscaled(&y, rows)
    }

    /// `b - B x`, and the sizes of its terms by row.
    pub(crate) fn residual(&self, b: &[TwoFloat], x: &[TwoFloat]) -> Vec<(f64, f64)> {
        let mut rows: Vec<(TwoFloat, f64)> = b.iter().map(|b| (*b, b.hi().abs())).collect();
        for (column, x) in self.columns.iter().zip(x) {
            for &(row, value) in column {
                let term = *x * value;
                rows[row].0 -= term;
                rows[row].1 += term.hi().abs();
            }
        }
        rows.into_iter().map(|(sum, size)| (sum.hi(), size)).collect()
    }

    /// `c - B' y`, and the sizes of its terms by column.
    pub(crate) fn residual_transposed(&self, c: &[TwoFloat], y: &[TwoFloat]) -> Vec<(f64, f64)> {
        let of_column = |(column, c): (&Vec<(usize, f64)>, &TwoFloat)| {
            let (mut sum, mut size) = (*c, c.hi().abs());
            for &(row, value) in column {
                let term = y[row] * value;
                sum -= term;
                size += term.hi().abs();
            }
            (sum.hi(), size)
        };
        self.columns.iter().zip(c).map(of_column).collect()
    }
}

/// Solves roughly for what is left until that does not shrink any more.
pub(crate) fn refined(
    right: &[TwoFloat],
    solve: impl Fn(&[f64]) -> Vec<f64>,
    residual: impl Fn(&[TwoFloat]) -> Vec<(f64, f64)>,
) -> Option<Vec<TwoFloat>> {
    let mut x = vec![TwoFloat::from(0.0); right.len()];
    let mut left: Vec<f64> = right.iter().map(|b| b.hi()).collect();
    let mut error = f64::INFINITY;
    for _ in 0..REFINEMENTS {
        let mut better = x.clone();
        better.iter_mut().zip(solve(&left)).for_each(|(x, change)| *x += change);
        let rows = residual(&better);
        let floor = FLOOR * rows.iter().fold(0.0, |largest: f64, row| largest.max(row.1));
        let share = |&(rest, size): &(f64, f64)| if rest == 0.0 { 0.0 } else { rest.abs() / size.max(floor) };
        let worse = |worst: f64, share: f64| if share.is_nan() { f64::INFINITY } else { worst.max(share) };
        let now = rows.iter().map(share).fold(0.0, worse);
        let last = now > GAIN * error;
        if now < error {
            (x, error) = (better, now);
            left = rows.iter().map(|row| row.0).collect();
        }
        if last || error == 0.0 {
            break;
        }
    }
    (error <= RESIDUAL).then_some(x)
}

/// Scales of rows and columns, powers of two, that bring the largest entry of each near one.
fn equilibrated(columns: &[Vec<(usize, f64)>]) -> [Vec<f64>; 2] {
    let n = columns.len();
    let (mut row_scale, mut column_scale) = (vec![1.0; n], vec![1.0; n]);
    for _ in 0..ROUNDS {
        let (mut of_row, mut of_column) = (vec![0.0_f64; n], vec![0.0_f64; n]);
        for (k, column) in columns.iter().enumerate() {
            for &(row, value) in column {
                let size = (value * row_scale[row] * column_scale[k]).abs();
                of_row[row] = of_row[row].max(size);
                of_column[k] = of_column[k].max(size);
            }
        }
        let shrink = |scale: &mut f64, size: f64| {
            if size > 0.0 {
                *scale *= (-0.5 * size.log2()).round().exp2();
            }
        };
        row_scale.iter_mut().zip(of_row).for_each(|(scale, size)| shrink(scale, size));
        column_scale.iter_mut().zip(of_column).for_each(|(scale, size)| shrink(scale, size));
    }
    [row_scale, column_scale]
}

fn factor(columns: &[Vec<(usize, f64)>], [rows, scales]: &[Vec<f64>; 2]) -> Option<Lu<usize, f64>> {
    let mut triplets = Vec::new();
    for (k, column) in columns.iter().enumerate() {
        triplets.extend(column.iter().map(|&(row, value)| Triplet::new(row, k, value * rows[row] * scales[k])));
    }
    let size = columns.len();
    SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?.sp_lu().ok()
}

fn scaled(values: &[f64], scales: &[f64]) -> Mat<f64> {
    Mat::from_fn(values.len(), 1, |row, _| values[row] * scales[row])
}

fn unscaled(column: &Mat<f64>, scales: &[f64]) -> Vec<f64> {
    (0..column.nrows()).map(|row| column[(row, 0)] * scales[row]).collect()
}
