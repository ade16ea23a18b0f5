//! What a flap and its actuator do over a revolution.

use crate::costs::electrical::{ElectricalPower, electrical_power};
use crate::flaps::HingePower;
use rotor_base::series::scaled;
use rotor_base::{HarmonicSeries, RotorScales, uniform_azimuths_rad};
use rotor_response::HingeMoment;
use serde::Serialize;

/// Azimuths of the peaks.
const AZIMUTHS: usize = 360;

/// Power, moment, rate and angle of one flap of one blade, and the electrical power of its piezo.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct FlapCost {
    /// Mean power that the actuator gives, none taken back, W.
    #[serde(rename = "given_W")]
    pub given_watt: f64,
    /// Mean of its power, W.
    #[serde(rename = "net_W")]
    pub net_watt: f64,
    /// Largest size of the hinge moment, N m.
    #[serde(rename = "peak_hinge_moment_N_m")]
    pub peak_hinge_newton_metre: f64,
    /// Largest size of the rate of the flap, deg/s.
    pub peak_rate_deg_s: f64,
    /// Largest size of the flap angle, mean included, deg.
    pub peak_angle_deg: f64,
    /// Mean flap angle, deg.
    pub mean_angle_deg: f64,
    /// Electrical power; none where the case gives no capacitance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub electrical: Option<ElectricalPower>,
    /// How much of the actuator it takes; none where the case does not give blocked force and free stroke.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_line: Option<LoadLineUse>,
}

/// Force and stroke of an actuator over its blocked force `F_b` and its free stroke `x_f`.
///
/// ```text
/// F = H / a,   x = delta a,   a = 1 / (deg_per_um in rad/m)      2 |F| / F_b + |x - x_mean| / (x_f / 2) <= 1
/// ```
/// `a` is the lever of the linkage, and `F_b / x_f` the stiffness, both over the whole range of voltages. An actuator that swings
/// about the middle of them gives `x_f / 2` to either side where nothing holds it, and `F_b / 2` where it is blocked.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct LoadLineUse {
    /// Largest force over the blocked force.
    pub force_share: f64,
    /// Largest stroke to one side over half the free stroke.
    pub stroke_share: f64,
    /// Largest sum of both at one azimuth: above 1 the actuator cannot.
    pub load_line_share: f64,
}

/// What the actuator of a flap is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PiezoData {
    pub(crate) capacitance_farad: Option<f64>,
    /// Blocked force, N, and free stroke, m.
    pub(crate) blocked_and_free: Option<[f64; 2]>,
    /// Flap angle per displacement, rad/m; none without a linkage that is known.
    pub(crate) rad_per_metre: Option<f64>,
}

impl FlapCost {
    /// Of one flap: hinge moment in rotor units, voltage, flap angle, and the output of its law alone, where it has a loop.
    pub(crate) fn new(
        hinge: &HingeMoment,
        (voltage_volt, flap_deg): (&HarmonicSeries, &HarmonicSeries),
        law_deg: Option<&HarmonicSeries>,
        piezo: PiezoData,
        scales: &RotorScales,
    ) -> Self {
        let power = HingePower::new(hinge, flap_deg, scales);
        let omega_rad_s = scales.omega_rad_s();
        let rate = flap_deg.derivative();
        let moment = scaled(&hinge.total(), scales.moment_newton_metre());
        let (mut peak_rate, mut peak_angle) = (0.0_f64, 0.0_f64);
        let mut line = LoadLineUse::default();
        for azimuth in uniform_azimuths_rad(AZIMUTHS) {
            peak_rate = peak_rate.max(rate.value(azimuth).abs());
            let angle_deg = flap_deg.value(azimuth);
            peak_angle = peak_angle.max(angle_deg.abs());
            if let (Some([blocked, free]), Some(lever)) =
                (piezo.blocked_and_free, piezo.rad_per_metre)
            {
                let force = (moment.value(azimuth) * lever).abs() / blocked;
                let swing_rad = (angle_deg - flap_deg.mean).abs().to_radians();
                let stroke = 2.0 * swing_rad / lever.abs() / free;
                line.force_share = line.force_share.max(force);
                line.stroke_share = line.stroke_share.max(stroke);
                line.load_line_share = line.load_line_share.max(2.0 * force + stroke);
            }
        }
        let is_known = piezo.blocked_and_free.is_some() && piezo.rad_per_metre.is_some();
        Self {
            given_watt: power.given_watt,
            net_watt: power.net_watt,
            peak_hinge_newton_metre: power.peak_newton_metre,
            peak_rate_deg_s: omega_rad_s * peak_rate,
            peak_angle_deg: peak_angle,
            mean_angle_deg: flap_deg.mean,
            electrical: piezo.capacitance_farad.map(|capacitance| {
                electrical_power(voltage_volt, law_deg, capacitance, omega_rad_s)
            }),
            load_line: is_known.then_some(line),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_base::Harmonic;

    /// `3 deg cos(4 psi - 0.4)` beside a moment in phase: rates and shares in closed form.
    #[test]
    fn rate_and_load_line_are_those_of_a_wave() {
        let scales = RotorScales::new(40.0, 5.0, 6.5).unwrap();
        let mut flap_deg = HarmonicSeries { mean: 0.5, ..HarmonicSeries::zero(4) };
        // a phase on the grid of azimuths
        let phase = 4.0_f64.to_radians();
        flap_deg.set_harmonic(4, Harmonic::from_amplitude_phase(3.0, phase));
        let mut aerodynamic = HarmonicSeries::zero(4);
        let unit = scales.moment_newton_metre();
        aerodynamic.set_harmonic(4, Harmonic::from_amplitude_phase(2.0 / unit, phase));
        let hinge = HingeMoment { aerodynamic, inertial: HarmonicSeries::zero(0) };
        let piezo = PiezoData {
            capacitance_farad: None,
            blocked_and_free: Some([500.0, 500e-6]),
            // 0.04 deg/um
            rad_per_metre: Some(0.04e6_f64.to_radians()),
        };
        let cost =
            FlapCost::new(&hinge, (&HarmonicSeries::zero(0), &flap_deg), None, piezo, &scales);
        assert!((cost.peak_rate_deg_s / (3.0 * 4.0 * 40.0) - 1.0).abs() < 1e-3, "{cost:?}");
        assert!((cost.peak_angle_deg - 3.5).abs() < 1e-12 && cost.electrical.is_none());
        let line = cost.load_line.unwrap();
        // 2 N m over a lever of 1 / (0.04 deg/um): 1396 N; 75 um of 250 um
        let force = 2.0 * 0.04e6_f64.to_radians() / 500.0;
        assert!((line.force_share / force - 1.0).abs() < 1e-12, "{line:?}");
        assert!((line.stroke_share - 0.3).abs() < 1e-12, "{line:?}");
        assert!((line.load_line_share - 2.0 * force - 0.3).abs() < 1e-12, "{line:?}");
    }
}
