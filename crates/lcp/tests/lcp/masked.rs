//! The solver that keeps its factor: any sequence of add, solve, snapshot and restore equals fresh solves, and
//! takes fewer pivots.

use crate::{
    contact::Wall,
    problems::{badly_scaled, feasible_q, gram, integer_rows, problem, random, repeat_columns, rows},
    verify::{RESIDUAL, SAME_W, assert_same_w, assert_solves},
};
use drystone_lcp::{Dantzig, Method, Problem, Settings, Snapshot, Solver, Status};
use rand::{Rng, seq::SliceRandom};

/// Solves the rows present afresh and compares.
fn assert_equals_fresh(solver: &Solver, status: Status, present: &[usize], context: &str) {
    let part = solver.problem().principal(present);
    let fresh = Dantzig.solve(&part, None, &Settings::default()).unwrap();
    assert_eq!(status, fresh.status, "{context}");
    let z: Vec<f64> = present.iter().map(|&i| solver.z(i)).collect();
    for i in (0..solver.problem().len()).filter(|i| !present.contains(i)) {
        assert_eq!(solver.z(i), 0.0, "{context}: row {i} is not present");
    }
    if status == Status::Solved {
        assert!(solver.residual() <= RESIDUAL, "{context}: {:e}", solver.residual());
        assert_solves(&part, &z, context);
        assert_same_w(&part, &z, &fresh.z, SAME_W, context);
    }
}

/// A depth-first search as the planner does it: rows are added in groups, and branches are rolled back.
fn random_walk(rng: &mut impl Rng, problem: Problem, steps: usize, context: &str) {
    let n = problem.len();
    let mut solver = Solver::new(problem, Settings::default()).unwrap();
    let mut present: Vec<usize> = Vec::new();
    let mut saved: Vec<(Snapshot, Vec<usize>)> = vec![(solver.snapshot(), Vec::new())];
    for step in 0..steps {
        let context = format!("{context}, step {step}");
        if rng.random_bool(0.3) || present.len() == n {
            let (snapshot, rows) = saved[rng.random_range(0..saved.len())].clone();
            solver.restore(&snapshot).unwrap();
            present = rows;
        } else {
            let mut rest: Vec<usize> = (0..n).filter(|i| !present.contains(i)).collect();
            rest.shuffle(rng);
            rest.truncate(rng.random_range(1..=4));
            solver.add_rows(&rest).unwrap();
            present.extend(rest);
        }
        let status = solver.solve().unwrap_or_else(|error| panic!("{context}: {error}"));
        assert_equals_fresh(&solver, status, &present, &context);
        if status == Status::Solved {
            saved.push((solver.snapshot(), present.clone()));
        } else {
            let (snapshot, rows) = saved[rng.random_range(0..saved.len())].clone();
            solver.restore(&snapshot).unwrap();
            present = rows;
        }
    }
}

#[test]
fn random_walks_over_random_problems() {
    let mut rng = random(60);
    for case in 0..300 {
        let n = rng.random_range(1..=40);
        let rank = rng.random_range(1..=n);
        let mut g = if case % 2 == 0 { integer_rows(&mut rng, rank, n) } else { rows(&mut rng, rank, n) };
        if case % 3 == 0 {
            repeat_columns(&mut rng, &mut g, n);
        }
        let m = gram(&g, n);
        let q = feasible_q(&mut rng, &m, n);
        let (m, q) = if case % 5 == 0 { badly_scaled(&mut rng, &m, &q) } else { (m, q) };
        random_walk(&mut rng, problem(&m, q), 30, &format!("case {case}, n = {n}, rank = {rank}"));
    }
}

/// Sub-problems without a solution on the way: the solver must come back from every one of them.
#[test]
fn random_walks_that_meet_infeasible_parts() {
    let mut rng = random(61);
    for case in 0..200 {
        let n = rng.random_range(2..=30);
        let rank = rng.random_range(1..=n);
        let m = gram(&rows(&mut rng, rank, n), n);
        let q = (0..n).map(|_| rng.random_range(-0.3..1.0)).collect();
        random_walk(&mut rng, problem(&m, q), 30, &format!("case {case}, n = {n}, rank = {rank}"));
    }
}

/// Large enough for the sparse factor; singular because of the full face contacts.
#[test]
fn random_walks_over_walls() {
    let mut rng = random(62);
    for (case, friction) in [None, Some(0.4)].into_iter().enumerate() {
        random_walk(&mut rng, Wall::pyramid(8, friction).problem(), 60, &format!("pyramid, case {case}"));
        random_walk(&mut rng, Wall::column(40, friction).problem(), 60, &format!("column, case {case}"));
    }
}

/// Rows of every block, lowest block first: what is added when the wall grows by that block.
fn rows_by_block(wall: &Wall) -> Vec<Vec<usize>> {
    let mut rows = vec![Vec::new(); wall.centres.len()];
    for (row, generator) in wall.generators().iter().enumerate() {
        rows[generator.upper()].push(row);
    }
    rows
}

/// Total pivots of growing a wall block by block: with reuse, and from scratch at every size.
fn pivots_of_growing(wall: &Wall) -> (usize, usize) {
    let problem = wall.problem();
    let mut solver = Solver::new(problem.clone(), Settings::default()).unwrap();
    let (mut present, mut cold) = (Vec::new(), 0);
    for rows in rows_by_block(wall) {
        present.extend(&rows);
        solver.add_rows(&rows).unwrap();
        assert_eq!(solver.solve(), Ok(Status::Solved));
        let fresh = Dantzig.solve(&problem.principal(&present), None, &Settings::default()).unwrap();
        assert_eq!(fresh.status, Status::Solved);
        cold += fresh.counts.pivots;
    }
    (solver.counts().pivots, cold)
}

/// Table I of the paper, column 50: of its 50 blocks one is the ground and the whole column is not counted, so the
/// test sees 1 to 48 blocks: 2 + 4 + ... + 96 = 2352 pivots from scratch, 2 a block = 96 with reuse.
#[test]
fn a_growing_column_takes_the_pivots_of_the_paper() {
    assert_eq!(pivots_of_growing(&Wall::column(48, None)), (96, 2352));
    assert_eq!(pivots_of_growing(&Wall::column(78, None)), (156, 6162));
}

/// Pyramid 91 of Table I: 1 to 90 blocks on the ground, 8190 pivots from scratch, 180 with reuse.
#[test]
fn a_growing_pyramid_takes_the_pivots_of_the_paper() {
    let mut wall = Wall::pyramid(13, None);
    wall.centres.truncate(90);
    assert_eq!(pivots_of_growing(&wall), (180, 8190));
}

#[test]
fn reuse_takes_fewer_pivots_with_friction_too() {
    for wall in [Wall::column(20, Some(0.5)), Wall::pyramid(7, Some(0.5))] {
        let (reused, cold) = pivots_of_growing(&wall);
        assert!(5 * reused < cold, "{reused} with reuse, {cold} from scratch");
    }
}
