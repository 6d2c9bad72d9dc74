//! From velocities to places.

use super::moving::Moving;
use crate::scene::SceneOf;

/// Moves every body that is not motionless by its velocity: `x+ = x + h v+`. Motionless ones keep their place to the bit.
pub(super) fn advance<S: Moving>(scene: &mut SceneOf<S>, velocities: &[S::Velocity], motionless: &[bool], dt: f64) {
    for (i, velocity) in velocities.iter().enumerate().filter(|(i, _)| !motionless[*i]) {
        scene.set_pose(i, S::advanced(&scene.bodies()[i], velocity, dt));
    }
}
