//! Which method is asked first, and how long, where nothing is known yet.
//!
//! ```text
//! load takedown     every block bears by straight pressure      in proportion to the blocks
//! elastic layers    none parts or slides                        one factor
//! pivots            forces within the cones, block by block     quick where most bear upright
//! interior point    any                                         ten to fifty factors
//! ```
//!
//! A method that may fail comes before a dearer one only as far as it costs a small part of that. Effort is counted
//! ([`ConeSolver::effort`](drystone_lcp::cone::ConeSolver::effort)), never timed: the same input takes the same way everywhere. Measured:
//! docs/theory/interior-point.md.

use crate::formulate::Assembly;

/// From how many unknowns a body has, and how many bodies there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ladder {
    size: usize,
    blocks: usize,
}

/// Of more blocks pivots from nothing pay only where what is put up bears upright.
const SMALL: usize = 32;

/// Blocks in the plane from which on the memory for the columns of all generators is worth saving: up to there two pivots a block
/// take as long as its takedown.
const LARGE_IN_PLANE: usize = 20_000;

/// A structure of few blocks is worth as many pivots as one with so many more.
const FIRST_BLOCKS: usize = 16;

/// Twice the effort of a block that bears upright in the plane, of which columns take 140 at most, walls and pyramids 320. Arches, and
/// random stacks from 80 blocks on, take longer than the interior-point method.
const UPRIGHT_IN_PLANE: usize = 600;

/// In space, where the takedown has failed before.
const UPRIGHT_IN_SPACE: usize = 8_000;

/// Effort for each block that takes as long as the interior-point method.
const WORTH_IN_PLANE: usize = 2_000;
const WORTH_IN_SPACE: usize = 50_000;

/// A change is worth so many times more pivots than a verdict from nothing, about as long as the interior-point method itself
/// takes: what is kept is lost with it.
const OF_A_CHANGE: usize = 8;

/// Most rows of a complementarity problem that pivots solve as soon as the interior-point method.
pub(crate) const FEW_ROWS: usize = 200;

impl Ladder {
    /// Of so many blocks of so many unknowns each.
    pub fn new(size: usize, blocks: usize) -> Self {
        Self { size, blocks }
    }

    /// Of so many blocks of an assembly.
    pub fn of(assembly: &Assembly, blocks: usize) -> Self {
        Self::new(assembly.components().len(), blocks)
    }

    fn in_plane(self) -> bool {
        self.size == 3
    }

    /// Whether the takedown comes before pivots that have the axes of the cones among their columns.
    pub fn takedown_first(self) -> bool {
        !self.in_plane() || self.blocks >= LARGE_IN_PLANE
    }

    /// The same before pivots that have the edges only, which take several of these for a straight force.
    pub fn takedown_before_edges(self) -> bool {
        !self.in_plane() || self.blocks > SMALL
    }

    /// Whether elastic layers, which take one factor, come before pivots. In the plane these are as quick where they find something; of
    /// many blocks the interior-point method comes next, of which one factor in vain is a fifth.
    pub fn elastic_first(self) -> bool {
        !self.in_plane() && self.is_small()
    }

    /// Whether pivots from nothing are made where the takedown, if it was asked, has failed: in space they find little else sooner
    /// than the interior-point method does.
    pub fn pivots_next(self) -> bool {
        self.in_plane() || self.is_small()
    }

    /// Whether it has so few blocks that pivots go on where what is put up falls on the way.
    pub fn is_small(self) -> bool {
        self.blocks <= SMALL
    }

    /// Effort of pivots from nothing before the interior-point method takes its turn.
    pub fn effort_of_upright(self) -> usize {
        let of_a_block = if self.in_plane() { UPRIGHT_IN_PLANE } else { UPRIGHT_IN_SPACE };
        of_a_block * (self.blocks + FIRST_BLOCKS)
    }

    /// Effort beyond which the interior-point method takes less time than the pivots that follow.
    pub fn effort_of_interior_point(self) -> usize {
        let of_a_block = if self.in_plane() { WORTH_IN_PLANE } else { WORTH_IN_SPACE };
        of_a_block * (self.blocks + FIRST_BLOCKS)
    }

    /// The same where pivots start from what is kept.
    pub fn effort_of_a_change(self) -> usize {
        OF_A_CHANGE * self.effort_of_interior_point()
    }
}
