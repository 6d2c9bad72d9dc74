//! The stability test of the planner that keeps the forces of the stable parent on a basis of the generators.

use super::by_interior::{Forces, by_interior_point};
use super::collapse::Collapse;
use super::stability::{PlanError, StabilityTest, TestOutcome, Tested, by_accelerations};
use super::touching::Touching;
use crate::{
    equilibrium::put_up,
    formulate::{Assembly, BlockRows, BlockSet},
    ladder::Ladder,
    nearby::Put,
    takedown::Takedown,
};
use drystone_lcp::cone::{ConeSolver, Mark, Membership};

/// Every test starts from the forces of the stable sub-assembly without the block just added (Theorem 1).
///
/// A sub-assembly that stands has no acceleration, so *any* contact forces that balance its loads solve its
/// complementarity problem with w = 0: they are looked for on the generators themselves, whose basis is far sparser
/// than `A = G' M^-1 G`. If there are none, the certificate is a virtual motion that opens no contact against
/// its force and in which the weights do work: the way in which it falls.
///
/// Once the pivots of a search have taken longer than many verdicts from nothing would, blocks that bear by straight pressure
/// are told without the solver, by `Takedown`'s lemma. It hears of them when it is asked again.
#[derive(Debug)]
pub struct Reuse<'a> {
    assembly: &'a Assembly,
    solver: ConeSolver,
    rows: BlockRows,
    /// Applied wrenches, row by row.
    loads: Vec<f64>,
    blocks: usize,
    /// Blocks of the current sub-assembly, as they came.
    placed: Vec<usize>,
    /// The solver's state with the first k of them, by k; None if it was not told of the last one.
    marks: Vec<Option<Mark>>,
    /// The solver is in the last of these states.
    at_current: bool,
    /// How the last one tested falls, where the solver had no answer and the accelerations had, or the interior-point method.
    otherwise: Option<Tested>,
    /// What the last test was about, and whether the solver was asked.
    tested: Option<(usize, bool)>,
    takedown: Option<Takedown>,
    /// Placed blocks that bear, with all below them.
    bearing: BlockSet,
    /// Effort of the solver from which on the lemma is asked first.
    worth: usize,
    /// On the last one tested pivots took longer than the interior-point method.
    hard: bool,
    /// They did on the sub-assembly of so many blocks: that method is asked of all that are built on it.
    hard_from: Option<usize>,
    /// From the first time on that it is asked.
    touching: Option<Touching>,
    /// Forces that it found for the last one tested, and for those of so many blocks on the way.
    found: Option<Forces>,
    forces: Vec<(usize, Forces)>,
}

impl<'a> Reuse<'a> {
    /// Takes the generators of the complete assembly; the current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly) -> Self {
        let mut solver = assembly.equilibrium();
        let blocks = assembly.blocks();
        let loads = (0..blocks).flat_map(|block| assembly.applied(block)).copied().collect();
        Self {
            assembly,
            rows: assembly.equilibrium_rows(),
            loads,
            blocks,
            placed: Vec::new(),
            marks: vec![Some(solver.mark())],
            solver,
            at_current: true,
            otherwise: None,
            tested: None,
            takedown: None,
            bearing: BlockSet::empty(blocks),
            worth: Ladder::of(assembly, blocks).effort_of_a_change(),
            hard: false,
            hard_from: None,
            touching: None,
            found: None,
            forces: Vec::new(),
        }
    }

    /// Asks the lemma from another effort on.
    #[cfg(test)]
    pub fn with_worth(mut self, worth: usize) -> Self {
        self.worth = worth;
        self
    }

    /// The same where the interior-point method is asked from the first test on.
    #[cfg(test)]
    pub fn always_hard(mut self) -> Self {
        self.hard_from = Some(0);
        self
    }

    /// The solver, for its counts.
    pub fn solver(&self) -> &ConeSolver {
        &self.solver
    }

    /// Whether the current sub-assembly, which stands, does so with a block put on it, by the lemma.
    fn carries(&mut self, added: usize) -> bool {
        if self.takedown.is_none() && self.solver.effort() >= self.worth {
            let takedown = Takedown::new(self.assembly);
            for &block in &self.placed {
                if takedown.bears(block, |below| self.bearing.contains(below)) {
                    self.bearing.insert(block);
                }
            }
            self.takedown = Some(takedown);
        }
        let bears = |takedown: &Takedown| takedown.bears(added, |below| self.bearing.contains(below));
        self.takedown.as_ref().is_some_and(bears)
    }

    /// What pivots say of `added` on the current sub-assembly, up to an effort.
    fn by_pivots(&mut self, blocks: &BlockSet, added: usize, most: usize) -> Membership {
        self.go_to_current();
        self.solver.limit_effort(self.solver.effort().saturating_add(most));
        self.solver.add_rows(self.rows.of(added));
        // The last test before the structure is complete brings all forces up to date, and checks them.
        let last = blocks.len() + 1 == self.blocks;
        let found = if last { self.solver.solve() } else { self.solver.decide() };
        self.solver.limit_effort(usize::MAX);
        found
    }

    /// What the interior-point method says.
    fn by_interior_point(&mut self, blocks: &BlockSet, added: usize) -> Option<Tested> {
        let touching = self.touching.get_or_insert_with(|| Touching::new(self.assembly));
        let (put, before) = (Put { blocks, held: &[], added }, self.forces.last().map(|(_, forces)| forces));
        let answer = by_interior_point(self.assembly, touching, put, before)?;
        self.found = answer.forces;
        Some(answer.tested)
    }

    /// Brings the solver to the current sub-assembly.
    fn go_to_current(&mut self) {
        if std::mem::replace(&mut self.at_current, false) {
            return;
        }
        let known = self.marks.iter().rposition(Option::is_some);
        let Some((known, mark)) = known.and_then(|known| Some((known, self.marks[known]?))) else { return };
        self.solver.roll_back(mark);
        self.marks[known] = Some(self.solver.mark()); // what had to be computed is remembered next time
        if known < self.placed.len() {
            put_up(&mut self.solver, &self.rows, self.placed[known..].iter().copied(), |_, _| true);
            self.solver.decide();
            self.marks[self.placed.len()] = Some(self.solver.mark());
        }
    }
}

