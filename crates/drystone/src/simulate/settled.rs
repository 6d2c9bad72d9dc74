//! Steps in which nothing moves: the first is solved, and those after it are the same.

use super::{
    moving::{Moving, is_zero},
    reuse::Reuse,
    step::StepRecord,
    world::World,
};
use drystone_lcp::Counts;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// A step in which nothing moved.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub(super) struct Settled<S: Moving> {
    /// Velocities without contacts.
    free: Vec<S::Velocity>,
    /// Of the approaches. Another finder counts its revisions anew, so that approaches are compared one by one after a snapshot.
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

impl<S: Moving> World<S> {
    /// What the next step may be compared with: this one, if nothing moved in it.
    pub(super) fn settled(&self, free: Vec<S::Velocity>, record: &StepRecord) -> Option<Settled<S>> {
        let still = record.motionless.iter().all(|&still| still) && record.inconsistent.is_none();
        let bearing = match &self.stood {
            Some(stood) => stood.start.indices.len(),
            None => self.route.active_rows(),
        };
        (self.options.reuse == Reuse::Full && still && record.collisions == 0).then_some(Settled {
            free,
            revision: self.finder.revision,
            bearing,
            residual: record.residual,
            friction_error: record.friction_error,
            exact: record.exact,
        })
    }

    /// Makes the step before over again, if this is the same: nothing moves, and no body or push has come or gone.
    pub(super) fn stay(&mut self, free: &[S::Velocity], begun: Instant) -> Option<StepRecord> {
        let (settled, before) = self.settled.as_mut().zip(self.before.as_ref())?;
        if settled.free != free || !self.velocities.iter().all(is_zero) {
            return None;
        }
        if settled.revision != self.finder.revision {
            let given = before.approaches().iter().filter(|approach| !self.finder.is_open(&approach.id));
            if !self.finder.approaches().eq(given) {
                return None;
            }
            settled.revision = self.finder.revision;
        }
        self.forces.fill(S::Velocity::default());
        self.steps += 1;
        Some(StepRecord {
            motionless: self.motionless.clone(),
            counts: Counts::default(),
            solves: 0,
            rows: before.len(),
            rows_reused: settled.bearing,
            solve_time: Duration::ZERO,
            time: begun.elapsed(),
            residual: settled.residual,
            friction_error: settled.friction_error,
            exact: settled.exact,
            collisions: 0,
            inconsistent: None,
            penetration: self.finder.penetration(),
            projections: 0,
        })
    }
}
