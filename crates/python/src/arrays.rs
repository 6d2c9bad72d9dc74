//! NumPy arrays in and out.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

pub fn vector<'py, T: numpy::Element>(py: Python<'py>, values: Vec<T>) -> Bound<'py, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}

/// Rows of equal length as a (rows, N) array, also when there are none.
pub fn matrix<'py, const N: usize>(py: Python<'py>, rows: &[[f64; N]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_iter(py, rows.iter().flatten().copied()).reshape([rows.len(), N])
}
