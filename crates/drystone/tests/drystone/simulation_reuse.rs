//! Reuse: the same motion by all three modes, less work, and states that go on bit for bit.

use drystone::{
    BodyOptions, Scene,
    geometry::Polygon,
    scenes,
    simulate::{Options, Reuse, World},
};
use drystone_lcp::Counts;

const MODES: [Reuse; 3] = [Reuse::None, Reuse::Motionless, Reuse::Full];

fn world(scene: &Scene, reuse: Reuse) -> World {
    World::new(scene.clone(), Options { reuse, ..Options::default() }).unwrap()
}

/// Pivots of a run; asserts that every step was solved.
fn run(world: &mut World, steps: usize) -> Counts {
    (0..steps).fold(Counts::default(), |sum, _| sum + world.step().unwrap().counts)
}

#[test]
fn the_three_modes_move_alike() {
    let scenes = [
        (scenes::col20(0.5), 1000),
        (scenes::slope(35.0, 0.5, 1.0, 1.0), 1000),
        (scenes::slope(40.0, 2.0, 0.4, 1.0), 1000),
        (scenes::fall7(0.5), 1000),
        (scenes::falling_column(0.2), 1000),
        (scenes::five_blocks(0.5), 1000),
        (scenes::arch(20, 0.2, 0.7), 1000),
        (scenes::pyramid(6, 0.5), 1000),
        (scenes::wall84(1, 0.5), 20),
    ];
    for (scene, count) in scenes {
        let scene = scene.unwrap();
        let mut worlds = MODES.map(|reuse| world(&scene, reuse));
        for step in 0..count {
            worlds.iter_mut().for_each(|world| drop(world.step().unwrap()));
            let [reference, others @ ..] = &worlds;
            for other in others {
                for (a, b) in reference.poses().zip(other.poses()) {
                    let worst = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
                    assert!(worst <= 1e-9, "step {step}: {a:?} and {b:?} by {:?}", other.options().reuse);
                }
            }
            if step % 100 == 0 {
                assert_eq!(worlds[0].motionless(), worlds[2].motionless(), "step {step}");
            }
        }
    }
}

/// The scene after Fig. 1: at least 90 % of the pivots are saved; the paper saved 45 % of the time.
#[test]
fn full_reuse_saves_nine_pivots_of_ten_on_the_falling_column() {
    let scene = scenes::falling_column(0.2).unwrap();
    let pivots = MODES.map(|reuse| run(&mut world(&scene, reuse), 700).pivots);
    assert!(10 * pivots[2] <= pivots[0], "{pivots:?}");
    assert!(pivots[1] < pivots[0], "{pivots:?}");
}

/// The scene after Fig. 4, where the paper's reuse made some steps slower: `full` takes fewer pivots in each segment.
#[test]
fn full_reuse_loses_in_no_segment() {
    let scene = scenes::three_segments(0.3).unwrap();
    let [mut none, _, mut full] = MODES.map(|reuse| world(&scene, reuse));
    for (segment, steps) in [86, 87, 180].into_iter().enumerate() {
        let (without, with) = (run(&mut none, steps).pivots, run(&mut full, steps).pivots);
        assert!(2 * with <= without, "segment {segment}: {with} against {without}");
    }
}

#[test]
fn the_scenes_move_in_the_segments_that_the_paper_describes() {
    let moving = |world: &World| -> Vec<String> {
        let bodies = world.names().zip(world.motionless());
        bodies.filter(|(_, still)| !**still).map(|(name, _)| name.to_owned()).collect()
    };
    let segments = |scene: Scene, steps: usize| {
        let mut world = world(&scene, Reuse::Full);
        let mut seen: Vec<Vec<String>> = Vec::new();
        for _ in 0..steps {
            world.step().unwrap();
            let now = moving(&world);
            if seen.last() != Some(&now) {
                seen.push(now);
            }
        }
        seen
    };
    let fig1 = segments(scenes::falling_column(0.2).unwrap(), 400);
    assert_eq!(fig1, [vec!["7"], vec!["6", "7"]]);
    let fig4 = segments(scenes::three_segments(0.3).unwrap(), 300);
    assert_eq!(fig4, [vec!["a", "b"], vec!["a", "b", "c", "d", "e"], vec!["a", "b", "c", "d", "e", "f", "g"]]);
}

