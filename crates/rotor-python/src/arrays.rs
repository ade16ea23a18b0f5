//! NumPy arrays in and out, by their bytes: NumPy is asked as any Python program asks it, so that no version of its C interface
//! is built in and nothing here is unsafe. A copy costs a millisecond per million numbers.

use crate::answers::{raised, refused};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PySlice};

/// Bytes of a number.
const SIZE: usize = size_of::<f64>();
/// Numbers taken over at once: their bytes stay in the cache.
const BLOCK: usize = 8192;

/// The numbers of an array of one dimension, or of what NumPy makes one of.
///
/// # Errors
/// What NumPy says of what are no numbers; `rotor_hhc.Error` for another number of dimensions.
pub(crate) fn numbers(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = given.py();
    let numpy = py.import("numpy")?;
    // what NumPy says of what is no array names no argument
    let told = |error: PyErr| {
        if !error.is_instance_of::<PyValueError>(py) {
            return error;
        }
        raised(py, refused(name, error.value(py).to_string()))
    };
    let array = numpy.call_method1("asanyarray", (given,)).map_err(told)?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) && array.len().is_ok_and(|count| count > 0) {
        let kind = array.getattr("dtype")?.str()?.to_string();
        let message = format!("an array of {kind}: give real numbers");
        return Err(raised(py, refused(name, message)));
    }
    if numpy.getattr("ma")?.call_method1("is_masked", (&array,))?.extract()? {
        let message = "a masked array: leave out what is masked, or fill it".to_owned();
        return Err(raised(py, refused(name, message)));
    }
    let array = numpy.call_method1("asarray", (array, "float64")).map_err(told)?;
    let dimensions: usize = array.getattr("ndim")?.extract()?;
    if dimensions != 1 {
        let message = format!("an array of {dimensions} dimensions: give one of one dimension");
        return Err(raised(py, refused(name, message)));
    }
    let count = array.len()?;
    let mut numbers = Vec::with_capacity(count);
    let mut begin = 0;
    while begin < count {
        let end = count.min(begin + BLOCK);
        let (from, to) = (isize::try_from(begin)?, isize::try_from(end)?);
        let bytes = array.get_item(PySlice::new(py, from, to, 1))?.call_method0("tobytes")?;
        let (block, _) = bytes.cast::<PyBytes>()?.as_bytes().as_chunks::<SIZE>();
        numbers.extend(block.iter().map(|bytes| f64::from_ne_bytes(*bytes)));
        begin = end;
    }
    Ok(numbers)
}

/// Numbers as an array of one dimension.
pub(crate) fn array<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyAny>> {
    let held = PyByteArray::new_with(py, SIZE * numbers.len(), |bytes| {
        for (place, number) in bytes.as_chunks_mut::<SIZE>().0.iter_mut().zip(numbers) {
            *place = number.to_ne_bytes();
        }
        Ok(())
    })?;
    py.import("numpy")?.call_method1("frombuffer", (held, "float64"))
}

/// Numbers as an array of a shape, its last index running fastest.
pub(crate) fn shaped<'py>(
    py: Python<'py>,
    numbers: &[f64],
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    array(py, numbers)?.call_method1("reshape", (shape.to_vec(),))
}

/// Pairs of real and imaginary part as an array of complex numbers of a shape.
pub(crate) fn complex<'py>(
    py: Python<'py>,
    pairs: &[[f64; 2]],
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let flat = array(py, pairs.as_flattened())?.call_method1("view", ("complex128",))?;
    flat.call_method1("reshape", (shape.to_vec(),))
}
