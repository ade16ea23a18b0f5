//! Hysteretic piezo actuators: static and dynamic Preisach models, identification from bench
//! records, periodic response.
//!
//! Voltage in volt, output in degrees of equivalent flap angle (displacement times a bench gain).
//!
//! | idea | module items |
//! |---|---|
//! | memory: plays on the Preisach triangle | [`PreisachGrid`], [`PlayMemory`], [`PlayMap`] |
//! | any law between voltage and free flap angle | [`HysteresisLaw`], [`ActuatorLaw`] |
//! | static model, paper eq. (2) | [`StaticPreisach`], [`EverettStaircase`], [`RelayGrid`] |
//! | dynamic model, paper eq. (5) | [`DynamicPreisach`], [`output_rate`] |
//! | other families | [`PrandtlIshlinskii`], [`BoucWen`]; output ahead of the input: [`PrandtlStop`] |
//! | what stands around the law | [`AmplifierStage`], [`LinkageStage`], [`SensorStage`] |
//! | one actuator: simulation, bench, batch | [`ActuatorModel`], [`Drive`], [`Stepper`] |
//! | what is impossible or unlikely about one | [`ActuatorModel::doubts`] |
//! | closed orbits, and the voltage for a wanted one | [`PeriodicResponse`], [`PeriodicInverse`] |
//! | reversal curves: density, FORC diagram | [`forc`] |
//! | identification from bench records | [`identify`](mod@identify) |
//!
//! Source: S. R. Viswamurthy and R. Ganguli, *Experimental and computational investigation of
//! piezoceramic actuator hysteresis phenomenon in helicopter vibration control using dual
//! trailing-edge flaps*; I. D. Mayergoyz, *Dynamic Preisach models of hysteresis*, IEEE
//! Transactions on Magnetics 24 (1988).

mod actuator;
mod bouc_wen;
mod chain;
mod doubts;
mod dynamics;
mod envelope;
mod error;
mod everett;
pub mod forc;
mod grid;
pub mod identify;
mod inverse;
mod law;
mod memory;
mod periodic;
mod play_map;
mod prandtl;
mod relays;
mod simulate;
mod stages;
mod statics;
mod stop;

pub use actuator::{ActuatorModel, Calibration, TrainedRange};
pub use bouc_wen::{BoucWen, BoucWenMemory, BoucWenParameters};
pub use chain::{ActuatorMemory, Stepper};
pub use doubts::{Doubt, Weight};
pub use dynamics::{
    DynamicMemory, DynamicParameters, DynamicPreisach, OutputHistory, OutputRate, RateForm,
    StepCounts, TimeOrder, output_rate,
};
pub use envelope::Envelope;
pub use error::PreisachError;
pub use everett::{EverettStaircase, StaircaseMemory};
pub use grid::{PreisachGrid, VoltageRange};
pub use inverse::{InverseSettings, PeriodicInverse};
pub use law::{ActuatorLaw, HysteresisLaw, LawMemory, LinearGain};
pub use memory::{PlayMemory, StartState};
pub use periodic::{PeriodicResponse, PeriodicSettings};
pub use play_map::PlayMap;
pub use prandtl::{PrandtlIshlinskii, PrandtlMemory, PrandtlParameters, WeightedPlay};
pub use relays::{RelayGrid, RelayMemory};
pub use simulate::{BenchSimulation, Drive, Simulation};
pub use stages::{
    Accommodation, AmplifierStage, Backlash, CoulombFriction, CurrentLimit, Delay, Depolarisation,
    DielectricHeating, KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage, LoadStiffness, LogCreep,
    MainsHum, Nonlinearity, NonlinearityShape, Quantisation, Relaxation, RelaxationElement,
    Resonance, Saturation, SensorStage,
};
pub use statics::StaticPreisach;
pub use stop::{PrandtlStop, StopMemory, StopParameters, WeightedStop};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
