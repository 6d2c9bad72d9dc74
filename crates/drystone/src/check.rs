//! Does it stand, with which contact forces, and if not, what falls?

mod collapse;
mod elastic;
mod interior;
mod pivots;
mod proved;
mod takedown;
pub(crate) mod verdict;

use crate::{
    equilibrium::{Effort, equilibrium_of, equilibrium_while},
    error::SceneError,
    formulate::{Assemble, Assembly, BlockSet, FrictionCone},
    ladder::Ladder,
    scene::SceneOf,
};
use drystone_lcp::{Counts, cone::Membership};
use pivots::{complementarity_while, held};

pub use crate::{equilibrium::GoOn, judgement::AT_REST};
pub(crate) use pivots::by_equilibrium;
pub use verdict::Verdict;

/// Checks a scene, or the sub-assembly of the named bodies; fixed bodies are always there.
///
/// # Errors
/// [`SceneError`] for overlapping blocks and unknown names.
pub fn check<S: Assemble>(scene: &SceneOf<S>, blocks: Option<&[String]>) -> Result<Verdict, SceneError> {
    let assembly = Assembly::new(scene)?;
    Ok(check_while(&assembly, blocks, Route::Equilibrium, FrictionCone::Pyramid, &mut |_| true)?
        .expect("nobody stops it"))
}

/// How a verdict is reached. All routes give the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Contact forces that balance the loads, by pivots as long as these are no slower than the interior-point method;
    /// accelerations only if there are none.
    Equilibrium,
    /// The complementarity problem in any case, by Dantzig's method from scratch; with pyramids only.
    Complementarity,
    /// Gauss's principle in any case, by the interior-point method.
    InteriorPoint,
}

/// [`check`] by a route and with friction cones of choice, unless it is stopped; None then.
///
/// # Errors
/// [`SceneError::UnknownName`].
pub fn check_while(
    assembly: &Assembly,
    blocks: Option<&[String]>,
    route: Route,
    cone: FrictionCone,
    go_on: &mut GoOn<'_>,
) -> Result<Option<Verdict>, SceneError> {
    let set = match blocks {
        None => BlockSet::full(assembly.blocks()),
        Some(names) => {
            let mut set = BlockSet::empty(assembly.blocks());
            assembly.named(names)?.into_iter().for_each(|block| set.insert(block));
            set
        }
    };
    Ok(match route {
        Route::Equilibrium => check_blocks_while(assembly, &set, cone, go_on),
        Route::Complementarity => complementarity_while(assembly, &set, None, Counts::default(), go_on),
        Route::InteriorPoint => interior::check(assembly, &set, cone, Counts::default(), go_on),
    })
}

/// Whether a scene stands, and nothing else.
///
/// # Errors
/// [`SceneError::Overlap`] if blocks overlap.
pub fn stands<S: Assemble>(scene: &SceneOf<S>) -> Result<bool, SceneError> {
    let assembly = Assembly::new(scene)?;
    Ok(equilibrium_of(&assembly, &BlockSet::full(assembly.blocks())).0 == Membership::Inside)
}

/// Checks a sub-assembly from scratch: equilibrium first, and the accelerations only if there is none.
pub fn check_blocks(assembly: &Assembly, blocks: &BlockSet) -> Verdict {
    check_blocks_while(assembly, blocks, FrictionCone::Pyramid, &mut |_| true).expect("nobody stops it")
}

/// [`check_blocks`] with friction cones of choice, unless it is stopped; None then.
pub fn check_blocks_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let ladder = Ladder::of(assembly, blocks.len());
    if let Some(stands) = takedown::check(assembly, blocks) {
        return Some(stands);
    }
    if ladder.elastic_first()
        && let Some(stands) = elastic::check(assembly, blocks, cone)
    {
        return Some(stands);
    }
    if !ladder.pivots_next() {
        return interior::check(assembly, blocks, cone, Counts::default(), go_on);
    }
    let (found, equilibrium) = equilibrium_while(assembly, blocks, Effort::FromNothing, go_on)?;
    let spent = equilibrium.counts();
    match found {
        // What stands within pyramids stands within the round cones around them.
        Membership::Inside => Some(held(assembly, blocks, &equilibrium, spent)),
        Membership::PivotLimit => interior::check(assembly, blocks, cone, spent, go_on),
        _ if assembly.is_round(cone) => interior::check(assembly, blocks, cone, spent, go_on),
        _ => by_equilibrium(assembly, blocks, found, &equilibrium, spent, go_on),
    }
}

/// [`check_blocks`] by the interior-point method at once; `spent` is work done for it.
pub(crate) fn by_interior_point(assembly: &Assembly, blocks: &BlockSet, spent: Counts) -> Verdict {
    interior::check(assembly, blocks, FrictionCone::Pyramid, spent, &mut |_| true).expect("nobody stops it")
}
