//! Verdicts by the interior-point method: forces, or the accelerations of what falls, proved by what shares nothing with it.

use super::{
    pivots::{by_equilibrium, complementarity_while, few},
    proved::by_interior_point,
    verdict::Verdict,
};
use crate::{
    crossover::from_interior_within,
    equilibrium::GoOn,
    formulate::{Assembly, BlockSet, FrictionCone},
    ladder::Ladder,
};
use drystone_lcp::{Counts, Status, cone::Membership};

/// The verdict of the interior-point method. Where its answer proves nothing, the equilibrium solver decides, which has more
/// digits: on the pyramids, or on those within and around round cones, as far as these agree. What it does not decide in a stated
/// effort, which large structures within rounding of their limit would take for minutes, stays borderline.
pub(super) fn check(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let found = by_interior_point(assembly, blocks, cone, spent, go_on)?;
    if found.status == Status::Solved {
        let refines = !found.stable && !assembly.is_round(cone) && assembly.is_wide();
        return if refines { refined(assembly, blocks, found, go_on) } else { Some(found) };
    }
    let Some(within) = by_pyramids(assembly, blocks, spent, go_on)? else { return Some(found) };
    if within.stable || !assembly.is_round(cone) {
        return Some(within);
    }
    let around = by_pyramids(&assembly.circumscribed(), blocks, within.counts, go_on)?;
    let Some(around) = around else { return Some(Verdict { counts: within.counts, ..found }) };
    let falls = around.status == Status::Solved && !around.stable;
    Some(if falls { around } else { Verdict { counts: around.counts, ..found } })
}

/// The same fall with accelerations to more than 64 bits, from a basis, where that takes no more than some seconds.
fn refined(assembly: &Assembly, blocks: &BlockSet, found: Verdict, go_on: &mut GoOn<'_>) -> Option<Verdict> {
    if assembly.rows(blocks).len() > few(assembly) {
        return Some(found);
    }
    let moved = complementarity_while(assembly, blocks, None, found.counts, go_on)?;
    let falls = moved.status == Status::Solved && !moved.stable && !moved.virtual_motion;
    Some(if falls { Verdict { iterations: found.iterations, ..moved } } else { found })
}

/// None inside if that takes more than an effort.
fn by_pyramids(assembly: &Assembly, blocks: &BlockSet, spent: Counts, go_on: &mut GoOn<'_>) -> Option<Option<Verdict>> {
    let effort = Ladder::of(assembly, blocks.len()).effort_at_a_limit();
    let (found, solver) = from_interior_within(assembly, blocks, effort);
    if found == Membership::PivotLimit && solver.is_exhausted() {
        return Some(None);
    }
    let counts = spent + solver.counts();
    by_equilibrium(assembly, blocks, found, &solver, counts, go_on).map(Some)
}
