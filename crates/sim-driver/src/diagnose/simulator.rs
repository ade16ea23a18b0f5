//! The bench as the engine sees it: base model, stages of the causes, channels.

use super::base::{BaseModel, ErrorModel, variance, white_noise};
use super::causes::{BenchCause, Part};
use super::record::Record;
use model_gap::discovery::{Signal, Simulator, Trace};
use model_gap::{Effect, GapError};
use nalgebra::DMatrix;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, Drive, LinearGain, LinkageStage,
    SensorStage, VoltageRange,
};

/// Most samples of all traces together; longer sets are averaged in blocks.
const MOST_SAMPLES: usize = 60_000;
/// Directions in which the base model may move.
const MOST_DIRECTIONS: usize = 32;
/// Part of the range that a voltage monitor is trusted to.
const MONITOR_ERROR: f64 = 1e-2;
/// Temperature that a thermometer is trusted to, K.
const THERMOMETER_ERROR_K: f64 = 1.0;
/// Standard deviation of the zero of a run, over the spread of the output.
const ZERO_ERROR: f64 = 2e-3;

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
    pub(crate) causes: &'a [Box<dyn BenchCause>],
    /// Output of the base's static part, and behind its relaxation, on the plain command.
    laws: Vec<Vec<f64>>,
    plain: Vec<Vec<f64>>,
    /// Residual of the base model, for what has its own phase in every run.
    residuals: Vec<Vec<f64>>,
    pub(crate) channels: Vec<(usize, ChannelKind)>,
    /// Samples averaged into one.
    pub(crate) block: usize,
    range: (f64, f64),
    /// Stages that only see signals: any value may pass.
    wide: VoltageRange,
}

