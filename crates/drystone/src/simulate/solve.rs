//! Solving a step: the contact problem again and again, until sliding contacts obey Coulomb's law.

use super::{
    acceleration_level::Inconsistent,
    error::StepFailure,
    friction::{FRICTION_ACCEPTED, FixedPoint, MOST_SOLVES, acceptable},
    moving::Moving,
    reuse::Situation,
    velocity_level::VelocityLevel,
    world::World,
};
use crate::{contact::approach::shift, geometry::Polygon};
use drystone_lcp::{Counts, LcpError, Status};
use std::time::{Duration, Instant};

/// A solved step.
pub struct Motion<S: Moving = Polygon> {
    pub velocities: Vec<S::Velocity>,
    /// Sliding speed at every approach, m/s.
    pub sliding: Vec<f64>,
    /// Impulse at every approach in world axes, N s.
    pub impulses: Vec<S::Vector>,
    /// Largest error of Coulomb's law, m/s.
    pub friction_error: f64,
    /// Whether that is within the tolerance.
    pub exact: bool,
    pub residual: f64,
    pub solves: usize,
    pub rows_reused: usize,
    pub time: Duration,
    /// Work besides the route's.
    pub counts: Counts,
    pub collisions: usize,
    pub inconsistent: Option<Inconsistent>,
}

impl<S: Moving> Motion<S> {
    /// Counts the work of an earlier solve of the same step.
    pub(super) fn add_earlier(&mut self, earlier: &Self) {
        self.solves += earlier.solves;
        self.counts = self.counts + earlier.counts;
        self.time += earlier.time;
    }
}

/// One solve for assumed sliding speeds.
struct Trial<S: Moving> {
    velocities: Vec<S::Velocity>,
    sliding: Vec<f64>,
    error: f64,
}

/// What stays the same in all solves of a step.
pub(super) struct Given<'a, S: Moving> {
    pub problem: &'a VelocityLevel<S>,
    pub free: &'a [S::Velocity],
    pub offsets: &'a [f64],
}

impl<S: Moving> World<S> {
    /// Solves by the route of choice; if that fails, from scratch with the solver's own tolerances.
    pub(super) fn solve(
        &mut self,
        problem: &VelocityLevel<S>,
        free: &[S::Velocity],
        offsets: &[f64],
    ) -> Result<Motion<S>, StepFailure> {
        let given = Given { problem, free, offsets };
        let mut work = Counts::default();
        if let Some(motion) = self.stand(&given, &mut work) {
            return Ok(motion);
        }
        if let Some(motion) = self.solve_on_round_cones(&given) {
            return Ok(Motion { counts: motion.counts + work, ..motion });
        }
        let answer = self.solve_coulomb(&given).or_else(|_| {
            self.route.restart();
            self.before = None;
            self.solve_coulomb(&given)
        });
        let motion = answer.map_err(|status| {
            self.forget();
            StepFailure::Unsolved { status: status.name() }
        })?;
        Ok(Motion { counts: motion.counts + work, ..motion })
    }

    /// Takes over what can be, then looks for the fixed point of the sliding speeds.
    fn solve_coulomb(&mut self, given: &Given<'_, S>) -> Result<Motion<S>, Status> {
        let mut time = Duration::ZERO;
        let mut assumed = self.carried_sliding(given.problem);
        let rows_reused = self.take_over(given, &assumed, &mut time)?;
        let speed = given.free.iter().fold(0.0, |fastest, v| shift::<S>(v).max(fastest));
        let mut point = FixedPoint::new();
        let mut best = (f64::INFINITY, Vec::new());
        let mut solves = 0;
        loop {
            let trial = self.try_sliding(given, &assumed, &mut time)?;
            solves += 1;
            if acceptable(trial.error, solves, speed) || solves > MOST_SOLVES {
                let exact = acceptable(trial.error, MOST_SOLVES, speed);
                return Ok(Motion { exact, ..self.motion(given.problem, trial, solves, rows_reused, time) });
            }
            if trial.error < best.0 {
                best = (trial.error, assumed.clone());
            }
            assumed = if solves == MOST_SOLVES {
                std::mem::take(&mut best.1)
            } else {
                point.next(&assumed, &trial.sliding, trial.error)
            };
        }
    }

