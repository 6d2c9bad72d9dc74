//! Where rounding decides: matrices that are nearly singular, and matrices that were written with few digits.
//!
//! The answers are known by the way the problems are made. `M = G' G`, `q = -G' h` is solvable for any G and h; a definite M
//! has a solution for any q; a y >= 0 with `G y = 0` and `q' y < 0` proves that there is none.

use crate::{
    problems::{feasible_q, gram, problem, random, rows, vector},
    verify::{assert_certificate, assert_solves},
};
use drystone_lcp::{Block, Dantzig, LcpError, Lemke, Method, Problem, Settings, Solver, Status};
use rand::Rng;

const METHODS: [&dyn Method; 3] = [&Dantzig, &Block, &Lemke];

/// What a method says, checked from M and q.
fn answer(problem: &Problem, method: &dyn Method, context: &str) -> Result<Status, LcpError> {
    let solution = method.solve(problem, None, &Settings::default())?;
    match solution.status {
        Status::Solved => assert_solves(problem, &solution.z, context),
        Status::NoSolution => assert_certificate(problem, solution.ray.as_ref().unwrap(), context),
        _ => {}
    }
    Ok(solution.status)
}

fn assert_all_say(problem: &Problem, expected: Status, context: &str) {
    for method in METHODS {
        let context = format!("{context}, {}", method.name());
        assert_eq!(answer(problem, method, &context), Ok(expected), "{context}");
    }
}

fn round(values: &[f64], decimals: i32) -> Vec<f64> {
    let unit = 10f64.powi(decimals);
    values.iter().map(|value| (value * unit).round() / unit).collect()
}

/// `-G' h`, h of as many entries as G has rows.
fn load(rng: &mut impl Rng, g: &[Vec<f64>], n: usize) -> Vec<f64> {
    let h = vector(rng, g.len());
    (0..n).map(|j| -g.iter().zip(&h).map(|(row, h)| row[j] * h).sum::<f64>()).collect()
}

/// Columns of G again, `near` away in every entry.
fn repeat_nearly(rng: &mut impl Rng, g: &mut [Vec<f64>], sign: f64, near: f64) {
    let (n, copies) = (g[0].len(), 2);
    for _ in 0..copies {
        let j = rng.random_range(0..n);
        g.iter_mut().for_each(|row| row.push(sign * (row[j] + near * rng.random_range(-1.0..1.0))));
    }
}

#[test]
fn few_decimals_make_no_ray() {
    let mut rng = random(60);
    let mut refused = 0;
    for decimals in [12, 11, 10, 9, 8, 6] {
        for case in 0..25 {
            let g = rows(&mut rng, 8, 30);
            let (m, q) = (round(&gram(&g, 30), decimals), round(&load(&mut rng, &g, 30), decimals));
            let problem = problem(&m, q);
            for method in METHODS {
                let context = format!("{decimals} decimals, case {case}, {}", method.name());
                match answer(&problem, method, &context) {
                    Ok(Status::Solved) => {}
                    // Rounding makes eigenvalues of up to some 30 units in the last decimal, here at a diagonal of 8 / 3.
                    Err(LcpError::NotSemidefinite { eigenvalue, .. }) => {
                        let least = -30.0 * 10f64.powi(-decimals);
                        assert!(eigenvalue < 0.0 && eigenvalue > least, "{context}: {eigenvalue:e}");
                        refused += 1;
                    }
                    Ok(Status::RayTermination) if decimals <= 9 && method.name() == "lemke" => {}
                    other => panic!("{context}: {other:?}"),
                }
            }
            assert!(decimals < 10 || refused == 0, "{decimals} decimals leave enough of M");
        }
    }
    assert!(refused > 50, "with 6 decimals M is indefinite");
}

#[test]
fn definite_matrices_of_condition_1e12_are_solved() {
    let mut rng = random(61);
    for case in 0..150 {
        let n = rng.random_range(2..=12);
        // Householder's reflections of a diagonal from 1e-12 to 1.
        let mut m = vec![0.0; n * n];
        (0..n).for_each(|i| m[i * n + i] = 10f64.powf(-12.0 * i as f64 / (n - 1) as f64));
        for _ in 0..3 {
            m = reflected(&m, &vector(&mut rng, n));
        }
        let context = format!("case {case}, n = {n}");
        assert_all_say(&problem(&m, vector(&mut rng, n)), Status::Solved, &context);
    }
}

/// `H M H` with `H = I - 2 v v' / v'v`, symmetric to the last bit.
fn reflected(m: &[f64], v: &[f64]) -> Vec<f64> {
    let n = v.len();
    let size: f64 = v.iter().map(|v| v * v).sum();
    let h = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j] / size;
    let product = |i: usize, j: usize| -> f64 { (0..n).map(|k| h(i, k) * m[k * n + j]).sum() };
    let left: Vec<f64> = (0..n * n).map(|p| product(p / n, p % n)).collect();
    let entry = |i: usize, j: usize| -> f64 { (0..n).map(|k| left[i * n + k] * h(k, j)).sum() };
    (0..n * n).map(|p| 0.5 * (entry(p / n, p % n) + entry(p % n, p / n))).collect()
}

