//! Copies of a solver, by `clone` and through bytes, go on bit for bit as the first does, and leave it alone.

use crate::problems::{badly_scaled, feasible_q, gram, problem, random, rows};
use drystone_lcp::{LcpError, Problem, Settings, Solution, Solver, cone::Columns};
use rand::{Rng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

/// Rows come and go, q changes, and it is solved: the answers and the work.
fn walk(solver: &mut Solver, seed: u64, steps: usize) -> Vec<(Solution, Vec<usize>)> {
    let mut rng = random(seed);
    let n = solver.problem().len();
    let step = |solver: &mut Solver, rng: &mut Pcg64Mcg| {
        let mut all: Vec<usize> = (0..n).collect();
        all.shuffle(rng);
        let (come, go) = all.split_at(n / 3);
        solver.add_rows(come).unwrap();
        solver.remove_rows(&go[..n / 5]).unwrap();
        if rng.random_bool(0.5) {
            let row = rng.random_range(0..n);
            let q = solver.problem().q()[row];
            solver.set_q_at(&[row], &[q * rng.random_range(0.5..1.5)]).unwrap();
        }
        let status = solver.solve().unwrap();
        (solver.solution(status), solver.rows())
    };
    (0..steps).map(|_| step(solver, &mut rng)).collect()
}

fn solvers() -> Vec<Solver> {
    let mut rng = random(11);
    let mut made = Vec::new();
    for (n, rank) in [(6, 6), (30, 12), (120, 120)] {
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = feasible_q(&mut rng, &m, n);
        let (m, q) = badly_scaled(&mut rng, &m, &q);
        made.push(Solver::new(problem(&m, q), Settings::default()).unwrap());
    }
    // A chain: a sparse factor.
    let (n, mut starts, mut entries, mut values) = (150, vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        entries.extend([j, j + 1]);
        values.extend([1.0 + 0.01 * j as f64, -1.0]);
        starts.push(entries.len());
    }
    let g = Columns::new(n + 1, &starts, &entries, &values).unwrap();
    let loads: Vec<f64> = (0..=n).map(|i| (i as f64).sin()).collect();
    made.push(Solver::from_generators(&g, &vec![1.0; n + 1], &loads, Settings::default()).unwrap());
    made
}

#[test]
fn copies_go_on_bit_for_bit_and_alone() {
    for (k, mut first) in solvers().into_iter().enumerate() {
        walk(&mut first, k as u64, 4);
        first.add_rows(&[0, 1, 2]).unwrap(); // not solved yet
        let written = first.to_bytes();
        let mut clone = first.clone();
        let mut taken_up = Solver::from_bytes(&written).unwrap();
        assert_eq!(taken_up.to_bytes(), written, "{k}");
        let (rows, z) = (first.rows(), first.z(0));
        let copied = walk(&mut clone, 99, 6);
        assert_eq!((first.rows(), first.z(0), first.to_bytes()), (rows, z, written), "{k}: the first has changed");
        assert_eq!(walk(&mut taken_up, 99, 6), copied, "{k}: through bytes");
        assert_eq!(walk(&mut first, 99, 6), copied, "{k}");
        assert_eq!((taken_up.counts(), clone.counts()), (first.counts(), first.counts()), "{k}");
    }
}

/// Snapshots taken before a clone are of both; those taken before a solver was written down are not.
#[test]
fn snapshots_of_copies() {
    let mut first = solvers().remove(1);
    first.add_rows(&(0..20).collect::<Vec<_>>()).unwrap();
    first.solve().unwrap();
    let state = first.snapshot();
    let mut clone = first.clone();
    clone.clear();
    clone.restore(&state).unwrap();
    assert_eq!(clone.rows(), first.rows());
    let mut taken_up = Solver::from_bytes(&first.to_bytes()).unwrap();
    assert_eq!(taken_up.restore(&state), Err(LcpError::ForeignSnapshot));
}

#[test]
fn changed_bytes_are_no_solver() {
    let problem = Problem::from_dense(&[2.0, 1.0, 1.0, 2.0], vec![-5.0, -6.0]).unwrap();
    let mut solver = Solver::new(problem, Settings::default()).unwrap();
    solver.add_rows(&[0, 1]).unwrap();
    solver.solve().unwrap();
    let bytes = solver.to_bytes();
    for place in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        assert!(matches!(Solver::from_bytes(&changed), Err(LcpError::ForeignState { .. })), "{place}");
    }
}
