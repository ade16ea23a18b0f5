//! The bench as the engine sees it: base model, stages of the causes, channels.

use super::response::{Plant, Response, line, slope};
use crate::base::BaseModel;
use crate::causes::{BenchCause, chain_under};
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
    pub(crate) fn role(self) -> TraceRole {
        match self {
            Self::Output => TraceRole::Output,
            Self::Amplifier | Self::Comparison => TraceRole::IntermediateChannel,
            Self::Temperature | Self::Load => TraceRole::Covariate,
        }
    }
}

/// The measured runs with the base model and the causes.
pub(crate) struct BenchSimulator<'a> {
    pub(crate) base: &'a BaseModel,
    pub(crate) runs: Vec<&'a Record>,
    causes: &'a [Box<dyn BenchCause>],
    plant: Plant<'a>,
    pub(crate) channels: Vec<(usize, ChannelKind)>,
    /// For a run read by an ideal sensor: the run of the same input read by the sensor of the bench, and
    /// the difference of both readings.
    twins: Vec<Option<Twin>>,
    /// Samples averaged into one.
    pub(crate) block: usize,
    pub(crate) range: (f64, f64),
}

/// A run that another one repeats.
struct Twin {
    run: usize,
    /// Its reading less that of the other.
    difference: Vec<f64>,
}

/// Part of the range of the input by which two runs of the same input may differ.
const SAME_INPUT: f64 = 1e-3;

/// The run that a run read by an ideal sensor repeats.
fn twin_of(runs: &[&Record], number: usize, range: (f64, f64)) -> Option<Twin> {
    let own = runs[number];
    let (step_s, most) = (own.step_s, SAME_INPUT * (range.1 - range.0));
    let is_same = |other: &&Record| {
        other.input.len() == own.input.len()
            && (other.step_s / step_s - 1.0).abs() < SAME_INPUT
            && other.input.iter().zip(&own.input).all(|(a, b)| (a - b).abs() <= most)
    };
    let found =
        |other: &&Record| !other.has_ideal_sensor() && !other.is_preloaded() && is_same(other);
    let run = runs.iter().position(found).filter(|_| own.has_ideal_sensor())?;
    let pairs = runs[run].output.iter().zip(&own.output);
    Some(Twin { run, difference: pairs.map(|(read, ideal)| read - ideal).collect() })
}

impl<'a> BenchSimulator<'a> {
    pub(crate) fn new(
        base: &'a BaseModel,
        runs: Vec<&'a Record>,
        causes: &'a [Box<dyn BenchCause>],
        range: (f64, f64),
    ) -> Result<Self, GapError> {
        let all: usize = runs.iter().map(|r| r.input.len()).sum();
        let block = all.div_ceil(MOST_SAMPLES).max(1);
        let mut channels = Vec::new();
        let twins: Vec<Option<Twin>> =
            (0..runs.len()).map(|number| twin_of(&runs, number, range)).collect();
        for (number, run) in runs.iter().enumerate() {
            let is_twin = twins[number].is_some();
            let output = if is_twin { ChannelKind::Comparison } else { ChannelKind::Output };
            channels.push((number, output));
            for (kind, given) in [
                (ChannelKind::Amplifier, &run.amplifier),
                (ChannelKind::Temperature, &run.temperature),
                (ChannelKind::Load, &run.load),
            ] {
                if given.is_some() {
                    channels.push((number, kind));
                }
            }
        }
        let plant = Plant::new(base, runs.clone(), causes, range)?;
        Ok(Self { base, runs, causes, plant, channels, twins, block, range })
    }

    /// Run, channel and sampling step of every trace.
    pub(crate) fn kinds(&self) -> Vec<(usize, &'static str, f64)> {
        self.channels
            .iter()
            .map(|&(number, kind)| {
                let name = match kind {
                    ChannelKind::Output => "output",
                    ChannelKind::Amplifier => "amplifier",
                    ChannelKind::Temperature => "temperature",
                    ChannelKind::Load => "load",
                    ChannelKind::Comparison => "comparison",
                };
                (number, name, self.runs[number].step_s * self.block as f64)
            })
            .collect()
    }

    /// What a channel of a run recorded where that is judged.
    pub(super) fn measured(&self, number: usize, kind: ChannelKind) -> &[f64] {
        let run = self.runs[number];
        let given = match kind {
            ChannelKind::Output => return run.judged_output(),
            ChannelKind::Amplifier => &run.amplifier,
            ChannelKind::Temperature => &run.temperature,
            ChannelKind::Load => &run.load,
            ChannelKind::Comparison => {
                return self.twins[number]
                    .as_ref()
                    .map_or(&[], |twin| run.judged(&twin.difference));
            }
        };
        given.as_deref().map_or(&[], |given| run.judged(given))
    }

