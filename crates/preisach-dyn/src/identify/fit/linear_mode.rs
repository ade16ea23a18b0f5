//! The linear mode nearest to records, and whether they show it.

use crate::identify::fit::output_error::OutputError;
use crate::identify::fit::static_fit;
use crate::identify::fit::training::Training;
use crate::identify::records::prepared::Prepared;
use crate::{
    ActuatorLaw, AmplifierStage, Lag, LinearGain, PreisachError, Resonance, StaticPreisach,
};
use actuator_stages::{StageStep, Step};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The linear mode nearest to some records: a gain and one mode behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinearMode {
    pub(crate) mode: Resonance,
    pub(crate) line: LinearGain,
    /// Whether records show it: neither a gain nor a first-order lag comes near what a mode explains, with and without
    /// the static hysteresis before it.
    pub(crate) is_shown: bool,
}

/// What a mode leaves, over what a lag leaves, where records show a mode.
const SHOWN: f64 = 0.7;
/// Damping ratio up to which a mode is one; above it, it is lags in a row.
pub(crate) const MOST_DAMPING: f64 = 0.7;
/// Ratio of neighbouring frequencies tried, and the damping ratios tried at each.
const RATIO: f64 = 1.12;
const DAMPING: [f64; 2] = [0.1, 0.5];
/// Ratio of neighbouring time constants tried.
const LAG_RATIO: f64 = 1.5;
/// Halvings of the steps that refine the best one.
const HALVINGS: usize = 6;
/// Highest frequency tried, over the sampling frequency.
const HIGHEST: f64 = 0.4;
/// Samples looked at of a record.
const MOST_SAMPLES: usize = 20_000;

/// Signals over the records that stages behind them are to bring to the outputs.
struct Front<'a> {
    records: &'a [&'a Prepared<'a>],
    signals: Vec<Vec<f64>>,
}

impl Front<'_> {
    /// Root mean square NRMSE of the line through a stage behind the signals, with its slope and its constant.
    fn line_behind(&self, stage: impl Fn(f64) -> Option<StageStep>) -> [f64; 3] {
        let [mut w, mut x, mut y, mut xx, mut xy, mut yy] = [0.0; 6];
        for (prepared, signal) in self.records.iter().zip(&self.signals) {
            let mut signal = signal.clone();
            if let Some(step) = stage(prepared.record.time_step_s) {
                step.pass(&mut signal);
            }
            let kept = OutputError::kept(prepared).filter(|i| *i < signal.len());
            let count = kept.clone().count().max(1) as f64;
            let weight = 1.0 / (prepared.spread_deg.powi(2) * count * self.records.len() as f64);
            for i in kept {
                let (input, output) = (signal[i], prepared.record.output_deg[i]);
                w += weight;
                x += weight * input;
                y += weight * output;
                xx += weight * input * input;
                xy += weight * input * output;
                yy += weight * output * output;
            }
        }
        let slope = (w * xy - x * y) / (w * xx - x * x);
        let constant = (y - slope * x) / w;
        let left = yy - slope * xy - constant * y;
        [left.max(0.0).sqrt(), slope, constant]
    }

    fn behind_mode(&self, mode: Resonance) -> f64 {
        let stage = |step_s: f64| Some(StageStep::Resonance(mode.prepared(step_s)));
        // a mode turns no motion round
        let [left, slope, _] = self.line_behind(stage);
        if slope > 0.0 { left } else { f64::INFINITY }
    }

    /// The best of a gain and of first-order lags.
    fn without_mode(&self, frequencies_hz: &[f64; 2]) -> f64 {
        let lag = |hz: f64| AmplifierStage::Lag(Lag { tau_s: 1.0 / (TAU * hz) });
        let lags: Vec<f64> = spaced(frequencies_hz, LAG_RATIO);
        let left =
            lags.into_par_iter().map(|hz| self.line_behind(|h| Some(lag(hz).prepared(h)))[0]);
        let left: Vec<f64> = left.collect();
        left.into_iter().fold(self.line_behind(|_| None)[0], f64::min)
    }

    /// The best mode, and what it leaves.
    fn best_mode(&self, frequencies_hz: &[f64; 2]) -> (Resonance, f64) {
        let grid = spaced(frequencies_hz, RATIO);
        let grid: Vec<Resonance> = grid
            .into_iter()
            .flat_map(|frequency_hz| {
                DAMPING.map(|damping_ratio| Resonance { frequency_hz, damping_ratio })
            })
            .collect();
        let (mut best, mut left) = self.least(&grid);
        let mut steps = [0.5 * RATIO.ln(), 0.8];
        for _ in 0..HALVINGS {
            // the four neighbours, as long as one is better
            loop {
                let beside = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
                let beside = beside.map(|[f, z]| Resonance {
                    frequency_hz: best.frequency_hz * (f * steps[0]).exp(),
                    damping_ratio: (best.damping_ratio * (z * steps[1]).exp()).clamp(1e-3, 2.0),
                });
                let (next, its) = self.least(&beside);
                if its >= left {
                    break;
                }
                (best, left) = (next, its);
            }
            steps = steps.map(|step| 0.5 * step);
        }
        (best, left)
    }

    /// The first best of some modes.
    fn least(&self, modes: &[Resonance]) -> (Resonance, f64) {
        let found: Vec<f64> = modes.par_iter().map(|mode| self.behind_mode(*mode)).collect();
        let (place, left) = found
            .into_iter()
            .enumerate()
            .fold((0, f64::INFINITY), |best, now| if now.1 < best.1 { now } else { best });
        (modes[place], left)
    }
}

