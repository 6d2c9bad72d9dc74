//! Another motion than rest that obeys every law, verified by what shares nothing with the search.

use super::{laws::Laws, program::Found};
use crate::{
    contact::Contact,
    formulate::{Acceleration, Assembly, BlockSet, Components, ContactForce},
    judgement::severity,
    proof::{law_error, unbalanced},
};

/// Error of a law, of the fastest acceleration, beyond which a motion is none: what the tolerances of a linear program leave.
const ERROR: f64 = 1e-7;

/// Acceleration of the fastest point, of what the block's own loads give it, from which on a motion is one.
const MOVES: f64 = 1e-6;

/// How blocks can leave rest.
#[derive(Debug, Clone)]
pub struct Escape {
    /// Acceleration of every block of the sub-assembly, by its body.
    pub accelerations: Vec<(usize, Acceleration)>,
    /// Force at every contact point.
    pub forces: Vec<(Contact, ContactForce)>,
    /// The largest error in any law, of the fastest acceleration: of Newton's and Euler's in each block, of Coulomb's and of
    /// complementarity at each point (the natural map of docs/notation.md, of accelerations).
    pub error: f64,
}

impl Escape {
    /// From a point of the relaxation; None if it does not obey the laws, or is at rest.
    pub(super) fn new(assembly: &Assembly, blocks: &BlockSet, laws: &Laws, found: &Found) -> Option<Self> {
        let (motion, forces) = laws.in_si(&found.a, &found.forces);
        Self::verified(assembly, blocks, &motion, forces)
    }

    /// From accelerations of the blocks and forces at the contacts between them.
    pub(super) fn verified(
        assembly: &Assembly,
        blocks: &BlockSet,
        motion: &[(usize, Components)],
        forces: Vec<ContactForce>,
    ) -> Option<Self> {
        let moves = motion.iter().any(|(block, a)| severity(assembly, *block, a) > MOVES);
        let fastest = motion.iter().map(|(block, a)| assembly.speed(*block, a)).fold(0.0, f64::max);
        if !moves {
            return None;
        }
        let error = unbalanced(assembly, blocks, motion, &forces).max(law_error(assembly, motion, &forces)) / fastest;
        (error <= ERROR).then(|| Self {
            accelerations: motion
                .iter()
                .map(|&(block, a)| (assembly.body_index(block), assembly.in_world(block, a)))
                .collect(),
            forces: forces.into_iter().map(|force| (assembly.contacts()[force.contact].clone(), force)).collect(),
            error,
        })
    }
}
