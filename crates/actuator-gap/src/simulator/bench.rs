//! The bench as the engine sees it: base model, stages of the causes, channels.

use super::response::{Plant, Response, highest_mode_hz, line};
use crate::base::{BaseModel, white_noise};
use crate::causes::{BenchCause, Command, chain_under, reads_load};
use crate::numbers::{less, slope};
use crate::record::Record;
use measured_data::Accuracy;
use model_gap::discovery::{Signal, Simulator, TraceRole};
use model_gap::{Effect, GapError};
use preisach_dyn::LinkageStage;
use rotor_base::{mean, variance};

/// Most samples of all traces together; longer sets are averaged in blocks.
const MOST_SAMPLES: usize = 60_000;

/// What a trace shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ChannelKind {
    Output,
    Amplifier,
    Temperature,
    Load,
    /// The output less what an ideal sensor read of the same motion: what the base model gets wrong
    /// cancels, what the sensor does is left.
    Comparison,
}

impl ChannelKind {
    pub(super) fn role(self) -> TraceRole {
        match self {
            Self::Output => TraceRole::Output,
            Self::Amplifier | Self::Comparison => TraceRole::IntermediateChannel,
            Self::Temperature | Self::Load => TraceRole::Covariate,
        }
    }
}

/// A channel of a run.
pub(crate) struct Channel {
    pub(crate) run: usize,
    pub(crate) kind: ChannelKind,
    /// What it recorded where that is judged.
    pub(super) measured: Vec<f64>,
    /// The run that the reading is compared with: of the same input, read by the sensor of the bench.
    twin: Option<usize>,
    /// What the reference run of the same input read less what the base model makes of it, where there is one: the
    /// error of the base model, which is then known there.
    pub(super) anchor: Option<Vec<f64>>,
}

/// The measured runs with the base model and the causes.
pub(crate) struct BenchSimulator<'a> {
    pub(crate) base: &'a BaseModel,
    pub(crate) runs: Vec<&'a Record>,
    causes: &'a [BenchCause],
    plant: Plant<'a>,
    pub(crate) channels: Vec<Channel>,
    /// Samples averaged into one.
    pub(crate) block: usize,
    pub(super) range: (f64, f64),
    pub(super) accuracy: Accuracy,
    /// What two runs of one input differ by besides noise, over the spread of the output.
    pub(super) repeatability: f64,
}

/// What a simulator of a bench is made of.
#[derive(Clone)]
pub(crate) struct Setting<'a> {
    pub(crate) base: &'a BaseModel,
    /// Runs that show the system with nothing missing.
    pub(crate) references: Vec<&'a Record>,
    pub(crate) causes: &'a [BenchCause],
    pub(crate) range: (f64, f64),
    pub(crate) accuracy: Accuracy,
}

/// Part of the range of the input by which two runs of the same input may differ.
const SAME_INPUT: f64 = 1e-3;

/// Whether two runs have the same input.
pub(crate) fn is_same_input(a: &Record, b: &Record, range: (f64, f64)) -> bool {
    a.input.len() == b.input.len() && begins_as(a, b, range)
}

/// Whether the input of a run is that of the beginning of another, or all of it.
fn begins_as(own: &Record, other: &Record, range: (f64, f64)) -> bool {
    let most = SAME_INPUT * (range.1 - range.0);
    own.input.len() <= other.input.len()
        && (own.step_s / other.step_s - 1.0).abs() < SAME_INPUT
        && own.input.iter().zip(&other.input).all(|(a, b)| (a - b).abs() <= most)
}

/// The run that a run read by an ideal sensor repeats.
fn twin_of(runs: &[&Record], own: &Record, range: (f64, f64)) -> Option<usize> {
    let is_twin = |other: &&Record| {
        !other.has_ideal_sensor() && !other.is_preloaded() && is_same_input(other, own, range)
    };
    runs.iter().position(is_twin).filter(|_| own.has_ideal_sensor())
}

/// Number of the input of every run: that of the first run with the same input.
pub(crate) fn inputs_of(runs: &[&Record], range: (f64, f64)) -> Vec<usize> {
    let first = |own: &&Record| {
        let same = runs.iter().position(|other| is_same_input(other, own, range));
        same.unwrap_or_default()
    };
    runs.iter().map(first).collect()
}

