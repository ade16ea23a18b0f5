//! A rotor diagnosed from points of test.

use super::PointDiagnosis;
use crate::SimError;
use crate::actuator::case_actuators;
use crate::case::LoadedCase;
use crate::files::{SHIPPED_BENCH, read_bench, ron_text, shipped};
use crate::identification::identify_bench;
use crate::problem::{Fault, Place, Problem};
use measured_data::SweepData;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::Settings;
use rotor_gap::{RotorGapError, RotorQuestion, Sweep, SweepPoint, diagnose, usual_uncertain};
use rotor_study::case::ActuatorChoice;
use std::sync::Arc;

/// Name of the case that a diagnosis extended.
const EXTENDED_CASE_FILE: &str = "extended_case.ron";

/// A rotor with what was found of it.
pub struct RotorPoints {
    /// What was found.
    pub diagnosis: PointDiagnosis,
    /// What a reader should know.
    pub notes: Vec<String>,
    /// The case with what was found, as a file holds it; none where nothing of a case was found.
    extended: Option<String>,
}

impl RotorPoints {
    /// Diagnoses the sweep of a rotor. `begun` hears the percent of the work done and what is begun.
    ///
    /// # Errors
    /// A column that is not known, at its place; an uncertain field, at its place in the case; the engine.
    pub fn of(
        case: &LoadedCase,
        data: &SweepData,
        only: &[String],
        begun: &(dyn Fn(usize, &str) + Sync),
    ) -> Result<Self, SimError> {
        let located = |error| located(case, data, error);
        let sweep = Sweep::of(&data.points, &case.case).map_err(located)?;
        let actuator = case_actuators(case)?.real.map(Arc::new);
        let is_driven = sweep.points.iter().any(SweepPoint::is_driven);
        let is_ideal = case.case.actuator.model == ActuatorChoice::Ideal;
        let hysteretic = if is_driven && is_ideal { Some(shipped_actuator()?) } else { None };
        let usual = usual_uncertain();
        let is_stated = !case.case.uncertain.is_empty();
        let uncertain = if is_stated { &case.case.uncertain } else { &usual };
        let question = RotorQuestion {
            case: &case.case,
            actuator,
            hysteretic,
            uncertain,
            sweep: &sweep,
            only,
            begun,
        };
        let found = diagnose(&question).map_err(located)?;
        let from = if is_stated {
            "the case"
        } else {
            "the usual of a rotor; `uncertain` of the case says others"
        };
        let notes = found.notes(uncertain, from);
        let extended = found.extended.as_ref().map(ron_text).transpose();
        let extended = extended.map_err(|e| SimError::not_written(EXTENDED_CASE_FILE, &e))?;
        let (title, table) = (data.title.clone(), found.table);
        let diagnosis =
            PointDiagnosis { title, data_kind: "RotorSweep", table, found: found.found };
        Ok(Self { diagnosis, notes, extended })
    }

    /// Files to write: those of the points, and the extended case.
    ///
    /// # Errors
    /// [`SimError::Data`] if JSON cannot express the findings.
    pub fn files(&self) -> Result<Vec<(String, String)>, SimError> {
        let mut files = self.diagnosis.files()?;
        files.extend(self.extended.clone().map(|text| (EXTENDED_CASE_FILE.to_owned(), text)));
        Ok(files)
    }
}

/// The shipped actuator with hysteresis: what an ideal one may lack.
fn shipped_actuator() -> Result<Arc<ActuatorModel>, SimError> {
    let data = read_bench(&shipped(SHIPPED_BENCH))?;
    Ok(Arc::new(identify_bench(&data, &Settings::default(), None)?.stored().model))
}

/// An error at the column of the table or the field of the case.
fn located(case: &LoadedCase, data: &SweepData, error: RotorGapError) -> SimError {
    let refused = |place: Place, message: String| -> SimError {
        Problem::new(place, Fault::Refused { message }).into()
    };
    match error {
        RotorGapError::Column { ref name, .. } => {
            refused(data.points.table.column_place(name), error.to_string())
        }
        RotorGapError::Uncertain { number, .. } => {
            refused(case.index.place(&format!("uncertain[{number}].field")), error.to_string())
        }
        RotorGapError::Gap(source) => {
            SimError::Diagnosis { place: Place::file(&data.folder), source: source.into() }
        }
        RotorGapError::Study { source, .. } => case.located(*source),
        error => refused(Place::file(&data.folder), error.to_string()),
    }
}
