//! Stages made ready for one time step: what all of them do, and any of them as one enum.

use crate::Saturation;
use crate::amplifier::{CurrentStep, DepolarisationStep, HeatStep};
use crate::creep::CreepStep;
use crate::delay::DelayStep;
use crate::linkage::{AccommodationStep, FrictionStep, LoadStep, PlayStep};
use crate::resonance::ResonanceStep;
use crate::sensor::{HumStep, NonlinearityStep, QuantisationStep};
use serde::{Deserialize, Serialize};

/// A stage made ready for one time step.
pub trait Step {
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
pub trait Curve {
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
        pub enum StageStep {
            $(#[doc = concat!("A [`", stringify!($step), "`].")] $kind($step)),*
        }

        /// What any stage remembers.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub enum StageMemory {
            $(#[doc = concat!("Memory of a [`", stringify!($step), "`].")] $kind(<$step as Step>::Memory)),*
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
