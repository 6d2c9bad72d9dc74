//! The exponential examples, and the pivot limit that stops them.

use crate::{problems::problem, verify::assert_solves};
use drystone_lcp::{Block, Dantzig, Lemke, Method, Problem, Settings, Solution, Status};

/// Lower triangular, 1 on the diagonal and 2 below (Murty, Computational complexity of complementary pivot methods,
/// Mathematical Programming Study 7, 1978).
fn murty_matrix(n: usize) -> Vec<f64> {
    let entry = |i: usize, j: usize| if i == j { 1.0 } else { 2.0 };
    (0..n * n).map(|p| if p % n > p / n { 0.0 } else { entry(p / n, p % n) }).collect()
}

/// `q_i = -(2^n + 2^(n-1) + ... + 2^(n-i+1))`; by hand, z = (2^n, 0, ..., 0).
fn murty(n: usize) -> Problem {
    let power = |k: usize| 2f64.powi(i32::try_from(k).unwrap());
    let q = (1..=n).map(|i| -(n + 1 - i..=n).map(power).sum::<f64>()).collect();
    problem(&murty_matrix(n), q)
}

/// `M M'` of Murty's matrix, symmetric positive definite (Fathi, Computational complexity of LCPs associated with positive
/// definite symmetric matrices, Mathematical Programming 17, 1979): 4 (i - 1) + 1 on the diagonal, 4 (min(i, j) - 1) + 2
/// elsewhere, counted from one. With q = -(1, ..., 1) the solution is z = (1, 0, ..., 0), by hand.
fn fathi(n: usize, q: Vec<f64>) -> Problem {
    let m = murty_matrix(n);
    let dot = |i: usize, j: usize| (0..n).map(|k| m[i * n + k] * m[j * n + k]).sum::<f64>();
    let product: Vec<f64> = (0..n * n).map(|p| dot(p / n, p % n)).collect();
    assert!(n < 3 || (product[0], product[1], product[n + 1], product[n + 2]) == (1.0, 2.0, 5.0, 6.0));
    problem(&product, q)
}

fn unlimited() -> Settings {
    Settings { pivot_limit: Some(1 << 20), ..Settings::default() }
}

fn solve(method: &dyn Method, problem: &Problem, settings: &Settings, context: &str) -> Solution {
    let solution = method.solve(problem, None, settings).unwrap();
    if solution.status == Status::Solved {
        assert_solves(problem, &solution.z, context);
    }
    solution
}

/// Murty, Linear Complementarity (1988), theorem 6.1: the complementary pivot method takes 2^n steps.
#[test]
fn lemke_takes_every_step_of_murtys_example() {
    for n in 2..=12 {
        let problem = murty(n);
        let solution = solve(&Lemke, &problem, &unlimited(), &format!("n = {n}"));
        assert_eq!(solution.status, Status::Solved, "n = {n}");
        assert_eq!(solution.counts.pivots, 1 << n, "n = {n}");
        assert!((solution.z[0] - f64::from(1 << n)).abs() < 1e-9 && solution.z[1..].iter().all(|&z| z == 0.0));
    }
}

#[test]
fn every_method_solves_fathis_symmetric_example() {
    for n in 1..=60 {
        let problem = fathi(n, vec![-1.0; n]);
        for method in [&Dantzig as &dyn Method, &Lemke, &Block] {
            let context = format!("n = {n}, {}", method.name());
            let solution = solve(method, &problem, &Settings::default(), &context);
            assert_eq!(solution.status, Status::Solved, "{context}: {:?}", solution.counts);
            assert!((solution.z[0] - 1.0).abs() < 1e-9, "{context}: {}", solution.z[0]);
            assert!(solution.z[1..].iter().all(|&z| z < 1e-9), "{context}");
        }
    }
}

#[test]
fn the_pivot_limit_is_a_status() {
    let problem = fathi(12, vec![-1.0; 12]);
    for method in [&Dantzig as &dyn Method, &Lemke] {
        let free = solve(method, &problem, &unlimited(), method.name());
        assert_eq!(free.status, Status::Solved);
        for limit in 0..free.counts.pivots {
            let settings = Settings { pivot_limit: Some(limit), ..Settings::default() };
            let solution = solve(method, &problem, &settings, method.name());
            assert_eq!(solution.status, Status::PivotLimit, "{} at {limit}", method.name());
            assert_eq!(solution.counts.pivots, limit, "{}", method.name());
            assert!(solution.residual > Settings::default().residual, "{}: {:e}", method.name(), solution.residual);
            assert!(solution.z.iter().all(|&z| z >= 0.0) && solution.ray.is_none(), "{}", method.name());
        }
        let settings = Settings { pivot_limit: Some(free.counts.pivots), ..Settings::default() };
        assert_eq!(solve(method, &problem, &settings, method.name()).status, Status::Solved);
    }
}
