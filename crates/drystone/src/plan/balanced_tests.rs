//! The balanced search and its collapses against brute force, the paper's search and fresh checks.

use super::balanced::Balanced;
use super::candidates::{Candidates, Upward};
use super::clear_path::{ClearPath, Paths};
use super::collapse::Collapse;
use super::in_turn::{InTurn, memory_for};
use super::learned::Learned;
use super::lemma_tests::{AT_ONCE, Watched, growable, small};
use super::memory::Memory;
use super::onward::Onward;
use super::outcome::{Limits, Outcome, Quiet, TestRecord};
use super::reuse::Reuse;
use super::search::{Clock, Search};
use super::stability::{PlanError, StabilityTest, TestOutcome};
use super::touching::Touching;
use crate::{
    Scene,
    check::check_blocks,
    formulate::{Assemble, Assembly, BlockSet},
    scene::SceneOf,
    scenes::{extruded, random_stack},
};
use std::{sync::atomic::AtomicBool, time::Instant};

/// Runs something under a clock with so many tests.
fn within<T>(tests: usize, run: impl FnOnce(&mut Clock<'_>) -> T) -> T {
    let limits = Limits { tests: Some(tests), ..Limits::default() };
    run(&mut Clock::new(limits, &mut Quiet, &AtomicBool::new(false)))
}

/// What two searches in turn find, the first turn being so long: the order in which blocks go up, if there is one.
fn in_turn(assembly: &Assembly, paths: Option<&Paths<'_>>, turn: usize) -> (Outcome, Vec<usize>) {
    let touching = Touching::new(assembly);
    let mut search = InTurn::new(assembly, &touching, paths, turn);
    let outcome = within(20_000, |clock| search.run(&mut Reuse::new(assembly), clock)).unwrap();
    (outcome, if outcome == Outcome::Found { search.best } else { Vec::new() })
}

/// Every structure on the way is checked from scratch.
fn stands_on_the_way(assembly: &Assembly, order: &[usize]) {
    let mut set = BlockSet::empty(assembly.blocks());
    for &block in order {
        set.insert(block);
        assert!(check_blocks(assembly, &set).stable, "{set:?}");
    }
    assert_eq!(set.len(), assembly.blocks());
}

/// A test that counts its collapses: by what props them, nothing or something.
struct Counting<'a>(Onward<'a>, &'a mut [usize; 2]);

impl StabilityTest for Counting<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let outcome = self.0.test(blocks, added)?;
        if !outcome.stands {
            let props = self.collapse().and_then(|collapse| collapse.props().map(<[usize]>::len)).unwrap();
            self.1[usize::from(props > 0)] += 1;
        }
        Ok(outcome)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.0.collapse()
    }

    fn descend(&mut self) {
        self.0.descend();
    }

    fn backtrack(&mut self) {
        self.0.backtrack();
    }
}

/// Compares every nogood of the balanced search with brute force, and its answer.
fn all_is_sound<S: Assemble>(scene: &SceneOf<S>, collapses: &mut [usize; 2]) -> Outcome {
    let assembly = Assembly::new(scene).unwrap();
    let (touching, grows) = (Touching::new(&assembly), growable(&assembly));
    let mut watched = Watched::new(Learned::new(&touching, AT_ONCE), &grows);
    let mut balanced = Balanced::new(&touching);
    let mut search = Search::new(&touching, None, &mut watched, &mut balanced);
    let mut test = Counting(Onward::new(&assembly), collapses);
    let outcome = within(5000, |clock| search.run(&mut test, clock)).unwrap();
    assert_eq!(outcome == Outcome::Found, grows[0]);
    outcome
}

#[test]
fn carried_on_collapses_cover_no_sub_assembly_that_can_be_grown_to_the_whole() {
    let (mut collapses, mut ends) = ([0, 0], [0, 0]);
    for scene in small(600) {
        let outcome = all_is_sound(&scene, &mut collapses);
        ends[usize::from(outcome == Outcome::Found)] += 1;
    }
    assert!(collapses[0] > 50 && collapses[1] > 5 && ends.iter().all(|&count| count > 25), "{collapses:?}, {ends:?}");
}

#[test]
fn nor_do_they_in_space() {
    let (mut collapses, mut ends) = ([0, 0], [0, 0]);
    for scene in small(600).filter(|scene| scene.bodies().len() < 9) {
        let outcome = all_is_sound(&extruded(&scene, 1.0).unwrap(), &mut collapses);
        ends[usize::from(outcome == Outcome::Found)] += 1;
    }
    assert!(collapses[0] > 25 && collapses[1] > 0 && ends.iter().all(|&count| count > 15), "{collapses:?}, {ends:?}");
}

fn stacks() -> impl Iterator<Item = Scene> {
    (0..40).filter_map(|seed| {
        let friction = if seed % 4 == 0 { 0.5 } else { 0.0 };
        random_stack(40 + seed as usize % 60, seed, friction).ok()
    })
}

#[test]
fn orders_of_the_balanced_search_stand_at_every_step() {
    for scene in stacks() {
        let assembly = Assembly::new(&scene).unwrap();
        let (outcome, order) = in_turn(&assembly, None, 1);
        assert_eq!(outcome, Outcome::Found);
        stands_on_the_way(&assembly, &order);
    }
}

#[test]
fn the_searches_in_turn_answer_as_the_first_alone() {
    let mut ends = [0, 0];
    for scene in small(400) {
        let assembly = Assembly::new(&scene).unwrap();
        let (alone, _) = in_turn(&assembly, None, 20_000);
        for turn in [1, 3, 10] {
            let (outcome, order) = in_turn(&assembly, None, turn);
            assert_eq!(outcome, alone, "turns from {turn} tests on");
            if outcome == Outcome::Found {
                stands_on_the_way(&assembly, &order);
            }
        }
        ends[usize::from(alone == Outcome::Found)] += 1;
    }
    assert!(ends.iter().all(|&count| count > 25), "{ends:?}");
}

