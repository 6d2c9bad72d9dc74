//! Solids where they stand, and the points at which two of them touch.

use super::id::SolidFeature;
use crate::{
    geometry::{Polyhedron, Solid, Vector3},
    scene::Body,
};

/// A body's pieces turned into world axes, but still about its centroid, so that nothing is lost far from the world's
/// origin.
#[derive(Debug, Clone)]
pub struct Placed {
    pub(super) pieces: Vec<Polyhedron>,
    /// Principal axes.
    pub(super) axes: [Vector3; 3],
}

impl Placed {
    pub(super) fn of(body: &Body<Solid>) -> Self {
        let [x, y, z] = body.pose.axes();
        let rotate = |v: Vector3| v.x * x + v.y * y + v.z * z;
        Self {
            pieces: body.shape.pieces().iter().map(|piece| piece.turned(rotate)).collect(),
            axes: body.principal_axes().map(rotate),
        }
    }
}

/// A contact point relative to the first body's centroid.
#[derive(Debug, Clone, Copy)]
pub(super) struct TouchPoint {
    pub features: [SolidFeature; 2],
    pub point: Vector3,
    /// Unit vector from the first body into the second.
    pub normal: Vector3,
    pub gap: f64,
}
