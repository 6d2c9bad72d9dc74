//! The stability tests of the planner: does this sub-assembly stand?

use super::collapse::Collapse;
use crate::{
    crossover::or_from_interior,
    equilibrium::{collapse_motion, with_work},
    error::SceneError,
    formulate::{Assembly, BlockSet, Components},
    judgement::{Judgement, judge, moving_blocks},
};
use drystone_lcp::{
    LcpError, Settings, Snapshot, Solver, Status,
    cone::{ConeSolver, Membership},
};

/// What one test said, and what it cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TestOutcome {
    /// Whether the sub-assembly stands.
    pub stands: bool,
    /// Neither is proved, that it stands or that it falls; it is not taken for one that stands.
    pub borderline: bool,
    /// Pivots made.
    pub pivots: usize,
}

/// Why a search could not go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The scene is not a valid assembly.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A stability test gave no answer.
    #[error("the stability test gave no answer on a sub-assembly of {blocks} blocks: {reason}")]
    NoAnswer {
        /// Blocks in the sub-assembly.
        blocks: usize,
        /// What the test said.
        reason: String,
    },
    /// The user interrupted a test from outside this crate; the search ends with the best so far.
    #[error("the stability test was interrupted")]
    Interrupted,
    /// A test from outside this crate failed with its own error.
    #[error("the stability test failed: {0}")]
    External(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// A stability test that follows the search. The search tells it where it stands: it tests a block on top of the
/// current sub-assembly, and moves to the one just tested or back from it.
pub trait StabilityTest {
    /// Told before each test which sub-assemblies the search is likely to ask about: the next one, and those after it as
    /// long as each stands. A test may answer them ahead; asking for more of them than it needs is a waste.
    fn foresee(&mut self, _likely: &mut dyn Iterator<Item = BlockSet>) {}

    /// Tests the current sub-assembly with `added` put on; `blocks` holds `added` already.
    ///
    /// # Errors
    /// [`PlanError`] if no answer can be given.
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError>;

    /// Puts `added` on the current sub-assembly, whether that stands or not, and moves there: more comes together with it. Returns
    /// the pivots made.
    ///
    /// # Errors
    /// [`PlanError`] if that cannot be done.
    fn carry(&mut self, blocks: &BlockSet, added: usize) -> Result<usize, PlanError> {
        let outcome = self.test(blocks, added)?;
        self.descend();
        Ok(outcome.pivots)
    }

    /// Whether this test finds a collapse motion of what falls.
    fn explains(&self) -> bool {
        false
    }

    /// The collapse motion of the sub-assembly just tested, which falls, if this test finds one.
    fn collapse(&self) -> Option<Collapse> {
        None
    }

    /// The same test at the bare supports, of one that is not about the assembly's own loads; None if it is.
    fn anew(&self) -> Option<Box<dyn StabilityTest + '_>> {
        None
    }

    /// Where blocks may be held: collapse motions of the sub-assembly just tested, so many that no hold stops all of them.
    fn collapses_however_held(&self) -> &[Collapse] {
        &[]
    }

    /// The sub-assembly just tested, which stands, becomes the current one.
    fn descend(&mut self) {}

    /// The current sub-assembly's parent becomes the current one.
    fn backtrack(&mut self) {}
}

/// The tests of this crate by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Test {
    /// Dantzig's method from scratch.
    Lcp,
    /// Forces of the stable parent, on a basis of the generators that follows the search.
    Reuse,
    /// Dantzig's method from the solution of the stable parent, as in the paper.
    ReuseDantzig,
}

pub(super) fn solver_for(assembly: &Assembly) -> Solver {
    Solver::new(assembly.problem(), Settings::default()).expect("A = G' M^-1 G is symmetric with a positive diagonal")
}

impl TestOutcome {
    /// What the answer of a solver means. None if it is none, or in doubt for no more than rounding: then accelerations, and the
    /// forces under them, may prove what its own do not.
    pub(super) fn sure(found: Membership, solver: &ConeSolver, pivots: usize) -> Option<Self> {
        let at_a_limit = solver.doubt().is_none_or(|doubt| doubt.is_at_a_limit());
        Self::of(found, pivots).filter(|outcome| !outcome.borderline || at_a_limit)
    }

    /// What an answer means. None if it is none.
    pub(super) fn of(found: Membership, pivots: usize) -> Option<Self> {
        let (stands, borderline) = match found {
            Membership::Inside => (true, false),
            Membership::Outside => (false, false),
            Membership::Borderline => (false, true),
            _ => return None,
        };
        Some(Self { stands, borderline, pivots })
    }
}

/// What a test by the complementarity problem has found, and how it falls if it does.
#[derive(Debug)]
pub(super) struct Tested {
    pub outcome: TestOutcome,
    pub collapse: Option<Collapse>,
}

