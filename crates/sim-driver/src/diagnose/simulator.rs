//! The bench as the engine sees it: base model, stages of the causes, channels.

use super::base::BaseModel;
use super::causes::{BenchCause, Part};
use super::record::Record;
use super::response::{Plant, Response, line, slope};
use super::traces::averaged;
use model_gap::discovery::{Signal, Simulator};
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
}

/// The measured runs with the base model and the causes.
pub(crate) struct BenchSimulator<'a> {
    pub(crate) base: &'a BaseModel,
    pub(crate) runs: Vec<&'a Record>,
    causes: &'a [Box<dyn BenchCause>],
    plant: Plant<'a>,
    pub(crate) channels: Vec<(usize, ChannelKind)>,
    /// Samples averaged into one.
    pub(crate) block: usize,
    pub(crate) range: (f64, f64),
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
        for (number, run) in runs.iter().enumerate() {
            channels.push((number, ChannelKind::Output));
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
        Ok(Self { base, runs, causes, plant, channels, block, range })
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
                };
                (number, name, self.runs[number].step_s * self.block as f64)
            })
            .collect()
    }

    /// What a channel of a run recorded.
    pub(super) fn measured(&self, number: usize, kind: ChannelKind) -> &[f64] {
        let run = self.runs[number];
        let given = match kind {
            ChannelKind::Output => return &run.output,
            ChannelKind::Amplifier => &run.amplifier,
            ChannelKind::Temperature => &run.temperature,
            ChannelKind::Load => &run.load,
        };
        given.as_deref().unwrap_or_default()
    }

    /// Input and output of the base model on a run, for directions without a name.
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
            .map(|&(number, kind)| match kind {
                ChannelKind::Output => averaged(&outputs[number], self.block),
                _ => vec![0.0; averaged_length(outputs[number].len(), self.block)],
            })
            .collect()
    }

    /// What a channel reads; zero of thermometer and load cell, and the stiffness of a load spring, are
    /// what the record says.
    fn reading(&self, number: usize, kind: ChannelKind, own: &Response) -> Vec<f64> {
        let measured = self.measured(number, kind);
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
        match kind {
            ChannelKind::Output => own.output(number),
            ChannelKind::Amplifier => {
                own.terminal(number).unwrap_or(&self.runs[number].input).to_vec()
            }
            ChannelKind::Temperature => {
                let rest = || vec![0.0; measured.len()];
                let rise = own.rise_k(number).map_or_else(rest, <[f64]>::to_vec);
                let off = mean(measured) - mean(&rise);
                rise.iter().map(|t| t + off).collect()
            }
            ChannelKind::Load => {
                // a load cell does not feel what hums in the reading
                let output = own.steady_output(number);
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
        let Part::Hum { amplitude, frequency_hz } =
            self.causes[effect.candidate].part(&effect.values)
        else {
            return Ok(None);
        };
        let own = |(&(number, kind), residual): (&(usize, ChannelKind), &Vec<f64>)| {
            let run = self.runs[number];
            if kind != ChannelKind::Output || run.has_ideal_sensor() {
                return vec![0.0; residual.len()];
            }
            line(amplitude, frequency_hz * run.step_s * self.block as f64, residual)
        };
        Ok(Some(self.channels.iter().zip(residual).map(own).collect()))
    }
}

fn averaged_length(samples: usize, block: usize) -> usize {
    (samples / block).max(1)
}
