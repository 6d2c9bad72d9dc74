//! Tests by the interior-point method, from nothing: where pivots from the sub-assembly before take longer.
//!
//! Rings of a dome are such structures: a voussoir more changes how all the others are held, and a ring that is not closed rests on
//! friction and on one hand. The method's iterations are as many there as anywhere.

use super::collapse::Collapse;
use super::stability::{TestOutcome, Tested, collapse_of};
use crate::{
    formulate::{Assembly, BlockSet, Constrained, FrictionCone},
    judgement::MARGIN,
    proof::{accelerations_under, moving, power_of_fall},
};
use drystone_lcp::interior::End;

/// What the interior-point method proves of a sub-assembly, some of whose blocks are held. None if it proves neither that it
/// stands nor that it falls.
pub(super) fn by_interior_point(assembly: &Assembly, blocks: &BlockSet, held: &[usize]) -> Option<Tested> {
    let (mut hands, mut free) = (BlockSet::empty(assembly.blocks()), blocks.clone());
    for &block in held {
        hands.insert(block);
        free.remove(block);
    }
    let cone = FrictionCone::Pyramid;
    let Constrained { motion, forces, found } = assembly.held_body_space(blocks, &hands, cone).solve();
    let tested = |stands, collapse: Option<Collapse>| {
        Some(Tested { outcome: TestOutcome { stands, borderline: false, pivots: 0 }, collapse })
    };
    let at_rest = || moving(assembly, &accelerations_under(assembly, &free, &forces), &forces).is_empty();
    if found.end == End::AtRest && at_rest() {
        return tested(true, None);
    }
    let falling = moving(assembly, &motion, &forces);
    let falls = !falling.is_empty() && power_of_fall(assembly, &motion, &forces, cone) > MARGIN;
    falls.then(|| tested(false, Some(collapse_of(assembly, falling)))).flatten()
}
