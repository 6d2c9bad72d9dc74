//! Scenes of cuboids, and planar scenes given a thickness.

use super::entry::{SceneEntry, friction, integer};
use crate::bounds::LENGTH;
use crate::error::SceneError;
use crate::geometry::{PoseInSpace, Shape};
use crate::mass_properties::MassProperties;
use crate::scene::{Body, BodyOptions, Scene};
use crate::scene_in_space::SceneInSpace;
use crate::settlement::Settlement;

/// Gravity of the built-in scenes in space, m/s^2.
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

pub(super) const SQUARE_PYRAMID: SceneEntry = SceneEntry {
    name: "square_pyramid",
    summary: "square layers of unit cubes, each cube on four of the layer below (in space)",
    parameters: &[integer("layers", 7, [1, 100], "layers"), friction(0.0)],
    make: |given| square_pyramid(given.size(0), given.number(1)).map(Into::into),
};

pub(super) const BRICK_WALL: SceneEntry = SceneEntry {
    name: "brick_wall",
    summary: "a wall of bricks in running bond, half bricks at the ends (in space)",
    parameters: &[
        integer("rows", 5, [1, 1000], "courses"),
        integer("columns", 5, [1, 1000], "bricks of a course"),
        friction(0.6),
    ],
    make: |given| brick_wall(given.size(0), given.size(1), given.number(2)).map(Into::into),
};

/// A pyramid of `layers` square layers, n (n + 1) (2 n + 1) / 6 unit cubes, layer by layer from below. Neighbours in a layer
/// touch side by side.
pub fn square_pyramid(layers: usize, friction: f64) -> Result<SceneInSpace, SceneError> {
    SQUARE_PYRAMID.check(&[layers as f64, friction])?;
    let mut builder = Builder::new(friction)?;
    builder.ground([layers as f64 + 2.0; 2])?;
    for layer in 0..layers {
        let side = layers - layer;
        let place = |k: usize| k as f64 - 0.5 * (side as f64 - 1.0);
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            builder.block([place(i), place(j), layer as f64 + 0.5], [1.0; 3])?;
        }
    }
    Ok(builder.scene)
}

/// Length, thickness and height of a brick, metres.
const BRICK: [f64; 3] = [1.0, 0.5, 0.5];

/// `rows` courses of bricks of 1 m by 0.5 m by 0.5 m. Every second course begins and ends with half a brick.
pub fn brick_wall(rows: usize, columns: usize, friction: f64) -> Result<SceneInSpace, SceneError> {
    BRICK_WALL.check(&[rows as f64, columns as f64, friction])?;
    let [length, thickness, height] = BRICK;
    let mut builder = Builder::new(friction)?;
    builder.ground([columns as f64 * length + 2.0, 2.0])?;
    let left = -0.5 * columns as f64 * length;
    for row in 0..rows {
        let ends = [0.0, length * columns as f64];
        let inner = (1..columns + row % 2).map(|k| length * (k as f64 - 0.5 * (row % 2) as f64));
        let joints: Vec<f64> = ends[..1].iter().copied().chain(inner).chain([ends[1]]).collect();
        for joint in joints.windows(2) {
            let middle = left + 0.5 * (joint[0] + joint[1]);
            let center = [middle, 0.0, height * (row as f64 + 0.5)];
            builder.block(center, [joint[1] - joint[0], thickness, height])?;
        }
    }
    Ok(builder.scene)
}

