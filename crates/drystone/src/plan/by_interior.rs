//! Tests by the interior-point method, from nothing: where pivots from the sub-assembly before take longer.
//!
//! Rings of a dome are such structures: a voussoir more changes how all the others are held, and a ring that is not closed rests on
//! friction and on one hand. The method's iterations are as many there as anywhere.

use super::stability::{TestOutcome, Tested, collapse_of};
use crate::{
    formulate::{Assembly, BlockSet, Constrained, FrictionCone},
    proof::proved,
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
    let proved = proved(assembly, &free, &motion, &forces, cone, found.end == End::AtRest);
    let falls = proved.falls();
    let collapse = falls.then(|| collapse_of(assembly, proved.falling));
    let outcome = TestOutcome { stands: proved.stands, borderline: false, pivots: 0 };
    (proved.stands || falls).then_some(Tested { outcome, collapse })
}
