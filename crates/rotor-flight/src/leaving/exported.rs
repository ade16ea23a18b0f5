//! T at the knots of a case as arrays with names and units, and its controllers to be written in other languages.

use super::labels::{AFTER_STEP, POINT_AT, T_OF, control_labels, load_axis, load_labels};
use super::settings::{self, actuator_note, inflow_note};
use crate::case_flight::{flight_of, guidance_of, path_of, ranged, unguided};
use crate::{Flight, FlightError, FlightState, Guidance};
use preisach_dyn::ActuatorModel;
use rotor_case::{Case, FlightController, FlightValues};
use rotor_export::{Axis, ControllerSpec, Document, LabelledArray, TKnowledge};
use rotor_study::{HUB_OUTPUTS, HubLoads, TrimmedRotor};

/// Highest harmonic of the flaps that the rotor along a path is linearised for.
const HIGHEST_LINEARISED: usize = 10;

/// T, baseline and conditions of a case at the knots of its flight, or at its own advance ratio where it has none, for every
/// set of harmonics that it controls.
///
/// ```text
/// T_j = ( Z(+h e_j) - Z(-h e_j) ) / 2h,     h the step of T, flaps and bias settled, about zero control
/// P   = s^2 (Phi' Phi)^-1 = s^2 diag( 1/(2n+1), 1/(2 h^2), ... ),     s^2 = s_rev^2 / window
/// ```
/// `P` is the covariance of `(Z0, T_i)` of one load when all `2n` steps and the rest are measured once each, with the noise
/// that the flight states; it is zero without noise. It is no statement about what the model of the rotor errs by.
///
/// Source: least squares, A. Gelb (ed.), *Applied Optimal Estimation* (1974), section 4.
///
/// # Errors
/// [`FlightError`]: trims, the linearised rotor, actuators, a set with a harmonic above 10.
pub fn exported_case(case: &Case, model: &ActuatorModel) -> Result<Document, FlightError> {
    let level = FlightValues {
        start_advance_ratio: case.advance_ratio,
        end_advance_ratio: case.advance_ratio,
        noise_percent: 0.0,
        ..FlightValues::default()
    };
    let values = case.flight.as_ref().unwrap_or(&level);
    let (path, model) = (path_of(case, values)?, ranged(case, model)?);
    let points: Vec<(FlightState, &TrimmedRotor)> = path.rotors().collect();
    let mut sets = case.control.harmonics.clone();
    if case.flight.is_some() {
        sets.retain(|set| *set != values.harmonics);
        sets.insert(0, values.harmonics.clone());
    }
    let mut document = Document {
        title: case.title.clone(),
        notes: notes(case, values),
        arrays: vec![conditions(case, &points), baseline(case, &points), load_units(case)],
    };
    document.arrays.extend(settings::arrays(case));
    for set in sets {
        if let Some(&n) = set.iter().find(|n| **n > HIGHEST_LINEARISED) {
            let (what, value) =
                ("harmonic of `control.harmonics` whose T is asked for (per rev)", n as f64);
            return Err(FlightError::OutOfRange { what, value, expected: "1 to 10" });
        }
        let values = FlightValues { harmonics: set.clone(), ..values.clone() };
        let flight = unguided(case, &values, &path, &model)?;
        document.arrays.extend(sensitivity(case, &set, &flight, &points)?);
    }
    Ok(document)
}

/// Samples of a revolution that a controller in other languages takes.
const SAMPLES_PER_REV: usize = 128;

