//! Lemke's method from the basis of a sub-problem's solution: the classes of matrices that only it takes, what a ray
//! means, and that the work falls. (For symmetric semidefinite M it is compared with Dantzig's in `reuse`.)

use crate::{
    contact::Wall,
    problems::{gram, integer_rows, problem, random, rows, vector},
    verify::{assert_answer, assert_certificate, assert_solves},
};
use drystone_lcp::{LcpError, Lemke, Method, Problem, Settings, Solution, Start, StartError, Status};
use rand::{Rng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

fn lemke(problem: &Problem, start: Option<&Start>) -> Result<Solution, LcpError> {
    Lemke.solve(problem, start, &Settings::default())
}

/// The solution of a random principal sub-problem, if it has one.
fn random_start(rng: &mut Pcg64Mcg, problem: &Problem) -> Option<Start> {
    let mut indices: Vec<usize> = (0..problem.len()).collect();
    indices.shuffle(rng);
    indices.truncate(rng.random_range(0..=problem.len()));
    let part = lemke(&problem.principal(&indices), None).unwrap();
    (part.status == Status::Solved).then_some(Start { indices, z: part.z })
}

/// `G' G` plus a skew-symmetric matrix: semidefinite, not symmetric, and of any rank.
fn skewed(rng: &mut Pcg64Mcg, n: usize, rank: usize, integers: bool) -> Vec<f64> {
    let g = if integers { integer_rows(rng, rank, n) } else { rows(rng, rank, n) };
    let mut m = gram(&g, n);
    for i in 0..n {
        for j in 0..i {
            let skew = if integers { f64::from(rng.random_range(-1..=1)) } else { rng.random_range(-1.0..1.0) };
            m[i * n + j] += skew;
            m[j * n + i] -= skew;
        }
    }
    m
}

/// For semidefinite matrices that are not symmetric a start leads to a solution if there is one, else to a proof.
#[test]
fn semidefinite_and_not_symmetric() {
    let mut rng = random(80);
    let (mut solved, mut without, mut dependent) = (0, 0, 0);
    for case in 0..2000 {
        let n = rng.random_range(1..=25);
        let rank = rng.random_range(0..=n);
        let m = skewed(&mut rng, n, rank, case % 2 == 0);
        let problem = problem(&m, vector(&mut rng, n));
        let context = format!("case {case}, n = {n}, rank = {rank}");
        let Some(start) = random_start(&mut rng, &problem) else { continue };
        let fresh = lemke(&problem, None).unwrap();
        match lemke(&problem, Some(&start)) {
            Ok(solution) => {
                assert_answer(&problem, &solution, &context);
                assert_eq!(solution.status, fresh.status, "{context}");
                if solution.status == Status::Solved { solved += 1 } else { without += 1 }
            }
            Err(LcpError::Start(StartError::Dependent)) => dependent += 1,
            Err(error) => panic!("{context}: {error}"),
        }
    }
    assert!(solved > 300 && without > 50, "both kinds must occur: {solved} solved, {without} without");
    assert_eq!(dependent, 0, "a solution of Lemke's method is a basic one");
}

/// Linear programs as complementarity problems, all right-hand sides zero or one: every vertex is degenerate. Where basic `z`
/// are zero, the positive ones are too few for a basis, and others have to join them.
#[test]
fn degenerate_linear_programs_grow_row_by_row() {
    let mut rng = random(81);
    let (mut solved, mut without, mut refused) = (0, 0, 0);
    for case in 0..400 {
        let (rows, columns) = (rng.random_range(1..=8), rng.random_range(1..=8));
        let n = rows + columns;
        let mut m = vec![0.0; n * n];
        for r in 0..rows {
            for c in 0..columns {
                let a = f64::from(rng.random_range(-2..=2));
                m[c * n + columns + r] = a;
                m[(columns + r) * n + c] = -a;
            }
        }
        let q = (0..n).map(|i| f64::from(rng.random_range(if i < columns { -2..=1 } else { 0..=1 }))).collect();
        let complete = problem(&m, q);
        let mut order: Vec<usize> = (0..n).collect();
        order.shuffle(&mut rng);
        let mut start: Option<Start> = None;
        for k in 1..=n {
            let indices = order[..k].to_vec();
            let part = complete.principal(&indices);
            // The start's rows come first among those of the part.
            let known = start.take().map(|start| Start { indices: (0..start.z.len()).collect(), z: start.z });
            let context = format!("case {case}, {k} of {n} rows");
            let fresh = lemke(&part, None).unwrap();
            let solution = match lemke(&part, known.as_ref()) {
                Err(LcpError::Start(StartError::Dependent)) => {
                    refused += 1;
                    fresh.clone()
                }
                outcome => outcome.unwrap_or_else(|error| panic!("{context}: {error}")),
            };
            assert_answer(&part, &solution, &context);
            assert_eq!(solution.status, fresh.status, "{context}");
            if solution.status == Status::Solved {
                solved += 1;
                start = Some(Start { indices, z: solution.z });
            } else {
                without += 1;
            }
        }
    }
    assert!(solved > 500 && without > 500, "both kinds must occur: {solved} solved, {without} without");
    assert_eq!(refused, 0, "of {solved} starts");
}

/// P-matrices that are far from semidefinite (positive diagonal, no negative entry, and lower triangular): never a ray.
#[test]
fn p_matrices_never_end_on_a_ray() {
    let mut rng = random(82);
    for case in 0..500 {
        let n = rng.random_range(1..=20);
        let entry = |rng: &mut Pcg64Mcg, i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => rng.random_range(0.5..1.5),
            std::cmp::Ordering::Greater => rng.random_range(-3.0..3.0),
        };
        let m: Vec<f64> = (0..n * n).map(|p| entry(&mut rng, p / n, p % n)).collect();
        let problem = problem(&m, vector(&mut rng, n));
        let start = random_start(&mut rng, &problem).expect("a sub-problem of a P-matrix has a solution");
        let (solution, fresh) = (lemke(&problem, Some(&start)).unwrap(), lemke(&problem, None).unwrap());
        assert_eq!(solution.status, Status::Solved, "case {case}");
        assert_solves(&problem, &solution.z, &format!("case {case}"));
        // The solution is unique.
        let size = fresh.z.iter().fold(1.0, |size: f64, z| size.max(z.abs()));
        assert!(solution.z.iter().zip(&fresh.z).all(|(z, other)| (z - other).abs() <= 1e-7 * size), "case {case}");
    }
}

