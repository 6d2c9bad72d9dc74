//! Motion on the acceleration level: answers in closed form, agreement with the velocity level, and what happens where no
//! forces exist.

use crate::motion::{G, close, named, on_ground};
use drystone::{
    Scene, scenes,
    simulate::{Formulation, Options, Reuse, World},
};

fn options(dt: f64) -> Options {
    Options { dt, formulation: Formulation::Acceleration, ..Options::default() }
}

fn world(scene: Scene, dt: f64) -> World {
    World::new(scene, options(dt)).unwrap()
}

/// Makes steps; every one is solved, obeys Coulomb's law and has forces.
fn steps(world: &mut World, count: usize) {
    for _ in 0..count {
        let record = world.step().unwrap();
        assert!(record.residual <= 1e-9 && record.friction_error <= 1e-9, "{record:?}");
        assert_eq!(record.inconsistent, None);
    }
}

/// Coulomb: a = g (sin s - mu cos s) along the slope and nothing across it.
#[test]
fn a_block_slides_down_with_coulombs_acceleration() {
    for (degrees, mu) in [(30.0_f64, 0.3), (40.0, 0.5), (20.0, 0.0), (60.0, 1.2)] {
        let dt = 1.0 / 240.0;
        let mut world = world(scenes::slope(degrees, mu, 2.0, 0.5).unwrap(), dt);
        let n = 200;
        steps(&mut world, n);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let [vx, vy, turning] = world.velocities()[1];
        close(-(vx * cos + vy * sin) / (dt * n as f64), G * (sin - mu * cos), 1e-9);
        close(vy * cos - vx * sin, 0.0, 1e-9);
        close(turning, 0.0, 1e-9);
    }
}

/// Below tan(angle) = mu it stays, to the bit; above it does not.
#[test]
fn a_block_stays_below_the_angle_of_friction() {
    let mu = 0.5_f64;
    let limit = mu.atan().to_degrees();
    for (degrees, stays) in [(limit - 1e-6, true), (limit + 1e-6, false)] {
        let mut world = world(scenes::slope(degrees, mu, 2.0, 0.5).unwrap(), 1.0 / 240.0);
        let start = world.poses().nth(1).unwrap();
        steps(&mut world, 200);
        assert_eq!(world.poses().nth(1).unwrap() == start, stays, "{degrees}");
    }
}

/// A block thrown along the ground loses mu g of speed a second, and then stands to the bit: friction does not turn it back.
#[test]
fn a_thrown_block_comes_to_rest_and_stays() {
    let (mu, speed, dt) = (0.4, 3.0, 1.0 / 240.0);
    let mut scene = on_ground(mu);
    scene.add_box([0.0, 0.25], [2.0, 0.5], 0.0, named("block")).unwrap();
    let mut world = world(scene, dt);
    world.set_velocity("block", [speed, 0.0, 0.0]).unwrap();
    let stops = (speed / (mu * G) / dt) as usize;
    for step in 1..=stops {
        steps(&mut world, 1);
        close(world.velocities()[1][0], speed - mu * G * dt * step as f64, 1e-9);
    }
    steps(&mut world, 2);
    let rest = world.poses().nth(1).unwrap();
    assert_eq!(world.velocities()[1], [0.0; 3]);
    steps(&mut world, 100);
    assert_eq!(world.poses().nth(1).unwrap(), rest);
}

/// Friction holds it; it topples where tan(angle) > width / height.
#[test]
fn a_block_topples_from_its_limit_on() {
    let limit = (0.4_f64 / 1.0).atan().to_degrees();
    for (degrees, stands) in [(limit - 1e-3, true), (limit + 1e-3, false)] {
        let mut world = world(scenes::slope(degrees, 2.0, 0.4, 1.0).unwrap(), 1.0 / 240.0);
        steps(&mut world, 100);
        assert_eq!(world.motionless()[1], stands, "{degrees}");
    }
}

/// Inelastic runs: the energy after a step is at most the energy before it, and what should stand still does.
#[test]
fn energy_never_grows() {
    let runs = [
        (scenes::col20(0.5), 400, 21),
        (scenes::pyr13(0.5), 100, 92),
        (scenes::fall7(0.5), 700, 6),
        (scenes::falling_column(0.2), 500, 6),
        (scenes::three_segments(0.3), 500, 1),
    ];
    for (scene, count, still) in runs {
        let mut world = world(scene.unwrap(), 1.0 / 240.0);
        let start: Vec<_> = world.poses().take(still).collect();
        let mut energy = world.energy();
        for step in 0..count {
            let record = world.step().unwrap();
            let now = world.energy();
            assert!(now <= energy + 1e-12 * energy.abs(), "step {step}: {energy} to {now}");
            assert!(record.penetration <= 1e-6, "step {step}: {:e}", record.penetration);
            energy = now;
        }
        assert_eq!(world.poses().take(still).collect::<Vec<_>>(), start);
    }
}

