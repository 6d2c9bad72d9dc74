//! Contact forces of the intermediate structures of an order.
//!
//! The structures are put up block by block, each from the basis of the one before (Loomis and Balkcom 2006, Theorem 1),
//! so that all of them together cost about as much as the last alone from scratch.

use super::stability::PlanError;
use crate::formulate::{Assembly, BlockSet, ContactForce};
use drystone_lcp::cone::Membership;

/// One structure of an order, and the forces that hold it up.
#[derive(Debug, Clone, PartialEq)]
pub struct StructureForces {
    /// Movable blocks put up so far.
    pub blocks: usize,
    /// Contact forces that balance the loads, without those that are zero; `None` if there are none: it falls, or that is
    /// borderline.
    pub forces: Option<Vec<ContactForce>>,
}

/// Puts movable blocks up in an order, and shows `visit` each structure whose number of blocks `wants` asks for, until
/// it returns false. Where a structure is redundant, other forces hold it up as well.
///
/// # Errors
/// [`PlanError::NoAnswer`] if an equilibrium is not decided.
pub fn forces_along(
    assembly: &Assembly,
    order: &[usize],
    wants: impl Fn(usize) -> bool,
    mut visit: impl FnMut(StructureForces) -> bool,
) -> Result<(), PlanError> {
    let (mut equilibrium, rows) = (assembly.equilibrium(), assembly.equilibrium_rows());
    let mut present = BlockSet::empty(assembly.blocks());
    for (below, &block) in order.iter().enumerate() {
        present.insert(block);
        equilibrium.add_rows(rows.of(block));
        let blocks = below + 1;
        if !wants(blocks) {
            equilibrium.decide();
            continue;
        }
        let forces = match equilibrium.solve() {
            Membership::Inside => {
                let every = assembly.contact_forces(&assembly.rows(&present), |j| assembly.magnitude(&equilibrium, j));
                Some(every.into_iter().filter(|force| force.force != [0.0; 3]).collect())
            }
            Membership::Outside | Membership::Borderline => None,
            trouble => {
                let reason = format!("{trouble:?} (residual {:.1e})", equilibrium.residual());
                return Err(PlanError::NoAnswer { blocks, reason });
            }
        };
        if !visit(StructureForces { blocks, forces }) {
            break;
        }
    }
    Ok(())
}
