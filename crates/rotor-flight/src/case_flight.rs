//! The flight that a case describes.

use crate::{FlapFailure, Flight, FlightError, FlightPoint, Guidance, OwnActuator, RotorPath};
use hhc_control::{ControlLayout, EstimatorSettings, FeedbackLaw, LoadWeights, RelaxedSettings};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rotor_case::{
    Case, FailedOn, FlapActuator, FlightController, FlightValues, Notice, TrimValues,
};
use rotor_study::{HUB_OUTPUTS, HubLoads, Setting, least_effort, output_weights};
use serde::Serialize;
use std::sync::Arc;

/// Change of T over full scale that an adaptive controller expects, part of the error that it takes T0 to have.
const T_DRIFT_OF_ERROR: f64 = 0.5;
/// Least noise that a controller is told, part of the loads: the rotor is not linear to the last digit.
const LEAST_NOISE: f64 = 1e-3;
/// Cycles that count as the end of a flight, and how far `J / J0` may lie from their mean when it has settled.
const END_CYCLES: usize = 10;
const SETTLED_WITHIN: f64 = 0.05;

/// The flights of a case: one rotor and one schedule under several controllers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlownCase {
    /// Hub loads without control at the start, cosine and sine of six, nondimensional.
    pub start: [f64; HUB_OUTPUTS],
    /// A flight of each controller, in the order of the case.
    pub flights: Vec<FlownController>,
}

/// A controller's flight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlownController {
    /// Its name.
    pub controller: &'static str,
    /// What it amounts to.
    pub summary: FlightSummary,
    /// A point for every cycle.
    pub points: Vec<FlightPoint>,
}

/// What a flight amounts to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightSummary {
    /// Mean of `J / J0` over all cycles.
    pub mean_cost_ratio: f64,
    /// The largest, of the cycles with control: the first has none yet.
    pub worst_cost_ratio: f64,
    /// End of that cycle, s.
    pub worst_at_s: f64,
    /// Mean over the last ten cycles.
    pub end_cost_ratio: f64,
    /// Mean over the last ten cycles of `J` of the loads at 1/rev over `J0`.
    pub end_once_per_rev_ratio: f64,
    /// The same of those at 2 to twice the blade number less one per rev, but for the blade number.
    pub end_other_ratio: f64,
    /// Both without control.
    pub end_off_blade_number_at_rest: [f64; 2],
    /// Time from the last disturbance of the schedule until `J / J0` stays within 0.05 of the mean of the last ten cycles, s;
    /// none if it does not before these.
    pub settles_in_s: Option<f64>,
    /// Part of the cycles whose control a limit of an amplitude bound, 0 to 1.
    pub limited_share: f64,
    /// Part of the samples whose voltage was held at an end of the range, 0 to 1.
    pub held_share: f64,
    /// Mean power that the actuators of one blade give, W.
    pub power_watt: f64,
}

impl FlightSummary {
    /// Of the points of a flight, one at least, whose last disturbance ends at a time.
    pub(crate) fn of(points: &[FlightPoint], disturbed_s: f64) -> Self {
        let count = points.len() as f64;
        let mean = |of: &dyn Fn(&FlightPoint) -> f64| points.iter().map(of).sum::<f64>() / count;
        let last = &points[points.len().saturating_sub(END_CYCLES)..];
        let at_end =
            |of: &dyn Fn(&FlightPoint) -> f64| last.iter().map(of).sum::<f64>() / last.len() as f64;
        let end = at_end(&|p| p.cost_ratio);
        let is_off = |p: &FlightPoint| (p.cost_ratio - end).abs() > SETTLED_WITHIN;
        let settled = points.iter().rposition(is_off).map_or(0, |k| k + 1);
        let settles_in_s = (settled + last.len() <= points.len())
            .then(|| (points[settled].time_s - disturbed_s).max(0.0));
        let (worst_cost_ratio, worst_at_s) = points
            .iter()
            .skip(1)
            .map(|p| (p.cost_ratio, p.time_s))
            .fold((0.0, 0.0), |worst, own| if own.0 > worst.0 { own } else { worst });
        Self {
            mean_cost_ratio: mean(&|p| p.cost_ratio),
            worst_cost_ratio,
            worst_at_s,
            end_cost_ratio: end,
            end_once_per_rev_ratio: at_end(&|p| p.once_per_rev_ratio),
            end_other_ratio: at_end(&|p| p.other_ratio),
            end_off_blade_number_at_rest: [0, 1]
                .map(|k| at_end(&|p: &FlightPoint| p.off_blade_number_at_rest[k])),
            settles_in_s,
            limited_share: mean(&|p| f64::from(u8::from(p.is_limited))),
            held_share: mean(&|p| p.held_share),
            power_watt: mean(&|p| p.power_watt),
        }
    }
}