    /// Input and output of the base model on a run, for the generic directions.
    pub(crate) fn plain(&self, number: usize) -> (&[f64], &[f64]) {
        (&self.runs[number].input, &self.plant.plain[number])
    }

    /// The temperature rise of an effect on the first run as it is, whatever a thermometer showed, K.
    pub(crate) fn rise_k(&self, effect: &Effect) -> Result<Vec<f64>, GapError> {
        let response = self.plant.respond(std::slice::from_ref(effect))?;
        let rest = || vec![0.0; self.runs.first().map_or(0, |r| r.input.len())];
        Ok(response.rise_k(0).map_or_else(rest, <[f64]>::to_vec))
    }

    /// A signal per run taken to the traces: zero on every further channel.
    pub(crate) fn on_traces(&self, outputs: &[Vec<f64>]) -> Signal {
        self.channels
            .iter()
            .map(|&(number, kind)| {
                let output = self.runs[number].judged(&outputs[number]);
                match kind {
                    ChannelKind::Output => averaged(output, self.block),
                    // what is wrong with the motion is the same in both readings
                    _ => vec![0.0; averaged_length(output.len(), self.block)],
                }
            })
            .collect()
    }

    /// What a channel reads; zero of thermometer, load cell and second sensor, and the stiffness of a load
    /// spring, are what the record says.
    fn reading(&self, number: usize, kind: ChannelKind, own: &Response) -> Vec<f64> {
        let measured = self.measured(number, kind);
        let judged = |signal: &[f64]| self.runs[number].judged(signal).to_vec();
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
        match kind {
            ChannelKind::Output => judged(&own.output(number)),
            ChannelKind::Comparison => {
                let Some(twin) = &self.twins[number] else { return Vec::new() };
                let mut read = judged(&own.output(twin.run));
                let ideal = judged(&own.output(number));
                read.iter_mut().zip(ideal).for_each(|(read, ideal)| *read -= ideal);
                let off = mean(measured) - mean(&read);
                read.iter().map(|difference| difference + off).collect()
            }
            ChannelKind::Amplifier => {
                judged(own.terminal(number).unwrap_or(&self.runs[number].input))
            }
            ChannelKind::Temperature => {
                let rest = || vec![0.0; measured.len()];
                let rise = own.rise_k(number).map_or_else(rest, judged);
                let off = mean(measured) - mean(&rise);
                rise.iter().map(|t| t + off).collect()
            }
            ChannelKind::Load => {
                // a load cell does not feel what hums in the reading
                let output = self.runs[number].judged(own.steady_output(number));
                let per_output = if own.is_loaded { slope(output, measured) } else { 0.0 };
                let off = mean(measured) - per_output * mean(output);
                output.iter().map(|y| off + per_output * y).collect()
            }
        }
    }
}

impl Simulator for BenchSimulator<'_> {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        let response = self.plant.respond(effects)?;
        let reading = |&(number, kind): &(usize, ChannelKind)| {
            averaged(&self.reading(number, kind, &response), self.block)
        };
        Ok(self.channels.iter().map(reading).collect())
    }

    /// Mains hum has a phase of its own in every record.
    fn adapted(
        &self,
        effect: &Effect,
        residual: &[Vec<f64>],
    ) -> Result<Option<Vec<Vec<f64>>>, GapError> {
        let mut chain = chain_under(self.causes, std::slice::from_ref(effect));
        let Some(hum) = chain.rear.take_hum() else { return Ok(None) };
        let own = |(&(number, kind), residual): (&(usize, ChannelKind), &Vec<f64>)| {
            let run = self.runs[number];
            let shows_hum = match kind {
                ChannelKind::Output => !run.has_ideal_sensor(),
                ChannelKind::Comparison => true,
                _ => false,
            };
            if !shows_hum {
                return vec![0.0; residual.len()];
            }
            line(hum.amplitude_um, hum.frequency_hz * run.step_s * self.block as f64, residual)
        };
        Ok(Some(self.channels.iter().zip(residual).map(own).collect()))
    }
}

fn averaged_length(samples: usize, block: usize) -> usize {
    (samples / block).max(1)
}

/// Means of whole blocks; the same for measured and predicted, so nothing is lost but what is faster
/// than a block.
pub(crate) fn averaged(values: &[f64], block: usize) -> Vec<f64> {
    if block <= 1 {
        return values.to_vec();
    }
    values.chunks_exact(block).map(|c| c.iter().sum::<f64>() / block as f64).collect()
}
