//! The transport delay.

use crate::StageError;
use crate::Step;
use crate::check::check_within;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A transport delay.
///
/// ```text
/// y(t) = u(t - delay)
/// ```
/// Exact for an input straight between samples, whatever the step. Before the first sample the
/// input is taken as constant. `delay_s = 0` is the identity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Delay {
    /// Delay, s, 0 to 1; 0.1 to 3 ms is usual.
    pub delay_s: f64,
}

impl Delay {
    pub(crate) fn check(self) -> Result<(), StageError> {
        check_within("delay_s", self.delay_s, 0.0..=1.0)
    }
}

/// A [`Delay`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelayStep {
    pub(crate) delay_s: f64,
    pub(crate) step_s: f64,
}

/// The samples still under way: how long each came after the one before, and its value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DelayMemory {
    samples: VecDeque<(f64, f64)>,
    /// From the oldest sample to the newest, s.
    span_s: f64,
}

impl Step for DelayStep {
    type Memory = DelayMemory;

    fn start(&self, input: f64) -> (DelayMemory, f64) {
        (DelayMemory { samples: VecDeque::from([(0.0, input)]), span_s: 0.0 }, input)
    }

    fn advance(&self, memory: &mut DelayMemory, input: f64) -> f64 {
        memory.samples.push_back((self.step_s, input));
        memory.span_s += self.step_s;
        loop {
            let [Some(&(_, from)), Some(&(length_s, to))] =
                [memory.samples.front(), memory.samples.get(1)]
            else {
                return input;
            };
            let after_s = memory.span_s - self.delay_s;
            if after_s <= 0.0 {
                return from;
            }
            if after_s < length_s {
                return from + (to - from) * (after_s / length_s);
            }
            memory.span_s -= length_s;
            memory.samples.pop_front();
        }
    }
}
