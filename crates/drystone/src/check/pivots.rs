//! Verdicts by pivots: forces of an equilibrium, or the complementarity problem that tells how blocks fall.

use super::{collapse, proved::by_interior_point, verdict::Verdict};
use crate::{
    crossover::or_from_interior,
    equilibrium::GoOn,
    formulate::{Assembly, BlockSet, FrictionCone, Moving},
    judgement::{CLOSING_AS_SOLVED, Judgement, judge, moving_blocks, proves_fall},
    ladder::FEW_ROWS,
};
use drystone_lcp::{
    Counts, Settings, Solver, Status,
    cone::{ConeSolver, Membership},
};

/// Most rows for which the complementarity problem tells the accelerations of what falls, where blocks differ so widely that accelerations are
/// refined to more than 64 bits, which takes a basis: the pivots for as many rows take a second or two.
const FEW_IF_WIDE: usize = 2_000;

pub(super) fn few(assembly: &Assembly) -> usize {
    if assembly.is_wide() { FEW_IF_WIDE } else { FEW_ROWS }
}

/// The verdict that an equilibrium solver has come to, with all its forces up to date; the accelerations of what falls are
/// those of the complementarity problem. `spent` is the work done for it. None if stopped.
pub(crate) fn by_equilibrium(
    assembly: &Assembly,
    blocks: &BlockSet,
    found: Membership,
    equilibrium: &ConeSolver,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    match found {
        Membership::Inside => Some(held(assembly, blocks, equilibrium, spent)),
        // Accelerations, and the forces under them, may prove what multipliers and simplex' forces do not.
        Membership::Borderline => {
            let moved = complementarity_while(assembly, blocks, None, spent, go_on)?;
            let falls_perhaps = equilibrium.doubt().is_some_and(|doubt| doubt.is_at_a_limit());
            let decided = moved.status == Status::Solved && !(moved.stable && falls_perhaps);
            Some(if decided { moved } else { held(assembly, blocks, equilibrium, spent) })
        }
        Membership::Outside => {
            let moved = match assembly.rows(blocks).len() > few(assembly) {
                true => Some(by_interior_point(assembly, blocks, FrictionCone::Pyramid, spent, go_on)?),
                false => None,
            };
            match moved {
                Some(moved) if moved.status == Status::Solved && !moved.stable => Some(moved),
                _ => complementarity_while(assembly, blocks, Some(equilibrium), spent, go_on),
            }
        }
        _ => complementarity_while(assembly, blocks, None, spent, go_on),
    }
}

/// Solves the complementarity problem from scratch; `fell` is an equilibrium solver that has found that the sub-assembly falls,
/// `spent` is work done before.
pub(super) fn complementarity_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    fell: Option<&ConeSolver>,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let mut solver = Solver::new(assembly.problem(), Settings::default())
        .expect("A = G' M^-1 G is symmetric with a positive diagonal");
    solver.add_rows(&assembly.rows(blocks)).expect("rows of this assembly's problem");
    let size = blocks.len();
    let status = match solver.solve_while(&mut || go_on(size)) {
        // A = G' M^-1 G and q = -G' M^-1 F have a solution always: a ray is made of rounding, beside masses of 1e13 to one.
        Ok(Some(Status::NoSolution)) | Err(_) => Status::NumericalTrouble,
        Ok(solved) => solved?,
    };
    let counts = spent + solver.counts();
    let moving = assembly.moving(blocks, |j| solver.z(j));
    let found = verdict(assembly, blocks, &moving, status, counts, solver.residual());
    let fallen = |found: Verdict, equilibrium: &ConeSolver| {
        let proved = status == Status::Solved
            && !found.falling.is_empty()
            && proves_fall(assembly, blocks, &moving, CLOSING_AS_SOLVED);
        if proved {
            Verdict { stable: false, ..found }
        } else {
            collapse::verdict(assembly, blocks, found, equilibrium)
        }
    };
    let judgement = match (fell, status) {
        (Some(equilibrium), _) => return Some(fallen(found, equilibrium)),
        (None, Status::Solved) => judge(assembly, blocks, &moving),
        (None, _) => Judgement::by_equilibrium(assembly, blocks),
    };
    Some(match or_from_interior(judgement, assembly, blocks) {
        Judgement::Stands => found,
        Judgement::Falls => Verdict { stable: false, ..found },
        Judgement::ByEquilibrium(Membership::Outside, equilibrium) => fallen(found, &equilibrium),
        Judgement::ByEquilibrium(Membership::Inside | Membership::Borderline, equilibrium) => {
            held(assembly, blocks, &equilibrium, counts)
        }
        Judgement::ByEquilibrium(..) => {
            let status = if status == Status::Solved { Status::NumericalTrouble } else { status };
            Verdict { status, stable: false, falling: Vec::new(), ..found }
        }
    })
}

/// The verdict on what is held up by the forces of an equilibrium solver, for certain or borderline.
pub(super) fn held(assembly: &Assembly, blocks: &BlockSet, equilibrium: &ConeSolver, counts: Counts) -> Verdict {
    let moving = assembly.moving_under(blocks, |j| assembly.magnitude(equilibrium, j));
    let held = verdict(assembly, blocks, &moving, Status::Solved, counts, equilibrium.residual());
    let doubt = equilibrium.doubt();
    let status = if doubt.is_some() { Status::Borderline } else { Status::Solved };
    Verdict { status, stable: doubt.is_none(), falling: Vec::new(), doubt, ..held }
}

/// Reads a verdict from the magnitudes of the generators and the accelerations under them.
fn verdict(
    assembly: &Assembly,
    blocks: &BlockSet,
    under: &Moving,
    status: Status,
    counts: Counts,
    residual: f64,
) -> Verdict {
    let moving = moving_blocks(assembly, under);
    let falling: Vec<usize> = moving.iter().map(|&(block, _)| assembly.body_index(block)).collect();
    Verdict {
        status,
        stable: status == Status::Solved && falling.is_empty(),
        checked: blocks.iter().map(|block| assembly.body_index(block)).collect(),
        accelerations: under.motion.iter().map(|&(block, value)| assembly.in_world(block, value)).collect(),
        falling,
        forces: assembly
            .contact_forces(&assembly.rows(blocks), |j| under.forces[j])
            .into_iter()
            .map(|force| (assembly.contacts()[force.contact].clone(), force))
            .collect(),
        counts,
        iterations: 0,
        residual,
        virtual_motion: false,
        least_norm: false,
        doubt: None,
    }
}
