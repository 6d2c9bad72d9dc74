//! Lemke's complementary pivoting, for any `M`: symmetric or not, definite or not.
//!
//! An artificial `z0` with a positive covering vector c makes `w = M z + q + c z0` feasible at once. From there every pivot
//! enters the complement of the variable that left, until `z0` leaves (solved) or nothing blocks (a ray). Ties
//! go by the lexicographic rule, so the path never returns to a basis and the method ends.
//!
//! It processes every copositive-plus matrix, positive semidefinite ones among them: a solution or a proof that there is
//! none. For other matrices a ray proves nothing. Dense, n^2 operations a pivot.
//!
//! With reuse the path begins at the basis of a sub-problem's solution, and c is positive only where that is
//! infeasible. For semidefinite M, symmetric or not, and for P-matrices this proves as much as a positive c does
//! (`docs/theory/lemke.md`); for any other M a ray that proves nothing is followed by a solve from scratch.
//!
//! Lemke, Bimatrix equilibrium points and mathematical programming (1965); Eaves, The linear complementarity
//! problem (1971); Tomlin, Robust implementation of Lemke's method for the linear complementarity problem (1978);
//! Cottle, Pang and Stone, The Linear Complementarity Problem (1992), section 4.4.

mod equilibration;
mod inverse;
mod path;
mod start;
mod system;
#[cfg(test)]
mod tests;

use super::Method;
use crate::{
    counts::Counts,
    error::LcpError,
    interrupt::apart,
    matrix::SparseColumns,
    problem::Problem,
    reuse::{Start, StartError},
    settings::Settings,
    solution::{Solution, Status, residual},
};
use equilibration::Equilibration;
use faer::{Mat, linalg::solvers::Solve};
use path::{End, Path};
use start::Known;

/// Complementary pivoting with an artificial variable and the lexicographic rule.
///
/// Counts: `pivots` are exchanges, the first (`z0` in) and the last (`z0` out) among them; there are no
/// major and minor cycles. Where M is not symmetric, a start that is not a basic solution may be refused with
/// [`StartError::Dependent`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Lemke;

impl Method for Lemke {
    fn name(&self) -> &'static str {
        "lemke"
    }

    fn solve(&self, problem: &Problem, start: Option<&Start>, settings: &Settings) -> Result<Solution, LcpError> {
        let scaling = Equilibration::new(problem.m());
        let (m, q, unit) = scaling.apply(problem)?;
        let limit = settings.pivot_limit_for(problem.len());
        let mut counts = Counts::default();
        let mut attempt = |mut path: Path| {
            let end = path.follow(limit.saturating_sub(counts.pivots));
            counts.pivots += path.pivots;
            counts.refactorisations += path.refactorisations;
            Outcome { problem, settings, scaling: &scaling, m: &m, q: &q, unit, counts }.judge(&path, end)
        };
        if let Some(start) = start {
            let known = Known::new(problem, start, settings)?;
            let from = |active: Vec<usize>| Path::from_basis(&m, &q, settings, &active, known.order());
            let path = from(known.positive()).or_else(|| from(known.completed(&m)?)).or_else(|| from(known.reduced()?));
            let solution = attempt(path.ok_or(StartError::Dependent)?);
            if !matches!(solution.status, Status::RayTermination | Status::NumericalTrouble) {
                return Ok(solution);
            }
        }
        let [ones, uneven] = covering_vectors(problem.len());
        let solution = attempt(Path::new(&m, &q, settings, ones));
        let trouble = solution.status == Status::NumericalTrouble;
        Ok(if trouble { attempt(Path::new(&m, &q, settings, uneven)) } else { solution })
    }
}

/// All ones and, should rounding spoil that path, one without the ties that equal entries bring.
fn covering_vectors(n: usize) -> [Vec<f64>; 2] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    [vec![1.0; n], (1..=n).map(|i| 1.0 + (i as f64 * GOLDEN).fract()).collect()]
}

/// What a path ended with, judged in the caller's own units.
struct Outcome<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    scaling: &'a Equilibration,
    m: &'a SparseColumns,
    q: &'a [f64],
    unit: f64,
    counts: Counts,
}

impl Outcome<'_> {
    fn judge(&self, path: &Path, end: End) -> Solution {
        let reached = self.solution(self.unscale(&path.z(), self.unit));
        match end {
            // A ray met where z0 is zero already is a solution found too late.
            End::Ray(_) if reached.residual <= self.settings.residual => Solution { status: Status::Solved, ..reached },
            // Without a z part it is the ray on which the path began. Only a tie misjudged by rounding leads back there.
            End::Ray(ray) if ray.iter().all(|&y| y == 0.0) => reached,
            End::Ray(ray) => {
                let ray = self.unscale(&ray, 1.0);
                let status = if self.certifies(&ray) { Status::NoSolution } else { Status::RayTermination };
                Solution { status, ray: Some(ray), ..reached }
            }
            End::Limit => Solution { status: Status::PivotLimit, ..reached },
            End::LostAccuracy => reached,
            End::Complementary => {
                let polished = self.solution(self.unscale(&self.polish(&path.active()), self.unit));
                let best = if polished.residual <= reached.residual { polished } else { reached };
                let solved = best.residual <= self.settings.residual;
                Solution { status: if solved { Status::Solved } else { Status::NumericalTrouble }, ..best }
            }
        }
    }

    /// A pair with its residual, not solved until judged so.
    fn solution(&self, z: Vec<f64>) -> Solution {
        Solution {
            w: self.problem.w(&z),
            residual: residual(self.problem, &z),
            status: Status::NumericalTrouble,
            ray: None,
            counts: self.counts,
            z,
        }
    }

    fn unscale(&self, z: &[f64], unit: f64) -> Vec<f64> {
        z.iter().zip(&self.scaling.columns).map(|(z, c)| z * c * unit).collect()
    }

    /// Solves `M_CC z_C = -q_C` on the final active set C, with one step of iterative refinement.
    fn polish(&self, active: &[usize]) -> Vec<f64> {
        let k = active.len();
        let block = self.m.principal(active);
        let mut dense = Mat::zeros(k, k);
        for j in 0..k {
            let (rows, values) = block.column(j);
            for (&i, &value) in rows.iter().zip(values) {
                dense[(i, j)] = value;
            }
        }
        let right = Mat::from_fn(k, 1, |i, _| -self.q[active[i]]);
        let z_active = apart(k * k * k, move || {
            let lu = dense.partial_piv_lu();
            let mut z_active = lu.solve(&right);
            let correction = lu.solve(&right - &dense * &z_active);
            z_active += correction;
            z_active
        });
        let mut z = vec![0.0; self.q.len()];
        for (i, &j) in active.iter().enumerate() {
            z[j] = z_active[(i, 0)].max(0.0);
        }
        z
    }

    /// Whether `y >= 0`, `M' y <= 0` and `q' y < 0`, to the residual's tolerance in the equilibrated problem. Any feasible z
    /// would give `0 <= y' (M z + q) < 0`.
    fn certifies(&self, y: &[f64]) -> bool {
        let scaled: Vec<f64> = y.iter().zip(&self.scaling.rows).map(|(y, r)| y / r).collect();
        let size = scaled.iter().fold(0.0, |size: f64, y| size.max(y.abs()));
        let rise = (0..self.q.len()).map(|j| self.m.column_dot(j, &scaled)).fold(0.0, f64::max);
        let progress: f64 = scaled.iter().zip(self.q).map(|(y, q)| y * q).sum();
        size.is_finite() && rise <= self.settings.residual * size && progress < -self.settings.residual * size
    }
}
