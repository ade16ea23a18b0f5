//! Reading cases, from disk or from the files shipped inside the program.

use super::airfoils::read_airfoils;
use super::measured::{MeasuredRotor, read_measured};
use super::t_file::read_t_file;
use super::{ActuatorChoice, ActuatorPath, Case, CaseFaults, ControlActuator, PlausibilityWarning};
use crate::SimError;
use crate::files::{
    Folder, RonIndex, SHIPPED_BENCH, SHIPPED_CASES, Source, airfoil_text, read_ron, shipped,
};
use crate::problem::{Fault, Problem, Problems};
use bench_study::stored::read_actuator;
use rotor_study::StudyError;
use std::path::Path;

/// Name of the shipped case that bare `hhc` runs.
pub const PAPER_CASE: &str = "paper_mu030.ron";
/// Shipped case of the paper's rotor under further controllers.
pub const CONTROLLERS_CASE: &str = "controllers_mu030.ron";

/// Name of the data set inside the program.
const SHIPPED_DATASET: &str = "shipped:apa500l_synthetic";

/// Fields that had another name: the path of the name before, the path now.
const RENAMED: [(&str, &str); 1] = [("rotor.unlike_blades", "rotor.dissimilar_blades")];

/// A case with everything needed to report on it later.
#[derive(Debug, Clone)]
pub struct LoadedCase {
    /// The values, every one in range, with the tables they name.
    pub case: Case,
    /// The places of its fields, for problems found while it runs.
    pub index: RonIndex,
    /// Folder that the paths in it are relative to.
    pub folder: Folder,
    /// What its measured files hold.
    pub measured: MeasuredRotor,
    /// Fields under a name they no longer have, measured files that are not inside the program, and what a T that is
    /// handed in was found with otherwise than the case has it.
    pub warnings: Vec<String>,
}

/// Where the actuator model of a case comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ActuatorSource {
    /// The ideal linear actuator alone.
    Ideal,
    /// Bench data folder.
    Bench(Folder),
    /// Stored actuator file: its folder and name.
    Stored {
        /// Folder of the file.
        folder: Folder,
        /// File name, folders included.
        file: String,
    },
}

impl LoadedCase {
    /// The actuator that the case names, found from its folder.
    pub fn actuator_source(&self) -> ActuatorSource {
        match &self.case.actuator.model {
            ActuatorChoice::Ideal => ActuatorSource::Ideal,
            ActuatorChoice::Bench(bench) if bench.dataset == SHIPPED_DATASET => {
                ActuatorSource::Bench(shipped(SHIPPED_BENCH))
            }
            ActuatorChoice::Bench(bench) => ActuatorSource::Bench(self.folder.join(&bench.dataset)),
            ActuatorChoice::File(stored) => {
                ActuatorSource::Stored { folder: self.folder.clone(), file: stored.path.clone() }
            }
        }
    }

    /// blake3 of every aerofoil table and of the T that the case names, for the key of a result.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub fn table_hashes(&self) -> Result<Vec<String>, Problem> {
        let named = self.case.aerodynamics.airfoils.iter();
        let tables = named.map(|airfoil| airfoil_text(&self.folder, &airfoil.table));
        let handed = self.case.control.t_file.iter().map(|file| self.folder.read(file));
        let hash = |of: Source| blake3::hash(of.text.as_bytes()).to_hex().to_string();
        tables.chain(handed).map(|source| source.map(hash)).collect()
    }

    /// An error of a model or a study at the line of its field.
    pub fn located(&self, error: impl Into<StudyError>) -> SimError {
        SimError::of_study(error.into(), |field| self.index.place(field))
    }

    /// Warnings of values that can be but hardly are meant, each with its place.
    pub fn in_words(&self, warnings: Vec<PlausibilityWarning>) -> Vec<String> {
        let said = warnings.into_iter().map(|PlausibilityWarning { field, message }| {
            Problem::new(self.index.place(&field), Fault::Other(message)).to_string()
        });
        said.collect()
    }
}

