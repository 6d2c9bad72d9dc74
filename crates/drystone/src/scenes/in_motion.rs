//! Scenes to be simulated: the paper's Figs. 1 and 4, and six on which simulators are compared.
//!
//! The paper shows pictures and says which blocks move when, not where they are; these are built to do what it describes.
//! Loomis and Balkcom, "Computation reuse for rigid-body dynamics", ICRA 2006.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, seed};
use crate::error::SceneError;
use crate::scene::Scene;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

pub(super) const FALLING_COLUMN: SceneEntry = SceneEntry {
    name: "falling_column",
    summary: "seven blocks of which the upper ones fall one after the other, after Fig. 1",
    parameters: &[friction(0.2)],
    make: |given| falling_column(given.number(0)).map(Into::into),
};

pub(super) const THREE_SEGMENTS: SceneEntry = SceneEntry {
    name: "three_segments",
    summary: "two blocks move, then five, then all, after Fig. 4",
    parameters: &[friction(0.3)],
    make: |given| three_segments(given.number(0)).map(Into::into),
};

pub(super) const COL20: SceneEntry = SceneEntry {
    name: "col20",
    summary: "a column of 20 unit squares on the ground, to be simulated",
    parameters: &[friction(0.5)],
    make: |given| standing_column(&COL20, 20, given.number(0)).map(Into::into),
};

pub(super) const COL50: SceneEntry = SceneEntry {
    name: "col50",
    summary: "a column of 50 unit squares on the ground, to be simulated",
    parameters: &[friction(0.5)],
    make: |given| standing_column(&COL50, 50, given.number(0)).map(Into::into),
};

pub(super) const PYR13: SceneEntry = SceneEntry {
    name: "pyr13",
    summary: "the pyramid of 13 rows, to be simulated",
    parameters: &[friction(0.5)],
    make: |given| super::pyramid(13, given.number(0)).map(Into::into),
};

pub(super) const FALL7: SceneEntry = SceneEntry {
    name: "fall7",
    summary: "five blocks stand still while two topple off them, to be simulated",
    parameters: &[friction(0.5)],
    make: |given| fall7(given.number(0)).map(Into::into),
};

pub(super) const WALL84: SceneEntry = SceneEntry {
    name: "wall84",
    summary: "a wall of 12 courses of 7 bricks of random widths, to be simulated",
    parameters: &[seed(1, "draws the widths"), friction(0.5)],
    make: |given| wall84(given.integer(0), given.number(1)).map(Into::into),
};

pub(super) const DROP84: SceneEntry = SceneEntry {
    name: "drop84",
    summary: "84 random boxes dropped on the ground, to be simulated",
    parameters: &[seed(1, "draws sizes and angles"), friction(0.5)],
    make: |given| drop84(given.integer(0), given.number(1)).map(Into::into),
};

/// Five blocks, a plank on them that reaches beyond, and on it a tall block that leans over.
///
/// ```text
///                    / /
///                   /7/           7 falls over and comes to lie on the end of 6;
///      ____________/_/__          then 6 tips with it, and both fall off;
///     |________6________|         1 to 5 stand still all the time
///    |______5______|
///         ...
///    |______1______|
/// ```
pub fn falling_column(friction: f64) -> Result<Scene, SceneError> {
    FALLING_COLUMN.check(&[friction])?;
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -10.0, 10.0, 1.0)?;
    for level in 0..5 {
        builder.block([0.0, 0.6 * f64::from(level) + 0.3], [2.0, 0.6])?;
    }
    builder.block([0.7, 3.1], [2.4, 0.2])?;
    // Its lower right corner stands on the plank.
    let (size, lean, foot) = ([0.3, 1.2], 0.9_f64, [1.2, 3.2]);
    let (sin, cos) = lean.sin_cos();
    let center =
        [foot[0] - 0.5 * size[0] * cos + 0.5 * size[1] * sin, foot[1] + 0.5 * size[0] * sin + 0.5 * size[1] * cos];
    builder.turned_block(center, size, -lean)?;
    Ok(builder.finish())
}

/// Five blocks of 2 m by 1 m on the ground.
fn base_of_five(friction: f64) -> Result<Builder, SceneError> {
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -10.0, 10.0, 1.0)?;
    for level in 0..5 {
        builder.block([0.0, level as f64 + 0.5], [2.0, 1.0])?;
    }
    Ok(builder)
}

