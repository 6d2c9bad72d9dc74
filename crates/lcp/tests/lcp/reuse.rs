//! Theorem 1 of Loomis and Balkcom (2006): a start from the solution of a principal sub-problem on k rows ends
//! in at most n - k major cycles, with the same answer. The other methods give that answer from the start as well. And
//! every reason to refuse a start.

use crate::{
    contact::Wall,
    problems::{
        badly_scaled, feasible_q, gram, integer_rows, integer_vector, problem, random, repeat_columns, rows, vector,
    },
    verify::{OTHERS, SAME_W, assert_answer, assert_same_w, assert_solves},
};
use drystone_lcp::{Dantzig, LcpError, Method, Problem, Settings, Solver, Start, StartError, Status};
use rand::{Rng, seq::SliceRandom};

fn solve(problem: &Problem, start: Option<&Start>) -> Result<drystone_lcp::Solution, LcpError> {
    Dantzig.solve(problem, start, &Settings::default())
}

/// Solves a random principal sub-problem, starts from it, and compares with a fresh solve.
fn theorem_one(rng: &mut impl Rng, problem: &Problem, context: &str) -> bool {
    let n = problem.len();
    let mut indices: Vec<usize> = (0..n).collect();
    indices.shuffle(rng);
    indices.truncate(rng.random_range(0..=n));
    let k = indices.len();
    let part = solve(&problem.principal(&indices), None).unwrap();
    if part.status != Status::Solved {
        return false;
    }
    let start = Start { indices, z: part.z };
    let from_part = solve(problem, Some(&start)).unwrap_or_else(|error| panic!("{context}: {error}"));
    let fresh = solve(problem, None).unwrap();
    assert_answer(problem, &from_part, context);
    assert_eq!(from_part.status, fresh.status, "{context}");
    assert!(from_part.counts.major_cycles <= n - k, "{context}: k = {k}, {:?}", from_part.counts);
    if fresh.status == Status::Solved {
        assert_same_w(problem, &from_part.z, &fresh.z, SAME_W, context);
    }
    for method in OTHERS {
        let context = format!("{context}, {}", method.name());
        let solution = method.solve(problem, Some(&start), &Settings::default());
        let solution = solution.unwrap_or_else(|error| panic!("{context}: {error}"));
        assert_answer(problem, &solution, &context);
        assert_eq!(solution.status, fresh.status, "{context}");
        if fresh.status == Status::Solved {
            assert_same_w(problem, &solution.z, &fresh.z, SAME_W, &context);
        }
    }
    true
}

#[test]
fn theorem_one_on_random_problems() {
    let mut rng = random(50);
    let mut started = 0;
    for case in 0..3000 {
        let n = rng.random_range(1..=30);
        let rank = rng.random_range(0..=n + 2);
        let mut g = if case % 3 == 0 { integer_rows(&mut rng, rank, n) } else { rows(&mut rng, rank, n) };
        if case % 4 == 0 {
            repeat_columns(&mut rng, &mut g, n);
        }
        let m = gram(&g, n);
        let q = match case % 5 {
            0 => vector(&mut rng, n),
            1 => integer_vector(&mut rng, n),
            _ => feasible_q(&mut rng, &m, n),
        };
        let (m, q) = if case % 7 == 0 { badly_scaled(&mut rng, &m, &q) } else { (m, q) };
        let context = format!("case {case}, n = {n}, rank = {rank}");
        started += usize::from(theorem_one(&mut rng, &problem(&m, q), &context));
    }
    assert!(started > 2000, "only {started} sub-problems had a solution to start from");
}

#[test]
fn theorem_one_on_walls() {
    let mut rng = random(51);
    for case in 0..60 {
        let friction = [None, Some(0.3), Some(0.8)][case % 3];
        let wall = if case % 2 == 0 { Wall::column(12, friction) } else { Wall::pyramid(5, friction) };
        assert!(theorem_one(&mut rng, &wall.problem(), &format!("case {case}")), "a sub-problem of a wall is solvable");
    }
}

#[test]
fn a_complete_solution_as_start_needs_no_work() {
    let mut rng = random(52);
    for case in 0..200 {
        let n = rng.random_range(1..=30);
        let m = gram(&rows(&mut rng, n / 2 + 1, n), n);
        let problem = problem(&m, feasible_q(&mut rng, &m, n));
        let first = solve(&problem, None).unwrap();
        let again = solve(&problem, Some(&Start { indices: (0..n).collect(), z: first.z })).unwrap();
        assert_eq!((again.status, again.counts.pivots), (Status::Solved, 0), "case {case}");
        assert_solves(&problem, &again.z, &format!("case {case}"));
        for method in OTHERS {
            let start = Start { indices: (0..n).collect(), z: again.z.clone() };
            let again = method.solve(&problem, Some(&start), &Settings::default()).unwrap();
            assert_eq!((again.status, again.counts.pivots), (Status::Solved, 0), "case {case}, {}", method.name());
        }
    }
}

