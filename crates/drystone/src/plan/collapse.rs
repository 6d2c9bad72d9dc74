//! Why a sub-assembly falls, and which others fall for the same reason.
//!
//! If no contact forces hold a sub-assembly U, there is a virtual motion y that opens every contact or keeps it closed
//! (`G' v >= 0` with v = -y) and in which the loads do work (`F' v > 0`): Farkas' lemma. Let K be the blocks that move
//! in it and P those whose load does positive work.
//!
//! *Lemma 1 (the collapse carries over).* The same motion, without the blocks taken away and with the added ones at
//! rest, makes U' fall if no block added to U touches a block of K and the loads of K in U' still do work.
//! *Proof.* Every contact of U' on a block of K is one of U; all others are at rest.
//!
//! *Lemma 2 (the trap).* If every block c that can be added to S makes it fall, with P_c as above, then no T with
//! `union of P_c (without c) <= T <= S` can be grown to the whole. *Proof.* T only grows within S: the first c from outside
//! S falls by Lemma 1, for `T + c <= S + c` has lost only blocks whose loads did no positive work.
//! The search may therefore step back until a block of that union is gone; this is conflict-directed backjumping
//! (Prosser, Hybrid algorithms for the constraint satisfaction problem, 1993).

use crate::formulate::BlockSet;

/// A collapse motion: which blocks move, and the work of each one's load.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapse {
    moving: Vec<(usize, f64)>,
}

/// A collapse is carried over while at least this share of its work is left: far above the rounding in it.
const WORK_LEFT: f64 = 1e-3;

impl Collapse {
    /// Takes the moving blocks with the work of their loads.
    pub fn new(moving: Vec<(usize, f64)>) -> Self {
        Self { moving }
    }

    /// The blocks that move, with the work of each one's load.
    pub fn moving(&self) -> &[(usize, f64)] {
        &self.moving
    }

    /// The blocks whose loads drive the collapse.
    pub fn driving(&self) -> impl Iterator<Item = usize> + '_ {
        self.moving.iter().filter(|(_, work)| *work > 0.0).map(|(block, _)| *block)
    }

    fn work(&self, counts: impl Fn(usize) -> bool) -> f64 {
        self.moving.iter().filter(|(block, _)| counts(*block)).map(|(_, work)| work).sum()
    }
}

/// A collapse with the conditions under which it carries over.
#[derive(Debug, Clone)]
pub(super) struct KnownCollapse {
    collapse: Collapse,
    /// Blocks that touch a moving one and were not there: with one of them the motion may be blocked.
    absent_neighbours: Vec<usize>,
}

impl KnownCollapse {
    /// `blocks` is the sub-assembly that falls.
    pub fn new(collapse: Collapse, blocks: &BlockSet, neighbours: &[Vec<usize>]) -> Self {
        let around = collapse.moving.iter().flat_map(|&(block, _)| &neighbours[block]).copied();
        let mut absent_neighbours: Vec<usize> = around.filter(|&block| !blocks.contains(block)).collect();
        absent_neighbours.sort_unstable();
        absent_neighbours.dedup();
        Self { collapse, absent_neighbours }
    }

    /// Whether `blocks` falls by the same motion (Lemma 1).
    pub fn holds_for(&self, blocks: &BlockSet) -> bool {
        !self.absent_neighbours.iter().any(|&block| blocks.contains(block))
            && self.collapse.work(|block| blocks.contains(block)) > WORK_LEFT * self.collapse.work(|_| true)
    }

    /// Adds the blocks of `blocks` that drive the collapse to a conflict.
    pub fn blame(&self, blocks: &BlockSet, conflict: &mut BlockSet) {
        self.collapse.driving().filter(|&block| blocks.contains(block)).for_each(|block| conflict.insert(block));
    }
}
