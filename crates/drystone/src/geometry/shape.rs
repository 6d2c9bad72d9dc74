//! What a scene asks of the shape of a block, in the plane and in space.

use std::fmt::Debug;

/// The shape of one block in its own frame, whose origin is the centroid.
pub trait Shape: Clone + Debug + PartialEq {
    /// A point or a vector: `[f64; 2]` or `[f64; 3]`.
    type Vector: Copy + Debug + PartialEq + AsRef<[f64]>;
    /// Where the frame stands in the world.
    type Pose: Copy + Debug + PartialEq;

    /// Area in m^2, or volume in m^3.
    fn measure(&self) -> f64;

    /// Principal second moments about the centroid for a density of one: m^4 in the plane, where there is one, m^5 in space.
    fn moments(&self) -> Vec<f64>;

    /// Distance of the furthest corner from the centroid, metres.
    fn radius(&self) -> f64;

    /// Distance of two parallel lines or planes that hold the shape between them, metres: the least over those along a face.
    fn width(&self) -> f64;
}