/// Reads and validates a case text; paths in it are relative to `folder`.
///
/// # Errors
/// Every problem of the file, each with its line.
pub fn read_case(source: &Source, folder: &Folder) -> Result<LoadedCase, Problems> {
    let read = read_ron::<Case>(source);
    let (mut problems, mut index) = (read.problems, read.index);
    let Some(mut case) = read.value else {
        return problems.into_result(None);
    };
    let mut warnings = Vec::new();
    for (before, now) in RENAMED {
        if index.contains(before) {
            let message = format!("is named {now} now, and read as that; rename it");
            let problem = Problem::new(index.place(before), Fault::Other(message));
            warnings.push(problem.to_string());
            index.rename(before, now);
        }
    }
    if case.actuator.model == ActuatorChoice::Ideal && !index.contains("control.actuators") {
        // the usual list needs an identified actuator
        case.control.actuators = vec![ControlActuator::Ideal];
    }
    match resolved(case, index, folder) {
        Ok(loaded) => {
            warnings.extend(loaded.measured.notes.iter().cloned());
            let handed = loaded.case.control.handed_t.iter();
            warnings.extend(handed.flat_map(|t| t.told.iter().cloned()));
            problems.into_result(Some(LoadedCase { warnings, ..loaded }))
        }
        Err(more) => {
            problems.append(more);
            problems.into_result(None)
        }
    }
}

/// Checks the values and reads the tables that they name.
fn resolved(mut case: Case, index: RonIndex, folder: &Folder) -> Result<LoadedCase, Problems> {
    let mut problems = Problems::default();
    if let Err(CaseFaults(faults)) = case.check() {
        for fault in faults {
            problems.push(index.place(&fault.field), Fault::Other(fault.fault.to_string()));
        }
    }
    match read_airfoils(&case.aerodynamics.airfoils, folder, &index) {
        Ok(tables) => case.aerodynamics.tables = tables,
        Err(more) => problems.append(more),
    }
    match read_t_file(&case, folder, &index) {
        Ok(t) => case.control.handed_t = t,
        Err(problem) => problems.append(problem.into()),
    }
    let radius_m = case.rotor.radius_m;
    let measured = read_measured(&case.measured, radius_m, folder, &index);
    let measured = measured.unwrap_or_else(|more| {
        problems.append(more);
        MeasuredRotor::default()
    });
    let folder = folder.clone();
    let loaded = LoadedCase { case, index, folder, measured, warnings: vec![] };
    let loaded = problems.into_result(Some(loaded))?;
    // what only the blade as a whole can say: flaps beside a tapered one
    match loaded.case.blade_with_flaps() {
        Ok(_) => Ok(loaded),
        Err(error) => {
            let fault = Fault::Refused { message: error.to_string() };
            Err(Problem::new(loaded.index.place("rotor"), fault).into())
        }
    }
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
    with_actuator_file(&shipped_case(PAPER_CASE)?, path, &folder)
}

/// Whether a text says that it is an actuator file.
pub(crate) fn is_actuator_file(source: &Source) -> bool {
    let is_kind = |part: &str| {
        part.trim().trim_matches(['(', ')']).split_whitespace().eq(["kind:", "Actuator"])
    };
    source.text.lines().any(|line| line.split(',').any(is_kind))
}

/// A case with the actuator of a file in the place of its own; paths are then relative to `folder`.
///
/// # Errors
/// That the case and the actuator do not fit.
pub fn with_actuator_file(
    loaded: &LoadedCase,
    path: &Path,
    folder: &Folder,
) -> Result<LoadedCase, Problems> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut case = loaded.case.clone();
    case.title = format!("{}, actuator of {name}", case.title);
    case.actuator.model = ActuatorChoice::File(ActuatorPath { path: name });
    resolved(case, loaded.index.clone(), folder)
}

/// Reads and validates a case shipped inside the program, such as [`PAPER_CASE`].
///
/// # Errors
/// As [`read_case`], or that no such case is shipped.
pub fn shipped_case(name: &str) -> Result<LoadedCase, Problems> {
    let folder = shipped(SHIPPED_CASES);
    read_case(&folder.read(name)?, &folder)
}
