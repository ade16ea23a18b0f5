//! `hhc fly`: the flight of a case in time, as table, CSV and page.

mod page;

pub use page::flight_html;

use crate::SimError;
use crate::actuator::case_actuators;
use crate::case::{Case, FailedOn, FlightValues, LoadedCase, Notice};
use crate::output::{Printable, Sheet};
use crate::problem::{Fault, Problem};
use crate::progress::Progress;
use preisach_dyn::ActuatorModel;
use rotor_flight::{
    DrawnCase, FailureStudy, FlightError, FlownCase, FlyingCase, MarginStudy, controllers_section,
    dissimilar_note, draws_section, failures_of_case, failures_section, margins_section,
};
use serde::Serialize;

/// What a case without a flight is told.
const NO_FLIGHT: &str = "the case has no flight to fly; add `flight: ()`, which is 60 s with an advance ratio of 0.15 to 0.30, or see `hhc init` for its fields";

/// A flown case with what is said of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightResult {
    /// Title of the case.
    pub title: String,
    /// What truth is, and what was asked for.
    pub notes: Vec<String>,
    /// What a reader should know first.
    pub warnings: Vec<String>,
    /// Harmonics commanded, per rev.
    pub harmonics: Vec<usize>,
    /// Blade number, per rev of the hub loads.
    pub blades: usize,
    /// Units of the loads, N and N m.
    pub units: [f64; 2],
    /// The flights.
    pub flown: FlownCase,
    /// Many draws of the noise, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn: Option<DrawnCase>,
    /// How wrong T may be, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margins: Option<MarginStudy>,
    /// What control reaches under failures, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failures: Option<FailureStudy>,
}

/// What is asked for beside the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Beside {
    /// What control reaches under failures.
    pub failures: bool,
    /// How wrong T may be.
    pub margins: bool,
    /// Draws of the noise.
    pub draws: Option<usize>,
}

/// Flies a case, with what is asked for beside.
///
/// # Errors
/// A case without a flight; what its actuators are refused for; [`SimError::Flight`].
pub fn flown(loaded: &LoadedCase, beside: Beside) -> Result<FlightResult, SimError> {
    let case = &loaded.case;
    let values = flight_values(loaded)?;
    // what is said of the actuator is of the harmonics flown
    let mut flying = loaded.clone();
    flying.case.control.harmonics = vec![values.harmonics.clone()];
    let actuators = case_actuators(&flying)?;
    let model = actuators.real.as_ref().unwrap_or(&actuators.ideal);
    let flights = values.controllers.len() * (1 + beside.draws.unwrap_or(0));
    let others = usize::from(beside.margins) + usize::from(beside.failures);
    let progress = Progress::new(1 + flights + others);
    progress.doing("trims and flights");
    let find = || {
        let flying = FlyingCase::new(case, values, model)?;
        progress.step();
        let flown = flying.fly(&|| progress.step())?;
        let drawn = beside.draws.map(|draws| flying.draws(draws, &|| progress.step()));
        progress.doing("margins and failures");
        let margins = beside.margins.then(|| flying.margins()).transpose()?;
        let failures = beside.failures.then(|| failures_of_case(case, values)).transpose()?;
        Ok((flown, drawn.transpose()?, margins, failures))
    };
    let found = find();
    progress.finish();
    let (flown, drawn, margins, failures) = found.map_err(|source| flight_error(loaded, source))?;
    let scales = case.scales();
    Ok(FlightResult {
        title: case.title.clone(),
        notes: notes(values, &actuators.data_title)
            .into_iter()
            .chain(dissimilar_note(case))
            .collect(),
        warnings: [&loaded.warnings[..], &actuators.warnings[..]].concat(),
        harmonics: values.harmonics.clone(),
        blades: case.rotor.blades,
        units: [scales.force_newton(), scales.moment_newton_metre()],
        flown,
        drawn,
        margins,
        failures,
    })
}