    /// Sliding speeds of the step before at the contacts that are still there; speeds within the tolerance are none.
    fn carried_sliding(&self, problem: &VelocityLevel<S>) -> Vec<f64> {
        let Some(before) = &self.before else { return vec![0.0; problem.approaches().len()] };
        let speeds = problem.matches(before).map(|(_, old)| old.map_or(0.0, |old| self.sliding[old]));
        speeds.map(|s| if s > FRICTION_ACCEPTED { s } else { 0.0 }).collect()
    }

    /// Hands the matrix to the route unless it has it. Returns the rows that come with their factor.
    fn take_over(&mut self, given: &Given<'_, S>, assumed: &[f64], time: &mut Duration) -> Result<usize, Status> {
        let problem = given.problem;
        self.take_up_stood().map_err(trouble)?;
        let situation = Situation { problem, before: self.before.as_ref(), motionless: &self.motionless };
        if self.route.has_matrix(&situation) {
            return Ok(self.route.solver().active_rows());
        }
        let q = problem.q(given.free, given.offsets, assumed);
        let matrix = match self.before.as_ref().zip(self.route.last()) {
            Some(before) => problem.problem_after(before, &self.inverse_mass, q),
            None => problem.problem(&self.inverse_mass, q),
        };
        let matrix = matrix.map_err(trouble)?;
        let begun = Instant::now();
        if self.before.is_none()
            && let Some(start) = self.start_from_interior(given, assumed)
            && self.route.begin_from(matrix.clone(), &start).is_ok()
        {
            *time += begun.elapsed();
            return Ok(0);
        }
        let rows_reused = self.route.begin(&situation, matrix).map_err(trouble);
        *time += begun.elapsed();
        rows_reused
    }

    fn try_sliding(&mut self, given: &Given<'_, S>, assumed: &[f64], time: &mut Duration) -> Result<Trial<S>, Status> {
        let q = given.problem.q(given.free, given.offsets, assumed);
        let begun = Instant::now();
        let status = self.route.solve(&q);
        *time += begun.elapsed();
        match status.map_err(trouble)? {
            Status::Solved => {}
            status => return Err(status),
        }
        let solver = self.route.solver();
        let velocities = given.problem.velocities(given.free, &self.inverse_mass, |row| solver.z(row));
        let (sliding, error) = judge(given, &velocities, assumed, |row| solver.z(row));
        Ok(Trial { velocities, sliding, error })
    }

    fn motion(
        &self,
        problem: &VelocityLevel<S>,
        trial: Trial<S>,
        solves: usize,
        rows_reused: usize,
        time: Duration,
    ) -> Motion<S> {
        let solver = self.route.solver();
        let impulse = |k: usize| problem.impulse(k, |row| solver.z(row));
        let Trial { velocities, sliding, error } = trial;
        Motion {
            velocities,
            sliding,
            impulses: (0..problem.approaches().len()).map(impulse).collect(),
            friction_error: error,
            exact: false,
            residual: solver.residual(),
            solves,
            rows_reused,
            time,
            counts: Counts::default(),
            collisions: 0,
            inconsistent: None,
        }
    }
}

/// The matrix of a step is symmetric and semidefinite by its making; where it does not look so, accuracy is lost.
fn trouble(_: LcpError) -> Status {
    Status::NumericalTrouble
}

/// The sliding speeds found, and the largest error of Coulomb's law: where a contact bears, the speed at which it parts;
/// where it does not, the speed at which it closes beyond its gap.
pub(super) fn judge<S: Moving>(
    given: &Given<'_, S>,
    velocities: &[S::Velocity],
    assumed: &[f64],
    p: impl Fn(usize) -> f64,
) -> (Vec<f64>, f64) {
    let mut worst = 0.0_f64;
    let mut sliding = Vec::with_capacity(assumed.len());
    for (k, (assumed, offset)) in assumed.iter().zip(given.offsets).enumerate() {
        let [opening, speed] = given.problem.opening_and_sliding(k, velocities);
        let bears = given.problem.rows(k).any(|row| p(row) > 0.0);
        worst = worst.max(match given.problem.friction(k) {
            0.0 => 0.0,
            friction if bears => friction * (speed - assumed).abs(),
            _ => -(opening + offset),
        });
        sliding.push(speed);
    }
    (sliding, worst)
}
