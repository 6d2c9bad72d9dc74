//! What a step leaves to the next one, to start from.

use super::{
    active_rows::ActiveRows,
    step_problem::Motion,
    warm_start::{WarmStart, warm_start},
};
use crate::{
    contact::candidates::CandidateOf,
    simulate::{
        formulate::contact_problem::ContactProblem,
        kinematics::Kinematics,
        options::{Options, Reuse},
    },
};
use drystone_lcp::{LcpError, Start};
use serde::{Deserialize, Serialize};

/// The problem of the last step, if it was solved, and its solution.
#[derive(Debug)]
pub struct PreviousStep<S: Kinematics> {
    pub problem: Option<ContactProblem<S>>,
    /// Sliding speed at each of its contacts, m/s.
    pub sliding: Vec<f64>,
    /// Impulse at each of its contacts, in world axes, N s.
    pub impulses: Vec<S::Vector>,
    /// Steps that the last one was made in; the impulses are of the last of them.
    pub substeps: usize,
    /// On the acceleration level with full reuse: where solves of islands with sliding contacts start.
    pub active_rows: ActiveRows,
    /// The solution, where no solver was made for it.
    pub at_rest: Option<RestSolution>,
    /// The solver of pivots, with what it takes over.
    pub solver: Box<dyn WarmStart<S>>,
}

/// The solution of the problem of a step at rest, for which no solver was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RestSolution {
    /// Rows that bear, with their impulses.
    pub start: Start,
    pub q: Vec<f64>,
}

impl<S: Kinematics> PreviousStep<S> {
    /// There was none.
    pub fn none(reuse: Reuse) -> Self {
        Self {
            problem: None,
            sliding: Vec::new(),
            impulses: Vec::new(),
            substeps: 1,
            active_rows: ActiveRows::default(),
            at_rest: None,
            solver: warm_start(reuse),
        }
    }

    /// Drops everything but the counts of the work done.
    pub fn forget(&mut self) {
        self.forget_pivots();
        self.problem = None;
        self.sliding.clear();
        self.impulses.clear();
        self.active_rows = ActiveRows::default();
    }

    /// Drops what pivots would take over: it is not of the step that was solved last.
    pub fn forget_pivots(&mut self) {
        self.solver.forget();
        self.at_rest = None;
    }

    /// Takes a solve of this step for the step before: the next one solves the same step again.
    pub fn take(&mut self, contacts: &ContactProblem<S>, motion: &Motion<S>) {
        self.problem = Some(contacts.clone());
        self.sliding.clone_from(&motion.sliding);
        self.impulses.clone_from(&motion.impulses);
    }

    /// The rows of some contacts.
    pub fn formulate(&self, contacts: Vec<CandidateOf<S>>, options: &Options, gravity: S::Vector) -> ContactProblem<S> {
        ContactProblem::after(self.problem.as_ref(), contacts, options.cones, gravity)
    }

    /// Makes a solver for a step that was solved without one: the next step differs from it. Where more rows bear than can be
    /// independent, as in a load takedown, `other` is asked for a solution on fewer: pivots that follow are fewer then.
    pub fn make_solver_at_rest(
        &mut self,
        inverse_mass: &[S::Velocity],
        other: impl FnOnce(&ContactProblem<S>, &Start) -> Option<Start>,
    ) -> Result<(), LcpError> {
        let Some((problem, RestSolution { start, q })) = self.problem.as_ref().zip(self.at_rest.take()) else {
            return Ok(());
        };
        let most = inverse_mass.iter().flat_map(|inverse| inverse.as_ref()).filter(|entry| **entry > 0.0).count();
        let fewer = if start.indices.len() > most { other(problem, &start) } else { None };
        match self.solver.load_solved(problem.problem(inverse_mass, q)?, &fewer.unwrap_or(start)) {
            // Its rows depend on one another, or nearly: this solve begins from nothing.
            Err(LcpError::Start(_)) => {
                self.forget();
                Ok(())
            }
            done => done,
        }
    }

    /// Sliding speeds of the step before at the contacts that are still there; those up to `least` count as none.
    pub fn sliding_at(&self, problem: &ContactProblem<S>, least: f64) -> Vec<f64> {
        let Some(before) = &self.problem else { return vec![0.0; problem.candidates().len()] };
        let speeds = problem.matches(before).map(|(_, old)| old.map_or(0.0, |old| self.sliding[old]));
        speeds.map(|s| if s > least { s } else { 0.0 }).collect()
    }
}
