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
mod lag_step;
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

use crate::check::{check_not_negative, check_positive};
use crate::{Calibration, PreisachError};
use amplifier::{CurrentStep, DepolarisationStep, HeatStep};
use creep::CreepStep;
use delay::DelayStep;
pub(crate) use linkage::FrictionStep;
use linkage::{AccommodationStep, LoadStep, PlayStep};
use resonance::ResonanceStep;
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

    /// A whole signal through the stage, settled at its first sample and without load: the same
    /// numbers as sample by sample.
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

    /// Whether a memory of this kind of stage is one of this stage.
    fn owns(&self, _memory: &Self::Memory) -> bool {
        true
    }

    /// Factor on the law's output that the present state means.
    fn gain(&self, _memory: &Self::Memory) -> f64 {
        1.0
    }

    /// Takes slow states to where a periodic input will leave them.
    ///
    /// ```text
    /// x(T) = e x(0) + b   =>   x* = (x(T) - e x(0)) / (1 - e),   e = exp(-T / tau)
    /// ```
    /// `e = exp(-way travelled / way)` where a state settles with the way.
    fn settle(&self, _before: &Self::Memory, _now: &mut Self::Memory, _period_s: f64) {}
}

/// The stages that have no memory: an output for every input.
pub(crate) trait Curve {
    /// The output at an input.
    fn value(&self, input: f64) -> f64;
}

impl<C: Curve> Step for C {
    type Memory = ();

    fn start(&self, input: f64) -> ((), f64) {
        ((), self.value(input))
    }

    #[inline]
    fn advance(&self, (): &mut (), input: f64) -> f64 {
        self.value(input)
    }
}

/// The kinds of stages: from a list of names and steps the enum of any step, the enum of any memory,
/// and [`Step`] of the one with the other.
macro_rules! kinds {
    ($($kind:ident($step:ty)),* $(,)?) => {
        /// Any stage made ready for one time step.
        #[derive(Debug, Clone, PartialEq)]
        pub(crate) enum StageStep {
            $($kind($step)),*
        }

        /// What any stage remembers.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub(crate) enum StageMemory {
            $($kind(<$step as Step>::Memory)),*
        }

        impl Step for StageStep {
            type Memory = StageMemory;

            fn start(&self, input: f64) -> (StageMemory, f64) {
                match self {
                    $(Self::$kind(step) => {
                        let (memory, output) = step.start(input);
                        (StageMemory::$kind(memory), output)
                    })*
                }
            }

            /// NaN for a memory of another kind of stage, see [`Step::owns`].
            #[inline]
            fn advance(&self, memory: &mut StageMemory, input: f64) -> f64 {
                match (self, memory) {
                    $((Self::$kind(step), StageMemory::$kind(m)) => step.advance(m, input),)*
                    _ => f64::NAN,
                }
            }

            fn pass(&self, signal: &mut [f64]) {
                match self {
                    $(Self::$kind(step) => step.pass(signal),)*
                }
            }

            fn owns(&self, memory: &StageMemory) -> bool {
                match (self, memory) {
                    $((Self::$kind(step), StageMemory::$kind(m)) => step.owns(m),)*
                    _ => false,
                }
            }

            #[inline]
            fn gain(&self, memory: &StageMemory) -> f64 {
                match (self, memory) {
                    $((Self::$kind(step), StageMemory::$kind(m)) => step.gain(m),)*
                    _ => f64::NAN,
                }
            }

            fn settle(&self, before: &StageMemory, now: &mut StageMemory, period_s: f64) {
                match (self, before, now) {
                    $((Self::$kind(step), StageMemory::$kind(b), StageMemory::$kind(n)) => {
                        step.settle(b, n, period_s);
                    })*
                    _ => {}
                }
            }
        }
    };
}

