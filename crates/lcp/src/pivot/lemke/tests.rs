//! The invariant that the end of the method rests on.

use super::path::{End, Path};
use crate::{matrix::SparseColumns, settings::Settings};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// After every pivot each row of `[x_B, B^-1]` is lexicographically positive: its first entry that is not zero is
/// positive. Then no basis comes twice (Eaves 1971). Integers, so that ties abound and zero is recognisable.
#[test]
fn every_row_stays_lexicographically_positive() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let settings = Settings::default();
    let (mut degenerate, mut degenerate_from_basis) = (0, 0);
    for case in 0..400 {
        let n: usize = rng.random_range(2..=7);
        let m: Vec<f64> = (0..n * n).map(|_| f64::from(rng.random_range(-2..=2))).collect();
        let m = SparseColumns::from_dense(&m).unwrap();
        let q: Vec<f64> = (0..n).map(|_| f64::from(rng.random_range(-1..=1))).collect();
        let fresh = || Some(Path::new(&m, &q, &settings, vec![1.0; n]));
        degenerate += degenerate_rows(fresh, &format!("case {case}"));
        let active: Vec<usize> = (0..n).filter(|_| rng.random_bool(0.5)).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.rotate_left(case % n);
        let from_basis = || Path::from_basis(&m, &q, &settings, &active, order.clone());
        degenerate_from_basis += degenerate_rows(from_basis, &format!("case {case}, from {active:?}"));
    }
    assert!(degenerate > 100, "the problems must be degenerate: only {degenerate} rows");
    assert!(degenerate_from_basis > 100, "from a basis only {degenerate_from_basis} rows");
}

/// Checks every basis on a path; how many of the rows began with zero.
fn degenerate_rows<'a>(path: impl Fn() -> Option<Path<'a>>, context: &str) -> usize {
    let mut degenerate = 0;
    for limit in 1..=30 {
        let Some(mut path) = path() else { break };
        if path.follow(limit) != End::Limit {
            break;
        }
        for (r, row) in path.lexicographic_rows().enumerate() {
            let first = row.iter().copied().find(|value| value.abs() > 1e-9);
            assert!(first.is_some_and(|value| value > 0.0), "{context}, {limit} pivots, row {r}: {row:?}");
            degenerate += usize::from(row[0].abs() <= 1e-9);
        }
    }
    degenerate
}
