//! One time step: contacts, formulate, solve, find motionless, integrate.

use super::{
    contacts,
    error::StepFailure,
    formulate::{contact_problem::ContactProblem, free_motion::free_velocities},
    integrate::integrate,
    kinematics::Kinematics,
    motionless::motionless_in_step,
    moving::Moving,
    record::StepRecord,
    settled::Settled,
    solve::{Effort, Motion},
    state::State,
    world::World,
};
use crate::{
    bounds::{COORDINATE, VELOCITY},
    interrupt::or_else,
    scene::Body,
};
use std::time::Instant;

/// Shorter steps that one is made in at most: what turns by more radians in a step near another is refused.
const MOST_SUBSTEPS: usize = 1000;

impl<S: Moving> World<S> {
    /// Makes one step; in several shorter ones where a body turns by more than a radian in it near another.
    ///
    /// # Errors
    /// [`StepFailure`]; the bodies are as they were before then. So they are after a step that is stopped on the way
    /// ([`interrupt`](crate::interrupt)), and the next one takes nothing over.
    pub fn step(&mut self) -> Result<StepRecord, StepFailure> {
        let made = or_else(self, Self::in_one_or_several, Self::forget);
        match &made {
            Ok(record) => {
                self.steps += 1;
                self.previous.substeps = record.substeps;
            }
            // The solver may hold this step's problem already, of which the next one knows nothing.
            Err(_) => self.forget(),
        }
        made
    }

    fn in_one_or_several(&mut self) -> Result<StepRecord, StepFailure> {
        match self.attempt() {
            Err(StepFailure::TooFast { body, other, dt }) => {
                self.in_several(StepFailure::TooFast { body, other, dt }, dt)
            }
            made => made,
        }
    }

    /// Makes the step in equal shorter ones of at most `longest` seconds; in still shorter ones from where a body turns faster on.
    fn in_several(&mut self, refused: StepFailure, longest: f64) -> Result<StepRecord, StepFailure> {
        let dt = self.state.options.dt;
        let begin = self.state.clone();
        let mended = begin.clone();
        let made = or_else(self, |world| world.parts(refused, longest), |world| world.state = mended);
        self.state.options.dt = dt;
        match &made {
            Ok(record) => self.state.motionless.clone_from(&record.motionless),
            Err(_) => self.state = begin,
        }
        made
    }

    fn parts(&mut self, mut refused: StepFailure, mut longest: f64) -> Result<StepRecord, StepFailure> {
        let forces = self.state.forces.clone();
        let mut seconds = self.state.options.dt;
        let (mut left, mut made): (usize, Option<StepRecord>) = (1, None);
        loop {
            left = ((seconds / longest).ceil() as usize).max(left + 1);
            if left + made.as_ref().map_or(0, |made| made.substeps) > MOST_SUBSTEPS {
                return Err(refused);
            }
            self.state.options.dt = seconds / left as f64;
            loop {
                self.state.forces.clone_from(&forces);
                match self.attempt() {
                    Ok(record) => {
                        seconds -= self.state.options.dt;
                        left -= 1;
                        let record = match made.take() {
                            Some(before) => before.then(record),
                            None => record,
                        };
                        if left == 0 {
                            return Ok(record);
                        }
                        made = Some(record);
                    }
                    Err(StepFailure::TooFast { body, other, dt }) => {
                        (refused, longest) = (StepFailure::TooFast { body, other, dt }, dt);
                        break;
                    }
                    Err(failure) => return Err(failure),
                }
            }
        }
    }

