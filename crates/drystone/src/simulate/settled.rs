//! Steps in which nothing moves: the first is solved, and those after it are the same.

use super::{kinematics::Kinematics, options::Reuse, record::StepRecord, solve::PreviousStep, state::State};
use crate::contact::candidates::CandidateFinder;
use drystone_lcp::Counts;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// A step in which nothing moved.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Settled<S: Kinematics> {
    /// Velocities without contacts.
    free: Vec<S::Velocity>,
    /// Of the contacts. Another finder counts its revisions anew, so that contacts are compared one by one after a snapshot.
    #[serde(skip, default = "of_another_finder")]
    revision: u64,
    /// Rows that bear.
    bearing: usize,
    residual: f64,
    friction_error: f64,
    exact: bool,
}

fn of_another_finder() -> u64 {
    u64::MAX
}

impl<S: Kinematics> Settled<S> {
    /// What the next step may be compared with: this one, if nothing moved in it. `free` were the velocities without contacts.
    pub fn of(
        state: &State<S>,
        previous: &PreviousStep<S>,
        finder: &CandidateFinder<S>,
        free: Vec<S::Velocity>,
        record: &StepRecord,
    ) -> Option<Self> {
        let still = record.motionless.iter().all(|&still| still) && record.inconsistent.is_none();
        let bearing = match &previous.at_rest {
            Some(solution) => solution.start.indices.len(),
            None => previous.solver.active_rows(),
        };
        (state.options.reuse == Reuse::Full && still && record.collisions == 0).then_some(Self {
            free,
            revision: finder.revision,
            bearing,
            residual: record.residual,
            friction_error: record.friction_error,
            exact: record.exact,
        })
    }

    /// The record of the step before over again, if this is the same: nothing moves, and no body or push has come or gone.
    pub fn again(
        &mut self,
        state: &State<S>,
        previous: &PreviousStep<S>,
        finder: &CandidateFinder<S>,
        free: &[S::Velocity],
        begun: Instant,
    ) -> Option<StepRecord> {
        let before = previous.problem.as_ref()?;
        if self.free != free || !state.is_at_rest() {
            return None;
        }
        if self.revision != finder.revision {
            let given = before.candidates().iter().filter(|candidate| !finder.is_open(&candidate.id));
            if !finder.candidates().eq(given) {
                return None;
            }
            self.revision = finder.revision;
        }
        Some(StepRecord {
            motionless: state.motionless.clone(),
            counts: Counts::default(),
            solves: 0,
            rows: before.len(),
            rows_reused: self.bearing,
            solve_time: Duration::ZERO,
            time: begun.elapsed(),
            residual: self.residual,
            friction_error: self.friction_error,
            exact: self.exact,
            collisions: 0,
            inconsistent: None,
            penetration: finder.penetration(),
            projections: 0,
            substeps: 1,
        })
    }
}
