//! Cholesky's method by supernodes, with faer's kernels: where columns of the factor are many and alike.

use super::blocks::{Block, Pattern};
use faer::{
    Conj, MatMut, Par, Side,
    dyn_stack::{MemBuffer, MemStack, StackReq},
    sparse::{
        SparseColMatRef, SymbolicSparseColMatRef,
        linalg::{
            SupernodalThreshold,
            cholesky::{
                CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
            },
        },
    },
};

/// The matrix by its lower triangle, and its factor.
pub(super) struct Supernodes<const B: usize> {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    /// Columns of blocks.
    pattern: Pattern,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl<const B: usize> Supernodes<B> {
    /// For a matrix of this pattern. None if there is no memory.
    pub fn new(pattern: Pattern) -> Option<Self> {
        let n = pattern.columns() * B;
        let (starts, rows) = lower::<B>(&pattern);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let (starts_above, above) = upper::<B>(&pattern);
        let upper = SymbolicSparseColMatRef::new_checked(n, n, &starts_above, None, &above);
        let symbolic = factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, parameters).ok()?;
        let scratch = StackReq::or(
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        );
        let memory = MemBuffer::try_new(scratch).ok()?;
        let (values, factor) = (vec![0.0; rows.len()], vec![0.0; symbolic.len_val()]);
        Some(Self { starts, rows, values, pattern, symbolic, factor, memory })
    }

    /// Numbers of the factor.
    pub fn len(&self) -> usize {
        self.factor.len()
    }

    /// Factors a matrix with more on its diagonal. False if that is not positive definite to working precision.
    pub fn factor(&mut self, diagonal: &[Block<B>], below: &[Block<B>], more: f64) -> bool {
        let mut values = self.values.iter_mut();
        for (column, own) in diagonal.iter().enumerate() {
            for k in 0..B {
                let blocks = below[self.pattern.range(column)].iter().flat_map(|block| &block[k]);
                values.by_ref().zip(own[k][k..].iter().chain(blocks)).for_each(|(value, x)| *value = *x);
            }
        }
        self.starts.iter().take(diagonal.len() * B).for_each(|&start| self.values[start] += more);
        let n = diagonal.len() * B;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.starts, None, &self.rows);
        let matrix = SparseColMatRef::new(pattern, &self.values);
        let stack = MemStack::new(&mut self.memory);
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            Default::default(),
            Par::Seq,
            stack,
            Default::default(),
        );
        done.is_ok()
    }

    /// Solves with the factor, in place.
    pub fn solve(&mut self, x: &mut [[f64; B]]) {
        let factor = LltRef::new(&self.symbolic, &self.factor);
        let x = x.as_flattened_mut();
        let (n, stack) = (x.len(), MemStack::new(&mut self.memory));
        let right = MatMut::from_column_major_slice_mut(x, n, 1);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
    }
}

/// The lower triangle, number by number: where its columns start, and their rows.
fn lower<const B: usize>(pattern: &Pattern) -> (Vec<usize>, Vec<usize>) {
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for column in 0..pattern.columns() {
        for k in 0..B {
            rows.extend(column * B + k..(column + 1) * B);
            rows.extend(pattern.rows(column).iter().flat_map(|&row| row as usize * B..(row as usize + 1) * B));
            starts.push(rows.len());
        }
    }
    (starts, rows)
}

/// The same of the upper one.
fn upper<const B: usize>(pattern: &Pattern) -> (Vec<usize>, Vec<usize>) {
    let mut above = vec![Vec::new(); pattern.columns()];
    for column in 0..pattern.columns() {
        pattern.rows(column).iter().for_each(|&row| above[row as usize].push(column));
    }
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for (column, above) in above.iter().enumerate() {
        for k in 0..B {
            rows.extend(above.iter().flat_map(|above| above * B..(above + 1) * B));
            rows.extend(column * B..=column * B + k);
            starts.push(rows.len());
        }
    }
    (starts, rows)
}
