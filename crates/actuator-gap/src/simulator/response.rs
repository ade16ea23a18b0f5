//! The runs under effects, stage by stage.
//!
//! What the front and the rear of a [`Chain`] make of the runs is kept for a while: a search that moves a stage
//! of the rear simulates the rear alone. Hum is added to the output of all others.

use super::smooth::{Smooth, Weights, turning};
use crate::base::BaseModel;
use crate::causes::{
    BenchCause, Chain, Command, FrontStages, Loops, Rate, RearStages, chain_under, looped,
    rate_dependent,
};
use crate::numbers::{less, slope};
use crate::plays::behind_lags;
use crate::record::Record;
use model_gap::{Effect, GapError, Memo};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, BenchSimulation, Calibration, DielectricHeating,
    Drive, LinearGain, LinkageStage, LogCreep, MainsHum, Resonance, SensorStage, VoltageRange,
};
use std::sync::Arc;

/// Fronts and responses kept; each holds two or three signals of all samples.
const KEPT: usize = 6;

/// Part of half the sampling frequency up to which samples carry a mode.
const CARRIED: f64 = 0.8;

/// Chords for each step of a relaxation.
const FINER: u32 = 4;

/// A signal on every run.
type OnRuns = Arc<Vec<Vec<f64>>>;

/// What has passed the law, on every run.
#[derive(Debug)]
pub(super) struct Front {
    /// Terminal voltage; none where it is the command.
    pub(super) terminals: Vec<Option<Vec<f64>>>,
    /// Temperature rise; none where nothing warms.
    pub(super) rises_k: Vec<Option<Vec<f64>>>,
    outputs: OnRuns,
}

/// Signals of all runs under effects.
pub(super) struct Response {
    pub(super) front: Arc<Front>,
    pub(super) outputs: OnRuns,
    /// Outputs without the hum of their reading.
    pub(super) steady: OnRuns,
    /// Whether a load spring is among the effects.
    pub(super) is_loaded: bool,
    /// What the voltage monitor makes of the terminal voltage, where it is not what it was.
    pub(super) monitor: Option<Command>,
}

/// The base model on runs, with the stages of causes.
pub(super) struct Plant<'a> {
    base: &'a BaseModel,
    runs: Vec<&'a Record>,
    causes: &'a [BenchCause],
    /// Output of the base's static part, and behind its relaxation, on the plain command.
    laws: Vec<Vec<f64>>,
    pub(super) plain: OnRuns,
    /// How smooth commands and plain outputs are: most candidates act on one of them.
    commands: Vec<Weights>,
    plain_outputs: Vec<Weights>,
    /// The law at rest at 0 V, and in the middle of the range.
    neutral: (f64, f64),
    /// Stages that only see signals: any value may pass.
    wide: VoltageRange,
    fronts: Memo<FrontStages, Front>,
    rears: Memo<(FrontStages, RearStages), OnRuns>,
}

impl<'a> Plant<'a> {
    pub(super) fn new(
        base: &'a BaseModel,
        runs: Vec<&'a Record>,
        causes: &'a [BenchCause],
        range: (f64, f64),
    ) -> Result<Self, GapError> {
        let laws: Vec<Vec<f64>> = runs.iter().map(|r| base.hysteresis(&r.input)).collect();
        let plain: Vec<Vec<f64>> =
            runs.iter().zip(&laws).map(|(r, law)| base.relaxed(law, r.step_s)).collect();
        let at = |volt: f64| base.hysteresis(&[volt]).first().copied().unwrap_or_default();
        Ok(Self {
            base,
            commands: runs.iter().map(|r| Smooth::weights(&r.input)).collect(),
            plain_outputs: plain.iter().map(|y| Smooth::weights(y)).collect(),
            neutral: (at(0.0), at(f64::midpoint(range.0, range.1))),
            wide: VoltageRange::new(-1e9, 1e9).map_err(|e| failed("the range of signals", &e))?,
            fronts: Memo::new(KEPT),
            rears: Memo::new(KEPT),
            runs,
            causes,
            laws,
            plain: Arc::new(plain),
        })
    }

