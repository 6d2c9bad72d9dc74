//! Permanent loads: forces and moments on blocks beside their weight.

use crate::{
    bounds::GRAVITY,
    checked::finite,
    error::SceneError,
    geometry::{Numbers, norm},
};

/// A load on a block: it does not change while the block stands, and in motion keeps its direction while the point where it acts
/// goes with the block.
#[derive(Debug, Clone, PartialEq)]
pub struct Load<V> {
    /// Unique in the scene.
    pub name: String,
    /// N, world axes.
    pub force: V,
    /// Where the force acts, in the block's frame, metres: its origin is the centre of mass.
    pub at: V,
    /// N m beside the force, about the axes of the world; in the plane only the last entry is used.
    pub moment: [f64; 3],
}

/// What is said of a load that is added.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoadOptions<V> {
    /// Without one it is "load" and a number.
    pub name: Option<String>,
    /// N, world axes.
    pub force: V,
    /// World coordinates, metres; without a point the force acts in the middle of the shape.
    pub at: Option<V>,
    /// N m beside the force.
    pub moment: [f64; 3],
}

/// Gravity that a scene can have.
pub(crate) fn check_gravity<V: Numbers>(gravity: &V) -> Result<(), SceneError> {
    for (axis, &value) in gravity.as_ref().iter().enumerate() {
        finite(format_args!("the scene's gravity[{axis}]"), value)?;
    }
    if gravity.as_ref().iter().any(|&value| value != 0.0) {
        GRAVITY.check("the size of the scene's gravity", norm(gravity.as_ref()))?;
    }
    Ok(())
}
