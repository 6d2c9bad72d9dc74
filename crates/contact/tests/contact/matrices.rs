//! Any M: the same answers as bodies where it is theirs, and truths where it is not.

use crate::common::tower;
use drystone_contact::{Bodies, ContactError, Matrices, Settings, Status};
use drystone_lcp::{SparseColumns, cone::Columns};

/// A problem of bodies by its matrices.
fn by_matrices(problem: &Bodies) -> Matrices {
    let (size, d) = (problem.size, problem.dimension());
    let n = problem.free.len();
    let masses: Vec<f64> = problem.inverse_mass.iter().map(|x| 1.0 / x).collect();
    let mass = SparseColumns::new(n, (0..=n).collect(), (0..n).collect(), masses).unwrap();
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for contact in &problem.contacts {
        for row in 0..d {
            for side in 0..2 {
                let Some(body) = contact.bodies[side] else { continue };
                rows.extend(size * body..size * (body + 1));
                values.extend(&contact.jacobian[side][row][..size]);
            }
            starts.push(rows.len());
        }
    }
    Matrices {
        dimension: d,
        mass,
        jacobian: Columns::new(n, &starts, &rows, &values).unwrap(),
        friction: problem.contacts.iter().map(|contact| contact.friction).collect(),
        free: problem.free.clone(),
        offsets: problem.contacts.iter().map(|contact| contact.offset).collect(),
    }
}

#[test]
fn bodies_by_their_matrices() {
    for angle in [0.2, 0.6] {
        let problem = tower(&[1.0, 3.0, 2.0], 0.5, [angle, 0.4]);
        let (a, b) =
            (problem.solve(None, &Settings::default()), by_matrices(&problem).solve(None, &Settings::default()));
        let (a, b) = (a.unwrap(), b.unwrap());
        assert_eq!((a.status, b.status), (Status::Solved, Status::Solved));
        for (a, b) in a.velocities.iter().zip(&b.velocities) {
            assert!((a - b).abs() < 1e-8);
        }
    }
}

/// A chain of unit masses on springs, whose M couples all of them; its last one meets a wall. M's inverse is known: it is
/// tridiagonal (2, -1) with ones, so that `1 / (M^-1)_nn` is what the wall feels.
#[test]
fn a_chain_meets_a_wall() {
    for n in [2_usize, 7, 50] {
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            for i in j.saturating_sub(1)..(j + 2).min(n) {
                rows.push(i);
                values.push(if i == j { 2.0 } else { -1.0 });
            }
            starts.push(rows.len());
        }
        // M = tridiag(-1, 2, -1): (M^-1)_ij = min(i, j) (n + 1 - max(i, j)) / (n + 1), counted from one.
        let inverse = |i: usize| (i + 1) as f64 / (n + 1) as f64;
        let mass = SparseColumns::new(n, starts, rows, values).unwrap();
        let jacobian = Columns::new(n, &[0, 1, 1], &[n - 1], &[-1.0]).unwrap();
        let free = vec![1.0; n];
        let problem = Matrices { dimension: 2, mass, jacobian, friction: vec![0.5], free, offsets: vec![0.25] };
        let solution = problem.solve(None, &Settings::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        let p = 0.75 / inverse(n - 1);
        assert!((solution.impulses[0] - p).abs() < 1e-9 && solution.impulses[1].abs() < 1e-12);
        for (i, v) in solution.velocities.iter().enumerate() {
            // Column n of M^-1.
            assert!((v - (1.0 - p * inverse(i))).abs() < 1e-9, "{n}: {:?}", solution.velocities);
        }
    }
}

#[test]
fn bad_matrices() {
    let good = by_matrices(&tower(&[1.0], 0.5, [0.0, 0.0]));
    let with = |change: &dyn Fn(&mut Matrices)| {
        let mut problem = good.clone();
        change(&mut problem);
        problem.solve(None, &Settings::default()).unwrap_err()
    };
    let n = good.free.len();
    assert_eq!(with(&|p| p.dimension = 4), ContactError::Dimension { dimension: 4 });
    assert!(matches!(with(&|p| p.free.push(0.0)), ContactError::Length { what: "free", .. }));
    assert!(matches!(with(&|p| p.friction.push(0.5)), ContactError::Length { .. }));
    assert!(matches!(with(&|p| p.offsets[0] = f64::NAN), ContactError::NotFinite { .. }));
    assert!(matches!(with(&|p| p.friction[0] = -1.0), ContactError::Friction { contact: 0, .. }));
    let negative = |p: &mut Matrices| {
        p.mass = SparseColumns::new(n, (0..=n).collect(), (0..n).collect(), vec![-1.0; n]).unwrap();
    };
    assert!(matches!(with(&negative), ContactError::MassMatrix { .. }));
    let skew = |p: &mut Matrices| {
        let mut dense = vec![0.0; n * n];
        (0..n).for_each(|k| dense[n * k + k] = 1.0);
        dense[1] = 0.5;
        p.mass = SparseColumns::from_dense(&dense).unwrap();
    };
    assert!(with(&skew).to_string().contains("entry [0, 1]"));
}
