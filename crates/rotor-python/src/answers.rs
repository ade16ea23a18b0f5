//! What a call answers: exceptions with the text of the command, warnings, tables; and the work between, outside of the
//! interpreter.

use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use serde::Serialize;
use sim_driver::SimError;
use std::ffi::CString;
use std::fmt::Display;
use std::panic::AssertUnwindSafe;

pyo3::create_exception!(
    rotor_hhc,
    Error,
    PyValueError,
    "What stops the command `hhc`, in its words. `exit_code` is that of the command: 1 the numerics failed, 2 bad input, 3 a comparison failed."
);
pyo3::create_exception!(
    rotor_hhc,
    Caution,
    PyUserWarning,
    "What the command `hhc` warns of, in its words."
);

/// The exception of an error.
pub(crate) fn raised(py: Python<'_>, error: impl Into<SimError>) -> PyErr {
    let error = error.into();
    let exception = Error::new_err(error.to_string());
    match exception.value(py).setattr("exit_code", error.exit_code()) {
        Ok(()) => exception,
        Err(other) => other,
    }
}

/// What a panic is told as.
const BUG: &str = "a bug of rotor_hhc stopped the call; please report it with what was called";

/// Works while other threads of Python run. A panic is a bug, and an exception as any other.
pub(crate) fn worked<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, SimError> + Send,
) -> PyResult<T> {
    let done = py.detach(|| std::panic::catch_unwind(AssertUnwindSafe(work)));
    done.map_err(|_| Error::new_err(BUG))?.map_err(|error| raised(py, error))
}

/// Warns as the command does, with the line of the caller.
pub(crate) fn warn<T: Display>(py: Python<'_>, warnings: &[T]) -> PyResult<()> {
    let category = py.get_type::<Caution>();
    for warning in warnings {
        // a text of C ends at its first zero
        let text = CString::new(warning.to_string().replace('\0', " "))?;
        PyErr::warn(py, &category, &text, 1)?;
    }
    Ok(())
}

/// The JSON text of a value.
pub(crate) fn json(value: &impl Serialize) -> Result<String, SimError> {
    sim_driver::output::json(value)
}

/// A JSON text as dictionaries, lists and numbers, every number with its bits.
pub(crate) fn table<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}
