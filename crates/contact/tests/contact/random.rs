//! Heaps without order.

use crate::common::{departure, energy, in_space};
use drystone_contact::{Bodies, Contact, Settings, Status};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Boxes on a grid, each with four corners on what is below it, thrown about.
fn heap(generator: &mut Pcg64Mcg, layers: usize, friction: f64) -> Bodies {
    let mut centers = Vec::new();
    for layer in 0..layers {
        for i in 0..3 {
            for j in 0..3 {
                let shift = 0.3 * layer as f64;
                centers.push([i as f64 + shift, j as f64 + 0.5 * shift, layer as f64 + 0.5]);
            }
        }
    }
    let mut problem = Bodies { size: 6, ..Bodies::default() };
    for _ in &centers {
        let mass: f64 = generator.random_range(0.2..5.0);
        problem.inverse_mass.extend([1.0 / mass, 1.0 / mass, 1.0 / mass, 6.0 / mass, 6.0 / mass, 6.0 / mass]);
        problem.free.extend((0..6).map(|k| generator.random_range(-0.3..0.3) - if k == 2 { 0.2 } else { 0.0 }));
    }
    for (k, [x, y, z]) in centers.iter().enumerate() {
        for [i, j] in [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
            let point = [x + i, y + j, z - 0.5];
            let over = |below: &[f64; 3]| {
                (point[0] - below[0]).abs() <= 0.5
                    && (point[1] - below[1]).abs() <= 0.5
                    && (below[2] + 0.5 - point[2]).abs() < 0.1
            };
            let below = centers.iter().position(over);
            if below.is_none() && z - 0.5 > 0.1 {
                continue;
            }
            let tilt: f64 = generator.random_range(-0.2..0.2);
            let normal = [tilt.sin(), 0.0, tilt.cos()];
            let offset = [0.0, generator.random_range(0.0..0.05)][generator.random_range(0..2)];
            problem.contacts.push(in_space(&centers, [below, Some(k)], point, normal, friction, offset));
        }
    }
    problem
}

/// Solved, by conditions that are computed again; and no energy comes from contacts.
#[test]
fn heaps_obey_the_law() {
    let mut generator = Pcg64Mcg::seed_from_u64(5);
    for round in 0..60 {
        let problem = heap(&mut generator, 1 + round % 4, [0.0, 0.2, 0.5, 0.9][round % 4]);
        let solution = problem.solve(None, &Settings::default()).unwrap();
        assert_eq!(solution.status, Status::Solved, "{round}: {:e}", solution.error);
        assert!(solution.error <= solution.tolerance);
        let speed = problem.free.iter().fold(0.0_f64, |fastest, v| fastest.max(v.abs()));
        assert!(departure(&problem, &solution) <= 1e-6 * speed, "{round}: {:e}", departure(&problem, &solution));
        let (before, after) = (energy(&problem, &problem.free), energy(&problem, &solution.velocities));
        assert!(after <= before * (1.0 + 1e-9), "{round}: {before} to {after}");
    }
}

/// Large heaps that are hit, in as many Newton steps as a simulation spends on them.
#[test]
fn large_heaps_are_solved() {
    let mut generator = Pcg64Mcg::seed_from_u64(34);
    let settings = Settings { newton_steps: 200, ..Settings::default() };
    let mut solved = 0;
    for round in 0..16 {
        let problem = heap(&mut generator, 6, [0.3, 0.6][round % 2]);
        solved += usize::from(problem.solve(None, &settings).unwrap().status == Status::Solved);
    }
    assert_eq!(solved, 16);
}

/// A wall in the plane, its boxes thrown about: each bears on two below it, at two points each, whose normals lean this way and that.
fn wall(generator: &mut Pcg64Mcg, size: usize, friction: f64) -> Bodies {
    let mut problem = Bodies { size: 3, ..Bodies::default() };
    for _ in 0..size * size {
        let mass: f64 = generator.random_range(0.2..5.0);
        problem.inverse_mass.extend([1.0 / mass, 1.0 / mass, 6.0 / mass]);
        problem.free.extend([0.0, -0.04, 0.0].map(|v| v + generator.random_range(-0.1..0.1)));
    }
    let center = |body: usize| [(body % size) as f64 + 0.5 * (body / size % 2) as f64, (body / size) as f64 + 0.5];
    for body in 0..size * size {
        let [x, y] = center(body);
        for corner in [x - 0.5, x + 0.5] {
            let is_below = |below: &usize| below / size + 1 == body / size && (center(*below)[0] - corner).abs() < 0.1;
            let below = (0..size * size).find(is_below);
            if below.is_none() && body >= size {
                continue;
            }
            let tilt: f64 = generator.random_range(-0.1..0.1);
            let axes = [[-tilt.sin(), tilt.cos()], [-tilt.cos(), -tilt.sin()], [0.0; 2]];
            for point in [corner, x] {
                let row = |at: Option<usize>, sign: f64| {
                    let [cx, cy] = at.map(center).unwrap_or_default();
                    let lever = [point - cx, y - 0.5 - cy];
                    axes.map(|d| [sign * d[0], sign * d[1], sign * (lever[0] * d[1] - lever[1] * d[0]), 0.0, 0.0, 0.0])
                };
                let jacobian = [row(below, -1.0), row(Some(body), 1.0)];
                let offset = [0.0, generator.random_range(0.0..0.02)][generator.random_range(0..2)];
                problem.contacts.push(Contact { bodies: [below, Some(body)], jacobian, friction, offset });
            }
        }
    }
    problem
}

