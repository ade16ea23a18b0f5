//! The first-order lag.

use crate::StageError;
use crate::check::check_not_negative;
use crate::creep::CreepStep;
use serde::{Deserialize, Serialize};

/// A first-order lag: an amplifier's output resistance into a capacitance, or a sensor's filter.
///
/// ```text
/// tau dy/dt + y = u
/// ```
/// Exact for an input straight between samples. `tau_s = 0` is the identity.
/// Source: elementary; `tau = R C`, 0.1 to 5 ms for piezo stacks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lag {
    /// Time constant, s, `>= 0`.
    pub tau_s: f64,
}

impl Lag {
    pub(crate) fn check(self) -> Result<(), StageError> {
        check_not_negative("tau_s", self.tau_s)
    }

    pub(crate) fn prepared(self, step_s: f64) -> CreepStep {
        CreepStep::relaxing([(1.0, self.tau_s)], step_s)
    }
}
