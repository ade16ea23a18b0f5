//! The laws between voltage and free flap angle: one enum of all of them.

use crate::{
    BoucWen, BoucWenMemory, DynamicMemory, DynamicPreisach, HysteresisLaw, HystereticOscillator,
    LinearGain, OscillatorMemory, PlayMemory, PrandtlIshlinskii, PrandtlStop, PreisachError,
    StartState, StaticPreisach, StepCounts, WidthsMemory,
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
    /// Bouc-Wen hysteresis in the spring of an oscillator.
    HystereticOscillator(HystereticOscillator),
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
    PrandtlIshlinskii(WidthsMemory),
    /// The hysteretic variable and the last voltage.
    BoucWen(BoucWenMemory),
    /// The plays of the stops and the last voltage.
    PrandtlStop(WidthsMemory),
    /// Place, rate, hysteretic part and the last voltage.
    HystereticOscillator(OscillatorMemory),
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
            Self::HystereticOscillator(_) => "Bouc-Wen oscillator",
        }
    }

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

/// The outputs of a law over voltages, from rest at the first.
fn outputs(law: &impl HysteresisLaw, voltages_volt: &[f64], time_step_s: f64) -> Vec<f64> {
    let Some((&first, later)) = voltages_volt.split_first() else { return Vec::new() };
    let (mut memory, output_deg) = law.start(first, StartState::Rest);
    let steps = later.iter().map(|volt| law.step(&mut memory, *volt, time_step_s));
    std::iter::once(output_deg).chain(steps).collect()
}

/// [`HysteresisLaw`] of any law, with any memory, from that of each law with its own.
macro_rules! any_of {
    ($($name:ident),*) => {
        impl ActuatorLaw {
            /// The outputs over voltages, from rest at the first: those of a simulation, which is not stopped where it
            /// diverges.
            pub(crate) fn outputs(&self, voltages_volt: &[f64], time_step_s: f64) -> Vec<f64> {
                match self {
                    $(Self::$name(law) => outputs(law, voltages_volt, time_step_s),)*
                }
            }
        }

        impl HysteresisLaw for ActuatorLaw {
            type Memory = LawMemory;

            fn start(&self, voltage_volt: f64, state: StartState) -> (LawMemory, f64) {
                match self {
                    $(Self::$name(law) => {
                        let (memory, output_deg) = law.start(voltage_volt, state);
                        (LawMemory::$name(memory), output_deg)
                    })*
                }
            }

            /// As the law's own step; NaN for a memory that belongs to another law, see
            /// [`HysteresisLaw::check_memory`].
            #[inline]
            fn step(&self, memory: &mut LawMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
                match (self, memory) {
                    $((Self::$name(law), LawMemory::$name(memory)) => {
                        HysteresisLaw::step(law, memory, voltage_volt, time_step_s)
                    })*
                    _ => f64::NAN,
                }
            }

            fn check_memory(&self, memory: &LawMemory) -> Result<(), PreisachError> {
                match (self, memory) {
                    $((Self::$name(law), LawMemory::$name(memory)) => law.check_memory(memory),)*
                    _ => Err(PreisachError::MemoryOfAnotherLaw { expected: self.name() }),
                }
            }

            fn counts(&self, memory: &LawMemory) -> StepCounts {
                match (self, memory) {
                    $((Self::$name(law), LawMemory::$name(memory)) => law.counts(memory),)*
                    _ => StepCounts::default(),
                }
            }

            fn shifted(self, shift_deg: f64) -> Self {
                match self {
                    $(Self::$name(law) => Self::$name(law.shifted(shift_deg)),)*
                }
            }
        }
    };
}

any_of!(
    Linear,
    StaticPreisach,
    DynamicPreisach,
    PrandtlIshlinskii,
    BoucWen,
    PrandtlStop,
    HystereticOscillator
);
