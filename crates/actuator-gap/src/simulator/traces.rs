//! The measured signals as the engine weighs them: noise, structure, and what the base model may still
//! move by.

use super::bench::{BenchSimulator, ChannelKind, averaged};
use crate::base::{ErrorModel, white_noise};
use crate::record::Record;
use model_gap::discovery::Trace;
use nalgebra::DMatrix;
use rotor_base::variance;

/// Directions in which the base model may move.
const MOST_DIRECTIONS: usize = 32;
/// Part of the range that a voltage monitor is trusted to.
const MONITOR_ERROR: f64 = 1e-2;
/// Temperature that a thermometer is trusted to, K.
const THERMOMETER_ERROR_K: f64 = 1.0;
/// Standard deviation of the zero of a run, over the spread of the output.
const ZERO_ERROR: f64 = 2e-3;

impl BenchSimulator<'_> {
    /// The traces with their noise and the covariance of the base model.
    pub(crate) fn traces(&self) -> Vec<Trace> {
        self.traces_of(&self.channels)
    }

    /// The traces of some channels: run and kind of each.
    pub(crate) fn traces_of(&self, channels: &[(usize, ChannelKind)]) -> Vec<Trace> {
        let errors: Vec<_> = self.runs.iter().map(|r| self.base.errors(r)).collect();
        let sigmas: Vec<f64> = errors.iter().map(ErrorModel::effective).collect();
        let moving = if channels.iter().any(|channel| channel.1 == ChannelKind::Output) {
            self.base.nuisance(&self.runs, &sigmas, MOST_DIRECTIONS)
        } else {
            // the base model moves the output alone
            Vec::new()
        };
        let directions = moving.first().map_or(0, DMatrix::ncols);
        let width = directions + self.runs.len();
        channels
            .iter()
            .map(|&(number, kind)| {
                let run = self.runs[number];
                let measured = averaged(self.measured(number, kind), self.block);
                let block = self.block as f64;
                let columns = if kind == ChannelKind::Output { width } else { 0 };
                let mut nuisance = DMatrix::zeros(measured.len(), columns);
                let (noise, sigma) = match kind {
                    ChannelKind::Output => {
                        let own = &moving[number];
                        for k in 0..directions {
                            let column: Vec<f64> = own.column(k).iter().copied().collect();
                            for (i, v) in
                                averaged(run.judged(&column), self.block).iter().enumerate()
                            {
                                nuisance[(i, k)] = *v;
                            }
                        }
                        nuisance
                            .column_mut(directions + number)
                            .fill(ZERO_ERROR * self.base.spread);
                        let e = errors[number];
                        let white = e.noise.powi(2) / block;
                        let left = (e.correlation / block).max(1.0) * e.structure.powi(2);
                        (white.sqrt(), (white + left).sqrt())
                    }
                    ChannelKind::Comparison => {
                        let white = white_noise(self.measured(number, kind)) / block.sqrt();
                        (white, white)
                    }
                    ChannelKind::Amplifier => {
                        let off: Vec<f64> = self
                            .measured(number, kind)
                            .iter()
                            .zip(run.judged_input())
                            .map(|(a, b)| a - b)
                            .collect();
                        let least = MONITOR_ERROR * (self.range.1 - self.range.0);
                        (white_noise(&off), white_noise(&off).max(least))
                    }
                    ChannelKind::Temperature => {
                        let white = white_noise(self.measured(number, kind));
                        (white, white.max(THERMOMETER_ERROR_K))
                    }
                    ChannelKind::Load => {
                        let own = self.measured(number, kind);
                        let white = white_noise(own);
                        (white, (3.0 * white).max(0.3 * variance(own).sqrt()))
                    }
                };
                Trace {
                    experiment: number,
                    block: block_of(run, measured.len()),
                    measured,
                    sigma: sigma.max(1e-12),
                    noise,
                    nuisance,
                    role: kind.role(),
                }
            })
            .collect()
    }
}

/// Block of the bootstrap: a period where the input has one, else a tenth of the run.
fn block_of(run: &Record, samples: usize) -> usize {
    let tenth = (samples / 10).max(1);
    match model_gap::Stimulus::of(run.judged_input(), run.step_s) {
        model_gap::Stimulus::Sine { frequency_hz, .. } => {
            let period = run.judged_input().len() as f64 * run.step_s * frequency_hz;
            let cycles = period.max(1.0);
            let per_cycle = samples as f64 / cycles;
            whole(per_cycle).clamp(1, samples.max(1))
        }
        model_gap::Stimulus::Other => tenth,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive count of samples"
)]
fn whole(value: f64) -> usize {
    value.ceil().max(0.0) as usize
}
