//! Degenerate problems made to cycle: every quantity ties. (Kostreva's, Beale's and Chvatal's are named problems.)

use crate::{
    problems::{gram, integer_rows, problem, random, vector},
    verify::{assert_answer, solve_by_all},
};
use drystone_lcp::{Lemke, Method, Problem, Settings, Status};
use rand::{Rng, seq::SliceRandom};

/// Kostreva's matrix repeated along the diagonal, rows shuffled: every first ratio is the same.
#[test]
fn blocks_of_kostrevas_example() {
    let mut rng = random(30);
    for blocks in 1..=20 {
        let n = 3 * blocks;
        let mut place: Vec<usize> = (0..n).collect();
        place.shuffle(&mut rng);
        let mut m = vec![0.0; n * n];
        for k in 0..n {
            let next = k / 3 * 3 + (k + 1) % 3;
            m[place[k] * n + place[k]] = 1.0;
            m[place[k] * n + place[next]] = 2.0;
        }
        let problem = problem(&m, vec![-1.0; n]);
        let solution = Lemke.solve(&problem, None, &Settings::default()).unwrap();
        assert_answer(&problem, &solution, &format!("{blocks} blocks"));
        assert!(solution.z.iter().all(|z| (z - 1.0 / 3.0).abs() < 1e-9), "{blocks} blocks: {:?}", solution.z);
    }
}

/// `M = G' G` with `q = -G' b`: nonnegative least squares, `min |G z - b|`, with small integers. Always solvable, with ties
/// in almost every step.
#[test]
fn least_squares_with_integers() {
    let mut rng = random(31);
    for case in 0..800 {
        let (rank, n) = (rng.random_range(1..=12), rng.random_range(1..=40));
        let g = integer_rows(&mut rng, rank, n);
        let b: Vec<f64> = (0..rank).map(|_| f64::from(rng.random_range(-1..=1))).collect();
        let q = (0..n).map(|j| -(0..rank).map(|r| g[r][j] * b[r]).sum::<f64>()).collect();
        let solution = solve_by_all(&problem(&gram(&g, n), q), &format!("case {case}, {rank} x {n}"));
        assert_eq!(solution.status, Status::Solved, "case {case}: least squares always have a solution");
    }
}

/// Linear programs `min c' x, A x <= b, x >= 0` with right-hand sides that are zero or one, as
/// `w = (c + A' y, b - A x)`: skew-symmetric M, every vertex degenerate.
#[test]
fn degenerate_linear_programs() {
    let mut rng = random(32);
    let (mut solved, mut without) = (0, 0);
    for case in 0..1000 {
        let (rows, columns) = (rng.random_range(1..=12), rng.random_range(1..=12));
        let n = rows + columns;
        let mut m = vec![0.0; n * n];
        for r in 0..rows {
            for c in 0..columns {
                let a = f64::from(rng.random_range(-2..=2));
                m[c * n + columns + r] = a;
                m[(columns + r) * n + c] = -a;
            }
        }
        let cost = |rng: &mut rand_pcg::Pcg64Mcg| f64::from(rng.random_range(-2..=1));
        let q: Vec<f64> =
            (0..n).map(|i| if i < columns { cost(&mut rng) } else { f64::from(rng.random_range(0..=1)) }).collect();
        let problem = problem(&m, q);
        let solution = Lemke.solve(&problem, None, &Settings::default()).unwrap();
        assert_answer(&problem, &solution, &format!("case {case}, {rows} x {columns}"));
        if solution.status == Status::Solved { solved += 1 } else { without += 1 }
    }
    assert!(solved > 200 && without > 200, "both kinds must occur: {solved} solved, {without} without");
}

/// Non-symmetric positive definite M: a Gram matrix plus a skew-symmetric one. Always solvable.
#[test]
fn positive_definite_and_not_symmetric() {
    let mut rng = random(33);
    for case in 0..500 {
        let n: usize = rng.random_range(1..=40);
        let mut m = gram(&integer_rows(&mut rng, n, n), n);
        for i in 0..n {
            m[i * n + i] += 0.5;
            for j in 0..i {
                let skew = f64::from(rng.random_range(-5..=5));
                m[i * n + j] += skew;
                m[j * n + i] -= skew;
            }
        }
        let problem: Problem = problem(&m, vector(&mut rng, n));
        let solution = Lemke.solve(&problem, None, &Settings::default()).unwrap();
        assert_answer(&problem, &solution, &format!("case {case}, n = {n}"));
        assert_eq!(solution.status, Status::Solved, "case {case}");
    }
}
