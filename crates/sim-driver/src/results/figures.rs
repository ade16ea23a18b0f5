//! The figures of a result: pure functions of its raw numbers and the case.
//!
//! ```text
//! J_Z = sum_k w_k (Z_kc^2 + Z_ks^2),      reduction = 100 (1 - J_Z / J_Z0)
//! ```

use super::{
    Baseline, ControlEnd, ControlHead, ControlRecord, FlapRecord, Residuals, RunResult, StepRecord,
    TrimLine, set_name,
};
use crate::case::{ControlActuator, ControllerChoice};
use crate::output::unique;
use hhc_control::{Cost, FeedbackLaw, TMatrix, lag_deg};
use rotor_base::RotorScales;
use rotor_response::HingeMoment;
use rotor_study::{
    ControlCost, CostedSet, CurveComparison, Forecast, FrontLine, HingePower, MeanLoads,
    PowerOutputs, SensitivityLine, Setting, StabilityLine, StationLine, UnlikeBladeLine,
    UnlikeLine, VortexComparison, WakeStatus, compare_curves, loads_cost, output_weights,
    sensitivity_lines,
};
use serde::Serialize;

/// What a result says, for people and as JSON: computed where it is shown, stored nowhere.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// The trim found.
    pub trim: TrimLine,
    /// How well the equations are satisfied.
    pub residuals: Residuals,
    /// How wake and trim ended; none without a free wake.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wake: Option<WakeStatus>,
    /// Mean loads on the hub and the power of the shaft.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_loads: Option<MeanLoads>,
    /// Loads without control.
    pub baseline: Baseline,
    /// Amplitudes of `FX FY FZ` at the blade number per rev over the mean vertical force: the vibration in g of a rigid
    /// fuselage that hangs on the hub. None without a lift.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vibration_g: Option<[f64; 3]>,
    /// Loads of one blade along its span without control.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub blade_loads: Vec<StationLine>,
    /// Measured curves beside computed ones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<CurveComparison>,
    /// Measured centres of tip vortices beside the computed vortices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vortices: Option<VortexComparison>,
    /// Stability of the trimmed blade.
    pub stability: StabilityLine,
    /// One entry per set of harmonics and actuator.
    pub control: Vec<ControlLine>,
    /// What the linearised rotor says beforehand, one entry per set.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub forecasts: Vec<Forecast>,
    /// What every control costs: power, piezo, blade loads.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<ControlCost>,
    /// What a fall of `J` costs in the linearised rotor.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fronts: Vec<FrontLine>,
    /// The reductions with one assumption changed at a time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<SensitivityLine>,
    /// Hub loads with dissimilar blades, flaps at rest and after every control.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unlike_blades: Vec<UnlikeLine>,
    /// Stability and loads of every dissimilar blade, flaps at rest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub each_unlike_blade: Vec<UnlikeBladeLine>,
    /// What a reader should know before using the numbers.
    pub warnings: Vec<String>,
}

/// The figures of one control study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ControlLine {
    /// What the record says too.
    #[serde(flatten)]
    pub head: ControlHead,
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// `100 (1 - J_Z / J_Z0)`.
    pub reduction_percent: f64,
    /// Part of the weighted actuation power in the cost, beside `J_Z`; 0 without such a weight.
    pub j_power: f64,
    /// Mean power that the actuators of one blade give, none taken back, W.
    #[serde(rename = "actuation_power_W")]
    pub actuation_power_watt: f64,
    /// One entry per flap, from root to tip; of a set of several harmonics, one after another.
    pub flaps: Vec<FlapLine>,
    /// What the controller knew of T: `global`, `local`, `adaptive`, or `none` for voltages taken over or
    /// inverted.
    pub controller: String,
    /// Weight of each load in `J_Z`, order FX FY FZ MX MY MZ, on nondimensional loads.
    pub load_weights: [f64; 6],
    /// Error of the flap motion at the wanted harmonics over the largest of them, percent; of the
    /// inverse alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion_error_percent: Option<f64>,
    /// Whether the identified actuator can make the motion within its range of voltages; of the ideal actuator
    /// beside an identified one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within_reach: Option<bool>,
    /// Largest mean flap angle over all control steps, deg.
    pub largest_mean_flap_deg: f64,
    /// Control steps.
    pub steps: usize,
    /// Largest rise of the cost in one step, over the cost at the start, percent: a step back into limits that
    /// moved with the control, a non-monotone step on the way to the fixed point, or the allowance of a loop that
    /// converges.
    pub overshoot_percent: f64,
    /// Factor from what one step asks for to the next, mean over the whole steps at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contraction: Option<f64>,
    /// Largest factor from the error of one control to that of the next with the T held and the weight of the end:
    /// below 1 whole steps converge there. Of a loop with a constant T and a control weight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spectral_radius: Option<f64>,
    /// Frobenius norm of the T matrix behind the voltages, nondimensional load per V.
    #[serde(rename = "t_norm_per_V")]
    pub t_norm_per_volt: f64,
    /// Cost of every recorded state, with the weight of its step: of the loads and of the control.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cost_history: Vec<[f64; 2]>,
}

