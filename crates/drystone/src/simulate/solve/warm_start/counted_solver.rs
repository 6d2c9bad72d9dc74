//! The solver that goes on from step to step, and what it took.

use drystone_lcp::{Counts, LcpError, Problem, Settings, Solver};

const SOLVED: &str = "a problem is loaded before it is solved";

/// A tighter bound on violated rows than the solver's own 1e-11: what is left of a violation moves a body that should stand still.
/// In the largest scenes tried (6,000 rows) rounding leaves 2e-14.
const FEASIBLE: f64 = 1e-13;

/// Those of a solver that is relaxed, or not.
pub fn settings(relaxed: bool) -> Settings {
    let own = Settings::default();
    if relaxed { own } else { Settings { feasibility: FEASIBLE, ..own } }
}

/// The numbers of n rows.
pub fn all_rows(n: usize) -> Vec<usize> {
    (0..n).collect()
}

/// A solver, the work of those it had before, and whether it is content with the solver's own tolerances.
#[derive(Debug, Default)]
pub struct CountedSolver {
    pub solver: Option<Solver>,
    pub spent: Counts,
    pub relaxed: bool,
}

impl CountedSolver {
    /// A new solver for this problem; no row is present.
    pub fn load(&mut self, matrix: Problem) -> Result<&mut Solver, LcpError> {
        let solver = Solver::new(matrix, settings(self.relaxed))?;
        self.spent = self.counts();
        Ok(self.solver.insert(solver))
    }

    /// The solver, after a problem was loaded.
    pub fn solver(&self) -> &Solver {
        self.solver.as_ref().expect(SOLVED)
    }

    /// The same, to change it.
    pub fn solver_mut(&mut self) -> &mut Solver {
        self.solver.as_mut().expect(SOLVED)
    }

    /// Rows that bear; none without a solver.
    pub fn active_rows(&self) -> usize {
        self.solver.as_ref().map_or(0, Solver::active_rows)
    }

    /// All work so far.
    pub fn counts(&self) -> Counts {
        self.spent + self.solver.as_ref().map(Solver::counts).unwrap_or_default()
    }

    /// Drops the solver, and counts its work.
    pub fn forget(&mut self) {
        self.spent = self.counts();
        (self.solver, self.relaxed) = (None, false);
    }
}
