//! The inflow of a case: a linear model, or a free wake settled with the trim.

use crate::error::StudyError;
use rotor_case::{Case, CirculationChoice};
use rotor_response::{ResponseError, ResponseTolerances, RotorSolver};
use rotor_wake::{
    ClosestPassage, FlightState, InflowModel, WAKE_BREAKDOWN_TRANSPORT, descent_transport,
    inflow_over_momentum,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use trim::{
    TrimError, TrimSolution, WakeOutcome, WakeTrim, trim, trim_in_free_wake, trim_in_free_wake_near,
};

/// Iterations of circulation and inflow allowed in a free wake, at least.
const WAKE_ITERATIONS: usize = 200;

/// How the iteration of a free wake and the trim ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WakeStatus {
    /// Wake, inflow and trim are within their tolerances.
    #[serde(alias = "settled")]
    Converged,
    /// Not within them after all updates: the state with the least change.
    #[serde(alias = "not-settled")]
    NotConverged,
    /// The iteration diverged, or settled on too little inflow: no solution.
    #[serde(alias = "parted")]
    Diverged,
}

impl WakeStatus {
    /// As in JSON and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::NotConverged => "not-converged",
            Self::Diverged => "diverged",
        }
    }
}

/// A trim with the inflow it settled on, and the wake if there is a free one.
#[derive(Debug, Clone)]
pub struct SettledTrim {
    /// The trim.
    pub trim: TrimSolution,
    /// Its inflow; a free wake held still.
    pub inflow: Arc<dyn InflowModel>,
    /// The free wake.
    pub wake: Option<Arc<WakeTrim>>,
}

/// Refuses to trim a rotor in the wake of a circulation that is not its own.
///
/// # Errors
/// [`StudyError::Refused`].
pub(crate) fn refuse_prescribed_circulation(case: &Case) -> Result<(), StudyError> {
    let wake = case.inflow.model.free_wake();
    if wake.is_none_or(|wake| wake.circulation == CirculationChoice::Trimmed) {
        return Ok(());
    }
    let message = "a rotor is trimmed with the circulation it has: leave it out, or look at the wake alone with `hhc wake`";
    let field = "inflow.model.circulation".to_owned();
    Err(StudyError::Refused { field, message: message.to_owned() })
}

/// Trims the rotor of a case in the inflow the case asks for, from a nearby trim and from its wake at the same advance
/// ratio if there are such; where that one's wake does not lead to a settled one, the free wake is built up anew.
///
/// # Errors
/// The errors of the trim and of the wake.
pub fn settled_trim(
    case: &Case,
    solver: &mut RotorSolver,
    start: Option<&TrimSolution>,
    near: Option<&WakeTrim>,
) -> Result<SettledTrim, TrimError> {
    let (mu, target, settings) = (case.advance_ratio, case.trim_target(), case.trim_settings());
    let choice = &case.inflow.model;
    let Some(inflow) = choice.model() else {
        let coupling = case.wake_trim_settings(&choice.free_wake().unwrap_or_default());
        let tolerances = solver.tolerances();
        let inflow_iterations = tolerances.inflow_iterations.max(WAKE_ITERATIONS);
        *solver = solver.with_tolerances(ResponseTolerances { inflow_iterations, ..tolerances });
        let near = near.and_then(|near| {
            let found = trim_in_free_wake_near(solver, &coupling, near, &target, &settings);
            found.ok().filter(|wake| wake.outcome == WakeOutcome::Settled)
        });
        let wake = match near {
            Some(wake) => wake,
            None => trim_in_free_wake(solver, &coupling, mu, &target, &settings)?,
        };
        let (trim, inflow) = (wake.trim.clone(), Arc::new(wake.frozen.clone()));
        return Ok(SettledTrim { trim, inflow, wake: Some(Arc::new(wake)) });
    };
    let trim = trim(solver, inflow.as_ref(), mu, &target, &settings, start)?;
    Ok(SettledTrim { trim, inflow, wake: None })
}

/// What may help a wake that does not settle.
const WAKE_REMEDY: &str = "Remedy: means in time, `hhc wake CASE.ron --in-time`; more `updates` if all were used; `mutual_core_r` or `near_core_r` of 0.1, which is another wake";
/// The same at low speed, where wider cores do not help.
const SLOW_WAKE_REMEDY: &str = "Remedy: at this speed there may be no periodic wake; `hhc wake CASE.ron --in-time` has the means of one in time";
/// Advance ratio below which a speed is low.
const LOW_SPEED: f64 = 0.1;

/// What may help the wake of a flight.
fn remedy(flight: &FlightState) -> &'static str {
    if flight.advance_ratio < LOW_SPEED { SLOW_WAKE_REMEDY } else { WAKE_REMEDY }
}

/// Mean inflow over that of momentum theory, least and most, that a rotor in its wake has.
const MOMENTUM: [f64; 2] = [0.5, 2.5];

