//! `LcpSolver`: the incremental solver with its states.

use crate::{
    errors::lcp_error,
    lcp::{LcpSolution, values, whole_numbers},
};
use drystone_lcp::{Counts, LcpError, Problem, Settings, Snapshot, Solver, SparseColumns, cone::Columns};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

#[pyclass(module = "drystone._core")]
pub struct LcpSolver {
    core: Solver,
}

/// A state of an `LcpSolver`.
#[pyclass(frozen, module = "drystone._core")]
pub struct LcpSnapshot {
    core: Snapshot,
}

fn settings(pivot_limit: Option<usize>) -> Settings {
    Settings { pivot_limit, ..Settings::default() }
}

fn raised<T>(result: Result<T, LcpError>) -> PyResult<T> {
    result.map_err(|error| lcp_error(&error))
}

#[pymethods]
impl LcpSolver {
    /// M in compressed columns.
    #[new]
    #[pyo3(signature = (indptr, indices, data, q, pivot_limit=None))]
    fn new(
        py: Python<'_>,
        indptr: PyReadonlyArray1<'_, i64>,
        indices: PyReadonlyArray1<'_, i64>,
        data: PyReadonlyArray1<'_, f64>,
        q: PyReadonlyArray1<'_, f64>,
        pivot_limit: Option<usize>,
    ) -> PyResult<Self> {
        let (indptr, indices) = (whole_numbers(&indptr, "indptr")?, whole_numbers(&indices, "indices")?);
        let (data, q) = (values(&data), values(&q));
        raised(py.detach(|| {
            let m = SparseColumns::new(indptr.len().saturating_sub(1), indptr, indices, data)?;
            Ok(Self { core: Solver::new(Problem::new(m, q)?, settings(pivot_limit))? })
        }))
    }

    /// G in compressed columns; as many inverse masses and loads as G has rows.
    #[staticmethod]
    #[pyo3(signature = (indptr, indices, data, inverse_mass, h, pivot_limit=None))]
    fn from_generators(
        py: Python<'_>,
        indptr: PyReadonlyArray1<'_, i64>,
        indices: PyReadonlyArray1<'_, i64>,
        data: PyReadonlyArray1<'_, f64>,
        inverse_mass: PyReadonlyArray1<'_, f64>,
        h: PyReadonlyArray1<'_, f64>,
        pivot_limit: Option<usize>,
    ) -> PyResult<Self> {
        let (indptr, indices) = (whole_numbers(&indptr, "indptr")?, whole_numbers(&indices, "indices")?);
        let (data, inverse_mass, h) = (values(&data), values(&inverse_mass), values(&h));
        raised(py.detach(|| {
            let g = Columns::new(h.len(), &indptr, &indices, &data)?;
            Ok(Self { core: Solver::from_generators(&g, &inverse_mass, &h, settings(pivot_limit))? })
        }))
    }

    fn add_rows(&mut self, rows: PyReadonlyArray1<'_, i64>) -> PyResult<()> {
        raised(self.core.add_rows(&whole_numbers(&rows, "rows")?))
    }

    fn remove_rows(&mut self, rows: PyReadonlyArray1<'_, i64>) -> PyResult<()> {
        raised(self.core.remove_rows(&whole_numbers(&rows, "rows")?))
    }

    fn set_q(&mut self, q: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        raised(self.core.set_q(&values(&q)))
    }

    fn set_q_at(&mut self, rows: PyReadonlyArray1<'_, i64>, q: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        raised(self.core.set_q_at(&whole_numbers(&rows, "rows")?, &values(&q)))
    }

    /// Complete vectors: z = 0 on the rows that are not present.
    fn solve(&mut self, py: Python<'_>) -> PyResult<LcpSolution> {
        let core = &mut self.core;
        let solution = raised(py.detach(|| core.solve().map(|status| core.solution(status))))?;
        Ok(LcpSolution::new(py, solution))
    }

    fn snapshot(&self) -> LcpSnapshot {
        LcpSnapshot { core: self.core.snapshot() }
    }

    fn restore(&mut self, snapshot: &LcpSnapshot) -> PyResult<()> {
        raised(self.core.restore(&snapshot.core))
    }

    fn rows(&self) -> Vec<usize> {
        self.core.rows()
    }

    fn q(&self) -> Vec<f64> {
        self.core.problem().q().to_vec()
    }

    /// (major cycles, minor cycles, pivots, refactorisations, factor rows, entries solved) so far.
    fn counts(&self) -> (usize, usize, usize, usize, usize, usize) {
        let Counts { major_cycles, minor_cycles, pivots, refactorisations, factor_rows, entries_solved } =
            self.core.counts();
        (major_cycles, minor_cycles, pivots, refactorisations, factor_rows, entries_solved)
    }
}
