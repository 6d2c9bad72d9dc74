//! Motion against answers known in closed form, and what must hold in every step: no drift, no energy gained.

use crate::motion::{G, close, named, on_ground};
use drystone::{
    BodyOptions, Scene, scenes,
    simulate::{Options, World},
};
use std::f64::consts::TAU;

fn world(scene: Scene, dt: f64) -> World {
    World::new(scene, Options { dt, ..Options::default() }).unwrap()
}

fn weightless(friction: f64) -> Scene {
    Scene::new([0.0, 0.0], friction).unwrap()
}

fn steps(world: &mut World, count: usize) {
    for _ in 0..count {
        let record = world.step().unwrap();
        assert!(record.residual <= 1e-9 && record.friction_error <= 1e-9, "{record:?}");
    }
}

/// Coulomb: a = g (sin s - mu cos s) along the slope and nothing across it. The integrator's place after n steps is
/// a h^2 n (n + 1) / 2.
#[test]
fn a_block_slides_down_with_coulombs_acceleration() {
    for (degrees, mu) in [(30.0_f64, 0.3), (40.0, 0.5), (20.0, 0.0), (60.0, 1.2)] {
        let dt = 1.0 / 240.0;
        let mut world = world(scenes::slope(degrees, mu, 2.0, 0.5).unwrap(), dt);
        let start = world.poses().nth(1).unwrap();
        let n = 200;
        steps(&mut world, n);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let acceleration = G * (sin - mu * cos);
        let [vx, vy, turning] = world.velocities()[1];
        let time = dt * n as f64;
        close(-(vx * cos + vy * sin) / time, acceleration, 1e-9);
        close(vy * cos - vx * sin, 0.0, 1e-9);
        close(turning, 0.0, 1e-9);
        let [x, y, _] = world.poses().nth(1).unwrap();
        let along = -((x - start[0]) * cos + (y - start[1]) * sin);
        close(along, 0.5 * acceleration * dt * dt * (n * (n + 1)) as f64, 1e-9);
        close((y - start[1]) * cos - (x - start[0]) * sin, 0.0, 1e-9);
    }
}

