//! A plant whose loads are worked out in another way than by the rotor's response.

use crate::flaps::PlantError;
use crate::plant::rotor_plant::RotorPlant;
use hhc_control::{ControlLayout, ControlLimits, Measurement, Plant, TMatrix};

/// What is answered in place of a [`RotorPlant`].
pub(crate) trait Answers {
    /// The measurement at a control vector, V.
    ///
    /// # Errors
    /// The errors of actuator and rotor.
    fn measure(
        &mut self,
        plant: &RotorPlant,
        control_volt: &[f64],
    ) -> Result<Measurement, PlantError>;

    /// T about a control vector, V.
    ///
    /// # Errors
    /// Whatever keeps it from an answer.
    fn offered_t(
        &self,
        plant: &mut RotorPlant,
        control_volt: &[f64],
    ) -> Result<Option<TMatrix>, PlantError>;
}

/// A [`RotorPlant`] that is measured in another way; layout, strokes and limits are its own.
#[derive(Debug, Clone)]
pub(crate) struct Answered<A> {
    pub(crate) plant: RotorPlant,
    pub(crate) answers: A,
}

impl<A: Answers> Plant for Answered<A> {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        self.answers.measure(&self.plant, control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.plant.admits(control_volt)
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, PlantError> {
        self.plant.limits(control_volt)
    }

    fn linearised_t(&mut self, control_volt: &[f64]) -> Result<Option<TMatrix>, PlantError> {
        self.answers.offered_t(&mut self.plant, control_volt)
    }
}

/// The rotor linearised about its trim with the actuators as they are, which alone are evaluated: what can be
/// worked out beforehand.
#[derive(Debug, Clone)]
pub(crate) struct Linearised;

impl Answers for Linearised {
    fn measure(
        &mut self,
        plant: &RotorPlant,
        control_volt: &[f64],
    ) -> Result<Measurement, PlantError> {
        let rotor = plant.rotor();
        let authority = rotor.authority()?;
        let flaps = plant.flap_motion(control_volt)?;
        let mut hub_loads = rotor.trim().rotor.hub.harmonic(rotor.rotor().model().blades);
        for (flap, motion) in flaps.iter().enumerate() {
            let changes = authority.loads(flap, &motion.flap_deg);
            for (load, change) in hub_loads.iter_mut().zip(changes) {
                *load += change;
            }
        }
        Ok(plant.measurement(control_volt, &hub_loads, &flaps))
    }

    fn offered_t(
        &self,
        plant: &mut RotorPlant,
        control_volt: &[f64],
    ) -> Result<Option<TMatrix>, PlantError> {
        plant.t_about_trim(control_volt).map(Some)
    }
}
