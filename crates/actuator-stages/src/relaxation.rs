//! A distribution of relaxation times.

use crate::StageError;
use crate::check::{check_not_negative, check_positive, check_that};
use crate::creep::CreepStep;
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
    pub(crate) fn check(&self) -> Result<(), StageError> {
        let mut value = 0.0;
        for element in &self.elements {
            check_not_negative("share", element.share)?;
            check_positive("time_constant_s", element.time_constant_s)?;
            value += element.share;
        }
        check_that(value <= 1.0 + 1e-12, "sum of the relaxation shares", value, "0 to 1")
    }

    pub(crate) fn prepared(&self, step_s: f64) -> CreepStep {
        let lag = |e: &RelaxationElement| (e.share, e.time_constant_s);
        CreepStep::relaxing(self.elements.iter().map(lag), step_s)
    }
}