/// What reference runs of one input differ by besides noise and zero, over the spread of the output: rms over the pairs of a
/// run with the one before it of the same input; 0 without repeats. A record that is there twice is no repeat.
fn repeatability_of(references: &[&Record], range: (f64, f64), spread: f64) -> f64 {
    let mut squares = Vec::new();
    for (k, run) in references.iter().enumerate() {
        let is_repeat = |other: &&&Record| {
            is_same_setup(other, run)
                && other.window == run.window
                && is_same_input(other, run, range)
        };
        let Some(before) = references[..k].iter().rfind(is_repeat) else { continue };
        let difference = less(run.judged_output(), before.judged_output());
        if difference.iter().any(|d| *d != 0.0) {
            let white = white_noise(&difference).powi(2);
            // what noise alone may read, five standard deviations of its variance
            let chance = 5.0 * (2.0 / difference.len() as f64).sqrt();
            squares.push((variance(&difference) - white * (1.0 + chance)).max(0.0));
        }
    }
    if squares.is_empty() { 0.0 } else { mean(&squares).sqrt() / spread }
}

impl<'a> BenchSimulator<'a> {
    pub(crate) fn new(setting: Setting<'a>, runs: Vec<&'a Record>) -> Result<Self, GapError> {
        let Setting { base, references, causes, range, accuracy } = setting;
        let monitor = monitor_of(&references);
        let shows_load = !reads_load(&references);
        let all: usize = runs.iter().map(|r| r.input.len()).sum();
        let block = all.div_ceil(MOST_SAMPLES).max(1);
        let repeatability = repeatability_of(&references, range, base.spread)
            .max(0.01 * accuracy.repeatability_percent);
        let mut channels = Vec::new();
        for (number, run) in runs.iter().enumerate() {
            let anchor = references
                .iter()
                .find(|other| {
                    let is_judged = other.window.start <= run.window.start
                        && other.window.end >= run.window.end;
                    is_judged && is_same_setup(other, run) && begins_as(run, other, range)
                })
                .map(|other| less(&other.output, &base.predict(&other.input, other.step_s)));
            let mut add = |kind, signal: &[f64], twin| {
                let measured = run.judged(signal).to_vec();
                let anchor = anchor.clone().filter(|_| kind == ChannelKind::Output);
                channels.push(Channel { run: number, kind, measured, twin, anchor });
            };
            match twin_of(&runs, run, range) {
                Some(twin) => {
                    let difference = less(&runs[twin].output, &run.output);
                    add(ChannelKind::Comparison, &difference, Some(twin));
                }
                None => add(ChannelKind::Output, &run.output, None),
            }
            if let Some(read) = &run.amplifier {
                // as it read the command in the reference runs, where terminals and command are one
                let volt: Vec<f64> =
                    read.iter().map(|v| (v - monitor.zero_volt) / monitor.gain).collect();
                add(ChannelKind::Amplifier, &volt, None);
            }
            if let Some(rise) = &run.temperature {
                add(ChannelKind::Temperature, rise, None);
            }
            // beside a spring that was always there a reading that is low looks like a new load
            if let Some(load) = run.load.as_ref().filter(|_| shows_load) {
                add(ChannelKind::Load, load, None);
            }
        }
        let plant = Plant::new(base, runs.clone(), causes, range)?;
        Ok(Self { base, runs, causes, plant, channels, block, range, accuracy, repeatability })
    }

    /// The runs under no effect.
    pub(super) fn plain(&self) -> &[Vec<f64>] {
        &self.plant.plain
    }

    /// Directions on all traces, zero on every channel but the outputs, from input, output of the base model
    /// and step of every run.
    pub(crate) fn directions(
        &self,
        of_run: impl Fn(&[f64], &[f64], f64) -> Vec<Vec<f64>>,
    ) -> Vec<Signal> {
        let plain = self.runs.iter().zip(self.plant.plain.iter());
        let per_run: Vec<Vec<Vec<f64>>> =
            plain.map(|(run, plain)| of_run(&run.input, plain, run.step_s)).collect();
        let count = per_run.first().map_or(0, Vec::len);
        (0..count).map(|k| self.on_outputs(|run| &per_run[run][k], |_| true)).collect()
    }

