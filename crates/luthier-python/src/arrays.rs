//! Arrays in and out.

use luthier_lut::Image;
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::fault::value;

/// Farthest that a squared length may be from 1: directions in single precision are unit to 1e-7.
const UNIT: f64 = 1e-4;

/// Unit directions, one a row. A row with a number that is none is let through: its values are no numbers either.
pub(crate) fn directions<'a>(array: &'a PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<&'a [[f64; 3]]> {
    let rows = triples(array, name)?;
    let wrong = rows.iter().position(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() > UNIT);
    let Some(row) = wrong else { return Ok(rows) };
    Err(value(format!("{name}: direction {row} is {:?}, which is not of length 1", rows[row])))
}

/// Rows of three numbers.
pub(crate) fn triples<'a>(array: &'a PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<&'a [[f64; 3]]> {
    let flat = array.as_slice().map_err(|_| value(format!("{name} is not contiguous")))?;
    match flat.as_chunks() {
        (rows, []) if array.as_array().ncols() == 3 => Ok(rows),
        _ => Err(value(format!("{name} has shape {:?}, expected (n, 3)", array.as_array().shape()))),
    }
}

/// Number of pairs of two lists, of which either may have a single direction.
pub(crate) fn pairs(wi: usize, wo: usize) -> PyResult<usize> {
    match (wi, wo) {
        (1, count) | (count, 1) => Ok(count),
        (count, other) if count == other => Ok(count),
        _ => Err(value(format!("{wi} directions of light and {wo} of the eye"))),
    }
}

/// Rows of numbers as an array.
pub(crate) fn rows<'py>(py: Python<'py>, columns: usize, flat: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let count = flat.len() / columns.max(1);
    Ok(Array2::from_shape_vec((count, columns), flat).map_err(value)?.into_pyarray(py))
}

/// An image as an array of rows, columns and channels.
pub(crate) fn image<'py>(py: Python<'py>, image: Image) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let shape = [image.height, image.width, image.channels].map(|side| side as usize);
    Ok(Array3::from_shape_vec(shape, image.data).map_err(value)?.into_pyarray(py))
}
