//! What a check answers.

use crate::{
    contact::Contact,
    formulate::{Acceleration, Assembly, BlockSet, ContactForce},
    judgement::severity,
    proof::{accelerations_under, moving},
};
use drystone_lcp::{Counts, Status, cone::Doubt};

/// The answer for an assembly or a sub-assembly.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// How the solver ended; anything but solved means that `stable` is not decided (and false). Borderline: neither
    /// standing nor falling is proved, see `doubt`.
    pub status: Status,
    /// An equilibrium exists within the friction cones (without friction this is also sufficient to stand).
    pub stable: bool,
    /// Indices of the movable bodies that were checked, ascending.
    pub checked: Vec<usize>,
    /// Acceleration of each of them.
    pub accelerations: Vec<Acceleration>,
    /// Those that do not stay at rest.
    pub falling: Vec<usize>,
    /// Force at every contact point between checked or fixed bodies.
    pub forces: Vec<(Contact, ContactForce)>,
    /// Work done.
    pub counts: Counts,
    /// Iterations of the interior-point method: matrices factored.
    pub iterations: usize,
    /// Residual of the complementarity problem, in its own scale.
    pub residual: f64,
    /// The accelerations are those along a virtual motion in which it falls, not those with which it begins to: the
    /// complementarity problem could not be solved to an accuracy that tells.
    pub virtual_motion: bool,
    /// Whether the forces are those of least norm ([`canonical_forces`](crate::canonical::canonical_forces)) already.
    pub least_norm: bool,
    /// Of a borderline verdict: how near it is to standing, and to falling.
    pub doubt: Option<Doubt>,
}

/// That it stands with some forces within its cones; None if these do not balance every block.
pub(super) fn standing(assembly: &Assembly, blocks: &BlockSet, forces: Vec<ContactForce>) -> Option<Verdict> {
    let under = accelerations_under(assembly, blocks, &forces);
    if !moving(assembly, &under, &forces).is_empty() {
        return None;
    }
    let contacts = assembly.contacts();
    Some(Verdict {
        status: Status::Solved,
        stable: true,
        checked: under.iter().map(|&(block, _)| assembly.body_index(block)).collect(),
        falling: Vec::new(),
        residual: under.iter().map(|(block, a)| severity(assembly, *block, a)).fold(0.0, f64::max),
        accelerations: under.iter().map(|&(block, value)| assembly.in_world(block, value)).collect(),
        forces: forces.into_iter().map(|force| (contacts[force.contact].clone(), force)).collect(),
        counts: Counts::default(),
        iterations: 0,
        virtual_motion: false,
        least_norm: false,
        doubt: None,
    })
}
