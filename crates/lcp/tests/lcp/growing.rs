//! A cone whose rows and columns are not known beforehand: they come to the problem and go from it, and every answer is that
//! of a solver that had them all from the beginning.

use drystone_lcp::cone::{Columns, ConeSolver, Membership};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

type Column = Vec<(usize, f64)>;

/// A problem by columns; every row has the unit one.
#[derive(Debug, Clone, Default)]
struct Growing {
    columns: Vec<Column>,
    h: Vec<f64>,
}

/// So many rows and columns more: each column holds a new row, and may press on an older one.
fn more(random: &mut Pcg64Mcg, old: usize) -> (Vec<Column>, Vec<f64>) {
    let rows = random.random_range(1..=3);
    let columns = (0..random.random_range(1..=5)).map(|_| {
        let mut column = vec![(old + random.random_range(0..rows), random.random_range(0.1..1.0))];
        if random.random_range(0..3) > 0 && old > 0 {
            column.push((random.random_range(0..old), random.random_range(-1.0..0.2)));
        }
        column
    });
    (columns.collect(), (0..rows).map(|_| random.random_range(-0.1..1.0)).collect())
}

fn sparse(rows: usize, columns: &[Column]) -> Columns {
    let mut indptr = vec![0];
    columns.iter().for_each(|column| indptr.push(indptr[indptr.len() - 1] + column.len()));
    let (indices, data): (Vec<usize>, Vec<f64>) = columns.iter().flatten().copied().unzip();
    Columns::new(rows, &indptr, &indices, &data).unwrap()
}

fn solver(problem: &Growing) -> ConeSolver {
    ConeSolver::new(sparse(problem.h.len(), &problem.columns), &problem.h, &vec![1.0; problem.h.len()]).unwrap()
}

/// The answer, and whether the forces balance every row, by a solver that starts from nothing.
fn fresh(problem: &Growing) -> Membership {
    let mut solver = solver(problem);
    solver.add_rows(&(0..problem.h.len()).collect::<Vec<_>>());
    solver.solve()
}

/// The largest imbalance of the forces, and the largest pull.
fn error(solver: &ConeSolver, problem: &Growing) -> f64 {
    let mut balance: Vec<f64> = problem.h.iter().map(|h| -h).collect();
    for (j, column) in problem.columns.iter().enumerate() {
        column.iter().for_each(|&(row, value)| balance[row] += solver.f(j) * value);
    }
    let pull = (0..problem.columns.len()).map(|j| -solver.f(j));
    balance.into_iter().map(f64::abs).chain(pull).fold(0.0, f64::max)
}

#[test]
fn rows_and_columns_come_and_go_as_if_they_had_been_there() {
    let mut answers = [0, 0];
    for seed in 0..60 {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut kept = Growing::default();
        let mut grown = solver(&kept);
        for _ in 0..40 {
            let (columns, h) = more(&mut random, kept.h.len());
            let mut tried = kept.clone();
            tried.columns.extend(columns.clone());
            tried.h.extend(&h);
            grown.truncate(kept.h.len(), kept.columns.len());
            grown.append(sparse(tried.h.len(), &columns), &h, &vec![1.0; h.len()]).unwrap();
            let before = grown.mark();
            grown.add_rows(&(kept.h.len()..tried.h.len()).collect::<Vec<_>>());
            let found = if random.random_range(0..2) == 0 { grown.solve() } else { grown.decide() };
            assert_eq!(found, fresh(&tried), "seed {seed}, {} rows", tried.h.len());
            let stands = found == Membership::Inside;
            answers[usize::from(stands)] += 1;
            if stands && random.random_range(0..4) > 0 {
                kept = tried;
                assert_eq!(grown.solve(), Membership::Inside);
                assert!(error(&grown, &kept) < 1e-10, "seed {seed}: {}", error(&grown, &kept));
            } else {
                grown.roll_back(before);
            }
        }
    }
    assert!(answers.iter().all(|&count| count > 400), "{answers:?}");
}

/// What is there is not solved again: a row that comes costs its own pivots.
#[test]
fn what_is_there_is_kept() {
    let rows = 200;
    let mut column = Growing::default();
    let mut grown = solver(&column);
    for row in 0..rows {
        // A block on the one before: it bears a load of one, and passes all on.
        let own: Column = if row == 0 { vec![(0, 1.0)] } else { vec![(row - 1, -1.0), (row, 1.0)] };
        grown.append(sparse(row + 1, std::slice::from_ref(&own)), &[1.0], &[1.0]).unwrap();
        column.columns.push(own);
        column.h.push(1.0);
        grown.add_rows(&[row]);
        assert_eq!(grown.decide(), Membership::Inside);
    }
    assert_eq!(grown.solve(), Membership::Inside);
    assert!(error(&grown, &column) < 1e-9);
    assert_eq!(grown.counts().pivots, rows);
}

#[test]
fn what_does_not_fit_is_refused() {
    let mut grown = solver(&Growing { columns: vec![vec![(0, 1.0)]], h: vec![1.0] });
    let more = sparse(2, &[vec![(1, 1.0)]]);
    assert!(grown.append(more.clone(), &[1.0, 1.0], &[1.0, 1.0]).is_err());
    assert!(grown.append(more.clone(), &[f64::NAN], &[1.0]).is_err());
    assert!(grown.append(more.clone(), &[1.0], &[0.0]).is_err());
    assert!(grown.append(sparse(0, &[]), &[], &[]).is_err());
    grown.append(more, &[1.0], &[1.0]).unwrap();
    grown.add_rows(&[0, 1]);
    assert_eq!(grown.solve(), Membership::Inside);
}

#[test]
#[should_panic(expected = "a row that goes is present")]
fn rows_that_are_present_stay() {
    let mut grown = solver(&Growing { columns: vec![vec![(0, 1.0)]], h: vec![1.0] });
    grown.add_rows(&[0]);
    grown.truncate(0, 0);
}

#[test]
#[should_panic(expected = "a mark that has ended")]
fn marks_end_when_the_problem_changes() {
    let mut grown = solver(&Growing { columns: vec![vec![(0, 1.0)]], h: vec![1.0] });
    let mark = grown.mark();
    grown.append(sparse(2, &[]), &[1.0], &[1.0]).unwrap();
    grown.roll_back(mark);
}
