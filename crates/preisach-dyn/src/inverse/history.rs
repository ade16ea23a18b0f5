//! The voltage for a wanted history of the flap: sample by sample, then by learning.

use crate::check::{check_count, check_finite, check_positive};
use crate::{ActuatorModel, AmplifierStage, LinkageStage, PreisachError, StartState};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Settings of the inverse of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HistoryInverseSettings {
    /// Rms error at which it ends, as a fraction of half of the peak to peak of the wanted motion.
    pub tolerance: f64,
    /// Simulations to try.
    pub largest_iterations: usize,
}

impl Default for HistoryInverseSettings {
    /// 1e-5 of the amplitude, within 400 simulations.
    fn default() -> Self {
        Self { tolerance: 1e-5, largest_iterations: 400 }
    }
}

/// A voltage history and what the flap does under it.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryInverse {
    /// Voltage at every sample, V, within the range of the actuator.
    pub voltage_volt: Vec<f64>,
    /// Flap angle at every sample, deg.
    pub output_deg: Vec<f64>,
    /// Largest error left, deg.
    pub largest_error_deg: f64,
    /// Rms error left, deg.
    pub rms_error_deg: f64,
    /// Half of the peak to peak of the wanted motion, deg.
    pub amplitude_deg: f64,
    /// Samples whose voltage is an end of the range.
    pub at_limit: usize,
    /// Simulations made.
    pub iterations: usize,
    /// Whether the tolerance was met.
    pub is_met: bool,
}

/// Errors must fall by this part for the iteration to be worth going on, over [`PATIENCE`] of them.
const WORTH: f64 = 1e-3;
/// Iterations without a worthy fall before the end.
const PATIENCE: usize = 12;
/// Smallest step of learning, over that of the linear gain.
const SMALLEST: f64 = 1e-3;

impl ActuatorModel {
    /// The voltage under which the flap follows a wanted history, from rest at its first sample, and the error that is left.
    ///
    /// It starts from the better of two voltages: what the linear gain asks for, and what brings the flap to the wanted angle
    /// sample by sample with the memory at hand (of laws with rate too, but not behind a delay or a mode). Then it learns:
    ///
    /// ```text
    /// u_(k+1) = clamp(u_k + s L^-1 (wanted - flap[u_k]) / gain)
    /// ```
    /// `gain` is the rise of the flap over the whole voltage range, `L` what lags, delays and modes of the stages do to it. The
    /// step `s` is 1; it is halved where the error grows. What cannot be had (a motion beyond the range, a corner behind a lag) stays as error: it is reported, no failure.
    ///
    /// | argument | meaning | unit |
    /// |---|---|---|
    /// | `wanted_deg` | flap angle at every sample, two or more | deg |
    /// | `time_step_s` | time between two samples, above 0 | s |
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] for fewer than two samples, a time step or settings not above 0, an actuator that does not
    /// move; [`PreisachError::NotFinite`]; the errors of [`ActuatorModel::simulate`].
    pub fn history_inverse(
        &self,
        wanted_deg: &[f64],
        time_step_s: f64,
        settings: &HistoryInverseSettings,
    ) -> Result<HistoryInverse, PreisachError> {
        check_count("wanted samples", wanted_deg.len(), 2)?;
        check_finite("wanted output (deg)", wanted_deg.iter().copied())?;
        check_positive("tolerance", settings.tolerance)?;
        check_count("largest_iterations", settings.largest_iterations, 1)?;
        let (low, high) = (self.range_volt.lowest_volt(), self.range_volt.highest_volt());
        let [low_deg, high_deg] = self.ends_deg(time_step_s)?;
        let gain = (high_deg - low_deg) / (high - low);
        check_positive("rise of the flap over the voltage range (deg)", gain)?;
        let (smallest, largest) = wanted_deg
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), w| (a.min(*w), b.max(*w)));
        let amplitude_deg = 0.5 * (largest - smallest);
        let within = |volt: f64| volt.clamp(low, high);
        let first: Vec<f64> =
            wanted_deg.iter().map(|w| within(low + (w - low_deg) / gain)).collect();
        let tried = |voltage_volt: Vec<f64>| -> Result<Tried, PreisachError> {
            let output_deg = self.simulate(&voltage_volt, time_step_s)?.output_deg;
            let error: Vec<f64> = wanted_deg.iter().zip(&output_deg).map(|(w, y)| w - y).collect();
            let rms_deg = rotor_base::mean_square(&error).sqrt();
            Ok(Tried { voltage_volt, output_deg, error, rms_deg })
        };
        let goal_deg = settings.tolerance * amplitude_deg;
        let mut best = tried(first)?;
        let mut iterations = 1;
        if best.rms_deg > goal_deg && settings.largest_iterations > 1 {
            let by_sample = tried(self.sample_by_sample(wanted_deg, time_step_s)?)?;
            iterations += 1;
            if by_sample.rms_deg < best.rms_deg {
                best = by_sample;
            }
        }
        let (mut step, mut idle, mut mark) = (1.0, 0, best.rms_deg);
        while best.rms_deg > goal_deg && iterations < settings.largest_iterations {
            let asked = self.ahead_of_stages(&best.error, time_step_s);
            let next = best.voltage_volt.iter().zip(&asked);
            let next = tried(next.map(|(u, e)| within(u + step * e / gain)).collect())?;
            iterations += 1;
            if next.rms_deg < best.rms_deg {
                best = next;
            } else {
                step *= 0.5;
            }
            idle += 1;
            if best.rms_deg < (1.0 - WORTH) * mark {
                (idle, mark) = (0, best.rms_deg);
            }
            if idle >= PATIENCE || step < SMALLEST {
                break;
            }
        }
        let Tried { voltage_volt, output_deg, error, rms_deg } = best;
        Ok(HistoryInverse {
            largest_error_deg: error.iter().fold(0.0, |most: f64, own| most.max(own.abs())),
            rms_error_deg: rms_deg,
            amplitude_deg,
            at_limit: voltage_volt.iter().filter(|u| **u <= low || **u >= high).count(),
            iterations,
            is_met: rms_deg <= goal_deg,
            voltage_volt,
            output_deg,
        })
    }

    /// The voltage at every sample that brings the flap to the wanted angle, or as near as the range allows.
    fn sample_by_sample(
        &self,
        wanted_deg: &[f64],
        time_step_s: f64,
    ) -> Result<Vec<f64>, PreisachError> {
        let chain = self.chain(time_step_s)?;
        let range = [self.range_volt.lowest_volt(), self.range_volt.highest_volt()];
        let at_rest = |volt: f64| chain.start(self, volt, 0.0, StartState::Rest);
        let mut voltages = vec![crossing(range, |volt| at_rest(volt).output_deg() - wanted_deg[0])];
        let mut memory = at_rest(voltages[0]);
        for wanted in &wanted_deg[1..] {
            let volt = crossing(range, |volt| {
                chain.advance(self, &mut memory.clone(), volt, 0.0) - wanted
            });
            chain.advance(self, &mut memory, volt, 0.0);
            voltages.push(volt);
        }
        Ok(voltages)
    }

    /// What the lags, delays and modes of the stages would make a signal of, by central differences.
    fn ahead_of_stages(&self, signal: &[f64], time_step_s: f64) -> Vec<f64> {
        let mut own = signal.to_vec();
        for stage in &self.linkage {
            if let LinkageStage::Resonance(mode) = stage {
                let omega = TAU * mode.frequency_hz;
                own = with_rates(&own, [mode.lead_s(), omega.powi(-2)], time_step_s);
            }
        }
        for stage in &self.amplifier {
            match stage {
                AmplifierStage::Lag(lag) => own = with_rates(&own, [lag.tau_s, 0.0], time_step_s),
                AmplifierStage::Delay(delay) => own = earlier(&own, delay.delay_s / time_step_s),
                _ => {}
            }
        }
        own
    }

    /// Flap angles at the ends of the voltage range, after a slow way up.
    fn ends_deg(&self, time_step_s: f64) -> Result<[f64; 2], PreisachError> {
        let (low, high) = (self.range_volt.lowest_volt(), self.range_volt.highest_volt());
        let up = (0..=WAY).map(|k| low + (high - low) * k as f64 / WAY as f64);
        let output = self.simulate(&up.collect::<Vec<f64>>(), time_step_s.max(SLOW_STEP_S))?;
        Ok([output.output_deg[0], output.output_deg[WAY]])
    }
}