/// An error of a flight at the field of the case that asked for it.
fn flight_error(loaded: &LoadedCase, source: FlightError) -> SimError {
    SimError::Flight { place: loaded.index.place(source.field()), source: Box::new(source) }
}

/// What leaves a case, as values; its warnings beside.
///
/// # Errors
/// What its actuators are refused for; [`SimError::Flight`].
pub fn leaving<T>(
    loaded: &LoadedCase,
    of: fn(&Case, &ActuatorModel) -> Result<T, FlightError>,
) -> Result<(T, Vec<String>), SimError> {
    let actuators = case_actuators(loaded)?;
    let model = actuators.real.as_ref().unwrap_or(&actuators.ideal);
    let found = of(&loaded.case, model).map_err(|source| flight_error(loaded, source))?;
    Ok((found, [&loaded.warnings[..], &actuators.warnings[..]].concat()))
}

/// The flight of a case.
///
/// # Errors
/// A case without one.
pub(crate) fn flight_values(loaded: &LoadedCase) -> Result<&FlightValues, Problem> {
    let fault = || Fault::Refused { message: NO_FLIGHT.to_owned() };
    let problem = || Problem::new(loaded.index.place("flight"), fault());
    loaded.case.flight.as_ref().ok_or_else(problem)
}

/// What truth is and what happens, in sentences.
fn notes(values: &FlightValues, actuator: &str) -> Vec<String> {
    let actuator = if actuator.is_empty() { "the ideal linear one" } else { actuator };
    let mut notes = vec![
        format!(
            "Truth: the rotor in trim at {} advance ratios, linear in its flaps, interpolated linearly in between. Every revolution is a steady state.",
            if values.is_level() { 1 } else { values.knots }
        ),
        format!(
            "Actuators: {actuator}. Each flap is marched through its own hysteresis, all harmonics at once."
        ),
        format!(
            "Speed: advance ratio {} to {} in {} s from {} s on.",
            values.start_advance_ratio, values.end_advance_ratio, values.ramp_s, values.ramp_at_s
        ),
    ];
    notes.extend(values.thrust_step.map(|step| {
        format!("Thrust: times {} within {} s from {} s on.", step.ratio, step.length_s, step.at_s)
    }));
    notes.extend(values.failed_flap.map(|failed| {
        let told = if failed.notice == Notice::Told { "told" } else { "not told" };
        let on = if failed.on == FailedOn::OneBlade { "one blade" } else { "every blade" };
        let (flap, at_s, stuck_deg) = (failed.flap, failed.at_s, failed.stuck_deg);
        let kept = failed.kept_percent;
        let left = if kept > 0.0 { format!(" with {kept} % of its motion") } else { String::new() };
        format!("Failure: flap {flap} of {on} stuck at {stuck_deg} deg{left} from {at_s} s on; the controller is {told}.")
    }));
    let (noise, seed) = (values.noise_percent, values.seed);
    let told = if values.noise_notice == Notice::Told { "told to" } else { "estimated by" };
    notes.push(format!(
        "Noise: {noise} % of the loads at the start in each revolution, seed {seed}; {told} the adaptive controller."
    ));
    notes
}

/// Every cycle of every controller: a row each.
pub fn flight_csv(of: &FlightResult) -> String {
    rotor_flight::flight_csv(&of.flown, &of.harmonics, of.blades, of.units)
}

impl Printable for FlightResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(&self.title);
        for note in &self.notes {
            sheet.paragraphs(note);
        }
        sheet.block(&controllers_section(&self.flown).to_string());
        let drawn = self.drawn.as_ref().map(draws_section);
        let margins = self.margins.as_ref().map(margins_section);
        let failures = self.failures.as_ref().map(failures_section);
        for section in drawn.into_iter().chain(margins).chain(failures) {
            sheet.block(&section.to_string());
        }
        sheet.finish()
    }
}
