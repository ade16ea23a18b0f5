//! The laws between voltage and free flap angle: one enum of all of them.

use crate::{
    BoucWen, BoucWenMemory, DynamicMemory, DynamicPreisach, HysteresisLaw, LinearGain, PlayMemory,
    PrandtlIshlinskii, PrandtlMemory, PrandtlStop, PreisachError, StartState, StaticPreisach,
    StepCounts, StopMemory,
};
use serde::{Deserialize, Serialize};

/// The law between voltage and free flap angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ActuatorLaw {
    /// Ideal linear actuator.
    Linear(LinearGain),
    /// Hysteresis without rate dependence, paper equation (2), as a sum of plays. Files that name it
    /// `Everett` are read as this: the same output to rounding.
    #[serde(alias = "Everett", alias = "RelayGrid")]
    StaticPreisach(StaticPreisach),
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
