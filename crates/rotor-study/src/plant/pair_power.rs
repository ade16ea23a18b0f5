//! Actuation power as a quadratic form of the control: what its weight and its limit are made of.
//!
//! ```text
//! flap at one harmonic    delta = A cos(n psi),   H = A (k_c cos n psi + k_s sin n psi)
//! power of the actuator   P = -H delta_dot = (n Omega A^2 / 2) (k_s + |k| sin(2 n psi - phase))
//! given, none taken back  mean max(0, P) = (n Omega A^2 / 2) (k_s (pi/2 + beta) + |k| cos beta) / pi,   sin beta = k_s / |k|
//! ```
//! A spring or a mass (`k_s = 0`) costs `n Omega A^2 |k| / 2 pi`, a damper `n Omega A^2 k_s / 2`. The form
//! is diagonal and never negative: cross terms of flaps, harmonics and the moment of the flaps at rest are
//! left out of its shape, not of the power that is reported. The limit brings its size up to date at
//! every step, see [`crate::RotorPlant`].
//!
//! Source: this project; the integral is elementary.

use crate::rotor::FlapAuthority;
use hhc_control::ControlLayout;
use rotor_base::series::{only, place, times};
use rotor_base::{Harmonic, RotorScales};
use std::f64::consts::{FRAC_PI_2, PI};

/// Mean power given to a flap at one harmonic over the square of its amplitude.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `harmonic` | `n` | per rev | >= 1 |
/// | `omega_rad_s` | `Omega` | rad/s | > 0 |
/// | `moment` | `k_c`, `k_s` | N m per rad | hinge moment of `delta = cos n psi` |
///
/// Returns W per `rad^2`, never negative.
pub fn given_watt_per_rad2(harmonic: u32, omega_rad_s: f64, moment: Harmonic) -> f64 {
    let size = moment.amplitude();
    if size == 0.0 {
        return 0.0;
    }
    let damping = (moment.sine / size).clamp(-1.0, 1.0);
    let beta = damping.asin();
    let mean = size * (damping * (FRAC_PI_2 + beta) + beta.cos()) / PI;
    0.5 * f64::from(harmonic) * omega_rad_s * mean.max(0.0)
}

/// The power of every pair of a layout for a flap amplitude of 1 deg, W per `deg^2`.
pub(crate) fn watt_per_deg2(
    layout: &ControlLayout,
    authority: &FlapAuthority,
    scales: &RotorScales,
) -> Vec<f64> {
    let pairs = (0..layout.pairs()).filter_map(|pair| layout.flap_and_harmonic(pair));
    pairs
        .map(|(flap, harmonic)| {
            let n = harmonic as usize;
            let all = authority.hinge(flap, &only(place(n, false), 1.0));
            let own = all.get(flap).map_or(Harmonic::default(), |h| h.harmonic(n));
            let moment = times(own, scales.moment_newton_metre());
            // moment per deg times rate per deg: the square of a degree in the end
            given_watt_per_rad2(harmonic, scales.omega_rad_s(), moment) * 1.0_f64.to_radians()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flaps::HingePower;
    use approx::assert_relative_eq;
    use rotor_base::HarmonicSeries;
    use rotor_response::HingeMoment;

    #[test]
    fn the_closed_form_is_the_mean_of_what_is_given() {
        let scales = RotorScales::new(40.0, 5.0, 6.5).unwrap();
        let unit = scales.moment_newton_metre();
        let (n, amplitude_deg) = (3, 2.0);
        let amplitude = f64::to_radians(amplitude_deg);
        for (k_c, k_s) in [(-9.0, 0.0), (0.0, 2.0), (-9.0, 2.5), (4.0, -1.0), (0.0, -3.0)] {
            let mut aerodynamic = HarmonicSeries::zero(n);
            let (cosine, sine) = (k_c * amplitude / unit, k_s * amplitude / unit);
            aerodynamic.set_harmonic(n, Harmonic { cosine, sine });
            let hinge = HingeMoment { aerodynamic, inertial: HarmonicSeries::zero(n) };
            let mut flap_deg = HarmonicSeries::zero(n);
            flap_deg.set_harmonic(n, Harmonic { cosine: amplitude_deg, sine: 0.0 });
            let sampled = HingePower::new(&hinge, &flap_deg, &scales).given_watt;
            let moment = Harmonic { cosine: k_c, sine: k_s };
            let closed = given_watt_per_rad2(3, 40.0, moment) * amplitude * amplitude;
            if k_s < 0.0 && k_c == 0.0 {
                assert!(sampled.abs() < 1e-12 && closed.abs() < 1e-12);
            } else {
                assert_relative_eq!(closed, sampled, max_relative = 1e-3);
            }
        }
    }
}
