//! One control study as it is stored: a set of harmonics and an actuator.

use super::Residuals;
use hhc_control::{AllowedIncrease, ControlRun, ControlStep, TMatrix};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::{ControlStudy, CouplingResidual, HubLoads, control_status};
use serde::{Deserialize, Serialize};

/// What a control study ended with and how it got there; its figures are those of [`super::ControlLine`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ControlRecord {
    /// What its figures repeat.
    #[serde(flatten)]
    pub head: ControlHead,
    /// The start and every control step; empty for voltages taken over or inverted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<StepRecord>,
    /// Voltages, flap motions and T at the end.
    #[serde(default, rename = "at_end", alias = "record")]
    pub end: ControlEnd,
}

/// What a stored control study and its figures both say.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ControlHead {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// `ideal`, `ignored`, `hysteretic` or `inverse`.
    pub actuator: String,
    /// Hub loads with control.
    #[serde(alias = "hub_4_per_rev")]
    pub hub_nb_per_rev: HubLoads,
    /// Size of the motion asked of the inverse over that of the ideal actuator's, 1 where that is within reach,
    /// else of the best that is; of the inverse alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_share: Option<f64>,
    /// Part of the ideal actuator's voltages that were taken over, 1 where they leave room for the bias; of
    /// `ignored` alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voltage_share: Option<f64>,
    /// Residual of the conditions of Karush, Kuhn and Tucker at the last optimum within limits, scaled to order 1;
    /// none without limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kkt_residual: Option<f64>,
    /// Times that T was identified again or probed on the way.
    #[serde(default)]
    pub t_renewals: usize,
    /// Steps halved because they would have raised the cost.
    #[serde(alias = "halvings")]
    pub backtracks: u32,
    /// How the loop ended: `converged`, `stalled`, `out-of-range`, `step-limit`, `flat`, or `taken-over` for
    /// voltages found with another actuator.
    #[serde(alias = "outcome")]
    pub status: String,
    /// Control weight `W_u = rho I`, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// Largest flap amplitude allowed at each harmonic of the set, deg.
    #[serde(default)]
    pub stroke_limit_deg: Vec<f64>,
    /// Residuals of the controlled response. Controls and attitude stay as trimmed, so `trim` here is
    /// what the moving flaps leave unbalanced.
    pub residuals: Residuals,
    /// Coupling of flap and hinge moment; none where the actuator is rigid under it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingResidual>,
}

/// Voltages, flap motions and T where a control study ended.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ControlEnd {
    /// One entry per flap, from root to tip.
    pub flaps: Vec<FlapRecord>,
    /// The T matrix behind the voltages, column by column, load per V.
    #[serde(rename = "t_per_V")]
    pub t_per_volt: Vec<Vec<f64>>,
    /// What turns the voltage of each pair into the square root of its weighted power; empty without such a
    /// weight.
    #[serde(rename = "power_gains_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub power_gains_per_volt: Vec<f64>,
    /// T about the control at the end, column by column, load per V; of a loop with a constant T and a control
    /// weight.
    #[serde(rename = "t_at_end_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub t_at_end_per_volt: Vec<Vec<f64>>,
    /// Part of this motion that the identified actuator makes within its range of voltages; of the ideal one beside
    /// an identified one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reach_share: Option<f64>,
}

/// One recorded state of a control loop.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StepRecord {
    /// Control weight of this step, `W_u = rho I`, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// Largest change of a voltage harmonic that was asked for on the way here, V.
    #[serde(rename = "asked_V")]
    pub asked_volt: f64,
    /// How often that change was halved.
    #[serde(alias = "halvings")]
    pub backtracks: u32,
    /// Why the step was allowed to raise the cost: `limits`, it led back into limits that moved with the control;
    /// `settling`, on the way to the fixed point of a constant T.
    #[serde(default, skip_serializing_if = "Option::is_none", alias = "leave")]
    pub allowed_increase: Option<String>,
    /// Measured loads, order `FX_c FX_s FY_c ... MZ_s`, then those that stand for weighted power.
    #[serde(default)]
    pub loads: Vec<f64>,
    /// Voltages: flap by flap, harmonic by harmonic, cosine then sine, V.
    #[serde(rename = "control_V")]
    pub control_volt: Vec<f64>,
    /// Mean flap angle of every flap, deg.
    pub mean_flap_deg: Vec<f64>,
}

/// A series over a revolution as plain numbers: mean, then cosine and sine of every harmonic.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Vec<f64>", into = "Vec<f64>")]
pub struct SeriesLine(pub HarmonicSeries);

