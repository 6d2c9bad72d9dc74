//! Random boxes and polygons thrown between two walls, at random steps and frictions: the rules that hold in any motion.

use drystone::{
    BodyOptions, Scene,
    simulate::{Formulation, Options, World},
};
use rand::{Rng, SeedableRng, seq::IndexedRandom};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

fn pit(friction: f64) -> Scene {
    let mut scene = Scene::new([0.0, -9.81], friction).unwrap();
    let fixed = || BodyOptions { fixed: true, ..BodyOptions::default() };
    scene.add_box([0.0, -0.5], [60.0, 1.0], 0.0, fixed()).unwrap();
    scene.add_box([-8.0, 4.0], [1.0, 8.0], 0.0, fixed()).unwrap();
    scene.add_box([8.0, 4.0], [1.0, 8.0], 0.0, fixed()).unwrap();
    scene
}

fn throw(random: &mut Pcg64, scene: &mut Scene, k: u32) {
    let center = [1.6 * (f64::from(k % 8) - 3.5), 1.2 + 1.7 * f64::from(k / 8)];
    let options = BodyOptions { density: if random.random_bool(0.1) { 1e3 } else { 1.0 }, ..BodyOptions::default() };
    if random.random_bool(0.5) {
        let size = [random.random_range(0.2..1.0), random.random_range(0.2..1.0)];
        scene.add_box(center, size, random.random_range(-1.6..1.6), options).unwrap();
    } else {
        let (corners, turn) = (random.random_range(3..8), random.random_range(0.0..TAU));
        let corner = |i: u32| (turn + TAU * f64::from(i) / f64::from(corners)).sin_cos();
        let at = |(sin, cos): (f64, f64)| [center[0] + 0.6 * cos, center[1] + 0.6 * sin];
        scene.add_polygon(&(0..corners).map(corner).map(at).collect::<Vec<_>>(), options).unwrap();
    }
}

/// No energy gained, every problem solved; no overlap deeper than a micrometre but where a small body is jammed between large
/// ones (1 step of 18,000 here); Coulomb's law in 99 steps of a hundred.
#[test]
fn random_scenes_keep_the_rules() {
    let (mut steps, mut off, mut jammed) = (0, 0, 0);
    for seed in 0..60 {
        let mut random = Pcg64::seed_from_u64(seed);
        let friction = *[0.0, 0.1, 0.5, 1.0, 3.0].choose(&mut random).unwrap();
        let dt = *[1.0 / 240.0, 1.0 / 60.0, 1e-3].choose(&mut random).unwrap();
        let mut scene = pit(friction);
        let count = random.random_range(1..30);
        (0..count).for_each(|k| throw(&mut random, &mut scene, k));
        let mut world = World::new(scene, Options { dt, ..Options::default() }).unwrap();
        let names: Vec<String> = world.scene().bodies().iter().skip(3).map(|body| body.name.clone()).collect();
        for name in names {
            world.set_velocity(&name, std::array::from_fn(|_| random.random_range(-3.0..3.0))).unwrap();
        }
        let mut energy = world.energy();
        for step in 0..300 {
            let context = || format!("seed {seed}, step {step}, friction {friction}, dt {dt}");
            let record = world.step().unwrap_or_else(|failure| panic!("{}: {failure}", context()));
            jammed += usize::from(record.penetration > 1e-6);
            assert!(record.residual <= if record.exact { 1e-8 } else { 1e-4 }, "{}: {:e}", context(), record.residual);
            let now = world.energy();
            assert!(now <= energy + 1e-12 * energy.abs().max(1.0), "{}: {energy} to {now}", context());
            energy = now;
            steps += 1;
            off += usize::from(record.friction_error > 1e-8);
        }
    }
    assert!(jammed <= 5, "{jammed} of {steps} steps");
    assert!(100 * off <= steps, "{off} of {steps} steps");
}

/// With any restitution and friction, whatever the formulation, no step gives energy.
#[test]
fn rebounds_give_no_energy() {
    let mut rebounds = 0;
    for seed in 0..40 {
        let mut random = Pcg64::seed_from_u64(500 + seed);
        let mut pick = |of: &[f64]| *of.choose(&mut random).unwrap();
        let (friction, restitution) = (pick(&[0.0, 0.1, 0.5, 1.0, 2.0]), pick(&[0.2, 0.6, 0.9, 1.0]));
        let dt = pick(&[1.0 / 240.0, 1.0 / 60.0]);
        let formulation = if seed % 4 == 3 { Formulation::Acceleration } else { Formulation::Velocity };
        let mut scene = pit(friction);
        let count = random.random_range(1..12);
        (0..count).for_each(|k| throw(&mut random, &mut scene, k));
        let options = Options { dt, restitution, formulation, ..Options::default() };
        let mut world = World::new(scene, options).unwrap();
        let names: Vec<String> = world.scene().bodies().iter().skip(3).map(|body| body.name.clone()).collect();
        for name in names {
            world.set_velocity(&name, std::array::from_fn(|_| random.random_range(-5.0..5.0))).unwrap();
        }
        let mut energy = world.energy();
        for step in 0..120 {
            let context = || format!("seed {seed}, step {step}, friction {friction}, restitution {restitution}");
            world.step().unwrap_or_else(|failure| panic!("{}: {failure}", context()));
            let now = world.energy();
            assert!(now <= energy + 1e-12 * energy.abs().max(1.0), "{}: {energy} to {now}", context());
            energy = now;
            rebounds += usize::from(world.contact_impulses().iter().any(|contact| contact.along_normal > 0.0));
        }
    }
    assert!(rebounds > 1000);
}

/// Impacts with full restitution take nothing: a block that falls again and again loses what the integrator takes of a free fall, (g h)^2 / 2
/// in every step, and no more. (Where each step's gravity is added to a rebound it would go higher and higher.)
#[test]
fn an_elastic_block_loses_nothing_in_its_impacts() {
    let mut scene = Scene::new([0.0, -10.0], 0.5).unwrap();
    let fixed = BodyOptions { fixed: true, ..BodyOptions::default() };
    scene.add_box([0.0, -0.5], [4.0, 1.0], 0.0, fixed).unwrap();
    scene.add_box([0.0, 1.0], [1.0, 1.0], 0.0, BodyOptions::default()).unwrap();
    let mut world = World::new(scene, Options { restitution: 1.0, ..Options::default() }).unwrap();
    let (start, steps) = (world.energy(), 2400);
    let taken = f64::from(steps) * 0.5 * (10.0_f64 / 240.0).powi(2);
    let mut highest = 0.0_f64;
    for step in 0..steps {
        world.step().unwrap();
        if step > 2000 {
            highest = highest.max(world.poses().nth(1).unwrap()[1]);
        }
    }
    let energy = world.energy();
    assert!(energy <= start && energy >= start - 1.01 * taken, "{energy} of {start}, {taken}");
    assert!(highest >= 0.99 * energy / 10.0, "{highest}");
}
