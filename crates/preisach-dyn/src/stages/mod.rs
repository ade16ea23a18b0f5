//! The stages around the hysteresis law: amplifier before it, linkage behind it, sensor on the
//! bench.
//!
//! Every stage takes one sample of a signal to the next. Its input is taken as straight between two
//! samples; linear stages are then exact at the samples whatever the step (first-order hold, the
//! matrix exponential in closed form). Volt in the amplifier, degrees of flap angle behind the law;
//! lengths in um are turned into degrees by the actuator's calibration.
//!
//! Source of the first-order hold: G. F. Franklin, J. D. Powell, M. L. Workman, *Digital Control of
//! Dynamic Systems* (1998), section 6.3.

mod amplifier;
mod creep;
mod delay;
mod lag;
mod linkage;
mod relaxation;
mod resonance;
mod sensor;

pub use amplifier::{CurrentLimit, Depolarisation, DielectricHeating, Saturation};
pub use creep::{KelvinVoigt, KelvinVoigtElement, LogCreep};
pub use delay::Delay;
pub use lag::Lag;
pub use linkage::{Accommodation, Backlash, CoulombFriction, LoadStiffness};
pub use relaxation::{Relaxation, RelaxationElement};
pub use resonance::Resonance;
pub use sensor::{MainsHum, Nonlinearity, NonlinearityShape, Quantisation};

use crate::{Calibration, PreisachError};
use amplifier::{
    CurrentStep, DepolarisationStep, HeatMemory, HeatStep, LimitMemory, LossMemory, SaturationStep,
};
use creep::{CreepMemory, CreepStep};
use delay::{DelayMemory, DelayStep};
use lag::{LagMemory, LagStep};
pub(crate) use linkage::FrictionStep;
use linkage::{AccommodationStep, LoadStep, PlayStep, WayMemory};
use resonance::{ResonanceMemory, ResonanceStep};
use sensor::{HumStep, NonlinearityStep, QuantisationStep};
use serde::{Deserialize, Serialize};

/// A stage between the command and the terminals of the actuator. Signal: V.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum AmplifierStage {
    /// First-order lag of amplifier and capacitance.
    Lag(Lag),
    /// Slew limit: a current limit into a capacitance.
    CurrentLimit(CurrentLimit),
    /// Voltage limits.
    Saturation(Saturation),
    /// Transport delay.
    Delay(Delay),
    /// Warming by dielectric loss, which raises the gain of the law.
    DielectricHeating(DielectricHeating),
    /// Loss of polarisation under reverse voltage, which lowers the gain of the law.
    Depolarisation(Depolarisation),
}

/// A stage between the law and what the rotor sees. Signal: flap angle, deg.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LinkageStage {
    /// Creep along the logarithm of time.
    LogCreep(LogCreep),
    /// Creep as a chain of Kelvin-Voigt elements.
    KelvinVoigt(KelvinVoigt),
    /// A distribution of relaxation times.
    Relaxation(Relaxation),
    /// A share that settles with the way travelled.
    Accommodation(Accommodation),
    /// One mechanical mode.
    Resonance(Resonance),
    /// Lost motion.
    Backlash(Backlash),
    /// Dry friction against an elastic linkage.
    CoulombFriction(CoulombFriction),
    /// A load spring and an external load.
    LoadStiffness(LoadStiffness),
}

/// A stage between the flap and the bench record. Signal: flap angle, deg. The rotor never sees it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum SensorStage {
    /// First-order low-pass filter.
    Filter(Lag),
    /// Polynomial error of the characteristic.
    Nonlinearity(Nonlinearity),
    /// Rounding to whole steps.
    Quantisation(Quantisation),
    /// Transport delay.
    Delay(Delay),
    /// A line at mains frequency.
    MainsHum(MainsHum),
}

/// A stage made ready for one time step.
pub(crate) trait Step {
    /// What the stage remembers.
    type Memory;

    /// The stage settled at an input, and its output there.
    fn start(&self, input: f64) -> (Self::Memory, f64);

