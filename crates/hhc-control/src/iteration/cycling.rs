//! Steps that reverse or cycle: limits that move with the control can send a loop to and fro.

use crate::layout::{difference, largest_amplitude};
use crate::{AllowedIncrease, ControlStep};

/// Part of the last step that a step goes back by, and square of the cosine between the two, from which it
/// reverses.
const REVERSAL: f64 = 0.8;
/// Distance to an earlier state, over the step, within which the step closes a cycle.
const CLOSED: f64 = 0.25;
/// Steps of the longest cycle that is detected.
const LONGEST_CYCLE: usize = 4;

/// The part of a step within limits that is taken: halved wherever a step would close a cycle.
pub(super) struct CycleDamping {
    share: f64,
}

impl Default for CycleDamping {
    fn default() -> Self {
        Self { share: 1.0 }
    }
}

impl CycleDamping {
    /// Shortens a step that follows others.
    pub(super) fn shorten(&mut self, step: &mut [f64], steps: &[ControlStep]) {
        if reverses(step, steps) {
            // out of limits that move with the control and back again: the optimum lies between
            scale(step, 0.5);
        }
        if closes_a_cycle(step, steps) {
            self.share *= 0.5;
        }
        scale(step, self.share);
    }
}

fn scale(step: &mut [f64], factor: f64) {
    for d in step {
        *d *= factor;
    }
}

/// Whether a step leads back along the last one, and about as far.
fn reverses(step: &[f64], steps: &[ControlStep]) -> bool {
    let [.., before, here] = steps else { return false };
    let last = difference(&here.control_volt, &before.control_volt);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (square, along) = (dot(&last, &last), dot(step, &last));
    along < -REVERSAL * square && along * along > REVERSAL * square * dot(step, step)
}

/// Whether a step leads to where the loop stood a few steps ago, with limits that moved since.
fn closes_a_cycle(step: &[f64], steps: &[ControlStep]) -> bool {
    let [earlier @ .., _before, here] = steps else { return false };
    let next: Vec<f64> = here.control_volt.iter().zip(step).map(|(u, d)| u + d).collect();
    let near = CLOSED * largest_amplitude(step);
    let since = earlier.len().saturating_sub(LONGEST_CYCLE - 1);
    let is_restoration = |s: &ControlStep| s.allowed_increase == AllowedIncrease::Restoration;
    let is_near = |s: &ControlStep| largest_amplitude(&difference(&next, &s.control_volt)) < near;
    steps[since..].iter().any(is_restoration) && earlier[since..].iter().any(is_near)
}
