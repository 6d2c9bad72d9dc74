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
    certificate::Scaled,
    counts::Counts,
    error::{LcpError, StartError},
    interrupt::apart,
    matrix::SparseColumns,
    problem::Problem,
    reuse::Start,
    scaling::Scaling,
    settings::Settings,
    solution::{Solution, Status, residual},
    solver::Solver,
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
        let mut attempts = Attempts::new(problem, settings, &scaling, &m, &q, unit);
        if let Some(start) = start {
            let known = Known::new(problem, start, settings)?;
            let from = |active: Vec<usize>| Path::from_basis(&m, &q, settings, &active, known.order());
            let path = from(known.positive()).or_else(|| from(known.completed(&m)?)).or_else(|| from(known.reduced()?));
            let ended = attempts.follow(path.ok_or(StartError::Dependent)?);
            // From a start a ray proves less than from scratch.
            if ended.is_sure && ended.solution.status != Status::RayTermination {
                return Ok(ended.solution);
            }
        }
        let Ended { solution, is_sure } = attempts.paths_from_zero();
        // For a symmetric M principal pivoting tells what a ray that proves nothing is worth.
        let is_final = is_sure && solution.status != Status::RayTermination;
        if is_final || settings.pivot_limit.is_some() || problem.require_symmetric().is_err() {
            return Ok(solution);
        }
        by_principal_pivoting(problem, settings, solution)
    }
}

/// Lemke's method alone, from scratch.
///
/// # Errors
/// [`LcpError::MatrixNotFinite`] if scaling makes an entry too large.
pub(crate) fn lemke_on(problem: &Problem, settings: &Settings) -> Result<Solution, LcpError> {
    let scaling = Equilibration::new(problem.m());
    let (m, q, unit) = scaling.apply(problem)?;
    Ok(Attempts::new(problem, settings, &scaling, &m, &q, unit).paths_from_zero().solution)
}

/// For a symmetric M with which rounding spoiled the path: the answer of principal pivoting, if it has one.
///
/// # Errors
/// [`LcpError::NotSemidefinite`] if that is why there is no answer.
fn by_principal_pivoting(problem: &Problem, settings: &Settings, unsure: Solution) -> Result<Solution, LcpError> {
    let mut solver = Solver::new(problem.clone(), settings.clone())?;
    solver.add_rows(&(0..problem.len()).collect::<Vec<_>>())?;
    let solution = match solver.solve() {
        Ok(status @ (Status::Solved | Status::NoSolution)) => solver.solution(status),
        // A z far out that may be a ray, and nobody can tell.
        Ok(status) if unsure.status == Status::Solved => solver.solution(status),
        Err(error) if matches!(unsure.status, Status::NumericalTrouble | Status::PivotLimit) => return Err(error),
        _ => return Ok(unsure),
    };
    Ok(Solution { counts: unsure.counts + solution.counts, ..solution })
}

/// Paths on one problem, the work of all of them added up.
struct Attempts<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    scaling: &'a Equilibration,
    m: &'a SparseColumns,
    q: &'a [f64],
    unit: f64,
    counts: Counts,
}

/// What a path ended with, and whether another path could tell more.
struct Ended {
    solution: Solution,
    is_sure: bool,
}

/// What counts as zero on a path that is followed because others were spoiled by rounding: a hundred times more than usual, still
/// less than what a solution may lack.
const COARSER: f64 = 100.0;

impl<'a> Attempts<'a> {
    fn new(
        problem: &'a Problem,
        settings: &'a Settings,
        scaling: &'a Equilibration,
        m: &'a SparseColumns,
        q: &'a [f64],
        unit: f64,
    ) -> Self {
        Self { problem, settings, scaling, m, q, unit, counts: Counts::default() }
    }

    /// Paths from `z = 0` until one is sure, or else the best of them.
    fn paths_from_zero(&mut self) -> Ended {
        let Settings { feasibility, pivot, .. } = *self.settings;
        let coarse = Settings { feasibility: COARSER * feasibility, pivot: COARSER * pivot, ..self.settings.clone() };
        let [ones, uneven] = covering_vectors(self.q.len());
        let mut best: Option<Solution> = None;
        for (cover, settings) in [(ones.clone(), self.settings), (uneven, self.settings), (ones, &coarse)] {
            let ended = self.follow(Path::new(self.m, self.q, settings, cover));
            if ended.is_sure {
                return ended;
            }
            if best.as_ref().is_none_or(|best| rank(ended.solution.status) < rank(best.status)) {
                best = Some(ended.solution);
            }
        }
        let solution = best.expect("there is more than one path");
        Ended { solution: Solution { counts: self.counts, ..solution }, is_sure: false }
    }

