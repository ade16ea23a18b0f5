//! `hhc diagnose`: a diagnosis of `actuator-gap` with the places of its errors, its cache on disk, its text and the ladder.

mod cache;
mod ladder;
mod story;

pub use actuator_gap::{Diagnosis, Findings, Proposal, Question, Record, Records};
pub use cache::FolderStore;
pub use ladder::{Ladder, Rung, climb};
pub use story::Story;

use crate::SimError;
use crate::problem::Place;
use actuator_gap::DiagnosisError;

/// Diagnoses measured runs against the base model of the reference runs.
///
/// # Errors
/// [`SimError::Misfit`] where the numerics fail or a cause asked for is not in the library, and
/// [`SimError::NothingMeasured`], at the place of the data set.
pub fn diagnose(measured: &Records, question: &Question<'_>) -> Result<Diagnosis, SimError> {
    let place = Place::file(format!("{}/dataset.ron", measured.folder));
    actuator_gap::diagnose(measured, question).map_err(|error| at(&place, error))
}

/// The error of a diagnosis with its place.
fn at(place: &Place, error: DiagnosisError) -> SimError {
    let place = place.clone();
    match error {
        DiagnosisError::NothingMeasured { runs } => SimError::NothingMeasured { place, runs },
        DiagnosisError::Misfit(source) => SimError::Misfit { place, source },
        DiagnosisError::Actuator(source) => SimError::Actuator { place, source },
    }
}

/// The extended actuator of a diagnosis, as a file holds it.
///
/// # Errors
/// [`SimError::Actuator`] at the place of the data set.
pub fn extended(found: &Diagnosis) -> Result<crate::stored_actuator::StoredActuator, SimError> {
    let place = || Place::file(format!("{}/dataset.ron", found.folder));
    found.extended().map_err(|source| SimError::Actuator { place: place(), source })
}
