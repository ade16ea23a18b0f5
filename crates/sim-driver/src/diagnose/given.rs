//! What a diagnosis is given: records to be explained and records that show the system as it is, the simulation asked about.

use super::{Record, Records};
use crate::SimError;
use crate::case::{LoadedCase, load_case};
use crate::files::{DataSet, Folder, Source, SweepData, read_dataset, read_sweep};
use crate::problem::{Fault, Place, Problem};
use bench_study::stored::read_actuator;
use measured_data::{DatasetKind, dataset_kind};
use preisach_dyn::ActuatorModel;
use std::path::Path;

/// The records of a diagnosis.
#[derive(Debug, Clone)]
pub struct GivenRecords {
    /// The runs to be explained.
    pub measured: Records,
    /// Runs of another folder that show the system as it is.
    pub reference: Vec<Record>,
    /// What a reader should know about the data.
    pub warnings: Vec<Problem>,
}

/// The runs of a folder to be explained, and the reference runs: of the folder given, else those of the data, else of
/// `../reference`.
///
/// # Errors
/// Every problem of the data; a kind that has no records; one folder for both.
pub fn both(data: &Path, reference: Option<&Path>) -> Result<GivenRecords, SimError> {
    let (measured, mut warnings) = records_of(data)?;
    let reference = reference_runs(reference, data, &measured, &mut warnings)?;
    Ok(GivenRecords { measured, reference, warnings })
}

/// The points of a folder; none of another kind of data.
///
/// # Errors
/// Every problem of the points.
pub fn points_of(data: &Path) -> Result<Option<SweepData>, SimError> {
    let folder = Folder::Disk(data.to_path_buf());
    let kind = dataset_kind(&folder);
    let is_of_points = |own: &DatasetKind| DatasetKind::OF_POINTS.iter().any(|of| of.0 == *own);
    Ok(kind.filter(is_of_points).map(|kind| read_sweep(&folder, kind)).transpose()?)
}

/// The model of an actuator file; or the case.
///
/// # Errors
/// Every problem of the file.
pub fn model_or_case(path: &Path) -> Result<(Option<ActuatorModel>, Option<LoadedCase>), SimError> {
    let source = Source::read(path)?;
    match read_actuator(&source) {
        Ok(stored) => Ok((Some(stored.model), None)),
        Err(problems) if source.text.contains("kind: Actuator") => Err(problems.into()),
        Err(_) => Ok((None, Some(load_case(path)?))),
    }
}

/// The records of a folder, and what a reader should know about them.
///
/// # Errors
/// As [`both`].
pub fn records_of(folder: &Path) -> Result<(Records, Vec<Problem>), SimError> {
    let data = read_dataset(&Folder::Disk(folder.to_path_buf()))?;
    let warnings = data.warnings().to_vec();
    match &data {
        DataSet::Bench(bench) => Ok((bench.into(), warnings)),
        DataSet::Loops(loops) => Ok((loops.into(), warnings)),
        DataSet::Sweep(sweep) => {
            let place = Place::file(format!("{}/dataset.ron", sweep.folder)).field("kind");
            let message = "points of a rotor are diagnosed alone, with a case: hhc diagnose CASE.ron --data DIR -o OUT";
            Err(Problem::new(place, Fault::Refused { message: message.to_owned() }).into())
        }
        DataSet::Curves(curves) => {
            let place = Place::file(format!("{}/dataset.ron", curves.folder)).field("kind");
            let message =
                "reversal curves hold no time: nothing dynamic can be diagnosed from them; \
                           give an ActuatorBench or a GenericLoop"
                    .to_owned();
            Err(Problem::new(place, Fault::Refused { message }).into())
        }
    }
}

/// Reference runs: of the folder given, else those of the data, else of `../reference`. A folder in which no
/// run has a role is one of reference runs.
fn reference_runs(
    given: Option<&Path>,
    data: &Path,
    measured: &Records,
    warnings: &mut Vec<Problem>,
) -> Result<Vec<Record>, SimError> {
    let folder = match given {
        Some(folder) => folder.to_path_buf(),
        None if measured.runs.iter().any(|run| run.is_reference) => return Ok(Vec::new()),
        None => data.join("../reference"),
    };
    if given.is_none() && !folder.join("dataset.ron").is_file() {
        return Ok(Vec::new());
    }
    let (found, more) = records_of(&folder)?;
    warnings.extend(more);
    if found.content_hash == measured.content_hash {
        let place = Place::file(format!("{}/dataset.ron", folder.display()));
        let message = "these are the measured runs themselves: reference runs show the actuator with nothing missing; \
             give their folder, or none"
            .to_owned();
        return Err(Problem::new(place, Fault::Refused { message }).into());
    }
    let mut runs = found.runs;
    if runs.iter().any(|run| run.is_reference) {
        runs.retain(|run| run.is_reference);
    }
    for run in &mut runs {
        run.is_reference = true;
    }
    Ok(runs)
}