/// A planar scene with a thickness: (x, y) becomes (x, 0, y), and every block reaches from -`depth` / 2 to `depth` / 2
/// along y. Masses stay what they are.
///
/// # Errors
/// [`SceneError`] for a depth that is not above zero or out of bounds, and what [`SceneInSpace::add_solid`] refuses.
pub fn extruded(scene: &Scene, depth: f64) -> Result<SceneInSpace, SceneError> {
    LENGTH.check_positive("the depth of an extruded scene", depth)?;
    let [gx, gy] = scene.gravity();
    let mut solid = SceneInSpace::new([gx, 0.0, gy], scene.friction())?;
    if let Some(tolerance) = scene.contact_tolerance() {
        solid = solid.with_contact_tolerance(tolerance)?;
    }
    for body in scene.bodies() {
        let density = if body.own.mass.is_some() { 1.0 } else { body.density / depth };
        let (friction, fixed, own) = (body.friction, body.fixed, thickened(body, depth));
        let options = BodyOptions { name: Some(body.name.clone()), density, friction, fixed, own };
        let ([x, y], (sin, cos)) = (body.pose.position, (0.5 * body.pose.angle).sin_cos());
        let pose = PoseInSpace { position: [x, 0.0, y], orientation: [cos, 0.0, -sin, 0.0] };
        match body.box_size {
            Some([width, height]) => solid.add_cuboid(pose, [width, depth, height], options)?,
            None => {
                let both =
                    |v: &<crate::geometry::Polygon as Shape>::Vector| [-0.5, 0.5].map(|s| [v[0], s * depth, v[1]]);
                let corners = body.shape.vertices().iter().flat_map(|v| both(&v.to_array())).collect();
                solid.add_solid(&[corners], pose, options)?
            }
        };
    }
    for (index, body) in scene.bodies().iter().enumerate() {
        for load in body.loads() {
            // The frames' axes: (x, y) of the plane are x and z.
            let ([x, y], [a, b], [_, _, m]) = (load.force, load.at, load.moment);
            solid.push_load(index, Some(load.name.clone()), [x, 0.0, y], [a, 0.0, b], [0.0, -m, 0.0])?;
        }
    }
    for (index, body) in scene.bodies().iter().enumerate() {
        for settlement in body.settlements() {
            let ([x, y], [a, b], [_, _, turn]) = (settlement.displacement, settlement.at, settlement.rotation);
            let (displacement, rotation, at) = ([x, 0.0, y], [0.0, -turn, 0.0], [a, 0.0, b]);
            solid.push_settlement(index, Settlement { displacement, rotation, at })?;
        }
    }
    let name = |i: usize| scene.bodies()[i].name.as_str();
    for ([a, b], friction) in scene.pair_frictions() {
        solid.set_friction(name(a), name(b), friction)?;
    }
    Ok(solid)
}

/// What a block weighs once it has a thickness. A moment of its own is that of its plane figure times a factor, which
/// the figure's other moments take on as well.
fn thickened(body: &Body, depth: f64) -> MassProperties {
    let center_of_mass = body.own.center_of_mass.map(|_| [0.0; 3]);
    let inertia = body.own.inertia.map(|_| {
        let [xx, yy, xy] = body.shape.second_moments();
        let factor = body.inertia() / (xx + yy);
        let slab = body.mass() * depth * depth / 12.0;
        let (x, z, across) = (factor * yy + slab, factor * xx + slab, -factor * xy);
        [[x, 0.0, across], [0.0, body.inertia(), 0.0], [across, 0.0, z]]
    });
    MassProperties { mass: body.own.mass, center_of_mass, inertia }
}

struct Builder {
    scene: SceneInSpace,
}

impl Builder {
    fn new(friction: f64) -> Result<Self, SceneError> {
        Ok(Self { scene: SceneInSpace::new(GRAVITY, friction)? })
    }

    /// A fixed slab, its upper side at height zero.
    fn ground(&mut self, [length, width]: [f64; 2]) -> Result<(), SceneError> {
        let options = BodyOptions { name: Some("ground".into()), fixed: true, ..BodyOptions::default() };
        let pose = PoseInSpace { position: [0.0, 0.0, -0.5], ..PoseInSpace::WORLD };
        self.scene.add_cuboid(pose, [length, width, 1.0], options).map(drop)
    }

    /// A movable cuboid; they are numbered from 1.
    fn block(&mut self, center: [f64; 3], size: [f64; 3]) -> Result<(), SceneError> {
        let name = Some(self.scene.bodies().len().to_string());
        let pose = PoseInSpace { position: center, ..PoseInSpace::WORLD };
        self.scene.add_cuboid(pose, size, BodyOptions { name, ..BodyOptions::default() }).map(drop)
    }
}
