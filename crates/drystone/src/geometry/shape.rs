//! What a scene asks of the shape of a block, in the plane and in space.

use super::{
    Vector3,
    vectors::{Numbers, plus_times},
};
use std::fmt::Debug;

/// A plane part of a block's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face<V> {
    /// Outward, of length one.
    pub normal: V,
    /// m^2; in the plane metres.
    pub area: f64,
    /// Centroid, metres.
    pub middle: V,
}

/// The shape of one block in its own frame, whose origin is the centre of mass: the centroid, unless another was given.
pub trait Shape: Clone + Debug + PartialEq {
    /// A point or a vector: `[f64; 2]` or `[f64; 3]`.
    type Vector: Numbers;
    /// Where the frame stands in the world.
    type Pose: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// Area in m^2, or volume in m^3.
    fn measure(&self) -> f64;

    /// Principal second moments about the centroid for a density of one: m^4 in the plane, where there is one, m^5 in space.
    fn moments(&self) -> Vec<f64>;

    /// Unit vectors of the principal axes in the frame, in the order of the moments; in the plane those of the frame.
    fn axes(&self) -> [Vector3; 3];

    /// Distance of the furthest corner from the frame's origin, metres.
    fn radius(&self) -> f64;

    /// Distance of two parallel lines or planes that hold the shape between them, metres: the least over those along a face.
    fn width(&self) -> f64;

    /// Where the centroid is in the frame, metres: zero to the bit unless another centre of mass was given.
    fn centroid(&self) -> Self::Vector;

    /// Where the frame's origin, the centre of mass, is in the world, metres.
    fn place(pose: &Self::Pose) -> Self::Vector;

    /// A vector of the frame in world axes.
    fn turned(pose: &Self::Pose, vector: Self::Vector) -> Self::Vector;

    /// A point of the frame in the world.
    fn in_world(pose: &Self::Pose, point: Self::Vector) -> Self::Vector {
        plus_times(Self::turned(pose, point), 1.0, &Self::place(pose))
    }

    /// A point of the world in the frame.
    fn seen_from(pose: &Self::Pose, point: Self::Vector) -> Self::Vector;

    /// The plane parts of the surface, in the frame; of a block of several pieces those of each.
    fn faces(&self) -> Vec<Face<Self::Vector>>;

    /// The pose with that place instead of its own.
    fn placed(pose: Self::Pose, place: Self::Vector) -> Self::Pose;

    /// Lower and upper corner of the box around the shape where its frame stands, world coordinates, metres.
    fn bounds(&self, pose: &Self::Pose) -> [Self::Vector; 2];
}
