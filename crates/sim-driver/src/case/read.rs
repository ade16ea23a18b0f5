//! Reading cases, from disk or from the files shipped inside the program.

use super::convert::convert;
use super::{ActuatorChoice, Case, CaseFile, ControlActuator, StoredActuatorFile};
use crate::files::{Folder, RonIndex, SHIPPED_CASES, Source, read_ron};
use crate::problem::Problems;
use crate::stored_actuator::read_actuator;
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

/// Reads and validates a case on disk. An actuator file stands for [`PAPER_CASE`] with that actuator.
///
/// # Errors
/// As [`read_case`], or that the file cannot be read.
pub fn load_case(path: &Path) -> Result<LoadedCase, Problems> {
    let (source, folder) = (Source::read(path)?, Folder::of_file(path));
    if !is_actuator_file(&source) {
        return read_case(&source, &folder);
    }
    read_actuator(&source)?;
    let shipped = shipped_case(PAPER_CASE)?;
    with_actuator_file(&shipped.file, &shipped.index, path, &folder)
}

/// Whether a text says that it is an actuator file.
fn is_actuator_file(source: &Source) -> bool {
    source.text.lines().any(|line| line.trim().trim_end_matches(',') == "kind: Actuator")
}

/// A case with the actuator of a file in the place of its own.
///
/// # Errors
/// That the case and the actuator do not fit.
pub fn with_actuator_file(
    file: &CaseFile,
    index: &RonIndex,
    path: &Path,
    folder: &Folder,
) -> Result<LoadedCase, Problems> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut file = file.clone();
    file.title = format!("{}, actuator of {name}", file.title);
    file.actuator.model = ActuatorChoice::File(StoredActuatorFile { path: name });
    let case = convert(&file, folder, index)?;
    Ok(LoadedCase { case, file, index: index.clone() })
}

/// Reads and validates a case shipped inside the program, such as [`PAPER_CASE`].
///
/// # Errors
/// As [`read_case`], or that no such case is shipped.
pub fn shipped_case(name: &str) -> Result<LoadedCase, Problems> {
    let folder = Folder::Shipped(SHIPPED_CASES.to_owned());
    read_case(&folder.read(name)?, &folder)
}
