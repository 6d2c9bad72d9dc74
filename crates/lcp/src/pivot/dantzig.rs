//! Dantzig's principal pivoting for a symmetric positive semidefinite `M`, singular or not.
//!
//! Cottle and Dantzig, Complementary pivot theory of mathematical programming (1968). The algorithm itself is
//! [`Solver`]; this is the one-shot form that takes a whole problem.

use super::Method;
use crate::{error::LcpError, problem::Problem, reuse::Start, settings::Settings, solution::Solution, solver::Solver};

/// Principal pivoting with major and minor cycles; see [`Solver`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Dantzig;

impl Method for Dantzig {
    fn name(&self) -> &'static str {
        "dantzig"
    }

    fn solve(&self, problem: &Problem, start: Option<&Start>, settings: &Settings) -> Result<Solution, LcpError> {
        let mut solver = present(problem, start, settings)?;
        let status = solver.solve()?;
        Ok(solver.solution(status))
    }
}

/// A solver with every row of the problem, started from a sub-problem's solution if one is given.
pub(super) fn present(problem: &Problem, start: Option<&Start>, settings: &Settings) -> Result<Solver, LcpError> {
    let mut solver = Solver::new(problem.clone(), settings.clone())?;
    if let Some(start) = start {
        solver.start_from(start)?;
    }
    let rows: Vec<usize> = (0..problem.len()).collect();
    solver.add_rows(&rows)?;
    Ok(solver)
}