/// Voltage and motion of a flap at one harmonic.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlapLine {
    /// The flap, counted from 0 at the root.
    pub flap: usize,
    /// Harmonic per rev.
    pub harmonic: usize,
    /// Voltage amplitude, V.
    #[serde(rename = "voltage_amplitude_V")]
    pub voltage_amplitude_volt: f64,
    /// Phase of the voltage, `A cos(n psi - phase)`, deg.
    pub voltage_phase_deg: f64,
    /// Flap amplitude, deg.
    pub flap_amplitude_deg: f64,
    /// Phase of the flap, deg.
    pub flap_phase_deg: f64,
    /// Phase by which the flap lags the voltage, deg.
    pub lag_deg: f64,
    /// Phase by which this flap leads the inboard one, deg; 0 for the inboard flap itself.
    pub lead_over_inboard_deg: f64,
    /// Bias voltage that centres the flap, V.
    #[serde(rename = "bias_V")]
    pub bias_volt: f64,
    /// Mean flap angle left by the bias, deg.
    pub mean_flap_deg: f64,
    /// Largest size of the hinge moment over the revolution, aerodynamic and inertial together, N m; of
    /// the whole motion of the flap, as the next four.
    #[serde(rename = "peak_hinge_moment_N_m")]
    pub peak_hinge_moment_newton_metre: f64,
    /// Largest size of its aerodynamic part, N m.
    #[serde(rename = "peak_aerodynamic_hinge_moment_N_m")]
    pub peak_aerodynamic_newton_metre: f64,
    /// Largest size of its inertial part, N m.
    #[serde(rename = "peak_inertial_hinge_moment_N_m")]
    pub peak_inertial_newton_metre: f64,
    /// Mean of the power while the actuator gives it, `mean max(0, M delta_dot)`, W.
    #[serde(rename = "actuation_power_W")]
    pub actuation_power_watt: f64,
    /// Mean of the power of the actuator on the flap, W.
    #[serde(rename = "net_actuation_power_W")]
    pub net_actuation_power_watt: f64,
}

/// The figures of a result; `setting` is what its case asks for.
pub fn figures(result: &RunResult, setting: &Setting) -> Figures {
    let control: Vec<ControlLine> =
        result.control.iter().map(|record| ControlLine::new(record, setting)).collect();
    // results of before hold the warnings of the control too
    let warnings =
        unique(result.warnings.iter().cloned().chain(control_warnings(&control, setting)));
    let measured = result.measured.iter().flat_map(|part| &part.curves);
    let costs = result.control.iter().zip(&control).enumerate();
    let costs = costs.filter_map(|(k, (record, line))| {
        result.costs.as_ref()?.figures(k, costed(record, line), setting)
    });
    Figures {
        costs: costs.collect(),
        fronts: result.fronts.clone(),
        trim: result.trim,
        residuals: result.residuals,
        wake: result.wake,
        mean_loads: result.mean_loads.map(|mean| MeanLoads::new(mean.hub, setting)),
        baseline: result.baseline,
        vibration_g: result.mean_loads.and_then(|mean| vibration_g(&result.baseline, mean.hub[2])),
        blade_loads: result.blade_loads.clone(),
        measured: measured.map(|line| compare_curves(&line.curve, &line.computed)).collect(),
        vortices: result.measured.as_ref().and_then(|part| part.vortices),
        stability: result.stability.clone(),
        control,
        forecasts: result.forecasts.iter().map(|line| line.figures(setting)).collect(),
        sensitivity: sensitivity_lines(&result.sensitivity, setting),
        unlike_blades: result.unlike_blades.clone(),
        each_unlike_blade: result.each_unlike_blade.clone(),
        warnings,
    }
}

