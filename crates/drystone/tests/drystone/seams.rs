//! Floors of many tiles: within the contact tolerance they are one floor (docs/theory/seams.md). In the plane and in space.

use drystone::{
    BodyOptions, Scene, SceneInSpace, check,
    geometry::{PoseInSpace, Solid},
    scenes,
    simulate::{Formulation, Moving, Options, StepRecord, World},
};
use rand::{Rng, SeedableRng, seq::IndexedRandom};
use rand_pcg::Pcg64;

const G: f64 = 9.81;

fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

/// Tiles of one metre with their tops at these heights along a floor that is turned by an angle, and a square block on it.
#[derive(Debug, Clone)]
struct Floor {
    angle: f64,
    /// Gravity's angle to the floor's normal.
    slope: f64,
    tolerance: Option<f64>,
    friction: f64,
    /// One slab instead of tiles, as high as the first.
    whole: bool,
    heights: Vec<f64>,
    /// Where the block's leading face is, from the middle of the first tile on, and its lower side's height.
    lead: f64,
    height: f64,
    size: f64,
}

impl Floor {
    fn level(heights: &[f64], lead: f64, size: f64) -> Self {
        let heights = heights.to_vec();
        Self { angle: 0.0, slope: 0.0, tolerance: None, friction: 0.0, whole: false, heights, lead, height: 0.0, size }
    }

    /// The contact tolerance of the block and a tile, metres.
    fn accuracy(&self) -> f64 {
        self.tolerance.unwrap_or(1e-6 * self.size.min(1.0))
    }

    fn scene(&self) -> Scene {
        let (sin, cos) = (self.angle - self.slope).sin_cos();
        let mut scene = Scene::new([G * sin, -G * cos], self.friction).unwrap();
        if let Some(tolerance) = self.tolerance {
            scene = scene.with_contact_tolerance(tolerance).unwrap();
        }
        let (sin, cos) = self.angle.sin_cos();
        let place = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
        let count = self.heights.len() as f64;
        if self.whole {
            let slab = BodyOptions { fixed: true, ..named("slab") };
            let middle = place(0.5 * count - 0.5, self.heights[0] - 0.5);
            scene.add_box(middle, [count, 1.0], self.angle, slab).unwrap();
        } else {
            for (k, height) in self.heights.iter().enumerate() {
                let tile = BodyOptions { fixed: true, ..named(&format!("tile{k}")) };
                scene.add_box(place(k as f64, height - 0.5), [1.0; 2], self.angle, tile).unwrap();
            }
        }
        let middle = place(self.lead - 0.5 * self.size, self.height + 0.5 * self.size);
        scene.add_box(middle, [self.size; 2], self.angle, named("block")).unwrap();
        scene
    }

    /// Steps with a speed along the floor to begin with; after each of them `look` is given the speeds along and square to the
    /// floor and that of turning, in the plane and then in space.
    fn run(&self, speed: f64, dt: f64, steps: usize, mut look: impl FnMut(usize, [f64; 3], &StepRecord)) {
        for formulation in [Formulation::Velocity, Formulation::Acceleration] {
            let options = Options { dt, formulation, ..Options::default() };
            let mut world = World::new(self.scene(), options).unwrap();
            world.set_velocity("block", self.along(speed)).unwrap();
            steps_of(&mut world, steps, |k, record, [x, y, turning]| look(k, self.seen(x, y, turning), record));
        }
        let options = Options { dt, ..Options::default() };
        let mut world = World::<Solid>::new(scenes::extruded(&self.scene(), 0.7).unwrap(), options).unwrap();
        let [x, z, _] = self.along(speed);
        world.set_velocity("block", [x, 0.0, z, 0.0, 0.0, 0.0]).unwrap();
        steps_of(&mut world, steps, |k, record, [x, y, z, a, b, c]| {
            assert!(y.abs() <= 1e-9, "{y}");
            look(k, self.seen(x, z, a.hypot(b).hypot(c)), record);
        });
    }

    fn along(&self, speed: f64) -> [f64; 3] {
        [speed * self.angle.cos(), speed * self.angle.sin(), 0.0]
    }

    fn seen(&self, x: f64, y: f64, turning: f64) -> [f64; 3] {
        let (sin, cos) = self.angle.sin_cos();
        [cos * x + sin * y, cos * y - sin * x, turning]
    }
}

fn steps_of<S: Moving>(world: &mut World<S>, steps: usize, mut look: impl FnMut(usize, &StepRecord, S::Velocity)) {
    for k in 0..steps {
        let record = world.step().unwrap();
        look(k, &record, *world.velocities().last().unwrap());
    }
}

