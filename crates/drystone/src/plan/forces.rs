//! Contact forces of the intermediate structures of an order.
//!
//! The structures are put up block by block, each from the basis of the one before (Loomis and Balkcom 2006, Theorem 1), so that
//! all their verdicts together cost about as much as the last alone from scratch. The canonical forces are computed for each
//! that is asked about.

use super::stability::PlanError;
use crate::{
    canonical::holding_up,
    formulate::{Assembly, BlockSet, Components, ContactForce, FrictionCone},
    proof::accelerations_under,
};
use drystone_lcp::cone::{ConeSolver, Membership};

/// Which of the forces that hold a structure up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WhichForces {
    /// Those of least norm ([`canonical`](crate::canonical)).
    #[default]
    Canonical,
    /// Those that are found first.
    Any,
}

/// How structures are put up.
#[derive(Debug, Clone, Copy, Default)]
pub struct Course<'a> {
    /// Movable blocks, the first put up first.
    pub order: &'a [usize],
    /// Of the structures of one block, of two and so on those that hands hold; of further ones none.
    pub held: &'a [Vec<usize>],
    /// Which forces are wanted.
    pub forces: WhichForces,
}

/// One structure of an order, and the forces that hold it up.
#[derive(Debug, Clone, PartialEq)]
pub struct StructureForces {
    /// Movable blocks put up so far.
    pub blocks: usize,
    /// Contact forces that balance the loads, without those that are zero; `None` if there are none: it falls, or that is
    /// borderline.
    pub forces: Option<Vec<ContactForce>>,
    /// What hands do to the blocks that they hold: force in world axes, N, and moment about the centre of mass, N m.
    pub hands: Vec<(usize, Components)>,
}

/// Puts movable blocks up in an order, and shows `visit` each structure whose number of blocks `wants` asks for, until
/// it returns false. Where blocks are held there are canonical forces only.
///
/// # Errors
/// [`PlanError::NoAnswer`] if an equilibrium is not decided.
pub fn forces_along(
    assembly: &Assembly,
    course: &Course<'_>,
    wants: impl Fn(usize) -> bool,
    mut visit: impl FnMut(StructureForces) -> bool,
) -> Result<(), PlanError> {
    let (mut equilibrium, rows) = (assembly.equilibrium(), assembly.equilibrium_rows());
    let mut present = BlockSet::empty(assembly.blocks());
    for (below, &block) in course.order.iter().enumerate() {
        present.insert(block);
        equilibrium.add_rows(rows.of(block));
        let blocks = below + 1;
        if !wants(blocks) {
            equilibrium.decide();
            continue;
        }
        let mut held = BlockSet::empty(assembly.blocks());
        course.held.get(below).into_iter().flatten().for_each(|&block| held.insert(block));
        let forces = if held.is_empty() || course.forces == WhichForces::Any {
            standing(assembly, &present, &mut equilibrium, course.forces)?
        } else {
            equilibrium.decide();
            holding_up(assembly, &present, &held, FrictionCone::Pyramid)
        };
        let hands = forces.as_ref().map(|forces| of_hands(assembly, &held, forces)).unwrap_or_default();
        let forces = forces.map(|every| every.into_iter().filter(|force| force.force != [0.0; 3]).collect());
        if !visit(StructureForces { blocks, forces, hands }) {
            break;
        }
    }
    Ok(())
}

/// The forces of a structure that stands without hands.
fn standing(
    assembly: &Assembly,
    present: &BlockSet,
    equilibrium: &mut ConeSolver,
    which: WhichForces,
) -> Result<Option<Vec<ContactForce>>, PlanError> {
    let any = |solver: &ConeSolver| assembly.contact_forces(&assembly.rows(present), |j| assembly.magnitude(solver, j));
    match equilibrium.solve() {
        Membership::Inside => {
            let none = BlockSet::empty(assembly.blocks());
            let canonical = || holding_up(assembly, present, &none, FrictionCone::Pyramid);
            let found = if which == WhichForces::Canonical { canonical() } else { None };
            Ok(Some(found.unwrap_or_else(|| any(equilibrium))))
        }
        Membership::Outside | Membership::Borderline => Ok(None),
        trouble => {
            let reason = format!("{trouble:?} (residual {:.1e})", equilibrium.residual());
            Err(PlanError::NoAnswer { blocks: present.len(), reason })
        }
    }
}

/// What hands have to do to the blocks that they hold: what contact forces and loads leave, reversed.
fn of_hands(assembly: &Assembly, held: &BlockSet, forces: &[ContactForce]) -> Vec<(usize, Components)> {
    let reaction = |(block, left): (usize, Components)| {
        let mut wrench = [0.0; 6];
        for (&k, inverse) in assembly.components().iter().zip(assembly.inverse_mass(block)) {
            wrench[k] = -left[k] / inverse;
        }
        let [x, y, z, moment @ ..] = wrench;
        let [a, b, c] = assembly.body(block).in_world(moment);
        (block, [x, y, z, a, b, c])
    };
    accelerations_under(assembly, held, forces).into_iter().map(reaction).collect()
}
