//! Scenes in map coordinates: what stands is still, and what moves does so as at the origin.

use drystone::{
    BodyOptions, Scene,
    geometry::Solid,
    scenes,
    simulate::{Moving, Options, World},
};

const G: f64 = 9.81;

fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

/// A turned wall of four courses with gravity square to them, a corner of it at `place`.
fn wall(place: [f64; 2], friction: f64) -> Scene {
    let angle = 0.3_f64;
    let (sin, cos) = angle.sin_cos();
    let mut scene = Scene::new([G * sin, -G * cos], friction).unwrap();
    let at = |x: f64, y: f64| [place[0] + cos * x - sin * y, place[1] + sin * x + cos * y];
    scene.add_box(at(2.0, -0.5), [10.0, 1.0], angle, BodyOptions { fixed: true, ..named("ground") }).unwrap();
    for (row, k) in (0..4).flat_map(|row| (0..4).map(move |k| (row, k))) {
        let (x, y) = (f64::from(k) + 0.3 * f64::from(row % 2), 0.5 * f64::from(row) + 0.25);
        scene.add_box(at(x, y), [1.0, 0.5], angle, named(&format!("{row}-{k}"))).unwrap();
    }
    scene
}

const PLACES: [[f64; 2]; 5] = [[0.0; 2], [1e4, -3e4], [1e5, 1e5], [5e6, 4e5], [-5e6, 5e6]];

/// Nothing moves by more than the last bits of a coordinate, and soon no step is solved.
fn settles<S: Moving>(mut world: World<S>) {
    let start: Vec<S::Place> = world.poses().collect();
    for _ in 0..5 {
        world.step().unwrap();
    }
    let early = world.hash();
    for step in 0..20 {
        let record = world.step().unwrap();
        assert!(record.motionless.iter().all(|still| *still) && record.solves == 0, "step {step}: {record:?}");
    }
    assert_ne!(world.hash(), early, "steps count");
    for (now, start) in world.poses().zip(start) {
        let largest = start.as_ref().iter().fold(1.0, |most: f64, x| x.abs().max(most));
        let last = 2.0 * f64::EPSILON * largest;
        let moved = now.as_ref().iter().zip(start.as_ref()).find(|(a, b)| (*a - *b).abs() > last);
        assert_eq!(moved, None);
    }
}

#[test]
fn a_wall_stands_still_wherever_it_is() {
    for place in PLACES {
        settles(World::new(wall(place, 0.5), Options::default()).unwrap());
        settles(World::<Solid>::new(scenes::extruded(&wall(place, 0.5), 1.0).unwrap(), Options::default()).unwrap());
    }
}

/// A pushed block slides off and falls as at the origin, to what the rounding of the coordinates given is worth.
#[test]
fn a_pushed_block_moves_as_at_the_origin() {
    let moved = |place: [f64; 2]| {
        let mut world = World::new(wall(place, 0.2), Options::default()).unwrap();
        let energy = world.energy();
        let top = world.poses().nth(16).unwrap();
        for _ in 0..120 {
            world.apply_force("3-3", [4.0, 1.0, 0.0], Some([top[0], top[1]])).unwrap();
            world.step().unwrap();
        }
        let forces: Vec<[f64; 2]> = world.contact_impulses().iter().map(|contact| contact.point).collect();
        assert!(forces.iter().all(|point| (point[0] - place[0]).hypot(point[1] - place[1]) < 9.0), "{forces:?}");
        let [x, y, angle] = world.poses().nth(16).unwrap();
        ([x - top[0], y - top[1], angle], world.energy() - energy)
    };
    let (near, gained) = moved([0.0; 2]);
    assert!(near[0] > 0.1, "{near:?}");
    for place in PLACES {
        let (far, energy) = moved(place);
        (0..3).for_each(|k| assert!((far[k] - near[k]).abs() <= 1e-6, "{far:?} and {near:?} at {place:?}"));
        assert!((energy - gained).abs() <= 1e-6, "{energy} and {gained} at {place:?}");
    }
}

/// What a world says of its bodies is in the scene's coordinates, and what it is given too.
#[test]
fn a_far_world_speaks_in_the_scenes_coordinates() {
    let scene = wall([5e6, 4e5], 0.5);
    let mut world = World::new(scene.clone(), Options::default()).unwrap();
    assert_eq!(*world.scene(), scene);
    world.step().unwrap();
    let [x, y, _] = world.poses().nth(13).unwrap();
    let index = world.add(|scene| scene.add_box([x, y + 0.9], [0.2, 0.2], 0.3, named("new"))).unwrap();
    assert_eq!(world.poses().nth(index).unwrap(), [x, y + 0.9, 0.3]);
    let mut bigger = world.scene().into_owned();
    bigger.add_box([x + 1.0, y + 0.9], [0.2, 0.2], 0.3, named("more")).unwrap();
    world.extend(bigger).unwrap();
    let mut again = World::restore(&world.snapshot()).unwrap();
    assert_eq!((world.hash(), &*world.scene()), (again.hash(), &*again.scene()));
    for _ in 0..60 {
        world.step().unwrap();
        again.step().unwrap();
    }
    assert_eq!(world.hash(), again.hash());
    world.remove("new").unwrap();
    assert!(world.poses().all(|[x, y, _]| (x - 5e6).hypot(y - 4e5) < 9.0));
}