    /// All runs under effects. The phase of a hum is what the measured output asks for beside the other
    /// effects.
    pub(super) fn respond(&self, effects: &[Effect]) -> Result<Response, GapError> {
        let Chain { front: stages, mut rear, monitor } = chain_under(self.causes, effects);
        let hum = rear.take_hum();
        let front = self.fronts.get(stages.clone(), || self.front(&stages))?;
        let is_loaded = rear.linkage.iter().any(|s| matches!(s, LinkageStage::LoadStiffness(_)));
        let make = || self.rear(&front, &rear);
        let steady = Arc::clone(&*self.rears.get((stages, rear.clone()), make)?);
        let outputs = match hum {
            Some(hum) => {
                let pairs = self.runs.iter().zip(steady.iter());
                Arc::new(pairs.map(|(run, output)| humming(run, output, hum)).collect())
            }
            None => Arc::clone(&steady),
        };
        Ok(Response { front, outputs, steady, is_loaded, monitor })
    }

    fn front(&self, stages: &FrontStages) -> Result<Front, GapError> {
        let count = self.runs.len();
        if *stages == FrontStages::default() {
            let none = || vec![None; count];
            let outputs = Arc::clone(&self.plain);
            return Ok(Front { terminals: none(), rises_k: none(), outputs });
        }
        let (mut terminals, mut rises_k, mut outputs) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..count {
            let run = self.runs[number];
            let mut terminal: Option<Vec<f64>> =
                stages.command.map(|command| run.input.iter().map(|u| command.of(*u)).collect());
            if let Some(late_s) = stages.late_s {
                let known = terminal.is_none().then(|| &self.commands[number]);
                let input = terminal.as_deref().unwrap_or(&run.input);
                terminal = Some(Smooth::new(input, known).late_by(late_s / run.step_s));
            }
            for stage in stages.amplifier.iter().filter(|stage| !acts_on_gain(stage)) {
                let input = terminal.as_deref().unwrap_or(&run.input);
                terminal = Some(match stage {
                    AmplifierStage::Lag(lag) => {
                        let known = terminal.is_none().then(|| &self.commands[number]);
                        Smooth::new(input, known).lagged(lag.tau_s, run.step_s)
                    }
                    other => {
                        self.through(|own| own.amplifier.push(*other), input, run)?.terminal_volt
                    }
                });
            }
            let mut law = match &terminal {
                Some(volt) => self.base.hysteresis(volt),
                None => self.laws[number].clone(),
            };
            let volt = terminal.as_deref().unwrap_or(&run.input);
            rises_k.push(self.ceramic(number, stages, volt, &mut law)?);
            outputs.push(self.base.relaxed(&law, run.step_s));
            terminals.push(terminal);
        }
        Ok(Front { terminals, rises_k, outputs: Arc::new(outputs) })
    }

