//! A matrix of B x B blocks, one for each chunk and two for each pair of chunks that a contact joins; its factors L U.
//!
//! It is not symmetric, as friction is not, but its pattern is. The order of elimination is that of approximate minimum degree on the
//! graph of the chunks (Amestoy, Davis and Duff 1996; faer's); rows are exchanged within a chunk only.

use crate::wide::wide;
use drystone_lcp::interrupt::poll;
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// Products of blocks in one factor, about: half a gigabyte says where they go.
const MOST_TARGETS: usize = 1 << 27;
/// So few chunks are eliminated as they come: to find an order takes longer than their factor.
const FEW: usize = 4;
/// Share of a pivot block that an update must leave: of less all digits are lost.
const LOST: f64 = 1e-12;

type Block<const B: usize> = [[f64; B]; B];

/// The matrix, then its factors in place.
#[derive(Debug)]
pub(crate) struct BlockMatrix<const B: usize> {
    /// Place of each chunk in the order of elimination.
    place: Vec<u32>,
    /// For each place where its later neighbours are listed.
    starts: Vec<u32>,
    later: Vec<u32>,
    /// For each place where the targets of its pairs of later neighbours are listed.
    pair_starts: Vec<u32>,
    /// Of each pair a < b of a place's later neighbours: where the block between them is.
    targets: Vec<u32>,
    /// Inverse of the pivot after factoring.
    diagonal: Vec<Block<B>>,
    /// Blocks of `later`, below and above (this one: row of the place, column of the later one).
    lower: Vec<Block<B>>,
    upper: Vec<Block<B>>,
    right: Vec<[f64; B]>,
    /// The two vectors of [`Self::update`], zero between its calls.
    added: [Vec<[f64; B]>; 2],
}

