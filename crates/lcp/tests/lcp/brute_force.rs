//! Small problems against the enumeration of all 2^n complementary bases.

use crate::{
    problems::{gram, integer_rows, integer_vector, problem, random, rows, vector},
    verify::{SAME_W, assert_same_w, assert_solves, solve_by_all},
};
use drystone_lcp::{Problem, Status};
use rand::Rng;

/// Solves `M_CC x = b` by Gauss's elimination with row exchanges; `None` if the block is singular.
fn eliminate(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let k = b.len();
    for p in 0..k {
        let best = (p..k).max_by(|&i, &j| a[i][p].abs().total_cmp(&a[j][p].abs()))?;
        if a[best][p].abs() < 1e-10 {
            return None;
        }
        a.swap(p, best);
        b.swap(p, best);
        let pivot_row = a[p].clone();
        for i in p + 1..k {
            let factor = a[i][p] / pivot_row[p];
            for (value, pivot) in a[i].iter_mut().zip(&pivot_row) {
                *value -= factor * pivot;
            }
            b[i] -= factor * b[p];
        }
    }
    for p in (0..k).rev() {
        let tail: f64 = (p + 1..k).map(|j| a[p][j] * b[j]).sum();
        b[p] = (b[p] - tail) / a[p][p];
    }
    Some(b)
}

/// The first complementary basic solution among all active sets. A feasible semidefinite problem has one with a
/// nonsingular active block, so `None` means that there is no solution.
fn enumerate(problem: &Problem) -> Option<Vec<f64>> {
    let n = problem.len();
    (0..1usize << n).find_map(|mask| {
        let active: Vec<usize> = (0..n).filter(|i| mask >> i & 1 == 1).collect();
        let block = active.iter().map(|&i| active.iter().map(|&j| problem.m().get(i, j)).collect()).collect();
        let x = eliminate(block, active.iter().map(|&i| -problem.q()[i]).collect())?;
        let mut z = vec![0.0; n];
        for (&i, &value) in active.iter().zip(&x) {
            z[i] = value;
        }
        let w = problem.w(&z);
        (z.iter().chain(&w).all(|&value| value >= -1e-9)).then(|| z.iter().map(|z| z.max(0.0)).collect())
    })
}

fn compare(problem: &Problem, context: &str) -> bool {
    let solution = solve_by_all(problem, context);
    let Some(expected) = enumerate(problem) else {
        assert_eq!(solution.status, Status::NoSolution, "{context}: no basis is feasible");
        return false;
    };
    assert_solves(problem, &expected, &format!("{context}, enumeration"));
    assert_eq!(solution.status, Status::Solved, "{context}: {expected:?} is a solution");
    assert_same_w(problem, &solution.z, &expected, SAME_W, context);
    true
}

#[test]
fn random_problems_of_up_to_eight_rows() {
    let mut rng = random(20);
    let mut solved = 0;
    for case in 0..600 {
        let n = rng.random_range(1..=8);
        let rank = rng.random_range(0..=n);
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = vector(&mut rng, n);
        solved += usize::from(compare(&problem(&m, q), &format!("case {case}, n = {n}, rank = {rank}")));
    }
    assert!((100..500).contains(&solved), "both kinds must occur: {solved} of 600 solved");
}

#[test]
fn integer_problems_of_up_to_eight_rows() {
    let mut rng = random(21);
    let mut solved = 0;
    for case in 0..1500 {
        let n = rng.random_range(1..=8);
        let rank = rng.random_range(0..=n);
        let m = gram(&integer_rows(&mut rng, rank, n), n);
        let q = integer_vector(&mut rng, n);
        solved += usize::from(compare(&problem(&m, q), &format!("case {case}, n = {n}, rank = {rank}")));
    }
    assert!((300..1200).contains(&solved), "both kinds must occur: {solved} of 1500 solved");
}
