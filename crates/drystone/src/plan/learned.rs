//! A memory that learns from every collapse and from every dead end.
//!
//! *Lemma 2 (the trap).* Let S be a sub-assembly and R a set of blocks outside it, not empty. For every c in R let a nogood
//! (`Q_c`, `A_c`) cover S + c, with `A_c` within R. Then (Q, R) with Q the union of the `Q_c` without c is a nogood.
//! *Proof.* Let T hold all of Q and no block of R. On a way from T to the whole some block c of R comes first. With it the
//! sub-assembly holds `Q_c`, and of R nothing but c, so nothing of `A_c`: it is lost, and so is T.
//!
//! If every candidate of S has failed, R can be everything outside S: a block that touches neither S nor a fixed body
//! is covered by ({c}, its neighbours). The search then steps back until a block of Q is gone. That is
//! conflict-directed backjumping (Prosser, Hybrid algorithms for the constraint satisfaction problem, 1993), and
//! it skips nothing but parts of S, so the largest standing sub-assembly is still found. A search that steps
//! back often looks for the *smallest* R instead, while other candidates are left: the same trap is then
//! recognised wherever it is met again, as by the clauses that satisfiability solvers learn (Marques-Silva and Sakallah, GRASP, 1999).

use super::collapse::Collapse;
use super::memory::{Back, Memory, Place};
use super::nogood::{Nogood, Reason};
use super::touching::Touching;
use crate::formulate::BlockSet;
use std::{collections::HashSet, rc::Rc};

/// What a memory may keep, and when it looks for small traps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// Dead ends after which a search looks for the smallest traps. One that ends before it finds the largest
    /// standing sub-assembly if there is no order.
    pub patience: usize,
    /// Most nogoods kept for a block; of more, those used longest ago are forgotten.
    pub for_a_block: usize,
    /// Most numbers kept in all nogoods; half of them are forgotten when there are more. Forgetting costs time, never an
    /// order: what is not known is tested.
    pub numbers: usize,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { patience: 30, for_a_block: 64, numbers: 1 << 23 }
    }
}

/// Most blocks of a trap from which a smaller one is looked for.
const STARTS: usize = 64;

#[derive(Debug)]
pub(super) struct Learned<'a> {
    touching: &'a Touching,
    /// Nogoods by the blocks that drive them, those used last first.
    nogoods: Vec<Vec<Rc<Nogood>>>,
    numbers: usize,
    /// For the bare supports and every block placed: the blocks that cannot come next, and why.
    failed: Vec<Vec<(usize, Reason)>>,
    bounds: Bounds,
    dead_ends: usize,
    shortcuts: usize,
}

/// A set R of Lemma 2 with its Q.
struct Trap {
    blame: Vec<usize>,
    absent: Vec<usize>,
}

impl<'a> Learned<'a> {
    pub fn new(touching: &'a Touching, bounds: Bounds) -> Self {
        let nogoods = vec![Vec::new(); touching.blocks()];
        Self { touching, nogoods, numbers: 0, failed: vec![Vec::new()], bounds, dead_ends: 0, shortcuts: 0 }
    }

    /// Every nogood kept, as often as it has drivers.
    #[cfg(test)]
    pub fn nogoods(&self) -> impl Iterator<Item = &Rc<Nogood>> {
        self.nogoods.iter().flatten()
    }

    /// Dead ends met.
    #[cfg(test)]
    pub fn dead_ends(&self) -> usize {
        self.dead_ends
    }

    /// Numbers kept in all nogoods.
    #[cfg(test)]
    pub fn numbers(&self) -> usize {
        let mut seen = HashSet::new();
        self.nogoods().filter(|nogood| seen.insert(Rc::as_ptr(nogood))).map(|nogood| nogood.size()).sum()
    }

    fn learn(&mut self, nogood: &Rc<Nogood>) {
        for block in nogood.driving() {
            let list = &mut self.nogoods[block];
            list.insert(0, Rc::clone(nogood));
            list.truncate(self.bounds.for_a_block);
        }
        self.numbers += nogood.size();
        if self.numbers > self.bounds.numbers {
            self.nogoods.iter_mut().for_each(|list| list.truncate(list.len() / 2));
            let mut seen = HashSet::new();
            let kept = self.nogoods.iter().flatten().filter(|nogood| seen.insert(Rc::as_ptr(nogood)));
            self.numbers = kept.map(|nogood| nogood.size()).sum();
        }
    }

    fn fail(&mut self, added: usize, reason: Reason) {
        if let Some(level) = self.failed.last_mut() {
            level.push((added, reason));
        }
    }

    /// Why `block` cannot come next on a sub-assembly, as far as is known.
    fn reason(&self, block: usize, place: &Place<'_>) -> Option<Reason> {
        if let Some((_, reason)) = self.failed.last().and_then(|level| level.iter().find(|(b, _)| *b == block)) {
            return Some(reason.clone());
        }
        if !self.touching.touches(block, place.current) {
            return Some(Reason { blame: Vec::new(), absent: self.touching.neighbours(block).to_vec() });
        }
        let mut with = place.current.clone();
        with.insert(block);
        let nogood = self.nogoods[block].iter().find(|nogood| nogood.covers(&with))?;
        Some(nogood.reason(block, &with, place.position))
    }