/// Walls in the plane that are hit from above, from the impulses before that. Newton's method on active sets goes round in circles on most of
/// them, and softened problems, one after the other, left five of forty.
#[test]
fn walls_in_the_plane_are_solved_piece_by_piece() {
    let mut generator = Pcg64Mcg::seed_from_u64(17);
    let settings = Settings { newton_steps: 200, ..Settings::default() };
    let mut solved = 0;
    for round in 0..20 {
        let mut problem = wall(&mut generator, 6, [0.3, 0.8][round % 2]);
        let before = problem.solve(None, &settings).unwrap();
        problem.free[90..].iter_mut().for_each(|v| *v += generator.random_range(-1.0..1.0));
        let after = problem.solve(Some(&before.impulses), &settings).unwrap();
        solved += [&before, &after].iter().filter(|solution| solution.status == Status::Solved).count();
        let [begin, end] = [&problem.free, &after.velocities].map(|velocities| energy(&problem, velocities));
        assert!(end <= begin * (1.0 + 1e-9), "{round}: {begin} to {end}");
    }
    assert_eq!(solved, 40);
}

/// Walls that are hit hard: Newton's method and ways that begin at an error leave most of them, the way from nothing arrives at all.
#[test]
fn the_way_from_nothing_arrives() {
    let mut generator = Pcg64Mcg::seed_from_u64(29);
    let with = Settings { newton_steps: 100, ..Settings::default() };
    let without = Settings { changes: 0, ..with };
    let mut left = 0;
    for round in 0..20 {
        let mut problem = wall(&mut generator, 8, [0.3, 0.8][round % 2]);
        let begin = problem.solve(None, &with).unwrap();
        problem.free[150..].iter_mut().for_each(|v| *v += generator.random_range(-5.0..5.0));
        let start = Some(&begin.impulses[..]);
        left += usize::from(problem.solve(start, &without).unwrap().status == Status::Limit);
        let found = problem.solve(start, &with).unwrap();
        assert_eq!(found.status, Status::Solved, "{round}: {:e} of {:e}", found.error, found.tolerance);
        let speed = problem.free.iter().fold(0.0_f64, |fastest, v| fastest.max(v.abs()));
        assert!(departure(&problem, &found) <= 1e-6 * speed, "{round}: {:e}", departure(&problem, &found));
    }
    assert!(left >= 10, "{left}");
}

/// Masses in another unit: the same velocities, to the bit where the factor has a root without rounding.
#[test]
fn units_of_mass_do_not_matter() {
    let mut generator = Pcg64Mcg::seed_from_u64(8);
    let problem = heap(&mut generator, 2, 0.5);
    let once = problem.solve(None, &Settings::default()).unwrap();
    let factor = 2.0_f64.powi(20);
    let mut other = problem.clone();
    other.inverse_mass.iter_mut().for_each(|inverse| *inverse /= factor);
    let again = other.solve(None, &Settings::default()).unwrap();
    assert_eq!(once.velocities, again.velocities);
    assert!(once.impulses.iter().zip(&again.impulses).all(|(a, b)| a * factor == *b));
}

/// The other way in: twice the contacts, in another order and with other tangents, give the same motion.
#[test]
fn contacts_twice_change_nothing() {
    let mut generator = Pcg64Mcg::seed_from_u64(21);
    let problem = heap(&mut generator, 2, 0.4);
    let once = problem.solve(None, &Settings::default()).unwrap();
    let mut other = problem.clone();
    for contact in problem.contacts.iter().rev() {
        let mut turned = contact.clone();
        for rows in &mut turned.jacobian {
            let [n, one, two] = *rows;
            let mix = |a: f64, b: f64| [0, 1, 2, 3, 4, 5].map(|k| a * one[k] + b * two[k]);
            *rows = [n, mix(0.6, 0.8), mix(-0.8, 0.6)];
        }
        other.contacts.push(turned);
    }
    let again = other.solve(None, &Settings::default()).unwrap();
    assert_eq!((once.status, again.status), (Status::Solved, Status::Solved));
    for (a, b) in once.velocities.iter().zip(&again.velocities) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}
