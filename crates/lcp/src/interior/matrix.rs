//! `I + J' D J`: one block for each body and one for each pair that touches; factored by Cholesky's method.
//!
//! The order is found once, on the graph of the bodies (approximate minimum degree; Amestoy, Davis and Duff 1996), and with it
//! where the factor has entries. Both come from faer, and so does the numerical factor, by supernodes.

use super::scaled::{Scaled, ScaledPoint};
use crate::interrupt::{apart, poll};
use faer::{
    Conj, MatMut, Par, Side,
    dyn_stack::{MemBuffer, MemStack, StackReq},
    sparse::{
        SparseColMatRef, SymbolicSparseColMatRef,
        linalg::{
            SupernodalThreshold, amd,
            cholesky::{
                CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
            },
        },
    },
};

/// Operations for each entry of the factor, in units of faer's own bound, above which its columns are taken together. Measured:
/// arches and random stacks are faster column by column; pyramids, walls and domes twice as fast together, from 0.3 on.
const SUPERNODAL: f64 = 0.3;

/// The matrix, by its upper triangle, and its factor.
pub(super) struct BodyMatrix<const B: usize> {
    /// Place of each body in the order of elimination.
    place: Vec<usize>,
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    /// For each point, and each pair of its bodies, where the block between the two lies, counted in blocks from the top of the
    /// later one's columns.
    between: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
    right: Vec<f64>,
}

impl<const B: usize> BodyMatrix<B> {
    /// Analyses the pattern. None if there is no memory for it.
    pub fn new<const D: usize, const N: usize>(problem: &Scaled<B, D, N>) -> Option<Self> {
        let (size, bodies) = (B, problem.load.len());
        let place = order(problem)?;
        let mut above: Vec<Vec<usize>> = vec![Vec::new(); bodies];
        for point in &problem.points {
            for (upper, lower) in pairs(point, &place).flatten() {
                above[lower].push(upper);
            }
        }
        above.iter_mut().for_each(|above| {
            above.sort_unstable();
            above.dedup();
        });
        let found = problem.points.iter().flat_map(|point| pairs(point, &place));
        let between = found.map(|pair| {
            let (upper, lower) = pair?;
            above[lower].binary_search(&upper).ok()
        });
        let between = between.map(Option::unwrap_or_default).collect();
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (body, above) in above.iter().enumerate() {
            for k in 0..size {
                rows.extend(above.iter().flat_map(|upper| upper * size..(upper + 1) * size));
                rows.extend(body * size..=body * size + k);
                starts.push(rows.len());
            }
        }
        let n = bodies * size;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let ordering = SymmetricOrdering::Identity;
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold(SUPERNODAL),
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, ordering, parameters).ok()?;
        let scratch = StackReq::or(
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        );
        let memory = MemBuffer::try_new(scratch).ok()?;
        let (values, factor) = (vec![0.0; rows.len()], vec![0.0; symbolic.len_val()]);
        Some(Self { place, starts, rows, values, between, symbolic, factor, memory, right: vec![0.0; n] })
    }

    /// Makes it diagonal, with the same number for all unknowns of a body.
    pub fn reset(&mut self, diagonal: impl Fn(usize) -> f64) {
        self.values.fill(0.0);
        for (body, place) in self.place.iter().enumerate() {
            let value = diagonal(body);
            self.starts[place * B + 1..][..B].iter().for_each(|&end| self.values[end - 1] = value);
        }
    }

    /// Adds `J' N J` of a point.
    pub fn add<const D: usize, const N: usize>(
        &mut self,
        index: usize,
        point: &ScaledPoint<B, D, N>,
        weight: &[[f64; D]; D],
    ) {
        let weighted = point.jacobian.each_ref().map(|jacobian| weighted(jacobian, weight));
        for (side, weighted) in weighted.iter().enumerate() {
            let Some(body) = point.body(side) else { continue };
            let first = self.place[body] * B;
            let block = block(&point.jacobian[side], weighted);
            for (column, entries) in block.iter().enumerate() {
                let end = self.starts[first + column + 1];
                let own = &mut self.values[end - 1 - column..end];
                own.iter_mut().zip(entries).for_each(|(value, entry)| *value += entry);
            }
        }
        let first_pair = index * two_of(N).count();
        for (pair, [one, other]) in two_of(N).enumerate() {
            let (Some(a), Some(b)) = (point.body(one), point.body(other)) else { continue };
            let (upper, lower) = if self.place[a] < self.place[b] { (one, other) } else { (other, one) };
            let first = self.place[a].max(self.place[b]) * B;
            let above = self.between[first_pair + pair] * B;
            let block = block(&point.jacobian[upper], &weighted[lower]);
            for (column, entries) in block.iter().enumerate() {
                let own = &mut self.values[self.starts[first + column] + above..][..B];
                own.iter_mut().zip(entries).for_each(|(value, entry)| *value += entry);
            }
        }
    }

    /// Factors it, with more on the diagonal if it is not positive definite to working precision; says how much more. None if
    /// there is no factor all the same.
    pub fn factor(&mut self) -> Option<f64> {
        let largest = self.starts[1..].iter().map(|&end| self.values[end - 1]).fold(0.0, f64::max);
        let mut more = 0.0;
        for share in [0.0, 1e-15, 1e-13, 1e-11] {
            let added = share * largest - more;
            self.starts[1..].iter().for_each(|&end| self.values[end - 1] += added);
            more += added;
            if self.try_to_factor() {
                return Some(more);
            }
        }
        None
    }

    fn try_to_factor(&mut self) -> bool {
        let n = self.right.len();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.starts, None, &self.rows);
        let matrix = SparseColMatRef::new(pattern, &self.values);
        let stack = MemStack::new(&mut self.memory);
        poll(8 * self.factor.len());
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Upper,
            Default::default(),
            Par::Seq,
            stack,
            Default::default(),
        );
        done.is_ok()
    }

    /// Solves with it, in place.
    pub fn solve(&mut self, x: &mut [[f64; B]]) {
        for (x, &place) in x.iter().zip(&self.place) {
            self.right[place * B..][..B].copy_from_slice(x);
        }
        poll(2 * self.factor.len());
        let factor = LltRef::new(&self.symbolic, &self.factor);
        let (n, stack) = (self.right.len(), MemStack::new(&mut self.memory));
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, 1);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
        for (x, &place) in x.iter_mut().zip(&self.place) {
            x.copy_from_slice(&self.right[place * B..][..B]);
        }
    }
}

