//! Pitt and Peters's inflow: mean and gradients follow the thrust and its first harmonics.

use crate::momentum::{modelled_skew_rad, momentum_inflow};
use crate::{FlightState, InducedInflow, InflowModel, RotorLoading, WakeError};
use std::f64::consts::PI;

/// The three-state model of Pitt and Peters, settled: in a periodic flight condition its states are
/// constant.
///
/// ```text
/// lambda_i = l0 + r (lc cos psi + ls sin psi),      t = tan(chi/2),  k = cos chi
/// l0 = C_T / 2V_T - (15 pi/64) t C_c / V
/// lc = (15 pi/64) t C_T / V_T + 4 k/(1 + k) C_c / V
/// ls = 4/(1 + k) C_s / V
/// V_T = sqrt(mu^2 + lambda^2),    V = (mu^2 + lambda (lambda + lambda_i)) / V_T
/// ```
/// `C_c` and `C_s` are the first harmonics of the thrust over the disk
/// ([`RotorLoading::moment_coefficients`]); `lambda` is that of momentum theory. Without them the gradient is
/// the model's static one, `lc / l0 = (15 pi/32) t`.
///
/// Source: Pitt and Peters, Vertica 5 (1981) 21; Peters and `HaQuang`, J. Am. Helicopter Soc. 33 (1988) 64, as
/// quoted in the rotorcraft literature. Differs from source: settled (no apparent mass), loads named by the
/// thrust harmonics instead of hub moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PittPeters;

impl InflowModel for PittPeters {
    fn name(&self) -> &'static str {
        "pitt-peters"
    }

    fn induced(
        &self,
        flight: &FlightState,
        loading: &RotorLoading,
    ) -> Result<InducedInflow, WakeError> {
        let flight = flight.validated()?;
        let ct = loading.thrust_coefficient;
        let uniform = momentum_inflow(&flight, ct)?;
        let lambda = flight.normal_inflow() + uniform;
        let chi = modelled_skew_rad(self.name(), &flight, uniform)?;
        let transport = flight.advance_ratio.hypot(lambda);
        if transport == 0.0 {
            return Ok(InducedInflow::uniform(0.0));
        }
        let mass_flow = (flight.advance_ratio.powi(2) + lambda * (lambda + uniform)) / transport;
        let [c_c, c_s] = loading.moment_coefficients;
        let (t, k) = ((0.5 * chi).tan(), chi.cos());
        let coupling = 15.0 * PI / 64.0 * t;
        Ok(InducedInflow::Linear {
            mean: uniform - coupling * c_c / mass_flow,
            cosine: coupling * ct / transport + 4.0 * k / (1.0 + k) * c_c / mass_flow,
            sine: 4.0 / (1.0 + k) * c_s / mass_flow,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    fn parts(inflow: &InducedInflow) -> [f64; 3] {
        let p = inflow.parameters();
        [p[0], p[1], p[2]]
    }

    #[test]
    fn the_static_gradient_at_the_stated_flight_point() {
        let flight = FlightState { advance_ratio: 0.30, shaft_tilt_rad: 5.0_f64.to_radians() };
        let loading = RotorLoading::from_thrust_coefficient(0.0049);
        let [mean, cosine, sine] = parts(&PittPeters.induced(&flight, &loading).unwrap());
        assert_abs_diff_eq!(mean, 0.008_114, epsilon = 5e-7);
        assert_abs_diff_eq!(cosine / mean, 1.314, epsilon = 5e-4);
        assert_abs_diff_eq!(sine, 0.0);
    }

    /// Hover: each gradient is `2/V` times its load, with `V = 2 lambda_0`, by momentum theory of the
    /// quarters of the disk.
    #[test]
    fn gradients_in_hover() {
        let flight = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };
        let loading =
            RotorLoading::from_thrust_coefficient(0.005).with_moment_coefficients([1e-4, -2e-4]);
        let [mean, cosine, sine] = parts(&PittPeters.induced(&flight, &loading).unwrap());
        assert_relative_eq!(mean, 0.05, max_relative = 1e-12);
        assert_relative_eq!(cosine, 1e-4 / 0.05, max_relative = 1e-12);
        assert_relative_eq!(sine, -2e-4 / 0.05, max_relative = 1e-12);
    }
}
