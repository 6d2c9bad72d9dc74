//! How fast the contacts of a step may close, and how fast they part after an impact.

use super::contact_problem::ContactProblem;
use crate::{
    geometry::norm,
    simulate::{kinematics::Kinematics, state::State},
};

/// Impacts slower than what gravity gives in this many steps do not rebound: they are contacts that rest.
const RESTING_STEPS: f64 = 4.0;

/// Contacts that close more slowly rest, m/s.
pub fn resting_speed<S: Kinematics>(state: &State<S>) -> f64 {
    RESTING_STEPS * state.options.dt * norm(state.scene.gravity().as_ref())
}

/// How fast every contact may close, m/s: to the end of its gap, or with restitution, at an impact, minus how fast it has to part.
/// `free` are the velocities without contacts.
pub fn offsets<S: Kinematics>(state: &State<S>, contacts: &ContactProblem<S>, free: &[S::Velocity]) -> Vec<f64> {
    let gap = |k: usize| contacts.candidates()[k].gap.max(0.0) / state.options.dt;
    let offset = |k: usize| rebound(state, contacts, k, free).unwrap_or_else(|| gap(k));
    (0..contacts.candidates().len()).map(offset).collect()
}

/// The offset of a contact at which bodies collide and part again, m/s: `e u_n`. None where they do not.
fn rebound<S: Kinematics>(
    state: &State<S>,
    contacts: &ContactProblem<S>,
    contact: usize,
    free: &[S::Velocity],
) -> Option<f64> {
    let (dt, restitution) = (state.options.dt, state.options.restitution);
    let [arriving, _] = contacts.opening_and_sliding(contact, &state.velocities);
    let [free, _] = contacts.opening_and_sliding(contact, free);
    let gap = contacts.candidates()[contact].gap.max(0.0);
    let collides = arriving < -resting_speed(state) && gap + dt * free <= 0.0;
    (restitution > 0.0 && collides).then_some(restitution * arriving)
}
