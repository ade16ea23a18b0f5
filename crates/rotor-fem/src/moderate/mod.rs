//! The blade with moderate deflections: nonlinear 15-dof elements, statics, modes about the deflected
//! rotating state, and the modal residual with the axial motion condensed.
//!
//! The section's energies are written once for real and complex numbers, so that the tests can take
//! their derivatives by complex step.

mod blade;
mod element;
mod inertia;
mod modal;
mod model;
mod modes;
mod points;
mod section_shape;
mod span;
mod statics;
mod strain;

pub use blade::{ModerateBlade, ModerateSpec, TorsionTerms, TwistAngle, Untwist};
pub use modal::{ModalBlade, ModalLoads, ModalMotion, ModalShape};
pub use model::{ModerateModel, NodalMotion, PitchMotion, Tangents};
pub use modes::{AxialMotion, deflected_modes};
pub use section_shape::SectionShape;
pub use statics::{StaticSettings, StaticState};

/// The numbers the section's functions are written in: real to solve, complex to differentiate.
pub(crate) trait Scalar: nalgebra::ComplexField<RealField = f64> + Copy {}

impl Scalar for f64 {}
impl Scalar for nalgebra::Complex<f64> {}
