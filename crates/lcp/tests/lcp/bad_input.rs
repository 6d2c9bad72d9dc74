//! Bad input is a typed error that names the entry; it is never a panic and never an answer.

use crate::{
    problems::{gram, problem, random, rows, vector},
    verify::{assert_certificate, assert_solves},
};
use drystone_lcp::{
    Block, Dantzig, LcpError, Lemke, Method, Problem, Settings, Solver, SparseColumns, Status, cone::Columns,
};
use rand::Rng;

fn dantzig(m: &[f64], q: Vec<f64>) -> Result<Status, LcpError> {
    Dantzig.solve(&problem(m, q), None, &Settings::default()).map(|solution| solution.status)
}

#[test]
fn entries_that_are_not_finite_are_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        match Problem::from_dense(&[1.0, 0.0, bad, 1.0], vec![0.0; 2]) {
            Err(LcpError::MatrixNotFinite { row: 1, column: 0, value }) => assert_eq!(value.to_bits(), bad.to_bits()),
            other => panic!("{other:?}"),
        }
        match Problem::from_dense(&[1.0], vec![bad]) {
            Err(LcpError::VectorNotFinite { index: 0, value }) => assert_eq!(value.to_bits(), bad.to_bits()),
            other => panic!("{other:?}"),
        }
        let sparse = SparseColumns::new(2, vec![0, 1, 2], vec![0, 1], vec![1.0, bad]);
        assert!(matches!(sparse, Err(LcpError::MatrixNotFinite { row: 1, column: 1, .. })), "{sparse:?}");
    }
}

#[test]
fn shapes_that_do_not_fit() {
    let shape = |result: Result<Problem, LcpError>| match result {
        Err(LcpError::Shape { rows, columns, q }) => (rows, columns, q),
        other => panic!("{other:?}"),
    };
    assert_eq!(shape(Problem::from_dense(&[1.0; 6], vec![0.0; 2])), (2, 3, 2));
    let square = SparseColumns::from_dense(&[1.0; 4]).unwrap();
    assert_eq!(shape(Problem::new(square, vec![0.0; 3])), (2, 2, 3));
    assert!(matches!(SparseColumns::from_dense(&[1.0; 5]), Err(LcpError::Shape { .. })));
    assert!(matches!(Problem::from_dense(&[1.0], vec![]), Err(LcpError::Shape { q: 0, .. })));
}

#[test]
fn compressed_columns_that_are_no_matrix() {
    let reason = |indptr: &[usize], indices: &[usize], values: usize| match SparseColumns::new(
        2,
        indptr.to_vec(),
        indices.to_vec(),
        vec![1.0; values],
    ) {
        Err(LcpError::Structure { reason }) => reason,
        other => panic!("{other:?}"),
    };
    assert!(reason(&[0, 1], &[0], 1).contains("3 entries"));
    assert!(reason(&[1, 1, 1], &[0], 1).contains("from 0"));
    assert!(reason(&[0, 1, 1], &[0, 1], 2).contains("stored entries"));
    assert!(reason(&[0, 2, 1], &[0], 1).contains("column 1"));
    assert!(reason(&[0, 5, 1], &[0], 1).contains("column 1"));
    assert!(reason(&[0, 1, 2], &[0, 1], 1).contains("2 row indices but 1 values"));
    assert!(reason(&[0, 1, 2], &[0, 2], 2).contains("row index 2 in column 1"));
    assert!(reason(&[0, 2, 3], &[1, 1, 0], 3).contains("[1, 0] is given twice"));
}

#[test]
fn rows_of_a_column_may_come_in_any_order() {
    let sorted = SparseColumns::new(2, vec![0, 2, 4], vec![0, 1, 0, 1], vec![2.0, 1.0, 1.0, 3.0]).unwrap();
    let shuffled = SparseColumns::new(2, vec![0, 2, 4], vec![1, 0, 1, 0], vec![1.0, 2.0, 3.0, 1.0]).unwrap();
    assert_eq!(sorted, shuffled);
    assert_eq!((sorted.get(0, 1), sorted.get(1, 1)), (1.0, 3.0));
}

