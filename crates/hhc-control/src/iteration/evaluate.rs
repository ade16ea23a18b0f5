//! Measurements of the plant, checked, and their cost.

use crate::{AllowedIncrease, ControlStep, Cost, FeedbackLaw, Measurement, Plant};
use crate::{RunError, error};

impl FeedbackLaw {
    /// The state before the first step.
    pub(crate) fn start<P: Plant>(
        &self,
        plant: &mut P,
        start_volt: &[f64],
    ) -> Result<ControlStep, RunError<P::Error>> {
        let what = "controls of the plant, against columns of T";
        error::check_length(what, plant.layout().len(), self.shape().1)?;
        plant.layout().check(start_volt)?;
        let measurement = self.measured(plant, start_volt, Vec::new)?;
        Ok(ControlStep {
            control_volt: start_volt.to_vec(),
            cost: self.cost(&measurement, start_volt, 0.0),
            measurement,
            rho: 0.0,
            asked_volt: 0.0,
            backtracks: 0,
            allowed_increase: AllowedIncrease::None,
        })
    }

    /// One checked measurement; `history` is made for an error alone.
    pub(super) fn measured<P: Plant>(
        &self,
        plant: &mut P,
        control_volt: &[f64],
        history: impl FnOnce() -> Vec<ControlStep>,
    ) -> Result<Measurement, RunError<P::Error>> {
        let measurement = plant.measure(control_volt).map_err(|source| RunError::Plant {
            call: "measured",
            at_volt: control_volt.to_vec(),
            history: history(),
            source,
        })?;
        error::check_vector("measured outputs", &measurement.outputs, self.shape().0)?;
        let layout = plant.layout();
        let flaps = measurement.flap_motion_deg.len();
        error::check_length("measured flap harmonics", flaps, layout.pairs())?;
        error::check_vector("mean flap angle (deg)", &measurement.mean_flap_deg, layout.flaps())?;
        Ok(measurement)
    }

    /// Cost of a measurement with the load weights of the law.
    pub(super) fn cost(&self, measurement: &Measurement, control_volt: &[f64], rho: f64) -> Cost {
        Cost::of(&measurement.outputs, self.load_weights(), control_volt, rho)
    }

    /// The same state with its cost formed with another weight.
    pub(super) fn weighed(&self, step: &ControlStep, rho: f64) -> ControlStep {
        let cost = self.cost(&step.measurement, &step.control_volt, rho);
        ControlStep { rho, cost, ..step.clone() }
    }
}
