//! Built-in scenes: the paper's, and structures whose limits are known in closed form.
//!
//! All stand under gravity (0, -9.81) m/s^2, or (0, 0, -9.81) in space, with density 1 kg/m^2 (kg/m^3). Movable blocks are named by
//! numbers from "1", fixed ones by what they are ("ground", "table", "plane"). The planning scenes
//! of the paper (column, pyramid, random stack, five blocks) are frictionless by default.
//!
//! Each scene is a function; [`build`] makes one by name and [`catalogue`] lists them all.

mod arch;
mod builder;
mod entry;
mod five_blocks;
mod in_motion;
mod in_space;
mod overhang;
mod paper_stacks;
mod random_stack;
mod slope;
mod wall;

pub use arch::arch;
pub use entry::{Parameter, ParameterKind, SceneEntry};
pub use five_blocks::five_blocks;
pub use in_motion::{col20, col50, drop84, fall7, falling_column, pyr13, three_segments, wall84};
pub use in_space::{brick_wall, extruded, square_pyramid};
pub use overhang::{diamond, harmonic_stack, inverted_triangle};
pub use paper_stacks::{column, pyramid};
pub use random_stack::{random_stack, random_stack_where};
pub use slope::slope;
pub use wall::wall;

use crate::any_scene::AnyScene;
use crate::error::SceneError;
use crate::suggest::nearest;
use serde_json::Value;
use std::collections::BTreeMap;

/// Every built-in scene, in alphabetical order.
pub fn catalogue() -> &'static [SceneEntry] {
    &[
        arch::ENTRY,
        in_space::BRICK_WALL,
        in_motion::COL20,
        in_motion::COL50,
        paper_stacks::COLUMN,
        overhang::DIAMOND,
        in_motion::DROP84,
        in_motion::FALL7,
        in_motion::FALLING_COLUMN,
        five_blocks::ENTRY,
        overhang::HARMONIC_STACK,
        overhang::INVERTED_TRIANGLE,
        in_motion::PYR13,
        paper_stacks::PYRAMID,
        random_stack::ENTRY,
        slope::ENTRY,
        in_space::SQUARE_PYRAMID,
        in_motion::THREE_SEGMENTS,
        wall::ENTRY,
        in_motion::WALL84,
    ]
}

/// Builds a scene by name. Parameters left out take their defaults; an unknown name, an unknown
/// parameter or a value of the wrong kind or out of range is an error that says what is accepted.
pub fn build(name: &str, parameters: &BTreeMap<String, Value>) -> Result<AnyScene, SceneError> {
    let names = catalogue().iter().map(|entry| entry.name);
    match catalogue().iter().find(|entry| entry.name == name) {
        Some(entry) => entry.build(parameters),
        None => Err(SceneError::UnknownScene {
            name: name.to_owned(),
            nearest: nearest(name, names.clone()),
            known: names.collect::<Vec<_>>().join(", "),
        }),
    }
}
