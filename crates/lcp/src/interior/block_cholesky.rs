//! Cholesky's method on a matrix of small dense blocks, column by column.
//!
//! Of little fill, as where blocks are in a chain or on a few others, a factor by supernodes has none that are worth a call; here
//! an entry of the factor is a block of as many rows as a body has unknowns, whose operations the compiler unrolls. Where each
//! column changes later ones is found once: no search is left for the numbers.

use super::blocks::{Block, Pattern, minus_product, minus_square};

/// A factor L by its blocks: `L L'` is the matrix.
pub(super) struct BlockCholesky<const B: usize> {
    /// Of L below its diagonal.
    pattern: Pattern,
    /// Of each block of the matrix below its diagonal the place in L.
    entries: Vec<u32>,
    /// For every pair of blocks of a column, one after the other, the block that their product changes; none for those on the
    /// diagonal, a block with itself.
    changed: Vec<u32>,
    /// Lower triangles, with the reciprocals of their diagonals.
    diagonal: Vec<Block<B>>,
    below: Vec<Block<B>>,
}

impl<const B: usize> BlockCholesky<B> {
    /// Where the factor of a matrix with this pattern has blocks.
    pub fn pattern_of(matrix: &Pattern) -> Pattern {
        let columns = matrix.columns();
        let mut found = Pattern::default();
        let (mut children, mut seen) = (vec![Vec::new(); columns], vec![usize::MAX; columns]);
        let mut rows = Vec::new();
        for column in 0..columns {
            seen[column] = column;
            rows.clear();
            let mut take = |row: u32| {
                if std::mem::replace(&mut seen[row as usize], column) != column {
                    rows.push(row);
                }
            };
            matrix.rows(column).iter().for_each(|&row| take(row));
            for &child in &children[column] {
                found.rows(child).iter().for_each(|&row| take(row));
            }
            rows.sort_unstable();
            if let Some(&parent) = rows.first() {
                children[parent as usize].push(column);
            }
            found.push(&rows);
        }
        found
    }

    /// For a matrix whose factor has this pattern.
    pub fn new(matrix: &Pattern, pattern: Pattern) -> Self {
        let entries = (0..matrix.columns())
            .flat_map(|column| places(matrix.rows(column), pattern.rows(column), pattern.start(column)))
            .collect();
        let mut changed = Vec::with_capacity(pattern.products());
        for column in 0..pattern.columns() {
            let rows = pattern.rows(column);
            for (k, &row) in rows.iter().enumerate() {
                let row = row as usize;
                changed.extend(places(&rows[k + 1..], pattern.rows(row), pattern.start(row)));
            }
        }
        let (diagonal, below) = (vec![[[0.0; B]; B]; pattern.columns()], vec![[[0.0; B]; B]; pattern.len()]);
        Self { pattern, entries, changed, diagonal, below }
    }

    /// Numbers of the factor.
    pub fn len(&self) -> usize {
        (self.diagonal.len() + self.below.len()) * B * B
    }

    /// Factors a matrix with more on its diagonal. False if that is not positive definite to working precision.
    pub fn factor(&mut self, diagonal: &[Block<B>], below: &[Block<B>], more: f64) -> bool {
        self.diagonal.copy_from_slice(diagonal);
        self.diagonal.iter_mut().for_each(|block| (0..B).for_each(|k| block[k][k] += more));
        self.below.fill([[0.0; B]; B]);
        self.entries.iter().zip(below).for_each(|(&entry, block)| self.below[entry as usize] = *block);
        let mut changed = &self.changed[..];
        for column in 0..self.diagonal.len() {
            let Some(own) = triangle(&self.diagonal[column]) else { return false };
            self.diagonal[column] = own;
            let (done, later) = self.below.split_at_mut(self.pattern.start(column + 1));
            let start = self.pattern.start(column);
            let blocks = &mut done[start..];
            blocks.iter_mut().for_each(|block| divide(block, &own));
            for (k, &row) in self.pattern.rows(column).iter().enumerate() {
                let factor = &blocks[k];
                minus_square(&mut self.diagonal[row as usize], factor);
                let (here, rest) = changed.split_at(blocks.len() - k - 1);
                for (block, &place) in blocks[k + 1..].iter().zip(here) {
                    minus_product(&mut later[place as usize - start - blocks.len()], block, factor);
                }
                changed = rest;
            }
        }
        true
    }

    /// Solves with the factor, in place.
    pub fn solve(&self, x: &mut [[f64; B]]) {
        for (column, own) in self.diagonal.iter().enumerate() {
            let mut value = x[column];
            for k in 0..B {
                value[k] *= own[k][k];
                (k + 1..B).for_each(|row| value[row] -= own[k][row] * value[k]);
            }
            x[column] = value;
            for (&row, block) in self.pattern.rows(column).iter().zip(&self.below[self.pattern.range(column)]) {
                let x = &mut x[row as usize];
                (0..B).for_each(|k| (0..B).for_each(|row| x[row] -= block[k][row] * value[k]));
            }
        }
        for (column, own) in self.diagonal.iter().enumerate().rev() {
            let mut value = x[column];
            for (&row, block) in self.pattern.rows(column).iter().zip(&self.below[self.pattern.range(column)]) {
                let x = &x[row as usize];
                (0..B).for_each(|k| value[k] -= (0..B).map(|row| block[k][row] * x[row]).sum::<f64>());
            }
            for k in (0..B).rev() {
                value[k] -= (k + 1..B).map(|row| own[k][row] * value[row]).sum::<f64>();
                value[k] *= own[k][k];
            }
            x[column] = value;
        }
    }
}

