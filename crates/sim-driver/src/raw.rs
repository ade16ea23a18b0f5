//! What the figures of a stored result are computed from: control vectors, loads, motions, sensitivities.

use crate::case::{Case, CaseFile, ControlValues, LoadScaleChoice};
use crate::results::HubLoads;
use hhc_control::{CertifiedCone, KktCertificate, LoopEnd, Outcome, reduction_percent};
use rotor_base::{BaseError, Harmonic, HarmonicSeries, RotorScales};
use serde::{Deserialize, Serialize};

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

/// What the figures of one control study are computed from, beside its hub loads and history.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ControlRecord {
    /// Control vector at the end, V.
    #[serde(rename = "control_V")]
    pub control_volt: Vec<f64>,
    /// One entry per flap, from root to tip.
    pub flaps: Vec<FlapRecord>,
    /// The T matrix behind the voltages, column by column, load per V.
    #[serde(rename = "t_per_V")]
    pub t_per_volt: Vec<Vec<f64>>,
    /// What turns the voltage of each pair into the square root of its weighted power; empty without such a
    /// weight.
    #[serde(rename = "power_gains_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub power_gains_per_volt: Vec<f64>,
    /// What shows what is asked for at the end to be the optimum within limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimum: Option<CertificateLine>,
    /// Where the loop ended; none where there was no loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<EndLine>,
    /// Steps no part of which is in the history.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refused: Vec<RefusedLine>,
    /// Steps taken by each time that T was identified again or probed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub identified_after: Vec<usize>,
    /// T about the control at the end, column by column, load per V; of a loop with a constant T and a control
    /// weight.
    #[serde(rename = "t_at_end_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub t_at_end_per_volt: Vec<Vec<f64>>,
    /// Flap motion at each harmonic for a cosine of the voltage of its stroke limit, `[cosine, sine]`, deg.
    #[serde(default)]
    pub at_stroke_deg: Vec<[f64; 2]>,
    /// Part of this motion that the identified actuator makes within its range of voltages; of the ideal one beside
    /// an identified one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reach_share: Option<f64>,
}

/// What a loop knew where it ended.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EndLine {
    /// The loads it aimed from: those measured, or what a filter makes of them.
    pub seen_loads: Vec<f64>,
    /// Control weight, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// Largest change of a voltage harmonic that is still asked for, V.
    #[serde(rename = "asked_V")]
    pub asked_volt: f64,
    /// The same of the step that the loop would take: held near the control where steps had to be halved.
    #[serde(rename = "next_V")]
    pub next_volt: f64,
    /// Largest voltage harmonic of the control reached and of the one asked for, V.
    #[serde(rename = "size_V")]
    pub size_volt: f64,
    /// Fall of the cost that the whole step promises.
    pub promise: f64,
    /// Why a loop that is not converged came to its end: `step-limit`, `stalled`, `out-of-range`; `flat`, steps promise and
    /// bring nothing any more, but do not become shorter; `unverified`, its
    /// step is small but nothing was left to look at T with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

/// A step no part of which is in the history.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RefusedLine {
    /// Steps of the history taken by then.
    pub after_steps: usize,
    /// Largest change of a voltage harmonic that was asked for, V.
    #[serde(rename = "asked_V")]
    pub asked_volt: f64,
    /// How often it was halved.
    pub halvings: u32,
}

/// A scaled second-order cone program, a point and its multipliers; limits without a multiplier are left out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CertificateLine {
    /// `P` of `x'Px/2 + q'x`, row by row.
    pub hessian: Vec<Vec<f64>>,
    /// `q`.
    pub linear: Vec<f64>,
    /// `x`: the control over `scale_V`.
    pub point: Vec<f64>,
    /// What the point is scaled by, V.
    #[serde(rename = "scale_V")]
    pub volt: f64,
    /// The limits that bind.
    pub cones: Vec<ConeLine>,
}

/// One limit: `bounds - rows x` in its cone.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ConeLine {
    /// `A`, row by row.
    pub rows: Vec<Vec<f64>>,
    /// The bound of every row.
    pub bounds: Vec<f64>,
    /// The multiplier of every row.
    pub multipliers: Vec<f64>,
}

