//! The test of stagnation.

use crate::{ControlStep, LoopEnd};

/// Steps in a row without progress after which a run has stagnated.
const STAGNATION_STEPS: usize = 5;
/// Length of the last of them over the first below which the steps contract and the run will converge.
const CONTRACTING: f64 = 0.5;

/// Watches for steps that bring no decrease of the cost, predict none, and do not become shorter.
#[derive(Default)]
pub(super) struct Stagnation {
    /// Length of the next step at the last states in a row without progress, V.
    asked_volt: Vec<f64>,
    /// Steps taken at the last test.
    tested_after: Option<usize>,
}

impl Stagnation {
    /// Tests a state, each one once. `end` is the next step there, `decrease` the least one of the cost that counts as
    /// progress.
    pub(super) fn detect(&mut self, steps: &[ControlStep], end: &LoopEnd, decrease: f64) -> bool {
        if self.tested_after.replace(steps.len()) == Some(steps.len()) {
            return false;
        }
        let brought = match steps {
            [.., before, here] => before.cost.total() - here.cost.total(),
            _ => f64::INFINITY,
        };
        if brought > decrease || end.promise > decrease {
            self.asked_volt.clear();
            return false;
        }
        self.asked_volt.push(end.asked_volt);
        let count = self.asked_volt.len();
        count >= STAGNATION_STEPS
            && self.asked_volt[count - 1] > CONTRACTING * self.asked_volt[count - STAGNATION_STEPS]
    }
}
