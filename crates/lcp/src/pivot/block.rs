//! Block principal pivoting for a symmetric positive semidefinite `M`, singular or not.
//!
//! All infeasible rows are exchanged at once while that makes progress, and Dantzig's method finishes where it does
//! not. The algorithm is [`Solver::solve_by_blocks`]; this is the one-shot form that takes a whole problem.
//!
//! Kostreva, Block pivot methods for solving the complementarity problem (1978); Judice and Pires, A block principal
//! pivoting algorithm for large-scale strictly monotone linear complementarity problems (1994).

use super::{Method, dantzig::present};
use crate::{error::LcpError, problem::Problem, reuse::Start, settings::Settings, solution::Solution};

/// Block exchanges, with Dantzig's method to fall back on; see [`Solver::solve_by_blocks`](crate::Solver::solve_by_blocks).
#[derive(Debug, Clone, Copy, Default)]
pub struct Block;

impl Method for Block {
    fn name(&self) -> &'static str {
        "block"
    }

    fn solve(&self, problem: &Problem, start: Option<&Start>, settings: &Settings) -> Result<Solution, LcpError> {
        let mut solver = present(problem, start, settings)?;
        let status = solver.solve_by_blocks()?;
        Ok(solver.solution(status))
    }
}
