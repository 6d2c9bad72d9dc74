//! Sequences of related problems: rows come and go, q changes, states are rolled back to. Every answer is compared with a
//! fresh solve of the rows present, and the work with that of the fresh solves. By Dantzig's method, by block exchanges, and
//! by one after the other.

use crate::{
    contact::Wall,
    problems::{badly_scaled, feasible_q, gram, integer_rows, problem, random, repeat_columns, rows},
    verify::{RESIDUAL, SAME_W, assert_answer, assert_same_w, assert_solves},
};
use drystone_lcp::{Block, Dantzig, Method, Problem, Settings, Snapshot, Solver, Status, cone::Columns, residual};
use rand::{
    Rng,
    seq::{IndexedRandom, SliceRandom},
};
use rand_pcg::Pcg64Mcg;

/// Pivots of the solver and of the fresh solves.
#[derive(Debug, Default, Clone, Copy)]
struct Work {
    kept: usize,
    fresh: usize,
    without_solution: usize,
}

/// How a step is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
enum By {
    Dantzig,
    Blocks,
    Turns,
}

/// A solver, and what it should hold.
struct Walk {
    solver: Solver,
    by: By,
    steps: usize,
    present: Vec<usize>,
    q: Vec<f64>,
    saved: Vec<(Snapshot, Vec<usize>, Vec<f64>)>,
    work: Work,
}

impl Walk {
    fn new(problem: Problem) -> Self {
        let q = problem.q().to_vec();
        let solver = Solver::new(problem, Settings::default()).unwrap();
        let (saved, work) = (Vec::new(), Work::default());
        Self { solver, by: By::Dantzig, steps: 0, present: Vec::new(), q, saved, work }
    }

    fn add(&mut self, rng: &mut Pcg64Mcg, most: usize) {
        let mut rest: Vec<usize> = (0..self.q.len()).filter(|i| !self.present.contains(i)).collect();
        rest.shuffle(rng);
        rest.truncate(rng.random_range(1..=most));
        self.solver.add_rows(&rest).unwrap();
        self.present.extend(rest);
    }

    fn remove(&mut self, rng: &mut Pcg64Mcg, most: usize) {
        self.present.shuffle(rng);
        let kept = self.present.len().saturating_sub(rng.random_range(1..=most));
        let gone = self.present.split_off(kept);
        self.solver.remove_rows(&gone).unwrap();
    }

    /// All of q becomes another feasible one, or some of its entries move.
    fn change_q(&mut self, rng: &mut Pcg64Mcg, other: &[f64]) {
        if rng.random_bool(0.3) {
            self.q.copy_from_slice(other);
            self.solver.set_q(other).unwrap();
            return;
        }
        let rows: Vec<usize> = (0..rng.random_range(1..=3)).map(|_| rng.random_range(0..self.q.len())).collect();
        let values: Vec<f64> = rows.iter().map(|&i| self.q[i] * rng.random_range(0.5..1.5)).collect();
        rows.iter().zip(&values).for_each(|(&i, &value)| self.q[i] = value);
        self.solver.set_q_at(&rows, &values).unwrap();
    }

    fn restore(&mut self, rng: &mut Pcg64Mcg) {
        if let Some((snapshot, present, q)) = self.saved.choose(rng).cloned() {
            self.solver.restore(&snapshot).unwrap();
            (self.present, self.q) = (present, q);
        }
    }

    fn save(&mut self) {
        self.saved.push((self.solver.snapshot(), self.present.clone(), self.q.clone()));
    }

    /// Solves, and compares with a fresh solve of the rows present.
    fn solve(&mut self, context: &str) {
        let before = self.solver.counts();
        self.steps += 1;
        let blocks = self.by == By::Blocks || self.by == By::Turns && self.steps.is_multiple_of(2);
        let status = if blocks { self.solver.solve_by_blocks() } else { self.solver.solve() };
        let status = status.unwrap_or_else(|error| panic!("{context}: {error}"));
        self.present.sort_unstable();
        assert_eq!(self.solver.rows(), self.present, "{context}");
        assert_eq!(self.solver.problem().q(), self.q, "{context}");
        let complete = Problem::new(self.solver.problem().m().clone(), self.q.clone()).unwrap();
        let part = complete.principal(&self.present);
        let method: &dyn Method = if self.by == By::Blocks { &Block } else { &Dantzig };
        let fresh = method.solve(&part, None, &Settings::default()).unwrap();
        assert_answer(&part, &fresh, context);
        assert_eq!(status, fresh.status, "{context}");
        self.work.kept += (self.solver.counts() - before).pivots;
        self.work.fresh += fresh.counts.pivots;
        let mut solution = self.solver.solution(status);
        for i in (0..self.q.len()).filter(|i| !self.present.contains(i)) {
            assert_eq!(solution.z[i], 0.0, "{context}: row {i} is not present");
        }
        solution.z = self.present.iter().map(|&i| solution.z[i]).collect();
        solution.ray = solution.ray.map(|ray| self.present.iter().map(|&i| ray[i]).collect());
        assert_answer(&part, &solution, context);
        if status == Status::Solved {
            assert_solves(&part, &solution.z, context);
            assert_same_w(&part, &solution.z, &fresh.z, SAME_W, context);
            assert!(residual(&part, &solution.z) <= RESIDUAL, "{context}");
        } else {
            self.work.without_solution += 1;
        }
    }
}