#[test]
fn dantzig_refuses_what_is_not_symmetric() {
    match dantzig(&[2.0, 1.0, 1.5, 2.0], vec![-1.0; 2]) {
        Err(LcpError::NotSymmetric { row: 1, column: 0, value: 1.5, mirror: 1.0 }) => {}
        other => panic!("{other:?}"),
    }
    // Only one of two mirrored entries stored.
    assert!(matches!(dantzig(&[2.0, 1.0, 0.0, 2.0], vec![-1.0; 2]), Err(LcpError::NotSymmetric { .. })));
    // Rounding of a product summed in two orders is no asymmetry, whatever the scale of the rows.
    assert_eq!(dantzig(&[2e-12, 1.0, 1.0 + 1e-13, 2e12], vec![-1e-6, -1e6]), Ok(Status::Solved));
}

#[test]
fn dantzig_refuses_what_is_not_semidefinite() {
    let index = |m: &[f64], q: Vec<f64>| match dantzig(m, q) {
        Err(LcpError::NotSemidefinite { index, eigenvalue }) => {
            assert!(eigenvalue < 0.0, "{eigenvalue}");
            index
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(index(&[1.0, 0.0, 0.0, -1.0], vec![-1.0; 2]), 1);
    assert_eq!(index(&[0.0, -1.0, -1.0, 0.0], vec![-1.0; 2]), 1);
    assert_eq!(index(&[1.0, -2.0, -2.0, 1.0], vec![-1.0; 2]), 1);
    // Every block of order two is definite: (1, 1, 1) has curvature 3 - 6 * 0.6, found on the way.
    let a = -0.6;
    index(&[1.0, a, a, a, 1.0, a, a, a, 1.0], vec![-1.0; 3]);
    // (1, 1, 0) has no curvature but an image, (0, 0, 0.7): no proof that there is no solution.
    index(&[1.0, -1.0, 0.5, -1.0, 1.0, 0.2, 0.5, 0.2, 1.0], vec![-1.0, -1.0, 5.0]);
}

/// Random symmetric indefinite matrices: an error or an answer that holds.
#[test]
fn indefinite_matrices_never_give_a_wrong_answer() {
    let mut rng = random(40);
    let (mut refused, mut answered) = (0, 0);
    for case in 0..1000 {
        let n: usize = rng.random_range(2..=20);
        let mut m = gram(&rows(&mut rng, n, n), n);
        for i in 0..n {
            m[i * n + i] *= rng.random_range(0.8..1.0);
        }
        let problem = problem(&m, vector(&mut rng, n));
        let context = format!("case {case}, n = {n}");
        for method in [&Dantzig as &dyn Method, &Block] {
            let context = format!("{context}, {}", method.name());
            match method.solve(&problem, None, &Settings::default()) {
                Err(LcpError::NotSemidefinite { eigenvalue, .. }) => {
                    assert!(eigenvalue < 0.0, "{context}");
                    refused += 1;
                }
                Err(error) => panic!("{context}: {error}"),
                Ok(solution) => {
                    answered += 1;
                    match solution.status {
                        Status::Solved => assert_solves(&problem, &solution.z, &context),
                        Status::NoSolution => assert_certificate(&problem, &solution.ray.unwrap(), &context),
                        Status::NumericalTrouble => {}
                        status => panic!("{context}: {status:?}"),
                    }
                }
            }
        }
        let solution = Lemke.solve(&problem, None, &Settings::default()).unwrap();
        match solution.status {
            Status::Solved => assert_solves(&problem, &solution.z, &context),
            Status::NoSolution => assert_certificate(&problem, &solution.ray.unwrap(), &context),
            Status::RayTermination => assert!(solution.ray.is_some()),
            status => panic!("{context}: {status:?}"),
        }
    }
    assert!(refused > 200 && answered > 200, "both must occur: {refused} refused, {answered} answered");
}

#[test]
fn problems_without_rows_or_without_violations() {
    for method in [&Dantzig as &dyn Method, &Lemke, &Block] {
        let empty = method.solve(&problem(&[], vec![]), None, &Settings::default()).unwrap();
        assert_eq!((empty.status, empty.z.len(), empty.counts.pivots), (Status::Solved, 0, 0));
        let zero = method.solve(&problem(&[0.0; 4], vec![0.0; 2]), None, &Settings::default()).unwrap();
        assert_eq!((zero.status, zero.z, zero.residual), (Status::Solved, vec![0.0; 2], 0.0));
        let idle = method.solve(&problem(&[1.0, 0.0, 0.0, 1.0], vec![1.0, 0.0]), None, &Settings::default()).unwrap();
        assert_eq!(
            (idle.status, idle.z, idle.w, idle.counts.pivots),
            (Status::Solved, vec![0.0; 2], vec![1.0, 0.0], 0)
        );
    }
    assert!(Solver::new(problem(&[], vec![]), Settings::default()).is_ok());
}

/// What is refused changes nothing: the next solve answers as if it had not been asked for.
#[test]
fn a_solver_refuses_rows_values_and_snapshots_that_are_not_its_own() {
    let make = || Solver::new(problem(&[2.0, 1.0, 1.0, 2.0], vec![-2.0, -3.0]), Settings::default()).unwrap();
    let (mut solver, other) = (make(), make());
    solver.add_rows(&[1]).unwrap();
    solver.solve().unwrap();
    let out = |row| Err(LcpError::RowOutOfRange { row, n: 2 });
    assert_eq!(solver.add_rows(&[0, 2]), out(2));
    assert_eq!(solver.remove_rows(&[1, 7]), out(7));
    assert_eq!(solver.set_q_at(&[2], &[0.0]), out(2));
    assert_eq!(solver.set_q_at(&[0, 1], &[0.0]), Err(LcpError::ValuesForRows { rows: 2, values: 1 }));
    assert_eq!(solver.set_q(&[0.0]), Err(LcpError::Shape { rows: 2, columns: 2, q: 1 }));
    assert!(matches!(solver.set_q(&[5.0, f64::NAN]), Err(LcpError::VectorNotFinite { index: 1, .. })));
    assert!(matches!(solver.set_q_at(&[0], &[f64::INFINITY]), Err(LcpError::VectorNotFinite { index: 0, .. })));
    assert_eq!(solver.restore(&other.snapshot()), Err(LcpError::ForeignSnapshot));
    assert_eq!(solver.rows(), [1]);
    assert_eq!(solver.problem().q(), [-2.0, -3.0]);
    assert_eq!(solver.solve(), Ok(Status::Solved));
    assert!((solver.z(1) - 1.5).abs() < 1e-15);
}

#[test]
fn generators_that_do_not_fit_are_named() {
    let g = Columns::new(2, &[0, 1], &[1], &[1.0]).unwrap();
    let make = |w: &[f64], h: &[f64]| Problem::from_generators(&g, w, h).unwrap_err();
    let shape = LcpError::GeneratorShape { rows: 2, inverse_masses: 1, loads: 2 };
    assert_eq!(make(&[1.0], &[0.0, 0.0]), shape);
    assert_eq!(make(&[1.0, -1.0], &[0.0, 0.0]), LcpError::InverseMass { row: 1, value: -1.0 });
    assert!(matches!(make(&[f64::NAN, 1.0], &[0.0, 0.0]), LcpError::InverseMass { row: 0, .. }));
    assert!(matches!(make(&[1.0, 1.0], &[0.0, f64::NAN]), LcpError::LoadNotFinite { row: 1, .. }));
    let huge = Columns::new(1, &[0, 1], &[0], &[1e200]).unwrap();
    let error = Problem::from_generators(&huge, &[1.0], &[0.0]).unwrap_err();
    assert!(matches!(error, LcpError::MatrixNotFinite { row: 0, column: 0, .. }));
}