/// A block keeps its speed over level tiles: at any angle of the floor to the axes, speed, step, size and tolerance, with its
/// leading face before, on and past a seam.
#[test]
fn level_tiles_stop_nothing() {
    let mut random = Pcg64::seed_from_u64(6);
    for _ in 0..80 {
        let (speed, dt) = (
            10.0_f64.powf(random.random_range(-4.0..1.0)),
            *[1e-3, 1.0 / 240.0, 1.0 / 60.0].choose(&mut random).unwrap(),
        );
        let mut floor = Floor::level(&[0.0; 14], 0.0, *[0.3, 0.6, 2.5].choose(&mut random).unwrap());
        floor.angle = *[0.0, random.random_range(-3.0..3.0)].choose(&mut random).unwrap();
        floor.tolerance = *[None, Some(1e-3), Some(1e-5)].choose(&mut random).unwrap();
        let (one, t) = (speed * dt, floor.accuracy());
        let past = [0.0, 1e-15, 1e-9, 0.5 * t, -0.5 * t, -t, -0.5 * one, -one * random.random_range(0.0..20.0)];
        floor.lead = 2.5 + past.choose(&mut random).unwrap();
        let count = ((9.0 / one) as usize).min(40);
        floor.run(speed, dt, count, |k, [along, square, turning], _| {
            let worst = (along - speed).abs().max(square.abs()).max(turning.abs());
            assert!(worst <= 1e-9 * speed.max(1.0), "step {k}: {along} of {speed}, {square}, {turning}: {floor:?}");
        });
    }
}

/// So it does where the next tile is higher or lower by less than the contact tolerance; where it is much lower, too.
#[test]
fn tiles_within_the_tolerance_are_one_floor() {
    for (tolerance, share, speed) in [None, Some(1e-3)]
        .into_iter()
        .flat_map(|t| [-300.0, -5.0, -0.9, 0.5, 0.9].map(|share| (t, share)))
        .flat_map(|(t, share)| [1e-4, 0.01, 0.5, 10.0].map(|speed| (t, share, speed)))
    {
        for past in [-1.5, 0.0, 1e-9, 0.3] {
            let mut floor = Floor { tolerance, ..Floor::level(&[0.0; 3], 0.0, 0.6) };
            let t = floor.accuracy();
            floor.heights[2] = share * t;
            floor.lead = 1.5 + past * if past < 0.0 { speed / 240.0 } else { t };
            floor.run(speed, 1.0 / 240.0, 5, |k, [along, square, turning], record| {
                let worst = (along - speed).abs().max(square.abs()).max(turning.abs());
                assert!(worst <= 1e-9 * speed.max(1.0), "step {k}: {along} of {speed}, {square}, {turning}: {floor:?}");
                assert!(record.penetration <= t, "{record:?}");
            });
        }
    }
}

/// Friction takes mu g of speed a second over seams, as on one slab.
#[test]
fn friction_takes_as_much_over_seams_as_on_one_slab() {
    for (speed, angle, lead) in [(0.2, 0.0, 1.5), (2.0, 0.3, 1.49), (0.01, -2.0, 1.5), (3.0, 1.1, 1.2)] {
        let tiles = Floor { friction: 0.3, angle, ..Floor::level(&[0.0; 6], lead, 0.6) };
        let slab = Floor { whole: true, ..tiles.clone() };
        let mut on_slab = Vec::new();
        slab.run(speed, 1.0 / 240.0, 60, |_, seen, _| on_slab.push(seen));
        let mut expected = on_slab.iter();
        tiles.run(speed, 1.0 / 240.0, 60, |k, seen, _| {
            let expected = expected.next().unwrap();
            let worst = (0..3).map(|axis| (seen[axis] - expected[axis]).abs()).fold(0.0, f64::max);
            assert!(worst <= 1e-8, "step {k}: {seen:?} and {expected:?}: {tiles:?}");
        });
    }
}

/// A block at rest goes down a frictionless slope of flush tiles by g sin, wherever it lies: `check` says that it falls, and a
/// run lets it.
#[test]
fn a_frictionless_slope_of_tiles_holds_nothing() {
    for slope in [0.05, 0.5, 1.2] {
        for (angle, size) in [(slope, 0.6), (slope + 0.7, 2.5), (0.0, 0.3)] {
            for past in [0.0, 1e-15, 1e-9, -1e-9, 2e-7, -2e-7, 1e-3, -1e-3, 0.4] {
                let mut floor = Floor { angle, slope: -slope, ..Floor::level(&[0.0; 9], 4.5 + past, size) };
                floor.angle = angle;
                let scene = floor.scene();
                assert!(!check(&scene, None).unwrap().stable, "{floor:?}");
                let solid = scenes::extruded(&scene, 0.7).unwrap();
                assert!(!check(&solid, None).unwrap().stable, "{floor:?}");
                floor.run(0.0, 1.0 / 240.0, 10, |k, [along, ..], _| {
                    let expected = G * slope.sin() * (k + 1) as f64 / 240.0;
                    assert!((along - expected).abs() <= 1e-9, "step {k}: {along} is not {expected}: {floor:?}");
                });
            }
        }
    }
}

