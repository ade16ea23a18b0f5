//! The values of a case: sections and their ranges, the models built from them, and warnings of values that
//! can be but hardly are meant.
//!
//! Floor 4. Nothing here knows a file. A field is named by its path (`flaps[1].start_r`); who has read the case from a
//! text adds the line. One struct per section holds what a user writes, in degrees and engineering units; the
//! models below are built from it in one step, in radians and rotor units, by `models`.
//!
//! | idea | module |
//! |---|---|
//! | a field stated once: name, default, range, unit, remedy, meaning | `field` |
//! | sections of a case | `sections`, `blade`, `wake`, `control`, `flight`, `measured` |
//! | rules between fields, and [`Case::check`] | `rules` |
//! | what is wrong with a value, and where | `fault` |
//! | values into the models of the crates below | `models`; [`ModelError`] |
//! | values that can be, but hardly are meant | `plausibility` |

mod bias;
mod blade;
mod control;
mod error;
mod fault;
mod field;
mod flight;
mod handed_t;
mod measured;
mod models;
mod plausibility;
mod rules;
mod sections;
mod wake;

pub use bias::Bias;
pub use blade::{
    BladeTables, DissimilarBlade, EffectivenessValues, FlapValues, GravityChoice, PitchHarmonic,
    RootPitchBy, RotorValues, times,
};
pub use control::{
    ActuatorChoice, ActuatorPath, ActuatorValues, BenchFolder, BiasChoice, ControlActuator,
    ControlValues, ControllerChoice, EffortChoice, HorizontalTailValues, LoadScaleChoice,
    LoadWeights, PrescribedTrim, PropulsiveTrim, StrokeChoice, TInflowChoice, TrimValues,
    WindTunnelTrim,
};
pub use error::ModelError;
pub use fault::{CaseFault, CaseFaults, FieldFault};
pub use field::{Field, Range, Section, Value, Visitor, variant_names};
pub use flight::{
    FailedFlap, FailedOn, FlapActuator, FlightController, FlightValues, Notice, ThrustStep,
};
pub use handed_t::{HandedSet, HandedT, HandedTError};
pub use measured::{MeasuredFile, MeasuredFiles, MeasuredSection, UncertainField};
pub use plausibility::PlausibilityWarning;
pub use sections::{
    AerodynamicsValues, AirfoilStation, Case, CompressibilityChoice, CouplingsChoice,
    DynamicStallChoice, InflowChoice, InflowValues, ModeNumbers, ResponseValues, StructureValues,
    ToleranceValues,
};
pub use wake::{
    BodyValues, CirculationChoice, CirculationShape, FreeWakeValues, GeometryChoice,
    PrescribedCirculation, RolledUpChoice, WakeChoices, WakePreset,
};
// settings of the models below, which a case names as they are
pub use flap_aero::AttachedFlowModel;
pub use rotor_fem::{Joint, ModalBasis, RootSupport, TwistAngle, Untwist};
pub use rotor_response::{FlapMass, ReverseFlow};
pub use rotor_wake::{
    ControlPoint, CoreModel, FarField, NearWakeMotion, ReleasePoint, WakeMethod, WakeSymmetry,
};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
