//! Bad input is a typed error, a step that cannot be made says why, and hard scenes get a right answer.

use drystone::{
    BodyOptions, Scene, SceneError,
    geometry::Polygon,
    scenes,
    simulate::{Ending, Options, Reuse, SimulationError, StepFailure, World, run},
};

fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

fn on_ground() -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    scene.add_box([0.0, -0.5], [200.0, 1.0], 0.0, BodyOptions { fixed: true, ..named("ground") }).unwrap();
    scene
}

#[test]
fn bad_input_is_refused_by_name() {
    let make = |dt: f64, restitution: f64| {
        World::new(scenes::column(3, 0.5).unwrap(), Options { dt, restitution, ..Options::default() }).unwrap_err()
    };
    for dt in [0.0, -0.1, f64::INFINITY] {
        assert_eq!(make(dt, 0.0), SimulationError::TimeStep { value: dt });
    }
    assert!(matches!(make(f64::NAN, 0.0), SimulationError::TimeStep { .. }));
    assert_eq!(make(0.1, 1.5), SimulationError::Restitution { value: 1.5 });
    let mut overlapping = on_ground();
    overlapping.add_box([0.0, 0.4], [1.0, 1.0], 0.0, named("deep")).unwrap();
    let error = World::new(overlapping, Options::default()).unwrap_err();
    assert!(matches!(error, SimulationError::Scene(SceneError::Overlap { .. })), "{error}");

    let mut world = World::new(scenes::column(3, 0.5).unwrap(), Options::default()).unwrap();
    let before = world.hash();
    let refused = world.apply_force("1", [f64::NAN, 0.0, 0.0], None).unwrap_err();
    assert!(refused.to_string().contains("\"1\"") && matches!(refused, SimulationError::NotFinite { .. }));
    assert!(matches!(world.apply_impulse("ground", [1.0, 0.0, 0.0], None), Err(SimulationError::Fixed { .. })));
    assert!(matches!(world.set_velocity("7", [0.0; 3]), Err(SimulationError::Scene(SceneError::UnknownName { .. }))));
    assert!(world.add(|scene| scene.add_box([0.0, 0.5], [1.0, 1.0], 0.0, named("new"))).is_err());
    assert_eq!(world.hash(), before);
}

#[test]
fn damaged_snapshots_are_refused() {
    let mut world = World::new(scenes::column(5, 0.5).unwrap(), Options::default()).unwrap();
    world.step().unwrap();
    let bytes = world.snapshot();
    for length in (0..bytes.len()).step_by(97) {
        assert!(
            matches!(World::<Polygon>::restore(&bytes[..length]), Err(SimulationError::Snapshot { .. })),
            "{length}"
        );
    }
    let text = String::from_utf8(bytes).unwrap();
    for (what, other) in
        [("drystone-world", "other"), ("\"steps\":1", "\"steps\":-1"), ("\"sliding\":[", "\"sliding\":[0.5,")]
    {
        assert!(text.contains(what));
        assert!(World::<Polygon>::restore(text.replacen(what, other, 1).as_bytes()).is_err(), "{what}");
    }
}

/// Light blocks under heavy ones, a million to one: they stand, to a billionth of a metre.
#[test]
fn a_mass_ratio_of_a_million_stands() {
    let mut scene = on_ground();
    for k in 0..6 {
        let density = if k % 2 == 0 { 1.0 } else { 1e6 };
        scene
            .add_box([0.0, 0.5 + f64::from(k)], [1.0, 1.0], 0.0, BodyOptions { density, ..named(&k.to_string()) })
            .unwrap();
    }
    for reuse in [Reuse::None, Reuse::Full] {
        let mut world = World::new(scene.clone(), Options { reuse, ..Options::default() }).unwrap();
        let start: Vec<_> = world.poses().collect();
        for _ in 0..500 {
            let record = world.step().unwrap();
            assert!(record.penetration <= 1e-6);
        }
        for (now, then) in world.poses().zip(&start) {
            assert!((0..3).all(|k| (now[k] - then[k]).abs() < 1e-9), "{now:?} {then:?}");
        }
    }
}