/// Signals of one run under effects.
struct Simulated {
    output: Vec<f64>,
    terminal: Vec<f64>,
    rise_k: Option<Vec<f64>>,
    is_loaded: bool,
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
        let laws: Vec<Vec<f64>> = runs.iter().map(|r| base.hysteresis(&r.input)).collect();
        let plain: Vec<Vec<f64>> =
            runs.iter().zip(&laws).map(|(r, law)| base.relaxed(law, r.step_s)).collect();
        let residuals = runs
            .iter()
            .zip(&plain)
            .map(|(r, p)| r.output.iter().zip(p).map(|(a, b)| a - b).collect())
            .collect();
        let wide = VoltageRange::new(-1e9, 1e9).map_err(|e| failed("the range of signals", &e))?;
        Ok(Self { base, runs, causes, laws, plain, residuals, channels, block, range, wide })
    }

    /// The traces with their noise and the covariance of the base model.
    pub(crate) fn traces(&self) -> Vec<Trace> {
        let errors: Vec<_> = self.runs.iter().map(|r| self.base.errors(r)).collect();
        let sigmas: Vec<f64> = errors.iter().map(ErrorModel::effective).collect();
        let moving = self.base.nuisance(&self.runs, &sigmas, MOST_DIRECTIONS);
        let directions = moving.first().map_or(0, DMatrix::ncols);
        let width = directions + self.runs.len();
        self.channels
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
                            for (i, v) in averaged(&column, self.block).iter().enumerate() {
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
                    ChannelKind::Amplifier => {
                        let off: Vec<f64> = self
                            .measured(number, kind)
                            .iter()
                            .zip(&run.input)
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
                    is_output: kind == ChannelKind::Output,
                }
            })
            .collect()
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

    fn measured(&self, number: usize, kind: ChannelKind) -> &[f64] {
        let run = self.runs[number];
        let given = match kind {
            ChannelKind::Output => return &run.output,
            ChannelKind::Amplifier => &run.amplifier,
            ChannelKind::Temperature => &run.temperature,
            ChannelKind::Load => &run.load,
        };
        given.as_deref().unwrap_or_default()
    }

    /// The law's input, output and relaxed output of a run, for directions without a name.
    pub(crate) fn plain(&self, number: usize) -> (&[f64], &[f64], &[f64]) {
        (&self.runs[number].input, &self.laws[number], &self.plain[number])
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

    fn simulate(&self, number: usize, effects: &[Effect]) -> Result<Simulated, GapError> {
        let run = self.runs[number];
        let mut amplifier: Vec<AmplifierStage> = Vec::new();
        let mut linkage: Vec<LinkageStage> = Vec::new();
        let mut sensor: Vec<SensorStage> = Vec::new();
        let mut special = Vec::new();
        let mut is_loaded = false;
        for effect in effects {
            match self.causes[effect.candidate].part(&effect.values) {
                Part::Amplifier(stage) => amplifier.push(stage),
                Part::Linkage(stage) => {
                    is_loaded |= matches!(stage, LinkageStage::LoadStiffness(_));
                    linkage.push(stage);
                }
                Part::Sensor(_) if run.has_ideal_sensor() => {}
                Part::Sensor(stages) => sensor.extend(stages),
                other => special.push(other),
            }
        }
        let terminal = if amplifier.is_empty() {
            run.input.clone()
        } else {
            let model = self.through(&amplifier, &[], &[]);
            let drive = Drive::new(&run.input, run.step_s);
            model.simulate_bench(&drive).map_err(|e| failed(&run.id, &e))?.terminal_volt
        };
        let mut rise_k = None;
        let mut gain: Option<Vec<f64>> = None;
        let mut rate = None;
        let mut about = 0.0;
        for part in &special {
            match part {
                Part::Heating(stage, point) => {
                    about = *point;
                    let (rise, scaled) = self.heated(number, *stage, &terminal)?;
                    multiply(
                        &mut gain,
                        rise.iter().map(|t| 1.0 + stage.coefficient_per_k * t * scaled),
                    );
                    rise_k = Some(rise.iter().map(|t| t * scaled).collect());
                }
                Part::Depolarisation(stage, point) => {
                    about = *point;
                    multiply(&mut gain, super::causes::lost_gain(stage, &terminal));
                }
                Part::RateDependence { tau_s, position } => rate = Some((*tau_s, *position)),
                _ => {}
            }
        }
        let is_plain = amplifier.is_empty() && gain.is_none() && rate.is_none();
        let mut output = if is_plain {
            self.plain[number].clone()
        } else {
            let mut law = if amplifier.is_empty() {
                self.laws[number].clone()
            } else {
                self.base.hysteresis(&terminal)
            };
            if let Some(gain) = gain {
                let neutral = self.neutral() + about * (self.neutral_middle() - self.neutral());
                for (y, g) in law.iter_mut().zip(gain) {
                    *y = neutral + g * (*y - neutral);
                }
            }
            if let Some((tau_s, position)) = rate {
                law = super::causes::rate_dependent(
                    &law,
                    tau_s,
                    position,
                    (self.neutral_middle(), self.base.spread),
                    run.step_s,
                );
            }
            self.base.relaxed(&law, run.step_s)
        };
        if !(linkage.is_empty() && sensor.is_empty()) {
            let model = self.through(&[], &linkage, &sensor);
            let drive = Drive::new(&output, run.step_s);
            output = model.simulate_bench(&drive).map_err(|e| failed(&run.id, &e))?.measured_deg;
        }
        for part in &special {
            if let Part::Hum { amplitude, frequency_hz } = part {
                let own = &self.residuals[number];
                self.hum(number, (*amplitude, *frequency_hz), (own, 1), &mut output);
            }
        }
        Ok(Simulated { output, terminal, rise_k, is_loaded })
    }

    /// Stages alone: a law of gain 1 between them, degrees standing for the output's unit.
    fn through(
        &self,
        amplifier: &[AmplifierStage],
        linkage: &[LinkageStage],
        sensor: &[SensorStage],
    ) -> ActuatorModel {
        let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 1.0, bias_volt: 0.0 });
        let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
        let mut model = ActuatorModel::new(law, self.wide, calibration);
        model.amplifier = amplifier.to_vec();
        model.linkage = linkage.to_vec();
        model.sensor = sensor.to_vec();
        model
    }

    /// Output of the rested law at zero input.
    fn neutral(&self) -> f64 {
        self.base.hysteresis(&[0.0]).first().copied().unwrap_or_default()
    }

    fn neutral_middle(&self) -> f64 {
        let middle = f64::midpoint(self.range.0, self.range.1);
        self.base.hysteresis(&[middle]).first().copied().unwrap_or_default()
    }

    /// The temperature rise of a heating stage, K, and the factor that a thermometer sets it right by.
    fn heated(
        &self,
        number: usize,
        stage: preisach_dyn::DielectricHeating,
        terminal: &[f64],
    ) -> Result<(Vec<f64>, f64), GapError> {
        let run = self.runs[number];
        let model = self.through(&[AmplifierStage::DielectricHeating(stage)], &[], &[]);
        let drive = Drive::new(terminal, run.step_s);
        let rise = model.simulate_bench(&drive).map_err(|e| failed(&run.id, &e))?.temperature_k;
        let factor = run.temperature.as_ref().map_or(1.0, |measured| slope(&rise, measured));
        Ok((rise, factor.max(0.0)))
    }

    /// What a channel reads; zero of thermometer and load cell, and the stiffness of a load spring, are
    /// what the record says.
    fn reading(&self, number: usize, kind: ChannelKind, own: &Simulated) -> Vec<f64> {
        let measured = self.measured(number, kind);
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
        match kind {
            ChannelKind::Output => own.output.clone(),
            ChannelKind::Amplifier => own.terminal.clone(),
            ChannelKind::Temperature => {
                let rise = own.rise_k.clone().unwrap_or_else(|| vec![0.0; measured.len()]);
                let off = mean(measured) - mean(&rise);
                rise.iter().map(|t| t + off).collect()
            }
            ChannelKind::Load => {
                let per_output = if own.is_loaded { slope(&own.output, measured) } else { 0.0 };
                let off = mean(measured) - per_output * mean(&own.output);
                own.output.iter().map(|y| off + per_output * y).collect()
            }
        }
    }

    /// A line of given amplitude and frequency, with the phase that a residual asks for; of both one
    /// sample in `block`.
    fn hum(
        &self,
        number: usize,
        (amplitude, frequency_hz): (f64, f64),
        (residual, block): (&[f64], usize),
        output: &mut [f64],
    ) {
        let run = self.runs[number];
        if run.has_ideal_sensor() {
            return;
        }
        let per_sample = frequency_hz * run.step_s * block as f64;
        let angle = |i: usize| std::f64::consts::TAU * (per_sample * i as f64).fract();
        let (mut c, mut s) = (0.0, 0.0);
        for (i, r) in residual.iter().enumerate() {
            let (sin, cos) = angle(i).sin_cos();
            c += r * cos;
            s += r * sin;
        }
        let size = c.hypot(s).max(1e-300);
        for (i, y) in output.iter_mut().enumerate() {
            let (sin, cos) = angle(i).sin_cos();
            *y += amplitude * (c * cos + s * sin) / size;
        }
    }
}