    fn follow(&mut self, mut path: Path) -> Ended {
        let limit = self.settings.pivot_limit_for(self.q.len());
        // A limit that nobody has set is one for each path.
        let left = if self.settings.pivot_limit.is_some() { limit.saturating_sub(self.counts.pivots) } else { limit };
        let end = path.follow(left);
        self.counts.pivots += path.pivots;
        self.counts.refactorisations += path.refactorisations;
        self.judge(&path, end)
    }
}

/// The order in which answers that are not sure are preferred.
fn rank(status: Status) -> usize {
    match status {
        Status::NoSolution => 0,
        Status::Solved => 1,
        Status::RayTermination => 2,
        _ => 3,
    }
}

/// All ones and, should rounding spoil that path, one without the ties that equal entries bring.
fn covering_vectors(n: usize) -> [Vec<f64>; 2] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    [vec![1.0; n], (1..=n).map(|i| 1.0 + (i as f64 * GOLDEN).fract()).collect()]
}

/// What a path ended with, judged in the caller's own units.
impl Attempts<'_> {
    fn judge(&self, path: &Path, end: End) -> Ended {
        let reached = self.solution(self.unscale(&path.z(), self.unit));
        let unsure = |status, solution| Ended { solution: Solution { status, ..solution }, is_sure: false };
        match end {
            End::Complementary => {
                let polished = self.solution(self.unscale(&self.polish(&path.active()), self.unit));
                let best = if polished.residual <= reached.residual { polished } else { reached };
                let solved = best.residual <= self.settings.residual;
                if solved { self.solved(best) } else { unsure(Status::NumericalTrouble, best) }
            }
            // A solution found too late, for instance a ray met where z0 is zero already.
            _ if reached.residual <= self.settings.residual => self.solved(reached),
            // Without a z part it is the ray on which the path began. Only a tie misjudged by rounding leads back there.
            End::Ray(ray) if ray.iter().all(|&y| y == 0.0) => unsure(Status::NumericalTrouble, reached),
            End::Ray(ray) => match self.certificate(&ray) {
                Some((y, is_sure)) => {
                    Ended { solution: Solution { status: Status::NoSolution, ray: Some(y), ..reached }, is_sure }
                }
                None => {
                    let is_sure = !self.on_certificates(&ray, |scaled, y| scaled.is_nearly(y));
                    let ray = Some(self.unscale(&ray, 1.0));
                    Ended { solution: Solution { status: Status::RayTermination, ray, ..reached }, is_sure }
                }
            },
            End::Limit => {
                let is_sure = self.settings.pivot_limit.is_some();
                Ended { solution: Solution { status: Status::PivotLimit, ..reached }, is_sure }
            }
            End::LostAccuracy => unsure(Status::NumericalTrouble, reached),
        }
    }

    /// A pair whose residual is small: solved, unless z is so much larger than q that it is a ray.
    fn solved(&self, pair: Solution) -> Ended {
        let is_far = Scaling::new(self.problem).is_far(&pair.z, pair.residual);
        if is_far {
            let ray: Vec<f64> = pair.z.iter().zip(&self.scaling.columns).map(|(z, c)| z / c).collect();
            if let Some((y, true)) = self.certificate(&ray) {
                return Ended {
                    solution: Solution { status: Status::NoSolution, ray: Some(y), ..pair },
                    is_sure: true,
                };
            }
        }
        Ended { solution: Solution { status: Status::Solved, ..pair }, is_sure: !is_far }
    }

    /// The certificate that a ray, equilibrated, is, in the caller's units, and whether it is a clear one.
    fn certificate(&self, ray: &[f64]) -> Option<(Vec<f64>, bool)> {
        let certificate = self.on_certificates(ray, |scaled, y| scaled.certificate(y))?;
        Some((certificate.y.iter().zip(&self.scaling.rows).map(|(y, r)| y * r).collect(), certificate.is_clear))
    }

    /// Asks something of a ray, whose z part is equilibrated by columns, as a certificate, which is by rows.
    fn on_certificates<T>(&self, ray: &[f64], ask: impl Fn(&Scaled, &[f64]) -> T) -> T {
        let weights = self.scaling.columns.iter().zip(&self.scaling.rows).map(|(c, r)| c / r);
        let y: Vec<f64> = ray.iter().zip(weights).map(|(y, weight)| y * weight).collect();
        let rows: Vec<usize> = (0..y.len()).collect();
        ask(&Scaled { m: self.m, q: self.q, rows: &rows }, &y)
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
}
