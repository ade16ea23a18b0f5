//! Incompressible harmonic loads by the pressure series of Küssner and Schwarz.
//!
//! ```text
//! w = sum w_n cos(n theta),   P_0 = w_0,  P_n = w_n / 2
//! a_0 = 4 [ C(k) (P_0 - P_1) + P_1 ]
//! a_n = -8 P_n + (4 ik/n) (P_{n-1} - P_{n+1})
//! ```
//! Source: H. G. Küssner and L. Schwarz, Luftfahrtforschung 17 (1940); Theodorsen's function from
//! NACA Report 496. No flap function of Theodorsen is used.

use crate::ExactError;
use crate::bessel::theodorsen_function;
use crate::downwash::{
    downwash, hinge_angle, hinge_weight, loads, steady_coefficient, steady_loads,
};
use num_complex::Complex64;

/// Coefficients summed for the part of the hinge moment that is not steady; they fall like `n^-4`.
const TERMS: usize = 2_000;

/// Complex amplitudes `[load][downwash]` at Mach 0, as [`Possio::loads`](crate::Possio::loads).
///
/// # Errors
/// [`ExactError::OutOfRange`] unless `0 <= k <= 20` and `0 <= flap_chord < 1`.
pub fn incompressible_loads(k: f64, flap_chord: f64) -> Result<[[Complex64; 4]; 3], ExactError> {
    if !(0.0..=20.0).contains(&k) {
        return Err(ExactError::OutOfRange { quantity: "reduced frequency", value: k });
    }
    if !(0.0..1.0).contains(&flap_chord) {
        return Err(ExactError::OutOfRange { quantity: "flap chord ratio", value: flap_chord });
    }
    let hinge = hinge_angle(flap_chord);
    let still = steady_loads(0.0, flap_chord);
    let lag = theodorsen_function(k);
    let w: Vec<[f64; 4]> = (0..=TERMS).map(|n| downwash(n, hinge)).collect();
    let mut out = [[Complex64::ZERO; 4]; 3];
    for j in 0..4 {
        let p = |n: usize| if n == 0 { w[0][j] } else { 0.5 * w[n][j] };
        let a: Vec<Complex64> = (0..TERMS)
            .map(|n| match n {
                0 => 4.0 * (lag * (p(0) - p(1)) + p(1)),
                _ => Complex64::new(-8.0 * p(n), 4.0 * k / n as f64 * (p(n - 1) - p(n + 1))),
            })
            .collect();
        let unsteady: Complex64 = a
            .iter()
            .enumerate()
            .map(|(n, a)| (a - steady_coefficient(n, w[n][j], 1.0)) * hinge_weight(n, hinge))
            .sum();
        let moment = if flap_chord > 0.0 { unsteady + still[2][j] } else { Complex64::ZERO };
        for (row, load) in out.iter_mut().zip(loads(&a, moment)) {
            row[j] = load;
        }
    }
    Ok(out)
}