#[test]
fn nearly_repeated_and_nearly_opposite_columns_are_no_rays() {
    let mut rng = random(62);
    for case in 0..300 {
        let (n, near) = (rng.random_range(2..=16), 10f64.powf(rng.random_range(-14.0..-1.0)));
        let rank = rng.random_range(1..=n);
        let mut g = rows(&mut rng, rank, n);
        let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
        repeat_nearly(&mut rng, &mut g, sign, near);
        let n = g[0].len();
        let m = gram(&g, n);
        // With opposite columns a load that is feasible for the numbers may not be for the columns.
        let q = if sign > 0.0 { feasible_q(&mut rng, &m, n) } else { load(&mut rng, &g, n) };
        assert_all_say(&problem(&m, q), Status::Solved, &format!("case {case}, {near:e} apart"));
    }
}

/// `q' y` is below zero by 1e-6 of q at least: that is to be said, however nearly other columns depend on these.
#[test]
fn what_has_no_solution_is_proved_beside_nearly_repeated_columns() {
    let mut rng = random(63);
    for case in 0..300 {
        let (n, near) = (rng.random_range(2..=12), 10f64.powf(rng.random_range(-14.0..-1.0)));
        let rank = rng.random_range(1..=n);
        let mut g = rows(&mut rng, rank, n);
        let y = vector(&mut rng, n);
        g.iter_mut().for_each(|row| row.push(-row.iter().zip(&y).map(|(g, y)| g * y.abs()).sum::<f64>()));
        repeat_nearly(&mut rng, &mut g, 1.0, near);
        let total = g[0].len();
        let m = gram(&g, total);
        let z = vector(&mut rng, total);
        let image = |i: usize| (0..total).map(|j| m[i * total + j] * z[j].abs()).sum::<f64>();
        let mut q: Vec<f64> = (0..total).map(|i| -image(i)).collect();
        let size = q.iter().fold(0.0, |size: f64, q| size.max(q.abs()));
        let share = 10f64.powf(rng.random_range(-6.0..0.0));
        q[..=n].iter_mut().for_each(|q| *q -= share * size);
        assert_all_say(&problem(&m, q), Status::NoSolution, &format!("case {case}, {near:e} apart, share {share:e}"));
    }
}

/// Far out along a ray the residual is small beside z. That is no solution: here `w_0 = -1e-4` whatever z is.
#[test]
fn small_beside_a_huge_z_is_not_solved() {
    let d = 1e-8;
    let g = [vec![1.0, -1.0, 1.0, -1.0], vec![0.0, 0.0, d, d]];
    let problem = problem(&gram(&g, 4), vec![-1e-4, -1e-4, 1.0, 1.0]);
    assert_all_say(&problem, Status::NoSolution, "opposite columns");
}

/// After the last pivot that the limit allows a row is still violated, but by less than a solution may be.
#[test]
fn a_solution_at_the_pivot_limit_is_a_solution() {
    for (violation, expected) in [(1e-10, Status::Solved), (1e-8, Status::PivotLimit)] {
        let problem = problem(&[1.0, 0.0, 0.0, 1.0], vec![-1.0, -violation]);
        let settings = Settings { pivot_limit: Some(1), ..Settings::default() };
        let solution = Dantzig.solve(&problem, None, &settings).unwrap();
        assert_eq!((solution.status, solution.counts.pivots), (expected, 1));
        assert!((solution.residual - violation).abs() < 1e-15);
    }
}

/// Rows come and go and q changes, with columns nearly repeated and opposite: always solvable, and always solved.
#[test]
fn a_walk_over_nearly_dependent_rows_is_solved_at_every_step() {
    let mut rng = random(64);
    for case in 0..40 {
        let n = rng.random_range(3..=12);
        let near = 10f64.powf(rng.random_range(-14.0..-1.0));
        let rank = rng.random_range(2..=n);
        let mut g = rows(&mut rng, rank, n);
        repeat_nearly(&mut rng, &mut g, 1.0, near);
        repeat_nearly(&mut rng, &mut g, -1.0, near);
        let n = g[0].len();
        let mut solver = Solver::new(problem(&gram(&g, n), load(&mut rng, &g, n)), Settings::default()).unwrap();
        for step in 0..10 {
            let some = |rng: &mut _, share| (0..n).filter(|_| Rng::random_bool(rng, share)).collect::<Vec<_>>();
            solver.remove_rows(&some(&mut rng, 0.3)).unwrap();
            solver.add_rows(&some(&mut rng, 0.5)).unwrap();
            if step % 3 == 2 {
                solver.set_q(&load(&mut rng, &g, n)).unwrap();
            }
            let context = format!("case {case}, step {step}, {near:e} apart");
            assert_eq!(solver.solve(), Ok(Status::Solved), "{context}");
            let rows = solver.rows();
            let z: Vec<f64> = rows.iter().map(|&i| solver.z(i)).collect();
            assert_solves(&solver.problem().principal(&rows), &z, &context);
        }
    }
}
