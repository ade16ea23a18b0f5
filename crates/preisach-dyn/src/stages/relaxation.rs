//! A distribution of relaxation times.

use super::creep::CreepStep;
use crate::PreisachError;
use crate::check::{check_not_negative, check_positive, check_that};
use serde::{Deserialize, Serialize};

/// One relaxation time and its share of the response.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RelaxationElement {
    /// Share of the response that follows with this time constant, 0 to 1.
    pub share: f64,
    /// Time constant, s, `> 0`.
    pub time_constant_s: f64,
}

/// First-order lags in parallel behind the law: the ceramic follows its field with several
/// relaxation times at once.
///
/// ```text
/// y = (1 - sum_i f_i) u + sum_i f_i x_i,   T_i dx_i/dt + x_i = u
/// ```
/// What the shares leave of 1 follows at once. The gain at rest is 1, so a settled output does not
/// depend on the stage. No element, or all `f_i = 0`, is the identity; one element with `f = 1` is a
/// first-order lag. Exact for an input straight between samples.
/// Source: L. Boltzmann's superposition of relaxations; R. M. Christensen, *Theory of
/// Viscoelasticity* (1982), section 1.2 (the spectrum of relaxation times).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relaxation {
    /// The elements; their shares sum to at most 1.
    pub elements: Vec<RelaxationElement>,
}

impl Relaxation {
    pub(super) fn check(&self) -> Result<(), PreisachError> {
        let mut value = 0.0;
        for element in &self.elements {
            check_not_negative("share", element.share)?;
            check_positive("time_constant_s", element.time_constant_s)?;
            value += element.share;
        }
        check_that(value <= 1.0 + 1e-12, "sum of the relaxation shares", value, "0 to 1")
    }

    pub(super) fn prepared(&self, step_s: f64) -> CreepStep {
        let lag = |e: &RelaxationElement| (e.share, e.time_constant_s);
        CreepStep::relaxing(self.elements.iter().map(lag), step_s)
    }
}

#[cfg(test)]
mod tests {
    use crate::{ActuatorModel, LinkageStage, Relaxation, RelaxationElement, VoltageRange};
    use approx::assert_abs_diff_eq;

    fn model(elements: &[(f64, f64)]) -> ActuatorModel {
        let mut model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
        let element = |&(share, time_constant_s)| RelaxationElement { share, time_constant_s };
        let elements = elements.iter().map(element).collect();
        model.linkage.push(LinkageStage::Relaxation(Relaxation { elements }));
        model
    }

    #[test]
    fn a_step_follows_the_sum_of_exponentials_whatever_the_sampling() {
        for step_s in [1e-3, 7e-3] {
            // at rest at 65 V, then up by 40 V over one sample, as straight as the hold takes it
            let mut volts = vec![65.0];
            volts.resize(60, 105.0);
            let parts = [(0.7, 0.02), (0.2, 0.005)];
            let got = model(&parts).simulate(&volts, step_s).unwrap().output_deg;
            let height = 40.0 * 20.0 / 170.0;
            for (i, y) in got.iter().enumerate().skip(1) {
                let t = (i - 1) as f64 * step_s;
                let left: f64 = parts
                    .iter()
                    .map(|(f, tau)| {
                        // a ramp of one step length, then decay
                        f * tau / step_s * (1.0 - (-step_s / tau).exp()) * (-t / tau).exp()
                    })
                    .sum();
                assert_abs_diff_eq!(*y, height * (1.0 - left), epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn without_shares_it_is_the_identity_and_too_large_shares_are_refused() {
        let volts: Vec<f64> = (0..50).map(|i| 65.0 + 40.0 * f64::from(i).sin()).collect();
        let plain = model(&[]).simulate(&volts, 1e-3).unwrap();
        let zero = model(&[(0.0, 0.1)]).simulate(&volts, 1e-3).unwrap();
        assert_eq!(plain.output_deg, zero.output_deg);
        assert!(model(&[(0.7, 0.1), (0.4, 0.2)]).simulate(&volts, 1e-3).is_err());
        assert!(model(&[(0.7, 0.0)]).simulate(&volts, 1e-3).is_err());
    }
}
