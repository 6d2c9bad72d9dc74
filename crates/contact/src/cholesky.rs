//! `M = L L'` of a general mass matrix, row by row (up-looking; Davis, Direct Methods for Sparse Linear Systems, 2006, section 4.7).

/// L of a symmetric positive definite matrix, by columns; the diagonal apart.
#[derive(Debug, Default)]
pub(crate) struct Cholesky {
    diagonal: Vec<f64>,
    columns: Vec<Vec<(u32, f64)>>,
}

/// Share of a diagonal entry that elimination must leave: what is less is rounding, and the matrix not definite.
const LEFT: f64 = 1e-14;

impl Cholesky {
    /// Takes, row after row, the entries on and below the diagonal, in any order. None if the matrix is not positive definite.
    pub fn new(rows: &[Vec<(u32, f64)>]) -> Option<Self> {
        let n = rows.len();
        let mut factor = Self { diagonal: Vec::with_capacity(n), columns: vec![Vec::new(); n] };
        // Elimination tree, with paths cut short.
        let (mut parent, mut ancestor) = (vec![u32::MAX; n], vec![u32::MAX; n]);
        let mut x = vec![0.0; n];
        let mut seen = vec![u32::MAX; n];
        for (k, row) in rows.iter().enumerate() {
            let k = k as u32;
            let mut reach = Vec::new();
            let mut diagonal = 0.0;
            for &(column, value) in row {
                if column == k {
                    diagonal += value;
                    continue;
                }
                x[column as usize] += value;
                let mut at = column;
                while at != u32::MAX && at < k {
                    let next = ancestor[at as usize];
                    ancestor[at as usize] = k;
                    if next == u32::MAX {
                        parent[at as usize] = k;
                    }
                    at = next;
                }
                let mut at = column;
                while at < k && seen[at as usize] != k {
                    seen[at as usize] = k;
                    reach.push(at);
                    at = parent[at as usize];
                }
            }
            reach.sort_unstable();
            let whole = diagonal;
            for &j in &reach {
                let entry = x[j as usize] / factor.diagonal[j as usize];
                x[j as usize] = 0.0;
                for &(i, l) in &factor.columns[j as usize] {
                    x[i as usize] -= l * entry;
                }
                diagonal -= entry * entry;
                factor.columns[j as usize].push((k, entry));
            }
            if !(whole.is_finite() && diagonal > LEFT * whole) {
                return None;
            }
            factor.diagonal.push(diagonal.sqrt());
        }
        Some(factor)
    }

    /// `L^-1 x`, in place.
    pub fn forward(&self, x: &mut [f64]) {
        for j in 0..x.len() {
            if x[j] != 0.0 {
                x[j] /= self.diagonal[j];
                for &(i, l) in &self.columns[j] {
                    x[i as usize] -= l * x[j];
                }
            }
        }
    }

    /// `L^-T x`, in place.
    pub fn backward(&self, x: &mut [f64]) {
        for j in (0..x.len()).rev() {
            let rest: f64 = self.columns[j].iter().map(|&(i, l)| l * x[i as usize]).sum();
            x[j] = (x[j] - rest) / self.diagonal[j];
        }
    }

    /// `L' x`, in place.
    pub fn times_transpose(&self, x: &mut [f64]) {
        for j in 0..x.len() {
            let rest: f64 = self.columns[j].iter().map(|&(i, l)| l * x[i as usize]).sum();
            x[j] = self.diagonal[j] * x[j] + rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Cholesky;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Sparse `B B' + I`.
    #[test]
    fn factors_solve_and_multiply() {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        for n in [1_usize, 4, 20, 60] {
            let mut dense = vec![vec![0.0; n]; n];
            (0..n).for_each(|k| dense[k][k] = 1.0);
            for _ in 0..2 * n {
                let (a, b): (usize, usize) = (random.random_range(0..n), random.random_range(0..n));
                let (x, y): (f64, f64) = (random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
                for (i, p) in [(a, x), (b, y)] {
                    for (j, q) in [(a, x), (b, y)] {
                        dense[i][j] += p * q;
                    }
                }
            }
            let lower = |i: usize| (0..=i).filter(|&j| dense[i][j] != 0.0).map(|j| (j as u32, dense[i][j])).collect();
            let factor = Cholesky::new(&(0..n).map(lower).collect::<Vec<_>>()).unwrap();
            let x: Vec<f64> = (0..n).map(|_| random.random_range(-1.0..1.0)).collect();
            let right: Vec<f64> = dense.iter().map(|row| row.iter().zip(&x).map(|(a, b)| a * b).sum()).collect();
            let mut solved = right.clone();
            factor.forward(&mut solved);
            let mut whole = x.clone();
            factor.times_transpose(&mut whole);
            // M x = L (L' x).
            assert!(solved.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-12));
            factor.backward(&mut solved);
            assert!(solved.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
        }
    }

    #[test]
    fn what_is_not_definite_has_none() {
        assert!(Cholesky::new(&[vec![(0, 1.0)], vec![(0, 1.0), (1, 1.0)]]).is_none());
        assert!(Cholesky::new(&[vec![(0, -1.0)]]).is_none());
        assert!(Cholesky::new(&[vec![]]).is_none());
    }
}
