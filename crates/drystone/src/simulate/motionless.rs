//! Which bodies do not move in a step: the paper's GETMOTIONLESSBODIES.

use super::velocity_level::Velocity;
use crate::{check::AT_REST, geometry::Shape, scene::Scene};

/// Fixed bodies, and those that end the step slower than [`AT_REST`] times what gravity gives in one step (1 m/s^2
/// without gravity). That is the measure of `check`: a block that would accelerate by less is at rest there too. The speed of the
/// corner furthest from the centroid counts for turning.
pub(super) fn motionless_bodies(scene: &Scene, velocities: &[Velocity], dt: f64) -> Vec<bool> {
    let [gx, gy] = scene.gravity();
    let gravity = Some(gx.hypot(gy)).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
    let slow = AT_REST * gravity * dt;
    let still = |(body, [x, y, turning]): (&crate::scene::Body, &Velocity)| {
        body.fixed || (x.hypot(*y) <= slow && turning.abs() * body.shape.radius() <= slow)
    };
    scene.bodies().iter().zip(velocities).map(still).collect()
}
