//! Bad input is a typed error, a step that cannot be made says why, and hard scenes get a right answer.

use drystone::{
    BodyOptions, Scene, SceneError,
    formulate::Cones,
    geometry::{Polygon, Solid},
    scenes,
    simulate::{Ending, Formulation, Kept, Options, Reuse, SimulationError, StepFailure, World, run},
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

/// Any changed bit, any bytes lost or added, in the plane and in space, by every mode of reuse.
#[test]
fn damaged_snapshots_are_refused() {
    let column = scenes::column(4, 0.5).unwrap();
    let solid = scenes::extruded(&column, 1.0).unwrap();
    for reuse in [Reuse::Full, Reuse::Motionless] {
        let mut plane = World::new(column.clone(), Options { reuse, ..Options::default() }).unwrap();
        let mut space = World::new(solid.clone(), Options { reuse, ..Options::default() }).unwrap();
        for _ in 0..3 {
            plane.step().unwrap();
            space.step().unwrap();
        }
        refuses_damage(&plane.snapshot(), |bytes| World::<Polygon>::restore(bytes).map(drop));
        refuses_damage(&space.snapshot(), |bytes| World::<Solid>::restore(bytes).map(drop));
        let crossed = [
            World::<Solid>::restore(&plane.snapshot()).map(drop),
            World::<Polygon>::restore(&space.snapshot()).map(drop),
        ];
        assert!(crossed.iter().all(|result| matches!(result, Err(SimulationError::Snapshot { .. }))));
    }
}

fn refuses_damage(bytes: &[u8], restore: impl Fn(&[u8]) -> Result<(), SimulationError>) {
    restore(bytes).unwrap();
    let refused = |bytes: &[u8]| matches!(restore(bytes), Err(SimulationError::Snapshot { .. }));
    for place in 0..bytes.len() {
        let mut changed = bytes.to_vec();
        changed[place] ^= 1 << (place % 8);
        assert!(refused(&changed), "byte {place}");
    }
    assert!((0..bytes.len()).step_by(7).all(|length| refused(&bytes[..length])));
    assert!(refused(&[bytes, b"\0"].concat()));
    assert!(refused(b""));
}

/// Worlds at the same places differ in their hash if they will move otherwise.
#[test]
fn the_hash_covers_what_decides_the_motion() {
    let scene = |size: f64, density: f64, friction: f64, own: Option<f64>, gravity: f64, fixed: bool, name: &str| {
        let mut scene = Scene::new([0.0, gravity], friction).unwrap();
        let options =
            BodyOptions { density, friction: own, fixed, name: Some(name.to_owned()), ..BodyOptions::default() };
        scene.add_box([0.0, 0.0], [size, 1.0], 0.0, options).unwrap();
        scene
    };
    let plain = || scene(1.0, 1.0, 0.5, None, -9.81, false, "block");
    let options = Options::default();
    let cones = Cones { facets: 12, ..Cones::default() };
    let worlds = [
        (plain(), options),
        (scene(1.5, 1.0, 0.5, None, -9.81, false, "block"), options),
        (scene(1.0, 2.0, 0.5, None, -9.81, false, "block"), options),
        (scene(1.0, 1.0, 0.6, None, -9.81, false, "block"), options),
        (scene(1.0, 1.0, 0.5, Some(0.7), -9.81, false, "block"), options),
        (scene(1.0, 1.0, 0.5, None, -9.82, false, "block"), options),
        (scene(1.0, 1.0, 0.5, None, -9.81, true, "block"), options),
        (scene(1.0, 1.0, 0.5, None, -9.81, false, "other"), options),
        (plain().with_contact_tolerance(1e-5).unwrap(), options),
        (plain(), Options { dt: 1.0 / 120.0, ..options }),
        (plain(), Options { restitution: 0.5, ..options }),
        (plain(), Options { reuse: Reuse::Motionless, ..options }),
        (plain(), Options { formulation: Formulation::Acceleration, ..options }),
        (plain(), Options { cones, ..options }),
    ];
    let mut hashes: Vec<u64> =
        worlds.into_iter().map(|(scene, options)| World::new(scene, options).unwrap().hash()).collect();
    let pushed = |push: &dyn Fn(&mut World)| {
        let mut world = World::new(plain(), options).unwrap();
        push(&mut world);
        world.hash()
    };
    hashes.push(pushed(&|world| world.apply_force("block", [1.0, 0.0, 0.0], None).unwrap()));
    hashes.push(pushed(&|world| world.set_velocity("block", [1.0, 0.0, 0.0]).unwrap()));
    hashes.push(pushed(&|world| drop(world.step().unwrap())));
    assert_eq!(hashes[0], pushed(&|_| ()));
    let count = hashes.len();
    hashes.sort_unstable();
    hashes.dedup();
    assert_eq!(hashes.len(), count);
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

fn whirling(turning: f64) -> World {
    let mut scene = Scene::new([0.0, 0.0], 0.5).unwrap();
    scene.add_box([10.0, 0.0], [4.0, 4.0], 0.0, BodyOptions { fixed: true, ..named("wall") }).unwrap();
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, named("block")).unwrap();
    let mut world = World::new(scene, Options::default()).unwrap();
    world.set_velocity("block", [300.0, 0.0, turning]).unwrap();
    world
}

/// It turns by ten radians in a step, next to another: the step is made in ten, and more where it then turns faster.
#[test]
fn a_whirl_is_made_in_shorter_steps() {
    for formulation in [Formulation::Velocity, Formulation::Acceleration] {
        let mut world = whirling(2400.0);
        if formulation == Formulation::Acceleration {
            let scene = world.scene().into_owned();
            world = World::new(scene, Options { formulation, ..Options::default() }).unwrap();
            world.set_velocity("block", [300.0, 0.0, 2400.0]).unwrap();
        }
        let mut energy = world.energy();
        let mut substeps = 0;
        for step in 0..40 {
            let record = world.step().unwrap();
            assert!(record.penetration <= 1e-6, "step {step}: {:e}", record.penetration);
            let now = world.energy();
            assert!(now <= energy * (1.0 + 1e-12), "step {step}: {energy} to {now}");
            (energy, substeps) = (now, record.substeps.max(substeps));
        }
        assert_eq!(world.steps(), 40);
        assert!(substeps >= 10);
        assert!(world.poses().nth(1).unwrap()[0] < 8.0);
    }
}

/// Where fallen dominoes push one another the sliding speeds go round in circles: in 80 of these steps, without Newton's method after pivots.
#[test]
fn dominoes_fall_by_coulombs_law() {
    let mut scene = Scene::new([0.0, -10.0], 0.6).unwrap();
    scene.add_box([0.0, -1.0], [200.0, 2.0], 0.0, BodyOptions { fixed: true, ..named("ground") }).unwrap();
    for k in 0..15_u8 {
        let name = format!("{k}");
        scene.add_box([f64::from(k) - 7.5, 0.5], [0.25, 1.0], 0.0, named(&name)).unwrap();
    }
    let mut world = World::new(scene, Options::default()).unwrap();
    world.set_velocity("0", [0.8, 0.0, -4.5]).unwrap();
    let inexact = (0..2200).filter(|_| !world.step().unwrap().exact).count();
    assert!(inexact <= 8, "{inexact}");
    assert!(world.poses().skip(1).all(|[_, height, _]| height < 0.4), "some stand");
}

/// A push lasts for the whole step, though that is made in parts.
#[test]
fn a_push_lasts_for_all_parts_of_a_step() {
    let mut scene = Scene::new([0.0, 0.0], 0.0).unwrap();
    scene.add_box([10.0, 0.0], [18.0, 4.0], 0.0, BodyOptions { fixed: true, ..named("wall") }).unwrap();
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, named("block")).unwrap();
    let mut world = World::new(scene, Options::default()).unwrap();
    world.set_velocity("block", [0.0, 0.0, 300.0]).unwrap();
    world.apply_force("block", [-240.0, 24.0, 0.0], None).unwrap();
    let record = world.step().unwrap();
    assert_eq!(record.substeps, 2);
    let [vx, vy, _] = world.velocities()[1];
    assert!((vx + 1.0).abs() < 1e-12 && (vy - 0.1).abs() < 1e-12, "{vx} {vy}");
    let next = world.step().unwrap();
    assert!((world.velocities()[1][0] + 1.0).abs() < 1e-12, "{next:?}");
}