impl<const B: usize> BlockMatrix<B> {
    /// Analyses the pattern: `pairs` of chunks, in either order, repeated or not. None if the factors would take too much memory.
    pub fn new(chunks: usize, pairs: &[(u32, u32)]) -> Option<Self> {
        let mut edges: Vec<(u32, u32)> = pairs.iter().flat_map(|&(a, b)| [(a, b), (b, a)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let place = order(chunks, &edges)?;
        let mut later: Vec<Vec<u32>> = vec![Vec::new(); chunks];
        for &(a, b) in &edges {
            let (a, b) = (place[a as usize], place[b as usize]);
            if a < b {
                later[a as usize].push(b);
            }
        }
        for j in 0..chunks {
            later[j].sort_unstable();
            later[j].dedup();
            if let Some((&parent, rest)) = later[j].split_first() {
                let rest = rest.to_vec();
                later[parent as usize].extend(rest);
            }
        }
        let mut starts = vec![0_u32];
        for list in &later {
            starts.push(starts[starts.len() - 1] + list.len() as u32);
        }
        let (mut targets, mut pair_starts) = (Vec::new(), vec![0_u32]);
        for list in &later {
            for (a, &first) in list.iter().enumerate() {
                if targets.len() > MOST_TARGETS {
                    return None;
                }
                for &second in &list[a + 1..] {
                    let found = later[first as usize].binary_search(&second).ok()?;
                    targets.push(starts[first as usize] + found as u32);
                }
            }
            pair_starts.push(u32::try_from(targets.len()).ok()?);
        }
        let blocks = starts[chunks] as usize;
        let later = later.concat();
        let zero = [[0.0; B]; B];
        let (lower, upper) = (vec![zero; blocks], vec![zero; blocks]);
        let (diagonal, right) = (vec![zero; chunks], vec![[0.0; B]; chunks]);
        let added = [right.clone(), right.clone()];
        Some(Self { place, starts, later, pair_starts, targets, diagonal, lower, upper, right, added })
    }

    /// Makes it the identity.
    pub fn reset(&mut self) {
        let mut one = [[0.0; B]; B];
        (0..B).for_each(|k| one[k][k] = 1.0);
        self.diagonal.fill(one);
        self.lower.fill([[0.0; B]; B]);
        self.upper.fill([[0.0; B]; B]);
    }

    /// Where the block between two chunks is; whether the first one's row is in the upper part.
    pub fn between(&self, a: u32, b: u32) -> Option<(u32, bool)> {
        let (a, b) = (self.place[a as usize], self.place[b as usize]);
        let (first, second) = (a.min(b), a.max(b));
        let range = self.starts[first as usize] as usize..self.starts[first as usize + 1] as usize;
        let found = self.later[range].binary_search(&second).ok()?;
        Some((self.starts[first as usize] + found as u32, a < b))
    }

    /// The block of a chunk.
    pub fn own(&mut self, chunk: u32) -> &mut Block<B> {
        &mut self.diagonal[self.place[chunk as usize] as usize]
    }

    /// A block found by [`Self::between`].
    pub fn block(&mut self, place: u32, upper: bool) -> &mut Block<B> {
        if upper { &mut self.upper[place as usize] } else { &mut self.lower[place as usize] }
    }

    /// Replaces it by its factors, `L U` with the inverses of U's pivot blocks in place of them. False if a pivot block has no inverse.
    pub fn factor(&mut self) -> bool {
        wide(
            #[inline(always)]
            || self.eliminate(),
        )
    }

    #[inline(always)]
    fn eliminate(&mut self) -> bool {
        for j in 0..self.diagonal.len() {
            let Some(inverse) = inverse(&self.diagonal[j]) else { return false };
            poll(2 * B * B * B * (self.pair_starts[j + 1] - self.pair_starts[j]) as usize);
            self.diagonal[j] = inverse;
            let range = self.starts[j] as usize..self.starts[j + 1] as usize;
            for at in range.clone() {
                self.lower[at] = product(&self.lower[at], &inverse);
            }
            let mut pair = self.pair_starts[j] as usize;
            // Blocks between later places lie behind those of this one.
            let (below, lower) = self.lower.split_at_mut(range.end);
            let (beside, upper) = self.upper.split_at_mut(range.end);
            for a in range.clone() {
                subtract(&mut self.diagonal[self.later[a] as usize], &below[a], &beside[a]);
                for b in a + 1..range.end {
                    let target = self.targets[pair] as usize - range.end;
                    pair += 1;
                    subtract(&mut lower[target], &below[b], &beside[a]);
                    subtract(&mut upper[target], &below[a], &beside[b]);
                }
            }
        }
        true
    }

    /// The factors of the matrix with `sigma x y'` added (Bennett, Triangular factors of modified matrices, 1965, by blocks). Each of the
    /// `sides` is a chunk and its entries of x and of y; blocks between all of them are in the pattern, so that the places that
    /// change are the chain of parents of the first. False if a pivot block loses its inverse: the factors are of no use then.
    pub fn update(&mut self, mut sigma: f64, sides: &[(u32, [f64; B], [f64; B])]) -> bool {
        let mut next = u32::MAX;
        for (chunk, x, y) in sides {
            let place = self.place[*chunk as usize];
            for (added, entries) in self.added.iter_mut().zip([x, y]) {
                added[place as usize].iter_mut().zip(entries).for_each(|(sum, entry)| *sum += entry);
            }
            next = next.min(place);
        }
        let mut regular = true;
        while next != u32::MAX {
            let j = next as usize;
            let [x, y] = [0, 1].map(|side| std::mem::replace(&mut self.added[side][j], [0.0; B]));
            let range = self.starts[j] as usize..self.starts[j + 1] as usize;
            next = self.later[range.clone()].first().copied().unwrap_or(u32::MAX);
            let (mut inverse_x, mut y_inverse) = ([0.0; B], [0.0; B]);
            for a in 0..B {
                for b in 0..B {
                    inverse_x[a] += self.diagonal[j][a][b] * x[b];
                    y_inverse[b] += y[a] * self.diagonal[j][a][b];
                }
            }
            let grown = 1.0 + sigma * y.iter().zip(&inverse_x).map(|(y, x)| y * x).sum::<f64>();
            regular &= grown.abs() > LOST && grown.is_finite();
            let less = sigma / grown;
            for a in 0..B {
                for b in 0..B {
                    self.diagonal[j][a][b] -= less * inverse_x[a] * y_inverse[b];
                }
            }
            for at in range {
                let i = self.later[at] as usize;
                let (lower, upper) = (&mut self.lower[at], &mut self.upper[at]);
                let (mut below, beside) = (self.added[0][i], self.added[1][i]);
                let mut next = beside;
                for a in 0..B {
                    for b in 0..B {
                        below[a] -= lower[a][b] * x[b];
                        next[b] -= upper[a][b] * y_inverse[a];
                    }
                }
                for a in 0..B {
                    for b in 0..B {
                        lower[a][b] += less * below[a] * y_inverse[b];
                        upper[a][b] += sigma * x[a] * beside[b];
                    }
                }
                (self.added[0][i], self.added[1][i]) = (below, next);
            }
            sigma = less;
        }
        regular
    }

    /// Solves with the factors, in place.
    pub fn solve(&mut self, x: &mut [[f64; B]]) {
        wide(
            #[inline(always)]
            || self.substitute(x),
        );
    }

    #[inline(always)]
    fn substitute(&mut self, x: &mut [[f64; B]]) {
        for (x, &place) in x.iter().zip(&self.place) {
            self.right[place as usize] = *x;
        }
        let count = self.diagonal.len();
        for j in 0..count {
            let from = self.right[j];
            for at in self.starts[j] as usize..self.starts[j + 1] as usize {
                subtract_times(&mut self.right[self.later[at] as usize], &self.lower[at], &from);
            }
        }
        for j in (0..count).rev() {
            let mut left = self.right[j];
            for at in self.starts[j] as usize..self.starts[j + 1] as usize {
                subtract_times(&mut left, &self.upper[at], &self.right[self.later[at] as usize]);
            }
            let mut solved = [0.0; B];
            subtract_times(&mut solved, &self.diagonal[j], &left);
            self.right[j] = solved.map(|x| -x);
        }
        for (x, &place) in x.iter_mut().zip(&self.place) {
            *x = self.right[place as usize];
        }
    }
}

#[inline(always)]
fn product<const B: usize>(a: &Block<B>, b: &Block<B>) -> Block<B> {
    let mut c = [[0.0; B]; B];
    for i in 0..B {
        for k in 0..B {
            for j in 0..B {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    c
}

#[inline(always)]
fn subtract<const B: usize>(c: &mut Block<B>, a: &Block<B>, b: &Block<B>) {
    for i in 0..B {
        let mut row = c[i];
        for k in 0..B {
            for j in 0..B {
                row[j] -= a[i][k] * b[k][j];
            }
        }
        c[i] = row;
    }
}

#[inline(always)]
fn subtract_times<const B: usize>(y: &mut [f64; B], a: &Block<B>, x: &[f64; B]) {
    for i in 0..B {
        let mut sum = 0.0;
        for k in 0..B {
            sum += a[i][k] * x[k];
        }
        y[i] -= sum;
    }
}

/// Gauss and Jordan with exchanges of rows. None if a pivot is zero or no number.
#[inline(always)]
fn inverse<const B: usize>(a: &Block<B>) -> Option<Block<B>> {
    let mut left = *a;
    let mut right = [[0.0; B]; B];
    (0..B).for_each(|k| right[k][k] = 1.0);
    for k in 0..B {
        let mut best = k;
        for i in k + 1..B {
            if left[i][k].abs() > left[best][k].abs() {
                best = i;
            }
        }
        left.swap(k, best);
        right.swap(k, best);
        let pivot = left[k][k];
        if !(pivot.abs() > 0.0 && pivot.is_finite()) {
            return None;
        }
        let factor = 1.0 / pivot;
        for j in 0..B {
            left[k][j] *= factor;
            right[k][j] *= factor;
        }
        let (row, other) = (left[k], right[k]);
        for i in 0..B {
            if i == k {
                continue;
            }
            let factor = left[i][k];
            for j in 0..B {
                left[i][j] -= factor * row[j];
                right[i][j] -= factor * other[j];
            }
        }
    }
    Some(right)
}

/// Place of each chunk in the order of elimination. Of [`FEW`] any is as good.
fn order(chunks: usize, edges: &[(u32, u32)]) -> Option<Vec<u32>> {
    if chunks <= FEW {
        return Some((0..chunks as u32).collect());
    }
    let mut starts = vec![0_usize; chunks + 1];
    edges.iter().for_each(|(column, _)| starts[*column as usize + 1] += 1);
    (0..chunks).for_each(|chunk| starts[chunk + 1] += starts[chunk]);
    let rows: Vec<usize> = edges.iter().map(|(_, row)| *row as usize).collect();
    let (mut order, mut place) = (vec![0_usize; chunks], vec![0_usize; chunks]);
    let pattern = SymbolicSparseColMatRef::new_checked(chunks, chunks, &starts, None, &rows);
    let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(chunks, rows.len())).ok()?;
    let stack = MemStack::new(&mut memory);
    amd::order(&mut order, &mut place, pattern, amd::Control::default(), stack).ok()?;
    Some(place.into_iter().map(|place| place as u32).collect())
}

#[cfg(test)]
mod tests {
    use super::BlockMatrix;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Random patterns with random entries, against the product with the matrix itself.
    #[test]
    fn solving_undoes_multiplying() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        for chunks in [1_usize, 2, 5, 12, 30] {
            let pairs: Vec<(u32, u32)> = (0..2 * chunks)
                .map(|_| (random.random_range(0..chunks as u32), random.random_range(0..chunks as u32)))
                .filter(|(a, b)| a != b)
                .collect();
            let mut matrix = BlockMatrix::<3>::new(chunks, &pairs).unwrap();
            matrix.reset();
            let mut dense = vec![vec![0.0; 3 * chunks]; 3 * chunks];
            let mut put = |block: &mut [[f64; 3]; 3], a: u32, b: u32, random: &mut Pcg64Mcg, more: f64| {
                for i in 0..3 {
                    for j in 0..3 {
                        block[i][j] += random.random_range(-1.0..1.0) + if i == j { more } else { 0.0 };
                        dense[3 * a as usize + i][3 * b as usize + j] = block[i][j];
                    }
                }
            };
            for chunk in 0..chunks as u32 {
                put(matrix.own(chunk), chunk, chunk, &mut random, 8.0);
            }
            for &(a, b) in &pairs {
                let (place, upper) = matrix.between(a, b).unwrap();
                put(matrix.block(place, upper), a, b, &mut random, 0.0);
                put(matrix.block(place, !upper), b, a, &mut random, 0.0);
            }
            let x: Vec<f64> = (0..3 * chunks).map(|_| random.random_range(-1.0..1.0)).collect();
            let times = |row: &Vec<f64>| row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>();
            let right: Vec<f64> = dense.iter().map(times).collect();
            let mut solved: Vec<[f64; 3]> = right.chunks(3).map(|r| [r[0], r[1], r[2]]).collect();
            assert!(matrix.factor());
            matrix.solve(&mut solved);
            for (found, x) in solved.iter().flatten().zip(&x) {
                assert!((found - x).abs() < 1e-10, "{chunks} chunks: {found} {x}");
            }
        }
    }

    /// Contacts that begin to bear and let go again, far stiffer than the rest: the factors are those of the whole.
    #[test]
    fn factors_follow_changes_of_rank_one() {
        let mut random = Pcg64Mcg::seed_from_u64(9);
        let chunks = 30_u32;
        let pairs = (0..chunks - 1).flat_map(|a| [(a, a + 1), (a, (a * 7 + 3) % chunks)]);
        let pairs: Vec<(u32, u32)> = pairs.filter(|(a, b)| a != b).collect();
        let [mut matrix, mut anew] = [0, 1].map(|_| BlockMatrix::<3>::new(chunks as usize, &pairs).unwrap());
        matrix.reset();
        assert!(matrix.factor());
        type Side = (u32, [f64; 3], [f64; 3]);
        let mut borne: Vec<[Side; 2]> = Vec::new();
        let stiff = 1e3;
        for round in 0..60 {
            if round % 3 == 2 {
                let sides = borne.remove(random.random_range(0..borne.len()));
                assert!(matrix.update(-stiff, &sides));
            } else {
                let (a, b) = pairs[random.random_range(0..pairs.len())];
                let x = [0, 1].map(|_| [0, 1, 2].map(|_| random.random_range(-1.0..1.0)));
                let y = x.map(|x| x.map(|x: f64| x + random.random_range(-0.3..0.3)));
                borne.push([(a, x[0], y[0]), (b, x[1], y[1])]);
                assert!(matrix.update(stiff, &borne[borne.len() - 1]));
            }
            anew.reset();
            let add = |block: &mut [[f64; 3]; 3], x: &[f64; 3], y: &[f64; 3]| {
                (0..9).for_each(|k| block[k / 3][k % 3] += stiff * x[k / 3] * y[k % 3]);
            };
            for [(a, x, y), (b, v, w)] in &borne {
                add(anew.own(*a), x, y);
                add(anew.own(*b), v, w);
                let (place, upper) = anew.between(*a, *b).unwrap();
                add(anew.block(place, upper), x, w);
                add(anew.block(place, !upper), v, y);
            }
            assert!(anew.factor());
            let mut solved: Vec<[f64; 3]> =
                (0..chunks).map(|_| [0, 1, 2].map(|_| random.random_range(-1.0..1.0))).collect();
            let mut expected = solved.clone();
            matrix.solve(&mut solved);
            anew.solve(&mut expected);
            let largest = expected.iter().flatten().fold(1.0_f64, |largest, x| largest.max(x.abs()));
            for (found, x) in solved.iter().flatten().zip(expected.iter().flatten()) {
                assert!((found - x).abs() < 1e-9 * largest, "{round}: {found} {x}");
            }
        }
    }

    #[test]
    fn a_singular_block_is_told() {
        let mut matrix = BlockMatrix::<3>::new(1, &[]).unwrap();
        *matrix.own(0) = [[0.0; 3]; 3];
        assert!(!matrix.factor());
    }
}