/// Where a coupling that failed has stopped, on a grid of so many steps per revolution.
fn kept(
    azimuths: usize,
    (updates, inflow_change): (usize, f64),
    error: &TrimError,
    remedy: &str,
) -> String {
    let error = match error {
        TrimError::Response(ResponseError::Wake(wake)) => wake.to_string(),
        error => error.to_string(),
    };
    let state = if inflow_change.is_finite() {
        format!(
            "what is given is the state of the least change of the inflow, {inflow_change:.1e} of the tip speed, on {azimuths} steps per revolution"
        )
    } else {
        format!(
            "what is given is the last state before, on {azimuths} steps per revolution: of a coarser grid if the case asks for more"
        )
    };
    format!(
        "wake and trim part after {updates} updates: {error}; {state}. First: `response.time_elements: 16` resolves a vortex that lies on a blade. {remedy}"
    )
}

/// How the coupling with a wake ended, in a word.
pub fn wake_status(wake: &WakeTrim) -> WakeStatus {
    match wake.outcome {
        WakeOutcome::Settled => WakeStatus::Converged,
        WakeOutcome::NotSettled { .. } => WakeStatus::NotConverged,
        _ => WakeStatus::Diverged,
    }
}

/// What a user should know about a wake; empty if there is nothing.
pub fn wake_warnings(wake: &WakeTrim) -> Vec<String> {
    let mut warnings = Vec::new();
    let (azimuths, remedy) = (wake.wake.settings().azimuths, remedy(&wake.trim.flight));
    match &wake.outcome {
        WakeOutcome::NotSettled {
            updates,
            inflow_change,
            tolerance,
            displacement,
            displacement_tolerance,
            theta0_band_rad,
        } => {
            let [low, high] = theta0_band_rad.map(f64::to_degrees);
            warnings.push(format!(
                "the free wake has not settled in {updates} updates: the inflow still changes by {inflow_change:.1e} of the tip speed ({tolerance:.1e} was asked) and the wake moves by {displacement:.1e} R ({displacement_tolerance:.1e}) in the update kept, the nearest to rest; theta0 between {low:.3} and {high:.3} deg in it and the second half of the updates, which is no bound, on {azimuths} steps per revolution. {remedy}"
            ));
        }
        WakeOutcome::TooLittleInflow { of_momentum } => warnings.push(format!(
            "the free wake carries hardly any of the thrust: its mean inflow is {of_momentum:.2} of momentum theory's. What is given is no solution. Remedy: more thrust where blades carry lift of both senses along the span; look at the circulation of the sections (`hhc wake --out DIR`), or compare with inflow.model: Uniform"
        )),
        WakeOutcome::Failed { updates, inflow_change, error } => {
            warnings.push(kept(azimuths, (*updates, *inflow_change), error, remedy));
        }
        _ => {}
    }
    let (flight, thrust) = (&wake.trim.flight, wake.trim.rotor.thrust_coefficient);
    let settled = wake.outcome == WakeOutcome::Settled;
    if settled && (f64::MIN_POSITIVE..LOW_SPEED).contains(&flight.advance_ratio) {
        warnings.push("the free wake has settled at low speed, where it may not be stable: a rotor in time may leave it. Compare with `hhc wake CASE.ron --in-time`".to_owned());
    }
    warnings.extend(descent_warning(flight, thrust, settled));
    if !matches!(wake.outcome, WakeOutcome::TooLittleInflow { .. }) {
        warnings.extend(momentum_warning(flight, thrust, wake.trim.rotor.inflow.mean()));
    }
    warnings.extend(wake.closest_passage.and_then(passage_warning));
    warnings
}

/// What a user should know about the wake of a descent.
pub(crate) fn descent_warning(
    flight: &FlightState,
    thrust_coefficient: f64,
    settled: bool,
) -> Option<String> {
    let transport = descent_transport(flight, thrust_coefficient)?;
    let breaks_down = transport < WAKE_BREAKDOWN_TRANSPORT;
    let state = if breaks_down { "in the" } else { "near the" };
    (breaks_down || (transport < 1.0 && !settled)).then(|| {
        format!(
            "{state} vortex-ring state: in this descent the wake is carried away with {transport:.2} of the hover induced velocity, and below {WAKE_BREAKDOWN_TRANSPORT} wakes break down and the flow is unsteady: a periodic wake stands for its mean at best. Fly faster, or descend less or much more steeply"
        )
    })
}

/// What a user should know about an inflow that does not go with the thrust.
fn momentum_warning(flight: &FlightState, thrust_coefficient: f64, mean: f64) -> Option<String> {
    let ratio = inflow_over_momentum(flight, thrust_coefficient, mean)?;
    let [least, most] = MOMENTUM;
    (!(least..=most).contains(&ratio)).then(|| {
        format!(
            "the mean inflow is {ratio:.2} of momentum theory's for this thrust, {least} to {most} are usual: lightly loaded blades carry lift of both senses along the span, the wake has more than one state, and neither trim nor power can be trusted. Remedy: more thrust, or compare with inflow.model: Uniform"
        )
    })
}

/// What a user should know about a vortex that passes a blade closely.
pub(crate) fn passage_warning(passage: ClosestPassage) -> Option<String> {
    passage.within_core().then(|| {
        format!(
            "a tip vortex of age {:.0} deg passes the blade at azimuth {:.0} deg, {:.2} R, at {:.4} R, closer than its core ({:.4} R): the core radius decides the load there",
            passage.age_rad.to_degrees(),
            passage.azimuth_rad.to_degrees(),
            passage.station,
            passage.distance,
            passage.core_radius
        )
    })
}
