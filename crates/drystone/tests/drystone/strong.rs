//! Must it stand? The laws are checked from outside in `tests/python/test_strong.py`.

use drystone::{
    BodyOptions, Scene,
    formulate::{Assembly, BlockSet},
    scenes,
    strong::{Budget, Searched, Strong, strong},
};

fn decided(scene: &Scene, budget: Budget) -> Strong {
    let assembly = Assembly::new(scene).unwrap();
    let blocks = BlockSet::full(assembly.blocks());
    strong(&assembly, &blocks, budget, &mut |_| true).expect("nobody stops it")
}

/// A block 2 m high that widens downwards by a share of its height, between two walls and over nothing.
fn between_walls(lean: f64) -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.84).unwrap();
    let k = lean;
    let block = [[-1.0 - k, 0.0], [1.0 + k, 0.0], [1.0 - k, 2.0], [k - 1.0, 2.0]];
    scene.add_polygon(&block, BodyOptions::default()).unwrap();
    let fixed = || BodyOptions { fixed: true, ..BodyOptions::default() };
    let right = [[1.0 + 2.0 * k, -1.0], [6.0, -1.0], [6.0, 3.0], [1.0 - 2.0 * k, 3.0]];
    scene.add_polygon(&right, fixed()).unwrap();
    let left: Vec<[f64; 2]> = right.iter().rev().map(|[x, y]| [-x, *y]).collect();
    scene.add_polygon(&left, fixed()).unwrap();
    scene
}

/// Friction is needed in every joint, and one node is enough: the least bearings leave no motion that could pay.
#[test]
fn arches_must_stand() {
    for voussoirs in [3, 5, 9, 20] {
        let found = decided(&scenes::arch(voussoirs, 0.2, 0.7).unwrap(), Budget::default());
        assert_eq!((found.must_stand, found.nodes), (Some(true), 1), "{voussoirs}");
        assert!(found.programs <= 3 * voussoirs + 5, "{voussoirs}: {}", found.programs);
    }
}

#[test]
fn a_block_on_a_slope_must_stand_or_slides() {
    let rests = decided(&scenes::slope(26.0, 0.5, 2.0, 1.0).unwrap(), Budget::default());
    assert_eq!(rests.must_stand, Some(true));
    let slides = decided(&scenes::slope(28.0, 0.5, 2.0, 1.0).unwrap(), Budget::default());
    let [x, y, _] = slides.escape.unwrap().accelerations[0].1.linear;
    let (sin, cos) = 28.0_f64.to_radians().sin_cos();
    assert!((x.hypot(y) - 9.81 * (sin - 0.5 * cos)).abs() < 1e-6, "{x} {y}");
}

#[test]
fn what_hangs_between_walls_can_fall() {
    for lean in [0.0, 0.2, 0.4] {
        let found = decided(&between_walls(lean), Budget::default());
        assert_eq!(found.must_stand, Some(false));
        let escape = found.escape.unwrap();
        assert!(escape.error <= 1e-7);
        assert!((escape.accelerations[0].1.linear[1] + 9.81).abs() < 1e-9);
    }
    assert_eq!(decided(&between_walls(-0.3), Budget::default()).must_stand, Some(true));
}

/// The search ends at its budget, and is stopped where somebody asks it to.
#[test]
fn a_search_has_an_end() {
    let scene = scenes::wall(3, 3, 0, 0.5).unwrap().with_gravity([3.36, -9.22]).unwrap(); // by 20 degrees
    let found = decided(&scene, Budget::Nodes(3));
    assert_eq!((found.must_stand, found.nodes), (None, 3));
    let assembly = Assembly::new(&scene).unwrap();
    let mut asked = 0;
    let mut go_on = |_| {
        asked += 1;
        asked < 3
    };
    assert!(strong(&assembly, &BlockSet::full(assembly.blocks()), Budget::default(), &mut go_on).is_none());
}

/// An effort ends a search within a node as well: the root of this wall takes seconds. Half of it is half of the same work.
#[test]
fn an_effort_is_kept() {
    let scene = scenes::wall(4, 4, 0, 0.5).unwrap().with_gravity([1.7, -9.66]).unwrap(); // by 10 degrees
    let assembly = Assembly::new(&scene).unwrap();
    let searched = |effort| {
        let mut done = Vec::new();
        let found = strong(&assembly, &BlockSet::full(assembly.blocks()), Budget::Effort(effort), &mut |now| {
            done.push(now);
            true
        });
        let found = found.expect("nobody stops it");
        assert_eq!((found.must_stand, found.nodes), (None, 1));
        (found.programs, done)
    };
    let (most, few) = (20_000_000, 10_000_000);
    let ((programs, done), (half, done_of_half)) = (searched(most), searched(few));
    let spent = |done: &[Searched]| done.last().unwrap().effort;
    assert!(spent(&done) >= most && spent(&done) < most + most / 10, "{}", spent(&done));
    assert!(half > 10 && programs > half, "{programs} {half}");
    // The last programs differ, which ends the shorter search in their middle.
    let before: Vec<_> = done.iter().take_while(|now| now.effort < few / 2).collect();
    assert!(before.len() > 10 && before.iter().zip(&done_of_half).all(|(a, b)| *a == b));
    assert!(Budget::default().share(Searched { nodes: 1, effort: most }) < 0.01);
    assert!((Budget::Nodes(4).share(Searched { nodes: 3, effort: most }) - 0.5).abs() < 1e-12);
}
