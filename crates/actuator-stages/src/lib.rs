//! What stands around the hysteresis of a piezo actuator: amplifier before the law, linkage behind it,
//! sensor on the bench.
//!
//! Every stage takes one sample of a signal to the next. Its input is taken as straight between two
//! samples; linear stages are then exact at the samples whatever the step (first-order hold, the
//! matrix exponential in closed form). Volt in the amplifier, degrees of flap angle behind the law;
//! lengths in um are turned into degrees by the actuator's [`Calibration`].
//!
//! | idea | items |
//! |---|---|
//! | a stage as written in an actuator file | [`AmplifierStage`], [`LinkageStage`], [`SensorStage`] |
//! | a stage made ready for one time step, and its state | [`Step`], [`StageStep`], [`StageMemory`] |
//! | flap angle from displacement | [`Calibration`] |
//! | parameters refused | [`StageError`] |
//!
//! Source of the first-order hold: G. F. Franklin, J. D. Powell, M. L. Workman, *Digital Control of
//! Dynamic Systems* (1998), section 6.3.

mod amplifier;
mod calibration;
mod check;
mod creep;
mod delay;
mod error;
mod lag;
mod lag_step;
mod linkage;
mod relaxation;
mod resonance;
mod sensor;
mod stage;
mod step;

pub use amplifier::{
    CurrentLimit, CurrentStep, Depolarisation, DepolarisationStep, DielectricHeating, HeatMemory,
    HeatStep, LimitMemory, LossMemory, Saturation,
};
pub use calibration::Calibration;
pub use creep::{CreepMemory, CreepStep, KelvinVoigt, KelvinVoigtElement, LogCreep};
pub use delay::{Delay, DelayMemory, DelayStep};
pub use error::StageError;
pub use lag::Lag;
pub use linkage::{
    Accommodation, AccommodationStep, Backlash, CoulombFriction, FrictionStep, LoadStep,
    LoadStiffness, PlayStep, WayMemory,
};
pub use relaxation::{Relaxation, RelaxationElement};
pub use resonance::{Resonance, ResonanceMemory, ResonanceStep};
pub use sensor::{
    HumStep, MainsHum, Nonlinearity, NonlinearityShape, NonlinearityStep, Quantisation,
    QuantisationStep,
};
pub use stage::{AmplifierStage, LinkageStage, SensorStage, StageMemory, StageStep};
pub use step::{Curve, Step};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