/// Samples of the way from one end of the range to the other, and their least distance, s.
const WAY: usize = 200;
const SLOW_STEP_S: f64 = 0.01;

/// A signal with parts of its first and second derivative, `x + a dx/dt + b d2x/dt2`; it is held at both ends.
fn with_rates(signal: &[f64], [a, b]: [f64; 2], time_step_s: f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let of = |k: usize| {
        let (before, now, after) =
            (signal[k.saturating_sub(1)], signal[k], signal[(k + 1).min(last)]);
        let rate = (after - before) / (2.0 * time_step_s);
        now + a * rate + b * (after - 2.0 * now + before) / time_step_s.powi(2)
    };
    (0..=last).map(of).collect()
}

/// A signal earlier by a number of samples, straight between them; it is held at the end.
fn earlier(signal: &[f64], samples: f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let whole = (1..=last).take_while(|k| *k as f64 <= samples).count();
    let part = samples.fract();
    let at = |k: usize| signal[k.min(last)];
    (0..=last).map(|k| at(k + whole) + part * (at(k + whole + 1) - at(k + whole))).collect()
}

/// Where a function that rises crosses zero, by false position, the weight of an end that stays halved (Illinois); the nearer end where it does
/// not.
fn crossing([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_low >= 0.0 {
        return low;
    }
    if at_high <= 0.0 {
        return high;
    }
    let least = 1e-13 * (at_high - at_low);
    let mut was_low = None;
    for _ in 0..CROSSINGS {
        let middle = low + (high - low) * at_low / (at_low - at_high);
        let value = function(middle);
        if value.abs() <= least || !value.is_finite() {
            return middle;
        }
        let is_low = value < 0.0;
        if is_low {
            (low, at_low) = (middle, value);
            at_high *= if was_low == Some(true) { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (middle, value);
            at_low *= if was_low == Some(false) { 0.5 } else { 1.0 };
        }
        was_low = Some(is_low);
    }
    f64::midpoint(low, high)
}

/// Steps towards a crossing.
const CROSSINGS: usize = 60;

/// A voltage with what the flap does.
struct Tried {
    voltage_volt: Vec<f64>,
    output_deg: Vec<f64>,
    /// Wanted less simulated, deg.
    error: Vec<f64>,
    rms_deg: f64,
}
