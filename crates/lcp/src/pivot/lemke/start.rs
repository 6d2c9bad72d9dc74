//! An advanced start: a complementary basis that belongs to the solution of a principal sub-problem.
//!
//! Basic are the `z` that are positive, if their rows are independent. If not, there are two ways out for a semidefinite
//! M, both by a null vector y of `M_CC`, for which `(M + M') y = 0`. Rows in which z and w are both zero and where
//! `M y` is not join the basis: the block with such a row is nonsingular. If there are none, as when M is symmetric and
//! so `M y = 0`, z is moved along y, which changes no w, until another active z is zero.

use crate::{
    error::LcpError, interrupt::poll, matrix::SparseColumns, problem::Problem, reuse::Start, scaling::Scaling,
    settings::Settings, solver::Solver,
};

/// The solution of a start, scaled to a unit diagonal.
pub(super) struct Known<'a> {
    problem: &'a Problem,
    start: &'a Start,
    settings: &'a Settings,
    z: Vec<f64>,
    w: Vec<f64>,
    /// Below this a z or w is zero.
    zero: f64,
}

impl<'a> Known<'a> {
    /// # Errors
    /// [`LcpError::Start`] if the start does not solve its sub-problem.
    pub fn new(problem: &'a Problem, start: &'a Start, settings: &'a Settings) -> Result<Self, LcpError> {
        start.require_well_formed(problem.len())?;
        let scaling = Scaling::new(problem);
        let mut z = start.spread(problem.len());
        let w: Vec<f64> = problem.w(&z).iter().zip(&scaling.d).map(|(w, d)| w * d).collect();
        z.iter_mut().zip(&scaling.d).for_each(|(z, d)| *z /= d);
        let q_size = start.indices.iter().fold(0.0, |size: f64, &i| size.max((scaling.d[i] * problem.q()[i]).abs()));
        start.require_complementary(&z, &w, &scaling.d, q_size)?;
        let zero = settings.feasibility * z.iter().fold(q_size, |size, z| size.max(*z));
        Ok(Self { problem, start, settings, z, w, zero })
    }

    /// Rows with `z > 0`, ascending.
    pub fn positive(&self) -> Vec<usize> {
        self.rows(|i| self.z[i] > 0.0 && self.z[i] >= self.w[i])
    }

    /// The positive rows and, of those where z and w are both zero, as many as it takes to make the columns of the positive
    /// ones independent. `None` if they do not suffice. `m` is M, equilibrated.
    pub fn completed(&self, m: &SparseColumns) -> Option<Vec<usize>> {
        let positive = self.positive();
        let idle = self.rows(|i| self.z[i] <= self.zero && self.w[i].abs() <= self.zero && !positive.contains(&i));
        let mut columns: Vec<Vec<f64>> = positive.iter().map(|&j| dense_column(m, j)).collect();
        let mut active = positive.clone();
        eliminate(&mut columns, &positive, self.settings.pivot);
        active.extend(eliminate(&mut columns, &idle, self.settings.pivot));
        active.sort_unstable();
        columns.is_empty().then_some(active)
    }

    /// Rows with `z > 0` once z has been moved along the null directions, for a symmetric M.
    pub fn reduced(&self) -> Option<Vec<usize>> {
        let mut solver = Solver::new(self.problem.clone(), self.settings.clone()).ok()?;
        solver.start_from(self.start).ok()?;
        Some((0..self.problem.len()).filter(|&i| solver.z(i) > 0.0).collect())
    }

    /// The order of the lexicographic rule: which rows are perturbed most. Any order will do; with the known rows before
    /// the new ones, and the last before the first in both, degenerate contact problems take the fewest pivots
    /// (`docs/theory/lemke.md`).
    pub fn order(&self) -> Vec<usize> {
        let mut new = vec![true; self.z.len()];
        self.start.indices.iter().for_each(|&i| new[i] = false);
        let mut order: Vec<usize> = (0..self.z.len()).rev().collect();
        order.sort_by_key(|&i| new[i]);
        order
    }

    fn rows(&self, keep: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut rows: Vec<usize> = self.start.indices.iter().copied().filter(|&i| keep(i)).collect();
        rows.sort_unstable();
        rows
    }
}

fn dense_column(m: &SparseColumns, j: usize) -> Vec<f64> {
    let mut column = vec![0.0; m.len()];
    m.add_column(j, 1.0, &mut column);
    column
}

/// Gauss's elimination of columns by pivots in `rows`, the largest first: a column with a pivot goes, the others become zero
/// in its row. What is left is zero in all of `rows`. Returns the rows with a pivot.
fn eliminate(columns: &mut Vec<Vec<f64>>, rows: &[usize], least: f64) -> Vec<usize> {
    let mut pivots = Vec::new();
    loop {
        let entries = (0..columns.len()).flat_map(|k| rows.iter().map(move |&row| (k, row)));
        let size = |&(k, row): &(usize, usize)| columns[k][row].abs();
        let largest = entries.max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a)));
        let Some((k, row)) = largest.filter(|entry| size(entry) > least) else { return pivots };
        poll(columns.len() * (rows.len() + pivots.len()));
        let pivot = columns.swap_remove(k);
        for column in columns.iter_mut() {
            poll(pivot.len());
            let factor = column[row] / pivot[row];
            column.iter_mut().zip(&pivot).for_each(|(value, p)| *value -= factor * p);
        }
        pivots.push(row);
    }
}