/// The certificate y with `y' G <= 0`, `y' h > 0` and `h = -F`: the motion is -y. `loads` has the entries of F; what comes
/// after them are the rows of hands.
pub(crate) fn certified_collapse(solver: &ConeSolver, rows: &BlockRows, loads: &[f64]) -> Collapse {
    let mut moving: Vec<(usize, f64)> = Vec::new();
    for (row, y) in solver.certificate().into_iter().filter(|&(row, _)| row < loads.len()) {
        let (block, work) = (rows.block(row), -y * loads[row]);
        match moving.last_mut().filter(|last| last.0 == block) {
            Some(last) => last.1 += work,
            None => moving.push((block, work)),
        }
    }
    Collapse::new(moving)
}

impl StabilityTest for Reuse<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let carried = self.carries(added);
        self.tested = Some((added, !carried));
        self.hard = false;
        self.found = None;
        if carried {
            return Ok(TestOutcome { stands: true, borderline: false, pivots: 0 });
        }
        let before = self.solver.counts().pivots;
        self.hard = self.hard_from.is_some();
        let worth = Ladder::of(self.assembly, blocks.len()).effort_of_a_change();
        let mut found = if self.hard { Membership::PivotLimit } else { self.by_pivots(blocks, added, worth) };
        if found == Membership::PivotLimit {
            self.hard = true;
            if let Some(tested) = self.by_interior_point(blocks, added) {
                self.tested = Some((added, false));
                let outcome = TestOutcome { pivots: self.solver.counts().pivots - before, ..tested.outcome };
                self.otherwise = Some(tested);
                return Ok(outcome);
            }
            found = self.by_pivots(blocks, added, usize::MAX);
        }
        let pivots = self.solver.counts().pivots - before;
        if let Some(outcome) = TestOutcome::sure(found, &self.solver, pivots) {
            self.otherwise = None;
            return Ok(outcome);
        }
        let tested = by_accelerations(self.assembly, blocks)?;
        let outcome = TestOutcome { pivots: tested.outcome.pivots + pivots, ..tested.outcome };
        self.otherwise = Some(tested);
        Ok(outcome)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        match &self.otherwise {
            Some(tested) => tested.collapse.clone(),
            None => Some(certified_collapse(&self.solver, &self.rows, &self.loads)),
        }
    }

    fn descend(&mut self) {
        let Some((added, asked)) = self.tested.take() else { return };
        self.placed.push(added);
        self.marks.push(asked.then(|| self.solver.mark()));
        self.at_current = asked;
        if self.hard {
            self.hard_from.get_or_insert(self.placed.len());
        }
        self.forces.extend(self.found.take().map(|forces| (self.placed.len(), forces)));
        let bears = |takedown: &Takedown| takedown.bears(added, |below| self.bearing.contains(below));
        if self.takedown.as_ref().is_some_and(bears) {
            self.bearing.insert(added);
        }
    }

    fn backtrack(&mut self) {
        self.marks.pop();
        self.placed.pop().into_iter().for_each(|block| self.bearing.remove(block));
        self.forces.pop_if(|(blocks, _)| *blocks > self.placed.len());
        self.hard_from = self.hard_from.filter(|&from| from <= self.placed.len());
        self.at_current = false;
    }
}
