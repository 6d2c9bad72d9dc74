//! One time step: contacts, formulate, solve, find motionless, integrate.

use super::{
    acceleration_level::Inconsistent,
    error::StepFailure,
    integrate::advance,
    motionless::motionless_bodies,
    moving::{Moving, add, is_zero, permanent, split_mut},
    project::{ROUNDS, shift, way_out},
    reuse::Reuse,
    solve::Motion,
    velocity_level::VelocityLevel,
    world::World,
};
use crate::{
    bounds::{COORDINATE, VELOCITY},
    contact::{
        approach::{ApproachOf, MOST_TURN, turn},
        pair_tolerance,
    },
    geometry::norm,
    interrupt::or_else,
    scene::Body,
};
use drystone_lcp::Counts;
use std::time::{Duration, Instant};

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
    /// Whether that is within what is asked for: 1e-8 of the fastest contact's speed and of what gravity gives in a step on round cones,
    /// [`FRICTION_ACCEPTED`](super::FRICTION_ACCEPTED) on pyramids and in the plane. Where it is not, the step was made with the best that was found.
    pub exact: bool,
    /// Contacts at which bodies collided, so that impulses came before the forces; acceleration level only.
    pub collisions: usize,
    /// Where no forces were found, so that impulses took their place; acceleration level only.
    pub inconsistent: Option<Inconsistent>,
    /// Deepest overlap at the end of the step, metres.
    pub penetration: f64,
    /// Times overlaps were taken back; their pivots are among the step's.
    pub projections: usize,
}

/// Impacts slower than what gravity gives in this many steps do not rebound: they are contacts that rest.
const RESTING_STEPS: f64 = 4.0;

impl<S: Moving> World<S> {
    /// Makes one step.
    ///
    /// # Errors
    /// [`StepFailure`]; the bodies are as they were before then. So they are after a step that is stopped on the way
    /// ([`interrupt`](crate::interrupt)), and the next one takes nothing over.
    pub fn step(&mut self) -> Result<StepRecord, StepFailure> {
        let made = or_else(self, Self::attempt, Self::forget);
        if made.is_err() {
            // The solver may hold this step's problem already, of which the next one knows nothing.
            self.forget();
        }
        made
    }

    fn attempt(&mut self) -> Result<StepRecord, StepFailure> {
        let begun = Instant::now();
        let spent = self.route.counts();
        let free = self.free_velocities();

        self.look(&free)?;
        if let Some(record) = self.stay(&free, begun) {
            return Ok(record);
        }
        let (problem, motion) = self.move_on(&free)?;
        let motionless = self.find_motionless(&motion)?;
        let projected = self.integrate(motion.velocities, motionless);

        self.impulses = motion.impulses;
        self.sliding = self.sliding_of(&problem, motion.sliding);
        self.steps += 1;
        let record = StepRecord {
            motionless: self.motionless.clone(),
            counts: self.route.counts() - spent + motion.counts + projected.counts,
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
        };
        self.before = Some(problem);
        self.settled = self.settled(free, &record);
        Ok(record)
    }

    /// `v* = v + h M^-1 F`: what the velocities would be without contacts.
    fn free_velocities(&self) -> Vec<S::Velocity> {
        self.free_from(&self.velocities)
    }

    /// The same from other velocities.
    pub(super) fn free_from(&self, velocities: &[S::Velocity]) -> Vec<S::Velocity> {
        let (gravity, dt) = (self.scene.gravity(), self.options.dt);
        let free = |i: usize| {
            let (inverse, force) = (&self.inverse_mass[i], self.wrench_on(i));
            if is_zero(inverse) {
                return velocities[i];
            }
            let mut free = S::undisturbed(&self.scene.bodies()[i], &velocities[i], dt);
            let pushed = inverse.as_ref().iter().zip(force.as_ref()).map(|(inverse, f)| inverse * f);
            let mut fall = S::Velocity::default();
            split_mut::<S>(&mut fall).0.copy_from_slice(gravity.as_ref());
            let gains = fall.as_ref().iter().zip(pushed);
            free.as_mut().iter_mut().zip(gains).for_each(|(v, (fall, pushed))| *v += dt * (fall + pushed));
            free
        };
        (0..velocities.len()).map(free).collect()
    }

