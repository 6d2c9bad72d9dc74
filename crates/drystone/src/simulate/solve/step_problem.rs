//! The contact problem of one step, and its answer.

use crate::{
    contact::candidates::CandidateOf,
    geometry::{Polygon, norm},
    simulate::{
        formulate::contact_problem::{ContactProblem, relative_velocity},
        kinematics::Kinematics,
        record::Inconsistent,
        state::State,
    },
};
use drystone_lcp::Counts;
use std::time::Duration;

/// What is to be solved: the same for all solves of a step.
pub struct StepProblem<'a, S: Kinematics> {
    pub contacts: &'a ContactProblem<S>,
    /// Velocities without contacts.
    pub free: &'a [S::Velocity],
    /// How fast each contact may close, m/s.
    pub offsets: &'a [f64],
    pub effort: Effort,
}

/// How much a motion may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// What is found soon, while it is looked for who meets.
    Soon,
    /// All that leads to Coulomb's law.
    Full,
}

/// A solved step.
pub struct Motion<S: Kinematics = Polygon> {
    pub velocities: Vec<S::Velocity>,
    /// Sliding speed at every contact, m/s.
    pub sliding: Vec<f64>,
    /// Impulse at every contact in world axes, N s.
    pub impulses: Vec<S::Vector>,
    /// Largest error of Coulomb's law, m/s.
    pub friction_error: f64,
    /// Whether that is within the tolerance.
    pub exact: bool,
    /// Whether more than [`Effort::Soon`] may find a better one.
    pub unfinished: bool,
    /// Slower than this, m/s, a body may be at rest: how far the velocities are known. Zero for pivots, which know them to rounding.
    pub unseen: f64,
    pub residual: f64,
    pub solves: usize,
    pub rows_reused: usize,
    pub time: Duration,
    /// Work besides that of the solver that goes on from step to step.
    pub counts: Counts,
    pub collisions: usize,
    pub inconsistent: Option<Inconsistent>,
}

impl<S: Kinematics> StepProblem<'_, S> {
    /// The largest error of Coulomb's law that counts as exact, m/s: the tolerance times the largest speed of a contact without
    /// impulses, or what gravity gives in a step.
    pub fn coulomb_tolerance(&self, state: &State<S>) -> f64 {
        let speed = |candidate: &CandidateOf<S>| norm(relative_velocity::<S>(candidate, self.free).as_ref());
        let fastest = self.contacts.candidates().iter().map(speed).fold(0.0, f64::max);
        state.options.coulomb_tolerance * fastest.max(norm(state.scene.gravity().as_ref()) * state.options.dt)
    }

    /// The sliding speeds found, and the largest error of Coulomb's law: where a contact bears, the speed at which it parts;
    /// where it does not, the speed at which it closes beyond its gap. `assumed` are the sliding speeds that the cones' edges were
    /// corrected for, `p` the impulses of the rows.
    pub fn coulomb_error(
        &self,
        velocities: &[S::Velocity],
        assumed: &[f64],
        p: impl Fn(usize) -> f64,
    ) -> (Vec<f64>, f64) {
        let mut worst = 0.0_f64;
        let mut sliding = Vec::with_capacity(assumed.len());
        for (k, (assumed, offset)) in assumed.iter().zip(self.offsets).enumerate() {
            let [opening, speed] = self.contacts.opening_and_sliding(k, velocities);
            let bears = self.contacts.rows(k).any(|row| p(row) > 0.0);
            worst = worst.max(match self.contacts.friction(k) {
                0.0 => 0.0,
                friction if bears => friction * (speed - assumed).abs(),
                _ => -(opening + offset),
            });
            sliding.push(speed);
        }
        (sliding, worst)
    }
}

impl<S: Kinematics> Motion<S> {
    /// Counts the work of a solve of the same step that was not better.
    pub fn count(&mut self, other: &Self) {
        (self.solves, self.counts, self.time) = (other.solves, other.counts, other.time);
    }

    /// Counts the work of an earlier solve of the same step.
    pub fn add_earlier(&mut self, earlier: &Self) {
        self.solves += earlier.solves;
        self.counts = self.counts + earlier.counts;
        self.time += earlier.time;
    }

    /// Counts the work of a part of the step that was solved apart.
    pub fn add_part(&mut self, solves: usize, counts: Counts, residual: f64) {
        self.solves += solves;
        self.counts = self.counts + counts;
        self.residual = self.residual.max(residual);
    }
}
