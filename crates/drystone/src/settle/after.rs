//! The one answer to "which contact forces after it": those of least norm of all that are left.

use super::settled::Settled;
use crate::{
    canonical::least_norm_of,
    contact::Contact,
    formulate::{Assembly, BlockSet, ContactForce, FrictionCone, force_at},
    proof::{accelerations_under, moving},
};

/// The canonical forces after a settlement: of those that do no work where joints open, so that they are left after it, the ones of
/// least norm; in the order of its own forces. None where these are not found to the accuracy that a verdict needs.
pub fn canonical_forces_after(assembly: &Assembly, cone: FrictionCone, settled: &Settled) -> Option<Vec<ContactForce>> {
    let mut blocks = BlockSet::empty(assembly.blocks());
    let bodies = settled.displacements.iter().map(|&(body, _)| body);
    bodies.filter_map(|body| assembly.block_of(body)).for_each(|block| blocks.insert(block));
    let found: Vec<[f64; 3]> = settled.forces.iter().map(|(_, force)| force.force).collect();
    let space = assembly.body_space(&blocks, cone).of_moving();
    let space = space.bearing_after(&settled.relative, settled.resolution, &found);
    let bearing = least_norm_of(assembly, space);
    if !moving(assembly, &accelerations_under(assembly, &blocks, &bearing), &bearing).is_empty() {
        return None;
    }
    let mut bearing = bearing.into_iter().peekable();
    let of = |(contact, force): &(Contact, ContactForce)| {
        let after = bearing.next_if(|after| after.contact == force.contact);
        after.unwrap_or_else(|| force_at(force.contact, contact.normal, assembly.in_plane(), [0.0; 3]))
    };
    Some(settled.forces.iter().map(of).collect())
}
