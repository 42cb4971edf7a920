//! Arrays in and out.

use durer::math::DVec2;
use durer::target::Pixels;
use numpy::{
    Element, IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Returns a plane of a picture as an array of rows and columns.
pub fn plane<T: Element + Copy>(
    py: Python<'_>,
    pixels: Pixels<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let shape = [pixels.height() as usize, pixels.width() as usize];
    pixels.into_data().into_pyarray(py).reshape(shape)
}

/// Returns a plane of several channels as an array of rows, columns and channels.
pub fn channels<T: Element + Copy, const N: usize>(
    py: Python<'_>,
    pixels: Pixels<[T; N]>,
) -> PyResult<Bound<'_, PyArray3<T>>> {
    let shape = [pixels.height() as usize, pixels.width() as usize, N];
    pixels.into_data().into_flattened().into_pyarray(py).reshape(shape)
}

/// Returns rows of `N` numbers.
pub fn rows<T: Element + Copy, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}

/// Returns points as rows of two.
pub fn points(py: Python<'_>, points: Vec<DVec2>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    rows(py, points.into_iter().map(|p| p.to_array()).collect())
}

/// Returns the numbers of an array, which must be contiguous.
pub fn contiguous<'a, T: Element, D: numpy::ndarray::Dimension>(
    array: &'a numpy::PyReadonlyArray<'_, T, D>,
    name: &str,
) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|_| PyTypeError::new_err(format!("{name} must be C-contiguous")))
}

/// Returns a picture from an array of rows, columns and channels.
pub fn pixels<const N: usize>(
    array: &numpy::PyReadonlyArray3<'_, u8>,
    name: &str,
) -> PyResult<Pixels<[u8; N]>> {
    let [rows, columns, channels] = *array.shape() else {
        return Err(PyTypeError::new_err(format!("{name} must have three dimensions")));
    };
    if channels != N {
        let message =
            format!("{name} must be (rows, columns, {N}), got ({rows}, {columns}, {channels})");
        return Err(PyTypeError::new_err(message));
    }
    let too_large =
        |_| PyTypeError::new_err(format!("{name}: {columns}x{rows} pixels are too many"));
    let (width, height) =
        (u32::try_from(columns).map_err(too_large)?, u32::try_from(rows).map_err(too_large)?);
    let data = contiguous(array, name)?.as_chunks::<N>().0.to_vec();
    Pixels::from_data(width, height, data).map_err(|e| PyTypeError::new_err(e.to_string()))
}

/// Returns a flat array that owns its numbers.
pub fn flat<T: Element>(py: Python<'_>, numbers: Vec<T>) -> Bound<'_, PyArray1<T>> {
    numbers.into_pyarray(py)
}