kinds! {
    CurrentLimit(CurrentStep),
    Saturation(Saturation),
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

impl AmplifierStage {
    /// Name of the stage, as in an actuator file, and what is refused of its parameters.
    pub(crate) fn checked(&self) -> (&'static str, Result<(), PreisachError>) {
        match self {
            Self::Lag(stage) => ("Lag", stage.check()),
            Self::CurrentLimit(stage) => {
                let slew = stage.slew_rate_volt_per_s;
                ("CurrentLimit", check_positive("slew_rate_volt_per_s", slew))
            }
            Self::Saturation(stage) => ("Saturation", stage.check()),
            Self::Delay(stage) => ("Delay", stage.check()),
            Self::DielectricHeating(stage) => ("DielectricHeating", stage.check()),
            Self::Depolarisation(stage) => ("Depolarisation", stage.check()),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64) -> StageStep {
        match self {
            Self::Lag(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::CurrentLimit(stage) => StageStep::CurrentLimit(CurrentStep {
                most_volt: stage.slew_rate_volt_per_s * step_s,
            }),
            Self::Saturation(stage) => StageStep::Saturation(*stage),
            Self::Delay(stage) => StageStep::Delay(DelayStep { delay_s: stage.delay_s, step_s }),
            Self::DielectricHeating(stage) => StageStep::Heating(stage.prepared(step_s)),
            Self::Depolarisation(stage) => StageStep::Depolarisation(stage.prepared(step_s)),
        }
    }
}

impl LinkageStage {
    /// Name of the stage, as in an actuator file, and what is refused of its parameters.
    pub(crate) fn checked(&self) -> (&'static str, Result<(), PreisachError>) {
        match self {
            Self::LogCreep(stage) => ("LogCreep", stage.check()),
            Self::KelvinVoigt(stage) => ("KelvinVoigt", stage.check()),
            Self::Relaxation(stage) => ("Relaxation", stage.check()),
            Self::Accommodation(stage) => ("Accommodation", stage.check()),
            Self::Resonance(stage) => ("Resonance", stage.check()),
            Self::Backlash(stage) => ("Backlash", check_not_negative("width_um", stage.width_um)),
            Self::CoulombFriction(stage) => {
                ("CoulombFriction", check_not_negative("width_um", stage.width_um))
            }
            Self::LoadStiffness(stage) => ("LoadStiffness", stage.check()),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
        let deg = calibration.deg_per_um.abs();
        match self {
            Self::LogCreep(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::KelvinVoigt(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::Relaxation(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::Accommodation(stage) => StageStep::Accommodation(AccommodationStep {
                travel: stage.travel_um * deg,
                share: stage.share,
            }),
            Self::Resonance(stage) => StageStep::Resonance(stage.prepared(step_s)),
            Self::Backlash(stage) => {
                StageStep::Play(PlayStep { half_width: 0.5 * stage.width_um * deg })
            }
            Self::CoulombFriction(stage) => {
                StageStep::Friction(FrictionStep { limit: 0.5 * stage.width_um * deg })
            }
            Self::LoadStiffness(stage) => StageStep::Load(stage.prepared(calibration.deg_per_um)),
        }
    }
}

impl SensorStage {
    /// Name of the stage, as in an actuator file, and what is refused of its parameters.
    pub(crate) fn checked(&self) -> (&'static str, Result<(), PreisachError>) {
        match self {
            Self::Filter(stage) => ("Filter", stage.check()),
            Self::Nonlinearity(stage) => ("Nonlinearity", stage.check()),
            Self::Quantisation(stage) => {
                ("Quantisation", check_not_negative("step_um", stage.step_um))
            }
            Self::Delay(stage) => ("Delay", stage.check()),
            Self::MainsHum(stage) => ("MainsHum", stage.check()),
        }
    }

    pub(crate) fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
        match self {
            Self::Filter(stage) => StageStep::Creep(stage.prepared(step_s)),
            Self::Nonlinearity(stage) => StageStep::Nonlinearity(stage.prepared(calibration)),
            Self::Quantisation(stage) => StageStep::Quantisation(QuantisationStep {
                step_deg: stage.step_um * calibration.deg_per_um.abs(),
            }),
            Self::Delay(stage) => StageStep::Delay(DelayStep { delay_s: stage.delay_s, step_s }),
            Self::MainsHum(stage) => StageStep::Hum(stage.prepared(step_s, calibration)),
        }
    }
}