impl From<Vec<f64>> for SeriesLine {
    fn from(numbers: Vec<f64>) -> Self {
        let mean = numbers.first().copied().unwrap_or_default();
        let pairs = numbers.get(1..).unwrap_or_default().chunks(2);
        let harmonics = pairs
            .map(|pair| Harmonic { cosine: pair[0], sine: pair.get(1).copied().unwrap_or(0.0) })
            .collect();
        Self(HarmonicSeries { mean, harmonics })
    }
}

impl From<SeriesLine> for Vec<f64> {
    fn from(line: SeriesLine) -> Self {
        let harmonics = line.0.harmonics.iter().flat_map(|h| [h.cosine, h.sine]);
        std::iter::once(line.0.mean).chain(harmonics).collect()
    }
}

/// One flap over a revolution.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FlapRecord {
    /// Voltage with its bias, V.
    #[serde(rename = "voltage_V")]
    pub voltage_volt: SeriesLine,
    /// Flap angle, deg, trailing edge down positive.
    pub flap_deg: SeriesLine,
    /// Aerodynamic hinge moment, `m0 Omega^2 R^3`.
    pub aerodynamic_moment: SeriesLine,
    /// Inertial hinge moment, the same unit.
    pub inertial_moment: SeriesLine,
    /// Motion asked of the inverse, deg; of the inverse alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wanted_deg: Option<SeriesLine>,
}

impl ControlRecord {
    /// What is kept of a study of a rotor with a number of blades.
    pub fn of(study: &ControlStudy, blades: usize) -> Self {
        let rotor = &study.state.rotor;
        let run = study.run.as_ref();
        let head = ControlHead {
            harmonics: study.harmonics.clone(),
            actuator: study.actuator.name().to_owned(),
            hub_nb_per_rev: HubLoads::from_parts(rotor.hub.harmonic(blades)),
            motion_share: study.motion_share,
            voltage_share: study.voltage_share,
            kkt_residual: run.and_then(|run| run.kkt).map(|kkt| kkt.largest()),
            t_renewals: run.map_or(0, |run| run.identifications),
            backtracks: study.backtracks(),
            status: control_status(study).to_owned(),
            rho_per_volt2: study.rho,
            stroke_limit_deg: study.stroke_limit_deg.clone(),
            residuals: Residuals {
                trim: study.trim_imbalance,
                periodicity: rotor.residuals.periodicity,
                inflow: rotor.residuals.inflow,
            },
            coupling: study.state.coupling,
        };
        let history = run.into_iter().flat_map(ControlRun::history).map(StepRecord::of).collect();
        Self { head, history, end: ControlEnd::of(study) }
    }
}

impl ControlEnd {
    fn of(study: &ControlStudy) -> Self {
        let wanted = study.wanted_deg.iter().map(Some).chain(std::iter::repeat(None));
        let flaps = study.state.flaps.iter().zip(&study.state.rotor.hinge).zip(wanted);
        let columns = |t: &Option<TMatrix>| t.as_ref().map(TMatrix::columns).unwrap_or_default();
        Self {
            flaps: flaps
                .map(|((motion, hinge), wanted)| FlapRecord {
                    voltage_volt: SeriesLine(motion.voltage_volt.clone()),
                    flap_deg: SeriesLine(motion.flap_deg.clone()),
                    aerodynamic_moment: SeriesLine(hinge.aerodynamic.clone()),
                    inertial_moment: SeriesLine(hinge.inertial.clone()),
                    wanted_deg: wanted.cloned().map(SeriesLine),
                })
                .collect(),
            t_per_volt: columns(&study.t),
            power_gains_per_volt: study.power.gains_per_volt().to_vec(),
            t_at_end_per_volt: columns(&study.t_at_end),
            reach_share: study.reach_share,
        }
    }
}

impl StepRecord {
    fn of(step: &ControlStep) -> Self {
        Self {
            rho_per_volt2: step.rho,
            asked_volt: step.asked_volt,
            backtracks: step.backtracks,
            allowed_increase: match step.allowed_increase {
                AllowedIncrease::None => None,
                AllowedIncrease::Restoration => Some("limits".to_owned()),
                AllowedIncrease::NonMonotone => Some("settling".to_owned()),
            },
            loads: step.measurement.outputs.clone(),
            control_volt: step.control_volt.clone(),
            mean_flap_deg: step.measurement.mean_flap_deg.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_keeps_its_bits_in_a_file() {
        let mut series = HarmonicSeries::zero(3);
        series.mean = 0.1 + 0.2;
        series.set_harmonic(2, Harmonic { cosine: -1.0 / 3.0, sine: 1e-17 });
        let text = serde_json::to_string(&SeriesLine(series.clone())).unwrap();
        assert!(text.starts_with('['), "{text}");
        let read: SeriesLine = serde_json::from_str(&text).unwrap();
        assert_eq!(read.0, series);
    }
}