    /// Pushes of the step and permanent loads on a body, about its own axes.
    fn wrench_on(&self, i: usize) -> S::Velocity {
        let body = &self.scene.bodies()[i];
        let mut total = self.forces[i];
        if !body.loads().is_empty() {
            add(&mut total, &permanent::<S>(body));
        }
        total
    }

    /// Solves the step; again where bodies then meet of which nothing was before a face of the other.
    fn move_on(&mut self, free: &[S::Velocity]) -> Result<(VelocityLevel<S>, Motion<S>), StepFailure> {
        let mut problem = self.problem_of(self.finder.approaches().copied().collect());
        let mut motion = self.law.motion(self, &problem, free)?;
        loop {
            let more = self.met(&problem, &motion);
            if more.is_empty() {
                return Ok((problem, motion));
            }
            let mut approaches = [problem.approaches(), &more].concat();
            approaches.sort_by_key(|approach| approach.id);
            let next = self.problem_of(approaches);
            self.sliding.clone_from(&motion.sliding);
            self.impulses.clone_from(&motion.impulses);
            self.before = Some(std::mem::replace(&mut problem, next));
            let earlier = std::mem::replace(&mut motion, self.law.motion(self, &problem, free)?);
            motion.add_earlier(&earlier);
        }
    }

    /// Where bodies meet that move so, beside what the problem knows. Nobody meets twice in a step, so this ends.
    fn met(&self, problem: &VelocityLevel<S>, motion: &Motion<S>) -> Vec<ApproachOf<S>> {
        let pair = |approach: &ApproachOf<S>| {
            let id = approach.id;
            (id.bodies, id.pieces(), id.feature.at_borders())
        };
        let known = |approach: &ApproachOf<S>| problem.approaches().iter().any(|known| pair(known) == pair(approach));
        let mut met = self.finder.met(&self.scene, &self.ways(&motion.velocities), |i| is_zero(&self.velocities[i]));
        met.retain(|approach| !known(approach));
        met
    }

    /// Finds every approach that may close within the step.
    fn look(&mut self, free: &[S::Velocity]) -> Result<(), StepFailure> {
        if self.options.reuse != Reuse::Full {
            self.finder.clear();
        }
        self.find_approaches(free);
        if let Some((body, pair)) = self.finder.whirling() {
            return Err(self.too_fast(body, pair, free));
        }
        Ok(())
    }

    /// The rows of some approaches.
    pub(super) fn problem_of(&self, approaches: Vec<ApproachOf<S>>) -> VelocityLevel<S> {
        VelocityLevel::after(self.before.as_ref(), approaches, self.options.cones, self.scene.gravity())
    }

    fn find_approaches(&mut self, free: &[S::Velocity]) {
        let travel = self.ways(free);
        self.finder.find(&self.scene, &travel);
    }

    /// How far bodies go in a step.
    fn ways(&self, velocities: &[S::Velocity]) -> Vec<S::Velocity> {
        let way = |velocity: &S::Velocity| {
            let mut way = *velocity;
            way.as_mut().iter_mut().for_each(|x| *x *= self.options.dt);
            way
        };
        velocities.iter().map(way).collect()
    }

    fn too_fast(&self, body: usize, [a, b]: [usize; 2], free: &[S::Velocity]) -> StepFailure {
        let name = |i: usize| self.scene.bodies()[i].name.clone();
        let other = if body == a { b } else { a };
        StepFailure::TooFast { body: name(body), other: name(other), dt: MOST_TURN / turn::<S>(&free[body]) }
    }

    /// The offset of an approach at which bodies collide and part again, m/s: `e u_n`. None where they do not.
    pub(super) fn rebound(&self, contacts: &VelocityLevel<S>, approach: usize, free: &[S::Velocity]) -> Option<f64> {
        let (dt, restitution) = (self.options.dt, self.options.restitution);
        let [arriving, _] = contacts.opening_and_sliding(approach, &self.velocities);
        let [free, _] = contacts.opening_and_sliding(approach, free);
        let gap = contacts.approaches()[approach].gap.max(0.0);
        let collides = arriving < -self.resting_speed() && gap + dt * free <= 0.0;
        (restitution > 0.0 && collides).then_some(restitution * arriving)
    }

