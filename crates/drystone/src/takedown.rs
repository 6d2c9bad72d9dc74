//! Load takedown: a proof of standing, block by block, for structures that bear by straight pressure.
//!
//! ```text
//! G_b x = -F_b,   x >= 0      own load of block b, on its bearings                      (1)
//! G_b x = n_c,    x >= 0      a unit normal force n_c of a block above, at a point c    (2)
//! ```
//!
//! A *bearing* of a block is a contact point below it whose normal force the body there takes up: a fixed body takes up any; a
//! block does if (2) has a solution on its own bearings. A block *bears* if (1) has one. Each of these is a small problem of its
//! own, solved once, from the supports upward.
//!
//! *Lemma.* Let S stand, and let b bear, with all blocks in S that its load passes through on the way to fixed bodies. Then S
//! with b stands. *Proof.* Follow b's load down: (1) gives forces on its bearings, (2) for each of these forces on the bearings of the
//! block below, and so on; blocks below are fewer each time. All of them are normal forces, not negative, and balance the load
//! of b. Cones are convex: added to the forces that hold S they hold S with b.
//!
//! So a plan of a wall needs no test for each block, and a wall of thousands of blocks no factor. What leans on friction, or is
//! held down by what lies on it, does not bear in this sense; other methods decide then. Engineers call the same way of following
//! loads from the top to the ground a load takedown. docs/theory/load-takedown.md

mod bearings;
mod stack;

pub(crate) use stack::{Stack, Touching};

use crate::{
    contact::Contact,
    formulate::{Assembly, BlockSet, Components, ContactForce},
    interrupt::poll,
};
use bearings::Bearings;

/// Normal forces at contact points: (point, N).
type Passed = Vec<(u32, f64)>;

/// How each block of an assembly passes loads on to those below it.
#[derive(Debug)]
pub(crate) struct Takedown {
    /// Blocks from the supports upward.
    upward: Vec<usize>,
    /// Of each block that bears: (1).
    own: Vec<Option<Passed>>,
    /// Of each contact point: (2) on the block below, for 1 N; None where that takes up nothing there.
    through: Vec<Option<Passed>>,
    /// Of each bearing the block below; None for a fixed body.
    lower: Vec<Option<usize>>,
    /// Of each block the blocks below its bearings.
    below: Vec<Vec<usize>>,
    /// Of each block its bearings, ascending.
    bearings: Vec<Vec<u32>>,
}

/// A bearing's normal rises by more than this share of its length: what stands beside a block bears nothing of it.
const RISES: f64 = 1e-3;

/// Operations of a small problem, about.
const SMALL: usize = 1 << 12;

impl Takedown {
    /// Solves (1) and (2) for all blocks.
    pub fn new(assembly: &Assembly) -> Self {
        Self::unless(&Stack::of(assembly), |_| false).expect("nothing ends it")
    }

    /// The same if all blocks of a sub-assembly bear; None as soon as one does not.
    pub fn of_bearing(assembly: &Assembly, blocks: &BlockSet) -> Option<Self> {
        Self::unless(&Stack::of(assembly), |block| blocks.contains(block))
    }

    /// Normal forces at all contact points of a stack that balance its loads, if every block bears.
    pub fn normal_forces(stack: &Stack) -> Option<Vec<f64>> {
        let blocks = BlockSet::full(stack.loads.len());
        Self::unless(stack, |_| true)?.along_normals(&blocks)
    }

    /// None as soon as a block does not bear of which `needed` says that it has to.
    fn unless(stack: &Stack, needed: impl Fn(usize) -> bool) -> Option<Self> {
        let (blocks, points) = (stack.loads.len(), stack.touching.len());
        let mut place = vec![0; blocks];
        stack.upward.iter().enumerate().for_each(|(k, &block)| place[block] = k);
        // Points under each block, and those on it.
        let (mut under, mut on) = (vec![Vec::new(); blocks], vec![Vec::new(); blocks]);
        for (index, touching) in stack.touching.iter().enumerate() {
            if let Some((upper, lower)) = stacked(touching, &place) {
                under[upper].push(index as u32);
                lower.into_iter().for_each(|lower| on[lower].push(index as u32));
            }
        }
        let mut found = Self {
            own: vec![None; blocks],
            through: vec![None; points],
            below: vec![Vec::new(); blocks],
            bearings: vec![Vec::new(); blocks],
            lower: vec![None; points],
            upward: stack.upward.clone(),
        };
        for k in 0..blocks {
            let block = found.upward[k];
            poll(SMALL * (1 + on[block].len()));
            found.settle(stack, block, &under[block], &on[block]);
            if found.own[block].is_none() && needed(block) {
                return None;
            }
        }
        Some(found)
    }

