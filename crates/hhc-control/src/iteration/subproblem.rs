//! The quadratic subproblem of one step.

use crate::law::Proximal;
use crate::sensitivity::Sensitivity;
use crate::{ControlError, ControlLimits, KktResidual, OperatingPoint, Plant, RunError};

/// The predicted cost with a control weight, and the limits within which it is minimised.
pub(super) struct Subproblem {
    /// 1/V^2.
    pub(super) rho: f64,
    pub(super) limits: Option<ControlLimits>,
}

/// Its solution.
#[derive(Clone)]
pub(super) struct Target {
    pub(super) control_volt: Vec<f64>,
    /// How exactly it is the optimum within the limits; none without limits.
    pub(super) kkt: Option<KktResidual>,
}

impl Subproblem {
    /// The control that minimises the cost predicted from a measured state, with `damping |u - u_here|^2` (1/V^2)
    /// beside it.
    pub(super) fn target(
        &self,
        model: &Sensitivity<'_>,
        from: OperatingPoint<'_>,
        damping: f64,
    ) -> Result<Target, ControlError> {
        let target = model.modal_target(from)?;
        let proximal = Proximal { weight: damping, control_volt: from.control_volt };
        Ok(match &self.limits {
            None => Target {
                control_volt: model.law.optimum_near(self.rho, &target, proximal),
                kkt: None,
            },
            Some(limits) => {
                let found = model.law.optimum_near_within(self.rho, &target, proximal, limits)?;
                Target { control_volt: found.control_volt, kkt: Some(found.kkt) }
            }
        })
    }
}

/// The plant's limits at a control vector.
pub(super) fn limits_at<P: Plant>(
    plant: &mut P,
    control_volt: &[f64],
) -> Result<ControlLimits, RunError<P::Error>> {
    plant.limits(control_volt).map_err(RunError::plant("asked for its limits", control_volt))
}
