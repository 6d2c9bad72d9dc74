//! What is recorded of a step.

use crate::contact::ContactId;
use drystone_lcp::Counts;
use std::time::Duration;

/// What one step did.
#[derive(Debug, Clone, PartialEq)]
pub struct StepRecord {
    /// Whether each body kept its place; fixed ones do.
    pub motionless: Vec<bool>,
    /// Pivots of all solves of the step; major and minor cycles.
    pub counts: Counts,
    /// Solves: the first one, and those that make Coulomb's law exact. None where the step is that before it over again.
    pub solves: usize,
    /// Rows of the step's problem.
    pub rows: usize,
    /// Active rows that came from the step before with their part of the factor.
    pub rows_reused: usize,
    /// Wall time of the solves, with the analysis and the factor of the matrix, without making it.
    pub solve_time: Duration,
    /// Wall time of the whole step.
    pub time: Duration,
    /// Residual of the last solve, in the problem's own scale.
    pub residual: f64,
    /// Largest speed, m/s, at which a contact that bears parts or closes against Coulomb's law: what is left of the fixed
    /// point's iteration, at most [`FRICTION_ACCEPTED`](super::FRICTION_ACCEPTED), relative above 1 m/s, unless it did not converge.
    pub friction_error: f64,
    /// Whether that is within what is asked for: the share
    /// [`coulomb_tolerance`](super::Options::coulomb_tolerance) of the fastest contact's speed or of what gravity gives in a step, where
    /// pivots solve it at least [`FRICTION_ACCEPTED`](super::FRICTION_ACCEPTED). Where it is not, the step was made with the best that was
    /// found.
    pub exact: bool,
    /// Contacts at which bodies collided, so that impulses came before the forces; acceleration level only.
    pub collisions: usize,
    /// Where no forces were found, so that impulses took their place; acceleration level only.
    pub inconsistent: Option<Inconsistent>,
    /// Deepest overlap at the end of the step, metres.
    pub penetration: f64,
    /// Times overlaps were taken back; their pivots are among the step's.
    pub projections: usize,
    /// Steps that it was made in: more than one where a body turned by more than a radian near another.
    pub substeps: usize,
}

impl StepRecord {
    /// This and the next part of the same step as one.
    pub(super) fn then(self, next: Self) -> Self {
        Self {
            motionless: self.motionless.iter().zip(&next.motionless).map(|(a, b)| *a && *b).collect(),
            counts: self.counts + next.counts,
            solves: self.solves + next.solves,
            rows_reused: self.rows_reused + next.rows_reused,
            solve_time: self.solve_time + next.solve_time,
            time: self.time + next.time,
            residual: self.residual.max(next.residual),
            friction_error: self.friction_error.max(next.friction_error),
            exact: self.exact && next.exact,
            collisions: self.collisions + next.collisions,
            inconsistent: self.inconsistent.or(next.inconsistent),
            projections: self.projections + next.projections,
            substeps: self.substeps + next.substeps,
            ..next
        }
    }
}

/// A contact at which no forces obey the conditions, so that the step went by impulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inconsistent {
    /// Which corner and which face.
    pub contact: ContactId,
    /// How the solve ended: "no_solution" is proved; after another word there may be forces that were not found.
    pub status: &'static str,
}
