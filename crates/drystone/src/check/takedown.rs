//! Verdicts on what bears by straight pressure, block by block.

use super::Verdict;
use crate::{
    formulate::{Assembly, BlockSet, ContactForce},
    judgement::severity,
    proof::{accelerations_under, moving},
    takedown::Takedown,
};
use drystone_lcp::{Counts, Status};

/// That it stands, if every block bears, proved by what shares nothing with the forces' computation.
pub(super) fn check(assembly: &Assembly, blocks: &BlockSet) -> Option<Verdict> {
    standing(assembly, blocks, Takedown::of_bearing(assembly, blocks)?.forces(assembly, blocks)?)
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
