//! The blade with moderate deflections: nonlinear 15-dof elements, statics, modes about the deflected
//! rotating state, and the modal residual with the axial motion condensed.
//!
//! The section's energies are written once for real and complex numbers, so that the tests can take
//! their derivatives by complex step, and for azimuths side by side.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

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

use nalgebra::Complex;
use rotor_base::{Lanes, Number};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

pub use blade::{ModerateBlade, ModerateSpec, TorsionTerms, TwistAngle, Untwist};
pub use modal::{ModalBlade, ModalLoads, ModalMotion, ModalShape};
pub use model::{ModerateModel, NodalMotion, PitchMotion, Tangents};
pub use modes::{AxialMotion, deflected_modes};
pub use section_shape::SectionShape;
pub use statics::{StaticSettings, StaticState};

/// The numbers the section's functions are written in: real to solve, at one azimuth or at several side by side; complex to
/// differentiate.
pub(crate) trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// A real value, everywhere.
    fn from_real(value: f64) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sine_cosine(self) -> (Self, Self);

    #[inline(always)]
    fn zero() -> Self {
        Self::from_real(0.0)
    }

    #[inline(always)]
    fn one() -> Self {
        Self::from_real(1.0)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn from_real(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn sine_cosine(self) -> (Self, Self) {
        self.sin_cos()
    }
}

impl Scalar for Lanes {
    #[inline(always)]
    fn from_real(value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn sine_cosine(self) -> (Self, Self) {
        self.sin_cos()
    }
}

impl Scalar for Complex<f64> {
    fn from_real(value: f64) -> Self {
        Self::from(value)
    }

    fn sine_cosine(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
}