/// Matrices without a negative entry are copositive-plus where their diagonal is positive, which a principal pivot need not
/// keep; of others nothing is known. A start must not make the answer weaker than that of a fresh solve.
#[test]
fn matrices_outside_the_classes_get_the_answer_of_a_fresh_solve() {
    let mut rng = random(83);
    let (mut solved, mut certified, mut rays) = (0, 0, 0);
    for case in 0..2000 {
        let n = rng.random_range(2..=8);
        let low = if case % 2 == 0 { 0.0 } else { -1.0 };
        let m: Vec<f64> = (0..n * n).map(|_| rng.random_range(low..1.0)).collect();
        let problem = problem(&m, vector(&mut rng, n));
        let context = format!("case {case}, n = {n}");
        let Some(start) = random_start(&mut rng, &problem) else { continue };
        let fresh = lemke(&problem, None).unwrap();
        let solution = lemke(&problem, Some(&start)).unwrap_or_else(|error| panic!("{context}: {error}"));
        match solution.status {
            Status::Solved => {
                assert_solves(&problem, &solution.z, &context);
                solved += 1;
            }
            Status::NoSolution => {
                assert_certificate(&problem, &solution.ray.unwrap(), &context);
                assert_ne!(fresh.status, Status::Solved, "{context}");
                certified += 1;
            }
            status => {
                assert_eq!((status, fresh.status), (Status::RayTermination, Status::RayTermination), "{context}");
                rays += 1;
            }
        }
    }
    assert!(solved > 500 && rays > 20, "{solved} solved, {certified} without a solution, {rays} rays");
}

