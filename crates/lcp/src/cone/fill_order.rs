//! In which order to put many columns into a basis at once, so that its factor stays sparse.

use super::columns::Columns;
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::colamd},
};

/// Approximate minimum degree of columns: Davis, Gilbert, Larimore and Ng, A column approximate minimum degree ordering
/// algorithm (2004). The given order where faer declines (it does so only when it runs out of memory).
pub(super) fn fill_reducing(g: &Columns, columns: &[u32]) -> Vec<u32> {
    let (rows, indptr, indices) = pattern(g, columns);
    let n = columns.len();
    let a = SymbolicSparseColMatRef::new_checked(rows, n, &indptr, None, &indices);
    let (mut order, mut inverse) = (vec![0_usize; n], vec![0_usize; n]);
    let mut memory = MemBuffer::new(colamd::order_scratch::<usize>(rows, n, indices.len()));
    let ordered = colamd::order(&mut order, &mut inverse, a, colamd::Control::default(), MemStack::new(&mut memory));
    match ordered {
        Ok(()) => order.into_iter().map(|k| columns[k]).collect(),
        Err(_) => columns.to_vec(),
    }
}

/// The pattern of some columns on the rows that they touch: (number of rows, starts, row indices).
fn pattern(g: &Columns, columns: &[u32]) -> (usize, Vec<usize>, Vec<usize>) {
    let mut touched: Vec<u32> = columns.iter().flat_map(|&j| g.column(j)).map(|&(row, _)| row).collect();
    touched.sort_unstable();
    touched.dedup();
    let (mut indptr, mut indices) = (vec![0], Vec::new());
    for &j in columns {
        let begin = indices.len();
        indices.extend(g.column(j).iter().map(|&(row, _)| touched.partition_point(|&other| other < row)));
        indices[begin..].sort_unstable();
        indptr.push(indices.len());
    }
    (touched.len(), indptr, indices)
}
