//! Block exchanges: that rows really move together, that dependent rows are left out, and that Dantzig's method
//! takes over where the exchanges lead nowhere. (Answers are compared with those of the other methods everywhere.)

use crate::{
    contact::Wall,
    problems::{feasible_q, gram, problem, random, rows, vector},
    verify::{assert_answer, assert_solves, solve_by_all},
};
use drystone_lcp::{Block, Dantzig, Method, Problem, Settings, Solution, Solver, Status};
use rand::Rng;

fn block(problem: &Problem, settings: &Settings) -> Solution {
    Block.solve(problem, None, settings).unwrap()
}

/// `M = I`: every violated row enters in the first exchange.
#[test]
fn rows_that_do_not_meet_move_in_one_exchange() {
    let n = 40;
    let m: Vec<f64> = (0..n * n).map(|p| if p % (n + 1) == 0 { 2.0 } else { 0.0 }).collect();
    let q = (0..n).map(|i| if i % 4 == 0 { 1.0 } else { -(i as f64) }).collect();
    let solution = block(&problem(&m, q), &Settings::default());
    let counts = (solution.counts.major_cycles, solution.counts.minor_cycles, solution.counts.pivots);
    assert_eq!((solution.status, counts), (Status::Solved, (1, 0, 30)));
}

/// Two rows enter together, and one of them has to leave again. By hand: `2 x + 1.9 y = 10`, `1.9 x + 2 y = 9` has y < 0, so
/// x = 5 alone.
#[test]
fn a_row_that_should_not_have_entered_leaves() {
    let solution = block(&problem(&[2.0, 1.9, 1.9, 2.0], vec![-10.0, -9.0]), &Settings::default());
    assert_eq!((solution.counts.major_cycles, solution.counts.pivots), (2, 3));
    assert!((solution.z[0] - 5.0).abs() < 1e-12 && solution.z[1] == 0.0, "{:?}", solution.z);
}

/// Four copies of one row, all violated: one enters, and the others are zero with it.
#[test]
fn dependent_rows_do_not_enter() {
    let solution = block(&problem(&[1.0; 16], vec![-3.0; 4]), &Settings::default());
    assert_eq!((solution.status, solution.counts.pivots), (Status::Solved, 1));
    assert_eq!(solution.z, [3.0, 0.0, 0.0, 0.0]);
    // One copy asks for more than the others: it is the one.
    let solution = block(&problem(&[1.0; 16], vec![-3.0, -3.0, -4.0, -3.0]), &Settings::default());
    assert_eq!((solution.status, solution.counts.pivots), (Status::Solved, 1));
    assert_eq!(solution.z, [0.0, 0.0, 4.0, 0.0]);
}

/// Positive definite matrices take a few exchanges, whatever their size, and Dantzig's method is not needed.
#[test]
fn definite_problems_take_few_exchanges() {
    let mut rng = random(90);
    let (mut exchanges, mut pivots, mut single) = (0, 0, 0);
    for case in 0..200 {
        let n: usize = rng.random_range(5..=60);
        let m = gram(&rows(&mut rng, n + 20, n), n);
        let problem = problem(&m, vector(&mut rng, n));
        let solution = solve_and_check(&problem, &format!("case {case}"));
        assert_eq!(solution.counts.minor_cycles, 0, "case {case}");
        exchanges += solution.counts.major_cycles;
        pivots += solution.counts.pivots;
        single += Dantzig.solve(&problem, None, &Settings::default()).unwrap().counts.pivots;
    }
    eprintln!("{exchanges} exchanges of {pivots} rows, {single} pivots one by one");
    assert!(exchanges <= 4 * 200, "{exchanges} exchanges in 200 problems");
    assert!(pivots < 2 * single, "{pivots} rows moved, {single} pivots one by one");
}

fn solve_and_check(problem: &Problem, context: &str) -> Solution {
    let solution = block(problem, &Settings::default());
    assert_answer(problem, &solution, context);
    assert_eq!(solution.status, Status::Solved, "{context}");
    solution
}

/// With singular matrices the exchanges often lead nowhere. Then Dantzig's method must finish.
#[test]
fn dantzigs_method_takes_over() {
    let mut rng = random(91);
    let (mut taken_over, mut by_blocks, mut single) = (0, 0, 0);
    for case in 0..300 {
        let n: usize = rng.random_range(5..=60);
        let rank = rng.random_range(1..=n);
        let m = gram(&rows(&mut rng, rank, n), n);
        let problem = problem(&m, feasible_q(&mut rng, &m, n));
        let solution = solve_and_check(&problem, &format!("case {case}"));
        taken_over += usize::from(solution.counts.minor_cycles > 0);
        by_blocks += solution.counts.pivots;
        single += solve_by_all(&problem, &format!("case {case}")).counts.pivots;
    }
    eprintln!("{taken_over} of 300 taken over, {by_blocks} pivots by blocks, {single} one by one");
    assert!(taken_over > 30, "only {taken_over} of 300");
}

/// No exchange, and no row taken out when Dantzig's method takes over, passes the limit.
#[test]
fn the_pivot_limit_holds_for_blocks() {
    let wall = Wall::pyramid(5, Some(0.5)).problem();
    let free = block(&wall, &Settings::default());
    let mut stopped = 0;
    for limit in 0..=free.counts.pivots {
        let solution = block(&wall, &Settings { pivot_limit: Some(limit), ..Settings::default() });
        assert!(solution.counts.pivots <= limit, "{:?} at {limit}", solution.counts);
        match solution.status {
            Status::Solved => assert_solves(&wall, &solution.z, &format!("limit {limit}")),
            Status::PivotLimit => stopped += 1,
            status => panic!("{status:?} at {limit}"),
        }
    }
    assert!(stopped > 10, "only {stopped} limits were reached");
}

/// A wall that grows: the exchanges of one block cost a few pivots, from scratch all of them again.
#[test]
fn a_growing_wall_takes_fewer_pivots() {
    for wall in
        [Wall::column(20, None), Wall::pyramid(7, None), Wall::column(20, Some(0.5)), Wall::pyramid(7, Some(0.5))]
    {
        let problem = wall.problem();
        let generators = wall.generators();
        let mut solver = Solver::new(problem.clone(), Settings::default()).unwrap();
        let (mut present, mut cold) = (Vec::new(), 0);
        for upper in 0..wall.centres.len() {
            let added: Vec<usize> = (0..problem.len()).filter(|&j| generators[j].upper() == upper).collect();
            present.extend(&added);
            solver.add_rows(&added).unwrap();
            assert_eq!(solver.solve_by_blocks(), Ok(Status::Solved));
            let part = problem.principal(&present);
            let z: Vec<f64> = present.iter().map(|&i| solver.z(i)).collect();
            assert_solves(&part, &z, &format!("{} rows", present.len()));
            cold += solve_and_check(&part, &format!("{} rows", present.len())).counts.pivots;
        }
        let reused = solver.counts().pivots;
        assert!(5 * reused < cold, "{reused} with reuse, {cold} from scratch");
    }
}
