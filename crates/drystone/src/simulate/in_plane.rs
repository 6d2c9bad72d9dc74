//! What a step asks of polygons.

use super::kinematics::Kinematics;
use crate::{
    any_scene::AnyScene,
    error::SceneError,
    formulate::{Cones, cone_edges},
    geometry::{Polygon, Pose},
    io,
    scene::{Body, Scene},
};

impl Kinematics for Polygon {
    type Place = [f64; 3];

    fn place_of(pose: &Pose) -> [f64; 3] {
        [pose.position[0], pose.position[1], pose.angle]
    }

    fn advanced(body: &Body, [vx, vy, turning]: &[f64; 3], seconds: f64) -> Pose {
        let Pose { position: [x, y], angle } = body.pose;
        Pose { position: [x + seconds * vx, y + seconds * vy], angle: angle + seconds * turning }
    }

    fn undisturbed(_: &Body, velocity: &[f64; 3], _: f64) -> [f64; 3] {
        *velocity
    }

    fn to_own_axes(_: &Body, velocity: &[f64; 3]) -> [f64; 3] {
        *velocity
    }

    fn to_world_axes(_: &Body, velocity: &[f64; 3]) -> [f64; 3] {
        *velocity
    }

    fn edges(_: Cones, normal: [f64; 2], friction: f64, _: [f64; 2]) -> Vec<[f64; 2]> {
        cone_edges(normal, friction)
    }

    fn edge_friction(_: Cones, friction: f64) -> f64 {
        friction
    }

    fn sliding_speed(_: &[[f64; 2]], [nx, ny]: &[f64; 2], _: f64, [ux, uy]: &[f64; 2]) -> f64 {
        (uy * nx - ux * ny).abs()
    }

    fn of_any(scene: AnyScene) -> Result<Scene, SceneError> {
        scene.in_plane()
    }

    fn to_json(scene: &Scene) -> String {
        io::to_json(scene)
    }
}
