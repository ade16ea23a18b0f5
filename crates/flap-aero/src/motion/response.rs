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
    let inputs = motion.inputs(reduced_frequency);
    let ik = Complex64::new(0.0, reduced_frequency);
    let mut loads = [Complex64::ZERO; 3];
    for (load, (direct, rate)) in loads.iter_mut().zip(section.direct.iter().zip(&section.rate)) {
        for ((d, r), m) in direct.iter().zip(rate).zip(&inputs) {
            *load += (*d + ik * *r) * m;
        }
    }
    for lag in &section.lags {
        let drive: Complex64 = lag.input.iter().zip(&inputs).map(|(w, m)| *w * m).sum();
        let state = drive * lag.pole / (ik + lag.pole);
        for (load, weight) in loads.iter_mut().zip(lag.output) {
            *load += weight * state;
        }
    }
    loads
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
