//! Case files: what users write, its check, and the validated case.
//!
//! The file types ([`CaseFile`] and its sections) hold degrees and engineering units; the validated
//! [`Case`] holds radians and rotor units. [`read_case`] reports every problem of a file at once.

mod airfoils;
mod checker;
mod convert;
mod file;
mod file_blade;
mod file_control;
mod file_wake;
mod ranges;
mod ranges_blade;
mod read;
#[cfg(test)]
mod tests;
mod validated;

pub use file::{
    AerodynamicsFile, AirfoilFile, BasisChoice, CaseFile, CompressibilityChoice, CouplingsChoice,
    DynamicStallChoice, EffectivenessFile, FlapFile, FlapMassChoice, InflowChoice, InflowFile,
    ModesFile, ResponseFile, ReverseFlowChoice, RotorFile, SectionModelChoice, StructureFile,
    TolerancesFile, TwistAngleChoice, UntwistChoice,
};
pub use file_blade::{BladeTablesFile, GravityChoice, JointChoice, RootFile, UnlikeBladeFile};
pub use file_control::{
    ActuatorChoice, ActuatorFile, BenchFile, ControlActuator, ControlFile, ControllerChoice,
    EffortChoice, HorizontalTailFile, LoadScaleChoice, LoadWeightsFile, PrescribedTrimFile,
    PropulsiveTrimFile, StoredActuatorFile, StrokeChoice, TInflowChoice, TrimFile,
    WindTunnelTrimFile,
};
pub use file_wake::{
    CirculationChoice, CirculationShape, ControlPointChoice, CoreChoice, FarFieldChoice,
    FreeWakeFile, GeometryChoice, NearWakeChoice, PrescribedCirculation, ReleaseChoice,
    RolledUpChoice, SymmetryChoice, WakeMethodChoice,
};
pub use read::{
    CONTROLLERS_CASE, LoadedCase, PAPER_CASE, load_case, read_case, shipped_case,
    with_actuator_file,
};
pub use validated::{
    ActuatorSource, ActuatorValues, BladeValues, Case, ControlValues, FlapValues, SectionValues,
    TrimValues,
};
