//! Which method is asked first, and how long, where nothing is known yet.
//!
//! ```text
//! load takedown     every block bears by straight pressure      in proportion to the blocks
//! elastic layers    none parts or slides                        one factor
//! pivots            forces within the cones, block by block     quick where blocks are few
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

/// Of more blocks pivots from nothing take longer than the interior-point method, where the takedown has failed.
const SMALL: usize = 32;

/// A structure of few blocks is worth as many pivots as one with so many more.
const FIRST_BLOCKS: usize = 16;

/// Effort for each block of pivots from nothing, of those that most small structures take.
const FROM_NOTHING_IN_PLANE: usize = 600;
const FROM_NOTHING_IN_SPACE: usize = 8_000;

/// Effort for each block that takes as long as the interior-point method.
const WORTH_IN_PLANE: usize = 2_000;
const WORTH_IN_SPACE: usize = 50_000;

/// Factors of the interior-point method from nothing, of most structures.
const FACTORS: usize = 12;

/// A change is worth so many times more pivots than a verdict from nothing: the basis that is kept is lost with it, from which the
/// changes that follow take a thousandth of that.
const OF_A_CHANGE: usize = 8;

/// What is within rounding of a limit is worth so many times more: below a second for what has a thousand blocks.
const AT_A_LIMIT: usize = 32;

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

    /// Whether elastic layers, which take one factor, come before pivots. In the plane these are as quick where they find something; of
    /// many blocks the interior-point method comes next, of which one factor in vain is a fifth.
    pub fn elastic_first(self) -> bool {
        !self.in_plane() && self.pivots_next()
    }

    /// Whether pivots from nothing are made where the takedown has failed: of many blocks they find little sooner than the
    /// interior-point method does.
    pub fn pivots_next(self) -> bool {
        self.blocks <= SMALL
    }

    /// Effort of pivots from nothing before the interior-point method takes its turn.
    pub fn effort_from_nothing(self) -> usize {
        let of_a_block = if self.in_plane() { FROM_NOTHING_IN_PLANE } else { FROM_NOTHING_IN_SPACE };
        of_a_block * (self.blocks + FIRST_BLOCKS)
    }

    /// Effort beyond which the interior-point method takes less time than the pivots that follow.
    pub fn effort_of_interior_point(self) -> usize {
        let of_a_block = if self.in_plane() { WORTH_IN_PLANE } else { WORTH_IN_SPACE };
        of_a_block * (self.blocks + FIRST_BLOCKS)
    }

    /// Effort of pivots where the interior-point method proves nothing: within rounding of a limit their digits may.
    pub fn effort_at_a_limit(self) -> usize {
        AT_A_LIMIT * self.effort_of_interior_point()
    }

    /// Effort that takes as long as some factors of that method.
    pub fn effort_of_factors(self, factors: usize) -> usize {
        self.effort_of_interior_point() / FACTORS * factors
    }

    /// The same where pivots start from what is kept.
    pub fn effort_of_a_change(self) -> usize {
        OF_A_CHANGE * self.effort_of_interior_point()
    }
}