/// Frequencies from one to another, at a ratio.
fn spaced([low, high]: &[f64; 2], ratio: f64) -> Vec<f64> {
    let next = |hz: &f64| Some(hz * ratio).filter(|hz| hz <= high);
    std::iter::successors(Some(*low), next).collect()
}

impl LinearMode {
    /// The linear mode nearest to the training records.
    pub(crate) fn of(training: &Training) -> Result<Self, PreisachError> {
        let all = training.all();
        let slowest = all.iter().map(|r| r.drive.base_hz).fold(f64::INFINITY, f64::min);
        let finest = all.iter().map(|r| r.record.time_step_s).fold(f64::INFINITY, f64::min);
        let highest_hz = HIGHEST / finest;
        let frequencies_hz = [slowest.clamp(1e-3 * highest_hz, 0.5 * highest_hz), highest_hz];
        let law = StaticPreisach::new(training.grid, static_fit::as_measured(training)?)?;
        let law = ActuatorLaw::StaticPreisach(law);
        let voltages = |r: &&Prepared| {
            let trained = r.record.trained_samples();
            r.record.voltage_volt[..trained.end.min(trained.start + MOST_SAMPLES)].to_vec()
        };
        let voltages: Vec<Vec<f64>> = all.iter().map(voltages).collect();
        let hysteretic = all.iter().zip(&voltages);
        let hysteretic = hysteretic.map(|(r, volts)| law.outputs(volts, r.record.time_step_s));
        let hysteretic = Front { records: &all, signals: hysteretic.collect() };
        let plain = Front { records: &all, signals: voltages };
        let (mode, left) = plain.best_mode(&frequencies_hz);
        let [_, gain_deg_per_volt, constant] =
            plain.line_behind(|step_s| Some(StageStep::Resonance(mode.prepared(step_s))));
        let line = LinearGain { gain_deg_per_volt, bias_volt: -constant / gain_deg_per_volt };
        let shown_by = |front: &Front, mode: Resonance, left: f64| {
            mode.damping_ratio < MOST_DAMPING && left <= SHOWN * front.without_mode(&frequencies_hz)
        };
        let is_shown = shown_by(&plain, mode, left) || {
            let (mode, left) = hysteretic.best_mode(&frequencies_hz);
            shown_by(&hysteretic, mode, left)
        };
        Ok(Self { mode, line, is_shown })
    }

    /// Where a search for a mode starts: logarithms of its frequency, Hz, and damping ratio.
    pub(crate) fn parameters(&self) -> [f64; 2] {
        [self.mode.frequency_hz.ln(), self.mode.damping_ratio.min(0.9 * MOST_DAMPING).ln()]
    }
}
