//! What a flap asks of its actuator: hinge moment and power.

use rotor_base::series::scaled;
use rotor_base::{HarmonicSeries, RotorScales, uniform_azimuths_rad};
use rotor_response::HingeMoment;

/// Azimuths of peaks and means; enough for the products of 24 harmonics of motion and 64 of load.
const AZIMUTHS: usize = 360;

/// Hinge moment and actuation power of one flap of one blade over a revolution.
///
/// ```text
/// P = -H delta_dot         power of the actuator on the flap; its moment is -H
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HingePower {
    /// Largest size of the hinge moment, N m.
    pub peak_newton_metre: f64,
    /// Largest size of its aerodynamic part, N m.
    pub peak_aerodynamic_newton_metre: f64,
    /// Largest size of its inertial part, N m.
    pub peak_inertial_newton_metre: f64,
    /// Mean of the power where the actuator gives it, `mean max(0, P)`, W: what an actuator needs that
    /// cannot take any back.
    pub given_watt: f64,
    /// Mean of the power, `mean P`, W: what air and blade keep.
    pub net_watt: f64,
}

impl HingePower {
    /// From the hinge moment in rotor units and the flap motion.
    pub fn new(hinge: &HingeMoment, flap_deg: &HarmonicSeries, scales: &RotorScales) -> Self {
        let unit = scales.moment_newton_metre();
        let (total, rate) = (hinge.total(), scaled(flap_deg, 1.0_f64.to_radians()).derivative());
        let mut found = Self::default();
        for azimuth in uniform_azimuths_rad(AZIMUTHS) {
            let moment = unit * total.value(azimuth);
            let larger = |peak: f64, value: f64| peak.max(value.abs());
            found.peak_newton_metre = larger(found.peak_newton_metre, moment);
            found.peak_aerodynamic_newton_metre = larger(
                found.peak_aerodynamic_newton_metre,
                unit * hinge.aerodynamic.value(azimuth),
            );
            found.peak_inertial_newton_metre =
                larger(found.peak_inertial_newton_metre, unit * hinge.inertial.value(azimuth));
            let power = -moment * rate.value(azimuth) * scales.omega_rad_s() / AZIMUTHS as f64;
            found.given_watt += power.max(0.0);
            found.net_watt += power;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use rotor_base::Harmonic;

    /// A spring takes and gives back, a damper only takes.
    #[test]
    fn a_spring_keeps_nothing_and_a_damper_all() {
        let scales = RotorScales::new(40.0, 5.0, 6.5).unwrap();
        let unit = scales.moment_newton_metre();
        let (amplitude_deg, n) = (3.0, 4);
        let mut flap_deg = HarmonicSeries::zero(4);
        flap_deg.set_harmonic(n, Harmonic { cosine: amplitude_deg, sine: 0.0 });
        let amplitude = f64::to_radians(amplitude_deg);
        let moment = |h: Harmonic| {
            let mut aerodynamic = HarmonicSeries::zero(4);
            aerodynamic.set_harmonic(n, h);
            HingeMoment { aerodynamic, inertial: HarmonicSeries::zero(4) }
        };
        let rate = n as f64 * scales.omega_rad_s() * amplitude;
        // H = -k delta: the mean of the positive half of a sine of the doubled frequency
        let stiffness = 9.0;
        let spring = moment(Harmonic { cosine: -stiffness * amplitude / unit, sine: 0.0 });
        let spring = HingePower::new(&spring, &flap_deg, &scales);
        let size = stiffness * amplitude * rate;
        assert_abs_diff_eq!(spring.net_watt, 0.0, epsilon = 1e-12 * size);
        assert_relative_eq!(
            spring.given_watt,
            0.5 * size / std::f64::consts::PI,
            max_relative = 1e-3
        );
        assert_relative_eq!(spring.peak_newton_metre, stiffness * amplitude, max_relative = 1e-9);
        // H = -c delta_dot: delta' = -n A sin, so H = c n A sin
        let damping = 0.02;
        let damper = moment(Harmonic { cosine: 0.0, sine: damping * rate / unit });
        let damper = HingePower::new(&damper, &flap_deg, &scales);
        assert_relative_eq!(damper.net_watt, 0.5 * damping * rate * rate, max_relative = 1e-9);
        assert_relative_eq!(damper.given_watt, damper.net_watt, max_relative = 1e-12);
    }
}