    /// What the base model leaves of a system per run, taken to the traces. Where the reference runs hold the same
    /// input its error is known, and none is left.
    pub(crate) fn structure<'s>(&self, of_run: impl Fn(usize) -> &'s Vec<f64>) -> Signal {
        self.on_outputs(of_run, |channel| channel.anchor.is_none())
    }

    /// A signal per run on the outputs that count; zero on every further channel: what is wrong with the motion is the
    /// same in two readings of it.
    fn on_outputs<'s>(
        &self,
        of_run: impl Fn(usize) -> &'s Vec<f64>,
        counts: impl Fn(&Channel) -> bool,
    ) -> Signal {
        let one = |channel: &Channel| {
            let output = averaged(self.runs[channel.run].judged(of_run(channel.run)), self.block);
            match channel.kind {
                ChannelKind::Output if counts(channel) => output,
                _ => vec![0.0; output.len()],
            }
        };
        self.channels.iter().map(one).collect()
    }

    /// The runs under effects, each channel that they have at its own sampling, without noise.
    pub(crate) fn rehearsed(&self, effects: &[Effect]) -> Result<Vec<Record>, GapError> {
        let own = self.plant.respond(effects)?;
        let one = |(number, run): (usize, &&Record)| {
            let terminals = own.front.terminals[number].as_ref().unwrap_or(&run.input);
            let monitor = |volt: &f64| own.monitor.map_or(*volt, |monitor| monitor.of(*volt));
            let rise = own.front.rises_k[number].as_ref();
            Record {
                output: own.outputs[number].clone(),
                amplifier: run.amplifier.as_ref().map(|_| terminals.iter().map(monitor).collect()),
                temperature: run.temperature.as_ref().map(|still| rise.unwrap_or(still).clone()),
                ..(*run).clone()
            }
        };
        Ok(self.runs.iter().enumerate().map(one).collect())
    }

    /// The temperature rise of an effect on the first run as it is, whatever a thermometer showed, K.
    pub(crate) fn rise_k(&self, effect: &Effect) -> Result<Vec<f64>, GapError> {
        let response = self.plant.respond(std::slice::from_ref(effect))?;
        let rest = || vec![0.0; self.runs.first().map_or(0, |r| r.input.len())];
        Ok(response.front.rises_k.first().cloned().flatten().unwrap_or_else(rest))
    }

    /// What a channel reads; zero of thermometer, load cell and second sensor, and the stiffness of a load
    /// spring, are what the record says.
    fn reading(&self, channel: &Channel, own: &Response) -> Vec<f64> {
        let (number, measured) = (channel.run, &channel.measured);
        let run = self.runs[number];
        let with_its_mean = |signal: Vec<f64>| {
            let off = mean(measured) - mean(&signal);
            signal.iter().map(|v| v + off).collect()
        };
        match channel.kind {
            ChannelKind::Output => {
                let read = run.judged(&own.outputs[number]).to_vec();
                match &channel.anchor {
                    Some(off) => read.iter().zip(run.judged(off)).map(|(y, off)| y + off).collect(),
                    None => read,
                }
            }
            ChannelKind::Comparison => {
                let read = &own.outputs[channel.twin.unwrap_or(number)];
                with_its_mean(less(run.judged(read), run.judged(&own.outputs[number])))
            }
            ChannelKind::Amplifier => {
                let volt = own.front.terminals[number].as_ref().unwrap_or(&run.input);
                let read = |volt: &f64| own.monitor.map_or(*volt, |monitor| monitor.of(*volt));
                run.judged(volt).iter().map(read).collect()
            }
            ChannelKind::Temperature => {
                let rise = own.front.rises_k[number].as_deref();
                with_its_mean(rise.map_or(vec![0.0; measured.len()], |t| run.judged(t).to_vec()))
            }
            ChannelKind::Load => {
                // a load cell does not feel what hums in the reading
                let output = run.judged(&own.steady[number]);
                let per_output = if own.is_loaded { slope(output, measured) } else { 0.0 };
                let off = mean(measured) - per_output * mean(output);
                output.iter().map(|y| off + per_output * y).collect()
            }
        }
    }
}

/// Whether two runs are read by the same sensor and fitted alike.
fn is_same_setup(a: &Record, b: &Record) -> bool {
    a.sensor == b.sensor && a.fitting == b.fitting
}