/// `others`: further q for which the complete problem is feasible.
fn walk(rng: &mut Pcg64Mcg, problem: Problem, others: &[Vec<f64>], steps: usize, by: By, context: &str) -> Work {
    let n = problem.len();
    let most = 4.max(n / 10);
    let mut walk = Walk { by, ..Walk::new(problem) };
    walk.save();
    for step in 0..steps {
        // Now and then several changes before one solve.
        for _ in 0..rng.random_range(1..=2) {
            match rng.random_range(0..10) {
                0..4 if walk.present.len() < n => walk.add(rng, most),
                0..7 => walk.remove(rng, most - 1),
                7..9 => walk.change_q(rng, &others[step % others.len()]),
                _ => walk.restore(rng),
            }
        }
        // Unsolved states, and those without a solution, are saved too.
        if rng.random_bool(0.1) {
            walk.save();
        }
        walk.solve(&format!("{context}, step {step}"));
        if rng.random_bool(0.3) {
            walk.save();
        }
    }
    walk.work
}

fn total(a: Work, b: Work) -> Work {
    Work { kept: a.kept + b.kept, fresh: a.fresh + b.fresh, without_solution: a.without_solution + b.without_solution }
}

#[test]
fn random_sequences_over_random_problems() {
    sequences_over_random_problems(By::Dantzig, 70, 250);
}

#[test]
fn random_sequences_by_blocks() {
    sequences_over_random_problems(By::Blocks, 72, 250);
}

#[test]
fn random_sequences_by_turns() {
    sequences_over_random_problems(By::Turns, 73, 100);
}

fn sequences_over_random_problems(by: By, seed: u64, cases: usize) {
    let mut rng = random(seed);
    let mut work = Work::default();
    for case in 0..cases {
        let n = rng.random_range(1..=40);
        let rank = rng.random_range(1..=n);
        let mut g = if case % 2 == 0 { integer_rows(&mut rng, rank, n) } else { rows(&mut rng, rank, n) };
        if case % 3 == 0 {
            repeat_columns(&mut rng, &mut g, n);
        }
        let m = gram(&g, n);
        let others: Vec<Vec<f64>> = (0..4).map(|_| feasible_q(&mut rng, &m, n)).collect();
        let q = others[0].clone();
        let scaled = badly_scaled(&mut rng, &m, &q);
        let (m, q) = if case % 5 == 0 { scaled } else { (m, q) };
        let others = if case % 5 == 0 { vec![q.clone()] } else { others };
        let context = format!("case {case}, n = {n}, rank = {rank}");
        work = total(work, walk(&mut rng, problem(&m, q), &others, 30, by, &context));
    }
    eprintln!("random, {by:?}: {work:?}");
    assert!(5 * work.without_solution > cases / 3, "parts without a solution must occur: {work:?}");
    assert!(3 * work.kept < 2 * work.fresh, "{work:?}");
}

/// Large enough for the sparse factor; singular because of the full face contacts.
#[test]
fn random_sequences_over_walls() {
    let mut rng = random(71);
    for (friction, by) in [None, Some(0.4)].into_iter().flat_map(|f| [(f, By::Dantzig), (f, By::Blocks)]) {
        for wall in [Wall::pyramid(8, friction), Wall::column(40, friction)] {
            let problem = wall.problem();
            let others: Vec<Vec<f64>> =
                (1..4).map(|k| problem.q().iter().map(|q| q * f64::from(k)).collect()).collect();
            let blocks = wall.centres.len();
            let context = format!("{blocks} blocks, friction {friction:?}, {by:?}");
            let work = walk(&mut rng, problem, &others, 80, by, &context);
            eprintln!("{context}: {work:?}");
            assert!(3 * work.kept < 2 * work.fresh, "{work:?}");
        }
    }
}