/// A controlled set as its costs are asked for.
fn costed<'a>(record: &'a ControlRecord, line: &ControlLine) -> CostedSet<'a> {
    let of = |flap: &'a FlapRecord| (hinge_of(flap), &flap.voltage_volt.0, &flap.flap_deg.0);
    CostedSet {
        harmonics: &record.head.harmonics,
        actuator: &record.head.actuator,
        cost_ratio: line.j_after / line.j_before,
        flaps: record.end.flaps.iter().map(of).collect(),
    }
}

/// Hub forces over a mean vertical force; none of a rotor that lifts less than it shakes.
fn vibration_g(baseline: &Baseline, lift: f64) -> Option<[f64; 3]> {
    let [fx, fy, fz, ..] = baseline.hub_nb_per_rev.amplitudes();
    (lift > fx.max(fy).max(fz)).then(|| [fx, fy, fz].map(|force| force / lift))
}

/// What a reader should know of controls that were not taken over as a whole, and of a rotor without vibration.
fn control_warnings(control: &[ControlLine], setting: &Setting) -> Vec<String> {
    let shares = control.iter().filter_map(ControlLine::share_warning);
    let still = (setting.is_still() && !control.is_empty()).then(|| {
        "without control the hub loads at the blade number per rev are zero to rounding: there is nothing to reduce, and percentages are left out".to_owned()
    });
    shares.chain(still).collect()
}

impl ControlLine {
    fn new(record: &ControlRecord, setting: &Setting) -> Self {
        let load_weights = setting.load_weights();
        let ControlRecord { head, history, end } = record;
        let j_before = loads_cost(&load_weights, &setting.baseline);
        let j_after = loads_cost(&load_weights, &head.hub_nb_per_rev.parts());
        let cost_history: Vec<[f64; 2]> =
            history.iter().map(|step| step_cost(step, &load_weights)).collect();
        let powers = end.flaps.iter().map(|flap| hinge_power(flap, &setting.scales).given_watt);
        let means = end.flaps.iter().map(|flap| flap.flap_deg.0.mean);
        let recorded = history.iter().flat_map(|step| step.mean_flap_deg.iter().copied());
        let overshoot = overshoot_percent(history, &cost_history);
        Self {
            head: head.clone(),
            j_before,
            j_after,
            reduction_percent: setting.reduction_percent(j_before, j_after),
            j_power: power_cost(record),
            actuation_power_watt: powers.sum(),
            flaps: flap_lines(&head.harmonics, end, &setting.scales),
            controller: controller_name(&head.actuator, setting.control.controller).to_owned(),
            load_weights,
            motion_error_percent: motion_error(&head.harmonics, end).map(|e| 100.0 * e),
            within_reach: end.reach_share.map(|share| share >= 1.0),
            largest_mean_flap_deg: recorded.chain(means).fold(0.0, |m, mean| mean.abs().max(m)),
            steps: history.len().saturating_sub(1),
            overshoot_percent: if setting.is_still() { 0.0 } else { overshoot },
            contraction: contraction(history),
            spectral_radius: spectral_radius(record, &load_weights),
            t_norm_per_volt: end.t_per_volt.iter().flatten().map(|t| t * t).sum::<f64>().sqrt(),
            cost_history,
        }
    }

    /// A number of each flap, inboard / outboard.
    pub(crate) fn each_flap(&self, pick: fn(&FlapLine) -> f64) -> String {
        let all: Vec<String> = self.flaps.iter().map(|flap| format!("{:.1}", pick(flap))).collect();
        all.join(" / ")
    }

    /// Whether the motion asked of the inverse is not the ideal actuator's.
    pub(crate) fn motion_differs(&self) -> bool {
        self.head.motion_share.is_some_and(|share| (share - 1.0).abs() > WHOLE)
    }

