//! Random symmetric positive semidefinite problems from seeds.

use drystone_lcp::Problem;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The generator of every random test: same seed, same problems, on every machine.
pub fn random(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// `G' G` for `rank` rows G of n entries, both triangles from the same products.
pub fn gram(g: &[Vec<f64>], n: usize) -> Vec<f64> {
    let mut m = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = g.iter().map(|row| row[i] * row[j]).sum();
            m[i * n + j] = dot;
            m[j * n + i] = dot;
        }
    }
    m
}

/// `rank` rows of n entries in -1..1.
pub fn rows(rng: &mut impl Rng, rank: usize, n: usize) -> Vec<Vec<f64>> {
    (0..rank).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect()
}

/// `rank` rows of n entries from -1, 0, 1: every quantity of the solve is a small fraction, so ties abound.
pub fn integer_rows(rng: &mut impl Rng, rank: usize, n: usize) -> Vec<Vec<f64>> {
    (0..rank).map(|_| (0..n).map(|_| f64::from(rng.random_range(-1..=1))).collect()).collect()
}

/// Overwrites some columns by exact copies of others.
pub fn repeat_columns(rng: &mut impl Rng, g: &mut [Vec<f64>], n: usize) {
    for j in 0..n {
        if rng.random_bool(0.4) {
            let copied = rng.random_range(0..n);
            for row in g.iter_mut() {
                row[j] = row[copied];
            }
        }
    }
}

/// n numbers in -1..1.
pub fn vector(rng: &mut impl Rng, n: usize) -> Vec<f64> {
    (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
}

/// n numbers from -1, 0, 1.
pub fn integer_vector(rng: &mut impl Rng, n: usize) -> Vec<f64> {
    (0..n).map(|_| f64::from(rng.random_range(-1..=1))).collect()
}

/// A q for which the problem is feasible, and so solvable: `q = s - M z` for some `z >= 0` and `s >= 0`. A third of
/// both is zero.
pub fn feasible_q(rng: &mut impl Rng, m: &[f64], n: usize) -> Vec<f64> {
    let mut sparse = || -> Vec<f64> {
        (0..n).map(|_| if rng.random_bool(1.0 / 3.0) { 0.0 } else { rng.random_range(0.0..1.0) }).collect()
    };
    let (z, s) = (sparse(), sparse());
    (0..n).map(|i| s[i] - (0..n).map(|j| m[i * n + j] * z[j]).sum::<f64>()).collect()
}

/// A q with the complementary solution `z`, `w` drawn at random; in a third of the pairs both are zero.
pub fn degenerate_q(rng: &mut impl Rng, m: &[f64], n: usize) -> Vec<f64> {
    let (mut z, mut w) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        match rng.random_range(0..3) {
            0 => z[i] = f64::from(rng.random_range(1..4)),
            1 => w[i] = f64::from(rng.random_range(1..4)),
            _ => {}
        }
    }
    (0..n).map(|i| w[i] - (0..n).map(|j| m[i * n + j] * z[j]).sum::<f64>()).collect()
}

/// `(D M D, D q)` with D from 1e-6 to 1e6, spread evenly in its logarithm: M spans 24 orders of magnitude, q 12.
pub fn badly_scaled(rng: &mut impl Rng, m: &[f64], q: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = q.len();
    let d: Vec<f64> = (0..n).map(|_| 10f64.powf(rng.random_range(-6.0..6.0))).collect();
    let scaled = (0..n * n).map(|p| m[p] * (d[p / n] * d[p % n])).collect();
    (scaled, (0..n).map(|i| q[i] * d[i]).collect())
}

/// A problem from rows of G and q.
pub fn problem(m: &[f64], q: Vec<f64>) -> Problem {
    Problem::from_dense(m, q).expect("test data is valid")
}
