//! Verdicts on what bears by straight pressure, block by block.

use super::verdict::{Verdict, standing};
use crate::{
    formulate::{Assembly, BlockSet},
    takedown::Takedown,
};

/// That it stands, if every block bears, proved by what shares nothing with the forces' computation.
pub(super) fn check(assembly: &Assembly, blocks: &BlockSet) -> Option<Verdict> {
    standing(assembly, blocks, Takedown::of_bearing(assembly, blocks)?.forces(assembly, blocks)?)
}
