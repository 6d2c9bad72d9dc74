//! What the interior-point method proves: forces, or the accelerations of what falls.

use super::verdict::Verdict;
use crate::{
    equilibrium::GoOn,
    formulate::{Assembly, BlockSet, Components, Constrained, ContactForce, FrictionCone},
    judgement::severity,
    proof::{Proved, proved},
};
use drystone_lcp::{Counts, Status, cone::Doubt, interior::End};

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
