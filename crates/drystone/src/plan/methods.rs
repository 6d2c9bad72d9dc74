//! Stability tests by methods that the planner does not use, for the comparison of section VI of Loomis and Balkcom
//! (2006): block principal pivoting and Lemke's method, from scratch and started from the stable parent's solution.

use super::stability::{PlanError, StabilityTest, TestOutcome, solve_by, solver_for};
use crate::{
    formulate::{Assembly, BlockSet},
    judgement::judge,
};
use drystone_lcp::{Lemke, Method, Problem, Settings, Snapshot, Solver, Start, Status};

/// Block principal pivoting. With reuse the factor of the active block follows the search, as in
/// [`ReuseDantzig`](super::ReuseDantzig).
#[derive(Debug)]
pub struct ByBlocks<'a> {
    assembly: &'a Assembly,
    solver: Solver,
    reuse: bool,
    /// States of the current sub-assembly and its ancestors, the current one last. With reuse only.
    path: Vec<Snapshot>,
    at_current: bool,
}

impl<'a> ByBlocks<'a> {
    /// Analyses the complete assembly; the current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly, reuse: bool) -> Self {
        let solver = solver_for(assembly);
        Self { assembly, path: vec![solver.snapshot()], solver, reuse, at_current: true }
    }
}

impl StabilityTest for ByBlocks<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let rows = match self.path.last() {
            Some(current) if self.reuse => {
                if !self.at_current {
                    self.solver.restore(current).expect("a snapshot of this solver");
                }
                self.assembly.rows_added(blocks, added)
            }
            _ => {
                self.solver.clear();
                self.assembly.rows(blocks)
            }
        };
        self.at_current = false;
        self.solver.add_rows(&rows).expect("rows of this assembly's problem");
        Ok(solve_by(Solver::solve_by_blocks, self.assembly, &mut self.solver, blocks)?.outcome)
    }

    fn descend(&mut self) {
        if self.reuse {
            self.path.push(self.solver.snapshot());
            self.at_current = true;
        }
    }

    fn backtrack(&mut self) {
        if self.reuse {
            self.path.pop();
            self.at_current = false;
        }
    }
}

/// Lemke's method. With reuse it begins at the basis of the parent's solution; the inverse of that basis is computed anew
/// for every test.
#[derive(Debug)]
pub struct ByLemke<'a> {
    assembly: &'a Assembly,
    problem: Problem,
    reuse: bool,
    /// Solutions of the current sub-assembly and its ancestors, on rows of the complete problem, the current one last.
    path: Vec<Start>,
    /// The solution of the sub-assembly tested last, if it was found.
    found: Option<Start>,
}

impl<'a> ByLemke<'a> {
    /// Formulates the complete assembly; the current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly, reuse: bool) -> Self {
        let nothing = Start { indices: Vec::new(), z: Vec::new() };
        Self { assembly, problem: assembly.problem(), reuse, path: vec![nothing], found: None }
    }

    /// The parent's solution on the rows of a part, which are ascending and hold all of its own.
    fn start(&self, rows: &[usize]) -> Option<Start> {
        let current = self.path.last().filter(|_| self.reuse)?;
        let place = |row: &usize| rows.binary_search(row).expect("a sub-assembly has the rows of its parent");
        Some(Start { indices: current.indices.iter().map(place).collect(), z: current.z.clone() })
    }
}

impl StabilityTest for ByLemke<'_> {
    fn test(&mut self, blocks: &BlockSet, _added: usize) -> Result<TestOutcome, PlanError> {
        self.found = None;
        let rows = self.assembly.rows(blocks);
        let no_answer = |reason: String| PlanError::NoAnswer { blocks: blocks.len(), reason };
        let solution = Lemke
            .solve(&self.problem.principal(&rows), self.start(&rows).as_ref(), &Settings::default())
            .map_err(|error| no_answer(error.to_string()))?;
        if solution.status != Status::Solved {
            return Err(no_answer(format!("{} (residual {:.1e})", solution.status.name(), solution.residual)));
        }
        let force = |j: usize| rows.binary_search(&j).map_or(0.0, |place| solution.z[place]);
        let found = judge(self.assembly, blocks, &self.assembly.moving(blocks, force)).found();
        let outcome = TestOutcome::of(found, solution.counts.pivots)
            .ok_or_else(|| no_answer(format!("{found:?} (residual {:.1e})", solution.residual)))?;
        self.found = Some(Start { indices: rows, z: solution.z });
        Ok(outcome)
    }

    fn descend(&mut self) {
        // Without a solution the parent's still is one of a sub-problem.
        let current = self.found.take().or_else(|| self.path.last().cloned());
        self.path.extend(current);
    }

    fn backtrack(&mut self) {
        self.path.pop();
    }
}
