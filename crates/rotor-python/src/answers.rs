//! What a call answers: exceptions with the text of the command, warnings, tables; and the work between, outside of the
//! interpreter.

use measured_data::problem::{Fault, Place, Problem};
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict};
use serde::Serialize;
use sim_driver::SimError;
use std::ffi::CString;
use std::fmt::Display;
use std::panic::AssertUnwindSafe;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// That an argument is refused.
pub(crate) fn refused(name: &str, message: String) -> Problem {
    Problem::new(Place::file(name), Fault::Refused { message })
}

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

/// Whether this process was forked after the package was imported: the threads for parallel work stayed behind.
static IS_FORKED: AtomicBool = AtomicBool::new(false);

/// Has Python say when the process is forked, where there are forks.
pub(crate) fn notice_forks(py: Python<'_>) -> PyResult<()> {
    let os = py.import("os")?;
    if !os.hasattr("register_at_fork")? {
        return Ok(());
    }
    let forked = PyCFunction::new_closure(py, None, None, |_, _| {
        IS_FORKED.store(true, Ordering::Relaxed);
    })?;
    let given = PyDict::new(py);
    given.set_item("after_in_child", forked)?;
    os.call_method("register_at_fork", (), Some(&given)).map(drop)
}

/// Works while other threads of Python run, in a forked process on threads of its own. A panic is a bug, and an exception as
/// any other.
pub(crate) fn worked<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, SimError> + Send,
) -> PyResult<T> {
    let work = || {
        if !IS_FORKED.load(Ordering::Relaxed) {
            return work();
        }
        let threads = rayon::ThreadPoolBuilder::new().build();
        threads.map_err(|error| refused("threads", error.to_string()))?.install(work)
    };
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
