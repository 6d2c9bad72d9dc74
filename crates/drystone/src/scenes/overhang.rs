//! Stacks of equal blocks whose balance is known in closed form.
//!
//! M. Paterson and U. Zwick, "Overhang", American Mathematical Monthly 116 (2009): frictionless
//! blocks of length 1, rows shifted by half a block. In rows of touching blocks the sides bear
//! nothing: an end block has nothing to push back, so by induction no block does.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, integer, number};
use crate::error::SceneError;
use crate::scene::Scene;

/// Height of the blocks, metres. Without friction all forces are vertical: it plays no part.
const HEIGHT: f64 = 0.5;

pub(super) const HARMONIC_STACK: SceneEntry = SceneEntry {
    name: "harmonic_stack",
    summary: "blocks of length 1 reaching over a table's edge, at the limit for factor 1",
    parameters: &[
        integer("n", 10, [1, 10_000], "blocks"),
        number("overhang_factor", 1.0, [0.0, 1.9], "overhang as a share of the limit H_n / 2"),
        friction(0.0),
    ],
    make: |given| harmonic_stack(given.size(0), given.number(1), given.number(2)).map(Into::into),
};

pub(super) const DIAMOND: SceneEntry = SceneEntry {
    name: "diamond",
    summary: "rows of 1, 2, ..., m, ..., 2, 1 blocks: stands without friction for m <= 4",
    parameters: &[integer("m", 4, [1, 300], "blocks in the longest row"), friction(0.0)],
    make: |given| diamond(given.size(0), given.number(1)).map(Into::into),
};

pub(super) const INVERTED_TRIANGLE: SceneEntry = SceneEntry {
    name: "inverted_triangle",
    summary: "rows of 1, 2, ..., rows blocks from the bottom: falls without friction from 3 rows",
    parameters: &[integer("rows", 3, [1, 300], "rows"), friction(0.0)],
    make: |given| inverted_triangle(given.size(0), given.number(1)).map(Into::into),
};

/// `n` blocks over the edge of a table, which ends at x = 0. The i-th from the top extends
/// `overhang_factor` / (2 i) beyond the block below it, so that the top one reaches
/// `overhang_factor` * H_n / 2. A factor of 1 is the limit: beyond it the stack falls.
pub fn harmonic_stack(n: usize, overhang_factor: f64, friction: f64) -> Result<Scene, SceneError> {
    HARMONIC_STACK.check(&[n as f64, overhang_factor, friction])?;
    let mut builder = Builder::new(friction)?;
    builder.ground("table", -2.0, 0.0, 1.0)?;
    let mut reach = 0.0;
    for level in 0..n {
        let from_top = (n - level) as f64;
        reach += 0.5 * overhang_factor / from_top;
        builder.block([reach - 0.5, (level as f64 + 0.5) * HEIGHT], [1.0, HEIGHT])?;
    }
    Ok(builder.finish())
}

/// The m-diamond: symmetric rows of 1, 2, ..., m, ..., 2, 1 blocks, m^2 in all, the lowest one
/// wholly on the table.
pub fn diamond(m: usize, friction: f64) -> Result<Scene, SceneError> {
    DIAMOND.check(&[m as f64, friction])?;
    symmetric_rows((1..=m).chain((1..m).rev()), friction)
}

/// Rows of 1, 2, ..., `rows` blocks from the bottom, the lowest one wholly on the table.
pub fn inverted_triangle(rows: usize, friction: f64) -> Result<Scene, SceneError> {
    INVERTED_TRIANGLE.check(&[rows as f64, friction])?;
    symmetric_rows(1..=rows, friction)
}

/// Rows of touching blocks, each centred on x = 0, from the table upwards.
fn symmetric_rows(lengths: impl Iterator<Item = usize>, friction: f64) -> Result<Scene, SceneError> {
    let mut builder = Builder::new(friction)?;
    builder.ground("table", -1.0, 1.0, 1.0)?;
    for (row, blocks) in lengths.enumerate() {
        let first = -0.5 * (blocks as f64 - 1.0);
        for k in 0..blocks {
            let center = [first + k as f64, (row as f64 + 0.5) * HEIGHT];
            builder.block(center, [1.0, HEIGHT])?;
        }
    }
    Ok(builder.finish())
}
