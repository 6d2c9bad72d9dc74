//! Searches whose tests ask the interior-point method from the first one on, against those by pivots.

use super::by_interior::by_interior_point;
use super::candidates::Upward;
use super::holding::Holding;
use super::learned::Learned;
use super::outcome::{Limits, Outcome, Quiet};
use super::reuse::Reuse;
use super::search::{Clock, Search};
use super::stability::StabilityTest;
use super::touching::Touching;
use crate::{
    BodyOptions, Scene,
    formulate::{Assembly, BlockSet},
    nearby::Put,
    scenes::{arch, extruded, random_stack, square_pyramid},
};
use std::sync::atomic::AtomicBool;

/// A search's outcome and order, and the pivots of its test.
fn planned(assembly: &Assembly, test: &mut dyn StabilityTest) -> (Outcome, Vec<usize>, usize) {
    let touching = Touching::new(assembly);
    let (mut memory, mut upward) = (Learned::new(&touching, Default::default()), Upward::new(&touching));
    let mut search = Search::new(&touching, None, &mut memory, &mut upward);
    let (whole_falls, mut quiet) = (AtomicBool::new(false), Quiet);
    let mut clock = Clock::new(Limits { tests: Some(400), ..Limits::default() }, &mut quiet, &whole_falls);
    let outcome = search.run(test, &mut clock).unwrap();
    let pivots = search.records.iter().map(|record| record.outcome.pivots).sum();
    (outcome, search.best, pivots)
}

#[test]
fn orders_are_those_that_pivots_find() {
    let stacks = (0..8).map(|seed| random_stack(24, seed, if seed % 2 == 0 { 0.0 } else { 0.5 }).unwrap());
    let in_plane = stacks.map(|scene| Assembly::new(&scene).unwrap());
    let (wedged, heap) = (extruded(&arch(9, 0.2, 0.7).unwrap(), 1.0).unwrap(), square_pyramid(3, 0.5).unwrap());
    let mut known = 0;
    for assembly in in_plane.chain([Assembly::new(&wedged).unwrap(), Assembly::new(&heap).unwrap()]) {
        let (outcome, order, pivots) = planned(&assembly, &mut Reuse::new(&assembly));
        let (other, by_interior, fewer) = planned(&assembly, &mut Reuse::new(&assembly).always_hard());
        if outcome != Outcome::TestLimit {
            assert_eq!((other, by_interior), (outcome, order));
            known += 1;
        }
        assert!(10 * fewer <= pivots, "{fewer} pivots of {pivots}");
    }
    assert!(known > 5, "{known} searches ended");
}

/// Every hold that is said to do does, by pivots from nothing, and as many structures are given up.
#[test]
fn holds_are_those_that_pivots_find() {
    for hands in [1, 2] {
        for voussoirs in [5, 8] {
            let assembly = Assembly::new(&extruded(&arch(voussoirs, 0.2, 0.7).unwrap(), 1.0).unwrap()).unwrap();
            let mut test = Holding::new(&assembly, hands, usize::MAX);
            let (outcome, order, _) = planned(&assembly, &mut test);
            let expected: Vec<_> = test.way().map(|(block, holds)| (block, sorted(holds))).collect();
            let mut hard = Holding::new(&assembly, hands, usize::MAX).always_hard();
            assert_eq!(planned(&assembly, &mut hard), (outcome, order, 0));
            let found: Vec<_> = hard.way().map(|(block, holds)| (block, sorted(holds))).collect();
            assert_eq!(found, expected, "{voussoirs} voussoirs, {hands} hands");
            assert!(found.iter().any(|(_, holds)| holds.iter().any(|held| held.len() == 1)));
        }
    }
}

fn sorted(holds: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut holds = holds.to_vec();
    holds.sort();
    holds
}

/// A row of boxes on a fixed one, another on top.
fn row() -> Assembly {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    let fixed = BodyOptions { fixed: true, ..BodyOptions::default() };
    scene.add_box([1.5, -0.5], [4.0, 1.0], 0.0, fixed).unwrap();
    for x in 0..4 {
        scene.add_box([f64::from(x), 0.5], [1.0, 1.0], 0.0, BodyOptions::default()).unwrap();
    }
    scene.add_box([0.5, 1.5], [1.0, 1.0], 0.0, BodyOptions::default()).unwrap();
    Assembly::new(&scene).unwrap()
}

#[test]
fn two_that_are_held_side_by_side_are_no_trouble() {
    let (assembly, blocks) = (row(), BlockSet::full(5));
    let touching = Touching::new(&assembly);
    let put = Put { blocks: &blocks, held: &[0, 1], added: 4 };
    assert!(by_interior_point(&assembly, &touching, put, None).unwrap().tested.outcome.stands);
}

#[test]
fn forces_of_the_one_before_hold_the_next() {
    let (assembly, mut blocks) = (row(), BlockSet::full(5));
    let touching = Touching::new(&assembly);
    blocks.remove(4);
    let put = Put { blocks: &blocks, held: &[], added: 3 };
    let before = by_interior_point(&assembly, &touching, put, None).unwrap().forces.unwrap();
    blocks.insert(4);
    let put = Put { blocks: &blocks, held: &[], added: 4 };
    let cold = by_interior_point(&assembly, &touching, put, None).unwrap();
    let warm = by_interior_point(&assembly, &touching, put, Some(&before)).unwrap();
    assert!(cold.tested.outcome.stands && warm.tested.outcome.stands);
    assert_ne!(cold.forces, warm.forces);
}
