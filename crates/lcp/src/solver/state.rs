//! A solver's whole state as plain numbers, to be written down and taken up elsewhere.

use super::{Role, Solver};
use crate::{error::LcpError, factor::FactorNumbers, problem::Problem, settings::Settings};
use serde::{Deserialize, Serialize};

/// All that a [`Solver`] knows beyond its problem and settings, factor included: a solver made of it goes on bit for bit like
/// the one it was taken from. Work counts are not part of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolverState {
    role: Vec<Role>,
    /// Scaled.
    z: Vec<f64>,
    /// In the order of the active set, which is the order of its sums.
    active: Vec<usize>,
    driven: Option<usize>,
    settled: bool,
    factor: FactorNumbers,
}

impl Solver {
    /// The state, to be taken up with [`Self::from_state`] and the same problem.
    pub fn state(&self) -> SolverState {
        SolverState {
            role: self.role.clone(),
            z: self.z.clone(),
            active: self.active.members().to_vec(),
            driven: self.driven,
            settled: self.settled,
            factor: self.factor.numbers(),
        }
    }

    /// A solver of the problem, `q` included, that the state was taken with.
    ///
    /// # Errors
    /// [`LcpError::ForeignState`] if sizes do not fit; as [`Self::new`].
    pub fn from_state(problem: Problem, settings: Settings, state: &SolverState) -> Result<Self, LcpError> {
        let mut solver = Self::new(problem, settings)?;
        let n = solver.role.len();
        let foreign = |reason: &str| LcpError::ForeignState { reason: reason.to_owned() };
        if state.role.len() != n || state.z.len() != n {
            return Err(foreign("it has another number of rows"));
        }
        if state.active.iter().chain(&state.driven).any(|&i| i >= n) {
            return Err(foreign("it names a row that the problem does not have"));
        }
        if !solver.factor.take_numbers(&state.factor) || solver.factor.len() != state.active.len() {
            return Err(foreign("its factor is one of another matrix"));
        }
        state.active.iter().for_each(|&i| solver.active.insert(i));
        solver.role.copy_from_slice(&state.role);
        solver.z.copy_from_slice(&state.z);
        (solver.driven, solver.settled) = (state.driven, state.settled);
        solver.measure_q();
        solver.recompute_w();
        Ok(solver)
    }
}