/// An actuator with the range of voltages of a case.
pub(crate) fn ranged(case: &Case, model: &ActuatorModel) -> Result<ActuatorModel, FlightError> {
    let (low, high) = case.actuator.range_volt;
    let range_volt =
        VoltageRange::new(low, high).map_err(|source| FlightError::Actuator { flap: 0, source })?;
    Ok(ActuatorModel { range_volt, ..model.clone() })
}

/// The rotor along the schedule of a flight.
pub(crate) fn path_of(case: &Case, values: &FlightValues) -> Result<RotorPath, FlightError> {
    let (from, to) = (values.start_advance_ratio, values.end_advance_ratio);
    let (low, span) = (from.min(to), (to - from).abs());
    let knots = if values.is_level() { 1 } else { values.knots };
    let place = |k: usize| low + span * k as f64 / (knots - 1).max(1) as f64;
    let path = RotorPath::new(case, &(0..knots).map(place).collect::<Vec<f64>>())?;
    match &values.thrust_step {
        None => Ok(path),
        Some(step) => path.with_thrust_step(&at_thrust(case, step.ratio)),
    }
}

/// The same with the blades that are unlike the rest, have an actuator of their own, or a flap that fails alone.
pub(crate) fn flown_path_of(case: &Case, values: &FlightValues) -> Result<RotorPath, FlightError> {
    let path = path_of(case, values)?;
    let failed = values.failed_flap.filter(|failed| failed.on == FailedOn::OneBlade);
    let own = values.flap_actuators.iter().filter_map(|own| Some((own.blade? - 1, own.flap - 1)));
    let moved: Vec<(usize, usize)> = own.chain(failed.map(|failed| (0, failed.flap - 1))).collect();
    if moved.is_empty() && case.rotor.dissimilar_blades.is_empty() {
        return Ok(path);
    }
    path.with_blades(case, &moved)
}

/// A case whose thrust or weight is multiplied by a ratio; controls that are given stay.
fn at_thrust(case: &Case, ratio: f64) -> Case {
    let mut after = case.clone();
    match &mut after.trim {
        TrimValues::Propulsive(own) => own.ct_sigma *= ratio,
        TrimValues::WindTunnel(own) => own.ct_sigma *= ratio,
        TrimValues::Prescribed(_) => {}
    }
    after
}

/// A straight change of a value between two times as points of a schedule.
fn ramp([from, to]: [f64; 2], at_s: f64, length_s: f64) -> Vec<(f64, f64)> {
    vec![(at_s, from), (at_s + length_s, to)]
}

/// The flight of a case without what it needs to know of T.
pub(crate) fn unguided<'a>(
    case: &Case,
    values: &FlightValues,
    path: &'a RotorPath,
    model: &'a ActuatorModel,
) -> Result<Flight<'a>, FlightError> {
    let harmonics = values.harmonics.iter().filter_map(|&n| u32::try_from(n).ok()).collect();
    let layout = ControlLayout::new(case.flaps.len(), harmonics)?;
    let speeds = [values.start_advance_ratio, values.end_advance_ratio];
    let settings = RelaxedSettings {
        gain: values.gain,
        amplitude_limit_volt: vec![values.amplitude_limit_volt; layout.pairs()],
        rate_limit_volt: values.rate_limit_volt,
        rate_weight: values.rate_weight,
        flap_survival: 0.01 * values.flap_survival_percent,
        dead_flap_cost: 0.01 * values.dead_flap_percent,
        ..RelaxedSettings::of_layout(&layout)
    };
    let own = |(index, own): (usize, &FlapActuator)| {
        let model = own.model.as_ref().ok_or(FlightError::FlapActuator { index })?;
        Ok(OwnActuator {
            flap: own.flap - 1,
            blade: own.blade.map(|blade| blade - 1),
            model: Arc::new(ranged(case, model)?),
            is_told: own.notice == Notice::Told,
        })
    };
    let own_actuators = values.flap_actuators.iter().enumerate().map(own);
    Ok(Flight {
        path,
        model,
        own_actuators: own_actuators.collect::<Result<_, FlightError>>()?,
        actuator_rev_hz: case.actuator.bench_rev_hz,
        bias: case.control.drive_bias(),
        rotor_rev_hz: case.rotor.omega_rpm / 60.0,
        advance_ratio: ramp(speeds, values.ramp_at_s, values.ramp_s),
        thrust_share: values
            .thrust_step
            .map(|step| ramp([0.0, 1.0], step.at_s, step.length_s))
            .unwrap_or_default(),
        duration_s: values.duration_s,
        noise_share: 0.01 * values.noise_percent,
        seed: values.seed as u64,
        failure: values.failed_flap.map(|failed| FlapFailure {
            flap: failed.flap - 1,
            time_s: failed.at_s,
            stuck_deg: failed.stuck_deg,
            kept_share: 0.01 * failed.kept_percent,
            is_told: failed.notice == Notice::Told,
            is_on_one_blade: failed.on == FailedOn::OneBlade,
        }),
        cycle_rev: [values.settling_rev, values.window_rev],
        step_volt: case.t_step_volt(),
        settings,
        layout,
        handed_t: None,
    })
}