/// A step in which nothing moves is that before it over again: nothing is solved, and every active row stays.
#[test]
fn a_settled_step_solves_nothing() {
    for scene in [scenes::col50(0.5), scenes::pyr13(0.5), scenes::wall84(3, 0.5), scenes::arch(20, 0.2, 0.7)] {
        let mut world = world(&scene.unwrap(), Reuse::Full);
        for _ in 0..3 {
            world.step().unwrap();
        }
        for _ in 0..20 {
            let record = world.step().unwrap();
            assert_eq!((record.counts, record.solves), (Counts::default(), 0));
            assert!(record.rows_reused > 0 && record.residual <= 1e-9);
            assert!(world.motionless().iter().all(|&still| still));
        }
    }
}

/// A run is a function of its input, and may be left and taken up at any step.
#[test]
fn reruns_and_snapshots_are_the_same_to_the_bit() {
    let scenes =
        [scenes::falling_column(0.2), scenes::three_segments(0.3), scenes::drop84(1, 0.5), scenes::pyramid(5, 0.3)];
    for scene in scenes {
        let scene = scene.unwrap();
        for reuse in MODES {
            let mut whole = world(&scene, reuse);
            let mut pieces = world(&scene, reuse);
            for piece in 0..5 {
                run(&mut whole, 50);
                run(&mut pieces, 50);
                assert_eq!(whole.hash(), pieces.hash(), "{reuse:?}, piece {piece}");
                let bytes = pieces.snapshot();
                pieces = World::<Polygon>::restore(&bytes).unwrap();
                assert_eq!(bytes, pieces.snapshot());
                assert_eq!(whole.contact_impulses(), pieces.contact_impulses());
            }
        }
    }
}

/// Pushes are part of the state, and of the hash.
#[test]
fn a_pending_push_survives_a_snapshot() {
    let mut first = world(&scenes::column(4, 0.5).unwrap(), Reuse::Full);
    run(&mut first, 5);
    let before = first.hash();
    first.apply_force("3", [20.0, 0.0, 0.0], None).unwrap();
    assert_ne!(first.hash(), before);
    let mut second = World::<Polygon>::restore(&first.snapshot()).unwrap();
    run(&mut first, 10);
    run(&mut second, 10);
    assert_eq!(first.hash(), second.hash());
    assert!(first.poses().nth(3).unwrap()[0] > 0.0);
}

/// Bodies come and go between steps; what was there goes on, and the answer is that of a world built at once.
#[test]
fn bodies_added_and_removed() {
    let mut grown = world(&scenes::column(3, 0.5).unwrap(), Reuse::Full);
    run(&mut grown, 5);
    grown
        .add(|scene| {
            scene.add_box([0.0, 2.5], [1.0, 1.0], 0.0, BodyOptions { name: Some("3".into()), ..BodyOptions::default() })
        })
        .unwrap();
    let record = grown.step().unwrap();
    assert!(record.rows_reused > 0);
    assert!(record.motionless.iter().all(|&still| still));
    let mut built = world(&scenes::column(4, 0.5).unwrap(), Reuse::Full);
    run(&mut built, 6);
    assert!(grown.poses().eq(built.poses()));
    grown.remove("1").unwrap();
    run(&mut grown, 200);
    let heights: Vec<f64> = grown.poses().map(|[_, y, _]| y).collect();
    assert!((heights[1] - 0.5).abs() < 1e-9 && (heights[2] - 1.5).abs() < 1e-9, "{heights:?}");
    assert!(grown.motionless().iter().all(|&still| still));
}
