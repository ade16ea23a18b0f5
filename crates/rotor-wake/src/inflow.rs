//! What every inflow model shares: its inputs, its answer and the trait.

use crate::WakeError;
use crate::error::{ensure, ensure_finite};
use crate::{CirculationMap, InflowMap, WakeRotor};

/// State of flight of the rotor's hub in still air, in the shaft frame.
///
/// | field | symbol | unit | range |
/// |---|---|---|---|
/// | `advance_ratio` | `mu` | - | 0 and up |
/// | `shaft_tilt_rad` | `alpha_s` | rad | less than 90 deg either way, forward + |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightState {
    /// In-plane component of the flight velocity, `V cos(alpha_s) / (Omega R)`.
    pub advance_ratio: f64,
    /// Forward tilt of the shaft against the normal of the flight path, rad; a rotor that pulls the
    /// aircraft forward has a positive tilt.
    pub shaft_tilt_rad: f64,
}

impl FlightState {
    /// Component of the free stream normal to the disk, `mu tan(alpha_s)`, positive down through
    /// the disk.
    pub fn normal_inflow(&self) -> f64 {
        self.advance_ratio * self.shaft_tilt_rad.tan()
    }

    /// The same state if its numbers describe a flight.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for an advance ratio that is negative or not finite, or a tilt of
    /// 90 deg or more.
    pub fn validated(self) -> Result<Self, WakeError> {
        let Self { advance_ratio: mu, shaft_tilt_rad: tilt } = self;
        let is_flight = mu.is_finite() && mu >= 0.0;
        ensure(is_flight, "advance_ratio", mu, "a finite number, 0 or more")?;
        let is_tilt = tilt.abs() < std::f64::consts::FRAC_PI_2;
        ensure(is_tilt, "shaft_tilt_rad", tilt, "less than pi/2 either way")?;
        Ok(self)
    }
}

/// What the rotor does to the air, as far as the inflow models ask for it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RotorLoading {
    /// Thrust coefficient `C_T = T / (rho pi R^2 (Omega R)^2)`, thrust up +.
    pub thrust_coefficient: f64,
    /// First harmonics of the thrust over the disk, `[longitudinal, lateral]`: the integrals of
    /// `r cos psi` and of `r sin psi` over the thrust coefficient, per tip radius.
    pub moment_coefficients: [f64; 2],
    /// Bound circulation over the disk, on the grid the model asks for
    /// ([`InflowModel::circulation_grid`]).
    pub circulation: Option<CirculationMap>,
}

impl RotorLoading {
    /// The loading known by its thrust alone: all that uniform and Drees's inflow need.
    pub fn from_thrust_coefficient(thrust_coefficient: f64) -> Self {
        Self { thrust_coefficient, moment_coefficients: [0.0; 2], circulation: None }
    }

    /// The same loading with the longitudinal and lateral first harmonics of the thrust.
    #[must_use]
    pub fn with_moment_coefficients(self, moment_coefficients: [f64; 2]) -> Self {
        Self { moment_coefficients, ..self }
    }

    /// The same loading with its circulation over the disk.
    #[must_use]
    pub fn with_circulation(self, circulation: CirculationMap) -> Self {
        Self { circulation: Some(circulation), ..self }
    }
}

/// Induced velocity over the disk, divided by the tip speed, positive down.
///
/// ```text
/// Linear:  lambda_i(psi, r) = mean + r (cosine cos psi + sine sin psi)
/// Map:     a table over azimuth and radius
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum InducedInflow {
    /// Linear over the disk.
    Linear {
        /// Value at the centre, which is also the mean over the disk.
        mean: f64,
        /// Longitudinal gradient: more inflow over the tail (`psi = 0`) if positive.
        cosine: f64,
        /// Lateral gradient: more inflow on the advancing side (`psi = 90 deg`) if positive.
        sine: f64,
    },
    /// A table over the disk.
    Map(InflowMap),
}

impl InducedInflow {
    /// The same induced velocity everywhere.
    pub fn uniform(mean: f64) -> Self {
        Self::Linear { mean, cosine: 0.0, sine: 0.0 }
    }

    /// Induced inflow at an azimuth (rad) and a radial station `r` (unit `R`), positive down.
    pub fn at(&self, azimuth_rad: f64, r: f64) -> f64 {
        match self {
            Self::Linear { mean, cosine, sine } => {
                let (sin, cos) = azimuth_rad.sin_cos();
                mean + r * (cosine * cos + sine * sin)
            }
            Self::Map(map) => map.at(azimuth_rad, r),
        }
    }

