//! `hhc diagnose`: a diagnosis of `actuator-gap` with the places of its errors, its cache on disk, its text and the ladder.

mod cache;
mod given;
mod ladder;
mod plan_text;
mod points;
mod specimens;
mod story;

pub use actuator_gap::{
    Diagnosis, Plan, Planned, Proposal, Question, Record, Records, Stage, usual_runs,
};
pub use cache::{FolderStore, KeptStructures};
pub use given::{GivenRecords, both, model_or_case, points_of, records_of};
pub use ladder::{Climb, Ladder, Rung, climb};
pub use model_gap::Findings;
pub use plan_text::PlanText;
pub use points::{CasePoints, PointDiagnosis, PointStory};
pub use specimens::{MissingInSome, Specimen, Specimens};
pub use story::{Story, bench_page};

use crate::SimError;
use crate::problem::Place;
use actuator_gap::DiagnosisError;
use bench_study::BenchError;
use bench_study::stored::StoredActuator;
use preisach_dyn::ActuatorModel;

/// Name of the page of a diagnosis.
pub const PAGE_FILE: &str = "report.html";

/// Diagnoses measured runs against the base model of the reference runs.
///
/// # Errors
/// [`BenchError::Diagnosis`] at the place of the data set.
pub fn diagnose(measured: &Records, question: &Question<'_>) -> Result<Diagnosis, SimError> {
    actuator_gap::diagnose(measured, question).map_err(|error| at(&measured.folder, error))
}

/// What planned runs would show on an actuator; `told` hears how many causes of how many are done.
///
/// # Errors
/// [`BenchError::Diagnosis`] at the file of the plan.
pub fn plan(
    model: &ActuatorModel,
    planned: &Planned<'_>,
    file: &str,
    store: &KeptStructures<'_>,
    told: &(dyn Fn(usize, usize) + Sync),
) -> Result<Plan, SimError> {
    let found = actuator_gap::plan(model, planned, Some(store), told);
    Ok(found.map_err(|source| BenchError::Diagnosis { place: Place::file(file), source })?)
}

/// The error of a diagnosis at the place of its data.
fn at(folder: &str, error: impl Into<DiagnosisError>) -> SimError {
    let place = Place::file(format!("{folder}/dataset.ron"));
    BenchError::Diagnosis { place, source: error.into() }.into()
}

/// The extended actuator of a diagnosis, as a file holds it.
///
/// # Errors
/// [`BenchError::Diagnosis`] at the place of the data set.
pub fn extended(found: &Diagnosis) -> Result<StoredActuator, SimError> {
    found.extended().map_err(|source| at(&found.folder, source))
}
