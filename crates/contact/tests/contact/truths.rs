//! Answers that are known.

use crate::common::{departure, in_space, tower};
use drystone_contact::{Bodies, Contact, Settings, Status};

const FALL: f64 = 9.81 / 240.0;

/// A block on a slope stays if tan(angle) <= mu; else it slides at g (sin - mu cos), straight down, whatever way the slope looks.
#[test]
fn a_block_on_a_slope() {
    for way in [0.0, 0.3, 1.0, 2.5] {
        for (angle, slides) in [(0.46_f64, false), (0.47, true), (0.8, true)] {
            let problem = tower(&[2.0], 0.5, [angle, way]);
            let solution = problem.solve(None, &Settings::default()).unwrap();
            assert_eq!(solution.status, Status::Solved);
            assert!(departure(&problem, &solution) < 1e-9, "{:e}", departure(&problem, &solution));
            let speed = if slides { FALL * (angle.sin() - 0.5 * angle.cos()) } else { 0.0 };
            let expected = [speed * way.cos(), speed * way.sin(), 0.0, 0.0, 0.0, 0.0];
            for (v, expected) in solution.velocities.iter().zip(expected) {
                assert!((v - expected).abs() < 1e-9, "{angle} {way}: {:?}", solution.velocities);
            }
            let normal: f64 = solution.impulses.iter().step_by(3).sum();
            assert!((normal - 2.0 * FALL * angle.cos()).abs() < 1e-9);
        }
    }
}

/// A tower stands, light under heavy too, and its feet bear its weight.
#[test]
fn towers_stand() {
    for masses in [vec![1.0; 12], vec![1.0, 1e6], vec![1e6, 1.0], vec![1.0, 1e3, 1.0, 1e3]] {
        let problem = tower(&masses, 0.5, [0.0, 0.0]);
        let solution = problem.solve(None, &Settings::default()).unwrap();
        assert_eq!(solution.status, Status::Solved, "{masses:?}: {:e}", solution.error);
        assert!(solution.velocities.iter().all(|v| v.abs() <= 1e-8 * FALL), "{masses:?}: {:?}", solution.velocities);
        let feet: f64 = solution.impulses[..12].iter().step_by(3).sum();
        let weight = FALL * masses.iter().sum::<f64>();
        assert!((feet / weight - 1.0).abs() < 1e-7, "{masses:?}");
    }
}

/// A ball that arrives at 2 m/s parts at a half of it; one whose gap stays open is not touched, to the bit.
#[test]
fn offsets_are_gaps_and_rebounds() {
    let ball = |offset: f64| Bodies {
        size: 6,
        inverse_mass: vec![1.0; 6],
        free: vec![0.7, 0.0, -2.0, 0.1, 0.2, 0.3],
        contacts: vec![in_space(&[[0.0; 3]], [None, Some(0)], [0.0, 0.0, -0.5], [0.0, 0.0, 1.0], 0.0, offset)],
    };
    let rebounds = ball(-1.0).solve(None, &Settings::default()).unwrap();
    assert!((rebounds.velocities[2] - 1.0).abs() < 1e-12);
    let closes = ball(0.5).solve(None, &Settings::default()).unwrap();
    assert!((closes.velocities[2] + 0.5).abs() < 1e-12);
    let apart = ball(2.5).solve(None, &Settings::default()).unwrap();
    assert_eq!(apart.velocities, ball(2.5).free);
    assert_eq!((apart.error, apart.impulses), (0.0, vec![0.0; 3]));
}

/// A ball with a spin about y that touches the ground: it slides until the surface stands still (Coulomb), or friction is spent.
#[test]
fn a_spinning_ball_takes_up_speed() {
    // Unit mass, radius .5, moment of inertia .1: to stop the surface takes p = speed / (1 + .25 / .1) = speed / 3.5.
    for (spin, friction) in [(0.2, 0.5), (20.0, 0.5), (20.0, 5.0)] {
        let problem = Bodies {
            size: 6,
            inverse_mass: vec![1.0, 1.0, 1.0, 10.0, 10.0, 10.0],
            free: vec![0.0, 0.0, -1.0, 0.0, spin, 0.0],
            contacts: vec![in_space(&[[0.0; 3]], [None, Some(0)], [0.0, 0.0, -0.5], [0.0, 0.0, 1.0], friction, 0.0)],
        };
        let solution = problem.solve(None, &Settings::default()).unwrap();
        let needed: f64 = 0.5 * spin / 3.5;
        let p = needed.min(friction);
        assert!((solution.velocities[0] - p).abs() < 1e-9, "{spin} {friction}: {:?}", solution.velocities);
        assert!(departure(&problem, &solution) < 1e-9);
    }
}

/// The answer as a start: nothing is left to do, and it stays to the bit. The same input gives the same bits.
#[test]
fn starts_and_bits() {
    let problem = tower(&[1.0, 2.0, 3.0], 0.4, [0.5, 0.3]);
    let once = problem.solve(None, &Settings::default()).unwrap();
    let twice = problem.solve(None, &Settings::default()).unwrap();
    assert_eq!((&once.velocities, &once.impulses), (&twice.velocities, &twice.impulses));
    let again = problem.solve(Some(&once.impulses), &Settings::default()).unwrap();
    assert!(again.counts.sweeps + again.counts.newton_steps <= 2, "{:?}", again.counts);
    for (a, b) in again.velocities.iter().zip(&once.velocities) {
        assert!((a - b).abs() < 1e-10);
    }
}

/// Where the limit comes first the best is handed back, with its error, and says so.
#[test]
fn a_limit_is_a_status() {
    let problem = tower(&[1.0, 1e6, 1.0, 1e6], 0.5, [0.3, 0.2]);
    let settings = Settings { newton_steps: 0, ..Settings::default() };
    let solution = problem.solve(None, &settings).unwrap();
    assert_eq!(solution.status, Status::Limit);
    assert!(solution.error > solution.tolerance && solution.error < FALL);
    assert!(solution.velocities.iter().all(|v| v.is_finite()));
}

/// A block that has to part from both walls it is jammed between: there is no answer, and the search for one ends.
#[test]
fn what_is_jammed_has_no_solution() {
    for friction in [0.0, 0.5] {
        let rows = |sign: f64| {
            let mut rows = [[0.0; 6]; 3];
            (rows[0][0], rows[1][1]) = (sign, sign);
            rows
        };
        let wall = |sign: f64| Contact {
            bodies: [None, Some(0)],
            jacobian: [[[0.0; 6]; 3], rows(sign)],
            friction,
            offset: -0.1,
        };
        let contacts = vec![wall(1.0), wall(-1.0)];
        let problem = Bodies { size: 3, inverse_mass: vec![1.0; 3], free: vec![0.0; 3], contacts };
        for start in [None, Some(&[0.1, 0.0, 0.1, 0.0][..])] {
            let solution = problem.solve(start, &Settings::default()).unwrap();
            assert_eq!(solution.status, Status::Limit);
            assert!((solution.error - 0.1).abs() < 0.05, "{:e}", solution.error);
        }
    }
}

/// Nothing to solve.
#[test]
fn without_contacts() {
    let problem = Bodies { size: 3, inverse_mass: vec![1.0; 3], free: vec![1.0, 2.0, 3.0], contacts: Vec::new() };
    let solution = problem.solve(None, &Settings::default()).unwrap();
    assert_eq!((solution.velocities, solution.status), (vec![1.0, 2.0, 3.0], Status::Solved));
}
