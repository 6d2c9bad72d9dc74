//! Blocks of a random stack, and who says which of them stay.

use crate::{error::SceneError, scene::Scene, scenes::builder::Builder};

/// Steps per metre of all lengths, so that coordinates are exact in binary and tops that look
/// level are.
pub(super) const STEPS: f64 = 1024.0;

/// Which blocks stay where they were dropped.
pub(super) trait Rule {
    /// Whether the stack stands with a block on it.
    fn stands(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError>;

    /// Whether the block just asked about stands on what lies lower than it. If not, it needs a counterweight that lies
    /// higher.
    fn stands_on_lower(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError>;

    /// The block just asked about stays.
    fn keep(&mut self) {}
}

/// Blocks on the ground, without friction.
pub(super) fn scene_of<'a>(ground: i64, blocks: impl Iterator<Item = &'a Placed>) -> Result<Scene, SceneError> {
    let mut builder = Builder::new(0.0)?;
    lay_ground(&mut builder, ground)?;
    for block in blocks {
        block.add_to(&mut builder)?;
    }
    Ok(builder.finish())
}

/// A block on the stack, in steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub left: i64,
    pub bottom: i64,
    pub width: i64,
    pub height: i64,
}

impl Placed {
    pub fn is_lower_than(&self, other: &Self) -> bool {
        2 * self.bottom + self.height < 2 * other.bottom + other.height
    }

    /// Whether they touch, or nearly.
    pub fn is_near(&self, other: &Self) -> bool {
        self.left <= other.left + other.width + 1
            && other.left <= self.left + self.width + 1
            && self.bottom <= other.bottom + other.height + 1
            && other.bottom <= self.bottom + self.height + 1
    }

    pub fn add_to(&self, builder: &mut Builder) -> Result<(), SceneError> {
        let metres = |steps: i64| steps as f64 / STEPS;
        let center = [metres(2 * self.left + self.width) / 2.0, metres(2 * self.bottom + self.height) / 2.0];
        builder.block(center, [metres(self.width), metres(self.height)])
    }
}

pub(super) fn lay_ground(builder: &mut Builder, width: i64) -> Result<(), SceneError> {
    builder.ground("ground", 0.0, width as f64 / STEPS, 0.5)
}
