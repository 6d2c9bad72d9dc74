//! What a step asks of the shape of a block, in the plane and in space.

use crate::{
    any_scene::AnyScene,
    contact::candidates::Colliding,
    error::SceneError,
    formulate::{Assemble, Cones},
    geometry::Numbers,
    scene::{Body, SceneOf},
};

/// Shapes whose motion can be simulated.
pub trait Kinematics: Colliding + Assemble {
    /// A pose as numbers: x, y (m) and the angle (rad); in space x, y, z (m) and a unit quaternion w, x, y, z.
    type Place: Numbers;

    /// See [`Self::Place`].
    fn place_of(pose: &Self::Pose) -> Self::Place;

    /// The pose of a body that moves with this velocity for so many seconds.
    fn advanced(body: &Body<Self>, velocity: &Self::Velocity, seconds: f64) -> Self::Pose;

    /// The velocity, after so many seconds, of a body on which nothing acts.
    fn undisturbed(body: &Body<Self>, velocity: &Self::Velocity, seconds: f64) -> Self::Velocity;

    /// A velocity whose turning is about the axes of the world, with the turning about the body's own ones.
    fn to_own_axes(body: &Body<Self>, velocity: &Self::Velocity) -> Self::Velocity;

    /// The reverse.
    fn to_world_axes(body: &Body<Self>, velocity: &Self::Velocity) -> Self::Velocity;

    /// Unit vectors along the edges of a friction cone: the normal alone without friction.
    fn edges(cones: Cones, normal: Self::Vector, friction: f64, gravity: Self::Vector) -> Vec<Self::Vector>;

    /// The coefficient at these edges.
    fn edge_friction(cones: Cones, friction: f64) -> f64;

    /// The speed that De Saxcé's correction needs, m/s: the greatest along an edge's tangent, reversed. `u` is the velocity of
    /// the second body relative to the first.
    fn sliding_speed(edges: &[Self::Vector], normal: &Self::Vector, edge_friction: f64, u: &Self::Vector) -> f64;

    /// The name of the first body whose motion cannot be simulated.
    fn immovable(_scene: &SceneOf<Self>) -> Option<String> {
        None
    }

    /// The scene of such shapes.
    ///
    /// # Errors
    /// [`SceneError`] for one in another dimension.
    fn of_any(scene: AnyScene) -> Result<SceneOf<Self>, SceneError>;

    /// The scene as JSON.
    fn to_json(scene: &SceneOf<Self>) -> String;
}

/// Mass for each direction (kg) and moment of inertia for each turning (kg m^2) of a body.
pub(crate) fn masses<S: Kinematics>(body: &Body<S>) -> S::Velocity {
    let mut masses = S::Velocity::default();
    let (along, turning) = split_mut::<S>(&mut masses);
    along.fill(body.mass());
    turning.copy_from_slice(body.moments());
    masses
}

/// Diagonal of `M^-1`: zero for a fixed body.
pub(crate) fn inverse_mass<S: Kinematics>(body: &Body<S>) -> S::Velocity {
    if body.fixed {
        return S::Velocity::default();
    }
    let mut inverse = masses(body);
    inverse.as_mut().iter_mut().for_each(|entry| *entry = entry.recip());
    inverse
}

/// Wrench of a body's permanent loads about its centre of mass, N and N m, the moments about its own axes.
pub(crate) fn permanent<S: Kinematics>(body: &Body<S>) -> S::Velocity {
    let part = S::part(body);
    let mut wrench = S::Velocity::default();
    S::COMPONENTS.iter().zip(wrench.as_mut()).for_each(|(&k, entry)| *entry = part.load[k]);
    wrench
}

/// Adds to a wrench.
pub(crate) fn add<V: Numbers>(sum: &mut V, more: &V) {
    sum.as_mut().iter_mut().zip(more.as_ref()).for_each(|(sum, more)| *sum += more);
}

/// The size of a body's permanent loads over its mass, m/s^2: see [`Part::load_size`](crate::formulate::Part::load_size).
pub(crate) fn loaded<S: Kinematics>(body: &Body<S>) -> f64 {
    if body.loads().is_empty() { 0.0 } else { S::part(body).load_size() / body.mass() }
}

/// Numbers of a vector.
pub(crate) fn axes<S: Kinematics>() -> usize {
    S::Vector::default().as_ref().len()
}

/// Numbers of a velocity.
pub(crate) fn components<S: Kinematics>() -> usize {
    S::Velocity::default().as_ref().len()
}

/// The part along the axes, and the turning.
pub(crate) fn split<S: Kinematics>(velocity: &S::Velocity) -> (&[f64], &[f64]) {
    velocity.as_ref().split_at(axes::<S>())
}

/// The same, to change it.
pub(crate) fn split_mut<S: Kinematics>(velocity: &mut S::Velocity) -> (&mut [f64], &mut [f64]) {
    velocity.as_mut().split_at_mut(axes::<S>())
}

/// Whether it is that of a body at rest: of `M^-1`, that of a fixed one.
pub(crate) fn is_zero<V: Numbers>(velocity: &V) -> bool {
    velocity.as_ref().iter().all(|x| *x == 0.0)
}
