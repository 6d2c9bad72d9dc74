//! By the interior-point method: many blocks, or round cones.

use super::{
    ends::{End, Limit},
    walk,
};
use crate::{
    check::check_blocks_while,
    crossover::from_interior,
    formulate::{Assembly, BlockSet, Constrained, ContactForce, FrictionCone, Push},
    judgement::{CLOSING, MARGIN},
    proof::{moving, power_of_fall},
    threads::at_once,
};
use drystone_lcp::{Counts, Status};

/// How well an end has to be known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    /// The factors of the forces and of the motion may differ by this, beside one or themselves.
    apart: f64,
    /// What the forces may leave of a load: the factor is wrong by as much at most.
    imbalance: f64,
}

/// The method ends this much nearer than has to be proved.
const SHARE_SOUGHT: f64 = 0.1;

impl Known {
    /// Where the factor is the answer: to 1e-7 other programs agree with one another. On the border of round cones, where blocks
    /// slide, the imbalance was 1e-10 for 14 blocks and more than 1e-9 for a wall of 50; between edges 1e-14. The bound of the
    /// mechanism is apart.
    pub fn well() -> Self {
        Self { apart: 1e-8, imbalance: 1e-7 }
    }

    /// Where the answer may be off by a tolerance: a hundredth of it. Round cones that only just slide, all at once, leave some
    /// 1e-7 where the push is askew to a wall of bricks.
    pub fn within(tolerance: f64) -> Self {
        let Self { apart, imbalance } = Self::well();
        Self { apart: apart.max(0.01 * tolerance), imbalance: imbalance.max(0.01 * tolerance) }
    }

    /// Whether less is asked than can be known.
    pub fn is_loose(self) -> bool {
        self.apart > Self::well().apart
    }

    /// How far the factors of forces and motion may differ where the method ends; as little as it can where the factor is the answer.
    fn sought(self) -> f64 {
        if self.is_loose() { SHARE_SOUGHT * self.apart } else { 0.0 }
    }

    /// Whether the forces hold the structure up to a factor beyond which the motion proves that it falls.
    fn proves(self, end: &End) -> bool {
        let apart = (end.bound - end.factor).abs() <= self.apart * end.factor.abs().max(1.0);
        apart && end.imbalance <= self.imbalance && end.closing <= CLOSING
    }
}

pub(super) fn limit(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone, known: Known) -> Limit {
    let towards = |sign: f64| {
        let mut iterations = 0;
        (Side { assembly, blocks, push, cone, sign, known }.end(&mut iterations), iterations)
    };
    let signs = [1.0, -1.0];
    let large = blocks.len() >= WORTH_A_THREAD;
    let found = if large { at_once(signs, towards) } else { signs.map(towards).into() };
    let found: [_; 2] = found.try_into().expect("one for each sign");
    let mut iterations = found.iter().map(|(_, iterations)| iterations).sum();
    let mut ends = found.map(|(end, _)| end);
    if let [Ok(upper), Ok(lower)] = &ends {
        let (upper, lower) = (upper.clone(), lower.clone());
        return Limit { status: Status::Solved, lower, upper, counts: Counts::default(), iterations };
    }
    if ends.iter().all(Result::is_err)
        && let Some(never) = never(assembly, blocks, push, cone, &mut iterations)
    {
        return never;
    }
    for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
        if end.is_err() && bears(assembly, blocks, push, cone, sign) {
            *end = Ok(End::unlimited(sign));
        }
    }
    let status = if ends.iter().all(Result::is_ok) { Status::Solved } else { Status::NumericalTrouble };
    if status != Status::Solved && !assembly.is_round(cone) {
        // Pivots, however long they take, have more digits.
        let (found, mut solver) = from_interior(assembly, blocks);
        solver.limit_effort(usize::MAX);
        if let Some(walked) = walk::to_the_end(assembly, blocks, push, found, &solver) {
            return Limit { iterations, ..walked };
        }
    }
    let [upper, lower] = ends.map(|end| end.unwrap_or_else(|end| end));
    Limit { status, lower, upper, counts: Counts::default(), iterations }
}

/// Fewest blocks for which the two ends are found on a thread each: fewer take less than a millisecond.
const WORTH_A_THREAD: usize = 32;

