//! What `hhc run` finds, and how it is stored.

use crate::SimError;
use crate::blade_loads::StationLine;
use crate::case::CaseFile;
use crate::dissimilar::{UnlikeBladeLine, UnlikeLine};
use crate::files::{ron_text, write_atomic};
use crate::mean_loads::MeanLoads;
use crate::raw::{ControlRecord, ForecastRecord};
use crate::refigure::WHOLE;
use crate::stability::StabilityLine;
use crate::study::{RobustnessCell, Sensitivity};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What `hhc run` prints. Loads nondimensional (`m0 Omega^2 R^2`, `m0 Omega^2 R^3`), a harmonic as
/// `[cosine, sine]`, angles of harmonics in (-180, 180] deg.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunResult {
    /// The trim found.
    pub trim: TrimLine,
    /// How well the equations are satisfied; no vibration number without them.
    pub residuals: Residuals,
    /// How wake and trim ended: `settled`, `not-settled` or `parted`; none without a free wake.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake: Option<String>,
    /// Mean loads on the hub and the power of the shaft; none in results stored before they were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_loads: Option<MeanLoads>,
    /// Loads without control.
    pub baseline: Baseline,
    /// Loads of one blade along its span without control, of each of the like ones where some are unlike; none in results stored before they were.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blade_loads: Vec<StationLine>,
    /// Stability of the trimmed blade, of each of the like ones where some are unlike.
    #[serde(default)]
    pub stability: StabilityLine,
    /// One entry per set of harmonics and actuator.
    pub control: Vec<ControlLine>,
    /// What the linearised rotor says beforehand, one entry per set; empty without an identified actuator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forecasts: Vec<Forecast>,
    /// The reductions with one assumption changed at a time; empty unless asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<Sensitivity>,
    /// What the controllers stand; empty unless asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub robustness: Vec<RobustnessCell>,
    /// Hub loads with blades unlike the rest, flaps at rest and after every control; empty if all are alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlike_blades: Vec<UnlikeLine>,
    /// Stability and loads of every blade unlike the rest, flaps at rest; empty if all are alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub each_unlike_blade: Vec<UnlikeBladeLine>,
    /// What a reader should know before using the numbers.
    #[serde(default)]
    pub warnings: Vec<String>,
}

impl RunResult {
    /// Whether a free wake has parted from the rotor: a state on the way, no solution, and not controlled.
    pub fn wake_parted(&self) -> bool {
        self.wake.as_deref() == Some(WAKE_PARTED)
    }
}

/// What [`RunResult::wake`] says of a wake that has parted from the rotor.
pub(crate) const WAKE_PARTED: &str = "parted";
/// What it says of one that has not come to rest.
pub(crate) const WAKE_NOT_SETTLED: &str = "not-settled";

/// Controls and attitude. Angles in deg.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TrimLine {
    /// Collective at 0.75 R.
    pub theta0_deg: f64,
    /// Lateral cyclic.
    pub theta1c_deg: f64,
    /// Longitudinal cyclic.
    pub theta1s_deg: f64,
    /// Shaft tilt, forward positive.
    pub alpha_s_deg: f64,
    /// Bank, right positive.
    pub phi_s_deg: f64,
    /// Tail rotor thrust to starboard, `m0 Omega^2 R^2`.
    pub tail_thrust: f64,
    /// Thrust coefficient over solidity.
    pub ct_sigma: f64,
    /// Mean induced inflow, tip speed, down positive.
    pub induced_inflow: f64,
    /// Newton iterations.
    pub iterations: usize,
}

/// The three residuals of every result.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Residuals {
    /// Largest trim residual over the weight.
    pub trim: f64,
    /// Largest weak residual of the periodic orbit.
    pub periodicity: f64,
    /// Mismatch of the inflow, tip speed.
    pub inflow: f64,
}

/// Loads without control.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Baseline {
    /// Fixed-frame hub loads at the blade number per rev.
    #[serde(alias = "hub_4_per_rev")]
    pub hub_nb_per_rev: HubLoads,
}

