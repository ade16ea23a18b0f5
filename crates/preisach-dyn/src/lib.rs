//! Hysteretic piezo actuators: static and dynamic Preisach models, identification from bench
//! records, periodic response.
//!
//! Voltage in volt, output in degrees of equivalent flap angle (displacement times a bench gain).
//!
//! | idea | module items |
//! |---|---|
//! | memory: plays on the Preisach triangle | [`PreisachGrid`], [`PlayMemory`], [`PlayMap`] |
//! | any law between voltage and free flap angle | [`HysteresisLaw`], [`ActuatorLaw`] |
//! | static model, paper eq. (2) | [`StaticPreisach`] |
//! | dynamic model, paper eq. (5) | [`DynamicPreisach`], [`output_rate`] |
//! | other families | [`PrandtlIshlinskii`], [`BoucWen`]; output ahead of the input: [`PrandtlStop`] |
//! | hysteresis inside a resonance | [`HystereticOscillator`] |
//! | what stands around the law, of `actuator-stages` | [`AmplifierStage`], [`LinkageStage`], [`SensorStage`] |
//! | one actuator: simulation, bench, batch | [`ActuatorModel`], [`Drive`], [`Stepper`] |
//! | closed orbits, and the voltage for a wanted one | [`PeriodicResponse`], [`PeriodicInverse`] |
//! | reversal curves: density | [`forc`] |
//! | identification from bench records | [`identify`](mod@identify) |
//!
//! Source: S. R. Viswamurthy and R. Ganguli, *Experimental and computational investigation of
//! piezoceramic actuator hysteresis phenomenon in helicopter vibration control using dual
//! trailing-edge flaps*; I. D. Mayergoyz, *Dynamic Preisach models of hysteresis*, IEEE
//! Transactions on Magnetics 24 (1988).

mod actuator;
mod check;
mod error;
pub mod forc;
pub mod identify;
mod inverse;
mod laws;

pub use actuator::chain::{ActuatorMemory, Stepper};
pub use actuator::model::{ActuatorModel, TrainedRange};
pub use actuator::periodic::{PeriodicResponse, PeriodicSettings};
pub use actuator::simulate::{BenchSimulation, Drive, Simulation};
pub use actuator_stages::{
    Accommodation, AmplifierStage, Backlash, Calibration, CoulombFriction, CurrentLimit, Delay,
    Depolarisation, DielectricHeating, KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage,
    LoadStiffness, LogCreep, MainsHum, Nonlinearity, NonlinearityShape, Quantisation, Relaxation,
    RelaxationElement, Resonance, Saturation, SensorStage, StageError,
};
pub use error::PreisachError;
pub use inverse::{InverseSettings, PeriodicInverse};
pub use laws::bouc_wen::{BoucWen, BoucWenMemory, BoucWenParameters};
pub use laws::dynamics::{
    DynamicMemory, DynamicParameters, DynamicPreisach, OutputHistory, OutputRate, RateForm,
    TimeOrder, output_rate,
};
pub use laws::envelope::Envelope;
pub use laws::grid::{PreisachGrid, VoltageRange};
pub use laws::hysteresis::{HysteresisLaw, LinearGain, StepCounts};
pub use laws::law::{ActuatorLaw, LawMemory};
pub use laws::memory::{PlayMemory, StartState, WidthsMemory};
pub use laws::oscillator::{HystereticOscillator, OscillatorMemory, OscillatorParameters};
pub use laws::play_map::PlayMap;
pub use laws::prandtl::{PrandtlIshlinskii, PrandtlParameters, WeightedPlay};
pub use laws::statics::StaticPreisach;
pub use laws::stop::{PrandtlStop, StopParameters, WeightedStop};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