impl EndLine {
    /// The end of a loop and how it is named.
    pub fn new(end: &LoopEnd, outcome: Outcome, is_settled: bool) -> Self {
        let stopped = match (outcome, is_settled) {
            (Outcome::Converged, _) => None,
            (_, true) => Some("unverified"),
            (Outcome::Stalled, _) => Some("stalled"),
            (Outcome::OutOfRange, _) => Some("out-of-range"),
            (Outcome::StepLimit, _) => Some("step-limit"),
            (Outcome::Flat, _) => Some("flat"),
        };
        Self {
            seen_loads: end.seen_loads.clone(),
            rho_per_volt2: end.rho,
            asked_volt: end.asked_volt,
            next_volt: end.next_volt,
            size_volt: end.size_volt,
            promise: end.promise,
            stopped: stopped.map(str::to_owned),
        }
    }

    /// The end as computed again; the step that was held near the control and why the loop stopped as stored.
    pub(crate) fn of(found: &LoopEnd, next_volt: Option<f64>, stored: &Self) -> Self {
        Self {
            seen_loads: found.seen_loads.clone(),
            rho_per_volt2: found.rho,
            asked_volt: found.asked_volt,
            next_volt: next_volt.unwrap_or(found.next_volt),
            size_volt: found.size_volt,
            promise: found.promise,
            stopped: stored.stopped.clone(),
        }
    }

    /// The same numbers as the loop has them.
    pub fn loop_end(&self) -> LoopEnd {
        LoopEnd {
            seen_loads: self.seen_loads.clone(),
            rho: self.rho_per_volt2,
            asked_volt: self.asked_volt,
            next_volt: self.next_volt,
            size_volt: self.size_volt,
            promise: self.promise,
        }
    }
}

impl From<&KktCertificate> for CertificateLine {
    fn from(found: &KktCertificate) -> Self {
        let cone = |cone: &CertifiedCone| ConeLine {
            rows: cone.rows.clone(),
            bounds: cone.bounds.clone(),
            multipliers: cone.multipliers.clone(),
        };
        Self {
            hessian: found.hessian.clone(),
            linear: found.linear.clone(),
            point: found.point.clone(),
            volt: found.volt,
            cones: found.cones.iter().map(cone).collect(),
        }
    }
}

impl CertificateLine {
    /// Largest residual of the conditions of Karush, Kuhn and Tucker, scaled to order 1.
    pub fn residual(&self) -> f64 {
        self.certificate().residual().largest()
    }

    /// The control it is about, V.
    pub fn control_volt(&self) -> Vec<f64> {
        self.certificate().control_volt()
    }

    fn certificate(&self) -> KktCertificate {
        let cone = |cone: &ConeLine| CertifiedCone {
            rows: cone.rows.clone(),
            bounds: cone.bounds.clone(),
            multipliers: cone.multipliers.clone(),
        };
        KktCertificate {
            hessian: self.hessian.clone(),
            linear: self.linear.clone(),
            point: self.point.clone(),
            volt: self.volt,
            cones: self.cones.iter().map(cone).collect(),
        }
    }
}

/// What a forecast is computed from, beside the loads without control.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForecastRecord {
    /// T of the linearised rotor with the ideal actuator, column by column, load per V.
    #[serde(rename = "t_per_V")]
    pub t_per_volt: Vec<Vec<f64>>,
    /// The same with the inflow settled on the moved loading, the geometry of a free wake held.
    #[serde(rename = "settled_t_per_V", default)]
    pub settled_t_per_volt: Vec<Vec<f64>>,
    /// The same with the inflow as in trim.
    #[serde(rename = "frozen_t_per_V", default)]
    pub frozen_t_per_volt: Vec<Vec<f64>>,
    /// The same with the geometry of the free wake converged anew; empty unless asked for.
    #[serde(rename = "reconverged_t_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub reconverged_t_per_volt: Vec<Vec<f64>>,
    /// Updates of the wake that the slowest of its differences took.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake_updates: Option<usize>,
    /// Largest change of one of them in its last update, over its size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake_change: Option<f64>,
    /// Control weight that picks the least voltage among equals, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// The optimum within the limits, V.
    #[serde(rename = "cone_V")]
    pub cone_volt: Vec<f64>,
    /// Stroke circle of each harmonic in volts of the ideal actuator.
    #[serde(rename = "stroke_V")]
    pub stroke_volt: Vec<f64>,
    /// Flap motion at each harmonic for a cosine of the voltage of its stroke limit, `[cosine, sine]`, deg.
    pub at_stroke_deg: Vec<[f64; 2]>,
    /// T with the full actuator model, both flaps alike, column by column, load per V.
    #[serde(rename = "dynamic_t_per_V")]
    pub dynamic_t_per_volt: Vec<Vec<f64>>,
    /// The same with a harmonic gain at the step of T.
    #[serde(rename = "gain_t_at_step_per_V")]
    pub gain_t_at_step_per_volt: Vec<Vec<f64>>,
    /// The same with a harmonic gain at the stroke limit.
    #[serde(rename = "gain_t_at_stroke_per_V")]
    pub gain_t_at_stroke_per_volt: Vec<Vec<f64>>,
}

