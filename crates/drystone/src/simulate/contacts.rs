//! The first stage of a step: what touches, and what may touch before it ends.

use super::{
    error::StepFailure,
    kinematics::{Kinematics, is_zero},
    options::Reuse,
    state::State,
};
use crate::contact::candidates::{CandidateFinder, CandidateOf, MOST_TURN, turn};

/// Finds every contact that may close within the step. `free` are the velocities without contacts.
///
/// # Errors
/// [`StepFailure::TooFast`].
pub(super) fn find_for_step<S: Kinematics>(
    finder: &mut CandidateFinder<S>,
    state: &State<S>,
    free: &[S::Velocity],
) -> Result<(), StepFailure> {
    if state.options.reuse != Reuse::Full {
        finder.clear();
    }
    find(finder, state, free);
    match finder.turns_too_far() {
        Some((body, pair)) => Err(too_fast(state, body, pair, free)),
        None => Ok(()),
    }
}

/// The same, whatever the bodies turn.
pub(super) fn find<S: Kinematics>(finder: &mut CandidateFinder<S>, state: &State<S>, free: &[S::Velocity]) {
    finder.find(&state.scene, &travel(state, free));
}

/// Where bodies meet that move so, beside the `known` contacts. Nobody meets twice in a step.
pub(super) fn met<S: Kinematics>(
    finder: &CandidateFinder<S>,
    state: &State<S>,
    known: &[CandidateOf<S>],
    velocities: &[S::Velocity],
) -> Vec<CandidateOf<S>> {
    let pair = |candidate: &CandidateOf<S>| {
        let id = candidate.id;
        (id.bodies, id.pieces(), id.feature.at_borders())
    };
    let is_known = |candidate: &CandidateOf<S>| known.iter().any(|known| pair(known) == pair(candidate));
    let mut met = finder.met(&state.scene, &travel(state, velocities), |i| is_zero(&state.velocities[i]));
    met.retain(|candidate| !is_known(candidate));
    met
}

/// How far bodies go in a step.
fn travel<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity]) -> Vec<S::Velocity> {
    let of = |velocity: &S::Velocity| {
        let mut travel = *velocity;
        travel.as_mut().iter_mut().for_each(|x| *x *= state.options.dt);
        travel
    };
    velocities.iter().map(of).collect()
}

fn too_fast<S: Kinematics>(state: &State<S>, body: usize, [a, b]: [usize; 2], free: &[S::Velocity]) -> StepFailure {
    let name = |i: usize| state.scene.bodies()[i].name.clone();
    let other = if body == a { b } else { a };
    StepFailure::TooFast { body: name(body), other: name(other), dt: MOST_TURN / turn::<S>(&free[body]) }
}
