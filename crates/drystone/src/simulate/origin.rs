//! The point from which a world measures places.
//!
//! A double resolves 1e-9 m at 5e6 m, where map coordinates are: far more than what a block at rest may move, so that nothing
//! there would ever come to rest. A world therefore keeps places relative to a point amid its bodies. That point is a multiple
//! of [`GRAIN`] on every axis, so that to subtract it rounds nothing: a place is a multiple of its own last bit, and so is the
//! point, unless the bodies are as far from one another as from the world's origin. What is asked of the world, and what it says,
//! is in the coordinates of the scene.

use super::kinematics::{Kinematics, is_zero};
use crate::{
    geometry::{Numbers, Shape, plus_times},
    scene::{Body, SceneOf},
};

/// Metres, a power of two. Scenes about a point nearer to the origin than half of it keep their coordinates: a double resolves
/// 1e-13 m there.
const GRAIN: f64 = 1024.0;

/// The multiple of [`GRAIN`] nearest to the middle of the bodies' places, on every axis.
pub(super) fn origin_of<S: Shape>(scene: &SceneOf<S>) -> S::Vector {
    let mut origin = S::Vector::default();
    for (axis, entry) in origin.as_mut().iter_mut().enumerate() {
        let places = scene.bodies().iter().map(|body: &Body<S>| S::place(&body.pose).as_ref()[axis]);
        let ends = places.fold(None, |ends: Option<[f64; 2]>, x| {
            let [low, high] = ends.unwrap_or([x, x]);
            Some([low.min(x), high.max(x)])
        });
        // Plus zero, so that no zero is negative.
        *entry = ends.map_or(0.0, |[low, high]| GRAIN * ((0.5 * low + 0.5 * high) / GRAIN).round() + 0.0);
    }
    origin
}

/// The scene moved by `sign` times the origin: to the bit the same where that is zero.
pub(super) fn moved<S: Shape>(mut scene: SceneOf<S>, sign: f64, origin: &S::Vector) -> SceneOf<S> {
    if is_zero(origin) {
        return scene;
    }
    for i in 0..scene.bodies().len() {
        let pose = scene.bodies()[i].pose;
        scene.set_pose(i, S::placed(pose, plus_times(S::place(&pose), sign, origin)));
    }
    scene
}

/// A point that was measured from the origin, in the coordinates of the scene.
pub(super) fn in_scene<V: Numbers>(point: V, origin: &V) -> V {
    if is_zero(origin) { point } else { plus_times(point, 1.0, origin) }
}

/// The same of a place: only its first numbers are coordinates.
pub(super) fn place_in_scene<S: Kinematics>(mut place: S::Place, origin: &S::Vector) -> S::Place {
    if !is_zero(origin) {
        place.as_mut().iter_mut().zip(origin.as_ref()).for_each(|(x, origin)| *x += origin);
    }
    place
}