/// What every figure of a result shares: loads without control, what the case asks of the control, units.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Hub loads without control.
    pub baseline: [f64; 12],
    /// What the case asks of the control, weights included.
    pub control: ControlValues,
    /// Flap amplitude of the ideal actuator at full-scale voltage, deg.
    pub ideal_amplitude_deg: f64,
    /// Units of the rotor.
    pub scales: RotorScales,
    /// `C_Q / sigma` of a torque of `m0 Omega^2 R^3`: `6 pi / (gamma N_b)`.
    pub torque_coefficient_over_solidity: f64,
}

/// Largest hub load that is none, `m0 Omega^2 R^2` and `m0 Omega^2 R^3`: the thrust is of order `1e-2`, a hovering rotor
/// whose cyclic pitch balances the tail rotor keeps up to `4e-8`, one at an advance ratio of 0.05 has `1e-5`.
const NO_LOAD: f64 = 1e-7;

impl Setting {
    /// Of a validated case.
    pub fn of_case(case: &Case, baseline: &HubLoads) -> Self {
        Self {
            baseline: baseline.parts(),
            control: case.control.clone(),
            ideal_amplitude_deg: case.actuator.ideal_amplitude_deg,
            scales: case.scales,
            torque_coefficient_over_solidity: torque_over_solidity(case.lock_number, case.blades),
        }
    }

    /// Of a stored case.
    ///
    /// # Errors
    /// Rotor units that are not positive.
    pub fn of_file(case: &CaseFile, baseline: &HubLoads) -> Result<Self, BaseError> {
        let rotor = &case.rotor;
        let omega_rad_s = rotor.omega_rpm * std::f64::consts::TAU / 60.0;
        Ok(Self {
            baseline: baseline.parts(),
            control: ControlValues::of(&case.control),
            ideal_amplitude_deg: case.actuator.ideal_amplitude_deg,
            scales: RotorScales::new(omega_rad_s, rotor.radius_m, rotor.mass_kg_m)?,
            torque_coefficient_over_solidity: torque_over_solidity(rotor.lock_number, rotor.blades),
        })
    }

    /// Whether there is nothing to reduce: every load without control is rounding.
    pub fn is_still(&self) -> bool {
        is_still(&self.baseline)
    }

    /// `100 (1 - J_Z / J_Z0)`, 0 where there is nothing to reduce.
    pub fn reduction_percent(&self, before: f64, after: f64) -> f64 {
        if self.is_still() { 0.0 } else { reduction_percent(before, after) }
    }

    /// Weight of each load, order `FX FY FZ MX MY MZ`: those of the case, over the squared amplitude without
    /// control if it asks for that.
    pub fn load_weights(&self) -> [f64; 6] {
        let w = &self.control.load_weights;
        let mut weights = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
        if self.control.load_scale == LoadScaleChoice::Baseline {
            for (weight, z) in weights.iter_mut().zip(self.baseline.chunks_exact(2)) {
                let square = z[0] * z[0] + z[1] * z[1];
                // a load that is none cannot be measured by itself
                *weight = if square > NO_LOAD * NO_LOAD { *weight / square } else { *weight };
            }
        }
        weights
    }
}

/// `C_Q / sigma` of a torque of `m0 Omega^2 R^3`, with `rho c R / m0 = gamma / (6 pi)`.
fn torque_over_solidity(lock_number: f64, blades: usize) -> f64 {
    6.0 * std::f64::consts::PI / (lock_number * blades as f64)
}

/// Whether every hub load is rounding.
pub(crate) fn is_still(baseline: &[f64; 12]) -> bool {
    baseline.iter().all(|load| load.abs() <= NO_LOAD)
}

/// `J_Z` of a hub load vector.
pub(crate) fn loads_cost(weights: &[f64; 6], loads: &[f64; 12]) -> f64 {
    loads.chunks_exact(2).zip(weights).map(|(z, w)| w * (z[0] * z[0] + z[1] * z[1])).sum()
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
