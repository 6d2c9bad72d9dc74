//! Which bodies do not move in a step: the paper's GETMOTIONLESSBODIES.

use super::{
    formulate::{contact_problem::ContactProblem, islands::Islands},
    kinematics::{Kinematics, loaded},
    options::COULOMB_TOLERANCE,
    state::State,
};
use crate::{
    check::AT_REST,
    contact::candidates::{shift, turn},
    geometry::norm,
    scene::Body,
};

/// Fixed bodies, those whose speed cannot be told from rest, and islands of which no body is faster than a step that counts as exact may be off
/// the law: rounding of places and of sliding speeds keeps a chain of blocks, such as a house of cards that stands, at 1e-10 m/s for ever. Of
/// a chain that moves no block may be held so: its neighbours would make up for it.
pub(super) fn motionless_in_step<S: Kinematics>(
    state: &State<S>,
    contacts: &ContactProblem<S>,
    velocities: &[S::Velocity],
    unseen: f64,
) -> Vec<bool> {
    let mut motionless = motionless_bodies(state, velocities, unseen);
    let creep = state.options.coulomb_tolerance.min(COULOMB_TOLERANCE)
        * norm(state.scene.gravity().as_ref())
        * state.options.dt;
    let creeping = motionless_bodies(state, velocities, creep);
    if motionless != creeping {
        let islands = Islands::new(contacts, &state.inverse_mass);
        let mut moves = vec![false; motionless.len()];
        creeping.iter().enumerate().filter(|(_, creeps)| !**creeps).for_each(|(i, _)| moves[islands.of_body(i)] = true);
        motionless.iter_mut().enumerate().for_each(|(i, still)| *still |= creeping[i] && !moves[islands.of_body(i)]);
    }
    motionless
}

/// Fixed bodies, and those that end the step slower than [`AT_REST`] times what gravity (1 m/s^2 without gravity) and their own
/// loads give in one step, or than `unseen`, what the step's solve cannot tell from rest (m/s). That is the measure of `check`: a block that would accelerate by less is at rest there too. The speed of the
/// corner furthest from the centre of mass counts for turning.
pub(super) fn motionless_bodies<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity], unseen: f64) -> Vec<bool> {
    let scene = &state.scene;
    let gravity = Some(norm(scene.gravity().as_ref())).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
    let still = |(body, velocity): (&Body<S>, &S::Velocity)| {
        let slow = unseen.max(AT_REST * (gravity + loaded(body)) * state.options.dt);
        body.fixed || (shift::<S>(velocity) <= slow && turn::<S>(velocity) * body.shape.radius() <= slow)
    };
    scene.bodies().iter().zip(velocities).map(still).collect()
}