    /// What a reader should know of a control that was not taken over as a whole.
    pub fn share_warning(&self) -> Option<String> {
        let (share, what) = match (self.head.voltage_share, self.head.motion_share) {
            (Some(share), _) => (
                share,
                "of the ideal actuator's voltages; all of them leave no room for the bias that centres the flap",
            ),
            (_, Some(share)) => (
                share,
                "of the size of the ideal actuator's flap motion, the best in reach; all of it takes voltages beyond the range",
            ),
            _ => return None,
        };
        (share < 1.0 - WHOLE).then(|| {
            format!(
                "{}/rev, {}: {:.1} % {what}",
                set_name(&self.head.harmonics),
                self.head.actuator,
                100.0 * share
            )
        })
    }
}

/// What a controller knows of T, by name.
fn controller_name(actuator: &str, choice: ControllerChoice) -> &'static str {
    if [ControlActuator::Ignored, ControlActuator::Inverse].iter().any(|a| a.name() == actuator) {
        return "none";
    }
    match choice {
        ControllerChoice::Local => "local",
        ControllerChoice::Adaptive if actuator != ControlActuator::Ideal.name() => "adaptive",
        ControllerChoice::Global | ControllerChoice::Adaptive => "global",
    }
}

/// The law of a T matrix and the weights of the hub loads.
fn law_of(t_per_volt: &[Vec<f64>], load_weights: &[f64; 6]) -> Option<FeedbackLaw> {
    let t = TMatrix::from_columns(t_per_volt).ok()?;
    FeedbackLaw::new(&t, &output_weights(load_weights, t.loads())).ok()
}

/// Spectral radius of the loop with its T and weight held, about where it ended.
fn spectral_radius(record: &ControlRecord, load_weights: &[f64; 6]) -> Option<f64> {
    let there = TMatrix::from_columns(&record.end.t_at_end_per_volt).ok()?;
    let law = law_of(&record.end.t_per_volt, load_weights)?;
    law.iteration_spectral_radius(record.head.rho_per_volt2, &there).ok()
}

/// How far a share may be from 1 by rounding.
const WHOLE: f64 = 1e-12;

/// The controlled voltages of the flaps: flap by flap, harmonic by harmonic, cosine then sine, V.
fn control_volt(record: &ControlRecord) -> Vec<f64> {
    let flaps = record.end.flaps.iter();
    let each = flaps
        .flat_map(|flap| record.head.harmonics.iter().map(|&n| flap.voltage_volt.0.harmonic(n)));
    each.flat_map(|h| [h.cosine, h.sine]).collect()
}

/// Part of the weighted power in the cost.
fn power_cost(record: &ControlRecord) -> f64 {
    PowerOutputs::new(record.end.power_gains_per_volt.clone()).cost(&control_volt(record))
}

fn hinge_of(flap: &FlapRecord) -> HingeMoment {
    HingeMoment {
        aerodynamic: flap.aerodynamic_moment.0.clone(),
        inertial: flap.inertial_moment.0.clone(),
    }
}

fn hinge_power(flap: &FlapRecord, scales: &RotorScales) -> HingePower {
    HingePower::new(&hinge_of(flap), &flap.flap_deg.0, scales)
}

/// Largest error of a wanted flap harmonic over the largest wanted one of the flap.
fn motion_error(harmonics: &[usize], record: &ControlEnd) -> Option<f64> {
    let errors = record.flaps.iter().filter_map(|flap| {
        let wanted = &flap.wanted_deg.as_ref()?.0;
        let sizes = harmonics.iter().map(|&n| wanted.harmonic(n).amplitude());
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let errors = harmonics.iter().map(|&n| {
            let (a, b) = (flap.flap_deg.0.harmonic(n), wanted.harmonic(n));
            (a.cosine - b.cosine).hypot(a.sine - b.sine) / size
        });
        Some(errors.fold(0.0, f64::max))
    });
    errors.fold(None, |worst: Option<f64>, error| Some(worst.map_or(error, |w| w.max(error))))
}

