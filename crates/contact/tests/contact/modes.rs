//! In the plane, against all ways of parting, sticking and sliding left and right, each a dense linear system.

use crate::common::{departure, relative};
use drystone_contact::{Bodies, Contact, Settings, Status};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn random(generator: &mut Pcg64Mcg, bodies: usize, contacts: usize) -> Bodies {
    let mut problem = Bodies { size: 3, ..Bodies::default() };
    for _ in 0..3 * bodies {
        problem.inverse_mass.push(generator.random_range(0.3..3.0));
        problem.free.push(generator.random_range(-1.0..1.0));
    }
    for _ in 0..contacts {
        let second = generator.random_range(0..bodies);
        let first = Some(generator.random_range(0..=bodies)).filter(|&first| first < bodies && first != second);
        let angle: f64 = generator.random_range(0.0..std::f64::consts::TAU);
        let n = [angle.cos(), angle.sin()];
        let mut rows = |sign: f64| {
            let lever: [f64; 2] = [generator.random_range(-1.0..1.0), generator.random_range(-1.0..1.0)];
            let row =
                |d: [f64; 2]| [sign * d[0], sign * d[1], sign * (lever[0] * d[1] - lever[1] * d[0]), 0.0, 0.0, 0.0];
            [row(n), row([-n[1], n[0]]), [0.0; 6]]
        };
        let jacobian = [rows(-1.0), rows(1.0)];
        let friction = [0.0, 0.3, 0.8][generator.random_range(0..3)];
        let offset = generator.random_range(0.0..0.2);
        problem.contacts.push(Contact { bodies: [first, Some(second)], jacobian, friction, offset });
    }
    problem
}

/// `u = A p + b`, both components of every contact.
fn dense(problem: &Bodies) -> (Vec<Vec<f64>>, Vec<f64>) {
    let u = |velocities: &[f64]| -> Vec<f64> {
        problem.contacts.iter().flat_map(|contact| relative(problem, contact, velocities)).collect()
    };
    let column = |j: usize| {
        let contact = &problem.contacts[j / 2];
        let mut velocities = vec![0.0; problem.free.len()];
        for side in 0..2 {
            let Some(body) = contact.bodies[side] else { continue };
            for k in 0..3 {
                velocities[3 * body + k] += contact.jacobian[side][j % 2][k] * problem.inverse_mass[3 * body + k];
            }
        }
        u(&velocities)
    };
    let columns: Vec<Vec<f64>> = (0..2 * problem.contacts.len()).map(column).collect();
    let size = columns.len();
    let a = (0..size).map(|i| (0..size).map(|j| columns[j][i]).collect()).collect();
    (a, u(&problem.free))
}

/// Gauss's elimination with exchanges of rows.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let best = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, best);
        b.swap(k, best);
        if a[k][k].abs() < 1e-11 {
            return None;
        }
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let row = a[k].clone();
            a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| a[k][j] * b[j]).sum::<f64>()) / a[k][k];
    }
    Some(b)
}

/// Relative velocities of every solution there is.
fn all(problem: &Bodies) -> Vec<Vec<f64>> {
    let (a, b) = dense(problem);
    let contacts = problem.contacts.len();
    let mut found = Vec::new();
    for mut code in 0..4_usize.pow(contacts as u32) {
        let (mut left, mut right) = (vec![vec![0.0; 2 * contacts]; 2 * contacts], vec![0.0; 2 * contacts]);
        let mut modes = Vec::new();
        for (k, contact) in problem.contacts.iter().enumerate() {
            let mode = code % 4;
            code /= 4;
            modes.push(mode);
            let (n, t) = (2 * k, 2 * k + 1);
            let mut closed = |left: &mut Vec<Vec<f64>>, row: usize, offset: f64| {
                left[row].clone_from(&a[row]);
                right[row] = -b[row] - offset;
            };
            match mode {
                0 => (left[n][n], left[t][t]) = (1.0, 1.0),
                1 => {
                    closed(&mut left, n, contact.offset);
                    closed(&mut left, t, 0.0);
                }
                _ => {
                    closed(&mut left, n, contact.offset);
                    left[t][t] = 1.0;
                    left[t][n] = contact.friction * if mode == 2 { 1.0 } else { -1.0 };
                }
            }
        }
        let Some(p) = solved(left, right) else { continue };
        let u: Vec<f64> =
            (0..2 * contacts).map(|i| b[i] + (0..2 * contacts).map(|j| a[i][j] * p[j]).sum::<f64>()).collect();
        let holds = (0..contacts).all(|k| {
            let (n, t, contact) = (2 * k, 2 * k + 1, &problem.contacts[k]);
            let within =
                p[n] >= -1e-9 && p[t].abs() <= contact.friction * p[n] + 1e-9 && u[n] + contact.offset >= -1e-9;
            within
                && match modes[k] {
                    2 => u[t] >= -1e-9,
                    3 => u[t] <= 1e-9,
                    _ => true,
                }
        });
        if holds {
            found.push(u);
        }
    }
    found
}

#[test]
fn the_answer_is_one_of_all() {
    let mut generator = Pcg64Mcg::seed_from_u64(11);
    let (mut compared, mut solved) = (0, 0);
    for round in 0..300 {
        let problem = random(&mut generator, 1 + round % 3, 1 + round % 4);
        let all = all(&problem);
        let solution = problem.solve(None, &Settings::default()).unwrap();
        if solution.status != Status::Solved {
            continue;
        }
        solved += 1;
        assert!(departure(&problem, &solution) < 1e-7, "{round}");
        let u: Vec<f64> =
            problem.contacts.iter().flat_map(|contact| relative(&problem, contact, &solution.velocities)).collect();
        if all.is_empty() {
            continue; // redundant contacts: no system of theirs is regular
        }
        compared += 1;
        let apart = |other: &Vec<f64>| other.iter().zip(&u).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        let nearest = all.iter().map(apart).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6, "{round}: {nearest:e} from {} solutions", all.len());
    }
    assert!(solved >= 299 && compared >= 200, "{solved} solved, {compared} compared");
}
