//! Five blocks in which the order of removal matters, after the paper's Fig. 5.

use super::builder::Builder;
use super::entry::{SceneEntry, friction};
use crate::error::SceneError;
use crate::scene::Scene;

pub(super) const ENTRY: SceneEntry = SceneEntry {
    name: "five_blocks",
    summary: "five blocks in which the order of removal matters",
    parameters: &[friction(0.0)],
    make: |given| five_blocks(given.number(0)).map(Into::into),
};

/// Two piers, a plank across them, a load and a counterweight:
///
/// ```text
///      ________      _________
///     |   5    |    |    4    |
///     |________|____|____ ____|
///     |________3_________|
///      |      1    |  |     2    |
///   ---+-----------+--+----------+---
/// ```
///
/// The plank's centre of mass is beyond pier 1. So without pier 2 it falls, unless the
/// counterweight 5 holds it and the load 4 is gone: {1, 3, 5} stands, {1, 3} and {1, 3, 4, 5}
/// fall. Taking 4 and then 2 away leads to {1, 3, 5}, from which no order goes on.
pub fn five_blocks(friction: f64) -> Result<Scene, SceneError> {
    ENTRY.check(&[friction])?;
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -1.5, 3.0, 0.5)?;
    // Centre of mass of {3, 5} at x = 1/3 m, of {3, 4, 5} at 0.6 m: pier 1 ends at 0.5 m.
    builder.block([0.0, 0.5], [1.0, 1.0])?;
    builder.block([1.7, 0.5], [1.0, 1.0])?;
    builder.block([0.6, 1.2], [2.0, 0.4])?;
    builder.block([1.4, 1.7], [0.8, 0.6])?;
    builder.block([0.0, 1.8], [0.8, 0.8])?;
    Ok(builder.finish())
}
