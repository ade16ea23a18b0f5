//! A case diagnosed from points of test: of its rotor, its blade or its section.

use super::PointDiagnosis;
use crate::SimError;
use crate::actuator::case_actuators;
use crate::case::LoadedCase;
use crate::files::{SHIPPED_BENCH, read_bench, ron_text, shipped};
use crate::problem::{Fault, Place, Problem};
use bench_study::BenchError;
use bench_study::identification::identify_bench;
use measured_data::{DatasetKind, SweepData};
use model_gap::points::{PointFinding, PointTable};
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::Settings;
use rotor_case::{ActuatorChoice, BenchFolder, Case, ControlValues, UncertainField};
use rotor_gap::blade::{Frequencies, diagnose_blade, usual_blade_uncertain};
use rotor_gap::section::{SectionLoads, diagnose_section};
use rotor_gap::{
    CaseQuestion, RotorGapError, RotorQuestion, Sweep, SweepPoint, WonBack, diagnose, stated,
    usual_uncertain,
};
use std::sync::Arc;

/// Name of the case that a diagnosis extended.
const EXTENDED_CASE_FILE: &str = "extended_case.ron";
/// What is taken for granted of the loads of a section.
const SAME_PRESSURES: &str = "cn, cm and ch are taken for integrals of the same pressures: one gain is that of all; pitch is read to 1 %";

/// A case with what was found of it.
pub struct CasePoints {
    /// What was found.
    pub diagnosis: PointDiagnosis,
    /// The case with what was found, as a file holds it; none where nothing of a case was found.
    extended: Option<String>,
}

/// What is asked of a case, and who hears of the progress.
struct Asked<'a> {
    case: &'a LoadedCase,
    data: &'a SweepData,
    only: &'a [String],
    begun: &'a (dyn Fn(usize, &str) + Sync),
}

impl CasePoints {
    /// Diagnoses points of a case. `begun` hears the percent of the work done and what is begun.
    ///
    /// # Errors
    /// A column that is not known, at its place; an uncertain field, at its place in the case; the engine.
    pub fn of(
        case: &LoadedCase,
        data: &SweepData,
        only: &[String],
        begun: &(dyn Fn(usize, &str) + Sync),
    ) -> Result<Self, SimError> {
        let asked = Asked { case, data, only, begun };
        match data.kind {
            DatasetKind::BladeFrequencies => asked.blade(),
            DatasetKind::SectionLoops => asked.section(),
            _ => asked.rotor(),
        }
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

impl Asked<'_> {
    fn rotor(&self) -> Result<CasePoints, SimError> {
        let case = &self.case.case;
        let sweep = Sweep::of(&self.data.points, case).map_err(|e| self.located(e))?;
        let actuator = case_actuators(self.case)?.real.map(Arc::new);
        let is_driven = sweep.points.iter().any(SweepPoint::is_driven);
        let is_ideal = case.actuator.model == ActuatorChoice::Ideal;
        let hysteretic = if is_driven && is_ideal { Some(shipped_actuator()?) } else { None };
        let usual = usual_uncertain();
        let (uncertain, from) = self.uncertain(&usual);
        let question = RotorQuestion {
            case,
            actuator,
            hysteretic,
            uncertain,
            sweep: &sweep,
            only: self.only,
            begun: self.begun,
        };
        let found = diagnose(&question).map_err(|e| self.located(e))?;
        let notes = found.notes(uncertain, from);
        let mut extended = found.extended;
        if !found.won_back.is_empty() {
            let own = extended.get_or_insert_with(|| case.clone());
            own.actuator.model = ActuatorChoice::Bench(BenchFolder::default());
            own.control.actuators = ControlValues::default().actuators;
        }
        let mut points = self.points("RotorSweep", found.table, found.found, (notes, extended))?;
        points.diagnosis.besides = found.won_back.iter().map(WonBack::text).collect();
        Ok(points)
    }

    fn blade(&self) -> Result<CasePoints, SimError> {
        let measured = Frequencies::of(&self.data.points).map_err(|e| self.located(e))?;
        let usual = usual_blade_uncertain();
        let (uncertain, from) = self.uncertain(&usual);
        let found = diagnose_blade(&self.question(uncertain), &measured);
        let found = found.map_err(|e| self.located(e))?;
        let mut notes = vec![stated(uncertain, from)];
        notes.extend(found.moved);
        self.points("BladeFrequencies", found.table, found.found, (notes, found.extended))
    }

    fn section(&self) -> Result<CasePoints, SimError> {
        let measured = SectionLoads::of(&self.data.points).map_err(|e| self.located(e))?;
        let found = diagnose_section(&self.question(&[]), &measured);
        let found = found.map_err(|e| self.located(e))?;
        let mut notes = vec![SAME_PRESSURES.to_owned()];
        notes.extend(found.moved);
        self.points("SectionLoops", found.table, found.found, (notes, found.extended))
    }

    /// What is uncertain, and where that is said.
    fn uncertain<'b>(
        &'b self,
        usual: &'b [UncertainField],
    ) -> (&'b [UncertainField], &'static str) {
        match &self.case.case.uncertain[..] {
            [] => (usual, "the usual; `uncertain` of the case says others"),
            stated => (stated, "the case"),
        }
    }

    fn question<'b>(&'b self, uncertain: &'b [UncertainField]) -> CaseQuestion<'b> {
        CaseQuestion { case: &self.case.case, uncertain, only: self.only, begun: self.begun }
    }

    fn points(
        &self,
        data_kind: &'static str,
        table: PointTable,
        found: PointFinding,
        (notes, extended): (Vec<String>, Option<Case>),
    ) -> Result<CasePoints, SimError> {
        let extended = extended.as_ref().map(ron_text).transpose();
        let extended = extended.map_err(|e| SimError::not_written(EXTENDED_CASE_FILE, &e))?;
        let title = self.data.title.clone();
        Ok(CasePoints {
            diagnosis: PointDiagnosis { title, data_kind, table, found, besides: vec![], notes },
            extended,
        })
    }

    /// An error at the column of the table or the field of the case.
    fn located(&self, error: RotorGapError) -> SimError {
        let Self { case, data, .. } = self;
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
                let place = Place::file(&data.folder);
                BenchError::Diagnosis { place, source: source.into() }.into()
            }
            RotorGapError::Study { source, .. } => case.located(*source),
            error => refused(Place::file(&data.folder), error.to_string()),
        }
    }
}

/// The shipped actuator with hysteresis: what an ideal one may lack.
fn shipped_actuator() -> Result<Arc<ActuatorModel>, SimError> {
    let data = read_bench(&shipped(SHIPPED_BENCH))?;
    Ok(Arc::new(identify_bench(&data, &Settings::default(), None)?.stored().model))
}
