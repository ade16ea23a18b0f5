//! Frequencies of a blade on its hub, mode by mode over the rotor speed.
//!
//! | idea | module |
//! |---|---|
//! | what was measured | `frequencies` |
//! | the cause library: what a blade may lack | `causes` |
//! | a diagnosis | here |

mod causes;
mod frequencies;

pub use causes::{BLADE_LIBRARY, BladeCause};
pub use frequencies::Frequencies;

use crate::diagnosis::{CaseDiagnosis, CaseQuestion};
use crate::error::RotorGapError;
use crate::properties::OfCase;
use crate::rotor::{moved_inputs, with_inputs};
use measured_data::Scatter;
use model_gap::points::{Grid, Instrument, KindFinding, KindQuestion, PointKind, channels_of};
use rotor_case::{Case, UncertainField};
use rotor_study::{AboutState, ModesQuestion, ModesResult, modes_at_speeds, numbered};

/// What is taken for uncertain where a case says nothing: field and percent.
pub const BLADE_UNCERTAIN: [(&str, f64); 3] =
    [("rotor.gj", 2.0), ("rotor.ei_flap", 1.0), ("rotor.ei_lag", 1.0)];
/// Part by which a frequency counter is off, standard deviation.
const COUNTER: f64 = 5e-4;

/// A blade as simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeModel {
    /// The blade and how it is held.
    pub case: Case,
    /// True rotor speed over the stated one.
    pub speed: f64,
    /// State whose small motions the modes are.
    pub about: AboutState,
}

impl OfCase for BladeModel {
    fn case(&self) -> &Case {
        &self.case
    }

    fn case_mut(&mut self) -> &mut Case {
        &mut self.case
    }
}

/// The modes that were measured, of any blade.
struct Modes<'a> {
    measured: &'a Frequencies,
}

impl PointKind for Modes<'_> {
    type Model = BladeModel;
    type Error = RotorGapError;

    fn read(&self, model: &BladeModel) -> Result<Grid, RotorGapError> {
        let stated_rpm = model.case.rotor.omega_rpm;
        let ratio = |rpm: &f64| rpm * model.speed / stated_rpm;
        let ratios: Vec<f64> = self.measured.speeds_rpm.iter().map(ratio).collect();
        let question = ModesQuestion { about: model.about, ..ModesQuestion::default() };
        let failed =
            |source| RotorGapError::Study { point: "blade".to_owned(), source: Box::new(source) };
        let found = modes_at_speeds(&model.case, &question, &ratios).map_err(failed)?;
        let of_speed = |own: &ModesResult| {
            let names: Vec<String> = numbered(&own.modes).collect();
            let of = |mode: &String| {
                let place = names.iter().position(|own| own == mode);
                place.map(|k| own.modes[k].hz).ok_or_else(|| RotorGapError::Mode {
                    mode: mode.clone(),
                    found: names.join(", "),
                })
            };
            self.measured.modes.iter().map(of).collect::<Result<Vec<f64>, _>>()
        };
        found.iter().map(of_speed).collect()
    }
}

/// What is taken for uncertain of a blade.
pub fn usual_blade_uncertain() -> Vec<UncertainField> {
    crate::rotor::in_percent(&BLADE_UNCERTAIN)
}

/// Diagnoses the frequencies of a blade.
///
/// # Errors
/// [`RotorGapError`]: a mode that no blade of the case has, an uncertain field that is none, the engine.
pub fn diagnose_blade(
    question: &CaseQuestion<'_>,
    measured: &Frequencies,
) -> Result<CaseDiagnosis, RotorGapError> {
    let mut case = question.case.clone();
    measured.widen(&mut case.structure.modes);
    let model = BladeModel { case, speed: 1.0, about: AboutState::Deflected };
    let kind = Modes { measured };
    let names: Vec<String> = measured.modes.iter().map(|own| format!("{own}_hz")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let (mut channels, _) = channels_of(&names);
    for own in &mut channels {
        own.instrument = 0;
    }
    let with_case = |case| BladeModel { case, ..model.clone() };
    let with_inputs = |by: &[f64]| with_inputs(&model.case, question.uncertain, by).map(with_case);
    let causes = causes::library(&model, &measured.modes);
    let asked = KindQuestion {
        kind: &kind,
        model: &model,
        causes: &causes,
        alternatives: vec![(
            "modes about the undeformed blade",
            BladeModel { about: AboutState::Undeformed, ..model.clone() },
        )],
        uncertain: question.uncertain.len(),
        with_inputs: &with_inputs,
        channels,
        instruments: vec![Instrument { name: "frequency_hz".to_owned(), gain: COUNTER, zero: 0.0 }],
        conditions: vec!["rotor_speed_rpm".to_owned()],
        points: &|predicted| measured.points(predicted),
        knows_deviations: measured.scatter != Scatter::Unknown,
        only: question.only,
        begun: question.begun,
    };
    let KindFinding { table, found, alternatives, inputs, mut extended } = asked.answer()?;
    extended.case.structure.modes = question.case.structure.modes.clone();
    let extended = (extended.case != *question.case).then_some(extended.case);
    let moved = moved_inputs(question.uncertain.iter().map(|own| own.field.as_str()), &inputs);
    Ok(CaseDiagnosis { table, found, alternatives, moved, extended })
}
