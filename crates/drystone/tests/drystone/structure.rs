//! A structure that changes: the same verdict as afresh, whatever came and went, and how much of it takes no solver.

use drystone::{
    Scene, Structure,
    check::check_blocks,
    formulate::{Assembly, BlockSet},
    scenes,
};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn scenes_that_fall() -> Vec<Scene> {
    vec![
        scenes::arch(20, 0.2, 0.5).unwrap(),
        scenes::random_stack(20, 3, 0.3).unwrap(),
        scenes::wall(5, 5, 1, 0.5).unwrap(),
        scenes::diamond(4, 0.0).unwrap(),
    ]
}

/// Blocks come and go one to three at a time, mostly without a question in between being answered by standing.
#[test]
fn every_verdict_is_that_of_a_fresh_check() {
    let mut random = Pcg64::seed_from_u64(11);
    for scene in scenes_that_fall() {
        let assembly = Assembly::new(&scene).unwrap();
        let mut structure = Structure::of(assembly.clone());
        let (mut present, mut verdicts) = (BlockSet::empty(assembly.blocks()), [0, 0]);
        for _ in 0..400 {
            for _ in 0..random.random_range(1..=3) {
                let block = random.random_range(0..assembly.blocks());
                // Three in four blocks are there on the average.
                if random.random_range(0..4) > 0 {
                    structure.add(block);
                    present.insert(block);
                } else {
                    structure.remove(block);
                    present.remove(block);
                }
            }
            assert_eq!(structure.blocks(), &present);
            let fresh = check_blocks(&assembly, &present);
            assert_eq!(structure.stands(), Some(fresh.stable));
            if random.random_range(0..5) == 0 {
                let verdict = structure.check();
                assert_eq!((verdict.stable, &verdict.falling), (fresh.stable, &fresh.falling));
            }
            verdicts[usize::from(fresh.stable)] += 1;
        }
        assert!(verdicts[0] > 20, "{verdicts:?}");
    }
}

/// Blocks go mostly in the order opposite to that in which they came, as in a search; forces are asked for now and then.
#[test]
fn going_back_leaves_what_was_there() {
    let mut random = Pcg64::seed_from_u64(5);
    for scene in scenes_that_fall() {
        let assembly = Assembly::new(&scene).unwrap();
        let (mut structure, upward) = (Structure::of(assembly.clone()), assembly.upward());
        let (mut came, mut verdicts): (Vec<usize>, _) = (Vec::new(), [0, 0]);
        for _ in 0..400 {
            let missing: Vec<usize> = upward.iter().copied().filter(|block| !came.contains(block)).collect();
            if !missing.is_empty() {
                came.push(missing[random.random_range(0..missing.len().min(4))]);
                structure.add(came[came.len() - 1]);
            }
            let stands = structure.stands().unwrap();
            let fresh = check_blocks(&assembly, structure.blocks());
            assert_eq!(stands, fresh.stable);
            verdicts[usize::from(stands)] += 1;
            let back = if !stands && random.random_range(0..8) > 0 { 1 } else { 0 };
            let further = if random.random_range(0..4) == 0 { random.random_range(1..=3) } else { 0 };
            for _ in 0..(back + further).min(came.len()) {
                let out_of_order = random.random_range(0..10) == 0;
                let at = if out_of_order { random.random_range(0..came.len()) } else { came.len() - 1 };
                structure.remove(came.remove(at));
            }
            if random.random_range(0..6) == 0 {
                let (verdict, fresh) = (structure.check(), check_blocks(&assembly, structure.blocks()));
                assert_eq!((verdict.stable, &verdict.falling), (fresh.stable, &fresh.falling));
            }
        }
        assert!(verdicts.iter().all(|&count| count > 20), "{verdicts:?}");
    }
}

/// What was taken off in the order opposite to that in which it came was not solved for: a second time up and down costs
/// no more pivots than the way up.
#[test]
fn the_way_down_takes_no_pivots() {
    let assembly = Assembly::new(&scenes::pyramid(8, 0.5).unwrap()).unwrap();
    let mut structure = Structure::of(assembly.clone());
    for block in assembly.upward() {
        structure.add(block);
        assert_eq!(structure.stands(), Some(true));
    }
    let up = structure.counts().pivots;
    for block in assembly.upward().into_iter().rev() {
        structure.remove(block);
        assert_eq!(structure.stands(), Some(true));
    }
    assert_eq!(structure.counts().pivots, up);
    assert_eq!(structure.entries(), 3 * assembly.blocks());
}

/// An arch without its keystone falls, and so does what is left of it from there on: the solver is asked a few times only.
#[test]
fn what_goes_on_falling_is_not_solved_again() {
    let assembly = Assembly::new(&scenes::arch(41, 0.2, 0.5).unwrap()).unwrap();
    let mut structure = Structure::of(assembly.clone());
    (0..assembly.blocks()).for_each(|block| structure.add(block));
    assert_eq!(structure.stands(), Some(true));
    let (mut fell, mut asked) = (0, 0);
    for block in assembly.upward().into_iter().rev() {
        structure.remove(block);
        let before = structure.counts();
        let stands = structure.stands().unwrap();
        assert_eq!(stands, check_blocks(&assembly, structure.blocks()).stable);
        fell += usize::from(!stands);
        asked += usize::from(!stands && structure.counts() != before);
    }
    assert!(fell > 15, "{fell}");
    assert!(asked <= 4, "{asked} of {fell}");
}

/// Copies, by `clone` and through bytes, answer with the same numbers as the first, and leave it alone.
#[test]
fn copies_go_on_bit_for_bit_and_alone() {
    let walk = |structure: &mut Structure, seed: u64| {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut seen = Vec::new();
        for _ in 0..12 {
            for _ in 0..3 {
                let block = random.random_range(0..structure.assembly().blocks());
                if random.random_bool(0.7) { structure.add(block) } else { structure.remove(block) }
            }
            let verdict = format!("{:?}", structure.check()); // every number with its digits
            seen.push((structure.stands(), verdict, structure.counts(), structure.entries()));
        }
        seen
    };
    for scene in scenes_that_fall() {
        let assembly = Assembly::new(&scene).unwrap();
        let mut first = Structure::of(assembly.clone());
        walk(&mut first, 1);
        first.add(0); // the solver has not been told yet
        let written = first.to_bytes();
        let mut clone = first.clone();
        let mut taken_up = Structure::from_bytes(assembly.clone(), &written).unwrap();
        assert!(taken_up.to_bytes() == written);
        let copied = walk(&mut clone, 2);
        assert!(first.to_bytes() == written, "the first has changed");
        assert_eq!(walk(&mut taken_up, 2), copied);
        assert_eq!(walk(&mut first, 2), copied);
    }
}

#[test]
fn bytes_of_another_scene_or_damaged_ones_are_no_structure() {
    let [arch, other] = [0.5, 0.6].map(|mu| Assembly::new(&scenes::arch(7, 0.2, mu).unwrap()).unwrap());
    let mut structure = Structure::of(arch.clone());
    (0..5).for_each(|block| structure.add(block));
    structure.stands();
    let bytes = structure.to_bytes();
    assert!(Structure::from_bytes(other, &bytes).is_err());
    for place in (0..bytes.len()).step_by(7) {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        assert!(Structure::from_bytes(arch.clone(), &changed).is_err(), "{place}");
    }
}
