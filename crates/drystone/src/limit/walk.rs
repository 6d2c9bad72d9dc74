//! By pivots, from the basis that is there: exact at a vertex.

use super::ends::{End, Limit};
use crate::{
    equilibrium::collapse_motion,
    formulate::{Assembly, BlockSet, ContactForce, FrictionCone, Push},
    ladder::Ladder,
};
use drystone_lcp::{
    Counts, Status,
    cone::{ConeSolver, Greatest, Load, Membership},
};

/// Pivots are given up after so small a part of what the interior-point method takes: few blocks are decided by then, and walls
/// take thousands (docs/theory/limit-loads.md).
const OF_INTERIOR_POINT: usize = 4;

/// None if the pivots would take about as long as the interior-point method, or lost too many digits.
pub(super) fn limit(
    assembly: &Assembly,
    blocks: &BlockSet,
    push: &Push,
    found: Membership,
    solver: &ConeSolver,
) -> Option<Limit> {
    let worth = Ladder::of(assembly, blocks.len()).effort_of_interior_point() / OF_INTERIOR_POINT;
    Walk { assembly, blocks, push, worth }.limit(found, solver)
}

/// The same however long it takes.
pub(super) fn to_the_end(
    assembly: &Assembly,
    blocks: &BlockSet,
    push: &Push,
    found: Membership,
    solver: &ConeSolver,
) -> Option<Limit> {
    Walk { assembly, blocks, push, worth: usize::MAX }.limit(found, solver)
}

struct Walk<'a> {
    assembly: &'a Assembly,
    blocks: &'a BlockSet,
    push: &'a Push,
    /// Most effort for an end.
    worth: usize,
}

impl Walk<'_> {
    fn limit(&self, found: Membership, solver: &ConeSolver) -> Option<Limit> {
        let mut solver = solver.clone();
        let before = solver.counts();
        let rows = self.push.wrenches().iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0);
        let load = solver.add_load(&rows.collect::<Vec<_>>()).ok()?;
        let counted = |limit: Limit, others: Counts| Some(Limit { counts: others + (limit.counts - before), ..limit });
        if found != Membership::Inside {
            solver.limit_effort(solver.effort().saturating_add(self.worth));
            match solver.solve() {
                Membership::Inside => {}
                Membership::Outside => return counted(self.never(&solver), Counts::default()),
                _ => return None,
            }
        }
        let (upper, up) = self.end(&mut solver.clone(), load, 1.0)?;
        let (lower, down) = self.end(&mut solver, load.reversed(), -1.0)?;
        let limit = Limit { status: Status::Solved, lower, upper, counts: up, iterations: 0 };
        counted(limit, down - before)
    }

    fn end(&self, solver: &mut ConeSolver, load: Load, sign: f64) -> Option<(End, Counts)> {
        solver.limit_effort(solver.effort().saturating_add(self.worth));
        let end = match solver.greatest(load) {
            Greatest::Unlimited => End::unlimited(sign),
            Greatest::Limited(factor) => self.at(solver, sign * factor),
            _ => return None,
        };
        Some((end, solver.counts()))
    }

    fn at(&self, solver: &ConeSolver, factor: f64) -> End {
        let Self { assembly, blocks, push, .. } = *self;
        let motion = collapse_motion(assembly, solver);
        End::new(assembly, blocks, push, FrictionCone::Pyramid, factor, motion, self.forces(solver))
    }

    fn forces(&self, solver: &ConeSolver) -> Vec<ContactForce> {
        let rows = self.assembly.rows(self.blocks);
        self.assembly.contact_forces(&rows, |j| self.assembly.magnitude(solver, j))
    }

    /// Whatever the factor, it falls.
    fn never(&self, solver: &ConeSolver) -> Limit {
        let end = self.at(solver, f64::NAN);
        let upper = End { imbalance: f64::NAN, bound: f64::NAN, ..end };
        let lower = End { forces: Vec::new(), ..upper.clone() };
        let counts = solver.counts();
        Limit { status: Status::NoSolution, lower, upper: End { forces: Vec::new(), ..upper }, counts, iterations: 0 }
    }
}