/// At 1e4 m/s a block covers 40 m in a step. It does not pass through a wall that is nearer.
#[test]
fn a_fast_block_does_not_pass_through_a_wall() {
    let mut scene = on_ground();
    scene.add_box([30.0, 5.0], [0.5, 10.0], 0.0, BodyOptions { fixed: true, ..named("wall") }).unwrap();
    scene.add_box([0.0, 2.0], [1.0, 1.0], 0.0, named("block")).unwrap();
    let mut world = World::new(scene, Options::default()).unwrap();
    world.set_velocity("block", [1e4, 0.0, 0.0]).unwrap();
    for _ in 0..200 {
        let record = world.step().unwrap();
        assert!(record.penetration <= 1e-6);
        let [x, y, _] = world.poses().nth(2).unwrap();
        assert!(x <= 29.25 + 1e-6 && y >= 0.5 - 1e-6, "{x} {y}");
    }
}

/// Its way leads through a corner of the wall, which is not before any face of it at first: it is stopped where it meets it.
#[test]
fn a_fast_block_does_not_pass_through_a_corner() {
    for (at, lands) in [([-60.0, -60.0], true), ([-60.0, -53.0], true), ([-60.0, -50.0], false)] {
        let mut scene = Scene::new([0.0, 0.0], 0.5).unwrap();
        scene.add_box([30.0, 30.0], [4.0, 4.0], 0.0, BodyOptions { fixed: true, ..named("wall") }).unwrap();
        scene.add_box(at, [1.0, 1.0], 0.0, named("block")).unwrap();
        let mut world = World::new(scene, Options::default()).unwrap();
        world.set_velocity("block", [1e4, 1e4, 0.0]).unwrap();
        for _ in 0..5 {
            match world.step() {
                Ok(record) => assert!(record.penetration <= 1e-6),
                // The corner sets it spinning, thousands of radians a second.
                Err(failure) => assert!(matches!(failure, StepFailure::TooFast { .. }) && lands, "{failure}"),
            }
        }
        let [vx, vy, _] = world.velocities()[1];
        assert_eq!(vx.hypot(vy) < 0.9 * 1e4 * 2_f64.sqrt(), lands, "{at:?}: {vx} {vy}");
    }
}

/// It turns by ten radians in a step, next to another: the step is refused, and says which is short enough; what came before is
/// kept.
#[test]
fn a_whirl_is_refused_and_what_was_done_is_kept() {
    let mut scene = Scene::new([0.0, 0.0], 0.5).unwrap();
    scene.add_box([10.0, 0.0], [4.0, 4.0], 0.0, BodyOptions { fixed: true, ..named("wall") }).unwrap();
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, named("block")).unwrap();
    let mut world = World::new(scene, Options::default()).unwrap();
    world.set_velocity("block", [300.0, 0.0, 2400.0]).unwrap();
    let recorded = run(&mut world, 10, true, |_| true);
    let Ending::Failed(StepFailure::TooFast { dt, .. }) = recorded.ending else { panic!("{:?}", recorded.ending) };
    assert!((dt - 1.0 / 2400.0).abs() < 1e-12);
    assert_eq!(recorded.poses.len(), recorded.records.len() + 1);
    assert!(!recorded.records.is_empty() && recorded.records.len() < 10);
    let last = recorded.poses.last().unwrap();
    assert!(world.poses().eq(last.iter().copied()));
}

#[test]
fn a_run_can_be_stopped() {
    let mut world = World::new(scenes::column(5, 0.5).unwrap(), Options::default()).unwrap();
    let recorded = run(&mut world, 100, false, |made| made < 7);
    assert_eq!((recorded.ending.name(), recorded.records.len(), recorded.poses.len()), ("interrupted", 7, 8));
}

/// Nothing to solve: no bodies, no contacts, no gravity.
#[test]
fn empty_worlds_make_steps() {
    let mut world = World::new(Scene::new([0.0, 0.0], 0.0).unwrap(), Options::default()).unwrap();
    assert_eq!(world.step().unwrap().rows, 0);
    let mut free = Scene::new([0.0, -10.0], 0.0).unwrap();
    free.add_box([0.0, 0.0], [1.0, 1.0], 0.0, named("falls")).unwrap();
    let mut world = World::new(free, Options { dt: 0.1, ..Options::default() }).unwrap();
    for _ in 0..10 {
        world.step().unwrap();
    }
    assert!((world.velocities()[0][1] + 10.0).abs() < 1e-12);
    assert!((world.poses().next().unwrap()[1] + 5.5).abs() < 1e-12);
}
