//! The regular planning scenes of the paper's Table I: columns and pyramids.
//!
//! Loomis and Balkcom, "Computation reuse in statics and dynamics problems for assemblies of rigid
//! bodies", ICRA 2006.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, integer};
use crate::error::SceneError;
use crate::scene::Scene;

pub(super) const COLUMN: SceneEntry = SceneEntry {
    name: "column",
    summary: "unit squares on top of each other, the lowest of them fixed",
    parameters: &[integer("n", 50, [1, 1_000_000], "squares, the fixed one included"), friction(0.0)],
    make: |given| column(given.size(0), given.number(1)).map(Into::into),
};

pub(super) const PYRAMID: SceneEntry = SceneEntry {
    name: "pyramid",
    summary: "rows of unit squares in full face contact, each on two of the row below",
    parameters: &[integer("rows", 13, [1, 1000], "rows"), friction(0.0)],
    make: |given| pyramid(given.size(0), given.number(1)).map(Into::into),
};

/// `n` unit squares on top of each other. The lowest is the fixed base ("ground"), so n - 1 can
/// move: the paper's pivot counts, 48 * 49 for 50 squares, follow from that.
pub fn column(n: usize, friction: f64) -> Result<Scene, SceneError> {
    COLUMN.check(&[n as f64, friction])?;
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -0.5, 0.5, 1.0)?;
    for level in 1..n {
        builder.block([0.0, level as f64 - 0.5], [1.0, 1.0])?;
    }
    Ok(builder.finish())
}

/// A pyramid of `rows` (rows + 1) / 2 movable unit squares on a separate fixed ground, numbered
/// row by row from the lower left. Neighbours in a row touch side by side.
pub fn pyramid(rows: usize, friction: f64) -> Result<Scene, SceneError> {
    PYRAMID.check(&[rows as f64, friction])?;
    let mut builder = Builder::new(friction)?;
    let half = 0.5 * rows as f64;
    builder.ground("ground", -half - 1.0, half + 1.0, 1.0)?;
    for row in 0..rows {
        let squares = rows - row;
        let first = -0.5 * (squares as f64 - 1.0);
        for k in 0..squares {
            builder.block([first + k as f64, row as f64 + 0.5], [1.0, 1.0])?;
        }
    }
    Ok(builder.finish())
}