    /// Induced velocity at several radial stations (unit `R`) of one azimuth (rad): inflow, positive down, and
    /// the velocity in the plane of the disk across the blade, from the leading to the trailing edge positive,
    /// which linear models leave out.
    pub fn velocities(&self, azimuth_rad: f64, stations: &[f64]) -> Vec<[f64; 2]> {
        match self {
            Self::Linear { .. } => {
                stations.iter().map(|&r| [self.at(azimuth_rad, r), 0.0]).collect()
            }
            Self::Map(map) => map.velocities(azimuth_rad, stations),
        }
    }

    /// Mean over the disk, by area; of a table, over the lifting part of it.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Linear { mean, .. } => *mean,
            Self::Map(map) => map.mean(),
        }
    }

    /// The numbers that make up the inflow, in an order that does not change: what a fixed-point
    /// iteration relaxes. `Linear`: mean, cosine, sine; `Map`: the inflow, then the velocity in the plane,
    /// azimuth by azimuth.
    pub fn parameters(&self) -> Vec<f64> {
        match self {
            Self::Linear { mean, cosine, sine } => vec![*mean, *cosine, *sine],
            Self::Map(map) => map.parameters(),
        }
    }

    /// An inflow of the same kind as `self` made of other numbers; the inverse of
    /// [`parameters`](Self::parameters).
    ///
    /// # Errors
    /// [`WakeError::ParameterCount`] if the count differs from that of `self`;
    /// [`WakeError::BadInput`] if a number is not finite.
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Self, WakeError> {
        ensure_finite("inflow parameter", parameters)?;
        match (self, parameters) {
            (Self::Linear { .. }, &[mean, cosine, sine]) => Ok(Self::Linear { mean, cosine, sine }),
            (Self::Linear { .. }, _) => {
                Err(WakeError::ParameterCount { expected: 3, got: parameters.len() })
            }
            (Self::Map(map), _) => Ok(Self::Map(map.with_parameters(parameters)?)),
        }
    }
}

/// An inflow model: from flight and loading to the induced velocity over the disk.
///
/// A model is a value without memory: the same question has the same answer. A caller that couples
/// it with blade motion iterates on [`InducedInflow::parameters`].
pub trait InflowModel: std::fmt::Debug + Send + Sync {
    /// Short name, as case files spell it.
    fn name(&self) -> &'static str;

    /// Induced inflow over the disk.
    ///
    /// # Errors
    /// [`WakeError`] if the inputs describe no flight, or the flow state is one the model does not
    /// describe.
    fn induced(
        &self,
        flight: &FlightState,
        loading: &RotorLoading,
    ) -> Result<InducedInflow, WakeError>;

    /// Whether the inflow depends on the loading; what is given does not.
    fn follows_loading(&self) -> bool {
        true
    }

    /// Panels and number of azimuths on which the model wants the circulation in
    /// [`RotorLoading::circulation`]; none if it asks for none.
    fn circulation_grid(&self) -> Option<(&WakeRotor, usize)> {
        None
    }

    /// For a change of the parameters that a fixed-point iteration found, a step that takes into account
    /// how the loading answers to it; none if the model has nothing to say. It alters the way to the
    /// fixed point, not the fixed point.
    fn improved_step(&self, _change: &[f64]) -> Option<Vec<f64>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn linear_inflow_in_the_four_quarters() {
        let inflow = InducedInflow::Linear { mean: 0.01, cosine: 0.004, sine: -0.002 };
        for (azimuth, want) in
            [(0.0, 0.012), (FRAC_PI_2, 0.009), (PI, 0.008), (3.0 * FRAC_PI_2, 0.011)]
        {
            assert_relative_eq!(inflow.at(azimuth, 0.5), want, max_relative = 1e-14);
        }
        assert_eq!(inflow.mean().to_bits(), 0.01_f64.to_bits());
    }

    #[test]
    fn parameters_go_out_and_come_back() {
        let inflow = InducedInflow::Linear { mean: 0.01, cosine: 0.004, sine: -0.002 };
        let other = InducedInflow::uniform(1.0);
        assert_eq!(other.with_parameters(&inflow.parameters()).unwrap(), inflow);
        assert_eq!(
            other.with_parameters(&[1.0]).unwrap_err(),
            WakeError::ParameterCount { expected: 3, got: 1 }
        );
        assert!(matches!(
            other.with_parameters(&[1.0, f64::NAN, 0.0]),
            Err(WakeError::BadInput { .. })
        ));
    }

    #[test]
    fn a_flight_that_is_none_is_refused() {
        let flight = |advance_ratio, shaft_tilt_rad| FlightState { advance_ratio, shaft_tilt_rad };
        assert!(flight(0.3, 0.1).validated().is_ok());
        for bad in
            [flight(-0.1, 0.0), flight(f64::NAN, 0.0), flight(0.3, 1.6), flight(0.3, f64::NAN)]
        {
            assert!(matches!(bad.validated(), Err(WakeError::BadInput { .. })), "{bad:?}");
        }
    }
}
