//! Generators: unit force directions that span each contact's friction cone, as sparse wrench columns.

use super::part::{Components, Part};
use crate::contact::Contact;

/// Force and moment of a unit generator on one movable block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Index among the movable blocks.
    pub block: usize,
    /// N and N m for a generator of 1 N.
    pub value: Components,
}

/// One unit direction of one contact's friction cone. Its wrenches are computed when they are asked for
/// ([`Assembly::wrenches`](super::Assembly::wrenches)): kept, they would be most of what a large assembly takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generator {
    contact: u32,
    /// Of the contact's two bodies: their numbers among the movable blocks, or `FIXED`.
    blocks: [u32; 2],
    /// Unit direction of the force on the second body; the first body feels its opposite.
    pub direction: [f64; 3],
}

const FIXED: u32 = u32::MAX;

impl Generator {
    /// `blocks` are those of the contact's bodies that move.
    pub(super) fn new(contact: usize, blocks: [Option<usize>; 2], direction: [f64; 3]) -> Self {
        let blocks = blocks.map(|block| block.map_or(FIXED, |block| block as u32));
        Self { contact: contact as u32, blocks, direction }
    }

    /// Index of the contact.
    pub fn contact(&self) -> usize {
        self.contact as usize
    }

    /// The movable blocks that it acts on, that of the contact's first body before that of the second.
    pub fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        self.blocks.into_iter().filter(|&block| block != FIXED).map(|block| block as usize)
    }

    /// Its wrenches on these blocks: force and moment for 1 N. `part` is the body of a block.
    pub(super) fn wrenches<'a>(
        self,
        contact: &'a Contact,
        part: impl Fn(usize) -> &'a Part + 'a,
    ) -> impl Iterator<Item = Wrench> + 'a {
        [(0, -1.0), (1, 1.0)].into_iter().filter(move |&(side, _)| self.blocks[side] != FIXED).map(
            move |(side, sign)| {
                let block = self.blocks[side] as usize;
                let force = self.direction.map(|d| sign * d);
                Wrench { block, value: part(block).wrench(force, contact.point) }
            },
        )
    }
}