/// Six hub loads at one harmonic, `[cosine, sine]`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct HubLoads {
    /// Longitudinal force, aft positive.
    pub fx: [f64; 2],
    /// Lateral force, starboard positive.
    pub fy: [f64; 2],
    /// Vertical force, up positive.
    pub fz: [f64; 2],
    /// Moment about the aft axis.
    pub mx: [f64; 2],
    /// Moment about the starboard axis.
    pub my: [f64; 2],
    /// Moment about the upward axis.
    pub mz: [f64; 2],
}

impl HubLoads {
    /// Names of the loads, in the order of [`Self::amplitudes`].
    pub const NAMES: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

    /// From cosine and sine parts `fx_c fx_s fy_c ... mz_s`.
    pub fn from_parts(parts: [f64; 12]) -> Self {
        let pair = |k: usize| [parts[2 * k], parts[2 * k + 1]];
        Self { fx: pair(0), fy: pair(1), fz: pair(2), mx: pair(3), my: pair(4), mz: pair(5) }
    }

    /// Cosine and sine parts `fx_c fx_s fy_c ... mz_s`.
    pub fn parts(&self) -> [f64; 12] {
        let pairs = [self.fx, self.fy, self.fz, self.mx, self.my, self.mz];
        std::array::from_fn(|k| pairs[k / 2][k % 2])
    }

    /// Amplitudes of the six loads.
    pub fn amplitudes(&self) -> [f64; 6] {
        [self.fx, self.fy, self.fz, self.mx, self.my, self.mz].map(|[c, s]| c.hypot(s))
    }
}

/// One control study: a set of harmonics and an actuator.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ControlLine {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// `ideal`, `ignored`, `hysteretic` or `inverse`.
    pub actuator: String,
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// `100 (1 - J_Z / J_Z0)`.
    pub reduction_percent: f64,
    /// Part of the weighted actuation power in the cost, beside `J_Z`; 0 without such a weight.
    #[serde(default)]
    pub j_power: f64,
    /// Mean power that the actuators of one blade give, none taken back, W.
    #[serde(rename = "actuation_power_W", default)]
    pub actuation_power_watt: f64,
    /// Hub loads with control.
    #[serde(alias = "hub_4_per_rev")]
    pub hub_nb_per_rev: HubLoads,
    /// One entry per flap, from root to tip; of a set of several harmonics, one after another.
    pub flaps: Vec<FlapLine>,
    /// What the controller knew of T: `global`, `local`, `adaptive`, or `none` for voltages taken over or
    /// inverted.
    #[serde(default)]
    pub controller: String,
    /// Weight of each load in `J_Z`, order FX FY FZ MX MY MZ, on nondimensional loads.
    #[serde(default = "unit_weights")]
    pub load_weights: [f64; 6],
    /// Error of the flap motion at the wanted harmonics over the largest of them, percent; of the
    /// inverse alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_error_percent: Option<f64>,
    /// Size of the motion asked of the inverse over that of the ideal actuator's, 1 where that is within reach,
    /// else of the best that is; of the inverse alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_share: Option<f64>,
    /// Part of the ideal actuator's voltages that were taken over, 1 where they leave room for the bias; of
    /// `ignored` alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voltage_share: Option<f64>,
    /// Whether the identified actuator can make the motion within its range of voltages; of the ideal actuator
    /// beside an identified one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_reach: Option<bool>,
    /// KKT residual of the last optimum within limits, where there were any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kkt_residual: Option<f64>,
    /// Largest mean flap angle over all control steps, deg.
    #[serde(default)]
    pub largest_mean_flap_deg: f64,
    /// Control steps.
    pub steps: usize,
    /// Steps halved because they would have raised the cost.
    pub halvings: u32,
    /// Largest rise of the cost in one step, over the cost at the start, percent: a step back into limits that
    /// moved with the control, over a hill to the fixed point, or the allowance of a loop that settles.
    #[serde(default)]
    pub largest_rise_percent: f64,
    /// Factor by which what a step asks for shrinks from one to the next, mean over the whole steps at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contraction: Option<f64>,
    /// Largest factor from the error of one control to that of the next with the T held and the weight of the end:
    /// below 1 whole steps settle there. Of a loop with a constant T and a control weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectral_radius: Option<f64>,
    /// Times that T was identified again or probed on the way.
    #[serde(default)]
    pub t_renewals: usize,
    /// How the loop ended: `converged`, `stalled`, `out-of-range`, `step-limit`, or `taken-over` for
    /// voltages found with another actuator.
    pub outcome: String,
    /// Frobenius norm of the T matrix behind the voltages, nondimensional load per V.
    #[serde(rename = "t_norm_per_V")]
    pub t_norm_per_volt: f64,
    /// Control weight `W_u = rho I` that meets the stroke, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// Largest flap amplitude allowed at each harmonic of the set, deg.
    pub stroke_limit_deg: Vec<f64>,
    /// Residuals of the controlled response. Controls and attitude stay as trimmed, so `trim` here is
    /// what the moving flaps leave unbalanced.
    pub residuals: Residuals,
    /// Coupling of flap and hinge moment; none where the actuator does not give way to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingLine>,
    /// The start and every control step; empty for voltages taken over or inverted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<HistoryLine>,
    /// What the figures are computed from.
    #[serde(default)]
    pub record: ControlRecord,
}

