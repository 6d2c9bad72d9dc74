//! Whether blocks stand: the one place that says so, for every method.
//!
//! *Stands:* contact forces within the cones leave each block an imbalance of at most 1e-9 of the largest force on it and at
//! most 1e-6 of its own load. An acceleration alone does not tell: what rounding leaves of a load that passes *through*
//! a light block is large beside that block's own weight.
//!
//! *Falls:* a motion opens contacts or keeps them closed, `G' a >= 0` up to rounding, and the loads do work in it, `F' a`, by
//! more than ten times what rounding could make of the forces that are there.
//!
//! What a complementarity solver leaves in between is decided by an equilibrium (`drystone_lcp::cone`), which refines its
//! residuals to 32 digits where 16 do not tell. Where both of the above hold even then, or neither, it is borderline.

use crate::{
    equilibrium::equilibrium_of,
    formulate::{Assembly, BlockSet, Components, Moving},
};
use drystone_lcp::cone::{ConeSolver, Membership};

/// A block is at rest while its acceleration stays below this share of gravity; turning counts by the speed of the
/// block's corner furthest from its centre of mass. Rounding in a stack of some hundred blocks leaves 1e-12; a block that
/// overhangs an edge by a hundred-millionth of its width has about 1e-8. Where the largest force on the block is above its own
/// load, the same share of that force.
pub const AT_REST: f64 = 1e-9;

/// Most acceleration of a block at rest, as a share of gravity, whatever forces pass through it.
const OF_OWN_LOAD: f64 = 1e-6;

/// Accelerations below this share of gravity do not decide alone: the complementarity solver lets contacts open by
/// 1e-11 of its scale, and what is left of a motion whose power is that small has the square root of it.
const DOUBTFUL: f64 = 1e-4;

/// How fast a contact may close in a motion and count as at rest, relative to the fastest point: rounding of the forces, by
/// which accelerations are computed.
pub(crate) const CLOSING: f64 = 1e-9;

/// The same of accelerations that need prove nothing, since a certificate does: what the complementarity solver's tolerance leaves.
pub(crate) const CLOSING_AS_SOLVED: f64 = 1e-6;

/// The power of a motion must be above as many times its rounding bound.
pub(crate) const MARGIN: f64 = 10.0;

/// Rounding of a sum of some ten terms, relative to the largest.
pub(crate) const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// What is known of a sub-assembly.
#[derive(Debug)]
pub(crate) enum Judgement {
    /// The forces at hand hold it.
    Stands,
    /// The accelerations at hand prove that it falls.
    Falls,
    /// Neither; what an equilibrium says, and its solver.
    ByEquilibrium(Membership, Box<ConeSolver>),
}

impl Judgement {
    /// Without forces or accelerations at hand.
    pub fn by_equilibrium(assembly: &Assembly, blocks: &BlockSet) -> Self {
        let (found, solver) = equilibrium_of(assembly, blocks);
        Self::ByEquilibrium(found, Box::new(solver))
    }

    /// The same as a membership.
    pub fn found(&self) -> Membership {
        match self {
            Self::Stands => Membership::Inside,
            Self::Falls => Membership::Outside,
            Self::ByEquilibrium(found, _) => *found,
        }
    }
}

/// Accelerations of blocks.
pub(crate) type Motion = Vec<(usize, Components)>;

/// Judges by a solution of the complementarity problem ([`Assembly::moving`]).
pub(crate) fn judge(assembly: &Assembly, blocks: &BlockSet, under: &Moving) -> Judgement {
    let moving = moving_blocks(assembly, under);
    if moving.is_empty() {
        return Judgement::Stands;
    }
    let fastest = moving.iter().map(|(block, a)| severity(assembly, *block, a)).fold(0.0, f64::max);
    if fastest >= DOUBTFUL && proves_fall(assembly, blocks, under, CLOSING) {
        return Judgement::Falls;
    }
    Judgement::by_equilibrium(assembly, blocks)
}

/// The blocks that are not at rest, with their accelerations.
pub(crate) fn moving_blocks(assembly: &Assembly, under: &Moving) -> Motion {
    let moves = |(block, a): &&(usize, Components)| !at_rest(assembly, *block, a, |j| under.forces[j]);
    under.motion.iter().filter(moves).copied().collect()
}

/// Whether the imbalance of the forces on a block, which gives it this acceleration, is none.
fn at_rest(assembly: &Assembly, block: usize, acceleration: &Components, f: impl Fn(usize) -> f64) -> bool {
    let severity = severity(assembly, block, acceleration);
    let largest = || assembly.generators_on(block).iter().map(|&j| f(j)).fold(0.0, f64::max);
    severity <= AT_REST || at_rest_under(assembly, block, severity, largest())
}

/// Whether a block of such a [`severity`] is at rest where the largest force on it, N, is this.
pub(crate) fn at_rest_under(assembly: &Assembly, block: usize, severity: f64, largest: f64) -> bool {
    let in_own_weights = largest * assembly.inverse_mass(block)[0] / assembly.unit_of_acceleration(block);
    severity <= AT_REST || severity <= OF_OWN_LOAD && severity <= AT_REST * in_own_weights
}

/// Whether accelerations are a motion in which it falls; contacts may close by a share of the fastest.
pub(crate) fn proves_fall(
    assembly: &Assembly,
    blocks: &BlockSet,
    Moving { forces, motion: moving }: &Moving,
    closing_share: f64,
) -> bool {
    let components = assembly.components();
    let (mut power, mut bound, mut closing) = (0.0, 0.0, 0.0_f64);
    for (block, acceleration) in moving {
        for (&k, load) in components.iter().zip(assembly.applied(*block)) {
            power += load * acceleration[k];
            bound += ROUNDING * (load * acceleration[k]).abs();
        }
    }
    for j in assembly.rows(blocks) {
        let (opening, size) = assembly.opening(&assembly.generators()[j], moving);
        closing = closing.max(-opening);
        bound += ROUNDING * forces[j].max(0.0) * size;
    }
    closing <= closing_share * assembly.fastest(moving) && power > MARGIN * bound
}

/// Largest acceleration of a point of a block, as a share of what its own loads give it: of gravity where it has no others, of
/// 1 m/s^2 where it has none.
pub(crate) fn severity(assembly: &Assembly, block: usize, acceleration: &Components) -> f64 {
    assembly.speed(block, acceleration) / assembly.unit_of_acceleration(block)
}
