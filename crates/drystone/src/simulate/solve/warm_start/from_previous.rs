//! Every solve from the one before: what did not move keeps its part of the factor, its active set and its impulses.

use super::{
    counted_solver::{CountedSolver, all_rows, settings},
    start::{NextProblem, SavedStart, WarmStart},
};
use crate::{
    contact::candidates::CandidateOf,
    simulate::{formulate::contact_problem::ContactProblem, kinematics::Kinematics},
};
use drystone_lcp::{LcpError, Problem, Solver, Status};

#[derive(Debug, Default)]
pub struct FromPrevious {
    counted: CountedSolver,
}

impl<S: Kinematics> WarmStart<S> for FromPrevious {
    fn counted(&self) -> &CountedSolver {
        &self.counted
    }

    fn counted_mut(&mut self) -> &mut CountedSolver {
        &mut self.counted
    }

    fn has_matrix(&self, next: &NextProblem<'_, S>) -> bool {
        let same = |previous: &ContactProblem<S>| {
            let pairs = previous.candidates().iter().zip(next.problem.candidates());
            previous.len() == next.problem.len() && pairs.into_iter().all(|(old, new)| old.same_geometry(new))
        };
        self.counted.solver.is_some() && next.previous.is_some_and(same)
    }

    fn last_problem(&self) -> Option<&Problem> {
        self.counted.solver.as_ref().map(Solver::problem)
    }

    fn load(&mut self, next: &NextProblem<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        let rows = all_rows(matrix.len());
        let (Some(previous), Some(solver)) = (next.previous, self.counted.solver.as_mut()) else {
            let solver = self.counted.load(matrix)?;
            solver.add_rows(&rows)?;
            return Ok(0);
        };
        let kept = solver.follow(matrix, &next.problem.origins(previous))?;
        solver.add_rows(&rows)?;
        Ok(kept)
    }

    fn solve(&mut self, q: &[f64], pivots: usize) -> Result<Option<Status>, LcpError> {
        let solver = self.counted.solver_mut();
        if solver.problem().q() != q {
            solver.set_q(q)?;
        }
        solver.solve_within(pivots)
    }

    fn save(&self) -> SavedStart<CandidateOf<S>> {
        let last = self.counted.solver.as_ref().map(|solver| (solver.problem().q().to_vec(), solver.state()));
        SavedStart { motionless: None, last, relaxed: self.counted.relaxed }
    }

    fn restore(
        &mut self,
        saved: &SavedStart<CandidateOf<S>>,
        matrix: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.counted.forget();
        self.counted.relaxed = saved.relaxed;
        if let Some((q, state)) = &saved.last {
            self.counted.solver = Some(Solver::from_state(matrix(q.clone())?, settings(self.counted.relaxed), state)?);
        }
        Ok(())
    }
}