    /// Solves the problems of a block, those below it being solved.
    fn settle(&mut self, stack: &Stack, block: usize, under: &[u32], on: &[u32]) {
        let bears = |&point: &u32| stack.other(point, block).is_none() || self.through[point as usize].is_some();
        let bearings: Vec<u32> = under.iter().copied().filter(bears).collect();
        let points =
            Bearings::new(bearings.iter().map(|&point| stack.pushed(point, block)), &stack.units[block][..stack.size]);
        let solve = |load: &Components| -> Option<Passed> {
            let forces = points.balance(load)?;
            let used = bearings.iter().zip(forces).filter(|(_, force)| *force > 0.0);
            Some(used.map(|(&point, force)| (point, force)).collect())
        };
        self.own[block] = solve(&stack.loads[block]);
        if self.own[block].is_some() {
            for &point in on {
                self.through[point as usize] = solve(stack.pushed(point, block));
            }
        }
        for &point in &bearings {
            self.lower[point as usize] = stack.other(point, block);
        }
        let mut below: Vec<usize> = bearings.iter().filter_map(|&point| stack.other(point, block)).collect();
        below.sort_unstable();
        below.dedup();
        (self.below[block], self.bearings[block]) = (below, bearings);
    }

    /// Whether a block bears, if all blocks below its bearings do (`carried` says so) on the way to fixed bodies.
    pub fn bears(&self, block: usize, carried: impl Fn(usize) -> bool) -> bool {
        self.own[block].is_some() && self.below[block].iter().all(|&below| carried(below))
    }

    /// Forces that hold a sub-assembly, of all contact points between its blocks; None if some block does not bear in it.
    pub fn forces(&self, assembly: &Assembly, blocks: &BlockSet) -> Option<Vec<ContactForce>> {
        let along = self.along_normals(blocks)?;
        let between = |contact: &Contact| {
            contact.bodies.iter().filter_map(|&body| assembly.block_of(body)).all(|block| blocks.contains(block))
        };
        let there = assembly.contacts().iter().zip(along).enumerate().filter(|(_, (contact, _))| between(contact));
        Some(there.map(|(index, (_, along))| assembly.normal_force(index, along)).collect())
    }

    /// The normal forces that hold a sub-assembly, one for each contact point; None if some block does not bear in it.
    fn along_normals(&self, blocks: &BlockSet) -> Option<Vec<f64>> {
        let mut carried = BlockSet::empty(self.own.len());
        for &block in self.upward.iter().filter(|&&block| blocks.contains(block)) {
            if !self.bears(block, |below| carried.contains(below)) {
                return None;
            }
            carried.insert(block);
        }
        let mut along = vec![0.0; self.through.len()];
        let mut on: Vec<Vec<usize>> = vec![Vec::new(); self.own.len()];
        for &block in self.upward.iter().rev().filter(|&&block| blocks.contains(block)) {
            pass(self.own[block].as_ref()?, 1.0, &mut along);
            // What blocks above have passed on is complete.
            for point in std::mem::take(&mut on[block]) {
                let force = along[point];
                if force > 0.0 {
                    pass(self.through[point].as_ref()?, force, &mut along);
                }
            }
            for &point in &self.bearings[block] {
                if let Some(lower) = self.lower[point as usize] {
                    on[lower].push(point as usize);
                }
            }
        }
        Some(along)
    }
}

fn pass(passed: &Passed, force: f64, along: &mut [f64]) {
    passed.iter().for_each(|&(point, share)| along[point as usize] += share * force);
}

/// The block above a contact point, and the one below unless that is a fixed body. None if they are side by side, or nothing
/// that moves is above.
fn stacked(touching: &Touching, place: &[usize]) -> Option<(usize, Option<usize>)> {
    let [first, second] = touching.blocks;
    let (lower, upper) = if touching.rise > 0.0 { (first, second) } else { (second, first) };
    let upper = upper.filter(|_| touching.rise.abs() > RISES)?;
    lower.is_none_or(|lower| place[lower] < place[upper]).then_some((upper, lower))
}
