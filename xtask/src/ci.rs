//! `cargo xtask ci`: runs `.ci/run`, so that there is one list of what a change must pass.

use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use crate::XtaskError;

/// Runs the script `.ci/run` of the workspace at `root` and passes on its exit code.
///
/// # Errors
/// [`XtaskError::Start`] if the script cannot be started.
pub fn run(root: &Path) -> Result<ExitCode, XtaskError> {
    let script = root.join(".ci").join("run");
    let status =
        Command::new(&script).current_dir(root).stdin(Stdio::null()).status().map_err(
            |source| XtaskError::Start { program: script.display().to_string(), source },
        )?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