/// A block thrown along the ground loses mu g of speed a second, and then stands to the bit.
#[test]
fn a_thrown_block_comes_to_rest_and_stays() {
    let (mu, speed, dt) = (0.4, 3.0, 1.0 / 240.0);
    let mut scene = on_ground(mu);
    scene.add_box([0.0, 0.25], [2.0, 0.5], 0.0, named("block")).unwrap();
    let mut world = world(scene, dt);
    world.set_velocity("block", [speed, 0.0, 0.0]).unwrap();
    let stops = speed / (mu * G);
    steps(&mut world, (stops / dt) as usize);
    assert!(world.velocities()[1][0] > 0.0);
    steps(&mut world, 2);
    let rest = world.poses().nth(1).unwrap();
    close(rest[0], 0.5 * speed * stops, speed * dt);
    steps(&mut world, 100);
    assert_eq!(world.poses().nth(1).unwrap(), rest);
    assert_eq!(world.velocities()[1], [0.0; 3]);
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

/// About its lower corner a block is a pendulum: angle'' = g r sin(phi) / k^2 with k^2 = 4 r^2 / 3, phi the angle of the arm r
/// from the vertical. Turn after `time` from rest on a slope, by the classical Runge-Kutta method.
fn pendulum(degrees: f64, width: f64, height: f64, time: f64) -> f64 {
    let arm = 0.5 * width.hypot(height);
    let start = degrees.to_radians() - (width / height).atan();
    let acceleration = |phi: f64| 0.75 * G / arm * phi.sin();
    let (n, mut phi, mut speed) = (10_000, start, 0.0);
    let h = time / f64::from(n);
    for _ in 0..n {
        let (k1, l1) = (speed, acceleration(phi));
        let (k2, l2) = (speed + 0.5 * h * l1, acceleration(phi + 0.5 * h * k1));
        let (k3, l3) = (speed + 0.5 * h * l2, acceleration(phi + 0.5 * h * k2));
        let (k4, l4) = (speed + h * l3, acceleration(phi + h * k3));
        phi += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        speed += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    phi - start
}

/// The integrator is of first order: half the step, half the error.
#[test]
fn toppling_follows_the_pendulum_to_first_order() {
    let (degrees, width, height, time) = (40.0, 0.4, 1.0, 0.4);
    let expected = pendulum(degrees, width, height, time);
    let error = |n: usize| {
        let mut world = world(scenes::slope(degrees, 3.0, width, height).unwrap(), time / n as f64);
        let start = world.poses().nth(1).unwrap()[2];
        steps(&mut world, n);
        world.poses().nth(1).unwrap()[2] - start - expected
    };
    let errors: Vec<f64> = [100, 200, 400, 800].map(error).to_vec();
    assert!(errors[0].abs() < 0.02 * expected, "{errors:?}, turn {expected}");
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((1.8..2.2).contains(&ratio), "{errors:?}");
    }
}

/// A hexagon rolls over its corners without a ball's help. At each impact the old corner lifts off and angular momentum
/// about the new one is kept: w+ / w- = (I + m R^2 cos(60)) / (I + m R^2), R the radius (the rimless wheel: McGeer 1990).
#[test]
fn a_hexagon_rolls_over_its_corners() {
    let mut scene = on_ground(10.0);
    let lift = 0.75_f64.sqrt();
    let corner = |k: i32| (TAU * f64::from(k) / 6.0).sin_cos();
    // The lowest face is flat on the ground; its right end is at x = 0.5.
    let corners: Vec<[f64; 2]> = (0..6).map(corner).map(|(sin, cos)| [cos, sin + lift]).collect();
    scene.add_polygon(&corners, named("wheel")).unwrap();
    let body = &scene.bodies()[1];
    let (inertia, mass) = (body.inertia(), body.mass());
    let mut world = world(scene, 2e-5);
    // Clockwise about the right end of the lowest face: enough speed to pass the top.
    let begin = 3.0;
    world.set_velocity("wheel", [begin * lift, begin * 0.5, -begin]).unwrap();
    let (mut before, mut ratio) = (0.0, None);
    for _ in 0..60_000 {
        world.step().unwrap();
        let now = world.velocities()[1][2];
        // Down the other side it speeds up; the impact is the sudden drop of |w|.
        if now.abs() < 0.9 * f64::abs(before) && before != 0.0 {
            for _ in 0..3 {
                world.step().unwrap();
            }
            ratio = Some(world.velocities()[1][2] / before);
            break;
        }
        before = now;
    }
    close(ratio.expect("it reaches the next face"), (inertia + 0.5 * mass) / (inertia + mass), 2e-3);
}

fn momentum(world: &World) -> [f64; 3] {
    let mut total = [0.0; 3];
    for (body, [vx, vy, turning]) in world.scene().bodies().iter().zip(world.velocities()) {
        let ([x, y], m) = (body.pose.position, body.mass());
        total[0] += m * vx;
        total[1] += m * vy;
        total[2] += m * (x * vy - y * vx) + body.inertia() * turning;
    }
    total
}

/// Two blocks meet off centre in free space: linear and angular momentum stay, energy does not grow.
#[test]
fn an_impact_keeps_momentum() {
    for restitution in [0.0, 0.5] {
        let mut scene = weightless(0.3);
        scene.add_box([0.0, 0.0], [1.0, 1.0], 0.2, named("a")).unwrap();
        let heavy = BodyOptions { density: 3.0, ..named("b") };
        scene.add_box([3.0, 0.6], [1.0, 2.0], -0.3, heavy).unwrap();
        let mut world = World::new(scene, Options { restitution, ..Options::default() }).unwrap();
        world.set_velocity("a", [5.0, 0.5, 1.0]).unwrap();
        let (mut expected, energy) = (momentum(&world), world.energy());
        let mut touched = false;
        for _ in 0..400 {
            let record = world.step().unwrap();
            touched |= world.contact_impulses().iter().any(|contact| contact.along_normal > 0.0);
            let now = momentum(&world);
            (0..2).for_each(|axis| close(now[axis], expected[axis], 1e-12));
            // Taking an overlap of micrometres back moves places under velocities that stay: their moment changes by as much.
            close(now[2], expected[2], if record.projections > 0 { 1e-4 } else { 1e-11 });
            expected[2] = now[2];
            assert!(world.energy() <= energy * (1.0 + 1e-12));
        }
        assert!(touched && world.energy() < 0.95 * energy);
    }
}

/// Equal blocks, head on, all of the speed comes back: they exchange velocities.
#[test]
fn with_full_restitution_equal_blocks_exchange_velocities() {
    let mut scene = weightless(0.0);
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, named("a")).unwrap();
    scene.add_box([2.0, 0.0], [1.0, 1.0], 0.0, named("b")).unwrap();
    let mut world = World::new(scene, Options { restitution: 1.0, ..Options::default() }).unwrap();
    world.set_velocity("a", [2.0, 0.0, 0.0]).unwrap();
    steps(&mut world, 240);
    close(world.velocities()[0][0], 0.0, 1e-12);
    close(world.velocities()[1][0], 2.0, 1e-12);
}

