//! The answer, each end with what proves it.

use crate::{
    contact::Contact,
    formulate::{Acceleration, Assembly, BlockSet, Components, ContactForce, FrictionCone, Push},
    proof::{closing, imbalance},
};
use drystone_lcp::{Counts, Status};

/// In which interval a structure can stand.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Solved; no solution if it can stand for no factor: both ends are then no numbers, and the motion of the upper one is how it falls
    /// whatever the factor; otherwise how the solver stopped without an answer.
    pub status: Status,
    /// The least factor.
    pub lower: End,
    /// The greatest factor.
    pub upper: End,
    /// Pivots.
    pub counts: Counts,
    /// Matrices factored by the interior-point method.
    pub iterations: usize,
}

/// An end of the interval.
#[derive(Debug, Clone)]
pub struct End {
    /// The factor t; infinite if nothing limits it.
    pub factor: f64,
    /// Velocity of every block that moves in the collapse, by its body, the largest of their speeds at 1 m/s. None if nothing limits it.
    pub motion: Vec<(usize, Acceleration)>,
    /// Forces that hold the structure there.
    pub forces: Vec<(Contact, ContactForce)>,
    /// Largest imbalance that they leave of a block, as a share of its own load or of the largest force on it.
    pub imbalance: f64,
    /// How fast a contact closes in the motion, of the fastest point.
    pub closing: f64,
    /// The factor that the motion proves to be the most (the least for the lower end) where no contact closes.
    pub bound: f64,
}

/// A block slower than this share of the fastest is at rest in a motion: rounding of the multipliers.
const AT_REST_BESIDE: f64 = 1e-9;

impl End {
    /// Without a limit.
    pub fn unlimited(sign: f64) -> Self {
        Self { factor: sign * f64::INFINITY, bound: sign * f64::INFINITY, ..Self::unknown() }
    }

    /// Without an answer.
    pub fn unknown() -> Self {
        let (motion, forces) = (Vec::new(), Vec::new());
        Self { factor: f64::NAN, motion, forces, imbalance: 0.0, closing: 0.0, bound: f64::NAN }
    }

    /// An end at a factor, with forces and a motion whose residuals are computed anew. `push` is the structure's, whichever end.
    pub fn new(
        assembly: &Assembly,
        blocks: &BlockSet,
        push: &Push,
        cone: FrictionCone,
        factor: f64,
        motion: Vec<(usize, Components)>,
        forces: Vec<ContactForce>,
    ) -> Self {
        let pushed = assembly.pushed(push, factor);
        let imbalance = imbalance(&pushed, blocks, &forces);
        let closing = closing(assembly, &motion, &forces, cone);
        let power = |of: &dyn Fn(usize) -> Vec<f64>| -> f64 {
            let each = motion.iter().map(|(block, velocity)| {
                let loads = of(*block);
                assembly.components().iter().zip(loads).map(|(&k, load)| velocity[k] * load).sum::<f64>()
            });
            each.sum()
        };
        let size = assembly.components().len();
        let by_loads = power(&|block| assembly.applied(block).to_vec());
        let by_push = power(&|block| push.on(block, size).to_vec());
        let fastest = motion.iter().map(|(block, v)| assembly.speed(*block, v)).fold(0.0, f64::max);
        let moves = |(block, v): &&(usize, Components)| assembly.speed(*block, v) > AT_REST_BESIDE * fastest;
        let shown = |(block, v): &(usize, Components)| {
            (assembly.body_index(*block), assembly.in_world(*block, v.map(|x| x / fastest)))
        };
        Self {
            factor,
            motion: motion.iter().filter(moves).map(shown).collect(),
            forces: forces.into_iter().map(|f| (assembly.contacts()[f.contact].clone(), f)).collect(),
            imbalance,
            closing,
            bound: -by_loads / by_push,
        }
    }
}
