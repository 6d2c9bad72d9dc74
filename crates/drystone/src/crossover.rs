//! From the interior to a basis: the equilibrium solver begins where the interior-point method ended.
//!
//! What pivots from nothing would climb for minutes, a wall under sideways gravity or a dome, the interior-point method
//! holds in some ten iterations. Its forces are all positive, so that they are no basis. From them a second problem of
//! the same kind leads to a vertex, the forces of least generic cost; those that stay positive are a basis, and the
//! solver has no pivot to make but for degenerate rows. Where blocks fall, the contacts that bear in Gauss's solution are
//! most of the basis of the certificate.

use crate::{
    formulate::{Assembly, BlockSet, Components, Constrained},
    judgement::Judgement,
    proof::moving,
};
use drystone_lcp::{
    cone::{ConeSolver, Membership},
    interior::End,
};

/// An equilibrium solver with these blocks, and what it says of them, from an answer of the interior-point method.
pub(crate) fn from_interior(assembly: &Assembly, blocks: &BlockSet) -> (Membership, ConeSolver) {
    from_interior_within(assembly, blocks, usize::MAX)
}

/// The same with no more than an effort: [`Membership::PivotLimit`] then.
pub(crate) fn from_interior_within(assembly: &Assembly, blocks: &BlockSet, effort: usize) -> (Membership, ConeSolver) {
    let space = assembly.body_space_with_axes(blocks);
    let Constrained { motion, forces, found } = space.solve_from_ones();
    let (mut solver, rows) = (assembly.equilibrium(), assembly.equilibrium_rows());
    solver.limit_effort(effort);
    for block in assembly.upward().into_iter().filter(|&block| blocks.contains(block)) {
        solver.add_group(rows.of(block));
    }
    if found.end == End::AtRest {
        solver.start_from(space.basis(&found).unwrap_or_default());
    } else {
        solver.start_from(space.bearing(&found));
        let largest = found.forces.iter().fold(0.0, |largest: f64, force| largest.max(*force));
        if solver.adopt_certificate(&certificate(assembly, &moving(assembly, &motion, &forces)), largest) {
            return (Membership::Outside, solver);
        }
    }
    (solver.solve(), solver)
}

/// A judgement, from the interior-point method where pivots from nothing have no answer: another way up, to another basis.
pub(crate) fn or_from_interior(judgement: Judgement, assembly: &Assembly, blocks: &BlockSet) -> Judgement {
    match judgement {
        Judgement::ByEquilibrium(Membership::PivotLimit | Membership::NumericalTrouble, _) => {
            let (found, solver) = from_interior(assembly, blocks);
            Judgement::ByEquilibrium(found, Box::new(solver))
        }
        answered => answered,
    }
}

/// The multipliers `y = -a` of a motion: by (row, value).
fn certificate(assembly: &Assembly, motion: &[(usize, Components)]) -> Vec<(usize, f64)> {
    let rows = assembly.equilibrium_rows();
    let of = |(block, a): &(usize, Components)| -> Vec<(usize, f64)> {
        rows.of(*block).iter().zip(assembly.components()).map(|(&row, &component)| (row, -a[component])).collect()
    };
    motion.iter().flat_map(of).collect()
}
