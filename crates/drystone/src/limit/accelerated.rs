//! The loads under which a structure stands if it has a margin.

use super::margin::{Loads, horizontal, sideways, unit_of};
use crate::{
    error::SceneError,
    formulate::{Assemble, Assembly},
    scene::SceneOf,
};
use std::f64::consts::PI;

/// Accelerations all around in space: corners of a polygon around the circle, which are 2 % further out.
const AROUND: u32 = 16;

/// A structure under horizontal accelerations that enclose all those of a size (over gravity): to both sides in the plane, all around
/// in space. What stands under each of them stands under all that they enclose, for loads are linear in the acceleration.
///
/// # Errors
/// [`SceneError::NoGravity`].
pub(crate) fn accelerated<S: Assemble>(
    assembly: &Assembly,
    scene: &SceneOf<S>,
    size: f64,
) -> Result<Vec<Assembly>, SceneError> {
    let (axes, blocks) = (horizontal(unit_of(assembly)?, assembly.in_plane()), assembly.every_block());
    let side = |axis: [f64; 3]| sideways(assembly, scene, &blocks, axis, Loads::Stay);
    let [first, second] = [side(axes[0])?, side(axes[1])?];
    if assembly.in_plane() {
        return Ok([size, -size].map(|factor| assembly.pushed(&first, factor)).into());
    }
    let step = 2.0 * PI / f64::from(AROUND);
    let far = size / (0.5 * step).cos();
    let towards = |k: u32| {
        let (sine, cosine) = (f64::from(k) * step).sin_cos();
        assembly.pushed(&first.plus(cosine, &second, sine), far)
    };
    Ok((0..AROUND).map(towards).collect())
}
