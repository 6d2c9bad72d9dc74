//! NumPy arrays in and out.

use drystone::geometry::Numbers;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

pub fn vector<'py, T: numpy::Element>(py: Python<'py>, values: Vec<T>) -> Bound<'py, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}

/// Rows of equal length as a (rows, N) array, also when there are none.
pub fn matrix<'py, const N: usize>(py: Python<'py>, rows: &[[f64; N]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_iter(py, rows.iter().flatten().copied()).reshape([rows.len(), N])
}

/// The same where the length of a row is known only to its type.
pub fn rows<'py, V: Numbers>(py: Python<'py>, rows: &[V]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat = rows.iter().flat_map(|row| row.as_ref()).copied();
    PyArray1::from_iter(py, flat.collect::<Vec<_>>()).reshape([rows.len(), V::default().as_ref().len()])
}