/// Where some rows are among others, all ascending, counted from a start.
fn places<'a>(rows: &'a [u32], among: &'a [u32], start: usize) -> impl Iterator<Item = u32> + 'a {
    let mut at = 0;
    rows.iter().map(move |row| {
        while among[at] != *row {
            at += 1;
        }
        (start + at) as u32
    })
}

/// The lower triangle of a block's own factor, with the reciprocals of its diagonal. None if it is not positive definite.
fn triangle<const B: usize>(block: &Block<B>) -> Option<Block<B>> {
    let mut l = *block;
    for k in 0..B {
        if l[k][k].is_nan() || l[k][k] <= 0.0 {
            return None;
        }
        let inverse = l[k][k].sqrt().recip();
        l[k][k] = inverse;
        (k + 1..B).for_each(|row| l[k][row] *= inverse);
        for column in k + 1..B {
            let factor = l[k][column];
            (column..B).for_each(|row| l[column][row] -= l[k][row] * factor);
        }
    }
    Some(l)
}

/// A block times the inverse of the transposed triangle.
fn divide<const B: usize>(block: &mut Block<B>, triangle: &Block<B>) {
    for column in 0..B {
        for k in 0..column {
            let (factor, earlier) = (triangle[k][column], block[k]);
            (0..B).for_each(|row| block[column][row] -= earlier[row] * factor);
        }
        block[column].iter_mut().for_each(|x| *x *= triangle[column][column]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::supernodes::Supernodes;
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    const B: usize = 3;

    /// A pattern of random blocks, and a matrix with it whose diagonal outweighs the rest.
    fn random(seed: u64, columns: usize) -> (Pattern, Vec<Block<B>>, Vec<Block<B>>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut pattern = Pattern::default();
        for column in 0..columns {
            let rows: Vec<u32> =
                (column + 1..columns).filter(|_| random.random_bool(0.2)).map(|row| row as u32).collect();
            pattern.push(&rows);
        }
        let mut block = |weight: f64| {
            let mut block = [[0.0; B]; B];
            block.iter_mut().flatten().for_each(|x| *x = random.random_range(-1.0..1.0));
            (0..B)
                .for_each(|k| (0..k).for_each(|i| block[k][i] = if weight > 0.0 { block[i][k] } else { block[k][i] }));
            (0..B).for_each(|k| block[k][k] += weight);
            block
        };
        let diagonal = (0..columns).map(|_| block(3.0 * columns as f64)).collect();
        let below = (0..pattern.len()).map(|_| block(0.0)).collect();
        (pattern, diagonal, below)
    }

    fn times(pattern: &Pattern, diagonal: &[Block<B>], below: &[Block<B>], x: &[[f64; B]]) -> Vec<[f64; B]> {
        let mut product = vec![[0.0; B]; x.len()];
        for column in 0..x.len() {
            for (k, row) in (0..B).flat_map(|k| (0..B).map(move |row| (k, row))) {
                product[column][row] += diagonal[column][k][row] * x[column][k];
                for (&later, block) in pattern.rows(column).iter().zip(&below[pattern.range(column)]) {
                    product[later as usize][row] += block[k][row] * x[column][k];
                    product[column][k] += block[k][row] * x[later as usize][row];
                }
            }
        }
        product
    }

    #[test]
    fn both_factors_solve_random_systems() {
        for seed in 0..20 {
            let (pattern, mut diagonal, below) = random(seed, 1 + 2 * seed as usize);
            let x: Vec<[f64; B]> = (0..diagonal.len()).map(|k| [1.0, k as f64, -2.0]).collect();
            let right = times(&pattern, &diagonal, &below, &x);
            let mut blocks = BlockCholesky::new(&pattern, BlockCholesky::<B>::pattern_of(&pattern));
            let mut supernodes = Supernodes::new(pattern).unwrap();
            diagonal.iter_mut().for_each(|block| (0..B).for_each(|k| block[k][k] -= 0.5));
            let mut solutions = [right.clone(), right];
            assert!(blocks.factor(&diagonal, &below, 0.5) && supernodes.factor(&diagonal, &below, 0.5));
            blocks.solve(&mut solutions[0]);
            supernodes.solve(&mut solutions[1]);
            for solution in solutions {
                let error = solution.iter().flatten().zip(x.iter().flatten()).map(|(a, b)| (a - b).abs());
                assert!(error.fold(0.0, f64::max) < 1e-12, "seed {seed}");
            }
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factor() {
        let (pattern, mut diagonal, below) = random(1, 9);
        diagonal[7][2][2] = -1.0;
        let mut blocks = BlockCholesky::new(&pattern, BlockCholesky::<B>::pattern_of(&pattern));
        assert!(!blocks.factor(&diagonal, &below, 0.0));
        assert!(!Supernodes::new(pattern).unwrap().factor(&diagonal, &below, 0.0));
    }
}
