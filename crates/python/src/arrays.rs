//! NumPy arrays in and out. Those handed out are read-only: nobody writes into one and believes that something changed.

use drystone::geometry::Numbers;
use numpy::{Element, PyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// The same array, read-only.
pub fn read_only<T: Element, D: numpy::ndarray::Dimension>(
    array: Bound<'_, PyArray<T, D>>,
) -> Bound<'_, PyArray<T, D>> {
    array.readwrite().make_nonwriteable();
    array
}

pub fn vector<'py, T: Element>(py: Python<'py>, values: Vec<T>) -> Bound<'py, PyArray1<T>> {
    read_only(PyArray1::from_vec(py, values))
}

/// Rows of equal length as a (rows, N) array, also when there are none.
pub fn matrix<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    Ok(read_only(PyArray1::from_iter(py, rows.iter().flatten().copied()).reshape([rows.len(), N])?))
}

/// The same where the length of a row is known only to its type.
pub fn rows<'py, V: Numbers>(py: Python<'py>, rows: &[V]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat = rows.iter().flat_map(|row| row.as_ref()).copied();
    let array = PyArray1::from_iter(py, flat.collect::<Vec<_>>());
    Ok(read_only(array.reshape([rows.len(), V::default().as_ref().len()])?))
}
