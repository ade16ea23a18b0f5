//! Any stage: as an actuator file holds it, one enum each for amplifier, linkage and sensor, and made ready for one time
//! step.

use crate::amplifier::{CurrentStep, DepolarisationStep, HeatStep};
use crate::check::{check_not_negative, check_positive};
use crate::creep::CreepStep;
use crate::delay::DelayStep;
use crate::linkage::{AccommodationStep, LoadStep, PlayStep};
use crate::resonance::ResonanceStep;
use crate::sensor::{HumStep, NonlinearityStep, QuantisationStep};
use crate::{
    Accommodation, Backlash, Calibration, CoulombFriction, CurrentLimit, Delay, Depolarisation,
    DielectricHeating, FrictionStep, KelvinVoigt, Lag, LoadStiffness, LogCreep, MainsHum,
    Nonlinearity, Quantisation, Relaxation, Resonance, Saturation, StageError, Step,
};
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

/// The kinds of stages: from a list of names and steps the enum of any step, the enum of any memory,
/// and [`Step`] of the one with the other.
macro_rules! kinds {
    ($($kind:ident($step:ty)),* $(,)?) => {
        /// Any stage made ready for one time step.
        #[derive(Debug, Clone, PartialEq)]
        pub enum StageStep {
            $(#[doc = concat!("[`", stringify!($step), "`].")] $kind($step)),*
        }

        /// What any stage remembers.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub enum StageMemory {
            $(#[doc = concat!("What [`", stringify!($step), "`] remembers.")] $kind(<$step as Step>::Memory)),*
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
    pub fn checked(&self) -> (&'static str, Result<(), StageError>) {
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

    /// The stage made ready for samples `step_s` apart, `> 0`.
    pub fn prepared(&self, step_s: f64) -> StageStep {
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
    pub fn checked(&self) -> (&'static str, Result<(), StageError>) {
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

    /// The stage made ready for samples `step_s` apart, `> 0`; lengths in um become degrees by the calibration.
    pub fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
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
                StageStep::Friction(FrictionStep::new(0.5 * stage.width_um * deg))
            }
            Self::LoadStiffness(stage) => StageStep::Load(stage.prepared(calibration.deg_per_um)),
        }
    }
}

impl SensorStage {
    /// Name of the stage, as in an actuator file, and what is refused of its parameters.
    pub fn checked(&self) -> (&'static str, Result<(), StageError>) {
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

    /// The stage made ready for samples `step_s` apart, `> 0`; lengths in um become degrees by the calibration.
    pub fn prepared(&self, step_s: f64, calibration: &Calibration) -> StageStep {
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
