//! How near is a touch.

use crate::{
    geometry::Shape,
    scene::{Body, SceneOf},
};

/// Default contact tolerance as a share of the narrower block's width.
pub const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The contact tolerance of a pair, metres.
pub(crate) fn pair_tolerance<S: Shape>(scene: &SceneOf<S>, a: &Body<S>, b: &Body<S>) -> f64 {
    tolerance_of(scene, a).min(tolerance_of(scene, b))
}

/// The largest contact tolerance a block can have in any pair, metres.
pub(crate) fn tolerance_of<S: Shape>(scene: &SceneOf<S>, body: &Body<S>) -> f64 {
    let derived = RELATIVE_TOLERANCE * body.shape.width();
    scene.contact_tolerance().unwrap_or(derived)
}
