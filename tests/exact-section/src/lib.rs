//! Exact linear theory of a thin section with a trailing-edge flap.
//!
//! What the section models are measured against and calibrated to. Shares no code with them.
//!
//! | question | answer |
//! |---|---|
//! | harmonic, compressible | [`Possio`] |
//! | harmonic, Mach 0 | [`incompressible_loads`] |
//! | first moments after a step | [`short_time()`] |
//! | steady, incompressible, with thickness and camber | [`Outline`] |
//! | poles and gains of a lag model | [`calibration`] |
//!
//! # Conventions
//! Loads `[Cn, Cm, Ch]`: up, nose-up about the quarter chord, in the sense of the flap angle about the
//! hinge; moments on the full chord squared. Downwashes `[alpha, q, delta, q_delta]`, rates on `U/c`.
//! `k = omega c / (2 U)`, `S = 2 U t / c`, time factor `exp(i omega t)`, `E` flap chord over chord.

pub mod calibration;

mod bessel;
mod chebyshev;
mod downwash;
mod incompressible;
mod panels;
mod possio;
mod short_time;

use num_complex::Complex64;

pub use bessel::{bound_circulation, theodorsen_function};
pub use downwash::{start_loads, steady_loads};
pub use incompressible::incompressible_loads;
pub use panels::{Outline, linear_section, thin_mean_line_230};
pub use possio::{Possio, TERMS};
pub use short_time::{ShortTime, short_time};

/// What can be wrong with a question to the exact theory.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExactError {
    /// A number outside the theory or the reach of its series.
    #[error("{quantity} {value} is outside the reach of the exact theory as programmed")]
    OutOfRange {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value found.
        value: f64,
    },
    /// The integral equation could not be solved.
    #[error("the integral equation has no solution at Mach {mach}, k {k}")]
    Singular {
        /// Mach number.
        mach: f64,
        /// Reduced frequency.
        k: f64,
    },
}

/// A harmonic motion of unit amplitude as amplitudes of the four downwashes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Flap angle with its rate.
    Flap,
    /// Pitch about the quarter chord with its rate.
    Pitch,
    /// Plunge velocity over `U`, down.
    Plunge,
}

impl Motion {
    /// All motions.
    pub const ALL: [Self; 3] = [Self::Flap, Self::Pitch, Self::Plunge];

    /// The loads of the motion from those of the downwashes.
    pub fn of(self, loads: &[[Complex64; 4]; 3], k: f64) -> [Complex64; 3] {
        let rate = Complex64::new(0.0, 2.0 * k);
        loads.map(|row| match self {
            Self::Flap => row[2] + rate * row[3],
            Self::Pitch => row[0] + rate * row[1],
            Self::Plunge => row[0],
        })
    }
}