/// The flight of a case, its cost and least effort by its start.
pub(crate) fn flight_of<'a>(
    case: &Case,
    values: &FlightValues,
    path: &'a RotorPath,
    model: &'a ActuatorModel,
) -> Result<Flight<'a>, FlightError> {
    let mut flight = unguided(case, values, path, model)?;
    if let Some(handed) = &case.control.handed_t {
        flight.handed_t = Some(handed.set(&values.harmonics)?.clone());
    }
    let state = flight.state_at(0.0);
    let start = HubLoads::from_parts(path.loads(state, &[])?);
    let weights: LoadWeights =
        output_weights(&Setting::of_case(case, &start).load_weights(), HUB_OUTPUTS);
    let law = FeedbackLaw::new(&flight.identify(state)?, &weights)?;
    flight.settings.effort_weight = least_effort(&law);
    flight.settings.load_weights = weights;
    Ok(flight)
}

/// How a controller knows T.
pub(crate) fn guidance_of(
    controller: FlightController,
    case: &Case,
    values: &FlightValues,
) -> Guidance {
    match controller {
        FlightController::Fixed => Guidance::Fixed,
        FlightController::Scheduled => Guidance::Scheduled,
        FlightController::Adaptive => Guidance::Adaptive(EstimatorSettings {
            uncertainty: 0.01 * values.t0_error_percent,
            drift: T_DRIFT_OF_ERROR * 0.01 * values.t0_error_percent,
            baseline_drift: 0.01 * values.z0_walk_percent,
            trend_drift: 0.01 * values.z0_trend_percent,
            dither_rad: values.dither_deg.to_radians(),
            noise_share: (values.noise_notice == Notice::Told).then(|| told_noise(values)),
            ..EstimatorSettings::in_flight(case.control.amplitude_volt)
        }),
    }
}

/// Noise of a load as a cycle measures it, the mean over its window, part of the loads at the start.
fn told_noise(values: &FlightValues) -> f64 {
    (0.01 * values.noise_percent / (values.window_rev as f64).sqrt()).max(LEAST_NOISE)
}

/// When the last change of the schedule has ended, s; 0 without any.
pub(crate) fn last_disturbance_s(values: &FlightValues) -> f64 {
    let ends = [
        (!values.is_level()).then_some(values.ramp_at_s + values.ramp_s),
        values.thrust_step.map(|step| step.at_s + step.length_s),
        values.failed_flap.map(|failed| failed.at_s),
    ];
    ends.into_iter().flatten().filter(|end| *end < values.duration_s).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told is the noise that a cycle's window leaves of that of a revolution.
    #[test]
    fn the_noise_that_is_told_is_that_of_a_cycle() {
        let case = Case::default();
        let share =
            |values: &FlightValues| match guidance_of(FlightController::Adaptive, &case, values) {
                Guidance::Adaptive(settings) => settings.noise_share,
                _ => None,
            };
        let untold = FlightValues { noise_percent: 4.0, window_rev: 4, ..FlightValues::default() };
        assert_eq!(share(&untold), None);
        let told = FlightValues { noise_notice: Notice::Told, ..untold };
        assert!((share(&told).unwrap() - 0.02).abs() < 1e-15);
        let quiet = FlightValues { noise_percent: 0.0, ..told };
        assert!(share(&quiet).unwrap() > 0.0, "a filter is never told that there is none");
    }
}