    fn attempt(&mut self) -> Result<StepRecord, StepFailure> {
        let begun = Instant::now();
        let spent = self.previous.solver.counts();
        let free = free_velocities(&self.state);

        contacts::find_for_step(&mut self.finder, &self.state, &free)?;
        if let Some(record) = self.stay(&free, begun) {
            return Ok(record);
        }
        let (problem, motion) = self.solve(&free)?;
        refuse_out_of_bounds(&self.state, &motion.velocities)?;
        let motionless = motionless_in_step(&self.state, &problem, &motion.velocities, motion.unseen);
        let projected = integrate(&mut self.state, &mut self.finder, motion.velocities, motionless);

        self.previous.impulses = motion.impulses;
        self.previous.sliding = sliding_of_moving(&problem, motion.sliding, &self.state.motionless);
        let record = StepRecord {
            motionless: self.state.motionless.clone(),
            counts: self.previous.solver.counts() - spent + motion.counts + projected.counts,
            solves: motion.solves,
            rows: problem.len(),
            rows_reused: motion.rows_reused,
            solve_time: motion.time,
            time: begun.elapsed(),
            residual: motion.residual,
            friction_error: motion.friction_error,
            exact: motion.exact,
            collisions: motion.collisions,
            inconsistent: motion.inconsistent,
            penetration: self.finder.penetration(),
            projections: projected.rounds,
            substeps: 1,
        };
        self.previous.problem = Some(problem);
        self.settled = Settled::of(&self.state, &self.previous, &self.finder, free, &record);
        Ok(record)
    }

    /// Makes the step before over again, if this is the same.
    fn stay(&mut self, free: &[S::Velocity], begun: Instant) -> Option<StepRecord> {
        let settled = self.settled.as_mut()?;
        let record = settled.again(&self.state, &self.previous, &self.finder, free, begun)?;
        self.state.forces.fill(S::Velocity::default());
        Some(record)
    }

    /// Formulates and solves the step; again where bodies then meet of which nothing was before a face of the other. Mostly that is the end of
    /// it. From the second time on the step is solved only nearly, until nobody meets any more; and with the full effort only then.
    fn solve(&mut self, free: &[S::Velocity]) -> Result<(ContactProblem<S>, Motion<S>), StepFailure> {
        let Self { state, previous, finder, law, .. } = self;
        let (options, gravity) = (state.options, state.scene.gravity());
        let mut problem = previous.formulate(finder.candidates().copied().collect(), &options, gravity);
        let mut motion = law.motion(state, previous, &problem, free, Effort::Soon)?;
        let (mut rounds, mut nearly) = (0, false);
        loop {
            let more = contacts::met(finder, state, problem.candidates(), &motion.velocities);
            if more.is_empty() && !nearly && !motion.unfinished {
                return Ok((problem, motion));
            }
            previous.take(&problem, &motion);
            rounds += 1;
            if !more.is_empty() {
                let mut all = [problem.candidates(), &more].concat();
                all.sort_by_key(|candidate| candidate.id);
                problem = previous.formulate(all, &options, gravity);
            }
            let looks_on = rounds > 1 && !more.is_empty();
            let near = if looks_on { law.nearly(state, previous, &problem, free) } else { None };
            nearly = near.is_some();
            let effort = if more.is_empty() && !nearly { Effort::Full } else { Effort::Soon };
            let next = near.map_or_else(|| law.motion(state, previous, &problem, free, effort), Ok)?;
            let earlier = std::mem::replace(&mut motion, next);
            motion.add_earlier(&earlier);
        }
    }
}

/// # Errors
/// [`StepFailure::OutOfBounds`].
fn refuse_out_of_bounds<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity]) -> Result<(), StepFailure> {
    let dt = state.options.dt;
    let wild = |(body, velocity): (&Body<S>, &S::Velocity)| {
        let (place, velocity) = (S::place(&body.pose), velocity.as_ref());
        let mut arrival = place.as_ref().iter().zip(velocity).map(|(x, v)| x + dt * v);
        !velocity.iter().all(|&v| VELOCITY.hold(v)) || !arrival.all(|x| COORDINATE.hold(x))
    };
    match state.scene.bodies().iter().zip(velocities).position(wild) {
        Some(i) => Err(StepFailure::OutOfBounds { body: state.scene.bodies()[i].name.clone() }),
        None => Ok(()),
    }
}

/// The sliding speeds to begin the next step with: none between bodies that stand still.
fn sliding_of_moving<S: Kinematics>(
    problem: &ContactProblem<S>,
    mut sliding: Vec<f64>,
    motionless: &[bool],
) -> Vec<f64> {
    for (candidate, s) in problem.candidates().iter().zip(&mut sliding) {
        if candidate.id.bodies.iter().all(|&body| motionless[body]) {
            *s = 0.0;
        }
    }
    sliding
}
