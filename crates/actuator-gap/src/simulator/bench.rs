//! The bench as the engine sees it: base model, stages of the causes, channels.

use super::response::{Plant, Response, line};
use crate::base::BaseModel;
use crate::causes::{BenchCause, chain_under};
use crate::numbers::{less, mean, slope};
use crate::record::Record;
use model_gap::discovery::{Signal, Simulator, TraceRole};
use model_gap::{Effect, GapError};

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
}

/// Part of the range of the input by which two runs of the same input may differ.
const SAME_INPUT: f64 = 1e-3;

/// The run that a run read by an ideal sensor repeats.
fn twin_of(runs: &[&Record], own: &Record, range: (f64, f64)) -> Option<usize> {
    let most = SAME_INPUT * (range.1 - range.0);
    let is_twin = |other: &&Record| {
        !other.has_ideal_sensor()
            && !other.is_preloaded()
            && other.input.len() == own.input.len()
            && (other.step_s / own.step_s - 1.0).abs() < SAME_INPUT
            && other.input.iter().zip(&own.input).all(|(a, b)| (a - b).abs() <= most)
    };
    runs.iter().position(is_twin).filter(|_| own.has_ideal_sensor())
}

impl<'a> BenchSimulator<'a> {
    pub(crate) fn new(
        base: &'a BaseModel,
        runs: Vec<&'a Record>,
        causes: &'a [BenchCause],
        range: (f64, f64),
    ) -> Result<Self, GapError> {
        let all: usize = runs.iter().map(|r| r.input.len()).sum();
        let block = all.div_ceil(MOST_SAMPLES).max(1);
        let mut channels = Vec::new();
        for (number, run) in runs.iter().enumerate() {
            let mut add = |kind, signal: &[f64], twin| {
                let measured = run.judged(signal).to_vec();
                channels.push(Channel { run: number, kind, measured, twin });
            };
            match twin_of(&runs, run, range) {
                Some(twin) => {
                    let difference = less(&runs[twin].output, &run.output);
                    add(ChannelKind::Comparison, &difference, Some(twin));
                }
                None => add(ChannelKind::Output, &run.output, None),
            }
            for (kind, given) in [
                (ChannelKind::Amplifier, &run.amplifier),
                (ChannelKind::Temperature, &run.temperature),
                (ChannelKind::Load, &run.load),
            ] {
                if let Some(signal) = given {
                    add(kind, signal, None);
                }
            }
        }
        let plant = Plant::new(base, runs.clone(), causes, range)?;
        Ok(Self { base, runs, causes, plant, channels, block, range })
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
        (0..count).map(|k| self.on_traces(|run| &per_run[run][k])).collect()
    }

    /// A signal per run taken to the traces: zero on every further channel.
    pub(crate) fn on_traces<'s>(&self, of_run: impl Fn(usize) -> &'s Vec<f64>) -> Signal {
        let one = |channel: &Channel| {
            let output = averaged(self.runs[channel.run].judged(of_run(channel.run)), self.block);
            match channel.kind {
                ChannelKind::Output => output,
                // what is wrong with the motion is the same in both readings
                _ => vec![0.0; output.len()],
            }
        };
        self.channels.iter().map(one).collect()
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
            ChannelKind::Output => run.judged(&own.outputs[number]).to_vec(),
            ChannelKind::Comparison => {
                let read = &own.outputs[channel.twin.unwrap_or(number)];
                with_its_mean(less(run.judged(read), run.judged(&own.outputs[number])))
            }
            ChannelKind::Amplifier => {
                run.judged(own.front.terminals[number].as_ref().unwrap_or(&run.input)).to_vec()
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

impl Simulator for BenchSimulator<'_> {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        let response = self.plant.respond(effects)?;
        let reading = |channel: &Channel| averaged(&self.reading(channel, &response), self.block);
        Ok(self.channels.iter().map(reading).collect())
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