/// A start may be any solution of the sub-problem, not only a basic one: here the active rows are repeated.
#[test]
fn a_start_with_dependent_rows_is_reduced_to_a_basis() {
    let mut rng = random(53);
    for case in 0..300 {
        let n: usize = rng.random_range(2..=20);
        let mut g = integer_rows(&mut rng, n / 2 + 1, n);
        repeat_columns(&mut rng, &mut g, n);
        let m = gram(&g, n);
        let z: Vec<f64> = (0..n).map(|_| f64::from(rng.random_range(1..=3))).collect();
        // w = M z + q = 0 everywhere: z is a solution with every row active.
        let q = (0..n).map(|i| -(0..n).map(|j| m[i * n + j] * z[j]).sum::<f64>()).collect();
        let problem = problem(&m, q);
        let start = Start { indices: (0..n).collect(), z };
        for method in [&Dantzig as &dyn Method].into_iter().chain(OTHERS) {
            let solution = method.solve(&problem, Some(&start), &Settings::default()).unwrap();
            assert_eq!(solution.status, Status::Solved, "case {case}, {}", method.name());
            assert_eq!(solution.counts.major_cycles, 0, "case {case}, {}", method.name());
            assert_solves(&problem, &solution.z, &format!("case {case}, {}", method.name()));
        }
    }
}

/// With q = 0 a start on dependent rows collapses to z = 0; what rounding leaves of it must not count as a violation.
#[test]
fn a_start_that_collapses_to_zero_leaves_nothing_to_do() {
    let m = [3.0, -3.0, 3.0, -3.0, 3.0, -3.0, 3.0, -3.0, 3.0];
    let start = Start { indices: vec![0, 1, 2], z: vec![1.0, 3.0, 2.0] };
    let solution = solve(&problem(&m, vec![0.0; 3]), Some(&start)).unwrap();
    assert_eq!((solution.status, solution.counts.major_cycles), (Status::Solved, 0), "{solution:?}");
}

/// w = 2 z + 1 z' + q with the solution z = (1, 0) of its first row.
fn two_rows() -> Problem {
    problem(&[2.0, 1.0, 1.0, 2.0], vec![-2.0, -3.0])
}

/// The reason, which is the same for every method.
fn refusal(indices: &[usize], z: &[f64]) -> StartError {
    let start = Start { indices: indices.to_vec(), z: z.to_vec() };
    let reason = |method: &dyn Method| match method.solve(&two_rows(), Some(&start), &Settings::default()) {
        Err(LcpError::Start(error)) => error,
        other => panic!("{other:?}"),
    };
    let dantzig = reason(&Dantzig);
    for method in OTHERS {
        // Text, because a NaN does not equal itself.
        assert_eq!(reason(method).to_string(), dantzig.to_string(), "{}", method.name());
    }
    dantzig
}

#[test]
fn invalid_starts_are_refused_with_the_reason() {
    assert!(solve(&two_rows(), Some(&Start { indices: vec![0], z: vec![1.0] })).is_ok());
    assert_eq!(refusal(&[0, 1], &[1.0]), StartError::Length { indices: 2, values: 1 });
    assert_eq!(refusal(&[2], &[1.0]), StartError::OutOfRange { index: 2, n: 2 });
    assert_eq!(refusal(&[1, 1], &[1.0, 1.0]), StartError::Repeated { index: 1 });
    assert_eq!(refusal(&[1], &[-1.0]), StartError::Infeasible { index: 1, value: -1.0 });
    assert!(matches!(refusal(&[1], &[f64::NAN]), StartError::Infeasible { index: 1, .. }));
    assert!(matches!(refusal(&[0], &[f64::INFINITY]), StartError::Infeasible { index: 0, .. }));
    assert_eq!(refusal(&[0], &[0.5]), StartError::Violated { index: 0, w: -1.0 });
    assert_eq!(refusal(&[0], &[2.0]), StartError::NotComplementary { index: 0, z: 2.0, w: 2.0 });
    // A start of another problem: z solves the second row alone, but not together with z = 1 on the first.
    assert_eq!(refusal(&[0, 1], &[1.0, 1.5]), StartError::NotComplementary { index: 0, z: 1.0, w: 1.5 });
}

#[test]
fn a_solver_goes_on_after_a_refused_start() {
    let mut solver = Solver::new(two_rows(), Settings::default()).unwrap();
    for start in [Start { indices: vec![0], z: vec![0.5] }, Start { indices: vec![7], z: vec![0.5] }] {
        assert!(matches!(solver.start_from(&start), Err(LcpError::Start(_))));
        solver.add_rows(&[0, 1]).unwrap();
        assert_eq!(solver.solve(), Ok(Status::Solved));
        // By hand: both rows active, 2 z1 + z2 = 2, z1 + 2 z2 = 3.
        assert!((solver.z(0) - 1.0 / 3.0).abs() < 1e-12 && (solver.z(1) - 4.0 / 3.0).abs() < 1e-12);
    }
}
