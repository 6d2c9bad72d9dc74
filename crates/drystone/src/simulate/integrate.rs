//! From velocities to places.

use super::velocity_level::Velocity;
use crate::{geometry::Pose, scene::Scene};

/// Moves every body that is not motionless by its velocity: `x+ = x + h v+`. Motionless ones keep their place to the bit.
pub(super) fn advance(scene: &mut Scene, velocities: &[Velocity], motionless: &[bool], dt: f64) {
    for (i, [vx, vy, turning]) in velocities.iter().copied().enumerate() {
        if !motionless[i] {
            let Pose { position: [x, y], angle } = scene.bodies()[i].pose;
            scene.set_pose(i, Pose { position: [x + dt * vx, y + dt * vy], angle: angle + dt * turning });
        }
    }
}
