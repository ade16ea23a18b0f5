//! The blade with moderate deflections: nonlinear 15-dof elements, statics, modes about the deflected
//! rotating state, and the modal residual with the axial motion condensed.
//!
//! The section's energies are written once for real and complex numbers, so that the tests can take
//! their derivatives by complex step.

mod blade;
mod element;
mod free_motion;
mod inertia;
mod modal;
mod modal_modes;
mod modal_tangent;
mod model;
mod modes;
mod points;
mod section_shape;
mod span;
mod statics;
mod strain;

pub use blade::{ModerateBlade, ModerateSpec, RotaryInertia, TorsionTerms, TwistAngle, Untwist};
pub use free_motion::{FreeMotion, MotionState};
pub use modal::{ModalBlade, ModalForce, ModalLoads, ModalMotion, ModalShape};
pub use modal_tangent::ModalTangent;
pub use model::{ModerateModel, NodalMotion, PitchMotion, Tangents};
pub use modes::{AxialMotion, deflected_fan, deflected_modes};
pub use section_shape::SectionShape;
pub use statics::{StaticSettings, StaticState};

/// The numbers the section's functions are written in: real to solve, complex to differentiate.
pub(crate) trait Scalar: nalgebra::ComplexField<RealField = f64> + Copy {}

impl Scalar for f64 {}
impl Scalar for nalgebra::Complex<f64> {}
