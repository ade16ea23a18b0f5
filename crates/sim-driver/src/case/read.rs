//! Reading cases, from disk or from the files shipped inside the program.

use super::convert::convert;
use super::{ActuatorChoice, Case, CaseFile, ControlActuator};
use crate::files::{Folder, RonIndex, SHIPPED_CASES, Source, read_ron};
use crate::problem::Problems;
use std::path::Path;

/// Name of the shipped case that bare `hhc` runs.
pub const PAPER_CASE: &str = "paper_mu030.ron";
/// Shipped case of the paper's rotor under further controllers.
pub const CONTROLLERS_CASE: &str = "controllers_mu030.ron";

/// A case with everything needed to report on it later.
#[derive(Debug, Clone)]
pub struct LoadedCase {
    /// The validated values.
    pub case: Case,
    /// The file with its defaults filled in, as results store it.
    pub file: CaseFile,
    /// The places of its fields, for problems found while it runs.
    pub index: RonIndex,
}

/// Reads and validates a case text; paths in it are relative to `folder`.
///
/// # Errors
/// Every problem of the file, each with its line.
pub fn read_case(source: &Source, folder: &Folder) -> Result<LoadedCase, Problems> {
    let read = read_ron::<CaseFile>(source);
    let mut problems = read.problems;
    let Some(mut file) = read.value else {
        return problems.into_result(None);
    };
    if file.actuator.model == ActuatorChoice::Ideal && !read.index.contains("control.actuators") {
        // the usual list needs an identified actuator
        file.control.actuators = vec![ControlActuator::Ideal];
    }
    let case = match convert(&file, folder, &read.index) {
        Ok(case) => Some(case),
        Err(more) => {
            problems.append(more);
            None
        }
    };
    problems.into_result(case.map(|case| LoadedCase { case, file, index: read.index }))
}

/// Reads and validates a case on disk.
///
/// # Errors
/// As [`read_case`], or that the file cannot be read.
pub fn load_case(path: &Path) -> Result<LoadedCase, Problems> {
    read_case(&Source::read(path)?, &Folder::of_file(path))
}

/// Reads and validates a case shipped inside the program, such as [`PAPER_CASE`].
///
/// # Errors
/// As [`read_case`], or that no such case is shipped.
pub fn shipped_case(name: &str) -> Result<LoadedCase, Problems> {
    let folder = Folder::Shipped(SHIPPED_CASES.to_owned());
    read_case(&folder.read(name)?, &folder)
}
