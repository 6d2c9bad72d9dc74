//! `I + J' D J`: one block for each body and one for each pair that touches; factored by Cholesky's method.
//!
//! The order is found once, on the graph of the bodies (approximate minimum degree, by faer; Amestoy, Davis and Duff 1996), and with
//! it where the factor has entries.

use super::{
    block_cholesky::BlockCholesky,
    blocks::{Block, Pattern},
    scaled::{Scaled, ScaledPoint, joints},
    supernodes::Supernodes,
};
use crate::interrupt::{apart, poll};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// The matrix by its lower triangle, and its factor.
pub(super) struct BodyMatrix<const B: usize> {
    /// Place of each body in the order of elimination.
    place: Vec<usize>,
    diagonal: Vec<Block<B>>,
    below: Vec<Block<B>>,
    /// For each joint, and each pair of its bodies, the block between the two.
    between: Vec<usize>,
    factor: Factor<B>,
    right: Vec<[f64; B]>,
}

enum Factor<const B: usize> {
    Blocks(BlockCholesky<B>),
    Supernodes(Box<Supernodes<B>>),
}

/// Products of blocks for each block of the factor, times the rows of a block, above which supernodes take less time. Measured:
/// with 20 products of 3 rows (a wall of 60 x 60) both take as long, with 11 of 6 rows supernodes take a fifth less, with 6
/// a fifth more.
const SUPERNODAL: usize = 60;

impl<const B: usize> Factor<B> {
    /// For a matrix of this pattern. None if there is no memory.
    fn of(matrix: Pattern) -> Option<Self> {
        let pattern = BlockCholesky::<B>::pattern_of(&matrix);
        if pattern.products() * B <= SUPERNODAL * (pattern.len() + pattern.columns()) {
            return Some(Self::Blocks(BlockCholesky::new(&matrix, pattern)));
        }
        Supernodes::new(matrix).map(|factor| Self::Supernodes(Box::new(factor)))
    }

    fn len(&self) -> usize {
        match self {
            Self::Blocks(factor) => factor.len(),
            Self::Supernodes(factor) => factor.len(),
        }
    }
}

impl<const B: usize> BodyMatrix<B> {
    /// Analyses the pattern. None if there is no memory for it.
    pub fn new<const D: usize, const N: usize>(problem: &Scaled<B, D, N>) -> Option<Self> {
        Self::between(problem.load.len(), &problem.points)
    }

    /// The same for points between so many bodies.
    pub fn between<const D: usize, const N: usize>(bodies: usize, points: &[ScaledPoint<B, D, N>]) -> Option<Self> {
        let place = order(bodies, points)?;
        let mut below: Vec<Vec<u32>> = vec![Vec::new(); bodies];
        for joint in joints(points) {
            for (earlier, later) in pairs(&joint[0], &place).flatten() {
                below[earlier].push(later as u32);
            }
        }
        let mut pattern = Pattern::default();
        for below in &mut below {
            below.sort_unstable();
            below.dedup();
            pattern.push(below);
        }
        let found = joints(points).flat_map(|joint| pairs(&joint[0], &place));
        let between = found.map(|pair| {
            let (earlier, later) = pair?;
            let among = pattern.rows(earlier).binary_search(&(later as u32)).ok()?;
            Some(pattern.start(earlier) + among)
        });
        let between = between.map(Option::unwrap_or_default).collect();
        let (diagonal, below) = (vec![[[0.0; B]; B]; bodies], vec![[[0.0; B]; B]; pattern.len()]);
        let factor = Factor::of(pattern)?;
        Some(Self { place, diagonal, below, between, factor, right: vec![[0.0; B]; bodies] })
    }