/// A wall taken down block by block: its removal costs a few pivots a block, a fresh solve all of them again.
#[test]
fn taking_a_wall_down_takes_few_pivots() {
    for friction in [None, Some(0.5)] {
        let wall = Wall::pyramid(8, friction);
        let mut walk = Walk::new(wall.problem());
        walk.present = (0..walk.q.len()).collect();
        walk.solver.add_rows(&walk.present).unwrap();
        walk.solve("complete");
        let built = walk.work;
        for top in (1..wall.centres.len()).rev() {
            let generators = wall.generators();
            let gone: Vec<usize> = walk.present.iter().copied().filter(|&j| generators[j].upper() == top).collect();
            walk.present.retain(|j| !gone.contains(j));
            walk.solver.remove_rows(&gone).unwrap();
            walk.solve(&format!("{top} blocks left"));
        }
        let (kept, fresh) = (walk.work.kept - built.kept, walk.work.fresh - built.fresh);
        eprintln!("friction {friction:?}: {kept} pivots kept, {fresh} fresh, {:?}", walk.solver.counts());
        assert!(4 * kept < fresh, "friction {friction:?}: {kept} and {fresh}");
    }
}

/// Going back to a solved state and asking again costs nothing, also after q and the rows have changed.
#[test]
fn a_restored_state_is_solved() {
    let mut walk = Walk::new(Wall::pyramid(6, Some(0.5)).problem());
    walk.present = (0..walk.q.len()).collect();
    walk.solver.add_rows(&walk.present).unwrap();
    walk.solve("complete");
    let (state, w) = (walk.solver.snapshot(), walk.solver.solution(Status::Solved).w);
    walk.solver.remove_rows(&[0, 5, 9]).unwrap();
    walk.solver.set_q_at(&[3], &[-4.0]).unwrap();
    walk.solver.solve().unwrap();
    walk.solver.restore(&state).unwrap();
    let before = walk.solver.counts();
    assert_eq!(walk.solver.solve(), Ok(Status::Solved));
    assert_eq!((walk.solver.counts() - before).pivots, 0);
    for (w, again) in w.iter().zip(walk.solver.solution(Status::Solved).w) {
        assert!((w - again).abs() < 1e-12);
    }
}

/// Every row put into the factor and taken out of it is counted: four independent rows go in, two come out.
#[test]
fn rows_of_the_factor_are_counted() {
    let m: Vec<f64> = (0..16).map(|p| if p % 5 == 0 { 1.0 } else { 0.0 }).collect();
    let mut solver = Solver::new(problem(&m, vec![-1.0; 4]), Settings::default()).unwrap();
    solver.add_rows(&[0, 1, 2, 3]).unwrap();
    solver.solve().unwrap();
    assert_eq!((solver.counts().factor_rows, solver.counts().pivots), (4, 4));
    // Directions on 0, 1, 2 and 3 active rows: k^2 numbers of the dense factor each.
    assert_eq!(solver.counts().entries_solved, 1 + 4 + 9);
    solver.remove_rows(&[1, 2]).unwrap();
    assert_eq!(solver.counts().factor_rows, 6);
    solver.solve().unwrap();
    assert_eq!((solver.counts().factor_rows, solver.counts().pivots), (6, 4));
}

/// `M` and `q` of generators, by hand: two bodies of mass 2 and 4 in one dimension, pushed by 1 N each from the left
/// end, the middle and the right end.
#[test]
fn the_problem_of_generators() {
    let g = Columns::new(2, &[0, 1, 3, 4], &[0, 1, 0, 1], &[1.0, 1.0, -1.0, -1.0]).unwrap();
    let made = Problem::from_generators(&g, &[0.5, 0.25], &[3.0, -1.0]).unwrap();
    // Columns (1, 0), (-1, 1), (0, -1); W = diag(1/2, 1/4).
    let m = [0.5, -0.5, 0.0, -0.5, 0.75, -0.25, 0.0, -0.25, 0.25];
    assert_eq!(made, problem(&m, vec![-1.5, 1.75, -0.25]));
}

/// The same walls, once from the definition of M and once from the generators.
#[test]
fn a_solver_of_generators_answers_as_one_of_the_matrix() {
    let wall = Wall::pyramid(5, Some(0.5));
    let (g, w, h) = wall.columns();
    let mut from_g = Solver::from_generators(&g, &w, &h, Settings::default()).unwrap();
    let mut from_m = Solver::new(wall.problem(), Settings::default()).unwrap();
    let all: Vec<usize> = (0..wall.problem().len()).collect();
    for solver in [&mut from_g, &mut from_m] {
        solver.add_rows(&all).unwrap();
        assert_eq!(solver.solve(), Ok(Status::Solved));
    }
    let z = from_g.solution(Status::Solved).z;
    assert_solves(&wall.problem(), &z, "from generators");
    assert_same_w(&wall.problem(), &z, &from_m.solution(Status::Solved).z, SAME_W, "from generators");
}
