//! Responses of a linear section in closed form: harmonic, steady, indicial.

use crate::{Mode, SectionCoefficients};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// A harmonic motion of a section, unit amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Motion {
    /// Flap angle of 1 rad, with the flap rate that goes with it.
    Flap,
    /// Pitch of 1 rad about the quarter chord, with its pitch rate.
    Pitch,
    /// Plunge velocity `h_dot / U = 1`, down +.
    Plunge,
}

impl Motion {
    /// Complex amplitudes of the four inputs at the reduced frequency `k = omega c / (2 U)`, motion
    /// `exp(i omega t)`.
    ///
    /// ```text
    /// flap: delta = 1, q_delta = 2ik      pitch: alpha = 1, q = 2ik      plunge: alpha = 1
    /// ```
    pub fn inputs(self, reduced_frequency: f64) -> [Complex64; 4] {
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        let rate = Complex64::new(0.0, 2.0 * reduced_frequency);
        match self {
            Self::Flap => [zero, zero, one, rate],
            Self::Pitch => [one, rate, zero, zero],
            Self::Plunge => [one, zero, zero, zero],
        }
    }
}

/// What the complex amplitudes `[Cn, Cm, Ch]` of a section in a harmonic motion are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseParts {
    /// Loads of the inputs as if each were held: no lag, no apparent mass.
    pub held: [Complex64; 3],
    /// What the lags take off.
    pub lag: [Complex64; 3],
    /// Loads of the rates of the inputs.
    pub apparent_mass: [Complex64; 3],
}

impl ResponseParts {
    /// Parts of the response to a motion of unit amplitude.
    ///
    /// ```text
    /// held = (direct + sum output input) m      lag = - sum output (ik / (pole + ik)) input m      apparent mass = ik rate m
    /// ```
    /// with the reduced frequency `k = omega c / (2 U)`, 0 and up. Where pressure waves stand for apparent mass (compressible
    /// models), they are in `lag`.
    pub fn of(section: &SectionCoefficients, reduced_frequency: f64, motion: Motion) -> Self {
        let inputs = motion.inputs(reduced_frequency);
        let ik = Complex64::new(0.0, reduced_frequency);
        let dot =
            |row: &[f64; 4]| -> Complex64 { row.iter().zip(&inputs).map(|(w, m)| *w * m).sum() };
        let mut held = section.direct.each_ref().map(dot);
        let mut lag = [Complex64::ZERO; 3];
        for own in &section.lags {
            let drive = dot(&own.input);
            let late = drive * ik / (ik + own.pole);
            for ((held, lag), weight) in held.iter_mut().zip(&mut lag).zip(own.output) {
                *held += weight * drive;
                *lag -= weight * late;
            }
        }
        Self { held, lag, apparent_mass: section.rate.each_ref().map(|row| ik * dot(row)) }
    }

    /// The loads: the sum of the parts.
    pub fn loads(&self) -> [Complex64; 3] {
        std::array::from_fn(|n| self.held[n] + self.lag[n] + self.apparent_mass[n])
    }
}

/// Complex amplitudes `[Cn, Cm, Ch]` of a section in a harmonic motion of unit amplitude.
///
/// ```text
/// y(k) = [direct + ik rate + sum output (pole / (pole + ik)) input] m(k)
/// ```
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `section` | | | |
/// | `reduced_frequency` | `k = omega c / (2 U)` | - | 0 and up |
/// | `motion` | `m(k)` | rad, or `h_dot/U` | |
///
/// Returns values per radian (plunge: per unit of `h_dot / U`), time factor `exp(i omega t)`: a
/// negative imaginary part lags the motion.
pub fn harmonic_response(
    section: &SectionCoefficients,
    reduced_frequency: f64,
    motion: Motion,
) -> [Complex64; 3] {
    ResponseParts::of(section, reduced_frequency, motion).loads()
}

/// Loads `[Cn, Cm, Ch]` long after the inputs have come to rest.
///
/// ```text
/// y = (direct + sum output input) m
/// ```
pub fn steady_response(section: &SectionCoefficients, modes: &[f64; 4]) -> [f64; 3] {
    indicial(section, modes, |_| 1.0)
}

/// Loads `[Cn, Cm, Ch]` a distance `semichords > 0` after a unit step of one input, the other three
/// held at zero.
///
/// ```text
/// y(S) = direct + sum output input (1 - e^(-pole S))
/// ```
/// The impulse that `rate` gives at the instant of the step is not in the value.
pub fn indicial_response(section: &SectionCoefficients, mode: Mode, semichords: f64) -> [f64; 3] {
    let mut modes = [0.0; 4];
    modes[mode.index()] = 1.0;
    indicial(section, &modes, |pole| -(-pole * semichords).exp_m1())
}

/// Loads with every lag state at a given share of its final value.
fn indicial(
    section: &SectionCoefficients,
    modes: &[f64; 4],
    share: impl Fn(f64) -> f64,
) -> [f64; 3] {
    let dot = |row: &[f64; 4]| -> f64 { row.iter().zip(modes).map(|(a, m)| a * m).sum() };
    let mut loads = section.direct.each_ref().map(dot);
    for lag in &section.lags {
        let state = share(lag.pole) * dot(&lag.input);
        for (load, weight) in loads.iter_mut().zip(lag.output) {
            *load += weight * state;
        }
    }
    loads
}
