//! Lemmas 1 and 2 against brute force, and memories that may keep little.

use super::candidates::Upward;
use super::learned::{Bounds, Learned};
use super::memory::{Back, Memory, Place};
use super::nogood::Nogood;
use super::outcome::{Limits, Outcome, Quiet};
use super::reuse::Reuse;
use super::search::{Clock, Search};
use super::touching::Touching;
use super::visited::Visited;
use crate::{
    Scene,
    check::check_blocks,
    formulate::{Assembly, BlockSet},
    scenes::{random_stack, random_stack_where},
};
use std::sync::atomic::AtomicBool;

pub(super) const AT_ONCE: Bounds = Bounds { patience: 0, for_a_block: 64, numbers: 1 << 20 };

/// Small stacks of which the whole stands. In most the stages on the way need not: many have no order.
pub(super) fn small(seeds: u64) -> impl Iterator<Item = Scene> {
    (0..seeds).filter_map(|seed| {
        let (blocks, friction) = (5 + seed as usize % 5, if seed % 3 == 0 { 0.4 } else { 0.0 });
        let whole_only = |scene: &Scene| scene.bodies().len() <= blocks || crate::check::stands(scene).unwrap_or(false);
        let scene = match seed % 4 {
            0 => random_stack(blocks, seed, friction),
            _ => random_stack_where(blocks, seed, friction, whole_only),
        };
        scene.ok().filter(|scene| crate::check::stands(scene).unwrap_or(false))
    })
}

/// All that a memory was told and what it knew, with every nogood on the way.
pub(super) struct Watched<'a> {
    learned: Learned<'a>,
    /// Whether each sub-assembly, by its bits, can be grown to the whole.
    grows: &'a [bool],
    nogoods: usize,
    traps: usize,
}

fn bits(set: &BlockSet) -> usize {
    set.iter().map(|block| 1 << block).sum()
}

impl<'a> Watched<'a> {
    pub fn new(learned: Learned<'a>, grows: &'a [bool]) -> Self {
        Self { learned, grows, nogoods: 0, traps: 0 }
    }

    /// A nogood covers no sub-assembly that can be grown to the whole.
    fn is_sound(&self, nogood: &Nogood, blocks: usize) {
        for (mask, &grows) in self.grows.iter().enumerate() {
            let mut set = BlockSet::empty(blocks);
            (0..blocks).filter(|block| mask >> block & 1 == 1).for_each(|block| set.insert(block));
            assert!(!(grows && nogood.covers(&set)), "{nogood:?} covers {set:?}");
        }
    }

    fn all_are_sound(&mut self) {
        let blocks = self.grows.len().trailing_zeros() as usize;
        let all: Vec<_> = self.learned.nogoods().cloned().collect();
        self.nogoods += all.len();
        all.iter().for_each(|nogood| self.is_sound(nogood, blocks));
    }
}

impl Memory for Watched<'_> {
    fn is_lost(&self, set: &BlockSet, added: usize) -> bool {
        self.learned.is_lost(set, added)
    }

    fn knows(&mut self, place: &Place<'_>, added: usize) -> bool {
        let known = self.learned.knows(place, added);
        assert!(!(known && self.grows[bits(place.current)]), "{:?} can be grown to the whole", place.current);
        known
    }

    fn fell(&mut self, place: &Place<'_>, added: usize, collapse: Option<super::Collapse>) {
        self.learned.fell(place, added, collapse);
        self.all_are_sound();
    }

    fn fell_however_held(&mut self, place: &Place<'_>, added: usize, collapses: &[super::Collapse]) {
        self.learned.fell_however_held(place, added, collapses);
        self.all_are_sound();
    }

    fn stood(&mut self, place: &Place<'_>) {
        self.learned.stood(place);
    }

    fn begin_anew(&mut self) {
        self.learned.begin_anew();
    }

    fn blocked(&mut self, place: &Place<'_>, added: usize, blame: Vec<usize>) -> Back {
        let back = self.learned.blocked(place, added, blame);
        assert!(!self.grows[bits(place.current)], "{:?} can be grown to the whole", place.current);
        self.all_are_sound();
        back
    }

    fn back(&mut self, place: &Place<'_>, failed: Option<usize>) -> Option<Back> {
        let back = self.learned.back(place, failed);
        if back.is_some() {
            assert!(!self.grows[bits(place.current)], "{:?} can be grown to the whole", place.current);
            self.traps += 1;
            self.all_are_sound();
        }
        back
    }
}

