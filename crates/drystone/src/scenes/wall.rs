//! A brick wall in running bond.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, integer, seed};
use crate::error::SceneError;
use crate::scene::Scene;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Height of a brick, metres; its length is 1.
const HEIGHT: f64 = 0.5;

/// How far a joint may stray from its place, metres. Two joints above each other are half a brick
/// apart, so that less than a quarter of a brick keeps them from ever meeting.
const STRAY: f64 = 0.2;

pub(super) const ENTRY: SceneEntry = SceneEntry {
    name: "wall",
    summary: "a brick wall in running bond",
    parameters: &[
        integer("rows", 10, [1, 1000], "courses of bricks"),
        integer("columns", 10, [1, 1000], "length of the wall in bricks"),
        seed(0, "0 for even joints; any other draws their places"),
        friction(0.6),
    ],
    make: |g| wall(g.size(0), g.size(1), g.integer(2), g.number(3)).map(Into::into),
};

/// `rows` courses of bricks of 1 m by 0.5 m, each course shifted by half a brick against the one
/// below, with half bricks at both ends of every second course. With a `seed` other than 0 every
/// joint within the wall strays from its place by up to 0.2 m.
pub fn wall(rows: usize, columns: usize, seed: u64, friction: f64) -> Result<Scene, SceneError> {
    ENTRY.check(&[rows as f64, columns as f64, seed as f64, friction])?;
    let mut random = Pcg64::seed_from_u64(seed);
    let end = columns as f64;
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -0.5, end + 0.5, HEIGHT)?;
    for row in 0..rows {
        let first = if row % 2 == 0 { 1.0 } else { 0.5 };
        let joints = (0..columns).map(|k| first + k as f64).filter(|&x| x < end);
        let mut left = 0.0;
        for place in joints.chain([end]) {
            let inside = place < end && seed != 0;
            let right = if inside { place + stray(&mut random) } else { place };
            let center = [0.5 * (left + right), (row as f64 + 0.5) * HEIGHT];
            builder.block(center, [right - left, HEIGHT])?;
            left = right;
        }
    }
    Ok(builder.finish())
}

/// A multiple of 2^-10 m, so that the bricks' coordinates are exact in binary.
fn stray(random: &mut Pcg64) -> f64 {
    let steps = (STRAY * 1024.0) as i32;
    f64::from(random.random_range(-steps..=steps)) / 1024.0
}
