//! An identified actuator and its inverse as step functions for other programs.
//!
//! | idea | module items |
//! |---|---|
//! | languages | [`Target`] |
//! | the files of one language | [`export`] |
//! | the monitor of a named cause: residual, amount, threshold | [`Monitor`], [`export_monitor`] |
//! | what they leave out or do only nearly | [`remarks()`] |
//! | what a step costs | [`timing_program`], [`timed_command`] |
//! | what cannot be exported, with the remedy | [`ExportError`] |
//! | texts of code and JSON, for other exporters | [`Library`], [`filled`], [`wrapped`], [`check_name`], [`Json`] |
//!
//! The generated code follows the arithmetic of `preisach-dyn` operation by operation; it needs nothing but the
//! language's own mathematics. Readable text is part of the purpose: the equations, their sources and units stand in
//! it as comments.

mod constant;
mod error;
mod json;
mod laws;
mod library;
mod monitor;
mod name;
mod plan;
mod remarks;
mod stages;
mod targets;
mod timing;

pub use constant::{number, wrapped};
pub use error::ExportError;
pub use json::Json;
pub use library::{Library, filled, prefixed};
pub use monitor::{Monitor, Seen, Watched, export_monitor, without_stages};
pub use name::check as check_name;
pub use remarks::remarks;
pub use timing::{timed_command, timing_program};

use plan::Plan;
use preisach_dyn::ActuatorModel;

/// A language to write an actuator in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// C99, also C++: a header and a source, no allocation, no state but in structs handed over.
    C,
    /// Python 3: a module with a class; `NumPy` for whole histories only.
    Python,
    /// MATLAB, also Octave: a handle class.
    Matlab,
    /// JSON: the parameters with names, units and meanings.
    Json,
}

/// The files, name and text of each, that hold an actuator and its inverse in one language.
///
/// | argument | meaning | range |
/// |---|---|---|
/// | `name` | name of files, functions, module, class | lower-case identifier of at most 31 characters |
/// | `time_step_s` | time between two samples of the generated step functions, s | positive |
///
/// Stages of the sensor do not act on the flap and are left out; see [`remarks()`].
///
/// # Errors
/// [`ExportError`]: a name that is no identifier, a time step that is not positive, a stage that is not written in
/// other languages (heating, depolarisation), a delay of too many samples, an actuator with refused numbers.
pub fn export(
    model: &ActuatorModel,
    name: &str,
    time_step_s: f64,
    target: Target,
) -> Result<Vec<(String, String)>, ExportError> {
    let plan = Plan::new(model, name, time_step_s)?;
    Ok(match target {
        Target::C => targets::c::files(&plan),
        Target::Python => targets::python::files(&plan),
        Target::Matlab => targets::matlab::files(&plan),
        Target::Json => targets::json::files(&plan),
    })
}

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