    /// What gain and rate make of the law's output; returns the temperature rise if anything warms.
    fn ceramic(
        &self,
        number: usize,
        stages: &FrontStages,
        volt: &[f64],
        law: &mut Vec<f64>,
    ) -> Result<Option<Vec<f64>>, GapError> {
        let (zero, middle) = self.neutral;
        let step_s = self.runs[number].step_s;
        if let Some(Loops { share, widest }) = stages.loops {
            *law = looped(law, share, widest);
        }
        let mut rise_k = None;
        let scale = |law: &mut [f64], about: f64, gain: &mut dyn Iterator<Item = f64>| {
            let point = zero + about * (middle - zero);
            for (y, g) in law.iter_mut().zip(gain) {
                *y = point + g * (*y - point);
            }
        };
        for stage in &stages.amplifier {
            match stage {
                AmplifierStage::DielectricHeating(stage) => {
                    let (rise, factor) = self.heated(number, *stage, volt)?;
                    let gain = |t: &f64| 1.0 + stage.coefficient_per_k * t * factor;
                    scale(law, stages.heat_about, &mut rise.iter().map(gain));
                    rise_k = Some(rise.iter().map(|t| t * factor).collect());
                }
                AmplifierStage::Depolarisation(stage) => {
                    scale(law, stages.loss_about, &mut stage.gains(volt, step_s).into_iter());
                }
                _ => {}
            }
        }
        if let Some(Rate { tau_s, position }) = stages.rate {
            let place = (middle, self.base.spread);
            // the relaxation time follows the state: no closed form for a curved input, so short chords
            let fine = Smooth::new(law, None).refined(FINER);
            let late = rate_dependent(&fine, tau_s, position, place, step_s / f64::from(FINER));
            *law = late.into_iter().step_by(FINER as usize).collect();
        }
        Ok(rise_k)
    }

    fn rear(&self, front: &Front, stages: &RearStages) -> Result<OnRuns, GapError> {
        if *stages == RearStages::default() {
            return Ok(Arc::clone(&front.outputs));
        }
        let mut outputs = Vec::with_capacity(self.runs.len());
        let is_plain = Arc::ptr_eq(&front.outputs, &self.plain);
        for (number, (run, output)) in self.runs.iter().zip(front.outputs.iter()).enumerate() {
            let mut known = is_plain.then(|| &self.plain_outputs[number]);
            let mut signal = output.clone();
            let has_play = |stage: &&LinkageStage| matches!(stage, LinkageStage::Backlash(_));
            for stage in stages.linkage.iter().filter(|s| !(run.is_preloaded() && has_play(s))) {
                let known = known.take();
                signal = match stage {
                    LinkageStage::Resonance(mode) if mode.damping_ratio < 1.0 => {
                        ringing(&signal, known, *mode, run.step_s)
                    }
                    LinkageStage::LogCreep(creep) => crept(&signal, creep, run.step_s),
                    LinkageStage::Backlash(_) | LinkageStage::CoulombFriction(_) => {
                        // a joint feels how far the motion goes, between two samples too
                        let (numbers, turned): (Vec<_>, Vec<f64>) = turning(&signal).unzip();
                        let add = |own: &mut ActuatorModel| own.linkage.push(stage.clone());
                        let passed = self.through(add, &turned, run)?.measured_deg;
                        numbers.iter().zip(passed).filter_map(|(own, y)| own.map(|_| y)).collect()
                    }
                    other => {
                        let add = |own: &mut ActuatorModel| own.linkage.push(other.clone());
                        self.through(add, &signal, run)?.measured_deg
                    }
                };
            }
            if !run.has_ideal_sensor() {
                for stage in &stages.sensor {
                    let known = known.take();
                    signal = match stage {
                        SensorStage::Filter(lag) => {
                            Smooth::new(&signal, known).lagged(lag.tau_s, run.step_s)
                        }
                        SensorStage::Delay(delay) => {
                            Smooth::new(&signal, known).late_by(delay.delay_s / run.step_s)
                        }
                        other => {
                            let add = |own: &mut ActuatorModel| own.sensor.push(*other);
                            self.through(add, &signal, run)?.measured_deg
                        }
                    };
                }
                for reading in &stages.readings {
                    signal = reading.of(&signal, run.step_s);
                }
            }
            outputs.push(signal);
        }
        Ok(Arc::new(outputs))
    }

