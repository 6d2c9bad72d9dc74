//! Both factors against a plain Cholesky solve, and against one another.

use super::{ActiveFactor, DenseFactor, SingularBlock, SparseFactor, choose};
use crate::matrix::SparseColumns;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Worst relative error of a solve that the tests allow, for blocks with a condition number up to about 1e3.
const ACCURATE: f64 = 1e-10;

/// A sparse positive definite matrix: a random G with a few entries in every column, plus a unit diagonal.
fn definite(rng: &mut Pcg64Mcg, n: usize, entries: usize) -> SparseColumns {
    let mut g = vec![vec![0.0; n]; n];
    for j in 0..n * entries {
        g[rng.random_range(0..n)][j % n] = rng.random_range(-1.0..1.0);
    }
    from_gram(&g, n, 1.0)
}

fn from_gram(g: &[Vec<f64>], n: usize, ridge: f64) -> SparseColumns {
    let dot = |i: usize, j: usize| g.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let entry = |p: usize| dot((p / n).max(p % n), (p / n).min(p % n)) + if p / n == p % n { ridge } else { 0.0 };
    SparseColumns::from_dense(&(0..n * n).map(entry).collect::<Vec<_>>()).unwrap()
}

/// Solves on `active` by a Cholesky factorisation written out.
fn reference(m: &SparseColumns, active: &[usize], b: &[f64]) -> Vec<f64> {
    let k = active.len();
    let mut l = vec![vec![0.0; k]; k];
    let mut x: Vec<f64> = active.iter().map(|&i| b[i]).collect();
    for r in 0..k {
        for c in 0..=r {
            let dot: f64 = (0..c).map(|p| l[r][p] * l[c][p]).sum();
            let rest = m.get(active[r], active[c]) - dot;
            l[r][c] = if r == c { rest.sqrt() } else { rest / l[c][c] };
        }
        let dot: f64 = (0..r).map(|p| l[r][p] * x[p]).sum();
        x[r] = (x[r] - dot) / l[r][r];
    }
    for r in (0..k).rev() {
        let dot: f64 = (r + 1..k).map(|p| l[p][r] * x[p]).sum();
        x[r] = (x[r] - dot) / l[r][r];
    }
    let mut full = vec![0.0; b.len()];
    for (&i, value) in active.iter().zip(x) {
        full[i] = value;
    }
    full
}

fn solve(factor: &dyn ActiveFactor, active: &[usize], b: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; b.len()];
    for &i in active {
        x[i] = b[i];
    }
    factor.solve(&mut x);
    x
}

fn assert_close(x: &[f64], expected: &[f64], context: &str) {
    let size = expected.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    for (i, (x, expected)) in x.iter().zip(expected).enumerate() {
        assert!((x - expected).abs() <= ACCURATE * size, "{context}: x[{i}] = {x}, not {expected}");
    }
}

fn both(m: &SparseColumns) -> [Box<dyn ActiveFactor>; 2] {
    [Box::new(DenseFactor::new(m.len())), Box::new(SparseFactor::new(m))]
}

#[test]
fn random_insertions_and_removals_solve_like_cholesky() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for case in 0..60 {
        let (n, entries) = (rng.random_range(1..=60), rng.random_range(1..=4));
        let m = definite(&mut rng, n, entries);
        let b: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
        let mut factors = both(&m);
        let mut active: Vec<usize> = Vec::new();
        for step in 0..4 * n {
            let i = rng.random_range(0..n);
            match active.iter().position(|&j| j == i) {
                Some(place) => {
                    active.remove(place);
                    factors.iter_mut().for_each(|factor| factor.remove(i));
                }
                None => {
                    active.push(i);
                    factors.iter_mut().for_each(|factor| assert!(factor.insert(&m, i).is_ok()));
                }
            }
            let expected = reference(&m, &active, &b);
            let context = format!("case {case}, step {step}, n = {n}, {} active", active.len());
            let [dense, sparse] = factors.each_ref().map(|factor| {
                assert_eq!((factor.len(), factor.is_empty()), (active.len(), active.is_empty()), "{context}");
                solve(factor.as_ref(), &active, &b)
            });
            assert_close(&dense, &expected, &format!("{context}, dense"));
            assert_close(&sparse, &expected, &format!("{context}, sparse"));
            assert_close(&sparse, &dense, &format!("{context}, sparse and dense"));
            assert!((0..n).all(|j| active.contains(&j) || (dense[j] == 0.0 && sparse[j] == 0.0)), "{context}");
        }
    }
}

/// Errors must not build up over thousands of updates of one factor.
#[test]
fn a_long_sequence_keeps_its_accuracy() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let n = 40;
    let m = definite(&mut rng, n, 3);
    let b: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
    for mut factor in both(&m) {
        let mut present = vec![false; n];
        for _ in 0..20_000 {
            let i = rng.random_range(0..n);
            present[i] = !present[i];
            if present[i] { assert!(factor.insert(&m, i).is_ok()) } else { factor.remove(i) }
        }
        let active: Vec<usize> = (0..n).filter(|&i| present[i]).collect();
        assert_close(&solve(factor.as_ref(), &active, &b), &reference(&m, &active, &b), &format!("{factor:.0?}"));
    }
}

