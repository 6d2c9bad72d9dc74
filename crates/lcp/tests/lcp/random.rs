//! Thousands of random problems, each solved by two independent methods and checked from `M` and `q`.

use crate::{
    problems::{
        badly_scaled, degenerate_q, feasible_q, gram, integer_rows, integer_vector, problem, random, repeat_columns,
        rows, vector,
    },
    verify::solve_by_all,
};
use drystone_lcp::{Problem, SparseColumns, Status};
use rand::Rng;

/// Sizes 1 to 60, small ones more often, so that 1000 problems take a second.
fn size(rng: &mut impl Rng) -> usize {
    let u: f64 = rng.random_range(0.0..1.0);
    1 + (59.0 * u * u * u) as usize
}

#[test]
fn positive_definite() {
    let mut rng = random(1);
    for case in 0..1500 {
        let n = size(&mut rng);
        let m = gram(&rows(&mut rng, n + 2, n), n);
        let q = vector(&mut rng, n);
        let solution = solve_by_all(&problem(&m, q), &format!("case {case}"));
        assert_eq!(solution.status, Status::Solved, "case {case}: a positive definite problem has a solution");
    }
}

#[test]
fn semidefinite_of_every_rank_and_feasible() {
    let mut rng = random(2);
    for case in 0..1500 {
        let n = size(&mut rng);
        let rank = rng.random_range(0..=n);
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = feasible_q(&mut rng, &m, n);
        let context = format!("case {case}, n = {n}, rank = {rank}");
        let solution = solve_by_all(&problem(&m, q), &context);
        assert_eq!(solution.status, Status::Solved, "{context}: feasible and semidefinite, so solvable");
    }
}

#[test]
fn semidefinite_of_every_rank_and_any_q() {
    let mut rng = random(3);
    let (mut solved, mut without) = (0, 0);
    for case in 0..2000 {
        let n = size(&mut rng);
        let rank = rng.random_range(0..=n);
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = vector(&mut rng, n);
        match solve_by_all(&problem(&m, q), &format!("case {case}, n = {n}, rank = {rank}")).status {
            Status::Solved => solved += 1,
            _ => without += 1,
        }
    }
    assert!(solved > 300 && without > 300, "the family must have both kinds: {solved} solved, {without} without");
}

#[test]
fn degenerate_solutions() {
    let mut rng = random(4);
    for case in 0..1000 {
        let n = size(&mut rng);
        let rank = rng.random_range(1..=n);
        let m = gram(&integer_rows(&mut rng, rank, n), n);
        let q = degenerate_q(&mut rng, &m, n);
        let context = format!("case {case}, n = {n}, rank = {rank}");
        assert_eq!(solve_by_all(&problem(&m, q), &context).status, Status::Solved, "{context}");
    }
}

#[test]
fn repeated_rows_and_columns() {
    let mut rng = random(5);
    for case in 0..1000 {
        let n = size(&mut rng);
        let rank = rng.random_range(1..=n);
        let mut g = rows(&mut rng, rank, n);
        repeat_columns(&mut rng, &mut g, n);
        let m = gram(&g, n);
        let feasible = rng.random_bool(0.5);
        let q = if feasible { feasible_q(&mut rng, &m, n) } else { vector(&mut rng, n) };
        let context = format!("case {case}, n = {n}, rank = {rank}");
        let solution = solve_by_all(&problem(&m, q), &context);
        assert!(!feasible || solution.status == Status::Solved, "{context}: {:?}", solution.status);
    }
}

#[test]
fn integer_matrices_full_of_ties() {
    let mut rng = random(6);
    for case in 0..2000 {
        let n = size(&mut rng);
        let rank = rng.random_range(0..=n);
        let mut g = integer_rows(&mut rng, rank, n);
        if case % 2 == 0 {
            repeat_columns(&mut rng, &mut g, n);
        }
        let m = gram(&g, n);
        let q = integer_vector(&mut rng, n);
        solve_by_all(&problem(&m, q), &format!("case {case}, n = {n}, rank = {rank}"));
    }
}

#[test]
fn badly_scaled_over_twelve_orders() {
    let mut rng = random(7);
    for case in 0..1000 {
        let n = size(&mut rng);
        // Rank 0 is left out: a row of zeros has no scale of its own.
        let rank = if case % 2 == 0 { n + 2 } else { rng.random_range(1..=n) };
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = if case % 3 == 0 { vector(&mut rng, n) } else { feasible_q(&mut rng, &m, n) };
        let context = format!("case {case}, n = {n}, rank = {rank}");
        let plain = solve_by_all(&problem(&m, q.clone()), &context);
        let (m, q) = badly_scaled(&mut rng, &m, &q);
        let scaled = solve_by_all(&problem(&m, q), &format!("{context}, badly scaled"));
        assert_eq!(plain.status, scaled.status, "{context}: scaling rows and columns does not change solvability");
    }
}

#[test]
fn all_numbers_huge_or_tiny() {
    let mut rng = random(8);
    for case in 0..200 {
        let n = size(&mut rng);
        let m = gram(&rows(&mut rng, n / 2 + 1, n), n);
        let q = feasible_q(&mut rng, &m, n);
        for (size_m, size_q) in [(1e-100, 1.0), (1e100, 1.0), (1.0, 1e-100), (1.0, 1e100), (1e60, 1e-60)] {
            let m: Vec<f64> = m.iter().map(|value| value * size_m).collect();
            let q: Vec<f64> = q.iter().map(|value| value * size_q).collect();
            let context = format!("case {case}, M * {size_m:e}, q * {size_q:e}");
            assert_eq!(solve_by_all(&problem(&m, q), &context).status, Status::Solved, "{context}");
        }
    }
}

/// The obstacle problem of a string over n points in a row: `M` tridiagonal (2, -1), loads that press parts of it
/// down. Large and sparse enough for the sparse factor.
#[test]
fn large_and_sparse() {
    let mut rng = random(9);
    for case in 0..6 {
        let n: usize = 300;
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            for i in j.saturating_sub(1)..(j + 2).min(n) {
                indices.push(i);
                data.push(if i == j { 2.0 } else { -1.0 });
            }
            indptr.push(indices.len());
        }
        let m = SparseColumns::new(n, indptr, indices, data).unwrap();
        let load = |i: usize, u: f64| if (i / 20).is_multiple_of(2) { -u } else { 3.0 * u };
        let q = (0..n).map(|i| load(i, rng.random_range(0.0..1.0))).collect();
        let problem = Problem::new(m, q).unwrap();
        assert_eq!(solve_by_all(&problem, &format!("case {case}")).status, Status::Solved);
    }
}

/// Sparse G with few entries in every column, so that M = G' G is sparse and singular.
#[test]
fn large_sparse_and_singular() {
    let mut rng = random(10);
    for case in 0..6 {
        let (n, rank) = (300, 150);
        let mut g = vec![vec![0.0; n]; rank];
        for j in (0..n).chain(0..n) {
            let near = (j * rank / n + rng.random_range(0..3)).min(rank - 1);
            g[near][j] = f64::from(rng.random_range(1..=3)) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        }
        let m = gram(&g, n);
        let q = if case % 2 == 0 { feasible_q(&mut rng, &m, n) } else { degenerate_q(&mut rng, &m, n) };
        assert_eq!(solve_by_all(&problem(&m, q), &format!("case {case}")).status, Status::Solved, "case {case}");
    }
}