fn weighted<const B: usize, const D: usize>(jacobian: &[[f64; B]; D], weight: &[[f64; D]; D]) -> [[f64; B]; D] {
    let mut product = [[0.0; B]; D];
    for i in 0..D {
        for k in 0..D {
            (0..B).for_each(|column| product[i][column] += weight[i][k] * jacobian[k][column]);
        }
    }
    product
}

/// `J'` times a product, by columns.
fn block<const B: usize, const D: usize>(jacobian: &[[f64; B]; D], product: &[[f64; B]; D]) -> [[f64; B]; B] {
    let mut block = [[0.0; B]; B];
    for k in 0..D {
        for column in 0..B {
            (0..B).for_each(|row| block[column][row] += jacobian[k][row] * product[k][column]);
        }
    }
    block
}

/// Pairs of so many sides.
fn two_of(sides: usize) -> impl Iterator<Item = [usize; 2]> {
    (1..sides).flat_map(|other| (0..other).map(move |one| [one, other]))
}

/// For each pair of bodies of a point their places, the earlier first; none where one does not move.
fn pairs<const B: usize, const D: usize, const N: usize>(
    point: &ScaledPoint<B, D, N>,
    place: &[usize],
) -> impl Iterator<Item = Option<(usize, usize)>> {
    two_of(N).map(|[one, other]| {
        let (a, b) = (place[point.body(one)?], place[point.body(other)?]);
        Some((a.min(b), a.max(b)))
    })
}

/// Operations of the ordering for each pair: much fewer mostly, but where it fills up.
const ORDERING: usize = 1024;

/// Place of each body in the order of elimination.
fn order<const B: usize, const D: usize, const N: usize>(problem: &Scaled<B, D, N>) -> Option<Vec<usize>> {
    let bodies = problem.load.len();
    let mut pairs: Vec<(usize, usize)> = problem
        .points
        .iter()
        .flat_map(|point| two_of(N).filter_map(|[one, other]| Some((point.body(one)?, point.body(other)?))))
        .flat_map(|(a, b)| [(a, b), (b, a)])
        .chain((0..bodies).map(|body| (body, body)))
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut starts = vec![0; bodies + 1];
    pairs.iter().for_each(|(column, _)| starts[column + 1] += 1);
    (0..bodies).for_each(|body| starts[body + 1] += starts[body]);
    let rows: Vec<usize> = pairs.into_iter().map(|(_, row)| row).collect();
    apart(ORDERING * rows.len(), move || {
        let (mut order, mut place) = (vec![0; bodies], vec![0; bodies]);
        let pattern = SymbolicSparseColMatRef::new_checked(bodies, bodies, &starts, None, &rows);
        let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(bodies, rows.len())).ok()?;
        let stack = MemStack::new(&mut memory);
        amd::order(&mut order, &mut place, pattern, amd::Control::default(), stack).ok()?;
        Some(place)
    })
}
