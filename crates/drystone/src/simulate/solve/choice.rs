//! Which steps are solved on round cones, and which by pivots.

use super::{previous_step::PreviousStep, step_problem::StepProblem};
use crate::{
    geometry::{norm, product},
    simulate::{
        formulate::contact_problem::relative_velocity,
        kinematics::{Kinematics, axes, is_zero},
        options::Reuse,
        state::State,
    },
};

/// A quarter of the blocks are many.
const MANY: usize = 4;

/// In the plane, where pivots have two rows a contact: from so many moving blocks on the step is solved sooner here. Measured: with 25 that tumble in
/// half the time, with 10 in the same.
const MANY_IN_PLANE: usize = 16;

/// An impact, in this step, of what comes so many times as fast as gravity makes it in a step changes what bears all over a pile: pivots, whose pyramids
/// have eight rows a contact, take seconds where Newton's method takes milliseconds.
const IMPACT: f64 = 10.0;

/// A block slower than this share of what gravity gives it in a step comes to rest, or settles by rounding of its place: pivots end that
/// to the bit.
const SLOW: f64 = 1e-3;

/// Rows from which on pivots do not begin from nothing: with 8,000 in space they take half a minute.
pub const MANY_ROWS: usize = 1_000;

/// Whether a step is solved on round cones. Not for the modes of reuse that are about pivots. Where few blocks move amid many that rest, pivots
/// with the factor of the step before are ten times faster; so they go on until [`MANY`] move or one hits another ([`IMPACT`]), in the plane
/// until [`MANY_IN_PLANE`] move, and have no factor to go on with after that. Nor where all are [`SLOW`], if pivots have one; from nothing they end that in
/// the plane, but in space they took a fifth of a second for a wall of 27 bricks that had been hit. Of first steps only those of [`MANY_ROWS`].
pub fn on_round_cones<S: Kinematics>(state: &State<S>, previous: &PreviousStep<S>, step: &StepProblem<'_, S>) -> bool {
    if state.options.reuse != Reuse::Full {
        return false;
    }
    let count = |of: &[S::Velocity]| of.iter().filter(|x| !is_zero(*x)).count();
    let (movable, moving) = (count(&state.inverse_mass), count(&state.velocities));
    let kept = previous.solver.last_problem().is_some() || previous.at_rest.is_some();
    if state.is_at_rest() && !kept {
        return axes::<S>() == 3 && step.contacts.len() >= MANY_ROWS;
    }
    if (kept || axes::<S>() == 2) && all_are_slow(state, step) {
        return false;
    }
    let enough = axes::<S>() == 3 || moving >= MANY_IN_PLANE;
    // What is hit may move all at once.
    let may_move = axes::<S>() == 3 || movable >= MANY_IN_PLANE;
    // At rest so far, without a factor: to make one for many rows takes longer.
    let unmade = previous.at_rest.is_some() && step.contacts.len() >= MANY_ROWS;
    (previous.problem.is_some() && !kept)
        || (unmade && moving > 0)
        || (enough && moving > 0 && MANY * moving >= movable)
        || (may_move && is_hit(state, step))
}

/// Whether one body hits another: [`IMPACT`].
pub fn is_hit<S: Kinematics>(state: &State<S>, step: &StepProblem<'_, S>) -> bool {
    let fall = norm(state.scene.gravity().as_ref()) * state.options.dt;
    step.contacts.candidates().iter().zip(step.offsets).any(|(candidate, offset)| {
        let opening = product(&candidate.normal, &relative_velocity::<S>(candidate, step.free));
        opening + offset < 0.0 && opening < -IMPACT * fall
    })
}

/// Whether no velocity of bodies that may touch others is above [`SLOW`].
fn all_are_slow<S: Kinematics>(state: &State<S>, step: &StepProblem<'_, S>) -> bool {
    let slow = SLOW * norm(state.scene.gravity().as_ref()) * state.options.dt;
    let bodies = step.contacts.candidates().iter().flat_map(|candidate| candidate.id.bodies);
    bodies.into_iter().all(|i| norm(state.velocities[i].as_ref()) <= slow)
}
