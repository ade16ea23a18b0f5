//! `hhc fly`: the flight of a case in time, as table, CSV and page.

mod page;

pub use page::flight_html;

use crate::SimError;
use crate::actuator::{case_actuators, with_flap_actuators};
use crate::case::{Case, FlightValues, LoadedCase};
use crate::output::{Printable, Sheet};
use crate::problem::{Fault, Problem};
use crate::progress::Progress;
use preisach_dyn::ActuatorModel;
use rotor_flight::{
    DrawnCase, FailureStudy, FlightError, FlownCase, FlyingCase, MarginStudy, controllers_section,
    draws_section, failures_of_case, failures_section, flight_notes, margins_section,
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
    let (loaded, own_warnings) = &with_flap_actuators(loaded)?;
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
        notes: flight_notes(case, values, &actuators.data_title),
        warnings: [&loaded.warnings[..], &actuators.warnings, own_warnings].concat(),
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
    let (loaded, own_warnings) = &with_flap_actuators(loaded)?;
    let actuators = case_actuators(loaded)?;
    let model = actuators.real.as_ref().unwrap_or(&actuators.ideal);
    let found = of(&loaded.case, model).map_err(|source| flight_error(loaded, source))?;
    Ok((found, [&loaded.warnings[..], &actuators.warnings, own_warnings].concat()))
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
