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
    let mut degenerate = 0;
    for case in 0..400 {
        let n: usize = rng.random_range(2..=7);
        let m: Vec<f64> = (0..n * n).map(|_| f64::from(rng.random_range(-2..=2))).collect();
        let m = SparseColumns::from_dense(&m).unwrap();
        let q: Vec<f64> = (0..n).map(|_| f64::from(rng.random_range(-1..=1))).collect();
        for limit in 1..=30 {
            let mut path = Path::new(&m, &q, &settings, vec![1.0; n]);
            if path.follow(limit) != End::Limit {
                break;
            }
            for (r, row) in path.lexicographic_rows().enumerate() {
                let first = row.iter().copied().find(|value| value.abs() > 1e-9);
                assert!(first.is_some_and(|value| value > 0.0), "case {case}, {limit} pivots, row {r}: {row:?}");
                degenerate += usize::from(row[0].abs() <= 1e-9);
            }
        }
    }
    assert!(degenerate > 100, "the problems must be degenerate: only {degenerate} rows");
}