    /// A signal through added stages alone: a law of gain 1 between them, degrees standing for the output's unit.
    fn through(
        &self,
        add: impl FnOnce(&mut ActuatorModel),
        signal: &[f64],
        run: &Record,
    ) -> Result<BenchSimulation, GapError> {
        let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 1.0, bias_volt: 0.0 });
        let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
        let mut model = ActuatorModel::new(law, self.wide, calibration);
        add(&mut model);
        let drive = Drive::new(signal, run.step_s);
        model.simulate_bench(&drive).map_err(|e| failed(&run.id, &e))
    }

    /// The temperature rise of a heating stage, K, and the factor that a thermometer sets it right by.
    fn heated(
        &self,
        number: usize,
        stage: DielectricHeating,
        volt: &[f64],
    ) -> Result<(Vec<f64>, f64), GapError> {
        let run = self.runs[number];
        let heating = AmplifierStage::DielectricHeating(stage);
        let rise = self.through(|own| own.amplifier.push(heating), volt, run)?.temperature_k;
        let factor = run.temperature.as_ref().map_or(1.0, |measured| slope(&rise, measured));
        Ok((rise, factor.max(0.0)))
    }
}

/// The reading of an output with hum of the phase that the measured output asks for.
fn humming(run: &Record, output: &[f64], hum: MainsHum) -> Vec<f64> {
    let mut read = output.to_vec();
    if !run.has_ideal_sensor() {
        let residual = less(run.judged_output(), run.judged(output));
        let line = line(hum.amplitude_um, hum.frequency_hz * run.step_s, &residual);
        // where nothing is judged there is no hum to tell
        read.iter_mut().skip(run.window.start).zip(line).for_each(|(y, hum)| *y += hum);
    }
    read
}

/// Highest frequency of a mode that samples so far apart carry.
pub(super) fn highest_mode_hz(step_s: f64) -> f64 {
    CARRIED * 0.5 / step_s
}

/// What a mode makes of a signal, as far as its samples carry the mode.
///
/// From [`highest_mode_hz`] on its ringing is taken out, at half the sampling frequency all of it: where between two
/// samples a step begins decides how the mode rings, and no sample tells.
fn ringing(signal: &[f64], known: Option<&Weights>, mode: Resonance, step_s: f64) -> Vec<f64> {
    let nyquist_hz = 0.5 / step_s;
    let beyond = nyquist_hz - highest_mode_hz(step_s);
    let share = ((nyquist_hz - mode.frequency_hz) / beyond).clamp(0.0, 1.0);
    if share == 0.0 {
        return signal.to_vec();
    }
    let smooth = Smooth::new(signal, known);
    let through = smooth.through_mode(mode.frequency_hz, mode.damping_ratio, step_s);
    through.iter().zip(signal).map(|(y, x)| x + share * (y - x)).collect()
}

/// A signal with its creep, `u + sum_i w_i (lag_i[u] - u_start)`.
fn crept(signal: &[f64], creep: &LogCreep, step_s: f64) -> Vec<f64> {
    let lags = creep.lags();
    let whole: f64 = lags.iter().map(|(weight, _)| weight).sum();
    let start = signal.first().copied().unwrap_or_default();
    let mut output =
        behind_lags(signal, lags.into_iter().map(|(weight, tau_s)| (tau_s, weight)), step_s);
    for (y, u) in output.iter_mut().zip(signal) {
        *y += whole * (u - start);
    }
    output
}

/// Whether a stage acts on the gain of the law and not on the voltage before it.
fn acts_on_gain(stage: &AmplifierStage) -> bool {
    matches!(stage, AmplifierStage::DielectricHeating(_) | AmplifierStage::Depolarisation(_))
}

/// Samples after which the turning of a line begins anew, so that its rounding does not grow.
const TURNED: usize = 64;

