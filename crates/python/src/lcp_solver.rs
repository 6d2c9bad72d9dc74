//! `LcpSolver`: the incremental solver with its states.

use crate::{
    errors::lcp_error,
    guard::Guarded,
    lcp::{LcpSolution, values, whole_numbers},
    watch::interruptible,
};
use drystone_lcp::{Counts, LcpError, Problem, Settings, Snapshot, Solver, SparseColumns, cone::Columns};
use numpy::PyReadonlyArray1;
use pyo3::{prelude::*, types::PyBytes};

#[pyclass(frozen, module = "drystone._core")]
pub struct LcpSolver {
    core: Guarded<Solver>,
}

impl LcpSolver {
    fn of(core: Solver) -> Self {
        Self { core: Guarded::new("Solver", core) }
    }
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
        raised(interruptible(py, || {
            let m = SparseColumns::new(indptr.len().saturating_sub(1), indptr, indices, data)?;
            Ok(Self::of(Solver::new(Problem::new(m, q)?, settings(pivot_limit))?))
        })?)
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
        raised(interruptible(py, || {
            let g = Columns::new(h.len(), &indptr, &indices, &data)?;
            Ok(Self::of(Solver::from_generators(&g, &inverse_mass, &h, settings(pivot_limit))?))
        })?)
    }

    fn add_rows(&self, py: Python<'_>, rows: PyReadonlyArray1<'_, i64>) -> PyResult<()> {
        let (rows, mut guard) = (whole_numbers(&rows, "rows")?, self.core.write()?);
        let core = &mut *guard;
        raised(interruptible(py, || core.add_rows(&rows))?)
    }

    fn remove_rows(&self, py: Python<'_>, rows: PyReadonlyArray1<'_, i64>) -> PyResult<()> {
        let (rows, mut guard) = (whole_numbers(&rows, "rows")?, self.core.write()?);
        let core = &mut *guard;
        raised(interruptible(py, || core.remove_rows(&rows))?)
    }

    fn set_q(&self, q: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        raised(self.core.write()?.set_q(&values(&q)))
    }

    fn set_q_at(&self, rows: PyReadonlyArray1<'_, i64>, q: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        raised(self.core.write()?.set_q_at(&whole_numbers(&rows, "rows")?, &values(&q)))
    }

    /// Complete vectors: z = 0 on the rows that are not present.
    fn solve(&self, py: Python<'_>) -> PyResult<LcpSolution> {
        let mut guard = self.core.write()?;
        let core = &mut *guard;
        let solution = raised(interruptible(py, || core.solve().map(|status| core.solution(status)))?)?;
        Ok(LcpSolution::new(py, solution))
    }

    fn snapshot(&self) -> PyResult<LcpSnapshot> {
        Ok(LcpSnapshot { core: self.core.read()?.snapshot() })
    }

    fn restore(&self, py: Python<'_>, snapshot: &LcpSnapshot) -> PyResult<()> {
        let mut guard = self.core.write()?;
        let core = &mut *guard;
        raised(interruptible(py, || core.restore(&snapshot.core))?)
    }

    fn rows(&self) -> PyResult<Vec<usize>> {
        Ok(self.core.read()?.rows())
    }

    fn q(&self) -> PyResult<Vec<f64>> {
        Ok(self.core.read()?.problem().q().to_vec())
    }

    /// (major cycles, minor cycles, pivots, refactorisations, factor rows, entries solved) so far.
    #[allow(clippy::type_complexity)]
    fn counts(&self) -> PyResult<(usize, usize, usize, usize, usize, usize)> {
        let Counts { major_cycles, minor_cycles, pivots, refactorisations, factor_rows, entries_solved } =
            self.core.read()?.counts();
        Ok((major_cycles, minor_cycles, pivots, refactorisations, factor_rows, entries_solved))
    }

    fn copy(&self) -> PyResult<Self> {
        Ok(Self::of(self.core.read()?.clone()))
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.core.read()?.to_bytes()))
    }

    #[staticmethod]
    fn from_bytes(state: &[u8]) -> PyResult<Self> {
        raised(Solver::from_bytes(state).map(Self::of))
    }
}