/// Gain and zero of the voltage monitor in the reference runs, where the terminals are at the command: by least
/// squares; 1 and 0 without one.
fn monitor_of(references: &[&Record]) -> Command {
    let monitored = references.iter().filter_map(|run| Some((run, run.amplifier.as_ref()?)));
    let (input, read): (Vec<f64>, Vec<f64>) = monitored
        .flat_map(|(run, read)| run.judged_input().iter().copied().zip(run.judged(read).to_vec()))
        .unzip();
    let gain = slope(&input, &read);
    if gain <= 0.0 {
        return Command { gain: 1.0, zero_volt: 0.0 };
    }
    Command { gain, zero_volt: mean(&read) - gain * mean(&input) }
}

impl Simulator for BenchSimulator<'_> {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        let response = self.plant.respond(effects)?;
        let reading = |channel: &Channel| averaged(&self.reading(channel, &response), self.block);
        Ok(self.channels.iter().map(reading).collect())
    }

    /// A mode above what a run is sampled for rings between its samples.
    fn carries(&self, effects: &[Effect], trace: usize) -> bool {
        let run = self.runs[self.channels[trace].run];
        let linkage = chain_under(self.causes, effects).rear.linkage;
        let mut modes = linkage.iter().filter_map(|stage| match stage {
            LinkageStage::Resonance(mode) => Some(mode.frequency_hz),
            _ => None,
        });
        modes.all(|hz| hz < highest_mode_hz(run.step_s))
    }

    /// Mains hum has a phase of its own in every record.
    fn adapted(&self, effect: &Effect, residual: &Signal) -> Result<Option<Signal>, GapError> {
        let mut chain = chain_under(self.causes, std::slice::from_ref(effect));
        let Some(hum) = chain.rear.take_hum() else { return Ok(None) };
        let own = |(channel, residual): (&Channel, &Vec<f64>)| {
            let run = self.runs[channel.run];
            let shows_hum = match channel.kind {
                ChannelKind::Output => !run.has_ideal_sensor(),
                kind => kind == ChannelKind::Comparison,
            };
            if !shows_hum {
                return vec![0.0; residual.len()];
            }
            line(hum.amplitude_um, hum.frequency_hz * run.step_s * self.block as f64, residual)
        };
        Ok(Some(self.channels.iter().zip(residual).map(own).collect()))
    }
}

/// Means of whole blocks; the same for measured and predicted, so nothing is lost but what is faster
/// than a block.
pub(crate) fn averaged(values: &[f64], block: usize) -> Vec<f64> {
    if block <= 1 {
        return values.to_vec();
    }
    values.chunks_exact(block).map(|c| c.iter().sum::<f64>() / block as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use model_gap::SplitMix;

    /// A run of a sine whose output is the input, and what is added to it.
    fn run(extra: impl Fn(f64) -> f64) -> Record {
        let input: Vec<f64> = (0..2000).map(|i| 50.0 * (0.01 * f64::from(i)).sin()).collect();
        let output = (0u32..).zip(&input).map(|(i, u)| u + extra(f64::from(i))).collect();
        Record::new("a", 1e-3, input, output)
    }

    #[test]
    fn what_repeats_differ_by_is_told_without_zero_and_noise() {
        let noisy = |mut run: Record, draw: u64| {
            let mut noise = SplitMix(draw);
            run.output.iter_mut().for_each(|y| *y += 0.1 * noise.normal());
            run
        };
        let (plain, again) = (noisy(run(|_| 0.0), 1), noisy(run(|_| 0.0), 2));
        let drifted = noisy(run(|i| 4.0 + 0.5 * (0.005 * i).sin()), 3);
        let of = |others: &[&Record]| {
            repeatability_of(&[&[&plain], others].concat(), (-50.0, 50.0), 50.0)
        };
        assert_eq!(
            (of(&[]), of(&[&plain])),
            (0.0, 0.0),
            "a record that is there twice is no repeat"
        );
        assert!(of(&[&again]) < 1e-4, "{}", of(&[&again]));
        assert_relative_eq!(of(&[&drifted]), 0.5 / 2.0_f64.sqrt() / 50.0, max_relative = 0.1);
    }
}