/// Cosine and sine at every sample of a line of a number of turns per sample.
fn waves(turns_per_sample: f64, samples: usize) -> Vec<(f64, f64)> {
    let step = std::f64::consts::TAU * turns_per_sample.fract();
    let (sin, cos) = step.sin_cos();
    let mut all = Vec::with_capacity(samples);
    let (mut s, mut c) = (0.0, 1.0);
    for i in 0..samples {
        if i % TURNED == 0 {
            (s, c) = (std::f64::consts::TAU * (turns_per_sample * i as f64).fract()).sin_cos();
        }
        all.push((c, s));
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
    all
}

/// A line of an amplitude and a number of turns per sample, with the phase that a residual asks for.
pub(super) fn line(amplitude: f64, turns_per_sample: f64, residual: &[f64]) -> Vec<f64> {
    let waves = waves(turns_per_sample, residual.len());
    let (mut s, mut c) = (0.0, 0.0);
    for (r, (cos, sin)) in residual.iter().zip(&waves) {
        s += r * sin;
        c += r * cos;
    }
    let size = amplitude / c.hypot(s).max(1e-300);
    waves.iter().map(|(cos, sin)| size * (c * cos + s * sin)).collect()
}

fn failed(what: &str, error: &preisach_dyn::PreisachError) -> GapError {
    GapError::Simulation { what: what.to_owned(), message: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_line_turned_on_sample_by_sample_is_that_of_its_angles() {
        let waves = waves(0.050_013_7, 20_000);
        for (i, (cos, sin)) in waves.iter().enumerate() {
            let angle = std::f64::consts::TAU * (0.050_013_7 * i as f64).fract();
            assert_abs_diff_eq!(*cos, angle.cos(), epsilon = 1e-12);
            assert_abs_diff_eq!(*sin, angle.sin(), epsilon = 1e-12);
        }
    }

    #[test]
    fn a_line_has_the_phase_that_the_residual_asks_for() {
        let wave = |i: u32| (0.31 * f64::from(i) + 0.8).sin();
        let residual: Vec<f64> = (0..5000).map(|i| 3.0 * wave(i)).collect();
        let found = line(0.7, 0.31 / std::f64::consts::TAU, &residual);
        for (i, y) in (0..).zip(&found) {
            assert_abs_diff_eq!(*y, 0.7 * wave(i), epsilon = 1e-3);
        }
    }

    #[test]
    fn the_creep_in_lags_side_by_side_is_that_of_the_stage() {
        let input: Vec<f64> =
            (0..3000).map(|i| 3.0 + (0.01 * f64::from(i)).sin() + f64::from(i / 1000)).collect();
        let creep = LogCreep { rate_per_decade: 0.03, from_s: 0.02, to_s: 1000.0 };
        let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 1.0, bias_volt: 0.0 });
        let wide = VoltageRange::new(-10.0, 10.0).expect("a range");
        let unit = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
        let mut model = ActuatorModel::new(law, wide, unit);
        model.linkage = vec![LinkageStage::LogCreep(creep)];
        let staged = model.simulate_bench(&Drive::new(&input, 2e-3)).expect("in range");
        for (own, y) in crept(&input, &creep, 2e-3).iter().zip(&staged.measured_deg) {
            assert_abs_diff_eq!(*own, *y, epsilon = 1e-12);
        }
    }

    /// A step rings where the mode is sampled finely, and passes where it rings between the samples.
    #[test]
    fn a_mode_rings_where_samples_carry_it() {
        let step: Vec<f64> = (0..200).map(|i| if i < 20 { 0.0 } else { 1.0 }).collect();
        let mode = Resonance { frequency_hz: 190.0, damping_ratio: 0.03 };
        let overshoot = |step_s: f64| {
            ringing(&step, None, mode, step_s).iter().fold(0.0_f64, |most, y| most.max(*y - 1.0))
        };
        assert!(overshoot(5e-4) > 0.5, "{}", overshoot(5e-4));
        assert!(overshoot(4e-3) <= 0.0, "{}", overshoot(4e-3));
        // in between it fades: no jump where a fit moves the mode past what a run carries
        let near = |hz: f64| {
            let mode = Resonance { frequency_hz: hz, ..mode };
            ringing(&step, None, mode, 2e-3).iter().map(|y| (y - 1.0).abs()).fold(0.0, f64::max)
        };
        assert!((near(199.9) - near(200.1)).abs() < 0.02 && near(251.0) <= 1.0);
    }
}