    /// Makes it `J' N J`, with N the weight of each point, and more on the diagonal: the same number for all unknowns of a body.
    pub fn assemble<const D: usize, const N: usize>(
        &mut self,
        points: &[ScaledPoint<B, D, N>],
        diagonal: impl Fn(usize) -> f64,
        mut weight: impl FnMut(&ScaledPoint<B, D, N>) -> [[f64; D]; D],
    ) {
        self.below.fill([[0.0; B]; B]);
        for (body, &place) in self.place.iter().enumerate() {
            let mut own = [[0.0; B]; B];
            (0..B).for_each(|k| own[k][k] = diagonal(body));
            self.diagonal[place] = own;
        }
        for (joint, between) in joints(points).zip(self.between.chunks_exact(two_of(N).count())) {
            let sums = Sums::of(joint, &self.place, &mut weight);
            for (side, own) in sums.own.iter().enumerate() {
                if let Some(body) = joint[0].body(side) {
                    add(&mut self.diagonal[self.place[body]], own);
                }
            }
            for ((pair, mixed), &place) in pairs(&joint[0], &self.place).zip(&sums.mixed).zip(between) {
                if pair.is_some() {
                    add(&mut self.below[place], mixed);
                }
            }
        }
    }

    /// Factors it, with more on the diagonal if it is not positive definite to working precision; says how much more. None if
    /// there is no factor all the same.
    pub fn factor(&mut self) -> Option<f64> {
        let on_diagonal = self.diagonal.iter().flat_map(|block| (0..B).map(|k| block[k][k]));
        let largest = on_diagonal.fold(0.0, f64::max);
        [0.0, 1e-15, 1e-13, 1e-11].into_iter().map(|share| share * largest).find(|&more| self.try_to_factor(more))
    }

    fn try_to_factor(&mut self, more: f64) -> bool {
        poll(8 * self.factor.len());
        match &mut self.factor {
            Factor::Blocks(factor) => factor.factor(&self.diagonal, &self.below, more),
            Factor::Supernodes(factor) => factor.factor(&self.diagonal, &self.below, more),
        }
    }

    /// Solves with it, in place.
    pub fn solve(&mut self, x: &mut [[f64; B]]) {
        for (x, &place) in x.iter().zip(&self.place) {
            self.right[place] = *x;
        }
        poll(2 * self.factor.len());
        match &mut self.factor {
            Factor::Blocks(factor) => factor.solve(&mut self.right),
            Factor::Supernodes(factor) => factor.solve(&mut self.right),
        }
        for (x, &place) in x.iter_mut().zip(&self.place) {
            *x = self.right[place];
        }
    }
}

/// What the points of a joint add.
struct Sums<const B: usize, const N: usize> {
    /// For each body.
    own: [Block<B>; N],
    /// For each pair of bodies: as many as bodies at most.
    mixed: [Block<B>; N],
}

impl<const B: usize, const N: usize> Sums<B, N> {
    fn of<const D: usize>(
        joint: &[ScaledPoint<B, D, N>],
        place: &[usize],
        weight: &mut impl FnMut(&ScaledPoint<B, D, N>) -> [[f64; D]; D],
    ) -> Self {
        let mut sums = Self { own: [[[0.0; B]; B]; N], mixed: [[[0.0; B]; B]; N] };
        let mut sides = [[0; 2]; N];
        for (sides, [one, other]) in sides.iter_mut().zip(two_of(N)) {
            let at = |side: usize| joint[0].body(side).map(|body| place[body]);
            *sides = if at(one) < at(other) { [one, other] } else { [other, one] };
        }
        for point in joint {
            let weight = weight(point);
            let weighted = point.jacobian.each_ref().map(|jacobian| weighted(jacobian, &weight));
            for (own, (jacobian, weighted)) in sums.own.iter_mut().zip(point.jacobian.iter().zip(&weighted)) {
                for (row, weighted) in jacobian.iter().zip(weighted) {
                    (0..B).for_each(|column| (column..B).for_each(|k| own[column][k] += row[k] * weighted[column]));
                }
            }
            for (block, [earlier, later]) in sums.mixed.iter_mut().zip(sides).take(two_of(N).count()) {
                for (row, weighted) in point.jacobian[later].iter().zip(&weighted[earlier]) {
                    (0..B).for_each(|column| (0..B).for_each(|k| block[column][k] += row[k] * weighted[column]));
                }
            }
        }
        sums
    }
}

fn add<const B: usize>(sum: &mut Block<B>, more: &Block<B>) {
    sum.iter_mut().flatten().zip(more.iter().flatten()).for_each(|(sum, more)| *sum += more);
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
fn order<const B: usize, const D: usize, const N: usize>(
    bodies: usize,
    points: &[ScaledPoint<B, D, N>],
) -> Option<Vec<usize>> {
    let mut pairs: Vec<(usize, usize)> = points
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
