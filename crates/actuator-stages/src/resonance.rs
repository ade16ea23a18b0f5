//! One mechanical mode.

use crate::StageError;
use crate::Step;
use crate::check::{check_positive, check_within};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The first mode of actuator, linkage and flap.
///
/// ```text
/// y'' + 2 zeta w y' + w^2 y = w^2 x,   w = 2 pi frequency
/// ```
/// Exact for an input straight between samples, under-damped, critical or over-damped. The identity
/// is the limit of a high frequency: the deviation is `2 zeta x' / w`.
/// Source: elementary; 60 to 400 Hz, damping ratio 0.005 to 0.05 for amplified stacks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Resonance {
    /// Undamped natural frequency, Hz, `> 0`.
    pub frequency_hz: f64,
    /// Damping ratio, `> 0`, up to 100.
    pub damping_ratio: f64,
}

impl Resonance {
    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_positive("frequency_hz", self.frequency_hz)?;
        check_positive("damping_ratio", self.damping_ratio)?;
        check_within("damping_ratio", self.damping_ratio, 0.0..=100.0)
    }

    /// The free motion over a step: place and rate (1/s) from `[place, rate]` before, one row each.
    ///
    /// ```text
    /// [y, y'](h) = exp(A h) [y, y'](0),   A = [0 1; -w^2 -2 zeta w]
    /// ```
    /// `step_s` is above 0.
    pub fn free_motion(&self, step_s: f64) -> [[f64; 2]; 2] {
        let omega = TAU * self.frequency_hz;
        let zeta = self.damping_ratio;
        let sigma = zeta * omega;
        let split = 1.0 - zeta * zeta;
        // c and s: exp(-sigma h) times cosine and sine (over its frequency) of the damped motion
        let (c, s) = if split > 0.0 {
            let damped = omega * split.sqrt();
            let decay = (-sigma * step_s).exp();
            let (sine, cosine) = (damped * step_s).sin_cos();
            (decay * cosine, decay * sine / damped)
        } else if split == 0.0 {
            let decay = (-sigma * step_s).exp();
            (decay, decay * step_s)
        } else {
            let apart = omega * (-split).sqrt();
            // the slow root as a product: sigma - apart would cancel
            let slow = (-omega * omega / (sigma + apart) * step_s).exp();
            let ratio_less_one = (-2.0 * apart * step_s).exp_m1();
            (0.5 * slow * (2.0 + ratio_less_one), -0.5 * slow * ratio_less_one / apart)
        };
        [[c + sigma * s, s], [-omega * omega * s, c - sigma * s]]
    }

    /// How much later than its input a ramp is followed, s.
    pub fn lead_s(&self) -> f64 {
        2.0 * self.damping_ratio / (TAU * self.frequency_hz)
    }

    /// The mode made ready for samples `step_s` apart, `> 0`.
    pub fn prepared(&self, step_s: f64) -> ResonanceStep {
        let [[place, s], [pull, rate]] = self.free_motion(step_s);
        let (from_place, from_rate) = ([place, pull], [s, rate]);
        ResonanceStep { lead_s: self.lead_s(), step_s, from_place, from_rate }
    }
}

/// A [`Resonance`] made ready: the matrix exponential of its free motion over a step, by columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResonanceStep {
    /// A ramp of the input is followed this much later, s.
    lead_s: f64,
    step_s: f64,
    from_place: [f64; 2],
    from_rate: [f64; 2],
}

/// Motion of a [`Resonance`] at the last sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ResonanceMemory {
    input: f64,
    /// Output less input.
    deviation: f64,
    /// Rate of the output, 1/s.
    rate: f64,
}

impl Step for ResonanceStep {
    type Memory = ResonanceMemory;

    fn start(&self, input: f64) -> (ResonanceMemory, f64) {
        (ResonanceMemory { input, deviation: 0.0, rate: 0.0 }, input)
    }

    #[inline]
    fn advance(&self, memory: &mut ResonanceMemory, input: f64) -> f64 {
        let slope = (input - memory.input) / self.step_s;
        // the motion about that which follows the ramp
        let behind = self.lead_s * slope;
        let (place, rate) = (memory.deviation + behind, memory.rate - slope);
        memory.deviation = self.from_place[0] * place + self.from_rate[0] * rate - behind;
        memory.rate = self.from_place[1] * place + self.from_rate[1] * rate + slope;
        memory.input = input;
        input + memory.deviation
    }
}
