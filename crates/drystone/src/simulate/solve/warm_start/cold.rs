//! Every solve from nothing.

use super::{
    counted_solver::{CountedSolver, all_rows},
    start::{NextProblem, SavedStart, WarmStart},
};
use crate::{contact::candidates::CandidateOf, simulate::kinematics::Kinematics};
use drystone_lcp::{LcpError, Problem, Status};

#[derive(Debug, Default)]
pub struct Cold {
    pub counted: CountedSolver,
}

impl<S: Kinematics> WarmStart<S> for Cold {
    fn counted(&self) -> &CountedSolver {
        &self.counted
    }

    fn counted_mut(&mut self) -> &mut CountedSolver {
        &mut self.counted
    }

    fn load(&mut self, _: &NextProblem<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        self.counted.load(matrix)?;
        Ok(0)
    }

    fn solve(&mut self, q: &[f64], pivots: usize) -> Result<Option<Status>, LcpError> {
        let solver = self.counted.solver_mut();
        solver.clear();
        solver.set_q(q)?;
        solver.add_rows(&all_rows(q.len()))?;
        solver.solve_within(pivots)
    }

    fn save(&self) -> SavedStart<CandidateOf<S>> {
        SavedStart { motionless: None, last: None, relaxed: self.counted.relaxed }
    }

    fn restore(
        &mut self,
        saved: &SavedStart<CandidateOf<S>>,
        _: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.counted.forget();
        self.counted.relaxed = saved.relaxed;
        Ok(())
    }
}
