//! Every solve from the solution of the motionless part alone: Loomis and Balkcom's reuse.

use super::{
    cold::Cold,
    counted_solver::{CountedSolver, all_rows, settings},
    start::{MotionlessPart, NextProblem, SavedStart, WarmStart},
};
use crate::{contact::candidates::CandidateOf, simulate::kinematics::Kinematics};
use drystone_lcp::{LcpError, Problem, Solver, Start, Status};

#[derive(Debug)]
pub struct FromMotionless<S: Kinematics> {
    full: Cold,
    part: Option<MotionlessPart<CandidateOf<S>>>,
    rows: Vec<usize>,
}

impl<S: Kinematics> Default for FromMotionless<S> {
    fn default() -> Self {
        Self { full: Cold::default(), part: None, rows: Vec::new() }
    }
}

impl<S: Kinematics> FromMotionless<S> {
    /// Solves the motionless part alone unless that has been done.
    fn solve_part(&mut self, next: &NextProblem<'_, S>, problem: &Problem) -> Result<(), LcpError> {
        let still = |&k: &usize| {
            let bodies = next.problem.candidates()[k].id.bodies;
            bodies.iter().all(|&body| next.motionless[body])
        };
        let part: Vec<usize> = (0..next.problem.candidates().len()).filter(still).collect();
        self.rows = part.iter().flat_map(|&k| next.problem.rows(k)).collect();
        let candidates: Vec<_> = part.iter().map(|&k| next.problem.candidates()[k]).collect();
        let q: Vec<f64> = self.rows.iter().map(|&row| problem.q()[row]).collect();
        let known = |part: &MotionlessPart<CandidateOf<S>>| {
            let same = part.candidates.iter().zip(&candidates).all(|(old, new)| old.same_geometry(new));
            same && part.candidates.len() == candidates.len() && part.q == q
        };
        if self.part.as_ref().is_some_and(known) {
            return Ok(());
        }
        let mut solver = Solver::new(problem.principal(&self.rows), settings(self.full.counted.relaxed))?;
        solver.add_rows(&all_rows(self.rows.len()))?;
        let status = solver.solve()?;
        self.full.counted.spent = self.full.counted.spent + solver.counts();
        let z = (0..self.rows.len()).map(|row| solver.z(row)).collect();
        self.part = (status == Status::Solved).then_some(MotionlessPart { candidates, q, z });
        Ok(())
    }
}

impl<S: Kinematics> WarmStart<S> for FromMotionless<S> {
    fn counted(&self) -> &CountedSolver {
        &self.full.counted
    }

    fn counted_mut(&mut self) -> &mut CountedSolver {
        &mut self.full.counted
    }

    fn load(&mut self, next: &NextProblem<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        self.solve_part(next, &matrix)?;
        WarmStart::<S>::load(&mut self.full, next, matrix)
    }

    fn solve(&mut self, q: &[f64], pivots: usize) -> Result<Option<Status>, LcpError> {
        let Some(part) = &self.part else { return WarmStart::<S>::solve(&mut self.full, q, pivots) };
        let solver = self.full.counted.solver_mut();
        solver.clear();
        solver.set_q(q)?;
        let start = Start { indices: self.rows.clone(), z: part.z.clone() };
        match solver.start_from(&start) {
            Ok(()) => {
                solver.add_rows(&all_rows(q.len()))?;
                solver.solve_within(pivots)
            }
            // The part's q has changed since: sliding speeds are corrected on the way.
            Err(LcpError::Start(_)) => WarmStart::<S>::solve(&mut self.full, q, pivots),
            Err(error) => Err(error),
        }
    }

    fn forget(&mut self) {
        self.full.counted.forget();
        self.part = None;
    }

    fn save(&self) -> SavedStart<CandidateOf<S>> {
        SavedStart { motionless: self.part.clone(), last: None, relaxed: self.full.counted.relaxed }
    }

    fn restore(
        &mut self,
        saved: &SavedStart<CandidateOf<S>>,
        _: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.forget();
        self.part.clone_from(&saved.motionless);
        self.full.counted.relaxed = saved.relaxed;
        Ok(())
    }
}