fn flap_lines(harmonics: &[usize], record: &ControlEnd, scales: &RotorScales) -> Vec<FlapLine> {
    let powers: Vec<HingePower> =
        record.flaps.iter().map(|flap| hinge_power(flap, scales)).collect();
    let each = harmonics.iter().flat_map(|&n| {
        let inboard = record.flaps.first().map(|flap| flap.flap_deg.0.harmonic(n));
        record.flaps.iter().zip(&powers).enumerate().map(move |(k, (flap, power))| {
            let (voltage, angle) = (flap.voltage_volt.0.harmonic(n), flap.flap_deg.0.harmonic(n));
            let lead = match inboard {
                Some(inboard) if k > 0 => lag_deg(angle, inboard),
                _ => 0.0,
            };
            FlapLine {
                flap: k,
                harmonic: n,
                voltage_amplitude_volt: voltage.amplitude(),
                voltage_phase_deg: voltage.phase_deg(),
                flap_phase_deg: angle.phase_deg(),
                flap_amplitude_deg: angle.amplitude(),
                lag_deg: lag_deg(voltage, angle),
                lead_over_inboard_deg: lead,
                bias_volt: flap.voltage_volt.0.mean,
                mean_flap_deg: flap.flap_deg.0.mean,
                peak_hinge_moment_newton_metre: power.peak_newton_metre,
                peak_aerodynamic_newton_metre: power.peak_aerodynamic_newton_metre,
                peak_inertial_newton_metre: power.peak_inertial_newton_metre,
                actuation_power_watt: power.given_watt,
                net_actuation_power_watt: power.net_watt,
            }
        })
    });
    each.collect()
}

/// The cost of a recorded state: of the loads as measured, those that stand for the power included, and of the
/// control.
fn step_cost(step: &StepRecord, load_weights: &[f64; 6]) -> [f64; 2] {
    let further = step.loads.len().saturating_sub(12);
    let weights: Vec<f64> = load_weights
        .iter()
        .flat_map(|&w| [w, w])
        .chain(std::iter::repeat_n(1.0, further))
        .collect();
    let cost = Cost::of(&step.loads, &weights, &step.control_volt, step.rho_per_volt2);
    [cost.loads, cost.control]
}

/// Largest rise of the cost in one step, both sides with the weight of the step, over the cost at the start,
/// percent.
fn overshoot_percent(history: &[StepRecord], costs: &[[f64; 2]]) -> f64 {
    let Some([start, _]) = costs.first() else { return 0.0 };
    let pairs = history.iter().zip(costs).zip(history.iter().zip(costs).skip(1));
    let rises = pairs.map(|((before, [loads_before, _]), (after, [loads, control]))| {
        let square: f64 = before.control_volt.iter().map(|u| u * u).sum();
        let before = loads_before + after.rho_per_volt2 * square;
        100.0 * (loads + control - before) / start
    });
    rises.fold(0.0, f64::max)
}

/// Factor from what one step asks for to the next, the geometric mean over the whole steps that a loop ends with;
/// none of fewer than three.
fn contraction(history: &[StepRecord]) -> Option<f64> {
    let asked: Vec<f64> = history
        .iter()
        .skip(1)
        .rev()
        .take_while(|step| step.backtracks == 0)
        .map(|step| step.asked_volt)
        .collect();
    let (last, first) = (asked.first()?, asked.last()?);
    (asked.len() > 2 && *first > 0.0).then(|| (last / first).powf(1.0 / (asked.len() - 1) as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::HubLoads;

    /// A vertical force of a hundredth of the lift is a hundredth of a g; a rotor that lifts nothing has no g.
    #[test]
    fn vibration_is_hub_force_over_lift() {
        let mut loads = [0.0; 12];
        (loads[0], loads[4], loads[5]) = (0.0002, 0.0006, -0.0008);
        let baseline = Baseline { hub_nb_per_rev: HubLoads::from_parts(loads) };
        let [fx, fy, fz] = vibration_g(&baseline, 0.1).unwrap();
        assert!((fx - 0.002).abs() < 1e-15 && fy == 0.0 && (fz - 0.01).abs() < 1e-15);
        assert_eq!(vibration_g(&baseline, 0.0005), None);
        assert_eq!(vibration_g(&baseline, -0.1), None);
    }
}