/// Inelastic runs: the energy after a step is at most the energy before it.
#[test]
fn energy_never_grows() {
    let runs = [
        (scenes::falling_column(0.2), 700),
        (scenes::three_segments(0.3), 600),
        (scenes::fall7(0.5), 700),
        (scenes::arch(20, 0.08, 0.7), 300),
        (scenes::drop84(1, 0.5), 500),
    ];
    for (scene, count) in runs {
        let mut world = world(scene.unwrap(), 1.0 / 240.0);
        let mut energy = world.energy();
        for step in 0..count {
            world.step().unwrap();
            let now = world.energy();
            assert!(now <= energy + 1e-12 * energy.abs(), "step {step}: {energy} to {now}");
            energy = now;
        }
    }
}

/// After five seconds nothing that should stand still has moved by a bit.
#[test]
fn what_stands_still_keeps_its_place_to_the_bit() {
    for (dt, count) in [(1.0 / 240.0, 1200), (1e-3, 5000)] {
        for (name, still) in [("col20", 21), ("col50", 51), ("pyr13", 92), ("fall7", 6), ("wall84", 85)] {
            let scene = scenes::build(name, &std::collections::BTreeMap::new()).unwrap().in_plane().unwrap();
            let mut world = world(scene, dt);
            let start: Vec<_> = world.poses().take(still).collect();
            for step in 0..count {
                let record = world.step().unwrap();
                assert!(record.penetration <= 1e-6, "{name}, step {step}: {:e}", record.penetration);
            }
            assert_eq!(world.poses().take(still).collect::<Vec<_>>(), start, "{name} at dt = {dt}");
        }
    }
}

/// Blocks that fall, tip and slide: no overlap is deeper than a micrometre at the end of any step.
#[test]
fn overlaps_stay_below_a_micrometre() {
    let runs = [
        (scenes::falling_column(0.2), 700),
        (scenes::three_segments(0.3), 600),
        (scenes::arch(20, 0.08, 0.7), 400),
        (scenes::inverted_triangle(4, 0.3), 400),
        (scenes::drop84(2, 0.5), 600),
    ];
    for (scene, count) in runs {
        let mut world = world(scene.unwrap(), 1.0 / 240.0);
        for step in 0..count {
            let record = world.step().unwrap();
            assert!(record.penetration <= 1e-6, "step {step}: {:e}", record.penetration);
        }
    }
}

/// A block that slides over the seam of two level slabs is not stopped by the side of the second.
#[test]
fn seams_of_level_ground_stop_nothing() {
    for speed in [1.7, 2.9, 3.0] {
        let mut scene = Scene::new([0.0, -G], 0.0).unwrap();
        for (name, x) in [("left", -5.0), ("right", 5.0)] {
            let slab = BodyOptions { fixed: true, ..named(name) };
            scene.add_box([x, -0.5], [10.0, 1.0], 0.0, slab).unwrap();
        }
        scene.add_box([-2.0, 0.5], [1.0, 1.0], 0.0, named("block")).unwrap();
        let mut world = world(scene, 1.0 / 240.0);
        world.set_velocity("block", [speed, 0.0, 0.0]).unwrap();
        steps(&mut world, 400);
        let [x, y, angle] = world.poses().nth(2).unwrap();
        close(x, -2.0 + speed * 400.0 / 240.0, 1e-9);
        close(y, 0.5, 1e-9);
        close(angle, 0.0, 1e-9);
    }
}