    /// One sample on.
    fn advance(&self, memory: &mut Self::Memory, input: f64) -> f64;

    /// A whole signal through the stage, settled at its first sample: the same numbers as sample by
    /// sample.
    fn pass(&self, signal: &mut [f64]) {
        let Some((first, rest)) = signal.split_first_mut() else {
            return;
        };
        let (mut memory, output) = self.start(*first);
        *first = output;
        for value in rest {
            *value = self.advance(&mut memory, *value);
        }
    }
}

/// Any stage made ready for one time step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum StageStep {
    Lag(LagStep),
    CurrentLimit(CurrentStep),
    Saturation(SaturationStep),
    Delay(DelayStep),
    Heating(HeatStep),
    Depolarisation(DepolarisationStep),
    Creep(CreepStep),
    Resonance(ResonanceStep),
    Play(PlayStep),
    Friction(FrictionStep),
    Accommodation(AccommodationStep),
    Load(LoadStep),
    Nonlinearity(NonlinearityStep),
    Quantisation(QuantisationStep),
    Hum(HumStep),
}

/// What any stage remembers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum StageMemory {
    Lag(LagMemory),
    CurrentLimit(LimitMemory),
    Saturation(()),
    Delay(DelayMemory),
    Heating(HeatMemory),
    Depolarisation(LossMemory),
    Creep(CreepMemory),
    Resonance(ResonanceMemory),
    Play(f64),
    Friction(WayMemory),
    Accommodation(WayMemory),
    Load(()),
    Nonlinearity(()),
    Quantisation(()),
    Hum(f64),
}

/// Runs the same expression for a stage and the memory that belongs to it.
macro_rules! paired {
    ($step:expr, $memory:expr, ($s:ident, $m:ident) => $body:expr, else $otherwise:expr) => {
        match ($step, $memory) {
            (StageStep::Lag($s), StageMemory::Lag($m)) => $body,
            (StageStep::CurrentLimit($s), StageMemory::CurrentLimit($m)) => $body,
            (StageStep::Saturation($s), StageMemory::Saturation($m)) => $body,
            (StageStep::Delay($s), StageMemory::Delay($m)) => $body,
            (StageStep::Heating($s), StageMemory::Heating($m)) => $body,
            (StageStep::Depolarisation($s), StageMemory::Depolarisation($m)) => $body,
            (StageStep::Creep($s), StageMemory::Creep($m)) => $body,
            (StageStep::Resonance($s), StageMemory::Resonance($m)) => $body,
            (StageStep::Play($s), StageMemory::Play($m)) => $body,
            (StageStep::Friction($s), StageMemory::Friction($m)) => $body,
            (StageStep::Accommodation($s), StageMemory::Accommodation($m)) => $body,
            (StageStep::Load($s), StageMemory::Load($m)) => $body,
            (StageStep::Nonlinearity($s), StageMemory::Nonlinearity($m)) => $body,
            (StageStep::Quantisation($s), StageMemory::Quantisation($m)) => $body,
            (StageStep::Hum($s), StageMemory::Hum($m)) => $body,
            _ => $otherwise,
        }
    };
}

impl StageStep {
    /// The stage settled at an input, and its output there.
    pub(crate) fn start(&self, input: f64) -> (StageMemory, f64) {
        macro_rules! started {
            ($($name:ident),*) => {
                match self {
                    $(Self::$name(step) => {
                        let (memory, output) = step.start(input);
                        (StageMemory::$name(memory), output)
                    })*
                }
            };
        }
        started!(
            Lag,
            CurrentLimit,
            Saturation,
            Delay,
            Heating,
            Depolarisation,
            Creep,
            Resonance,
            Play,
            Friction,
            Accommodation,
            Load,
            Nonlinearity,
            Quantisation,
            Hum
        )
    }