/// Rows repeated exactly: the copy is refused, whatever came between, and the factor solves as before. It may be built again
/// first, as the contract says.
#[test]
fn a_dependent_row_is_refused_and_the_factor_stays_usable() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    for case in 0..100 {
        let n: usize = rng.random_range(2..=30);
        let mut g: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
        let (row, copy) = (rng.random_range(0..n), rng.random_range(0..n));
        if row == copy {
            continue;
        }
        g.iter_mut().for_each(|g| g[copy] = g[row]);
        let m = from_gram(&g, n, 0.0);
        let b: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
        // Half of the rows, which keeps the block well conditioned; the row among them.
        let active: Vec<usize> = (0..n).filter(|&i| i == row || (i != copy && i % 2 == 0)).collect();
        for mut factor in both(&m) {
            active.iter().for_each(|&i| assert!(factor.insert(&m, i).is_ok()));
            let before = solve(factor.as_ref(), &active, &b);
            match factor.insert(&m, copy) {
                Err(SingularBlock { row, pivot }) => {
                    assert_eq!(row, copy, "case {case}");
                    assert!(pivot < 1e-10 * m.get(copy, copy), "case {case}: {pivot:e}");
                }
                // Rounding can leave a pivot just above the factor's own floor; the row must then be removable.
                Ok(_) => factor.remove(copy),
            }
            assert_eq!(factor.len(), active.len(), "case {case}");
            let same = |after: &[f64]| after.iter().zip(&before).all(|(x, y)| (x - y).abs() <= 1e-8 * (1.0 + y.abs()));
            if !same(&solve(factor.as_ref(), &active, &b)) {
                factor.clear();
                active.iter().for_each(|&i| assert!(factor.insert(&m, i).is_ok()));
            }
            assert!(same(&solve(factor.as_ref(), &active, &b)), "case {case}");
        }
    }
}

/// Exact integers, so that the pivot of the copy is exactly zero: no rebuilding is needed then.
#[test]
fn an_exact_copy_leaves_the_factor_untouched() {
    let m = SparseColumns::from_dense(&[4.0, 2.0, 4.0, 2.0, 5.0, 2.0, 4.0, 2.0, 4.0]).unwrap();
    for mut factor in both(&m) {
        factor.insert(&m, 0).unwrap();
        factor.insert(&m, 1).unwrap();
        assert_eq!(factor.insert(&m, 2).map_err(|error| error.row), Err(2));
        // 4 x + 2 y = 2, 2 x + 5 y = 9: x = -1/2, y = 2.
        assert_eq!(solve(factor.as_ref(), &[0, 1], &[2.0, 9.0, 0.0]), vec![-0.5, 2.0, 0.0]);
        factor.remove(0);
        factor.insert(&m, 2).unwrap();
        assert_eq!(solve(factor.as_ref(), &[1, 2], &[0.0, 9.0, 2.0]), vec![0.0, 2.0, -0.5]);
    }
}

#[test]
fn a_zero_row_is_refused() {
    let m = SparseColumns::from_dense(&[1.0, 0.0, 0.0, 0.0]).unwrap();
    for mut factor in both(&m) {
        assert!(factor.insert(&m, 1).is_err());
        factor.insert(&m, 0).unwrap();
        assert_eq!(solve(factor.as_ref(), &[0], &[3.0, 0.0]), vec![3.0, 0.0]);
    }
}

#[test]
fn removing_an_absent_row_and_clearing_do_nothing_else() {
    let m = SparseColumns::from_dense(&[2.0, 1.0, 1.0, 2.0]).unwrap();
    for mut factor in both(&m) {
        factor.remove(1);
        factor.insert(&m, 0).unwrap();
        factor.remove(1);
        assert_eq!(solve(factor.as_ref(), &[0], &[4.0, 0.0]), vec![2.0, 0.0]);
        factor.clear();
        assert!(factor.is_empty());
        assert_eq!(solve(factor.as_ref(), &[], &[4.0, 5.0]), vec![0.0, 0.0]);
        factor.insert(&m, 1).unwrap();
        assert_eq!(solve(factor.as_ref(), &[1], &[0.0, 4.0]), vec![0.0, 2.0]);
    }
}

/// A banded matrix keeps its band: entries grow with n, not with n^2, and the sparse factor is chosen.
#[test]
fn the_choice_follows_the_fill() {
    let band = |n: usize| {
        let near = |p: usize| (p / n).abs_diff(p % n);
        let entry = |p: usize| [4.0, -1.0].get(near(p)).copied().unwrap_or(0.0);
        SparseColumns::from_dense(&(0..n * n).map(entry).collect::<Vec<_>>()).unwrap()
    };
    assert_eq!(SparseFactor::new(&band(200)).entries(), 2 * 200 - 1);
    assert!(format!("{:?}", choose(&band(200))).starts_with("SparseFactor"));
    assert!(format!("{:?}", choose(&band(10))).starts_with("DenseFactor"));
    let full = SparseColumns::from_dense(&vec![1.0; 50 * 50]).unwrap();
    assert!(format!("{:?}", choose(&full)).starts_with("DenseFactor"));
}