/// What slides into a step higher than the tolerance, however fast, is hit at its lower edge: it stops, or tips over that edge with
/// three quarters of its speed at most; in space, where what two faces share must be wider than twice the tolerance, at most the
/// tolerance past it.
#[test]
fn a_step_stops_what_slides_into_it() {
    for (tolerance, share, speed) in [None, Some(1e-3)]
        .into_iter()
        .flat_map(|t| [1.1, 1.9, 3.0, 100.0].map(|share| (t, share)))
        .flat_map(|(t, share)| [1e-3, 0.03, 0.5, 3.0, 10.0].map(|speed| (t, share, speed)))
    {
        let mut floor = Floor { tolerance, ..Floor::level(&[0.0; 3], 0.0, 0.6) };
        let (t, dt) = (floor.accuracy(), 1.0 / 60.0);
        floor.heights[2] = share * t;
        floor.lead = 1.5 - f64::min(0.5, 3.3 * speed * dt);
        let steps = 6 + (1.1 * t / (speed * dt)) as usize;
        floor.run(speed, dt, steps, |k, [along, ..], record| {
            assert!(k + 1 < steps || along <= 0.76 * speed, "{along}: {floor:?}");
            assert!(record.penetration <= t * (1.0 + 1e-6), "{record:?}: {floor:?}");
        });
    }
}

/// Blocks thrown with a corner at a corner, past it or beside it: never deeper in one another than the tolerance.
#[test]
fn corners_thrown_at_corners_stay_outside() {
    let mut random = Pcg64::seed_from_u64(66);
    for _ in 0..60 {
        let mut scene =
            Scene::new([0.0, *[0.0, -G].choose(&mut random).unwrap()], random.random_range(0.0..0.5)).unwrap();
        scene.add_box([0.0; 2], [1.0; 2], 0.0, BodyOptions { fixed: true, ..named("slab") }).unwrap();
        let (angle, speed) = (random.random_range(0.0_f64..1.5), 10.0_f64.powf(random.random_range(-2.0..1.3)));
        let (beside, away) =
            (*[0.0, 1e-9, 3e-7, 2e-6, 0.01].choose(&mut random).unwrap(), random.random_range(0.0..0.2));
        let corner = [0.5 + away * angle.cos() + beside, 0.5 + away * angle.sin()];
        scene.add_box(corner.map(|x| x + 0.25), [0.5; 2], 0.0, named("block")).unwrap();
        let [x, y, turning] = [-speed * angle.cos(), -speed * angle.sin(), random.random_range(-2.0..2.0)];
        let mut solid = World::<Solid>::new(scenes::extruded(&scene, 0.7).unwrap(), Options::default()).unwrap();
        let mut plane = World::new(scene, Options::default()).unwrap();
        plane.set_velocity("block", [x, y, turning]).unwrap();
        solid.set_velocity("block", [x, 0.0, y, 0.0, -turning, 0.0]).unwrap();
        let stays_outside =
            |k: usize, record: &StepRecord| assert!(record.penetration <= 5.001e-7, "step {k}: {record:?}");
        steps_of(&mut plane, 60, |k, record, _| stays_outside(k, record));
        steps_of(&mut solid, 60, |k, record, _| stays_outside(k, record));
    }
}

/// Tiles in both directions, under blocks that go in any.
#[test]
fn a_floor_of_tiles_in_both_directions_stops_nothing() {
    let mut random = Pcg64::seed_from_u64(666);
    let at = |position: [f64; 3]| PoseInSpace { position, ..PoseInSpace::WORLD };
    for (speed, size) in [(1e-3, 0.6), (0.02, 0.6), (0.3, 1.7), (4.0, 0.3), (9.0, 2.5)] {
        let mut scene = SceneInSpace::new([0.0, 0.0, -G], 0.0).unwrap();
        for (i, j) in (0..7).flat_map(|i| (0..7).map(move |j| (i, j))) {
            let tile = BodyOptions { fixed: true, ..named(&format!("tile{i}-{j}")) };
            scene.add_cuboid(at([f64::from(i) - 3.0, f64::from(j) - 3.0, -0.5]), [1.0; 3], tile).unwrap();
        }
        // Its leading corner is where four tiles meet.
        let middle = 0.5 - 0.5 * size;
        scene.add_cuboid(at([middle, middle, 0.5 * size]), [size; 3], named("block")).unwrap();
        let direction: f64 = random.random_range(0.1..1.4);
        let mut world = World::<Solid>::new(scene, Options::default()).unwrap();
        let velocity = [speed * direction.cos(), speed * direction.sin(), 0.0, 0.0, 0.0, 0.0];
        world.set_velocity("block", velocity).unwrap();
        steps_of(&mut world, 30, |k, _, seen| {
            let worst = (0..6).map(|axis| (seen[axis] - velocity[axis]).abs()).fold(0.0, f64::max);
            assert!(worst <= 1e-9 * speed.max(1.0), "step {k}: {seen:?} of {velocity:?}, block of {size}");
        });
    }
}
