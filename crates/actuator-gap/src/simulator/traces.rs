//! The measured signals as the engine weighs them: noise, structure, and what the base model may still
//! move by.

use super::bench::{BenchSimulator, Channel, ChannelKind, averaged};
use crate::base::{ErrorModel, white_noise};
use crate::numbers::less;
use crate::record::Record;
use model_gap::Sine;
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
        let errors: Vec<_> = self.runs.iter().map(|r| self.base.errors(r)).collect();
        let sigmas: Vec<f64> = errors.iter().map(ErrorModel::effective).collect();
        let moving = if self.channels.iter().any(|channel| channel.kind == ChannelKind::Output) {
            self.base.nuisance(&self.runs, &sigmas, MOST_DIRECTIONS)
        } else {
            // the base model moves the output alone
            Vec::new()
        };
        let block = self.block as f64;
        let one = |channel: &Channel| {
            let (run, own) = (self.runs[channel.run], &channel.measured);
            let white = white_noise(own);
            let (noise, sigma) = match channel.kind {
                ChannelKind::Output => {
                    let e = errors[channel.run];
                    let white = e.noise.powi(2) / block;
                    let left = (e.correlation / block).max(1.0) * e.structure.powi(2);
                    (white.sqrt(), (white + left).sqrt())
                }
                ChannelKind::Comparison => (white / block.sqrt(), white / block.sqrt()),
                ChannelKind::Amplifier => {
                    let white = white_noise(&less(own, run.judged_input()));
                    (white, white.max(MONITOR_ERROR * (self.range.1 - self.range.0)))
                }
                ChannelKind::Temperature => (white, white.max(THERMOMETER_ERROR_K)),
                ChannelKind::Load => (white, (3.0 * white).max(0.3 * variance(own).sqrt())),
            };
            let measured = averaged(own, self.block);
            Trace {
                experiment: channel.run,
                block: block_of(run, measured.len()),
                nuisance: match channel.kind {
                    ChannelKind::Output => self.nuisance(&moving[channel.run], channel.run),
                    _ => DMatrix::zeros(measured.len(), 0),
                },
                measured,
                sigma: sigma.max(1e-12),
                noise,
                role: channel.kind.role(),
            }
        };
        self.channels.iter().map(one).collect()
    }

    /// What the output of a run may move by: the directions of the base model, and the zeros of the runs.
    fn nuisance(&self, directions: &DMatrix<f64>, number: usize) -> DMatrix<f64> {
        let column = |k: usize| {
            let own = directions.column(k);
            averaged(self.runs[number].judged(own.as_slice()), self.block)
        };
        let columns: Vec<Vec<f64>> = (0..directions.ncols()).map(column).collect();
        let samples = averaged(self.runs[number].judged_output(), self.block).len();
        DMatrix::from_fn(samples, columns.len() + self.runs.len(), |i, k| match columns.get(k) {
            Some(column) => column[i],
            None if k == columns.len() + number => ZERO_ERROR * self.base.spread,
            None => 0.0,
        })
    }
}

/// Block of the bootstrap: a period where the input has one, else a tenth of the run.
fn block_of(run: &Record, samples: usize) -> usize {
    let Some(sine) = Sine::of(run.judged_input(), run.step_s) else {
        return (samples / 10).max(1);
    };
    let cycles = (run.judged_input().len() as f64 * run.step_s * sine.frequency_hz).max(1.0);
    whole(samples as f64 / cycles).clamp(1, samples.max(1))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive count of samples"
)]
fn whole(value: f64) -> usize {
    value.ceil().max(0.0) as usize
}