impl Tested {
    /// It falls so.
    pub fn falling(collapse: Collapse) -> Self {
        let outcome = TestOutcome { stands: false, borderline: false, pivots: 0 };
        Self { outcome, collapse: Some(collapse) }
    }
}

/// What accelerations say of a sub-assembly where an equilibrium solver has no answer (as in `check.rs`).
pub(super) fn by_accelerations(assembly: &Assembly, blocks: &BlockSet) -> Result<Tested, PlanError> {
    let mut solver = solver_for(assembly);
    solver.add_rows(&assembly.rows(blocks)).expect("rows of this assembly's problem");
    solve(assembly, &mut solver, blocks)
}

/// Solves what is present by Dantzig's method, and reads the answer.
fn solve(assembly: &Assembly, solver: &mut Solver, blocks: &BlockSet) -> Result<Tested, PlanError> {
    solve_by(Solver::solve, assembly, solver, blocks)
}

/// Solves what is present by one of the solver's methods, and reads the answer.
pub(super) fn solve_by(
    method: impl FnOnce(&mut Solver) -> Result<Status, LcpError>,
    assembly: &Assembly,
    solver: &mut Solver,
    blocks: &BlockSet,
) -> Result<Tested, PlanError> {
    let before = solver.counts().pivots;
    let no_answer = |reason: String| PlanError::NoAnswer { blocks: blocks.len(), reason };
    let status = method(solver).map_err(|error| no_answer(error.to_string()))?;
    let moving = assembly.moving(blocks, |j| solver.z(j));
    let judgement = match status {
        Status::Solved => judge(assembly, blocks, &moving),
        _ => Judgement::by_equilibrium(assembly, blocks),
    };
    let judgement = or_from_interior(judgement, assembly, blocks);
    let outcome = TestOutcome::of(judgement.found(), solver.counts().pivots - before)
        .ok_or_else(|| no_answer(format!("{} (residual {:.1e})", status.name(), solver.residual())))?;
    let collapse = match judgement {
        Judgement::Falls => Some(collapse_of(assembly, moving_blocks(assembly, &moving))),
        Judgement::ByEquilibrium(Membership::Outside, equilibrium) => {
            Some(collapse_of(assembly, collapse_motion(assembly, &equilibrium)))
        }
        _ => None,
    };
    Ok(Tested { outcome, collapse })
}

/// A motion v of a fall is a collapse motion: `G' v >= 0` and `F' v > 0`. Accelerations are one (`F' v = v' M v`).
pub(super) fn collapse_of(assembly: &Assembly, motion: impl IntoIterator<Item = (usize, Components)>) -> Collapse {
    Collapse::new(with_work(assembly, motion))
}

/// Every test solves its sub-assembly from scratch.
#[derive(Debug)]
pub struct FromScratch<'a> {
    assembly: &'a Assembly,
    solver: Solver,
    collapse: Option<Collapse>,
}

impl<'a> FromScratch<'a> {
    /// Analyses the complete assembly.
    pub fn new(assembly: &'a Assembly) -> Self {
        Self { assembly, solver: solver_for(assembly), collapse: None }
    }
}

impl StabilityTest for FromScratch<'_> {
    fn test(&mut self, blocks: &BlockSet, _added: usize) -> Result<TestOutcome, PlanError> {
        self.solver.clear();
        self.solver.add_rows(&self.assembly.rows(blocks)).expect("rows of this assembly's problem");
        let tested = solve(self.assembly, &mut self.solver, blocks)?;
        self.collapse = tested.collapse;
        Ok(tested.outcome)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.collapse.clone()
    }
}

/// Every test runs Dantzig's method from the solution of the stable sub-assembly without the block just added: the
/// paper's algorithm. The factor of the active block of `A` follows the search.
#[derive(Debug)]
pub struct ReuseDantzig<'a> {
    assembly: &'a Assembly,
    solver: Solver,
    /// States of the current sub-assembly and its ancestors, the current one last.
    path: Vec<Snapshot>,
    at_current: bool,
    collapse: Option<Collapse>,
}

impl<'a> ReuseDantzig<'a> {
    /// Analyses the complete assembly; the current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly) -> Self {
        let solver = solver_for(assembly);
        Self { assembly, path: vec![solver.snapshot()], solver, at_current: true, collapse: None }
    }
}

impl StabilityTest for ReuseDantzig<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        if !self.at_current
            && let Some(current) = self.path.last()
        {
            self.solver.restore(current).expect("a snapshot of this solver");
        }
        self.at_current = false;
        self.solver.add_rows(&self.assembly.rows_added(blocks, added)).expect("rows of this assembly's problem");
        let tested = solve(self.assembly, &mut self.solver, blocks)?;
        self.collapse = tested.collapse;
        Ok(tested.outcome)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.collapse.clone()
    }

    fn descend(&mut self) {
        self.path.push(self.solver.snapshot());
        self.at_current = true;
    }

    fn backtrack(&mut self) {
        self.path.pop();
        self.at_current = false;
    }
}