/// What the linearised rotor says of one set of harmonics before any control: what a lag that is ignored
/// costs, what clipping to the stroke costs, and what a harmonic gain in place of the actuator misses.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Forecast {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// Lag of the actuator at the stroke limit of each harmonic, deg.
    pub lag_deg: Vec<f64>,
    /// Part of the attainable fall of `J` that is lost where these lags are ignored, limits lifted, percent:
    /// `|T (R - I) u*|^2 / |T u*|^2`.
    pub lag_loss_percent: f64,
    /// `4 sin^2(lag/2)` of the largest lag, percent: the same if T acts alike on all controls.
    pub isotropic_loss_percent: f64,
    /// `J/J0` of the cone program's optimum within the limits, ideal actuator.
    pub cone: f64,
    /// `J/J0` of the free optimum with every harmonic clipped to its stroke circle.
    pub clipped: f64,
    /// `J/J0` of the free optimum, no limits.
    pub free: f64,
    /// Distance of T with the actuator as a harmonic gain from T with the full dynamic model, both at the step
    /// of T, over the latter, percent: what the harmonics that the actuator adds do to the hub.
    pub gain_at_step_percent: f64,
    /// The same with the gain at the stroke limit: what amplitude does to gain and lag.
    pub gain_at_stroke_percent: f64,
    /// Distance of T with the wake frozen from T with the inflow settled on the moved loading, over the latter,
    /// percent.
    #[serde(default)]
    pub frozen_percent: f64,
    /// The same of T with the geometry of the free wake converged anew; where the case asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reconverged_percent: Option<f64>,
    /// What these are computed from.
    #[serde(default)]
    pub record: ForecastRecord,
}

/// One recorded state of a control loop.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HistoryLine {
    /// `J_Z`, the loads' part of the cost.
    pub j_loads: f64,
    /// `J_u`, the control's part, with the weight of this step.
    pub j_control: f64,
    /// Control weight of this step, `W_u = rho I`, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// Largest change of a voltage harmonic that was asked for on the way here, V.
    #[serde(rename = "asked_V")]
    pub asked_volt: f64,
    /// How often that change was halved.
    pub halvings: u32,
    /// Why the step could raise the cost: `limits`, it led back into limits that moved with the control;
    /// `settling`, on the way to the fixed point of a constant T.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leave: Option<String>,
    /// Measured loads, order `FX_c FX_s FY_c ... MZ_s`, then those that stand for weighted power.
    #[serde(default)]
    pub loads: Vec<f64>,
    /// Voltages: flap by flap, harmonic by harmonic, cosine then sine, V.
    #[serde(rename = "control_V")]
    pub control_volt: Vec<f64>,
    /// Mean flap angle of every flap, deg.
    pub mean_flap_deg: Vec<f64>,
}

