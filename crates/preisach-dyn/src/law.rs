//! The laws between voltage and free flap angle: one trait, one enum of all of them.

use crate::{
    BoucWen, BoucWenMemory, DynamicMemory, DynamicPreisach, EverettStaircase, PlayMemory,
    PrandtlIshlinskii, PrandtlMemory, PrandtlStop, PreisachError, RelayGrid, RelayMemory,
    StaircaseMemory, StartState, StaticPreisach, StepCounts, StopMemory,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

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

/// The law between voltage and free flap angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ActuatorLaw {
    /// Ideal linear actuator.
    Linear(LinearGain),
    /// Hysteresis without rate dependence, paper equation (2), as a sum of plays.
    StaticPreisach(StaticPreisach),
    /// The same from Everett's integral and the staircase of past extremes.
    Everett(EverettStaircase),
    /// The same from bare two-position relays: the output is grainy.
    RelayGrid(RelayGrid),
    /// Hysteresis with rate dependence, paper equation (5).
    DynamicPreisach(DynamicPreisach),
    /// Plays whose thresholds depend on the rate of the voltage.
    PrandtlIshlinskii(PrandtlIshlinskii),
    /// The Bouc-Wen differential equation.
    BoucWen(BoucWen),
    /// Stops: an output that leads its input, as friction does.
    PrandtlStop(PrandtlStop),
}

/// The memory of any law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LawMemory {
    /// The linear actuator remembers nothing.
    Linear(()),
    /// The plays.
    StaticPreisach(PlayMemory),
    /// The past extremes.
    Everett(StaircaseMemory),
    /// The relays that are up.
    RelayGrid(RelayMemory),
    /// The plays and the past outputs.
    DynamicPreisach(DynamicMemory),
    /// The plays and the last voltage.
    PrandtlIshlinskii(PrandtlMemory),
    /// The hysteretic variable and the last voltage.
    BoucWen(BoucWenMemory),
    /// The plays of the stops and the last voltage.
    PrandtlStop(StopMemory),
}

/// Runs the same expression for a law and the memory that belongs to it.
macro_rules! paired {
    ($law:expr, $memory:expr, ($l:ident, $m:ident) => $body:expr, else $otherwise:expr) => {
        match ($law, $memory) {
            (ActuatorLaw::Linear($l), LawMemory::Linear($m)) => $body,
            (ActuatorLaw::StaticPreisach($l), LawMemory::StaticPreisach($m)) => $body,
            (ActuatorLaw::Everett($l), LawMemory::Everett($m)) => $body,
            (ActuatorLaw::RelayGrid($l), LawMemory::RelayGrid($m)) => $body,
            (ActuatorLaw::DynamicPreisach($l), LawMemory::DynamicPreisach($m)) => $body,
            (ActuatorLaw::PrandtlIshlinskii($l), LawMemory::PrandtlIshlinskii($m)) => $body,
            (ActuatorLaw::BoucWen($l), LawMemory::BoucWen($m)) => $body,
            (ActuatorLaw::PrandtlStop($l), LawMemory::PrandtlStop($m)) => $body,
            _ => $otherwise,
        }
    };
}

/// Runs the same expression for every law, wrapped in its own variant.
macro_rules! each {
    ($law:expr, $l:ident, $variant:ident => $body:expr) => {
        match $law {
            ActuatorLaw::Linear($l) => each!(@ $variant Linear $body),
            ActuatorLaw::StaticPreisach($l) => each!(@ $variant StaticPreisach $body),
            ActuatorLaw::Everett($l) => each!(@ $variant Everett $body),
            ActuatorLaw::RelayGrid($l) => each!(@ $variant RelayGrid $body),
            ActuatorLaw::DynamicPreisach($l) => each!(@ $variant DynamicPreisach $body),
            ActuatorLaw::PrandtlIshlinskii($l) => each!(@ $variant PrandtlIshlinskii $body),
            ActuatorLaw::BoucWen($l) => each!(@ $variant BoucWen $body),
            ActuatorLaw::PrandtlStop($l) => each!(@ $variant PrandtlStop $body),
        }
    };
    (@ memory $name:ident $body:expr) => {{
        let (memory, output_deg) = $body;
        (LawMemory::$name(memory), output_deg)
    }};
    (@ law $name:ident $body:expr) => { ActuatorLaw::$name($body) };
}

impl ActuatorLaw {
    /// Name of the law, for messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Linear(_) => "linear gain",
            Self::StaticPreisach(_) => "static Preisach",
            Self::Everett(_) => "Everett staircase",
            Self::RelayGrid(_) => "relay grid",
            Self::DynamicPreisach(_) => "dynamic Preisach",
            Self::PrandtlIshlinskii(_) => "Prandtl-Ishlinskii",
            Self::BoucWen(_) => "Bouc-Wen",
            Self::PrandtlStop(_) => "Prandtl-Ishlinskii stops",
        }
    }
}

impl ActuatorLaw {
    /// The outputs of Preisach laws of one kind on one grid over the same voltages, from rest at the
    /// first; each is that of its own simulation, to the last bit. None for other laws.
    pub(crate) fn side_by_side(
        laws: &[&Self],
        voltages_volt: &[f64],
        time_step_s: f64,
    ) -> Option<Vec<Vec<f64>>> {
        let statics = laws.iter().map(|law| match law {
            Self::StaticPreisach(law) => Some(law),
            _ => None,
        });
        if let Some(laws) = statics.collect::<Option<Vec<_>>>() {
            let same = laws.windows(2).all(|pair| pair[0].grid() == pair[1].grid());
            return same.then(|| StaticPreisach::side_by_side(&laws, voltages_volt));
        }
        let dynamics = laws.iter().map(|law| match law {
            Self::DynamicPreisach(law) => Some(law),
            _ => None,
        });
        let laws = dynamics.collect::<Option<Vec<_>>>()?;
        let same = laws.windows(2).all(|pair| pair[0].grid() == pair[1].grid());
        same.then(|| DynamicPreisach::side_by_side(&laws, voltages_volt, time_step_s))
    }
}

impl HysteresisLaw for ActuatorLaw {
    type Memory = LawMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (LawMemory, f64) {
        each!(self, law, memory => law.start(voltage_volt, state))
    }

    /// As the law's own step; NaN for a memory that belongs to another law, see
    /// [`HysteresisLaw::check_memory`].
    #[inline]
    fn step(&self, memory: &mut LawMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        paired!(self, memory,
            (law, memory) => HysteresisLaw::step(law, memory, voltage_volt, time_step_s),
            else f64::NAN)
    }

    fn check_memory(&self, memory: &LawMemory) -> Result<(), PreisachError> {
        paired!(self, memory,
            (law, memory) => law.check_memory(memory),
            else Err(PreisachError::MemoryOfAnotherLaw { expected: self.name() }))
    }

    fn counts(&self, memory: &LawMemory) -> StepCounts {
        paired!(self, memory, (law, memory) => law.counts(memory), else StepCounts::default())
    }

    fn shifted(self, shift_deg: f64) -> Self {
        each!(self, kept, law => kept.shifted(shift_deg))
    }
}
