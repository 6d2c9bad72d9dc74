//! Verdicts on what stands with joints that neither part nor slide.

use super::verdict::{Verdict, standing};
use crate::{
    canonical::elastic_forces,
    formulate::{Assembly, BlockSet, FrictionCone},
};

/// That it stands, if every face can bear what a thin elastic layer between its blocks does; with the forces of least norm then.
pub(super) fn check(assembly: &Assembly, blocks: &BlockSet, cone: FrictionCone) -> Option<Verdict> {
    let forces = elastic_forces(assembly, blocks, cone)?;
    let stands = standing(assembly, blocks, forces)?;
    Some(Verdict { least_norm: cone == assembly.cone_of_rest(cone), ..stands })
}