/// It turns by ten thousand: the step is refused, and says which is short enough; what came before is kept.
#[test]
fn a_wild_whirl_is_refused_and_what_was_done_is_kept() {
    let mut world = whirling(2.4e6);
    let recorded = run(&mut world, 10, Kept::all(true), |_| true);
    let Ending::Failed(StepFailure::TooFast { dt, .. }) = recorded.ending else { panic!("{:?}", recorded.ending) };
    assert!((dt - 1.0 / 2.4e6).abs() < 1e-15);
    assert_eq!(recorded.moments, recorded.records.len() + 1);
    assert!(!recorded.records.is_empty() && recorded.records.len() < 10);
    let last: Vec<f64> = world.poses().flatten().collect();
    assert_eq!(recorded.poses[recorded.poses.len() - last.len()..], last);
}

#[test]
fn a_run_can_be_stopped() {
    let mut world = World::new(scenes::column(5, 0.5).unwrap(), Options::default()).unwrap();
    let recorded = run(&mut world, 100, Kept::all(false), |made| made < 7);
    assert_eq!((recorded.ending.name(), recorded.records.len(), recorded.moments), ("interrupted", 7, 8));
}

/// Of every third step and of the last what is known of all of them.
#[test]
fn bodies_of_every_third_step_are_those_of_all() {
    let scene = || scenes::fall7(0.5).unwrap();
    let recorded = |kept| run(&mut World::new(scene(), Options::default()).unwrap(), 100, kept, |made| made < 20);
    let (all, some) = (recorded(Kept::all(true)), recorded(Kept { every: 3, forces: true }));
    assert_eq!((some.records.len(), some.moments), (20, 8));
    let size = all.poses.len() / all.moments;
    let kept = [0, 3, 6, 9, 12, 15, 18, 20];
    let of = |numbers: &[f64]| -> Vec<f64> { kept.iter().flat_map(|k| numbers[k * size..][..size].to_vec()).collect() };
    assert_eq!((&some.poses, &some.velocities), (&of(&all.poses), &of(&all.velocities)));
    assert!(some.contacts.iter().eq(kept[1..].iter().map(|k| &all.contacts[k - 1])));
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