/// The rows of z = (1, 1) depend on one another, by y = (1, -1); but `M y = (0, 0, -2)`, so z may not be moved along y.
#[test]
fn dependent_rows_of_a_matrix_that_is_not_symmetric_are_refused() {
    let m = [1.0, 1.0, 2.0, 1.0, 1.0, 0.0, -2.0, 0.0, 0.0];
    let problem = problem(&m, vec![-2.0, -2.0, 3.0]);
    let start = Start { indices: vec![0, 1], z: vec![1.0, 1.0] };
    assert_eq!(lemke(&problem, Some(&start)), Err(LcpError::Start(StartError::Dependent)));
    let basic = Start { indices: vec![0, 1], z: vec![2.0, 0.0] };
    assert_answer(&problem, &lemke(&problem, Some(&basic)).unwrap(), "a basic solution of the same rows");
}

/// Total pivots of growing a wall block by block: with reuse, and from scratch at every size.
fn pivots_of_growing(wall: &Wall) -> (usize, usize) {
    let complete = wall.problem();
    let generators = wall.generators();
    let (mut reused, mut cold) = (0, 0);
    let mut start = Start { indices: Vec::new(), z: Vec::new() };
    for blocks in 1..=wall.centres.len() {
        let indices: Vec<usize> = (0..complete.len()).filter(|&j| generators[j].upper() < blocks).collect();
        let part = complete.principal(&indices);
        let place = |row: &usize| indices.binary_search(row).expect("rows only come");
        let known = Start { indices: start.indices.iter().map(place).collect(), z: start.z };
        let (solution, fresh) = (lemke(&part, Some(&known)).unwrap(), lemke(&part, None).unwrap());
        for solution in [&solution, &fresh] {
            assert_eq!(solution.status, Status::Solved, "{blocks} blocks");
            assert_answer(&part, solution, &format!("{blocks} blocks"));
        }
        reused += solution.counts.pivots;
        cold += fresh.counts.pivots;
        start = Start { indices, z: solution.z };
    }
    (reused, cold)
}

#[test]
fn a_growing_wall_takes_fewer_pivots() {
    for wall in
        [Wall::column(20, None), Wall::pyramid(7, None), Wall::column(20, Some(0.5)), Wall::pyramid(7, Some(0.5))]
    {
        let (reused, cold) = pivots_of_growing(&wall);
        assert!(5 * reused < cold, "{reused} with reuse, {cold} from scratch");
    }
}

/// A guess of the active rows: the right one is a solution, a wrong one is a valid start or none. Dependent rows are none.
#[test]
fn a_guess_of_the_active_rows_starts_or_is_refused() {
    let mut rng = random(11);
    let (mut starts, mut refused) = (0, 0);
    for _ in 0..300 {
        let n = rng.random_range(1..=8);
        let problem = problem(&skewed(&mut rng, n, n, false), vector(&mut rng, n));
        let solution = lemke(&problem, None).unwrap();
        let active: Vec<usize> = (0..n).filter(|&i| solution.z[i] > 0.0).collect();
        let right = Start::from_active(&problem, &active).expect("the solution's own rows");
        let again = lemke(&problem, Some(&right)).unwrap();
        assert_eq!((again.status, again.counts.pivots), (Status::Solved, 0));
        let guess: Vec<usize> = (0..n).filter(|_| rng.random()).collect();
        match Start::from_active(&problem, &guess) {
            Some(start) => {
                starts += 1;
                let other = lemke(&problem, Some(&start)).unwrap();
                assert_eq!(other.status, Status::Solved);
                other.z.iter().zip(&solution.z).for_each(|(a, b)| assert!((a - b).abs() <= 1e-8, "{a} and {b}"));
            }
            None => refused += 1,
        }
    }
    assert!(starts > 50 && refused > 50, "{starts} and {refused}");
    let dependent = problem(&[1.0, 1.0, 1.0, 1.0], vec![-1.0, -2.0]);
    assert_eq!(Start::from_active(&dependent, &[0, 1]), None);
}
