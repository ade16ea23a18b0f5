//! What the figures of a stored result are computed from: control vectors, loads, motions, sensitivities.

use crate::case::{Case, CaseFile, LoadScaleChoice, LoadWeightsFile};
use crate::results::HubLoads;
use hhc_control::{CertifiedCone, KktCertificate};
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
    /// What shows the last aim to be the optimum within limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimum: Option<CertificateLine>,
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
        let cone = |cone: &ConeLine| CertifiedCone {
            rows: cone.rows.clone(),
            bounds: cone.bounds.clone(),
            multipliers: cone.multipliers.clone(),
        };
        let certificate = KktCertificate {
            hessian: self.hessian.clone(),
            linear: self.linear.clone(),
            point: self.point.clone(),
            volt: self.volt,
            cones: self.cones.iter().map(cone).collect(),
        };
        certificate.residual().largest()
    }
}

/// What a forecast is computed from, beside the loads without control.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForecastRecord {
    /// T of the linearised rotor with the ideal actuator, column by column, load per V.
    #[serde(rename = "t_per_V")]
    pub t_per_volt: Vec<Vec<f64>>,
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

/// What every figure of a result shares: loads without control, definition of the weights, units.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Hub loads without control.
    pub baseline: [f64; 12],
    /// Weights of the case.
    pub weights: LoadWeightsFile,
    /// What they multiply.
    pub scale: LoadScaleChoice,
    /// Units of the rotor.
    pub scales: RotorScales,
}

impl Setting {
    /// Of a validated case.
    pub fn of_case(case: &Case, baseline: &HubLoads) -> Self {
        Self {
            baseline: baseline.parts(),
            weights: case.control.load_weights.clone(),
            scale: case.control.load_scale,
            scales: case.scales,
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
            weights: case.control.load_weights.clone(),
            scale: case.control.load_scale,
            scales: RotorScales::new(omega_rad_s, rotor.radius_m, rotor.mass_kg_m)?,
        })
    }

    /// Weight of each load, order `FX FY FZ MX MY MZ`: those of the case, over the squared amplitude without
    /// control if it asks for that.
    pub fn load_weights(&self) -> [f64; 6] {
        let w = &self.weights;
        let mut weights = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
        if self.scale == LoadScaleChoice::Baseline {
            for (weight, z) in weights.iter_mut().zip(self.baseline.chunks_exact(2)) {
                let square = z[0] * z[0] + z[1] * z[1];
                *weight = if square > 0.0 { *weight / square } else { *weight };
            }
        }
        weights
    }
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