    /// The smallest R that holds `start`, if every block in it has a reason not to come next.
    fn closed(&self, start: usize, place: &Place<'_>) -> Option<Trap> {
        let blocks = self.touching.blocks();
        let (mut inside, mut blamed) = (BlockSet::empty(blocks), BlockSet::empty(blocks));
        let mut absent = vec![start];
        inside.insert(start);
        let mut next = 0;
        while let Some(&block) = absent.get(next) {
            next += 1;
            let reason = self.reason(block, place)?;
            reason.blame.iter().for_each(|&block| blamed.insert(block));
            for other in reason.absent {
                if !inside.contains(other) {
                    inside.insert(other);
                    absent.push(other);
                }
            }
        }
        Some(Trap { blame: blamed.iter().collect(), absent })
    }

    /// The trap around `failed` that lets the search step back furthest.
    fn smallest(&self, failed: usize, place: &Place<'_>) -> Option<Trap> {
        let first = self.closed(failed, place)?;
        let others = first.absent.iter().skip(1).take(STARTS).filter_map(|&start| self.closed(start, place));
        let others: Vec<Trap> = others.collect();
        let last = |trap: &Trap| trap.blame.iter().map(|&block| place.position[block] + 1).max().unwrap_or(0);
        others.into_iter().chain([first]).min_by_key(|trap| (last(trap), trap.absent.len(), trap.blame.len()))
    }

    /// Everything outside a sub-assembly on which nothing can come next.
    fn everything(&self, place: &Place<'_>) -> Trap {
        let blocks = self.touching.blocks();
        let mut blamed = BlockSet::empty(blocks);
        let reasons = self.failed.last().into_iter().flatten();
        reasons.flat_map(|(_, reason)| &reason.blame).for_each(|&block| blamed.insert(block));
        let absent = (0..blocks).filter(|&block| !place.current.contains(block)).collect();
        Trap { blame: blamed.iter().collect(), absent }
    }
}

impl Memory for Learned<'_> {
    fn is_lost(&self, set: &BlockSet, added: usize) -> bool {
        self.nogoods[added].iter().any(|nogood| nogood.covers(set))
    }

    fn knows(&mut self, place: &Place<'_>, added: usize) -> bool {
        let list = &mut self.nogoods[added];
        let Some(found) = list.iter().position(|nogood| nogood.covers(place.current)) else { return false };
        list[..=found].rotate_right(1);
        let reason = list[0].reason(added, place.current, place.position);
        self.fail(added, reason);
        self.shortcuts += 1;
        true
    }

    fn fell(&mut self, place: &Place<'_>, added: usize, collapse: Option<Collapse>) {
        let nogood = Rc::new(match collapse {
            Some(collapse) => Nogood::of_collapse(&collapse, place.current, self.touching),
            None => {
                let outside = (0..self.touching.blocks()).filter(|&block| !place.current.contains(block));
                Nogood::of_sets(&place.current.iter().collect::<Vec<_>>(), outside.collect())
            }
        });
        let reason = nogood.reason(added, place.current, place.position);
        self.learn(&nogood);
        self.fail(added, reason);
    }

    fn fell_however_held(&mut self, place: &Place<'_>, added: usize, collapses: &[Collapse]) {
        let reason = Reason::of_all(collapses.iter().map(|collapse| {
            let nogood = Nogood::of_collapse(collapse, place.current, self.touching);
            nogood.reason(added, place.current, place.position)
        }));
        let blocks: Vec<usize> = reason.blame.iter().copied().chain([added]).collect();
        self.learn(&Rc::new(Nogood::of_sets(&blocks, reason.absent.clone())));
        self.fail(added, reason);
    }

    fn stood(&mut self, _place: &Place<'_>) {
        self.failed.push(Vec::new());
    }

    fn back(&mut self, place: &Place<'_>, failed: Option<usize>) -> Option<Back> {
        let trap = match failed {
            _ if self.dead_ends < self.bounds.patience => failed.is_none().then(|| self.everything(place)),
            Some(block) => self.smallest(block, place),
            None => Some(self.everything(place)),
        }?;
        self.dead_ends += 1;
        Some(self.step_out_of(trap, place))
    }

    fn blocked(&mut self, place: &Place<'_>, added: usize, blame: Vec<usize>) -> Back {
        self.step_out_of(Trap { blame, absent: vec![added] }, place)
    }

    fn begin_anew(&mut self) {
        self.failed = vec![Vec::new()];
    }

    fn shortcuts(&self) -> usize {
        self.shortcuts
    }
}

impl Learned<'_> {
    /// Steps back to where the trap is not closed, and learns it.
    fn step_out_of(&mut self, trap: Trap, place: &Place<'_>) -> Back {
        let Back::To(last) = Back::before_last_of(&trap.blame, place) else { return Back::NoOrder };
        self.learn(&Rc::new(Nogood::of_sets(&trap.blame, trap.absent.clone())));
        self.failed.truncate(last + 1);
        let blame = trap.blame.into_iter().filter(|&block| block != place.placed[last]).collect();
        self.fail(place.placed[last], Reason { blame, absent: trap.absent });
        Back::To(last)
    }
}
