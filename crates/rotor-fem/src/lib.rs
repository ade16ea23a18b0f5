//! Rotating blade finite elements: the 15-dof beam element, rotating modes, finite elements in time.

mod acceleration;
mod assembly;
mod distribution;
mod eigen;
mod element;
mod error;
mod linear_periodic;
mod mode_kind;
mod mode_set;
mod modes;
mod newton_matrix;
mod periodic;
mod properties;
mod shape;
mod time_elements;

pub use assembly::{BladeModel, SectionMotion};
pub use distribution::Distribution;
pub use error::FemError;
pub use linear_periodic::{LinearCoefficients, LinearPeriodic};
pub use mode_kind::ModeKind;
pub use mode_set::{ModeCount, ModeSet, UncoupledMode, uncoupled_modes};
pub use modes::{CoupledMode, EnergyShares, FanPoint, GyroscopicTerms, fan_plot, modes};
pub use periodic::{
    Acceleration, LocalTangent, PeriodicError, PeriodicSettings, PeriodicSolution, PeriodicSolver,
    PeriodicSystem,
};
pub use properties::{BladeProperties, BladeSpec, RootCondition, Twist};
pub use time_elements::{Orbit, OrbitSamples, TimeElements};
