//! A block on an inclined plane.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, number};
use crate::error::SceneError;
use crate::scene::Scene;

pub(super) const ENTRY: SceneEntry = SceneEntry {
    name: "slope",
    summary: "a block on an inclined plane",
    parameters: &[
        number("angle_degrees", 20.0, [-89.0, 89.0], "inclination, degrees, rising to the right"),
        friction(0.5),
        number("width", 1.0, [1e-3, 1e3], "the block's side along the plane, metres"),
        number("height", 1.0, [1e-3, 1e3], "the block's side square to the plane, metres"),
    ],
    make: |g| slope(g.number(0), g.number(1), g.number(2), g.number(3)).map(Into::into),
};

/// A block on a fixed plane through the origin, which rises to the right by `angle_degrees`.
///
/// It slides when tan(angle) > `friction` and topples when tan(angle) > `width` / `height`.
pub fn slope(angle_degrees: f64, friction: f64, width: f64, height: f64) -> Result<Scene, SceneError> {
    ENTRY.check(&[angle_degrees, friction, width, height])?;
    let angle = angle_degrees.to_radians();
    let (sin, cos) = angle.sin_cos();
    let above = |distance: f64| [-sin * distance, cos * distance];
    let depth = 0.5 * width;
    let mut builder = Builder::new(friction)?;
    builder.fixed_box("plane", above(-0.5 * depth), [4.0 * width, depth], angle)?;
    builder.turned_block(above(0.5 * height), [width, height], angle)?;
    Ok(builder.finish())
}