    /// One sample on; NaN for a memory of another kind of stage, see [`Self::owns`].
    #[inline]
    pub(crate) fn advance(&self, memory: &mut StageMemory, input: f64) -> f64 {
        paired!(self, memory, (step, memory) => step.advance(memory, input), else f64::NAN)
    }

    /// A whole signal through the stage, settled at its first sample and without load: the same
    /// numbers as sample by sample.
    pub(crate) fn pass(&self, signal: &mut [f64]) {
        match self {
            Self::Lag(step) => step.pass(signal),
            Self::CurrentLimit(step) => step.pass(signal),
            Self::Saturation(step) => step.pass(signal),
            Self::Delay(step) => step.pass(signal),
            Self::Heating(step) => step.pass(signal),
            Self::Depolarisation(step) => step.pass(signal),
            Self::Creep(step) => step.pass(signal),
            Self::Resonance(step) => step.pass(signal),
            Self::Play(step) => step.pass(signal),
            Self::Friction(step) => step.pass(signal),
            Self::Accommodation(step) => step.pass(signal),
            Self::Load(step) => step.pass(signal),
            Self::Nonlinearity(step) => step.pass(signal),
            Self::Quantisation(step) => step.pass(signal),
            Self::Hum(step) => step.pass(signal),
        }
    }

    /// Whether a memory is one of this kind of stage.
    pub(crate) fn owns(&self, memory: &StageMemory) -> bool {
        if let (Self::Creep(step), StageMemory::Creep(memory)) = (self, memory) {
            return step.owns(memory);
        }
        paired!(self, memory, (_step, _memory) => true, else false)
    }

    /// Factor on the law's output that the stage's present state means: 1 but for heating and
    /// depolarisation.
    #[inline]
    pub(crate) fn gain(&self, memory: &StageMemory) -> f64 {
        match (self, memory) {
            (Self::Heating(step), StageMemory::Heating(memory)) => step.gain(memory),
            (Self::Depolarisation(_), StageMemory::Depolarisation(memory)) => {
                DepolarisationStep::gain(memory)
            }
            _ => 1.0,
        }
    }

    /// Takes slow states to where a periodic input will leave them.
    ///
    /// ```text
    /// x(T) = e x(0) + b   =>   x* = (x(T) - e x(0)) / (1 - e),   e = exp(-T / tau)
    /// ```
    /// `e = exp(-way travelled / way)` where a state settles with the way.
    pub(crate) fn settle(&self, before: &StageMemory, now: &mut StageMemory, period_s: f64) {
        match (self, before, now) {
            (Self::Lag(step), StageMemory::Lag(before), StageMemory::Lag(now)) => {
                now.deviation = step.settled(before.deviation, now.deviation, period_s);
            }
            (Self::Heating(step), StageMemory::Heating(before), StageMemory::Heating(now)) => {
                now.settle(before, step, period_s);
            }
            (
                Self::Depolarisation(_),
                StageMemory::Depolarisation(before),
                StageMemory::Depolarisation(now),
            ) => now.settle(before),
            (Self::Creep(step), StageMemory::Creep(before), StageMemory::Creep(now)) => {
                step.settle(before, now, period_s);
            }
            (Self::Friction(step), StageMemory::Friction(before), StageMemory::Friction(now)) => {
                step.settle(before, now);
            }
            (
                Self::Accommodation(step),
                StageMemory::Accommodation(before),
                StageMemory::Accommodation(now),
            ) => step.settle(before, now),
            _ => {}
        }
    }
}

