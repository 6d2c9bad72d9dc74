//! `lcp_solve`: matrices in compressed columns in, a checked solution out.

use crate::{arrays::vector, errors::lcp_error, watch::interruptible};
use drystone_lcp::{Block, Dantzig, LcpError, Lemke, Method, Problem, Settings, Solution, SparseColumns, Start};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::{exceptions::PyValueError, prelude::*};

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct LcpSolution {
    z: Py<PyArray1<f64>>,
    w: Py<PyArray1<f64>>,
    status: String,
    pivots: usize,
    major_cycles: usize,
    minor_cycles: usize,
    residual: f64,
    ray: Option<Py<PyArray1<f64>>>,
    refactorisations: usize,
}

impl LcpSolution {
    pub fn new(py: Python<'_>, solution: Solution) -> Self {
        Self {
            z: vector(py, solution.z).unbind(),
            w: vector(py, solution.w).unbind(),
            status: solution.status.name().to_owned(),
            pivots: solution.counts.pivots,
            major_cycles: solution.counts.major_cycles,
            minor_cycles: solution.counts.minor_cycles,
            residual: solution.residual,
            ray: solution.ray.map(|ray| vector(py, ray).unbind()),
            refactorisations: solution.counts.refactorisations,
        }
    }
}

pub fn values<T: numpy::Element + Copy>(array: &PyReadonlyArray1<'_, T>) -> Vec<T> {
    array.as_array().iter().copied().collect()
}

pub fn whole_numbers(array: &PyReadonlyArray1<'_, i64>, what: &str) -> PyResult<Vec<usize>> {
    let convert = |value: i64| {
        usize::try_from(value).map_err(|_| lcp_error(&LcpError::Structure { reason: format!("{what} holds {value}") }))
    };
    values(array).into_iter().map(convert).collect()
}

/// M in compressed columns. `start`: (indices of the sub-problem, its solution z).
#[pyfunction]
#[pyo3(signature = (indptr, indices, data, q, method, start=None, pivot_limit=None))]
#[allow(clippy::too_many_arguments)]
pub fn lcp_solve(
    py: Python<'_>,
    indptr: PyReadonlyArray1<'_, i64>,
    indices: PyReadonlyArray1<'_, i64>,
    data: PyReadonlyArray1<'_, f64>,
    q: PyReadonlyArray1<'_, f64>,
    method: &str,
    start: Option<(PyReadonlyArray1<'_, i64>, PyReadonlyArray1<'_, f64>)>,
    pivot_limit: Option<usize>,
) -> PyResult<LcpSolution> {
    let solver: Box<dyn Method + Send + Sync> = match method {
        "dantzig" => Box::new(Dantzig),
        "lemke" => Box::new(Lemke),
        "block" => Box::new(Block),
        other => {
            let message = format!("unknown method \"{other}\": give \"dantzig\", \"lemke\" or \"block\"");
            return Err(PyValueError::new_err(message));
        }
    };
    let start = match start {
        Some((rows, z)) => Some(Start { indices: whole_numbers(&rows, "the start's indices")?, z: values(&z) }),
        None => None,
    };
    let (indptr, indices) = (whole_numbers(&indptr, "indptr")?, whole_numbers(&indices, "indices")?);
    let (data, q) = (values(&data), values(&q));
    let settings = Settings { pivot_limit, ..Settings::default() };
    let solution = interruptible(py, || {
        let m = SparseColumns::new(indptr.len().saturating_sub(1), indptr, indices, data)?;
        solver.solve(&Problem::new(m, q)?, start.as_ref(), &settings)
    })?
    .map_err(|error| lcp_error(&error))?;
    Ok(LcpSolution::new(py, solution))
}
