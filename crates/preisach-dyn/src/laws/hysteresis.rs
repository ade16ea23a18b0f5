//! What any law between voltage and free flap angle can do; the linear gain.

use crate::{PreisachError, StartState};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// What happened to the steps of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StepCounts {
    /// Steps taken.
    pub steps: usize,
    /// Steps with `G1 >= 0`, where the actuator would run away if the voltage were held.
    pub g1_not_negative: usize,
    /// Steps with a negative discriminant, where `d = b / (2 G2)` was taken.
    pub folds: usize,
}

impl StepCounts {
    /// Steps that were not solved as equation (5) intends.
    pub fn bad_steps(&self) -> usize {
        self.g1_not_negative + self.folds
    }

    /// What was counted since an earlier reading.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self {
            steps: self.steps - earlier.steps,
            g1_not_negative: self.g1_not_negative - earlier.g1_not_negative,
            folds: self.folds - earlier.folds,
        }
    }
}

/// A law with memory between a voltage (V) and an output (deg of equivalent flap angle).
///
/// The law itself never changes; everything that does is in its `Memory`. Both can be stored: a
/// memory written out, read back and continued gives the same bits as one never stored, provided
/// the file keeps all digits of its numbers.
///
/// Voltages must be finite, time steps positive; the callers in [`crate::ActuatorModel`] check it.
pub trait HysteresisLaw: Clone + Debug + PartialEq + Serialize + DeserializeOwned {
    /// What the law remembers between two samples.
    type Memory: Clone + Debug + PartialEq + Serialize + DeserializeOwned;

    /// A memory that starts at a voltage, settled, and the output there, deg.
    fn start(&self, voltage_volt: f64, state: StartState) -> (Self::Memory, f64);

    /// Moves the memory to a new voltage, reached `time_step_s` after the last, and returns the
    /// output there, deg.
    fn step(&self, memory: &mut Self::Memory, voltage_volt: f64, time_step_s: f64) -> f64;

    /// Refuses a memory that was not made by this law.
    ///
    /// # Errors
    /// [`PreisachError::MemoryMismatch`] or [`PreisachError::MemoryOfAnotherLaw`].
    fn check_memory(&self, memory: &Self::Memory) -> Result<(), PreisachError>;

    /// What happened to the steps since the memory was made; `steps` itself is counted by the
    /// actuator.
    fn counts(&self, _memory: &Self::Memory) -> StepCounts {
        StepCounts::default()
    }

    /// The same law with its output moved by `shift_deg`.
    #[must_use]
    fn shifted(self, shift_deg: f64) -> Self;
}

/// The ideal actuator: `delta = gain (u - bias)`, no memory, no lag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearGain {
    /// Gain, deg/V.
    pub gain_deg_per_volt: f64,
    /// Voltage of zero flap angle, V.
    pub bias_volt: f64,
}

impl LinearGain {
    /// Flap angle at a voltage, deg.
    pub fn output_deg(&self, voltage_volt: f64) -> f64 {
        self.gain_deg_per_volt * (voltage_volt - self.bias_volt)
    }
}

impl HysteresisLaw for LinearGain {
    type Memory = ();

    fn start(&self, voltage_volt: f64, _: StartState) -> ((), f64) {
        ((), self.output_deg(voltage_volt))
    }

    fn step(&self, (): &mut (), voltage_volt: f64, _: f64) -> f64 {
        self.output_deg(voltage_volt)
    }

    fn check_memory(&self, (): &()) -> Result<(), PreisachError> {
        Ok(())
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.bias_volt -= shift_deg / self.gain_deg_per_volt;
        self
    }
}