/// What the controllers of a case's flight hold, each with its name, to be written in other languages; none without a flight.
///
/// # Errors
/// As [`exported_case`]; [`FlightError::Control`].
pub fn controllers_of_case(
    case: &Case,
    model: &ActuatorModel,
) -> Result<Vec<(&'static str, ControllerSpec)>, FlightError> {
    let Some(values) = &case.flight else { return Ok(Vec::new()) };
    let (path, model) = (path_of(case, values)?, ranged(case, model)?);
    let flight = flight_of(case, values, &path, &model)?;
    let (steps, start) = (flight.steps()?, path.loads(flight.state_at(0.0), &[])?);
    let scales = case.scales();
    let channel = |(k, name): (usize, &&str)| {
        let (unit, scale) = if k < 3 {
            ("N", scales.force_newton())
        } else {
            ("N m", scales.moment_newton_metre())
        };
        (format!("{} ({unit})", name.to_uppercase()), scale)
    };
    let spec = |&controller: &FlightController| {
        let t_at = |state| flight.t_in(state, &steps);
        let first = || t_at(flight.state_at(0.0));
        let knowledge = match guidance_of(controller, case, values) {
            Guidance::Fixed => TKnowledge::Fixed(first()?),
            Guidance::Scheduled => {
                let advance_ratios = path.advance_ratios().to_vec();
                let at =
                    |&advance_ratio: &f64| t_at(FlightState { advance_ratio, thrust_share: 0.0 });
                let t = advance_ratios.iter().map(at).collect::<Result<_, _>>()?;
                TKnowledge::Scheduled { advance_ratios, t }
            }
            Guidance::Adaptive(settings) => {
                TKnowledge::Adaptive { settings, t0: first()?, baseline: start.to_vec() }
            }
        };
        let own = ControllerSpec {
            title: case.title.clone(),
            layout: flight.layout.clone(),
            settings: flight.settings.clone(),
            knowledge,
            channels: HubLoads::NAMES.iter().enumerate().map(channel).collect(),
            load_harmonic: u32::try_from(case.rotor.blades).unwrap_or_default(),
            samples_per_rev: SAMPLES_PER_REV,
            cycle_rev: flight.cycle_rev,
        };
        Ok((controller.name(), own))
    };
    values.controllers.iter().map(spec).collect()
}

fn notes(case: &Case, values: &FlightValues) -> Vec<String> {
    let mut notes = vec![
        "Z = Z0 + T u. Loads: cosine and sine of six hub loads in the fixed frame at the blade number per rev, X aft, Y starboard, Z up, over the units in `load_unit`. Controls: cosine and sine voltage of each flap at each harmonic, V; A cos(n psi - phase), psi = 0 over the tail.".to_owned(),
        inflow_note(case),
        actuator_note(case),
        format!("T: central differences about zero control with {} V, flaps and bias settled in their hysteresis, all others at rest.", case.t_step_volt()),
    ];
    let noise = values.noise_percent;
    notes.push(if noise > 0.0 {
        format!("Covariance: of (Z0, T) of one load, from one measurement at rest and one of each step up and down, {} revolutions each, with noise of {noise} % of the loads at the start in each revolution. Its units are those of the parameters multiplied, loads nondimensional.", values.window_rev)
    } else {
        "Covariance: zero, since the case states no noise (`flight.noise_percent`).".to_owned()
    });
    notes.extend(dissimilar_note(case));
    notes
}

/// The points of all arrays.
fn point_axis(points: &[(FlightState, &TrimmedRotor)]) -> Axis {
    let label = |(state, _): &(FlightState, &TrimmedRotor)| {
        let step = if state.thrust_share > 0.0 { AFTER_STEP } else { "" };
        format!("{POINT_AT}{:.4}{step}", state.advance_ratio)
    };
    Axis::of_unit("point", points.iter().map(label).collect(), "")
}

fn conditions(case: &Case, points: &[(FlightState, &TrimmedRotor)]) -> LabelledArray {
    let solidity = case.rotor_model().solidity();
    let of = |(state, rotor): &(FlightState, &TrimmedRotor)| {
        let trim = rotor.trim();
        [
            ("advance_ratio", "", state.advance_ratio),
            ("thrust_share", "", state.thrust_share),
            ("ct_sigma", "", trim.rotor.thrust_coefficient / solidity),
            ("shaft_tilt_deg", "deg", trim.attitude.shaft_tilt_rad.to_degrees()),
            ("bank_deg", "deg", trim.attitude.roll_rad.to_degrees()),
            ("theta0_deg", "deg", trim.controls.theta0_rad.to_degrees()),
            ("theta1c_deg", "deg", trim.controls.theta1c_rad.to_degrees()),
            ("theta1s_deg", "deg", trim.controls.theta1s_rad.to_degrees()),
            ("induced_inflow", "Omega R", trim.rotor.inflow.mean()),
        ]
    };
    let each: Vec<_> = points.iter().map(of).collect();
    let named = each.first().map_or(&[][..], |first| first);
    let axis = Axis {
        name: "condition".to_owned(),
        labels: named.iter().map(|(name, _, _)| (*name).to_owned()).collect(),
        units: named.iter().map(|(_, unit, _)| (*unit).to_owned()).collect(),
    };
    let meaning = "trim of each point: advance ratio, part of the thrust step made, C_T/sigma, shaft tilt forward positive, bank right positive, collective at 0.75 R and cyclic theta = theta0 + theta1c cos psi + theta1s sin psi, mean induced inflow down positive";
    LabelledArray::from_fn("conditions", meaning, vec![axis, point_axis(points)], |i, j, _| {
        each[j][i].2
    })
}