    /// Contacts that close more slowly rest, m/s.
    pub(super) fn resting_speed(&self) -> f64 {
        RESTING_STEPS * self.options.dt * norm(self.scene.gravity().as_ref())
    }

    /// The motionless set of the step.
    fn find_motionless(&self, motion: &Motion<S>) -> Result<Vec<bool>, StepFailure> {
        let dt = self.options.dt;
        let wild = |(body, velocity): (&Body<S>, &S::Velocity)| {
            let (place, velocity) = (S::place(&body.pose), velocity.as_ref());
            let mut arrival = place.as_ref().iter().zip(velocity).map(|(x, v)| x + dt * v);
            !velocity.iter().all(|&v| VELOCITY.hold(v)) || !arrival.all(|x| COORDINATE.hold(x))
        };
        if let Some(i) = self.scene.bodies().iter().zip(&motion.velocities).position(wild) {
            return Err(StepFailure::OutOfBounds { body: self.scene.bodies()[i].name.clone() });
        }
        Ok(motionless_bodies(&self.scene, &motion.velocities, self.options.dt))
    }

    /// Moves what moves, and takes back what came to overlap.
    fn integrate(&mut self, velocities: Vec<S::Velocity>, motionless: Vec<bool>) -> Projected {
        let poses: Vec<S::Pose> = self.scene.bodies().iter().map(|body| body.pose).collect();
        let before = (self.velocities.clone(), self.motionless.clone(), self.forces.clone());
        let go_on = |world: &mut Self| world.integrate_to_the_end(velocities, motionless);
        or_else(self, go_on, |world| {
            poses.into_iter().enumerate().for_each(|(i, pose)| world.scene.set_pose(i, pose));
            (world.velocities, world.motionless, world.forces) = before;
        })
    }

    fn integrate_to_the_end(&mut self, mut velocities: Vec<S::Velocity>, motionless: Vec<bool>) -> Projected {
        velocities
            .iter_mut()
            .zip(&motionless)
            .filter(|(_, still)| **still)
            .for_each(|(v, _)| *v = S::Velocity::default());
        advance(&mut self.scene, &velocities, &motionless, self.options.dt);
        (self.velocities, self.motionless) = (velocities, motionless);
        self.forces.fill(S::Velocity::default());
        self.project()
    }

    /// The sliding speeds to begin the next step with: none between bodies that stand still.
    fn sliding_of(&self, problem: &VelocityLevel<S>, mut sliding: Vec<f64>) -> Vec<f64> {
        for (approach, s) in problem.approaches().iter().zip(&mut sliding) {
            if approach.id.bodies.iter().all(|&body| self.motionless[body]) {
                *s = 0.0;
            }
        }
        sliding
    }

    /// Takes overlaps back until none is deeper than the contact tolerance, or nothing helps. Finds the approaches of the next step.
    fn project(&mut self) -> Projected {
        let mut projected = Projected::default();
        loop {
            self.find_approaches(&self.free_velocities());
            let deep = |([a, b], depth): ([usize; 2], f64)| {
                let bodies = self.scene.bodies();
                let held = self.motionless[a] && self.motionless[b];
                !held && depth > pair_tolerance(&self.scene, &bodies[a], &bodies[b])
            };
            if projected.rounds == ROUNDS || !self.finder.overlaps().any(deep) {
                return projected;
            }
            let held = |(mass, still): (&S::Velocity, &bool)| if *still { S::Velocity::default() } else { *mass };
            let inverse_mass: Vec<_> = self.inverse_mass.iter().zip(&self.motionless).map(held).collect();
            let free = |approach: &&ApproachOf<S>| approach.id.bodies.iter().any(|&i| !is_zero(&inverse_mass[i]));
            let approaches: Vec<&ApproachOf<S>> = self.finder.approaches().filter(free).collect();
            let Some(change) = way_out::<S>(&approaches, &inverse_mass, &mut projected.counts) else {
                return projected;
            };
            shift(&mut self.scene, &mut self.velocities, &change);
            projected.rounds += 1;
        }
    }
}

#[derive(Debug, Default)]
struct Projected {
    rounds: usize,
    counts: Counts,
}
