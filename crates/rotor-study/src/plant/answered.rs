//! The rotor linearised about its trim, as a plant.

use crate::flaps::PlantError;
use crate::plant::rotor_plant::RotorPlant;
use hhc_control::{ControlLayout, ControlLimits, Measurement, Plant, TMatrix};
use rotor_base::series::scaled;

/// The rotor linearised about its trim with the actuators as they are, which alone are evaluated: what can be
/// worked out beforehand. Layout, strokes and limits are those of the plant.
#[derive(Debug, Clone)]
pub(crate) struct LinearisedPlant(pub(crate) RotorPlant);

impl Plant for LinearisedPlant {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        self.0.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        linearised_answer(&self.0, control_volt, 1.0)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        self.0.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.0.stroke_limits_deg()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.0.admits(control_volt)
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, PlantError> {
        self.0.limits(control_volt)
    }

    fn linearised_t(&mut self, control_volt: &[f64]) -> Result<Option<TMatrix>, PlantError> {
        self.0.t_about_trim(control_volt).map(Some)
    }
}

/// The measurement of the rotor linearised about its trim, a share of the motion of the flaps left.
///
/// # Errors
/// The errors of the actuator; a rotor without a linearised answer.
pub(crate) fn linearised_answer(
    plant: &RotorPlant,
    control_volt: &[f64],
    share: f64,
) -> Result<Measurement, PlantError> {
    let rotor = plant.rotor();
    let authority = rotor.authority()?;
    let flaps = plant.flap_motion(control_volt)?;
    let mut hub_loads = rotor.trim().rotor.hub.harmonic(rotor.rotor().model().blades);
    for (flap, motion) in flaps.iter().enumerate() {
        let changes = authority.loads(flap, &scaled(&motion.flap_deg, share));
        for (load, change) in hub_loads.iter_mut().zip(changes) {
            *load += change;
        }
    }
    Ok(plant.measurement(control_volt, &hub_loads, &flaps))
}