/// What a case with blades unlike the rest is told.
pub(crate) fn dissimilar_note(case: &Case) -> Option<String> {
    let told = "`rotor.dissimilar_blades` is left out: all blades are alike here.";
    (!case.rotor.dissimilar_blades.is_empty()).then(|| told.to_owned())
}

fn baseline(case: &Case, points: &[(FlightState, &TrimmedRotor)]) -> LabelledArray {
    let loads: Vec<[f64; HUB_OUTPUTS]> = points
        .iter()
        .map(|(_, rotor)| rotor.trim().rotor.hub.harmonic(case.rotor.blades))
        .collect();
    let axes = vec![load_axis(load_labels(case)), point_axis(points)];
    let meaning = "Z0: hub loads with the flaps at rest, unit of the row";
    LabelledArray::from_fn("baseline", meaning, axes, |i, j, _| loads[j][i])
}

fn load_units(case: &Case) -> LabelledArray {
    let scales = case.scales();
    let is_force = |k: usize| k < HUB_OUTPUTS / 2;
    let units =
        (0..HUB_OUTPUTS).map(|k| if is_force(k) { "N" } else { "N m" }.to_owned()).collect();
    let axis = Axis { name: "load".to_owned(), labels: load_labels(case), units };
    let meaning = "what a load of 1 of the other arrays is, m0 Omega^2 R^2 or R^3";
    LabelledArray::from_fn("load_unit", meaning, vec![axis], |i, _, _| {
        if is_force(i) { scales.force_newton() } else { scales.moment_newton_metre() }
    })
}

/// T of a set of harmonics and the covariance of what identifies it.
fn sensitivity(
    case: &Case,
    set: &[usize],
    flight: &Flight<'_>,
    points: &[(FlightState, &TrimmedRotor)],
) -> Result<[LabelledArray; 2], FlightError> {
    let steps = flight.steps()?;
    let each = points.iter().map(|(state, _)| Ok(flight.t_in(*state, &steps)?.columns()));
    let t: Vec<Vec<Vec<f64>>> = each.collect::<Result<_, FlightError>>()?;
    let controls = control_labels(flight.layout.flaps(), set);
    let name: Vec<String> = set.iter().map(usize::to_string).collect();
    let name = name.join("_");
    let axes = vec![
        load_axis(load_labels(case)),
        Axis::of_unit("control", controls.clone(), "V"),
        point_axis(points),
    ];
    let t = LabelledArray::from_fn(
        &format!("{T_OF}{name}"),
        "T = dZ/du: unit of the row per V",
        axes,
        |i, j, k| t[k][j][i],
    );
    let variance = flight.noise(&flight.path.loads(flight.state_at(0.0), &[])?).powi(2)
        / flight.cycle_rev[1] as f64;
    let (count, step) = (controls.len(), flight.step_volt);
    let parameters = Axis {
        name: "parameter".to_owned(),
        labels: std::iter::once("z0".to_owned())
            .chain(controls.iter().map(|control| format!("t_of_{control}")))
            .collect(),
        units: std::iter::once(String::new())
            .chain(std::iter::repeat_n("1/V".to_owned(), count))
            .collect(),
    };
    let columns = Axis { name: "parameter_2".to_owned(), ..parameters.clone() };
    let covariance = LabelledArray::from_fn(
        &format!("covariance_{name}"),
        "covariance of (Z0, T) of each load, the same for all loads and points: unit of the row times that of the column, loads over their `load_unit`",
        vec![parameters, columns],
        |i, j, _| match (i == j, i) {
            (false, _) => 0.0,
            (true, 0) => variance / (2 * count + 1) as f64,
            (true, _) => variance / (2.0 * step * step),
        },
    );
    Ok([t, covariance])
}
