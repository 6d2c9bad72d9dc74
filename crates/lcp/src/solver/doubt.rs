//! Where rounding decides: what an end other than "solved" is worth, and further attempts.
//!
//! The first attempt takes as zero what is rounding in M's last digits. A matrix that was written with few digits, or that
//! lost them on the way, has more noise than that; rows that depend on others then seem not to, and z becomes noise. Further
//! attempts take more for zero. Whatever an attempt does, its answer is judged by its residual and by the one rule for
//! certificates (`certificate.rs`), so that no attempt can make an answer wrong.

use super::{
    Solver,
    attempt::{FINE_CURVATURE, Repair, Zero},
    largest,
};
use crate::{
    certificate::Scaled, error::LcpError, interrupt::apart, pivot::lemke_on, problem::Problem, scaling::is_far,
    solution::Status,
};
use faer::{Mat, Side, linalg::solvers::SelfAdjointEigen};

/// What a row may lack in a coarser attempt: a fifth of what a solution may.
const COARSE_FEASIBILITY: f64 = 0.2;
/// What remains violated beside q in a z far out that counts when there is no other answer: no certificate speaks against it
/// (`settings::PROGRESS`, ten times).
const LITTLE: f64 = 1e-6;
/// Rows up to which dense matrices are worth their n^3 operations.
pub(super) const LARGEST_DENSE: usize = 600;
/// An eigenvalue of at most this (unit diagonal) for each row is rounding.
pub(super) const EIGENVALUE_ROUNDING: f64 = 1e-15;

impl Solver {
    pub(super) fn repair(&mut self, repair: Repair) {
        self.zero = Zero::of(&self.settings);
        match repair {
            Repair::Refactor => return self.refactor(),
            Repair::Restart => {}
            Repair::Finer => (self.zero.singular, self.zero.curvature) = (0.0, FINE_CURVATURE),
            Repair::Coarser(curvature) => {
                self.zero.feasibility = COARSE_FEASIBILITY * self.settings.residual;
                (self.zero.curvature, self.zero.goes_out) = (curvature, true);
            }
        }
        self.restart();
    }

    /// The answer, if the state with which an attempt ended is one all the same. Nothing moves.
    pub(super) fn late_answer(&mut self) -> Option<Status> {
        self.residual = self.present_residual();
        let signs = self.z.iter().all(|&z| z >= 0.0);
        (signs && self.residual <= self.settings.residual).then(|| self.conclude(false)).flatten()
    }

    /// The status of a state whose residual is small. In its own scale it is small along every ray, too, far enough out: then
    /// z must not be a ray, and no row may be violated by more than rounding, which `is_feasible` says where rows were driven
    /// that far.
    pub(super) fn conclude(&mut self, is_feasible: bool) -> Option<Status> {
        let z_size = largest(&self.z, &self.rows());
        if (self.zero.beside_q && is_feasible) || !is_far(z_size, self.q_size, self.residual) {
            return Some(Status::Solved);
        }
        let z = self.z.clone();
        if self.take_certificate(&z) || self.certify_in_null_space().unwrap_or(false) {
            return Some(Status::NoSolution);
        }
        if self.residual * z_size <= LITTLE * self.q_size {
            self.doubtful.far = Some(z);
        }
        None
    }

    /// Keeps the certificate that a ray (n, scaled) is. True if it is a clear one.
    pub(super) fn take_certificate(&mut self, ray: &[f64]) -> bool {
        let rows = self.rows();
        let scaled = Scaled { m: &self.m, q: &self.load.scaled, rows: &rows };
        let Some(certificate) = scaled.certificate(ray) else { return false };
        let y = certificate.y.iter().zip(&self.scaling.d).map(|(y, d)| y * d).collect();
        *(if certificate.is_clear { &mut self.ray } else { &mut self.doubtful.ray }) = Some(y);
        certificate.is_clear
    }

