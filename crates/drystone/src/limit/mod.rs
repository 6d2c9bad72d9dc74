//! How much more load: the interval of t in which a structure can stand under `F + t F1`.
//!
//! ```text
//! t_high = max t   with   G f + F + t F1 = 0,   f in K                                (1)
//!        = min -v' F   with   v opens contacts or keeps them closed,   v' F1 = 1       (2)
//! ```
//!
//! and `t_low` the same with `-F1`. (1) is the static theorem of limit analysis, (2) the kinematic one: the collapse motion v in
//! which the loads do no more work than they must. With friction both are those of the associated flow rule, in which what
//! slides also opens; see docs/theory/limit-loads.md.

mod accelerated;
mod cases;
mod centre;
mod ends;
mod fall;
mod interior;
mod margin;
mod region;
mod root;
mod walk;

pub(crate) use accelerated::accelerated;
pub use cases::{Cases, cases};
pub use ends::{End, Limit};
pub use margin::{Asked, Loads, Margin, least_friction, margin};

use crate::{
    equilibrium::{Effort, equilibrium_while},
    error::SceneError,
    formulate::{Assembly, BlockSet, FrictionCone, Push},
};
use drystone_lcp::{
    Status,
    cone::{ConeSolver, Membership},
};
use interior::Known;

/// The interval for a sub-assembly of these blocks; a push acts on them only.
pub fn limit(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone) -> Limit {
    limit_known(assembly, blocks, push, cone, Known::well())
}

/// The same with ends that are known well enough.
fn limit_known(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone, known: Known) -> Limit {
    if assembly.is_round(cone) {
        return interior::limit(assembly, blocks, push, cone, known);
    }
    let found = equilibrium_while(assembly, blocks, Effort::OfInteriorPoint, &mut |_| true);
    let (found, solver) = found.expect("nobody stops it");
    from_equilibrium(assembly, blocks, push, found, &solver, known)
}

/// The greatest factor alone; None if it stands for none, or there is no answer.
pub(crate) fn greatest(assembly: &Assembly, blocks: &BlockSet, push: &Push, cone: FrictionCone) -> Option<f64> {
    interior::greatest(assembly, blocks, push, cone).or_else(|| {
        let found = limit(assembly, blocks, push, cone);
        (found.status == Status::Solved).then_some(found.upper.factor)
    })
}

/// [`limit`] with pyramids, from what an equilibrium solver with these blocks has found.
pub(crate) fn limit_from(
    assembly: &Assembly,
    blocks: &BlockSet,
    push: &Push,
    found: Membership,
    solver: &ConeSolver,
) -> Limit {
    from_equilibrium(assembly, blocks, push, found, solver, Known::well())
}

fn from_equilibrium(
    assembly: &Assembly,
    blocks: &BlockSet,
    push: &Push,
    found: Membership,
    solver: &ConeSolver,
    known: Known,
) -> Limit {
    let walked = match found {
        Membership::PivotLimit => None,
        _ => walk::limit(assembly, blocks, push, found, solver),
    };
    walked.unwrap_or_else(|| interior::limit(assembly, blocks, push, FrictionCone::Pyramid, known))
}

/// The blocks with these names, or all.
///
/// # Errors
/// [`SceneError::UnknownName`].
pub fn blocks_named(assembly: &Assembly, names: Option<&[String]>) -> Result<BlockSet, SceneError> {
    let Some(names) = names else { return Ok(BlockSet::full(assembly.blocks())) };
    let mut set = BlockSet::empty(assembly.blocks());
    assembly.named(names)?.into_iter().for_each(|block| set.insert(block));
    Ok(set)
}