/// Seven slabs on the ground, like dominoes in three groups. `a` leans on `b` and pushes it over; `b` falls on
/// `c`, `d` and `e`, which stand side by side, and these on `f` and `g`.
///
/// ```text
///      a   b      c d e    f g
///       / |_|    |_|_|_|  |_|_|
///      /  |_|    |_|_|_|  |_|_|
/// ```
pub fn three_segments(friction: f64) -> Result<Scene, SceneError> {
    THREE_SEGMENTS.check(&[friction])?;
    let (width, height, lean, gap) = (0.0625, 0.5, 0.4_f64, 0.075);
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -2.0, 3.0, 0.5)?;
    // The upper right corner of a touches the left side of b, within the contact tolerance.
    let (sin, cos) = lean.sin_cos();
    let reach = 0.5 * (height * sin + width * cos);
    builder.leaning_block("a", [-0.5 * width - reach, 0.5 * (height * cos + width * sin)], [width, height], -lean)?;
    let mut left = -0.5 * width;
    for (group, names) in [["b"].as_slice(), &["c", "d", "e"], &["f", "g"]].into_iter().enumerate() {
        left += if group > 0 { gap } else { 0.0 };
        for name in names {
            builder.leaning_block(name, [left + 0.5 * width, 0.5 * height], [width, height], 0.0)?;
            left += width;
        }
    }
    Ok(builder.finish())
}

fn standing_column(entry: &SceneEntry, blocks: usize, friction: f64) -> Result<Scene, SceneError> {
    entry.check(&[friction])?;
    super::column(blocks + 1, friction)
}

/// A column of 20 unit squares on the ground.
pub fn col20(friction: f64) -> Result<Scene, SceneError> {
    standing_column(&COL20, 20, friction)
}

/// A column of 50 unit squares on the ground.
pub fn col50(friction: f64) -> Result<Scene, SceneError> {
    standing_column(&COL50, 50, friction)
}

/// The pyramid of 91 blocks, with friction.
pub fn pyr13(friction: f64) -> Result<Scene, SceneError> {
    PYR13.check(&[friction])?;
    super::pyramid(13, friction)
}

/// Five blocks of 2 m by 1 m on each other, and on their edge two unit squares whose common centre of mass is beyond it.
pub fn fall7(friction: f64) -> Result<Scene, SceneError> {
    FALL7.check(&[friction])?;
    let mut builder = base_of_five(friction)?;
    builder.block([1.1, 5.5], [1.0, 1.0])?;
    builder.block([1.1, 6.5], [1.0, 1.0])?;
    Ok(builder.finish())
}

/// Places per metre of what is drawn at random: coordinates are then exact in binary.
const STEPS: f64 = 1024.0;

/// A number from `low` to `high` in steps of 2^-10.
fn drawn(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    f64::from(random.random_range((low * STEPS) as i32..=(high * STEPS) as i32)) / STEPS
}

/// 12 courses of 7 bricks, half a metre high and 0.75 m to 1.25 m wide.
pub fn wall84(seed: u64, friction: f64) -> Result<Scene, SceneError> {
    WALL84.check(&[seed as f64, friction])?;
    let mut random = Pcg64::seed_from_u64(seed);
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -5.0, 5.0, 1.0)?;
    for course in 0..12 {
        let widths: Vec<f64> = (0..7).map(|_| drawn(&mut random, 0.75, 1.25)).collect();
        let mut left = -0.5 * widths.iter().sum::<f64>();
        for width in widths {
            builder.block([left + 0.5 * width, 0.5 * f64::from(course) + 0.25], [width, 0.5])?;
            left += width;
        }
    }
    Ok(builder.finish())
}

/// 84 boxes of 0.4 m to 1 m, turned at random, in 7 layers of 12 above the ground.
pub fn drop84(seed: u64, friction: f64) -> Result<Scene, SceneError> {
    DROP84.check(&[seed as f64, friction])?;
    let mut random = Pcg64::seed_from_u64(seed);
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -40.0, 40.0, 1.0)?;
    for layer in 0..7 {
        for place in 0..12 {
            let size = [drawn(&mut random, 0.4, 1.0), drawn(&mut random, 0.4, 1.0)];
            let stray = drawn(&mut random, -0.1, 0.1);
            let angle = drawn(&mut random, -0.5, 0.5);
            // Boxes are within 0.71 m of their centres, which are at least 1.5 m apart.
            let center = [1.7 * (f64::from(place) - 5.5) + stray, 1.0 + 1.6 * f64::from(layer)];
            builder.turned_block(center, size, angle)?;
        }
    }
    Ok(builder.finish())
}
