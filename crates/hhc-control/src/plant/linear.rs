//! An exactly linear plant: the oracle of the tests and the plant of the example.

use crate::{ControlError, ControlLayout, Measurement, Plant, TMatrix, error};
use rotor_base::Harmonic;
use std::convert::Infallible;

/// A plant whose loads are linear in the voltages and whose actuators are pure gain and lag.
///
/// ```text
/// Z = Z0 + T u,      flap(pair) = g A cos(n psi - phase - lag)   for a voltage A cos(n psi - phase)
/// ```
/// The answer of every control problem on it is known in closed form. It has no hysteresis: its
/// T matrix does not depend on the step, and the mean flap angle is zero without bias.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearPlant {
    layout: ControlLayout,
    baseline_loads: Vec<f64>,
    t: TMatrix,
    gain_deg_per_volt: f64,
    lag_rad: f64,
    stroke_limit_deg: f64,
}

impl LinearPlant {
    /// A plant with baseline loads `Z0` (nondimensional) and sensitivity `T` (1/V), with actuators
    /// of 1 deg/V, no lag and no stroke limit.
    ///
    /// # Errors
    /// [`ControlError::Length`] if the sizes do not fit, [`ControlError::NotFinite`].
    pub fn new(
        layout: ControlLayout,
        baseline_loads: Vec<f64>,
        t: TMatrix,
    ) -> Result<Self, ControlError> {
        error::check_vector("baseline loads", &baseline_loads, t.loads())?;
        error::check_length("columns of the T matrix", t.controls(), layout.len())?;
        let (gain_deg_per_volt, lag_rad, stroke_limit_deg) = (1.0, 0.0, f64::INFINITY);
        Ok(Self { layout, baseline_loads, t, gain_deg_per_volt, lag_rad, stroke_limit_deg })
    }

    /// The same plant with another actuator: gain `g` in degrees per volt (positive) and lag in
    /// radians of harmonic phase.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`], [`ControlError::NotFinite`].
    pub fn with_actuator(self, gain_deg_per_volt: f64, lag_rad: f64) -> Result<Self, ControlError> {
        error::check_positive("actuator gain (deg/V)", gain_deg_per_volt)?;
        error::check_vector("actuator lag (rad)", &[lag_rad], 1)?;
        Ok(Self { gain_deg_per_volt, lag_rad, ..self })
    }

    /// The same plant with a limit on the flap amplitude of every pair, degrees.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] unless positive and finite.
    pub fn with_stroke_limit_deg(self, stroke_limit_deg: f64) -> Result<Self, ControlError> {
        error::check_positive("stroke limit (deg)", stroke_limit_deg)?;
        Ok(Self { stroke_limit_deg, ..self })
    }

    fn flap_motion_deg(&self, control_volt: &[f64]) -> Vec<Harmonic> {
        crate::layout::as_harmonics(control_volt)
            .iter()
            .map(|voltage| {
                Harmonic::from_amplitude_phase(
                    self.gain_deg_per_volt * voltage.amplitude(),
                    voltage.phase_rad() + self.lag_rad,
                )
            })
            .collect()
    }
}

impl Plant for LinearPlant {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error> {
        let mut hub_loads = self.baseline_loads.clone();
        for (column, volt) in self.t.columns().iter().zip(control_volt) {
            for (load, t) in hub_loads.iter_mut().zip(column) {
                *load += t * volt;
            }
        }
        Ok(Measurement {
            outputs: hub_loads,
            flap_motion_deg: self.flap_motion_deg(control_volt),
            mean_flap_deg: vec![0.0; self.layout.flaps()],
        })
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error> {
        Ok(self.flap_motion_deg(control_volt).iter().map(Harmonic::amplitude).collect())
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![self.stroke_limit_deg; self.layout.pairs()]
    }

    fn linearised_t(&mut self, _: &[f64]) -> Result<Option<TMatrix>, Self::Error> {
        Ok(Some(self.t.clone()))
    }
}