/// Which sub-assemblies can be grown to the whole: from the whole downward, by testing every one from scratch.
pub(super) fn growable(assembly: &Assembly) -> Vec<bool> {
    let blocks = assembly.blocks();
    let mut grows = vec![false; 1 << blocks];
    for mask in (0..1_usize << blocks).rev() {
        let mut set = BlockSet::empty(blocks);
        (0..blocks).filter(|block| mask >> block & 1 == 1).for_each(|block| set.insert(block));
        let further = mask == (1 << blocks) - 1 || (0..blocks).any(|b| mask >> b & 1 == 0 && grows[mask | 1 << b]);
        grows[mask] = further && (mask == 0 || check_blocks(assembly, &set).stable);
    }
    grows
}

fn searched(assembly: &Assembly, memory: &mut dyn Memory) -> (Outcome, Vec<usize>, usize) {
    let touching = Touching::new(assembly);
    let limits = Limits { tests: Some(5000), ..Limits::default() };
    let (mut quiet, never) = (Quiet, AtomicBool::new(false));
    let mut clock = Clock::new(limits, &mut quiet, &never);
    let mut upward = Upward::new(&touching);
    let mut search = Search::new(&touching, None, memory, &mut upward);
    let outcome = search.run(&mut Reuse::new(assembly), &mut clock).unwrap();
    let order = if outcome == Outcome::Found { search.placed().to_vec() } else { Vec::new() };
    (outcome, order, search.records.len())
}

#[test]
fn nogoods_cover_no_sub_assembly_that_can_be_grown_to_the_whole() {
    let (mut nogoods, mut traps, mut ends) = (0, 0, [0, 0]);
    for scene in small(600) {
        let assembly = Assembly::new(&scene).unwrap();
        let (touching, grows) = (Touching::new(&assembly), growable(&assembly));
        for patience in [0, 3] {
            let learned = Learned::new(&touching, Bounds { patience, ..AT_ONCE });
            let mut watched = Watched::new(learned, &grows);
            let (outcome, ..) = searched(&assembly, &mut watched);
            assert_eq!(outcome == Outcome::Found, grows[0]);
            (nogoods, traps) = (nogoods + watched.nogoods, traps + watched.traps);
            ends[usize::from(outcome == Outcome::Found)] += 1;
        }
    }
    assert!(nogoods > 400 && traps > 80 && ends.iter().all(|&count| count > 50), "{nogoods}, {traps}, {ends:?}");
}

#[test]
fn every_memory_leads_to_the_same_order() {
    let mut stepped_back = 0;
    let stacks = (0..60).filter_map(|seed| random_stack(30 + seed as usize % 40, seed, 0.0).ok());
    for scene in small(200).chain(stacks) {
        let assembly = Assembly::new(&scene).unwrap();
        let touching = Touching::new(&assembly);
        let mut paper = Visited::new(1 << 20);
        let (outcome, order, tests) = searched(&assembly, &mut paper);
        if outcome == Outcome::TestLimit {
            continue;
        }
        stepped_back += usize::from(tests > assembly.blocks());
        let few = Bounds { patience: 0, for_a_block: 2, numbers: 200 };
        for bounds in [AT_ONCE, Bounds::default(), few] {
            let mut learned = Learned::new(&touching, bounds);
            let found = searched(&assembly, &mut learned);
            assert_eq!((found.0, &found.1), (outcome, &order), "{bounds:?}");
            assert!(found.2 <= tests);
            assert!(learned.numbers() <= bounds.numbers);
        }
        let mut forgetful = Visited::new(100);
        let found = searched(&assembly, &mut forgetful);
        assert!(forgetful.len() <= 100);
        if found.0 != Outcome::TestLimit {
            assert_eq!((found.0, &found.1), (outcome, &order));
        }
    }
    assert!(stepped_back > 30, "{stepped_back}");
}