    /// No attempt had an answer. Lemke's method may have one; else it is what was doubtful, or M has a negative eigenvalue, or there
    /// is a certificate that no pivot meets.
    ///
    /// # Errors
    /// [`LcpError::NotSemidefinite`].
    pub(super) fn last_resort(&mut self) -> Result<Status, LcpError> {
        let rows = self.rows();
        let dense = rows.len() <= LARGEST_DENSE;
        // Lemke's pivots would be beyond a limit that somebody has set.
        if dense
            && self.settings.pivot_limit.is_none()
            && let Some(status) = self.ask_lemke(&rows)?
        {
            return Ok(status);
        }
        if self.doubtful.ray.is_some() {
            self.ray = self.doubtful.ray.take();
            return Ok(Status::NoSolution);
        }
        if let Some(z) = self.doubtful.far.take() {
            self.take_values(&z);
            return Ok(Status::Solved);
        }
        if !dense {
            return Ok(Status::NumericalTrouble);
        }
        self.require_no_negative_eigenvalue(&rows)?;
        if self.settings.pivot_limit.is_some() {
            return Ok(Status::NumericalTrouble);
        }
        if !self.certify_by_simplex(&rows)? {
            self.ray = self.doubtful.ray.take();
        }
        Ok(if self.ray.is_some() { Status::NoSolution } else { Status::NumericalTrouble })
    }

    /// The pivots have come to an end. If it was not the caller who set it, rounding led them in circles, and there may be an answer all the same.
    ///
    /// # Errors
    /// [`LcpError::NotSemidefinite`].
    pub(super) fn beyond_the_limit(&mut self) -> Result<Status, LcpError> {
        if self.settings.pivot_limit.is_some() {
            return Ok(Status::PivotLimit);
        }
        Ok(match self.last_resort()? {
            Status::NumericalTrouble => Status::PivotLimit,
            answer => answer,
        })
    }

    fn ask_lemke(&mut self, rows: &[usize]) -> Result<Option<Status>, LcpError> {
        let q = rows.iter().map(|&i| self.load.scaled[i]).collect();
        let part = Problem::new(self.m.principal(rows), q)?;
        let found = lemke_on(&part, &self.settings)?;
        self.counts.pivots += found.counts.pivots;
        let mut values = vec![0.0; self.z.len()];
        match found.status {
            Status::NoSolution => {
                rows.iter().zip(found.ray.iter().flatten()).for_each(|(&i, &y)| values[i] = y);
                Ok(self.take_certificate(&values).then_some(Status::NoSolution))
            }
            Status::Solved => {
                rows.iter().zip(&found.z).for_each(|(&i, &z)| values[i] = z);
                self.take_values(&values);
                let solved = self.residual <= self.settings.residual;
                Ok(if solved { self.conclude(false) } else { None })
            }
            _ => Ok(None),
        }
    }

    /// Takes a scaled z that pivots did not lead to. The next solve begins with it anew.
    fn take_values(&mut self, z: &[f64]) {
        self.restart();
        self.z.copy_from_slice(z);
        self.settled = false;
        self.residual = self.present_residual();
    }

    /// Eigenvalues, ascending, and eigenvectors of the rows present.
    pub(super) fn eigen(&self, rows: &[usize]) -> Option<SelfAdjointEigen<f64>> {
        let n = rows.len();
        let block = Mat::from_fn(n, n, |i, j| self.m.get(rows[i], rows[j]));
        apart(10 * n * n * n, move || block.self_adjoint_eigen(Side::Lower)).ok()
    }

    fn require_no_negative_eigenvalue(&self, rows: &[usize]) -> Result<(), LcpError> {
        let Some(eigen) = self.eigen(rows) else { return Ok(()) };
        // In ascending order.
        let (Some(&eigenvalue), vector) = (eigen.S().column_vector().iter().next(), eigen.U().col(0)) else {
            return Ok(());
        };
        let largest = (0..rows.len()).max_by(|&a, &b| vector[a].abs().total_cmp(&vector[b].abs()));
        match largest {
            Some(k) if eigenvalue < -EIGENVALUE_ROUNDING * rows.len() as f64 => {
                Err(LcpError::NotSemidefinite { index: rows[k], eigenvalue })
            }
            _ => Ok(()),
        }
    }
}