impl AmplifierStage {
    /// Name of the stage, as in an actuator file.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Lag(_) => "Lag",
            Self::CurrentLimit(_) => "CurrentLimit",
            Self::Saturation(_) => "Saturation",
            Self::Delay(_) => "Delay",
            Self::DielectricHeating(_) => "DielectricHeating",
            Self::Depolarisation(_) => "Depolarisation",
        }
    }

    /// Refuses parameters outside their ranges.
    pub(crate) fn check(&self) -> Result<(), PreisachError> {
        match self {
            Self::Lag(stage) => stage.check(),
            Self::CurrentLimit(stage) => stage.check(),
            Self::Saturation(stage) => stage.check(),
            Self::Delay(stage) => stage.check(),
            Self::DielectricHeating(stage) => stage.check(),
            Self::Depolarisation(stage) => stage.check(),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64) -> StageStep {
        match self {
            Self::Lag(stage) => StageStep::Lag(LagStep::new(stage.tau_s, step_s)),
            Self::CurrentLimit(stage) => StageStep::CurrentLimit(stage.prepared(step_s)),
            Self::Saturation(stage) => StageStep::Saturation(stage.prepared()),
            Self::Delay(stage) => StageStep::Delay(stage.prepared(step_s)),
            Self::DielectricHeating(stage) => StageStep::Heating(stage.prepared(step_s)),
            Self::Depolarisation(stage) => StageStep::Depolarisation(stage.prepared(step_s)),
        }
    }
}

impl LinkageStage {
    /// Name of the stage, as in an actuator file.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::LogCreep(_) => "LogCreep",
            Self::KelvinVoigt(_) => "KelvinVoigt",
            Self::Relaxation(_) => "Relaxation",
            Self::Accommodation(_) => "Accommodation",
            Self::Resonance(_) => "Resonance",
            Self::Backlash(_) => "Backlash",
            Self::CoulombFriction(_) => "CoulombFriction",
            Self::LoadStiffness(_) => "LoadStiffness",
        }
    }

    /// Refuses parameters outside their ranges.
    pub(crate) fn check(&self) -> Result<(), PreisachError> {
        match self {
            Self::LogCreep(stage) => stage.check(),
            Self::KelvinVoigt(stage) => stage.check(),
            Self::Relaxation(stage) => stage.check(),
            Self::Accommodation(stage) => stage.check(),
            Self::Resonance(stage) => stage.check(),
            Self::Backlash(stage) => stage.check(),
            Self::CoulombFriction(stage) => stage.check(),
            Self::LoadStiffness(stage) => stage.check(),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
        let deg = calibration.deg_per_um.abs();
        match self {
            Self::LogCreep(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::KelvinVoigt(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::Relaxation(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::Accommodation(stage) => {
                StageStep::Accommodation(AccommodationStep::new(stage.travel_um * deg, stage.share))
            }
            Self::Resonance(stage) => StageStep::Resonance(stage.prepared(step_s)),
            Self::Backlash(stage) => StageStep::Play(PlayStep::new(0.5 * stage.width_um * deg)),
            Self::CoulombFriction(stage) => {
                StageStep::Friction(FrictionStep::new(0.5 * stage.width_um * deg))
            }
            Self::LoadStiffness(stage) => StageStep::Load(stage.prepared(calibration.deg_per_um)),
        }
    }
}

impl SensorStage {
    /// Name of the stage, as in an actuator file.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Filter(_) => "Filter",
            Self::Nonlinearity(_) => "Nonlinearity",
            Self::Quantisation(_) => "Quantisation",
            Self::Delay(_) => "Delay",
            Self::MainsHum(_) => "MainsHum",
        }
    }

    /// Refuses parameters outside their ranges.
    pub(crate) fn check(&self) -> Result<(), PreisachError> {
        match self {
            Self::Filter(stage) => stage.check(),
            Self::Nonlinearity(stage) => stage.check(),
            Self::Quantisation(stage) => stage.check(),
            Self::Delay(stage) => stage.check(),
            Self::MainsHum(stage) => stage.check(),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
        match self {
            Self::Filter(stage) => StageStep::Lag(LagStep::new(stage.tau_s, step_s)),
            Self::Nonlinearity(stage) => StageStep::Nonlinearity(stage.prepared(calibration)),
            Self::Quantisation(stage) => StageStep::Quantisation(stage.prepared(calibration)),
            Self::Delay(stage) => StageStep::Delay(stage.prepared(step_s)),
            Self::MainsHum(stage) => StageStep::Hum(stage.prepared(step_s, calibration)),
        }
    }
}
