//! Estimate and control together: loads in, control out.

use super::{EstimatorSettings, LoadEstimator, Observed, RelaxedController};
use crate::{ControlError, OperatingPoint, TMatrix};

/// A [`RelaxedController`] whose T and Z are those of a [`LoadEstimator`].
#[derive(Debug, Clone)]
pub struct CycleController {
    estimator: LoadEstimator,
    controller: RelaxedController,
    loads: Vec<f64>,
    observed: Observed,
}

impl CycleController {
    /// Takes over from the control that acts on a controller, with the loads measured there and a T0 (1/V).
    ///
    /// # Errors
    /// As [`LoadEstimator::new`].
    pub fn new(
        controller: RelaxedController,
        settings: &EstimatorSettings,
        t0: &TMatrix,
        outputs: &[f64],
    ) -> Result<Self, ControlError> {
        let start = OperatingPoint { control_volt: controller.control_volt(), outputs };
        let estimator = LoadEstimator::new(settings, t0, start)?;
        Ok(Self { estimator, controller, loads: outputs.to_vec(), observed: Observed::AsExpected })
    }

    /// The next control, volt, from the loads measured at the present one.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; control and estimate then stay.
    pub fn step(&mut self, outputs: &[f64]) -> Result<&[f64], ControlError> {
        let Self { estimator, controller, loads, observed } = self;
        let control_volt = controller.control_volt();
        *observed = estimator.observe(OperatingPoint { control_volt, outputs })?;
        estimator.loads_at(control_volt, loads);
        controller.step(estimator.t(), loads)
    }

    /// Leaves a load (from 0) out of cost and estimate, or takes it in again.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a load that there is not.
    pub fn set_load_lost(&mut self, load: usize, is_lost: bool) -> Result<(), ControlError> {
        self.controller.set_load_lost(load, is_lost)?;
        self.estimator.set_load_lost(load, is_lost)
    }

    /// Leaves a flap (from 0) out for good.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a flap that there is not.
    pub fn lose_flap(&mut self, flap: usize) -> Result<(), ControlError> {
        self.controller.set_flap_lost(flap, true)?;
        self.estimator.lose_controls(self.controller.controls_of(flap))
    }

    /// What T, Z0 and the noise are estimated to be.
    pub fn estimator(&self) -> &LoadEstimator {
        &self.estimator
    }

    /// The controller, its control that acts and its limits.
    pub fn controller(&self) -> &RelaxedController {
        &self.controller
    }

    /// What the last measured pair told.
    pub fn observed(&self) -> Observed {
        self.observed
    }
}
