//! Supports that settle: truths that can be worked out by hand, and what the answer proves.

use drystone::{
    BodyOptions, Scene, SceneError, SceneOf,
    formulate::{Assemble, Assembly, BlockSet, FrictionCone},
    io::from_json,
    scenes,
    settle::{Joint, Opening, Settled, canonical_forces_after, settle},
};
use drystone_lcp::Status;
use std::collections::BTreeMap;

fn support(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), fixed: true, ..BodyOptions::default() }
}

fn block(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

fn settled<S: Assemble>(scene: &SceneOf<S>, cone: FrictionCone) -> (Assembly, Settled) {
    let assembly = Assembly::new(scene).unwrap();
    let found = settle(&assembly, &BlockSet::full(assembly.blocks()), cone);
    (assembly, found)
}

/// A beam 4 m long and .4 m high on two supports, half a metre of it on each.
fn beam(friction: f64) -> Scene {
    let mut scene = Scene::new([0.0, -10.0], friction).unwrap();
    scene.add_box([-2.0, -0.5], [1.0, 1.0], 0.0, support("left")).unwrap();
    scene.add_box([2.0, -0.5], [1.0, 1.0], 0.0, support("right")).unwrap();
    scene.add_box([0.0, 0.2], [4.0, 0.4], 0.0, block("beam")).unwrap();
    scene
}

/// An arch whose abutments are two bodies, the right one of which settles.
fn arch(voussoirs: usize, displacement: [f64; 2]) -> Scene {
    let whole = scenes::arch(voussoirs, 0.2, 0.7).unwrap();
    let mut scene = Scene::new([0.0, -9.81], 0.7).unwrap();
    scene.add_box([-1.0, -0.5], [1.0, 1.0], 0.0, support("left")).unwrap();
    scene.add_box([1.0, -0.5], [1.0, 1.0], 0.0, support("right")).unwrap();
    for body in whole.bodies().iter().filter(|body| !body.fixed) {
        scene.add_polygon(&body.vertices(), block(&body.name)).unwrap();
    }
    scene.add_settlement("right", displacement, [0.0; 3], None).unwrap();
    scene
}

#[test]
fn a_beam_follows_the_support_that_sinks() {
    let mut scene = beam(0.5);
    scene.add_settlement("right", [0.0, -0.01], [0.0; 3], None).unwrap();
    let (assembly, found) = settled(&scene, FrictionCone::Pyramid);
    assert_eq!(found.status, Status::Solved, "{found:?}");
    // It turns about the inner edge of the support that stays, at x = -1.5, and lies on the outer end of the other, at its own end
    // x = 2: by .01 in 3.5 m.
    let (_, moved) = found.displacements[0];
    let turn = -0.01 / 3.5;
    let [x, y, angle] = moved.in_plane();
    assert!((angle - turn).abs() < 1e-9 && (y - 1.5 * turn).abs() < 1e-9 && (x + 0.2 * turn).abs() < 1e-9, "{moved:?}");
    assert!((found.work - 1.6 * 10.0 * -1.5 * turn).abs() < 1e-9);
    let kinds: Vec<_> = found.joints.iter().map(|joint| joint.opening).collect();
    assert_eq!(kinds, [Opening::Hinge; 2], "{:?}", found.joints);
    let at = found.joints.iter().map(|joint| joint.at[0]);
    assert!(at.zip([-1.5, 2.0]).all(|(found, x)| (found - x).abs() < 1e-9));
    // So it rests on these two corners, by the law of the lever.
    let forces = canonical_forces_after(&assembly, FrictionCone::Pyramid, &found).unwrap();
    let bearing: Vec<f64> = forces.iter().filter(|f| f.normal > 1e-9).map(|f| f.normal).collect();
    assert!((bearing[0] - 16.0 * 2.0 / 3.5).abs() < 1e-9 && (bearing[1] - 16.0 * 1.5 / 3.5).abs() < 1e-9);
    assert_eq!(bearing.len(), 2, "{forces:?}");
}

#[test]
fn an_arch_whose_abutment_spreads_opens_three_hinges() {
    for voussoirs in [15, 20, 31] {
        let (assembly, found) = settled(&arch(voussoirs, [0.01, 0.0]), FrictionCone::Pyramid);
        assert_eq!(found.status, Status::Solved);
        let hinges: Vec<&Joint> = found.joints.iter().filter(|j| j.opening == Opening::Hinge).collect();
        assert_eq!((hinges.len(), found.joints.len()), (3, 3), "{:?}", found.joints);
        // The middle one at the extrados (it opens below), the others at the intrados.
        let mut radii: Vec<(f64, f64)> = hinges.iter().map(|j| (j.at[0], j.at[0].hypot(j.at[1]))).collect();
        radii.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(radii[1].1 > 1.05 && radii[0].1 < 0.95 && radii[2].1 < 0.95, "{radii:?}");
        assert!((found.work - found.bound).abs() < 1e-10 && found.imbalance < 1e-9 && found.closing < 1e-9);
        // Three hinges leave one set of resultants in the joints, whatever the method.
        let forces = canonical_forces_after(&assembly, FrictionCone::Pyramid, &found).unwrap();
        let mut apart: BTreeMap<[usize; 2], [f64; 3]> = BTreeMap::new();
        for (after, (contact, as_found)) in forces.iter().zip(&found.forces) {
            let of_pair = apart.entry(contact.bodies).or_default();
            (0..3).for_each(|k| of_pair[k] += after.force[k] - as_found.force[k]);
        }
        assert!(apart.values().flatten().all(|apart| apart.abs() < 1e-9), "{apart:?}");
    }
}

#[test]
fn the_same_in_space_and_on_round_cones() {
    for displacement in [[0.01, 0.0], [0.0, -0.01], [-0.01, 0.0]] {
        let plane = arch(12, displacement);
        let (_, flat) = settled(&plane, FrictionCone::Pyramid);
        let solid = scenes::extruded(&plane, 0.5).unwrap();
        for cone in [FrictionCone::Pyramid, FrictionCone::Round] {
            let (assembly, found) = settled(&solid, cone);
            assert_eq!(found.status, Status::Solved, "{displacement:?} {cone:?} {found:?}");
            assert!((found.work - flat.work).abs() < 1e-8 * flat.work.abs(), "{} {}", found.work, flat.work);
            let kinds = |found: &Settled| -> Vec<_> { found.joints.iter().map(|j| (j.bodies, j.opening)).collect() };
            assert_eq!(kinds(&found), kinds(&flat), "{displacement:?} {cone:?}");
            assert!(canonical_forces_after(&assembly, cone, &found).is_some());
        }
    }
}

#[test]
fn blocks_that_nothing_moves_stay() {
    // Without friction a block could slide at no cost, and another support sinks that bears nothing.
    let mut scene = beam(0.0);
    scene.add_box([0.0, -1.0], [1.0, 1.0], 0.0, support("below")).unwrap();
    scene.add_settlement("below", [0.3, -0.2], [0.0, 0.0, 0.05], None).unwrap();
    let (_, found) = settled(&scene, FrictionCone::Pyramid);
    assert_eq!((found.status, found.joints.len()), (Status::Solved, 0));
    assert!(found.displacements[0].1.in_plane().iter().all(|u| *u == 0.0));
    // Both supports sink: the beam with them, and nothing opens.
    for name in ["left", "right"] {
        scene.add_settlement(name, [0.0, -0.01], [0.0; 3], None).unwrap();
    }
    let (_, found) = settled(&scene, FrictionCone::Pyramid);
    let [x, y, turn] = found.displacements[0].1.in_plane();
    assert!(x.abs() < 1e-9 && (y + 0.01).abs() < 1e-9 && turn.abs() < 1e-9);
    assert_eq!((found.status, found.joints.len()), (Status::Solved, 0), "{:?}", found.joints);
}

#[test]
fn settlements_of_one_support_add_up_and_turn_about_the_point_given() {
    let mut scene = beam(0.5);
    // About the middle of its top, by one degree or so; then the top's right end goes down by .5 times the turn.
    scene.add_settlement("right", [0.0, 0.0], [0.0, 0.0, -0.02], Some([2.0, 0.0])).unwrap();
    let (_, one) = settled(&scene, FrictionCone::Pyramid);
    let mut twice = beam(0.5);
    // The centroid, half a metre below that point, goes to the left by the turn times .5 m.
    twice.add_settlement("right", [-0.01, 0.0], [0.0; 3], None).unwrap();
    twice.add_settlement("right", [0.0, 0.0], [0.0, 0.0, -0.02], None).unwrap();
    let (_, other) = settled(&twice, FrictionCone::Pyramid);
    assert_eq!(one.status, Status::Solved);
    let apart = |k: usize| one.displacements[0].1.in_plane()[k] - other.displacements[0].1.in_plane()[k];
    assert!((0..3).all(|k| apart(k).abs() < 1e-12), "{one:?} {other:?}");
}

#[test]
fn supports_that_squeeze_have_no_answer() {
    let mut scene = Scene::new([0.0, -10.0], 0.5).unwrap();
    scene.add_box([0.0, -0.5], [3.0, 1.0], 0.0, support("floor")).unwrap();
    scene.add_box([0.0, 0.5], [1.0, 1.0], 0.0, block("between")).unwrap();
    scene.add_box([-1.0, 0.5], [1.0, 1.0], 0.0, support("left")).unwrap();
    scene.add_box([1.0, 0.5], [1.0, 1.0], 0.0, support("right")).unwrap();
    scene.add_settlement("right", [-0.01, 0.0], [0.0; 3], None).unwrap();
    for cone in [FrictionCone::Pyramid, FrictionCone::Round] {
        let names = |assembly: &Assembly, found: &Settled| -> Vec<String> {
            found.squeezed.iter().map(|&body| assembly.bodies()[body].name.clone()).collect()
        };
        let (assembly, found) = settled(&scene, FrictionCone::Pyramid);
        assert_eq!(found.status, Status::NoSolution);
        assert_eq!(names(&assembly, &found), ["between", "left", "right"]);
        let (assembly, found) = settled(&scenes::extruded(&scene, 1.0).unwrap(), cone);
        assert_eq!(found.status, Status::NoSolution);
        assert_eq!(names(&assembly, &found), ["between", "left", "right"]);
    }
}

#[test]
fn only_supports_settle_and_only_a_little() {
    let mut scene = beam(0.5);
    let refused = |error: Result<(), SceneError>| error.unwrap_err().to_string();
    assert!(refused(scene.add_settlement("beam", [0.0, 0.1], [0.0; 3], None)).contains("not fixed"));
    assert!(refused(scene.add_settlement("lef", [0.0, 0.1], [0.0; 3], None)).contains("did you mean \"left\""));
    assert!(refused(scene.add_settlement("left", [f64::NAN, 0.1], [0.0; 3], None)).contains("displacement[0]"));
    assert!(refused(scene.add_settlement("left", [0.0, 0.1], [0.0, 0.0, 2.0], None)).contains("radians"));
    assert!(refused(scene.add_settlement("left", [0.0, 0.1], [0.0; 3], Some([0.0, 1e13]))).contains("at[1]"));
    assert!(scene.settling().is_none());
}

#[test]
fn a_scene_file_keeps_them() {
    let mut scene = beam(0.5);
    let plain = drystone::AnyScene::from(scene.clone()).to_json();
    assert!(plain.contains("\"version\": 1"));
    scene.add_settlement("right", [0.1, -0.01], [0.0, 0.0, 0.02], Some([2.0, 0.0])).unwrap();
    let text = drystone::AnyScene::from(scene.clone()).to_json();
    assert!(text.contains("\"version\": 3"), "{text}");
    assert_eq!(from_json(&text, "it").unwrap().in_plane().unwrap(), scene);
    let solid = scenes::extruded(&scene, 1.0).unwrap();
    let text = drystone::AnyScene::from(solid.clone()).to_json();
    assert_eq!(from_json(&text, "it").unwrap().in_space().unwrap(), solid);
    let moved = text.replace("\"settlements\"", "\"settlement\"");
    assert!(from_json(&moved, "it").unwrap_err().to_string().contains("did you mean \"settlements\""));
}

#[test]
fn a_world_refuses_them() {
    let mut scene = beam(0.5);
    scene.add_settlement("right", [0.0, -0.01], [0.0; 3], None).unwrap();
    let world = |scene: Scene| drystone::simulate::World::new(scene, drystone::simulate::Options::default());
    let error = world(scene.clone()).unwrap_err().to_string();
    assert!(error.contains("\"right\"") && error.contains("without_settlements"), "{error}");
    assert!(world(scene.without_settlements()).is_ok());
}
