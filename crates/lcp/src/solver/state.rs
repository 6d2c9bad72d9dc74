//! A solver's whole state as plain numbers, to be written down and taken up elsewhere.

use super::{Role, Solver};
use crate::{
    counts::Counts,
    error::LcpError,
    factor::FactorNumbers,
    matrix::SparseColumns,
    problem::Problem,
    sealed::{Seal, SealError},
    settings::Settings,
};
use serde::{Deserialize, Serialize};

/// All that a [`Solver`] knows beyond its problem and settings, factor included: a solver made of it goes on bit for bit like
/// the one it was taken from. Work counts are not part of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolverState {
    role: Vec<Role>,
    /// Scaled.
    z: Vec<f64>,
    /// Scaled.
    w: Vec<f64>,
    /// In the order of the active set, which is the order of its sums.
    active: Vec<usize>,
    driven: Option<usize>,
    settled: bool,
    factor: FactorNumbers,
}

const SEAL: Seal = Seal { kind: *b"DS-LCPSO", version: 1 };

/// A solver with its problem.
#[derive(Serialize, Deserialize)]
struct Whole {
    indptr: Vec<usize>,
    indices: Vec<usize>,
    data: Vec<f64>,
    q: Vec<f64>,
    gram: bool,
    settings: Settings,
    state: SolverState,
    counts: Counts,
}

impl Solver {
    /// The state, to be taken up with [`Self::from_state`] and the same problem.
    pub fn state(&self) -> SolverState {
        SolverState {
            role: self.role.clone(),
            z: self.z.clone(),
            w: self.w.clone(),
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
        if [state.role.len(), state.z.len(), state.w.len()] != [n; 3] {
            return Err(foreign("it has another number of rows"));
        }
        if state.active.iter().chain(&state.driven).any(|&i| i >= n) {
            return Err(foreign("it names a row that the problem does not have"));
        }
        state.active.iter().for_each(|&i| solver.active.insert(i));
        if solver.active.members().len() != state.active.len() {
            return Err(foreign("a row of it is active twice"));
        }
        let fits = solver.factor.take_numbers(&state.factor) && solver.factor.rows() == ascending(&state.active);
        if !fits {
            return Err(foreign("its factor is one of another matrix"));
        }
        solver.role.copy_from_slice(&state.role);
        solver.z.copy_from_slice(&state.z);
        solver.w.copy_from_slice(&state.w);
        (solver.driven, solver.settled) = (state.driven, state.settled);
        solver.measure_q();
        Ok(solver)
    }

    /// The solver with its problem as bytes, to go on from with [`Self::from_bytes`].
    pub fn to_bytes(&self) -> Vec<u8> {
        let (m, q) = (self.problem.m(), self.problem.q().to_vec());
        SEAL.close(&Whole {
            indptr: m.indptr().to_vec(),
            indices: m.indices().to_vec(),
            data: m.data().to_vec(),
            q,
            gram: self.problem.is_gram(),
            settings: self.settings.clone(),
            state: self.state(),
            counts: self.counts,
        })
    }

    /// The solver again: what goes on from it goes on bit for bit. Snapshots of the first are foreign to it.
    ///
    /// # Errors
    /// [`LcpError::ForeignState`] for anything but what [`Self::to_bytes`] gave.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LcpError> {
        let whole: Whole = SEAL.open(bytes).map_err(|error: SealError| foreign(&error.to_string()))?;
        let Whole { indptr, indices, data, q, gram, settings, state, counts } = whole;
        let m = SparseColumns::new(q.len(), indptr, indices, data)?;
        let problem = if gram { Problem::of_gram(m, q)? } else { Problem::new(m, q)? };
        let mut solver = Self::from_state(problem, settings, &state)?;
        (solver.counts, solver.counts_at_solve) = (counts, counts);
        Ok(solver)
    }
}

fn foreign(reason: &str) -> LcpError {
    LcpError::ForeignState { reason: reason.to_owned() }
}

fn ascending(rows: &[usize]) -> Vec<usize> {
    let mut rows = rows.to_vec();
    rows.sort_unstable();
    rows
}
