//! What the interior-point method proves of a structure, begun from the forces of one nearby.
//!
//! Most answers take little of it: what falls does so near a new block, which a small problem says, and what stands is held by
//! forces near those of the structure before. It is what is asked where pivots from the structure before take longer.

use crate::{
    formulate::{Assembly, BlockSet, Components, Constrained, FrictionCone},
    proof::proved,
};
use drystone_lcp::interior::End;

/// What was found.
pub(crate) enum Nearby {
    /// It stands, with these forces along all generators, positive where they are known.
    Stands(Vec<f64>),
    /// It falls: the blocks that move.
    Falls(Vec<(usize, Components)>),
}

/// What was found, and in how many factors.
pub(crate) struct Solved {
    pub found: Nearby,
    pub factors: usize,
}

/// What the method proves of these blocks, of which some are held, first by forces near those of the structure before. None if it
/// proves neither that they stand nor that they fall.
pub(crate) fn solved(assembly: &Assembly, blocks: &BlockSet, held: &[usize], before: Option<&[f64]>) -> Option<Solved> {
    let (mut hands, mut free) = (BlockSet::empty(assembly.blocks()), blocks.clone());
    for &block in held {
        hands.insert(block);
        free.remove(block);
    }
    let cone = FrictionCone::Pyramid;
    let space = assembly.held_body_space(blocks, &hands, cone).of_moving();
    let judged = |Constrained { motion, forces, found }: Constrained| {
        let proved = proved(assembly, &free, &motion, &forces, cone, found.end == End::AtRest);
        let factors = found.iterations;
        let found = if proved.stands {
            Nearby::Stands(space.magnitudes(&found))
        } else if proved.falls() {
            Nearby::Falls(proved.falling)
        } else {
            return None;
        };
        Some(Solved { found, factors })
    };
    let near = before.and_then(|before| judged(space.rest_near(before)?));
    near.or_else(|| judged(space.solve()))
}

/// A block put on a structure.
#[derive(Clone, Copy)]
pub(crate) struct Put<'a> {
    /// What is there, the new block included.
    pub blocks: &'a BlockSet,
    pub held: &'a [usize],
    pub added: usize,
}

/// How a block put up last falls, alone or with those that it touches, while all others stay where they are: a small problem,
/// whatever the size of the whole. `touched` gives the blocks that one touches.
pub(crate) fn falls_nearby(
    assembly: &Assembly,
    touched: &dyn Fn(usize) -> Vec<usize>,
    put: Put<'_>,
) -> Option<Vec<(usize, Components)>> {
    let near = touched(put.added).into_iter().filter(|&block| put.blocks.contains(block));
    let near: Vec<usize> = near.chain([put.added]).collect();
    falls_among(assembly, touched, put, &[put.added]).or_else(|| falls_among(assembly, touched, put, &near))
}

/// How some blocks fall, those that are held left out, while all others stay where they are.
pub(crate) fn falls_among(
    assembly: &Assembly,
    touched: &dyn Fn(usize) -> Vec<usize>,
    put: Put<'_>,
    some: &[usize],
) -> Option<Vec<(usize, Components)>> {
    let mut still = BlockSet::empty(assembly.blocks());
    let moving: Vec<usize> = some.iter().copied().filter(|block| !put.held.contains(block)).collect();
    let around = moving.iter().flat_map(|&block| touched(block));
    around.filter(|&block| put.blocks.contains(block)).for_each(|block| still.insert(block));
    moving.iter().for_each(|&block| still.remove(block));
    if moving.is_empty() {
        return None;
    }
    let mut there = still.clone();
    moving.iter().for_each(|&block| there.insert(block));
    let still: Vec<usize> = still.iter().collect();
    match solved(assembly, &there, &still, None)?.found {
        Nearby::Falls(motion) => Some(motion),
        Nearby::Stands(_) => None,
    }
}
