//! Where the solver of a step's problem starts: what all ways have in common.

use super::counted_solver::CountedSolver;
use crate::{
    contact::candidates::CandidateOf,
    simulate::{formulate::contact_problem::ContactProblem, kinematics::Kinematics},
};
use drystone_lcp::{Counts, LcpError, Problem, Solver, SolverState, Start, Status};
use serde::{Deserialize, Serialize};

/// A step's problem, beside that of the step before.
pub struct NextProblem<'a, S: Kinematics> {
    pub problem: &'a ContactProblem<S>,
    /// The problem of the step before, if the same solver has solved it.
    pub previous: Option<&'a ContactProblem<S>>,
    /// Bodies that did not move in the step before, fixed ones included.
    pub motionless: &'a [bool],
}

/// Where the solver of a step's problem starts. The answer is the same from everywhere.
pub trait WarmStart<S: Kinematics>: std::fmt::Debug + Send + Sync {
    /// Whether the problem is that of the step before but for q, so that its matrix need not be made.
    fn has_matrix(&self, _next: &NextProblem<'_, S>) -> bool {
        false
    }

    /// The problem of the step before, if the matrix of this one is to be made from it.
    fn last_problem(&self) -> Option<&Problem> {
        None
    }

    /// Takes the matrix of a step. Returns how many rows of the active block came with their factor.
    fn load(&mut self, next: &NextProblem<'_, S>, matrix: Problem) -> Result<usize, LcpError>;

    /// Takes the matrix of the step before, which was solved without a solver.
    fn load_solved(&mut self, matrix: Problem, solved: &Start) -> Result<(), LcpError> {
        let rows = (0..matrix.len()).collect::<Vec<_>>();
        let solver = self.counted_mut().load(matrix)?;
        solver.start_from(solved)?;
        solver.add_rows(&rows)
    }

    /// Solves it for this q, with at most so many pivots. None if they do not suffice: then all has to be forgotten.
    fn solve(&mut self, q: &[f64], pivots: usize) -> Result<Option<Status>, LcpError>;

    /// The solver that it works with, if it has one.
    fn counted(&self) -> &CountedSolver;

    /// The same, to change it.
    fn counted_mut(&mut self) -> &mut CountedSolver;

    /// The solver with the solution, after a solve.
    fn solver(&self) -> &Solver {
        self.counted().solver()
    }

    /// Rows that bear; none without a solver.
    fn active_rows(&self) -> usize {
        self.counted().active_rows()
    }

    /// All work so far.
    fn counts(&self) -> Counts {
        self.counted().counts()
    }

    /// Forgets what it took over.
    fn forget(&mut self) {
        self.counted_mut().forget();
    }

    /// Forgets what it took over, and is content with the solver's own tolerances until it forgets again.
    fn restart(&mut self) {
        self.forget();
        self.counted_mut().relaxed = true;
    }

    /// What goes into a snapshot after a step.
    fn save(&self) -> SavedStart<CandidateOf<S>>;

    /// Goes on from what was saved. `matrix` makes the problem of the step before from its q.
    fn restore(
        &mut self,
        saved: &SavedStart<CandidateOf<S>>,
        matrix: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError>;
}

/// What is kept between two steps, as it is in a snapshot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedStart<A> {
    /// With [`Reuse::Motionless`](crate::simulate::Reuse::Motionless): rows of the motionless part, their q and z.
    pub motionless: Option<MotionlessPart<A>>,
    /// With [`Reuse::Full`](crate::simulate::Reuse::Full): q and the solver's state.
    pub last: Option<(Vec<f64>, SolverState)>,
    pub relaxed: bool,
}

/// The motionless part of a step's problem with its solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionlessPart<A> {
    /// Contacts between motionless and fixed bodies, to tell whether it is still the same part.
    pub candidates: Vec<A>,
    pub q: Vec<f64>,
    pub z: Vec<f64>,
}
