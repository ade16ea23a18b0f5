//! What the controller sees of the rotor and its actuators.

mod linear;
mod outputs;

pub use linear::LinearPlant;
pub use outputs::{HUB_OUTPUTS, PowerOutputs, hub_outputs, output_weights};

use crate::{ControlLayout, ControlLimits, TMatrix};
use rotor_base::Harmonic;

/// One steady measurement at one control vector.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// Outputs `Z` that the cost weighs, nondimensional, cosine and sine of each: the plant says what they are, and
    /// their number never changes. Of a rotor, the hub loads `Fx Fy Fz Mx My Mz` at the blade passing frequency in the
    /// fixed frame, 12 numbers in that order, and whatever else is to be kept small.
    pub outputs: Vec<f64>,
    /// Measured flap motion at the controlled harmonic, degrees, one per pair of the layout.
    pub flap_motion_deg: Vec<Harmonic>,
    /// Mean flap angle, degrees, one per flap: what the bias solution left of it.
    pub mean_flap_deg: Vec<f64>,
}

/// A rotor with its actuators, or anything else with harmonics in and harmonics out.
///
/// Every answer must depend on the arguments alone, not on the calls made before (an actuator with
/// memory is taken to its periodic state before it answers): central differences, step halving and
/// the search for the control weight compare answers of separate calls.
///
/// Implementations solve the bias voltage inside each call, so that the mean flap angle vanishes;
/// [`crate::BiasSolver`] does that for one actuator.
pub trait Plant {
    /// Why the plant could not answer.
    type Error: std::error::Error + 'static;

    /// Layout of the control vector.
    fn layout(&self) -> &ControlLayout;

    /// Steady response to a control vector, volt. This is the dear call: a trimmed aeroelastic
    /// solution.
    ///
    /// # Errors
    /// Whatever keeps the plant from a converged answer.
    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error>;

    /// Steady responses to several control vectors, in their order. The controls are independent, so
    /// a plant may answer them in parallel; by default one after the other.
    ///
    /// # Errors
    /// As [`Plant::measure`].
    fn measure_many(
        &mut self,
        controls_volt: &[Vec<f64>],
    ) -> Result<Vec<Measurement>, Self::Error> {
        controls_volt.iter().map(|control_volt| self.measure(control_volt)).collect()
    }

    /// Strokes (degrees, `>= 0`) that the actuators make for a control vector: the cheap call, with
    /// no aeroelastic solution. One number per limit of [`Plant::stroke_limits_deg`], usually one per
    /// pair of the layout: the amplitude of the flap at the controlled harmonic.
    ///
    /// It must answer for *any* finite control vector. Beyond the actuator's range the answer must lie
    /// above the limit and should go on growing with the voltage, for example in proportion to it: an
    /// actuator model that saturates must not hide there.
    ///
    /// # Errors
    /// Whatever keeps the actuator model from an answer.
    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error>;

    /// Largest strokes allowed, degrees, positive; `f64::INFINITY` where there is no limit.
    fn stroke_limits_deg(&self) -> Vec<f64>;

    /// Whether [`Plant::measure`] can be asked for this control vector, for example because the
    /// voltage lies in the actuator's range. A control step that leads outside is halved. Yes by
    /// default.
    fn admits(&self, control_volt: &[f64]) -> bool {
        let _ = control_volt;
        true
    }

    /// Convex limits of the control, as they stand at a control vector: the bias and the gain of an
    /// actuator with memory belong to the motion it makes. No limits by default; only
    /// [`crate::FeedbackController::run_constrained`] asks.
    ///
    /// # Errors
    /// Whatever keeps the actuator model from an answer.
    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, Self::Error> {
        let _ = control_volt;
        Ok(ControlLimits::none(self.layout()))
    }

    /// `T = dZ/du` about a control vector from a linearised solution, for plants that have one;
    /// `None` by default.
    ///
    /// # Errors
    /// Whatever keeps the plant from a linearised solution.
    fn linearised_t(&mut self, control_volt: &[f64]) -> Result<Option<TMatrix>, Self::Error> {
        let _ = control_volt;
        Ok(None)
    }
}
