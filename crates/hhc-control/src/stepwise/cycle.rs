//! Estimate and control together: loads in, control out.

use super::{EstimatorSettings, LoadEstimator, Observed, RelaxedController};
use crate::{ControlError, OperatingPoint, TMatrix};

/// A [`RelaxedController`] whose T and Z are those of a [`LoadEstimator`], its control turned to and fro.
///
/// ```text
/// u_p = R(a s_p) c_p,    s_p = -1 to the power of the ones in the binary digits of (cycle and p),   p = 1, 2 ... pairs
/// ```
/// `c` is the control of the controller, `a` the [`EstimatorSettings::dither_rad`]. A turn keeps the amplitudes; on the circle of a
/// limit `J` is level to first order, and the loads there tell that part of T which places the optimum. About an optimum that no
/// limit binds `J` rises by `sin^2 a` times the sum of `|W^(1/2) T_p c_p|^2`. Without voltage there is nothing to turn.
///
/// Source: the dual controllers of W. Johnson, NASA TP-1996 (1982). The turn and its signs are this project's.
#[derive(Debug, Clone)]
pub struct CycleController {
    estimator: LoadEstimator,
    controller: RelaxedController,
    loads: Vec<f64>,
    observed: Observed,
    /// What acts, volt: the control of the controller, turned to and fro.
    acting_volt: Vec<f64>,
    /// Sine and cosine of that turn.
    turn: (f64, f64),
    rate_limit_volt: f64,
    cycles: u64,
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
        Ok(Self {
            loads: outputs.to_vec(),
            observed: Observed::AsExpected,
            acting_volt: controller.control_volt().to_vec(),
            turn: settings.dither_rad.sin_cos(),
            rate_limit_volt: controller.rate_limit_volt(),
            cycles: 0,
            estimator,
            controller,
        })
    }

    /// The next control, volt, from the loads measured at the present one.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; control and estimate then stay.
    pub fn step(&mut self, outputs: &[f64]) -> Result<&[f64], ControlError> {
        let Self { estimator, controller, loads, observed, acting_volt, .. } = self;
        *observed = estimator.observe(OperatingPoint { control_volt: acting_volt, outputs })?;
        estimator.loads_at(controller.control_volt(), loads);
        controller.step(estimator.t(), loads)?;
        self.dither();
        Ok(&self.acting_volt)
    }

    /// Turns every harmonic to one side or the other, by signs that are orthogonal over the cycles and have no mean, at no more
    /// than the rate.
    fn dither(&mut self) {
        let Self { controller, acting_volt, turn: (sin, cos), rate_limit_volt, cycles, .. } = self;
        if *sin == 0.0 {
            acting_volt.copy_from_slice(controller.control_volt());
            return;
        }
        let pairs = controller.control_volt().chunks_exact(2).zip(acting_volt.chunks_exact_mut(2));
        for (signs, (centre, acting)) in (1_u64..).zip(pairs) {
            let is_back = (*cycles & signs).count_ones() % 2 == 1;
            let sin = if is_back { -*sin } else { *sin };
            let to = [*cos * centre[0] - sin * centre[1], *cos * centre[1] + sin * centre[0]];
            let way = (to[0] - acting[0]).hypot(to[1] - acting[1]);
            let share = (*rate_limit_volt / way.max(f64::MIN_POSITIVE)).min(1.0);
            for (acting, to) in acting.iter_mut().zip(to) {
                *acting += share * (to - *acting);
            }
        }
        *cycles += 1;
    }

    /// The control that acts, volt: that of [`Self::controller`], turned to and fro.
    pub fn control_volt(&self) -> &[f64] {
        &self.acting_volt
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

    /// The controller: its control without the turn to and fro, and its limits.
    pub fn controller(&self) -> &RelaxedController {
        &self.controller
    }

    /// What the last measured pair told.
    pub fn observed(&self) -> Observed {
        self.observed
    }
}