impl ControlLine {
    /// The set of harmonics as a title: `2` or `2+3`.
    pub fn set_name(&self) -> String {
        let all: Vec<String> = self.harmonics.iter().map(usize::to_string).collect();
        all.join("+")
    }

    /// The actuator, marked where its motion is not the one it stands beside.
    pub(crate) fn actuator_cell(&self) -> String {
        let changed = self.motion_share.is_some_and(|share| (share - 1.0).abs() > WHOLE);
        let mark = match self.within_reach {
            Some(false) => "*",
            _ if changed => "**",
            _ => "",
        };
        format!("{}{mark}", self.actuator)
    }

    /// The controller, with the renewals of a constant T.
    pub(crate) fn controller_cell(&self) -> String {
        match self.t_renewals {
            times if times > 0 && self.controller == "global" => {
                format!("{}+{times}", self.controller)
            }
            _ => self.controller.clone(),
        }
    }
}

/// The identity weights, those of results stored before weights were.
fn unit_weights() -> [f64; 6] {
    [1.0; 6]
}

/// Name of a flap, counted from 0 at the root.
pub fn flap_name(index: usize) -> String {
    match index {
        0 => "inboard".to_owned(),
        1 => "outboard".to_owned(),
        more => format!("flap {}", more + 1),
    }
}

/// Voltage and motion of a flap at one harmonic.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FlapLine {
    /// The flap, counted from 0 at the root.
    pub flap: usize,
    /// Harmonic per rev.
    pub harmonic: usize,
    /// Voltage amplitude, V.
    #[serde(rename = "voltage_amplitude_V")]
    pub voltage_amplitude_volt: f64,
    /// Phase of the voltage, `A cos(n psi - phase)`, deg.
    #[serde(default)]
    pub voltage_phase_deg: f64,
    /// Flap amplitude, deg.
    pub flap_amplitude_deg: f64,
    /// Phase of the flap, deg.
    #[serde(default)]
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
    #[serde(rename = "peak_aerodynamic_hinge_moment_N_m", default)]
    pub peak_aerodynamic_newton_metre: f64,
    /// Largest size of its inertial part, N m.
    #[serde(rename = "peak_inertial_hinge_moment_N_m", default)]
    pub peak_inertial_newton_metre: f64,
    /// Mean of the power while the actuator gives it, `mean max(0, M delta_dot)`, W.
    #[serde(rename = "actuation_power_W", default)]
    pub actuation_power_watt: f64,
    /// Mean of the power of the actuator on the flap, W.
    #[serde(rename = "net_actuation_power_W", default)]
    pub net_actuation_power_watt: f64,
}

/// How flap motion and hinge moment settled on each other.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CouplingLine {
    /// Responses of the rotor it took.
    pub iterations: usize,
    /// Largest change of a harmonic of a flap angle by the hinge moment still left, deg.
    pub residual_deg: f64,
}

/// A stored result: everything needed to reproduce it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredResult<T> {
    /// Program and version.
    pub program: String,
    /// blake3 of version, canonical case and input data: equal keys mean equal results.
    pub key: String,
    /// blake3 of each input beside the case: actuator or bench data.
    pub inputs: Vec<String>,
    /// blake3 of what the report shows of bench and setting, which does not follow from the result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub page_key: Option<String>,
    /// blake3 of the whole result: what its figures are computed from is what the run wrote.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result_key: Option<String>,
    /// blake3 of the loads of the blade, here and as a table: they follow from the flight alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blade_loads_key: Option<String>,
    /// The whole case, defaults filled in.
    pub case: CaseFile,
    /// The result.
    pub result: T,
}

impl<T: Serialize> StoredResult<T> {
    /// Puts a result beside its case and key. `inputs` are blake3 hashes of bench or actuator data.
    ///
    /// # Errors
    /// As [`result_key`].
    pub fn new(case: &CaseFile, inputs: Vec<String>, result: T) -> Result<Self, SimError> {
        Ok(Self {
            program: format!("hhc {}", crate::VERSION),
            key: result_key(case, &inputs)?,
            inputs,
            page_key: None,
            result_key: Some(json_key(&result)?),
            blade_loads_key: None,
            case: case.clone(),
            result,
        })
    }

