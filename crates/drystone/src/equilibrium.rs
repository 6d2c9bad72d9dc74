//! Contact forces that hold a sub-assembly, looked for from the supports upward, and the motion in which it falls if there are
//! none.

use crate::{
    formulate::{Assembly, BlockRows, BlockSet, Components},
    ladder::Ladder,
};
use drystone_lcp::cone::{ConeSolver, Membership};

/// Asked many times, with the blocks put up so far, whether to go on.
pub type GoOn<'a> = dyn FnMut(usize) -> bool + 'a;

/// Looks for contact forces that hold a sub-assembly, putting it up block by block from the supports. None if stopped.
pub(crate) fn equilibrium_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    effort: Effort,
    go_on: &mut GoOn<'_>,
) -> Option<(Membership, ConeSolver)> {
    let mut equilibrium = assembly.equilibrium();
    let upward = assembly.upward().into_iter().filter(|&block| blocks.contains(block));
    let (mut placed, mut hard) = (0, false);
    let ladder = |blocks: usize| Ladder::of(assembly, blocks);
    let mut before = |solver: &mut ConeSolver, _| {
        hard = solver.is_exhausted();
        placed += 1;
        match effort {
            Effort::Any => {}
            Effort::OfInteriorPoint => solver.limit_effort(ladder(placed).effort_of_interior_point()),
            Effort::FromNothing => solver.limit_effort(ladder(placed).effort_from_nothing()),
        }
        !hard && go_on(placed - 1)
    };
    let all_there = put_up(&mut equilibrium, &assembly.equilibrium_rows(), upward, &mut before);
    if !all_there && !hard {
        return None;
    }
    let found = if hard { Membership::PivotLimit } else { equilibrium.solve() };
    Some((found, equilibrium))
}

/// How long pivots are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// To the end.
    Any,
    /// Until they take about as long as the interior-point method: [`Membership::PivotLimit`] then.
    OfInteriorPoint,
    /// As many as most small structures take: the interior-point method comes next in any case.
    FromNothing,
}

/// [`equilibrium_while`] to the end.
pub(crate) fn equilibrium_of(assembly: &Assembly, blocks: &BlockSet) -> (Membership, ConeSolver) {
    equilibrium_while(assembly, blocks, Effort::Any, &mut |_| true).expect("nobody stops it")
}

/// How what a solver has just found outside falls: its certificate y has `y' G <= 0` and `y' h > 0` with `h = -F`, so that the
/// loads do work in the motion -y. Blocks ascending, those at rest left out; rows after those of the blocks are none's.
pub(crate) fn collapse_motion(assembly: &Assembly, solver: &ConeSolver) -> Vec<(usize, Components)> {
    let (rows, components) = (assembly.equilibrium_rows(), assembly.components());
    let mut moving: Vec<(usize, Components)> = Vec::new();
    for (row, y) in solver.certificate().into_iter().filter(|&(row, _)| row < components.len() * assembly.blocks()) {
        let block = rows.block(row);
        if moving.last().is_none_or(|last| last.0 != block) {
            moving.push((block, [0.0; 6]));
        }
        if let Some((_, velocity)) = moving.last_mut() {
            velocity[components[row - rows.of(block)[0]]] = -y;
        }
    }
    moving
}

/// The blocks of a motion, each with the work that its load does.
pub(crate) fn with_work(
    assembly: &Assembly,
    motion: impl IntoIterator<Item = (usize, Components)>,
) -> Vec<(usize, f64)> {
    let work = |(block, velocity): (usize, Components)| {
        let loads = assembly.components().iter().zip(assembly.applied(block));
        (block, loads.map(|(&k, load)| load * velocity[k]).sum())
    };
    motion.into_iter().map(work).collect()
}

/// A block slower than this share of the fastest is at rest in a motion: rounding of the multipliers.
const AT_REST_BESIDE: f64 = 1e-9;

/// The accelerations along a motion v that come nearest to free fall in Gauss's sense: `a = v (F' v) / (v' M v)`. Blocks at rest
/// are left out.
pub(crate) fn accelerations_along(assembly: &Assembly, motion: &[(usize, Components)]) -> Vec<(usize, Components)> {
    let (mut power, mut inertia, mut fastest) = (0.0, 0.0, 0.0_f64);
    let energy = |block: usize, velocity: &Components| -> f64 {
        let of = assembly.components().iter().zip(assembly.inverse_mass(block));
        of.map(|(&k, inverse)| velocity[k] * velocity[k] / inverse).sum()
    };
    for (block, velocity) in motion {
        let loads = assembly.components().iter().zip(assembly.applied(*block));
        power += loads.map(|(&k, load)| load * velocity[k]).sum::<f64>();
        inertia += energy(*block, velocity);
        fastest = fastest.max((energy(*block, velocity) * assembly.inverse_mass(*block)[0]).sqrt());
    }
    let moves = |(block, velocity): &&(usize, Components)| {
        (energy(*block, velocity) * assembly.inverse_mass(*block)[0]).sqrt() > AT_REST_BESIDE * fastest
    };
    let scaled = |(block, velocity): &(usize, Components)| (*block, velocity.map(|v| v * power / inertia));
    motion.iter().filter(moves).map(scaled).collect()
}

/// Blocks put on what falls already until the solver is asked again: every answer costs a pass over all that falls, and
/// more blocks at once, which nothing holds yet, tie in many pivots. Measured on the arch of 200 voussoirs, where 4 are best (16
/// take an eighth longer), and on 1000 random blocks, where 16 are (4 take a quarter longer).
fn together(blocks: usize) -> usize {
    (blocks / 64).max(4)
}

/// Puts blocks into a solver, which has not answered then. It is asked about every block but the last on the way, or about
/// some at a time where what is there falls in between, as half an arch does. `before` is told each block before it comes;
/// stops, with false, as soon as that says so.
pub(crate) fn put_up(
    solver: &mut ConeSolver,
    rows: &BlockRows,
    blocks: impl IntoIterator<Item = usize>,
    mut before: impl FnMut(&mut ConeSolver, usize) -> bool,
) -> bool {
    let (mut falls, mut new) = (false, 0);
    for block in blocks {
        if new == together(rows.blocks()) || new > 0 && !falls {
            falls = solver.decide() == Membership::Outside;
            new = 0;
        }
        if !before(solver, block) {
            return false;
        }
        solver.add_rows(rows.of(block));
        new += 1;
    }
    true
}
