//! Models whose induced inflow is linear over the disk.

use crate::error::ensure_finite;
use crate::momentum::{modelled_skew_rad, momentum_inflow};
use crate::{FlightState, InducedInflow, InflowModel, RotorLoading, WakeError};

/// The linear inflow models.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LinearInflow {
    /// A given induced inflow, the same all over the disk and whatever the thrust.
    Prescribed {
        /// `lambda_i`, positive down.
        induced_inflow: f64,
    },
    /// Momentum theory, the same all over the disk: see [`momentum_inflow`].
    Uniform,
    /// Momentum theory for the mean with Drees's gradients: see [`drees_factors`].
    Drees,
}

/// Longitudinal and lateral gradient factors `[k_x, k_y]` of Drees's inflow.
///
/// ```text
/// lambda_i(psi, r) = lambda_0 (1 + k_x r cos psi + k_y r sin psi)
/// k_x = (4/3) (1 - cos chi - 1.8 mu^2) / sin chi,    k_y = -2 mu,    chi = atan2(mu, lambda)
/// ```
/// computed in the form `k_x = (4/3) [tan(chi/2) - 1.8 mu sqrt(mu^2 + lambda^2)]`, the same number
/// without the division by zero in hover, where both factors vanish.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `advance_ratio` | `mu` | - | 0 to about 0.4 |
/// | `inflow` | `lambda`, normal free stream included | - | down + |
///
/// Assumes: a steady skewed wake of constant circulation, unlike blades' loading; a reading for
/// level flight and climb. Infinite for `mu = 0` and `lambda <= 0`.
///
/// Source: Drees, J. Helicopter Assoc. of Great Britain 3 (1949); the factors as quoted in the
/// rotorcraft literature.
pub fn drees_factors(advance_ratio: f64, inflow: f64) -> [f64; 2] {
    let speed = advance_ratio.hypot(inflow);
    // tan(chi/2) = mu / (V + lambda) = (V - lambda) / mu: the form that does not cancel
    let half_angle_tangent = if inflow >= 0.0 {
        if speed == 0.0 { 0.0 } else { advance_ratio / (speed + inflow) }
    } else {
        (speed - inflow) / advance_ratio
    };
    [4.0 / 3.0 * (half_angle_tangent - 1.8 * advance_ratio * speed), -2.0 * advance_ratio]
}

impl InflowModel for LinearInflow {
    fn name(&self) -> &'static str {
        match self {
            Self::Prescribed { .. } => "prescribed",
            Self::Uniform => "uniform",
            Self::Drees => "drees",
        }
    }

    fn follows_loading(&self) -> bool {
        !matches!(self, Self::Prescribed { .. })
    }

    fn induced(
        &self,
        flight: &FlightState,
        loading: &RotorLoading,
    ) -> Result<InducedInflow, WakeError> {
        let flight = flight.validated()?;
        match *self {
            Self::Prescribed { induced_inflow } => {
                ensure_finite("prescribed induced_inflow", &[induced_inflow])?;
                Ok(InducedInflow::uniform(induced_inflow))
            }
            Self::Uniform => {
                momentum_inflow(&flight, loading.thrust_coefficient).map(InducedInflow::uniform)
            }
            Self::Drees => {
                let mean = momentum_inflow(&flight, loading.thrust_coefficient)?;
                modelled_skew_rad(self.name(), &flight, mean)?;
                let [k_x, k_y] = drees_factors(flight.advance_ratio, flight.normal_inflow() + mean);
                Ok(InducedInflow::Linear { mean, cosine: mean * k_x, sine: mean * k_y })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use rotor_base::{gauss_legendre, uniform_azimuths_rad};

    const FLIGHT: FlightState =
        FlightState { advance_ratio: 0.30, shaft_tilt_rad: 0.087_266_462_6 };

    #[test]
    fn drees_factors_at_the_stated_flight_point() {
        let [k_x, k_y] = drees_factors(0.30, 0.034_360);
        assert_abs_diff_eq!(k_x, 0.972, epsilon = 5e-4);
        assert_abs_diff_eq!(k_y, -0.6, epsilon = 1e-15);
    }

    #[test]
    fn both_forms_of_the_longitudinal_factor_agree() {
        for (mu, lambda) in [(0.05, 0.05), (0.2, 0.02), (0.35, 0.001), (0.3, -0.1)] {
            let chi = f64::atan2(mu, lambda);
            let printed = 4.0 / 3.0 * (1.0 - chi.cos() - 1.8 * mu * mu) / chi.sin();
            assert_relative_eq!(drees_factors(mu, lambda)[0], printed, max_relative = 1e-13);
        }
        for lambda in [0.05, 0.0] {
            assert!(drees_factors(0.0, lambda).iter().all(|k| k.abs() <= 0.0));
        }
    }

    #[test]
    fn the_mean_of_drees_is_uniform_inflow() {
        let loading = RotorLoading::from_thrust_coefficient(0.0049);
        let uniform = LinearInflow::Uniform.induced(&FLIGHT, &loading).unwrap();
        let drees = LinearInflow::Drees.induced(&FLIGHT, &loading).unwrap();
        assert_eq!(uniform.mean().to_bits(), drees.mean().to_bits());
        // by the definition, not by the field: the area mean of the values over the disk
        let rule = gauss_legendre(3);
        let azimuths = uniform_azimuths_rad(16);
        let mut sum = 0.0;
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let r = 0.5 * (node + 1.0);
            let ring: f64 = azimuths.iter().map(|&azimuth| drees.at(azimuth, r)).sum();
            sum += weight * r * ring / 16.0;
        }
        assert_relative_eq!(sum, uniform.mean(), max_relative = 1e-13);
    }

    #[test]
    fn prescribed_inflow_does_not_ask_the_thrust() {
        let model = LinearInflow::Prescribed { induced_inflow: 0.008 };
        for thrust in [0.0, 0.005, f64::NAN] {
            let loading = RotorLoading::from_thrust_coefficient(thrust);
            let inflow = model.induced(&FLIGHT, &loading).unwrap();
            assert_eq!(inflow, InducedInflow::uniform(0.008));
        }
        let bad = LinearInflow::Prescribed { induced_inflow: f64::NAN };
        let loading = RotorLoading::from_thrust_coefficient(0.005);
        assert!(matches!(bad.induced(&FLIGHT, &loading), Err(WakeError::BadInput { .. })));
    }

    #[test]
    fn drees_refuses_a_wake_that_leaves_upward() {
        let flight = FlightState { advance_ratio: 0.05, shaft_tilt_rad: -1.35 };
        let loading = RotorLoading::from_thrust_coefficient(0.005);
        assert!(LinearInflow::Uniform.induced(&flight, &loading).is_ok());
        let error = LinearInflow::Drees.induced(&flight, &loading).unwrap_err();
        assert!(matches!(error, WakeError::WakeAboveDisk { .. }), "{error}");
    }

    #[test]
    fn the_trait_is_usable_through_a_reference() {
        let models: [&dyn InflowModel; 3] = [
            &LinearInflow::Prescribed { induced_inflow: 0.01 },
            &LinearInflow::Uniform,
            &LinearInflow::Drees,
        ];
        let names: Vec<_> = models.iter().map(|m| m.name()).collect();
        assert_eq!(names, ["prescribed", "uniform", "drees"]);
    }
}