    /// Writes the result atomically as JSON.
    ///
    /// # Errors
    /// [`SimError::NotWritten`].
    pub fn write(&self, path: &Path) -> Result<(), SimError> {
        let text = serde_json::to_string_pretty(self).map_err(|e| not_written(path, &e))?;
        write_atomic(path, (text + "\n").as_bytes())
    }
}

/// blake3 of a value as JSON.
///
/// # Errors
/// [`SimError::NotWritten`] if JSON cannot express it.
pub fn json_key<T: Serialize>(value: &T) -> Result<String, SimError> {
    let text = serde_json::to_string(value).map_err(|e| not_written(Path::new("JSON"), &e))?;
    Ok(blake3::hash(text.as_bytes()).to_hex().to_string())
}

/// blake3 of program version, canonical case and input hashes.
///
/// The canonical case is the case file with its defaults filled in, so comments, order and layout of
/// the user's file do not matter.
///
/// # Errors
/// [`SimError::NotWritten`] for a case RON cannot express.
pub fn result_key(case: &CaseFile, inputs: &[String]) -> Result<String, SimError> {
    key_of_version(crate::VERSION, case, inputs)
}

/// The same of the version that a result says it is of.
pub(crate) fn key_of_version(
    version: &str,
    case: &CaseFile,
    inputs: &[String],
) -> Result<String, SimError> {
    let canonical = ron_text(case).map_err(|e| not_written(Path::new("case"), &e))?;
    let mut hash = blake3::Hasher::new();
    for part in std::iter::once(version)
        .chain(std::iter::once(canonical.as_str()))
        .chain(inputs.iter().map(String::as_str))
    {
        hash.update(&(part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    Ok(hash.finalize().to_hex().to_string())
}

fn not_written(path: &Path, error: &dyn std::fmt::Display) -> SimError {
    SimError::NotWritten { path: path.to_path_buf(), reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PAPER_CASE, shipped_case};

    /// Loads at the blade number were once stored as those at 4/rev, of whatever number of blades.
    #[test]
    fn loads_under_their_old_name_are_read() {
        let baseline = Baseline { hub_nb_per_rev: HubLoads::from_parts([0.5; 12]) };
        let new = serde_json::to_string(&baseline).unwrap();
        let old = new.replace("hub_nb_per_rev", "hub_4_per_rev");
        assert!(old != new);
        assert_eq!(serde_json::from_str::<Baseline>(&old).unwrap(), baseline);
    }

    #[test]
    fn the_key_follows_case_and_inputs_but_not_layout() {
        let file = shipped_case(PAPER_CASE).unwrap().file;
        let key = |file: &CaseFile, inputs: &[&str]| {
            let inputs: Vec<String> = inputs.iter().map(|s| (*s).to_owned()).collect();
            result_key(file, &inputs).unwrap()
        };
        let base = key(&file, &["a", "b"]);
        assert_eq!(base.len(), 64);
        assert_eq!(base, key(&file.clone(), &["a", "b"]));
        assert_ne!(base, key(&file, &["ab"]), "inputs are kept apart");
        let moved = CaseFile { advance_ratio: file.advance_ratio + 1e-12, ..file };
        assert_ne!(base, key(&moved, &["a", "b"]));
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "small integers are exact")]
    fn hub_loads_keep_their_order() {
        let mut parts = [0.0; 12];
        for (i, p) in parts.iter_mut().enumerate() {
            *p = i as f64;
        }
        let loads = HubLoads::from_parts(parts);
        assert_eq!(loads.fz, [4.0, 5.0]);
        assert_eq!(loads.mz, [10.0, 11.0]);
        let json = serde_json::to_value(loads).unwrap();
        for (name, amplitude) in HubLoads::NAMES.iter().zip(loads.amplitudes()) {
            let pair = &json[name];
            let found = pair[0].as_f64().unwrap().hypot(pair[1].as_f64().unwrap());
            assert!((found - amplitude).abs() < 1e-15);
        }
    }
}
