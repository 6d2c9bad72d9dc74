//! Symbolic analysis of the complete matrix, done once: order, elimination tree and the static pattern of `L`.
//!
//! Every active set is a mask of this pattern. Liu, The role of elimination trees in sparse factorization (1990).

use crate::{
    interrupt::{apart, poll},
    matrix::SparseColumns,
};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// Where the entries of `L` (strictly below the diagonal) can be, in the permuted order.
#[derive(Debug, Clone)]
pub(super) struct Symbolic {
    /// Position in the elimination order of every matrix row.
    pub position: Vec<usize>,
    /// Matrix row at every position.
    pub row_at: Vec<usize>,
    /// Column j of `L`: rows `rows[starts[j]..starts[j + 1]]`, ascending.
    pub starts: Vec<usize>,
    pub rows: Vec<u32>,
    /// Row k of `L`: `(column, place of the entry in rows)`, columns ascending.
    row_starts: Vec<usize>,
    row_entries: Vec<(u32, u32)>,
}

const ROOT: usize = usize::MAX;

impl Symbolic {
    pub fn new(m: &SparseColumns) -> Self {
        let row_at = fill_reducing_order(m);
        let n = m.len();
        let mut position = vec![0; n];
        for (k, &i) in row_at.iter().enumerate() {
            position[i] = k;
        }
        let row_patterns = row_patterns(m, &row_at, &position);
        let mut starts = vec![0; n + 1];
        for &j in row_patterns.iter().flatten() {
            starts[j as usize + 1] += 1;
        }
        for j in 0..n {
            starts[j + 1] += starts[j];
        }
        let mut next = starts.clone();
        let mut rows = vec![0; starts[n]];
        let (mut row_starts, mut row_entries) = (vec![0], Vec::with_capacity(starts[n]));
        for (k, pattern) in row_patterns.iter().enumerate() {
            poll(8 * pattern.len());
            for &j in pattern {
                let place = next[j as usize];
                next[j as usize] += 1;
                rows[place] = k as u32;
                row_entries.push((j, place as u32));
            }
            row_starts.push(row_entries.len());
        }
        Self { position, row_at, starts, rows, row_starts, row_entries }
    }

    pub fn len(&self) -> usize {
        self.row_at.len()
    }

    pub fn column(&self, j: usize) -> std::ops::Range<usize> {
        self.starts[j]..self.starts[j + 1]
    }

    pub fn row(&self, k: usize) -> &[(u32, u32)] {
        &self.row_entries[self.row_starts[k]..self.row_starts[k + 1]]
    }

    /// Parent of column j in the elimination tree: the first row of the column.
    pub fn parent(&self, j: usize) -> Option<usize> {
        let column = self.column(j);
        (!column.is_empty()).then(|| self.rows[column.start] as usize)
    }
}

/// Operations of the ordering for each entry of the matrix: much fewer mostly, but where it fills up.
const ORDERING: usize = 1024;

/// Approximate minimum degree; the given order where faer declines (it does so only when it runs out of memory).
fn fill_reducing_order(m: &SparseColumns) -> Vec<usize> {
    let (n, indptr, indices) = (m.len(), m.indptr().to_vec(), m.indices().to_vec());
    let order = apart(ORDERING * indices.len(), move || {
        let (mut order, mut inverse) = (vec![0usize; n], vec![0usize; n]);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &indptr, None, &indices);
        let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(n, indices.len())).ok()?;
        let control = amd::Control::default();
        amd::order(&mut order, &mut inverse, pattern, control, MemStack::new(&mut memory)).ok()?;
        Some(order)
    });
    order.unwrap_or_else(|| (0..n).collect())
}

/// The columns of every row of `L`, ascending: row k reaches from the entries of `M` left of its diagonal
/// up the elimination tree, which is built on the way.
fn row_patterns(m: &SparseColumns, row_at: &[usize], position: &[usize]) -> Vec<Vec<u32>> {
    let n = m.len();
    let (mut parent, mut mark) = (vec![ROOT; n], vec![ROOT; n]);
    let mut patterns = Vec::with_capacity(n);
    for k in 0..n {
        mark[k] = k;
        let mut pattern = Vec::new();
        for &i in m.column(row_at[k]).0 {
            let mut j = position[i];
            while j < k && mark[j] != k {
                mark[j] = k;
                pattern.push(j as u32);
                if parent[j] == ROOT {
                    parent[j] = k;
                }
                j = parent[j];
            }
        }
        pattern.sort_unstable();
        poll(8 * pattern.len());
        patterns.push(pattern);
    }
    patterns
}