/// The greatest factor, if forces and a motion prove it.
pub(super) fn greatest(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone) -> Option<f64> {
    let upper = Side { assembly, blocks, push, cone, sign: 1.0, known: Known::well() };
    upper.end(&mut 0).ok().map(|end| end.factor)
}

/// One of the two ends, and how well it has to be known.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub assembly: &'a Assembly,
    pub blocks: &'a BlockSet,
    pub push: &'a Push,
    pub cone: FrictionCone,
    /// 1 for the greatest factor, -1 for the least.
    pub sign: f64,
    pub known: Known,
}

impl Side<'_> {
    /// The end, or the one that was found though its residuals are too large.
    pub fn end(self, iterations: &mut usize) -> Result<End, End> {
        let sought = self.known.sought();
        if sought > 0.0
            && let Ok(end) = self.end_within(sought, iterations)
        {
            return Ok(end);
        }
        self.end_within(0.0, iterations)
    }

    fn end_within(self, sought: f64, iterations: &mut usize) -> Result<End, End> {
        let Self { assembly, blocks, push, cone, sign, known } = self;
        if push.is_none() {
            return Err(End::unlimited(sign));
        }
        let signed = if sign < 0.0 { push.reversed() } else { push.clone() };
        let space = assembly.body_space(blocks, cone).under(&signed);
        let Constrained { motion, forces, found } = space.greatest_within(sought);
        *iterations += found.iterations;
        let finite = found.factor.is_finite() && motion.iter().flat_map(|(_, v)| v).all(|v| v.is_finite());
        if !finite {
            return Err(End::unknown());
        }
        let at = |factor: f64, forces| End::new(assembly, blocks, push, cone, factor, motion.clone(), forces);
        let end = at(sign * found.factor, forces);
        if known.proves(&end) {
            return Ok(end);
        }
        if sought > 0.0 {
            return Err(end);
        }
        let held = self.held_before(&end).map(|(factor, forces)| at(factor, forces));
        held.filter(|held| known.proves(held)).ok_or(end)
    }

    /// Forces that hold it a little before the bound of its mechanism. Where round cones are met by many contacts at once, the forces at
    /// the end itself have some digits less than the mechanism; those before it are found from nothing.
    fn held_before(self, end: &End) -> Option<(f64, Vec<ContactForce>)> {
        if !(end.bound.is_finite() && end.closing <= CLOSING) {
            return None;
        }
        let factor = end.bound - 0.5 * self.sign * self.known.apart * end.bound.abs().max(1.0);
        let pushed = self.assembly.pushed(self.push, factor);
        let verdict = check_blocks_while(&pushed, self.blocks, self.cone, &mut |_| true).expect("nobody stops it");
        verdict.stable.then(|| (factor, verdict.forces.into_iter().map(|(_, force)| force).collect()))
    }
}

/// Whether contacts bear the push however large: blocks without weight stand under it.
fn bears(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone, sign: f64) -> bool {
    let alone = assembly.only(push, sign);
    check_blocks_while(&alone, blocks, cone, &mut |_| true).expect("nobody stops it").stable
}

/// How it falls whatever the factor, if it does: Gauss's principle with the factor free. A motion in which the push does no work,
/// and the loads do.
fn never(
    assembly: &Assembly,
    blocks: &BlockSet,
    push: &Push,
    cone: FrictionCone,
    iterations: &mut usize,
) -> Option<Limit> {
    let space = assembly.body_space(blocks, cone);
    let Constrained { motion, forces, found } = if push.is_none() { space.solve() } else { space.under(push).solve() };
    *iterations += found.iterations;
    let falling = moving(assembly, &motion, &forces);
    let falls = !falling.is_empty() && power_of_fall(assembly, &motion, &forces, cone) > MARGIN;
    falls.then(|| {
        let end = End::new(assembly, blocks, push, cone, f64::NAN, falling, Vec::new());
        let end = End { imbalance: f64::NAN, bound: f64::NAN, ..end };
        let counts = Counts::default();
        Limit { status: Status::NoSolution, lower: end.clone(), upper: end, counts, iterations: *iterations }
    })
}