impl Simulator for BenchSimulator<'_> {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        let simulated: Vec<Simulated> =
            (0..self.runs.len()).map(|r| self.simulate(r, effects)).collect::<Result<_, _>>()?;
        Ok(self
            .channels
            .iter()
            .map(|&(number, kind)| {
                averaged(&self.reading(number, kind, &simulated[number]), self.block)
            })
            .collect())
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
        let line = |(&(number, kind), own): (&(usize, ChannelKind), &Vec<f64>)| {
            let mut line = vec![0.0; own.len()];
            if kind == ChannelKind::Output {
                self.hum(number, (amplitude, frequency_hz), (own, self.block), &mut line);
            }
            line
        };
        Ok(Some(self.channels.iter().zip(residual).map(line).collect()))
    }
}

fn multiply(gain: &mut Option<Vec<f64>>, factors: impl IntoIterator<Item = f64>) {
    match gain {
        Some(gain) => gain.iter_mut().zip(factors).for_each(|(g, f)| *g *= f),
        None => *gain = Some(factors.into_iter().collect()),
    }
}

/// Slope of `y` against `x` by least squares, both about their means; 0 where `x` is constant.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().max(1) as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (mut xy, mut xx) = (0.0, 0.0);
    for (a, b) in x.iter().zip(y) {
        xy += (a - mx) * (b - my);
        xx += (a - mx).powi(2);
    }
    if xx > 0.0 { xy / xx } else { 0.0 }
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

/// Block of the bootstrap: a period where the input has one, else a tenth of the run.
fn block_of(run: &Record, samples: usize) -> usize {
    let tenth = (samples / 10).max(1);
    match model_gap::Stimulus::of(&run.input, run.step_s) {
        model_gap::Stimulus::Sine { frequency_hz, .. } => {
            let period = run.input.len() as f64 * run.step_s * frequency_hz;
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

fn failed(what: &str, error: &preisach_dyn::PreisachError) -> GapError {
    GapError::Simulation { what: what.to_owned(), message: error.to_string() }
}
