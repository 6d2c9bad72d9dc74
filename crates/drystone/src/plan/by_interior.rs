//! Tests by the interior-point method: where pivots from the sub-assembly before take longer.
//!
//! Rings of a dome are such structures: a voussoir more changes how all the others are held, and a ring that is not closed rests on
//! friction and on one hand. The method's iterations are as many there as anywhere. Most answers take few of them: what falls
//! does so near the new block, which a small problem says, and what stands is held by forces near those of the structure before.

use super::collapse::Collapse;
use super::stability::{TestOutcome, Tested, collapse_of};
use super::touching::Touching;
use crate::{
    formulate::{Assembly, BlockSet, Constrained, FrictionCone},
    proof::proved,
};
use drystone_lcp::interior::End;
use std::rc::Rc;

/// Forces along all generators, positive where they are known.
pub(super) type Forces = Rc<[f64]>;

/// A block put on a sub-assembly, some of whose blocks are held.
#[derive(Clone, Copy)]
pub(super) struct Put<'a> {
    pub blocks: &'a BlockSet,
    pub held: &'a [usize],
    pub added: usize,
}

/// What was found, and forces that hold it if it stands.
pub(super) struct Answer {
    pub tested: Tested,
    pub forces: Option<Forces>,
}

/// What the interior-point method proves of a sub-assembly, first of the new block and what it touches, then by forces near those
/// of the one before. None if it proves neither that it stands nor that it falls.
pub(super) fn by_interior_point(
    assembly: &Assembly,
    touching: &Touching,
    put: Put<'_>,
    before: Option<&Forces>,
) -> Option<Answer> {
    match falls_nearby(assembly, touching, put) {
        Some(collapse) => Some(Answer { tested: Tested::falling(collapse), forces: None }),
        None => solved(assembly, put.blocks, put.held, before),
    }
}

fn solved(assembly: &Assembly, blocks: &BlockSet, held: &[usize], before: Option<&Forces>) -> Option<Answer> {
    let (mut hands, mut free) = (BlockSet::empty(assembly.blocks()), blocks.clone());
    for &block in held {
        hands.insert(block);
        free.remove(block);
    }
    let cone = FrictionCone::Pyramid;
    let space = assembly.held_body_space(blocks, &hands, cone).of_moving();
    let judged = |Constrained { motion, forces, found }: Constrained| {
        let proved = proved(assembly, &free, &motion, &forces, cone, found.end == End::AtRest);
        let falls = proved.falls();
        let collapse = falls.then(|| collapse_of(assembly, proved.falling));
        let outcome = TestOutcome { stands: proved.stands, borderline: false, pivots: 0 };
        let forces = proved.stands.then(|| space.magnitudes(&found).into());
        (proved.stands || falls).then_some(Answer { tested: Tested { outcome, collapse }, forces })
    };
    let near = before.and_then(|before| judged(space.rest_near(before)?));
    near.or_else(|| judged(space.solve()))
}

/// How a block put up last falls, alone or with those that it touches, while all others stay where they are: a small problem,
/// whatever the size of the whole.
fn falls_nearby(assembly: &Assembly, touching: &Touching, put: Put<'_>) -> Option<Collapse> {
    let near = touching.neighbours(put.added).iter().copied().filter(|&block| put.blocks.contains(block));
    let near: Vec<usize> = near.chain([put.added]).collect();
    falls_among(assembly, touching, put, &[put.added]).or_else(|| falls_among(assembly, touching, put, &near))
}

/// How some blocks fall, those that are held left out, while all others stay where they are.
pub(super) fn falls_among(assembly: &Assembly, touching: &Touching, put: Put<'_>, some: &[usize]) -> Option<Collapse> {
    let mut still = BlockSet::empty(assembly.blocks());
    let moving: Vec<usize> = some.iter().copied().filter(|block| !put.held.contains(block)).collect();
    let around = moving.iter().flat_map(|&block| touching.neighbours(block)).copied();
    around.filter(|&block| put.blocks.contains(block)).for_each(|block| still.insert(block));
    moving.iter().for_each(|&block| still.remove(block));
    let mut there = still.clone();
    moving.iter().for_each(|&block| there.insert(block));
    let still: Vec<usize> = still.iter().collect();
    if moving.is_empty() { None } else { solved(assembly, &there, &still, None)?.tested.collapse }
}
