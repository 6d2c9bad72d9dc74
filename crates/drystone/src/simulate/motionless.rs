//! Which bodies do not move in a step: the paper's GETMOTIONLESSBODIES.

use super::kinematics::{Kinematics, loaded};
use crate::{
    check::AT_REST,
    contact::candidates::{shift, turn},
    geometry::norm,
    scene::{Body, SceneOf},
};

/// Fixed bodies, and those that end the step slower than [`AT_REST`] times what gravity (1 m/s^2 without gravity) and their own
/// loads give in one step, or than `unseen`, what the step's solve cannot tell from rest (m/s). That is the measure of `check`: a block that would accelerate by less is at rest there too. The speed of the
/// corner furthest from the centre of mass counts for turning.
pub(super) fn motionless_bodies<S: Kinematics>(
    scene: &SceneOf<S>,
    velocities: &[S::Velocity],
    dt: f64,
    unseen: f64,
) -> Vec<bool> {
    let gravity = Some(norm(scene.gravity().as_ref())).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
    let still = |(body, velocity): (&Body<S>, &S::Velocity)| {
        let slow = unseen.max(AT_REST * (gravity + loaded(body)) * dt);
        body.fixed || (shift::<S>(velocity) <= slow && turn::<S>(velocity) * body.shape.radius() <= slow)
    };
    scene.bodies().iter().zip(velocities).map(still).collect()
}
