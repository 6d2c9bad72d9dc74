//! `contact_solve`: one step's contact problem by its matrices.

use crate::{
    arrays::vector,
    errors::contact_error,
    lcp::{values, whole_numbers},
    watch::interruptible,
};
use drystone_contact::{Matrices, Settings, Solution};
use drystone_lcp::{LcpError, SparseColumns, cone::Columns};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct ContactSolution {
    impulses: Py<PyArray1<f64>>,
    velocities: Py<PyArray1<f64>>,
    error: f64,
    tolerance: f64,
    status: String,
    islands: usize,
    sweeps: usize,
    newton_steps: usize,
}

impl ContactSolution {
    fn new(py: Python<'_>, solution: Solution) -> Self {
        Self {
            impulses: vector(py, solution.impulses).unbind(),
            velocities: vector(py, solution.velocities).unbind(),
            error: solution.error,
            tolerance: solution.tolerance,
            status: solution.status.name().to_owned(),
            islands: solution.counts.islands,
            sweeps: solution.counts.sweeps,
            newton_steps: solution.counts.newton_steps,
        }
    }
}

type Compressed<'py> = (PyReadonlyArray1<'py, i64>, PyReadonlyArray1<'py, i64>, PyReadonlyArray1<'py, f64>);

/// `mass`: M in compressed columns; `jacobian`: J in compressed rows.
#[pyfunction]
#[pyo3(signature = (dimension, mass, jacobian, friction, free, offset, start=None, tolerance=None, scale=0.0))]
#[allow(clippy::too_many_arguments)]
pub fn contact_solve(
    py: Python<'_>,
    dimension: usize,
    mass: Compressed<'_>,
    jacobian: Compressed<'_>,
    friction: PyReadonlyArray1<'_, f64>,
    free: PyReadonlyArray1<'_, f64>,
    offset: PyReadonlyArray1<'_, f64>,
    start: Option<PyReadonlyArray1<'_, f64>>,
    tolerance: Option<f64>,
    scale: f64,
) -> PyResult<ContactSolution> {
    let arrays = |(indptr, indices, data): &Compressed<'_>, what: &str| -> PyResult<_> {
        Ok((whole_numbers(indptr, what)?, whole_numbers(indices, what)?, values(data)))
    };
    let (mass, jacobian) = (arrays(&mass, "M")?, arrays(&jacobian, "J")?);
    let (friction, free, offsets) = (values(&friction), values(&free), values(&offset));
    let start = start.map(|start| values(&start));
    let settings = Settings { tolerance, scale, ..Settings::default() };
    let solution = interruptible(py, || {
        let named = |what: &str, error: LcpError| match error {
            LcpError::MatrixNotFinite { row, column, value } => {
                // J's rows are the core's columns.
                let (row, column) = if what == "J" { (column, row) } else { (row, column) };
                format!("{what}[{row}, {column}] is {value}: every entry must be finite")
            }
            error => format!("{what}: {error}"),
        };
        let (indptr, indices, data) = mass;
        let mass = SparseColumns::new(free.len(), indptr, indices, data).map_err(|error| named("M", error))?;
        let (indptr, indices, data) = jacobian;
        let jacobian = Columns::new(free.len(), &indptr, &indices, &data).map_err(|error| named("J", error))?;
        let problem = Matrices { dimension, mass, jacobian, friction, free, offsets };
        problem.solve(start.as_deref(), &settings).map_err(|error| error.to_string())
    })?;
    Ok(ContactSolution::new(py, solution.map_err(contact_error)?))
}