#[test]
fn with_ways_out_they_do_so_too() {
    for scene in small(120) {
        let assembly = Assembly::new(&scene).unwrap();
        let paths = Paths::new(&scene, &assembly, &ClearPath::default()).unwrap();
        if !paths.locked().is_empty() {
            continue;
        }
        let (alone, _) = in_turn(&assembly, Some(&paths), 20_000);
        let (outcome, order) = in_turn(&assembly, Some(&paths), 1);
        assert_eq!(outcome, alone);
        let mut set = BlockSet::empty(assembly.blocks());
        for &block in &order {
            assert!(paths.can_leave(block, &set), "{block} has no way out");
            set.insert(block);
        }
        if outcome == Outcome::Found {
            stands_on_the_way(&assembly, &order);
        }
    }
}

/// A test that loses its digits.
struct Lost;

impl StabilityTest for Lost {
    fn test(&mut self, blocks: &BlockSet, _added: usize) -> Result<TestOutcome, PlanError> {
        Err(PlanError::NoAnswer { blocks: blocks.len(), reason: "for a test".into() })
    }
}

#[test]
fn in_numerical_trouble_of_the_balanced_search_the_first_goes_on() {
    for scene in stacks().take(8).chain(small(60)) {
        let assembly = Assembly::new(&scene).unwrap();
        let touching = Touching::new(&assembly);
        let mut search = InTurn::new(&assembly, &touching, None, 3);
        search.onward = |_| Box::new(Lost);
        let outcome = within(20_000, |clock| search.run(&mut Reuse::new(&assembly), clock)).unwrap();
        let alone = in_turn(&assembly, None, 20_000);
        assert_eq!(outcome, alone.0);
        assert!(outcome != Outcome::Found || search.best == alone.1);
    }
}

/// The order that a search finds if it stops after every so many tests, and its tests.
fn stopping(
    assembly: &Assembly,
    memory: &mut dyn Memory,
    candidates: &mut dyn Candidates,
    test: &mut dyn StabilityTest,
    every: usize,
) -> (Outcome, Vec<usize>, Vec<(usize, bool)>) {
    let touching = Touching::new(assembly);
    let mut search = Search::new(&touching, None, memory, candidates);
    let mut tests = every;
    let outcome = loop {
        match within(tests, |clock| search.run(test, clock)).unwrap() {
            Outcome::TestLimit if tests < 5000 => tests += every,
            outcome => break outcome,
        }
    };
    let answer = |record: &TestRecord| (record.size, record.outcome.stands);
    (outcome, search.placed().to_vec(), search.records.iter().map(answer).collect())
}

#[test]
fn a_search_that_was_stopped_goes_on_as_if_nothing_had_been() {
    for scene in stacks().take(12).chain(small(40)) {
        let assembly = Assembly::new(&scene).unwrap();
        let touching = Touching::new(&assembly);
        let searched = |every| {
            let mut memory = memory_for(&touching, Limits::default(), &Reuse::new(&assembly));
            let mut upward = Upward::new(&touching);
            let first = stopping(&assembly, memory.as_mut(), &mut upward, &mut Reuse::new(&assembly), every);
            let (mut memory, mut balanced) = (Learned::new(&touching, AT_ONCE), Balanced::new(&touching));
            (first, stopping(&assembly, &mut memory, &mut balanced, &mut Onward::new(&assembly), every))
        };
        let at_once = searched(5000);
        assert_eq!(searched(1), at_once);
        assert_eq!(searched(7), at_once);
    }
}

#[test]
fn a_large_stack_has_an_order_where_the_first_search_has_lost_its_way() {
    let scene = random_stack(500, 2, 0.0).unwrap();
    let assembly = Assembly::new(&scene).unwrap();
    let touching = Touching::new(&assembly);
    let mut search = InTurn::new(&assembly, &touching, None, 1000);
    let outcome = within(10_000, |clock| search.run(&mut Reuse::new(&assembly), clock)).unwrap();
    assert_eq!(outcome, Outcome::Found);
    stands_on_the_way(&assembly, &search.best);
    // Alone the first takes more than 20,000.
    assert!(search.records.len() < 5000, "{} tests", search.records.len());
}

/// `cargo test --release -p drystone --lib -- --ignored --nocapture large_stacks` prints the table of docs/theory/search.md.
#[test]
#[ignore = "takes half a minute"]
fn large_stacks_have_their_orders() {
    for (blocks, friction, seeds) in [(250, 0.0, 20), (500, 0.0, 20), (1000, 0.0, 24), (500, 0.5, 6), (1000, 0.5, 6)] {
        for seed in 1..=seeds {
            let Ok(scene) = random_stack(blocks, seed, friction) else { continue };
            let assembly = Assembly::new(&scene).unwrap();
            let touching = Touching::new(&assembly);
            let begin = Instant::now();
            let mut memory = Learned::new(&touching, AT_ONCE);
            let mut balanced = Balanced::new(&touching);
            let mut search = Search::new(&touching, None, &mut memory, &mut balanced);
            let outcome = within(20_000, |clock| search.run(&mut Onward::new(&assembly), clock)).unwrap();
            assert_eq!(outcome, Outcome::Found, "{blocks} blocks, seed {seed}, friction {friction}");
            let (tests, time) = (search.records.len(), begin.elapsed().as_secs_f64());
            let falls = search.records.iter().filter(|record| !record.outcome.stands).count();
            let ends = memory.dead_ends();
            println!("{blocks}, {seed}, {friction}: {tests} tests, {falls} fell, {ends} dead ends, {time:.2} s");
        }
    }
}
