//! From velocities to places.

use super::projection::{Projected, project};
use crate::{
    contact::candidates::CandidateFinder,
    interrupt::or_else,
    scene::SceneOf,
    simulate::{kinematics::Kinematics, state::State},
};

/// Moves what moves, and takes back what came to overlap. Work that is stopped on the way leaves the state as it was.
pub fn integrate<S: Kinematics>(
    state: &mut State<S>,
    finder: &mut CandidateFinder<S>,
    velocities: Vec<S::Velocity>,
    motionless: Vec<bool>,
) -> Projected {
    let poses: Vec<S::Pose> = state.scene.bodies().iter().map(|body| body.pose).collect();
    let before = (state.velocities.clone(), state.motionless.clone(), state.forces.clone());
    let go_on = |state: &mut State<S>| {
        take_velocities(state, velocities, motionless);
        project(state, finder)
    };
    or_else(state, go_on, |state| {
        poses.into_iter().enumerate().for_each(|(i, pose)| state.scene.set_pose(i, pose));
        (state.velocities, state.motionless, state.forces) = before;
    })
}

fn take_velocities<S: Kinematics>(state: &mut State<S>, mut velocities: Vec<S::Velocity>, motionless: Vec<bool>) {
    velocities.iter_mut().zip(&motionless).filter(|(_, still)| **still).for_each(|(v, _)| *v = S::Velocity::default());
    advance(&mut state.scene, &velocities, &motionless, state.options.dt);
    (state.velocities, state.motionless) = (velocities, motionless);
    state.forces.fill(S::Velocity::default());
}

/// Moves every body that is not motionless by its velocity: `x+ = x + h v+`. Motionless ones keep their place to the bit.
fn advance<S: Kinematics>(scene: &mut SceneOf<S>, velocities: &[S::Velocity], motionless: &[bool], dt: f64) {
    for (i, velocity) in velocities.iter().enumerate().filter(|(i, _)| !motionless[*i]) {
        scene.set_pose(i, S::advanced(&scene.bodies()[i], velocity, dt));
    }
}
