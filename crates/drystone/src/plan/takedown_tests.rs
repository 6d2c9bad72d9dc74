//! The lemma of the load takedown against verdicts that know nothing of it, and plans with and without it.

use super::candidates::Upward;
use super::learned::Learned;
use super::outcome::{Limits, Outcome, Quiet};
use super::reuse::Reuse;
use super::search::{Clock, Search};
use super::touching::Touching;
use crate::{
    check::{Route, check_while},
    formulate::{Assemble, Assembly, BlockSet, FrictionCone},
    proof::{accelerations_under, moving},
    scene::SceneOf,
    scenes::{arch, brick_wall, diamond, extruded, pyramid, random_stack, square_pyramid, wall},
    takedown::Takedown,
};
use std::sync::atomic::AtomicBool;

fn stands(assembly: &Assembly, blocks: &BlockSet) -> bool {
    let names: Vec<String> = blocks.iter().map(|block| assembly.body(block).name.clone()).collect();
    let found = check_while(assembly, Some(&names), Route::InteriorPoint, FrictionCone::Pyramid, &mut |_| true);
    found.unwrap().unwrap().stable
}

/// The first blocks from the supports upward.
fn lower(assembly: &Assembly, count: usize) -> BlockSet {
    let mut set = BlockSet::empty(assembly.blocks());
    assembly.upward().into_iter().take(count).for_each(|block| set.insert(block));
    set
}

/// Forces of the takedown, if every block bears: normal forces that leave no block an imbalance.
fn held<S: Assemble>(scene: &SceneOf<S>) -> bool {
    let assembly = Assembly::new(scene).unwrap();
    let takedown = Takedown::new(&assembly);
    let sizes = [assembly.blocks(), assembly.blocks() / 2, 1];
    let forces = sizes.map(|size| takedown.forces(&assembly, &lower(&assembly, size)));
    for (size, forces) in sizes.into_iter().zip(&forces) {
        let Some(forces) = forces else { continue };
        assert!(forces.iter().all(|force| force.normal >= 0.0 && force.tangential <= 1e-15 * force.normal));
        let under = accelerations_under(&assembly, &lower(&assembly, size), forces);
        assert!(moving(&assembly, &under, forces).is_empty());
    }
    forces.iter().all(Option::is_some)
}

#[test]
fn walls_and_heaps_bear_block_by_block() {
    assert!(held(&wall(12, 9, 3, 0.0).unwrap()));
    assert!(held(&pyramid(9, 0.3).unwrap()));
    assert!(held(&brick_wall(8, 9, 0.6).unwrap()));
    assert!(held(&square_pyramid(6, 0.5).unwrap()));
    assert!(held(&extruded(&wall(5, 5, 1, 0.5).unwrap(), 1.0).unwrap()));
}

#[test]
fn what_leans_or_is_held_down_does_not() {
    assert!(!held(&arch(9, 0.2, 0.7).unwrap()));
    assert!(!held(&wall(4, 4, 0, 0.6).unwrap().with_gravity([1.0, -9.81]).unwrap()));
    assert!(!held(&diamond(4, 0.6).unwrap()));
}

/// Where the lemma says that a block can come, the structure with it stands.
#[test]
fn the_lemma_is_never_wrong() {
    let (mut carried, mut not) = (0, 0);
    for seed in 0..12 {
        let scene = random_stack(24, seed, if seed % 2 == 0 { 0.0 } else { 0.5 }).unwrap();
        let assembly = Assembly::new(&scene).unwrap();
        let takedown = Takedown::new(&assembly);
        let (mut current, mut bearing) = (BlockSet::empty(24), BlockSet::empty(24));
        for block in assembly.upward() {
            let mut with = current.clone();
            with.insert(block);
            let bears = takedown.bears(block, |below| bearing.contains(below));
            if bears {
                carried += 1;
                bearing.insert(block);
            } else {
                not += 1;
            }
            if stands(&assembly, &with) {
                current = with;
            } else {
                assert!(!bears, "seed {seed}, block {block}");
            }
        }
    }
    assert!(carried > 60 && not > 60, "{carried} blocks bear, {not} do not");
}

/// A search's outcome and order, and the pivots of its test.
fn planned(assembly: &Assembly, worth: usize) -> (Outcome, Vec<usize>, usize) {
    let touching = Touching::new(assembly);
    let (mut memory, mut upward) = (Learned::new(&touching, Default::default()), Upward::new(&touching));
    let mut search = Search::new(&touching, None, &mut memory, &mut upward);
    let (whole_falls, mut quiet) = (AtomicBool::new(false), Quiet);
    let mut clock = Clock::new(Limits { tests: Some(3000), ..Limits::default() }, &mut quiet, &whole_falls);
    let outcome = search.run(&mut Reuse::new(assembly).with_worth(worth), &mut clock).unwrap();
    let pivots = search.records.iter().map(|record| record.outcome.pivots).sum();
    (outcome, search.best, pivots)
}

fn the_same_with_the_lemma<S: Assemble>(scene: &SceneOf<S>) -> [usize; 2] {
    let assembly = Assembly::new(scene).unwrap();
    let (outcome, order, pivots) = planned(&assembly, usize::MAX);
    let mut with = 0;
    for worth in [5_000, 500, 0] {
        let other = planned(&assembly, worth);
        assert_eq!((other.0, &other.1), (outcome, &order));
        with = other.2;
    }
    [pivots, with]
}

/// With the lemma from the first test on, and after a while: the same order, also where the search goes back and the solver
/// hears of many blocks at once.
#[test]
fn plans_are_the_same() {
    for seed in 0..10 {
        the_same_with_the_lemma(&random_stack(40, seed, if seed % 2 == 0 { 0.0 } else { 0.5 }).unwrap());
    }
    let [without, with] = the_same_with_the_lemma(&brick_wall(6, 7, 0.6).unwrap());
    assert!(without > 100 && with == 0, "{without} pivots, {with} with the lemma");
}
