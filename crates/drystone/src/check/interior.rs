//! Verdicts by the interior-point method: forces, or the accelerations of what falls, proved by what shares nothing with it.

use super::{GoOn, Verdict, by_equilibrium, complementarity_while, few};
use crate::{
    crossover::from_interior,
    formulate::{Assembly, BlockSet, Components, Constrained, ContactForce, FrictionCone},
    judgement::severity,
    proof::{Proved, proved},
};
use drystone_lcp::{Counts, Status, cone::Doubt, interior::End};

/// The verdict of the interior-point method. Where its answer proves nothing, the equilibrium solver decides, which has more
/// digits: on the pyramids, or on those within and around round cones, as far as these agree.
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
    let within = by_pyramids(assembly, blocks, spent, go_on)?;
    if within.stable || !assembly.is_round(cone) {
        return Some(within);
    }
    let around = by_pyramids(&assembly.circumscribed(), blocks, within.counts, go_on)?;
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

fn by_pyramids(assembly: &Assembly, blocks: &BlockSet, spent: Counts, go_on: &mut GoOn<'_>) -> Option<Verdict> {
    let (found, solver) = from_interior(assembly, blocks);
    let counts = spent + solver.counts();
    by_equilibrium(assembly, blocks, found, &solver, counts, go_on)
}

/// What the interior-point method has found: proved, or borderline. None if stopped.
pub(super) fn by_interior_point(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let size = blocks.len();
    let Constrained { motion, forces, found } = assembly.body_space(blocks, cone).solve_while(&mut || go_on(size))?;
    // Pivots come nearer to the limit, where there are as many.
    let sure = found.end == End::AtRest || assembly.is_round(cone);
    let proved = proved(assembly, blocks, &motion, &forces, cone, sure);
    let falls = proved.falls();
    let Proved { under, stands, falling, power } = proved;
    let imbalance = largest(assembly, &under);
    let residual = if stands { imbalance } else { largest(assembly, &difference(&under, &motion)) };
    let accelerations = if stands { under } else { motion };
    let bodies = |blocks: &[(usize, Components)]| blocks.iter().map(|&(block, _)| assembly.body_index(block)).collect();
    let at = |force: ContactForce| (assembly.contacts()[force.contact].clone(), force);
    let doubt = (!stands && !falls).then_some(Doubt { imbalance, power });
    Some(Verdict {
        status: if doubt.is_some() { Status::Borderline } else { Status::Solved },
        stable: stands,
        checked: bodies(&accelerations),
        falling: if falls { bodies(&falling) } else { Vec::new() },
        accelerations: accelerations.iter().map(|&(block, value)| assembly.in_world(block, value)).collect(),
        forces: forces.into_iter().map(at).collect(),
        counts: spent,
        iterations: found.iterations,
        residual,
        virtual_motion: false,
        least_norm: false,
        doubt,
    })
}

fn difference(a: &[(usize, Components)], b: &[(usize, Components)]) -> Vec<(usize, Components)> {
    a.iter().zip(b).map(|((block, a), (_, b))| (*block, std::array::from_fn(|k| a[k] - b[k]))).collect()
}

/// The largest of some accelerations, as a share of gravity.
fn largest(assembly: &Assembly, accelerations: &[(usize, Components)]) -> f64 {
    accelerations.iter().map(|(block, a)| severity(assembly, *block, a)).fold(0.0, f64::max)
}
