//! The measured signals as the engine weighs them: noise, structure, and what the base model may still
//! move by.

use super::bench::{BenchSimulator, Channel, ChannelKind, averaged};
use crate::base::{ErrorModel, white_noise};
use crate::causes::Command;
use crate::numbers::less;
use crate::record::Record;
use measured_data::Accuracy;
use model_gap::discovery::Trace;
use model_gap::{Sine, Spectrum};
use nalgebra::DMatrix;
use rotor_base::variance;

/// Directions in which the base model may move.
const MOST_DIRECTIONS: usize = 32;
/// Part of the range by which a sample of a voltage monitor may stray from the terminals beside its gain and zero.
const MONITOR_ERROR: f64 = 1e-2;
/// Standard deviation of the zero of a run, over the spread of the output.
const ZERO_ERROR: f64 = 2e-3;

/// Columns of the nuisance that are calibrations, gain and zero of sensor, amplifier and monitor: the last ones.
pub(crate) const CALIBRATIONS: usize = 6;

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
                    let readings = readings_in(channel);
                    let structure = e.structure * self.structure_part(channel, e.structure);
                    let white = readings * e.noise.powi(2) / block;
                    let left = (e.correlation / block).max(1.0) * structure.powi(2);
                    (white.sqrt(), (white + left).sqrt())
                }
                ChannelKind::Comparison => (white / block.sqrt(), white / block.sqrt()),
                ChannelKind::Amplifier => {
                    let white = white_noise(&less(own, run.judged_input()));
                    (white, white.max(MONITOR_ERROR * (self.range.1 - self.range.0)))
                }
                ChannelKind::Temperature => {
                    (white, white.max(self.accuracy.thermometer.zero_kelvin))
                }
                ChannelKind::Load => (white, (3.0 * white).max(0.3 * variance(own).sqrt())),
            };
            let measured = averaged(own, self.block);
            let sigma = sigma.max(1e-12);
            Trace {
                experiment: channel.run,
                step_s: block * run.step_s,
                block: block_of(run, measured.len()),
                nuisance: self.nuisance(channel, &moving, measured.len()),
                spectrum: self.spectrum(channel, measured.len(), sigma, &errors[channel.run]),
                measured,
                sigma,
                noise,
                role: channel.kind.role(),
            }
        };
        self.channels.iter().map(one).collect()
    }

    /// Part of the structural error of the base model that is in a channel: where a run is compared with the reference run of
    /// its input, no more than two such runs differ by.
    fn structure_part(&self, channel: &Channel, structure: f64) -> f64 {
        let repeated = self.repeatability * self.base.spread;
        if channel.anchor.is_some() && structure > repeated { repeated / structure } else { 1.0 }
    }

    /// How the errors of a channel are spread over frequency, over the variance `sigma^2` that its samples weigh with; those
    /// of a channel that the base model does not foretell are taken for white.
    fn spectrum(
        &self,
        channel: &Channel,
        samples: usize,
        sigma: f64,
        errors: &ErrorModel,
    ) -> Spectrum {
        if channel.kind != ChannelKind::Output {
            return Spectrum::default();
        }
        let (run, block) = (self.runs[channel.run], self.block as f64);
        let white = readings_in(channel) * errors.noise.powi(2) / block;
        let part = self.structure_part(channel, errors.structure).powi(2);
        let lines = self.base.structure_lines(run, samples, block * run.step_s);
        let variance = |structure: f64| (white + part * structure) / (sigma * sigma);
        Spectrum::new(lines.into_iter().map(variance).collect())
    }

    /// What a channel may move by, in this order: the directions of the base model, the zeros of the runs, and the
    /// calibration of sensor, amplifier and monitor from one session to the next.
    fn nuisance(&self, channel: &Channel, moving: &[DMatrix<f64>], samples: usize) -> DMatrix<f64> {
        let (number, Accuracy { displacement, amplifier, monitor, .. }) =
            (channel.run, self.accuracy);
        let run = self.runs[number];
        let (plain, input) = (&self.plain()[number], &run.input);
        let directions = moving.first().map_or(0, DMatrix::ncols);
        let mut columns: Vec<Option<Vec<f64>>> = vec![None; directions + self.runs.len()];
        let scaled =
            |signal: &[f64], by: f64| -> Vec<f64> { signal.iter().map(|v| by * v).collect() };
        let constant = |value: f64| vec![value; input.len()];
        let is_output = channel.kind == ChannelKind::Output;
        let by_sensor = !run.has_ideal_sensor();
        if is_output {
            if channel.anchor.is_none() {
                for (own, direction) in columns.iter_mut().zip(moving[number].column_iter()) {
                    *own = Some(direction.as_slice().to_vec());
                }
            }
            columns[directions + number] = Some(constant(ZERO_ERROR * self.base.spread));
        }
        let output = |by: &dyn Fn() -> Vec<f64>| is_output.then(by);
        let of_sensor = |by: &dyn Fn() -> Vec<f64>| (is_output && by_sensor).then(by);
        columns.push(of_sensor(&|| scaled(plain, 0.01 * displacement.gain_percent)));
        columns.push(of_sensor(&|| constant(displacement.zero_um)));
        let is_monitor = channel.kind == ChannelKind::Amplifier;
        for (gain, zero_volt) in [(0.01 * amplifier.gain_percent, 0.0), (0.0, amplifier.zero_volt)]
        {
            let volt = || -> Vec<f64> {
                input.iter().map(|u| Command { gain: 1.0 + gain, zero_volt }.of(*u)).collect()
            };
            columns.push(if is_monitor {
                Some(less(&volt(), input))
            } else {
                output(&|| less(&self.base.predict(&volt(), run.step_s), plain))
            });
        }
        columns.push(is_monitor.then(|| scaled(input, 0.01 * monitor.gain_percent)));
        columns.push(is_monitor.then(|| constant(monitor.zero_volt)));
        let columns: Vec<Option<Vec<f64>>> = columns
            .into_iter()
            .map(|column| column.map(|own| averaged(run.judged(&own), self.block)))
            .collect();
        DMatrix::from_fn(samples, columns.len(), |i, k| {
            columns[k].as_ref().map_or(0.0, |own| own[i])
        })
    }
}

/// Readings whose noise is in a channel: that of the reference run of the same input is in a comparison too.
fn readings_in(channel: &Channel) -> f64 {
    if channel.anchor.is_some() { 2.0 } else { 1.0 }
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