/// Largest distance of places by the two formulations after `time`.
fn apart(scene: &Scene, time: f64, count: usize) -> f64 {
    let dt = time / count as f64;
    let places = [Formulation::Velocity, Formulation::Acceleration].map(|formulation| {
        let mut world = World::new(scene.clone(), Options { dt, formulation, ..Options::default() }).unwrap();
        for _ in 0..count {
            world.step().unwrap();
        }
        world.poses().collect::<Vec<_>>()
    });
    let [a, b] = places;
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Both come to the same motion as the step goes to zero, impacts included.
#[test]
fn the_two_formulations_agree_for_small_steps() {
    for (scene, time) in [(scenes::slope(40.0, 3.0, 0.4, 1.0), 0.4), (scenes::fall7(0.5), 0.8)] {
        let scene = scene.unwrap();
        let coarse = apart(&scene, time, 200);
        let fine = apart(&scene, time, 3200);
        assert!(fine <= 2e-3 && fine <= 0.5 * coarse.max(2e-9), "{coarse:e} and then {fine:e}");
    }
}

/// Painlevé's rod: thin, uniform, 2 m long, tan(angle) = 2, its lower end thrown along the ground away from the side on which
/// it leans. Friction of 4/3 is the least at which forces may not exist (Painlevé 1895). With the arm of the corner that
/// touches, from the centroid.
fn rod(friction: f64) -> (World, [f64; 2]) {
    let mut scene = on_ground(friction);
    let (length, width, angle) = (2.0, 1e-3, 2.0_f64.atan());
    let (sin, cos) = angle.sin_cos();
    // The corner furthest down is (-length / 2, -width / 2) in the rod's frame.
    let arm = [-0.5 * length * cos + 0.5 * width * sin, -0.5 * length * sin - 0.5 * width * cos];
    scene.add_box([0.0, -arm[1]], [length, width], angle, named("rod")).unwrap();
    let mut world = world(scene, 1e-3);
    world.set_velocity("rod", [-3.0, 0.0, 0.0]).unwrap();
    (world, arm)
}

/// Acceleration of the corner along the normal by a unit normal force and the friction that it brings, 1/kg.
fn own_acceleration(world: &World, [rx, ry]: [f64; 2], friction: f64) -> f64 {
    let scene = world.scene();
    let body = &scene.bodies()[1];
    // It slides to the left: the force is (mu, 1).
    let moment = rx - ry * friction;
    1.0 / body.mass() + rx * moment / body.inertia()
}

/// Where the corner's own acceleration is negative, and negative without a force too, no force lifts it: there is none. The step
/// names the contact and goes by impulses, which stop the corner at once; then it tips over its corner and lies down.
#[test]
fn painleves_rod_has_no_forces_and_goes_on_by_impulses() {
    let friction = 2.0;
    let (mut world, arm) = rod(friction);
    assert!(own_acceleration(&world, arm, friction) < -0.1);
    let free = -G; // at rest but for a velocity without turning, the corner falls freely
    assert!(free < 0.0);

    let energy = world.energy();
    let record = world.step().unwrap();
    let found = record.inconsistent.expect("no forces exist");
    assert_eq!((found.contact.bodies, found.status), ([0, 1], "no_solution"));
    assert_eq!(record.collisions, 0);
    assert!(record.friction_error <= 1e-9, "{record:?}");
    let [vx, vy, turning] = world.velocities()[1];
    close(vx - turning * arm[1], 0.0, 1e-9);
    close(vy + turning * arm[0], 0.0, 1e-9);
    assert!(world.energy() < energy);
    for _ in 0..3000 {
        let (energy, record) = (world.energy(), world.step().unwrap());
        assert!(world.energy() <= energy + 1e-12 * energy.abs());
        assert!(record.penetration <= 1e-6);
    }
    assert!(world.motionless()[1], "it lies");
}

/// Just below the limit forces exist, and they are what the corner's own acceleration asks for: f = (g - a_n) / own.
#[test]
fn below_painleves_limit_the_rod_slides_by_forces() {
    let friction = 1.3;
    let (mut world, arm) = rod(friction);
    let own = own_acceleration(&world, arm, friction);
    assert!((0.0..0.1).contains(&(own * world.scene().bodies()[1].mass())), "{own}");
    let record = world.step().unwrap();
    assert_eq!(record.inconsistent, None);
    assert!(record.friction_error <= 1e-9, "{record:?}");
    let contact = world.contact_impulses().into_iter().find(|contact| contact.along_normal > 0.0).unwrap();
    close(contact.along_normal / 1e-3, G / own, 1e-6 * G / own);
    // The tangent is the normal turned a quarter counter-clockwise.
    let ([x, y], [nx, ny]) = (contact.impulse, contact.normal);
    close(y * nx - x * ny, -friction * contact.along_normal, 1e-9); // to the right, against t
}

/// Off both ends of what forces can do: blocks that collide are given impulses first, with the rebound asked for.
#[test]
fn collisions_are_impulses_of_their_own() {
    for restitution in [0.0, 0.5] {
        let mut scene = on_ground(0.5);
        scene.add_box([0.0, 0.5 + 0.1], [1.0, 1.0], 0.0, named("block")).unwrap();
        let mut world = World::new(scene, Options { restitution, ..options(1.0 / 240.0) }).unwrap();
        world.set_velocity("block", [0.0, -3.0, 0.0]).unwrap();
        let (mut arriving, mut collisions) = (0.0, 0);
        while collisions == 0 {
            arriving = world.velocities()[1][1];
            collisions = world.step().unwrap().collisions;
        }
        assert_eq!(collisions, 2, "both corners");
        // The step's weight acts after the impulse, unless the block is stopped to close the rest of the gap.
        let expected = if restitution > 0.0 { -restitution * arriving - G / 240.0 } else { 0.0 };
        let gap_speed = if restitution > 0.0 { 1e-9 } else { 0.1 * 240.0 };
        close(world.velocities()[1][1], expected, gap_speed);
        (0..300).for_each(|_| drop(world.step().unwrap()));
        assert!(world.motionless()[1] && world.poses().nth(1).unwrap()[1] >= 0.5 - 1e-6);
    }
}

/// What a step takes over changes the work, not the motion.
#[test]
fn the_three_modes_of_reuse_move_alike() {
    let scenes = [
        (scenes::col20(0.5), 200),
        (scenes::slope(35.0, 0.5, 1.0, 1.0), 500),
        (scenes::slope(40.0, 2.0, 0.4, 1.0), 500),
        (scenes::fall7(0.5), 700),
        (scenes::falling_column(0.2), 700),
        (scenes::arch(12, 0.2, 0.7), 100),
    ];
    for (scene, count) in scenes {
        let scene = scene.unwrap();
        let mut worlds = [Reuse::None, Reuse::Motionless, Reuse::Full]
            .map(|reuse| World::new(scene.clone(), Options { reuse, ..options(1.0 / 240.0) }).unwrap());
        for step in 0..count {
            worlds.iter_mut().for_each(|world| drop(world.step().unwrap()));
            let [reference, others @ ..] = &worlds;
            for other in others {
                for (a, b) in reference.poses().flatten().zip(other.poses().flatten()) {
                    assert!((a - b).abs() <= 1e-9, "step {step}: {a} and {b} by {:?}", other.options().reuse);
                }
            }
        }
    }
}

/// Islands with something that slides start from the rows that bore in the step before.
#[test]
fn full_reuse_saves_more_than_half_of_the_pivots() {
    for scene in [scenes::fall7(0.5), scenes::falling_column(0.2)] {
        let scene = scene.unwrap();
        let [none, full] = [Reuse::None, Reuse::Full].map(|reuse| {
            let mut world = World::new(scene.clone(), Options { reuse, ..options(1.0 / 240.0) }).unwrap();
            (0..600).map(|_| world.step().unwrap().counts.pivots).sum::<usize>()
        });
        assert!(2 * full < none, "{full} of {none}");
    }
}

/// Where nothing moves, a step takes no pivot; a snapshot goes on bit for bit.
#[test]
fn what_is_kept_between_steps_is_in_the_snapshot() {
    let mut still = world(scenes::wall84(1, 0.5).unwrap(), 1.0 / 240.0);
    still.step().unwrap();
    assert_eq!(still.step().unwrap().counts.pivots, 0);

    let mut falling = world(scenes::fall7(0.5).unwrap(), 1.0 / 240.0);
    (0..250).for_each(|_| drop(falling.step().unwrap()));
    let mut again: World = World::restore(&falling.snapshot()).unwrap();
    assert_eq!(again.options().formulation, Formulation::Acceleration);
    for _ in 0..150 {
        falling.step().unwrap();
        again.step().unwrap();
        assert_eq!(falling.hash(), again.hash());
    }
}

/// A heap of boxes with many contacts that slide: forces are found in 99 steps of 100 and more (where they are not is named),
/// they obey Coulomb's law, and no step adds energy.
#[test]
fn a_heap_has_forces_in_nearly_every_step() {
    let mut world = world(scenes::drop84(5, 0.5).unwrap(), 1.0 / 240.0);
    let (mut energy, mut without) = (world.energy(), 0);
    for step in 0..600 {
        let record = world.step().unwrap();
        without += usize::from(record.inconsistent.is_some());
        assert!(record.friction_error <= 1e-8, "step {step}: {:e}", record.friction_error);
        assert!(record.penetration <= 1e-6, "step {step}: {:e}", record.penetration);
        assert!(world.energy() <= energy + 1e-12 * energy.abs(), "step {step}");
        energy = world.energy();
    }
    assert!(without <= 6, "{without}");
}
