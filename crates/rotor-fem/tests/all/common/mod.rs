//! The rigid flapping blade in forward flight: a linear equation with periodic coefficients.

use nalgebra::{DMatrix, DVector};

use crate::linear::{LinearCoefficients, LinearPeriodic};

/// Lock number, flap frequency and advance ratio of the reference table.
const GAMMA: f64 = 5.2;
const NU: f64 = 1.125_789_21;
const MU: f64 = 0.3;

/// ```text
/// b'' + (g/8)(1 + 4/3 mu s) b' + [nu^2 + (g/8)(4/3 mu c + mu^2 sin 2psi)] b
///   = (g/8)[theta (1 + 8/3 mu s + 2 mu^2 s^2) + twist (4/5 + 2 mu s + 4/3 mu^2 s^2)
///           - lambda (4/3 + 2 mu s)]
/// ```
/// in degrees, with theta = 8 + 2 c - 6 s, twist -8 deg (zero at the root) and lambda 0.02.
pub(crate) fn flap_equation() -> LinearPeriodic<impl Fn(f64) -> LinearCoefficients + Sync> {
    LinearPeriodic::new(DMatrix::identity(1, 1), |psi: f64| {
        let (s, c) = psi.sin_cos();
        let g = GAMMA / 8.0;
        let theta = 8.0 + 2.0 * c - 6.0 * s;
        let lambda = 0.02_f64.to_degrees();
        let load = theta * (1.0 + 8.0 / 3.0 * MU * s + 2.0 * MU * MU * s * s)
            - 8.0 * (0.8 + 2.0 * MU * s + 4.0 / 3.0 * MU * MU * s * s)
            - lambda * (4.0 / 3.0 + 2.0 * MU * s);
        let [damping, stiffness] = flap_stability_coefficients(psi);
        LinearCoefficients {
            damping: DMatrix::from_element(1, 1, damping),
            stiffness: DMatrix::from_element(1, 1, stiffness),
            load: DVector::from_element(1, g * load),
        }
    })
}

/// Damping and stiffness of the left side of the [`flap_equation`].
pub(crate) fn flap_stability_coefficients(psi: f64) -> [f64; 2] {
    let (s, c) = psi.sin_cos();
    let g = GAMMA / 8.0;
    let aero_stiffness = g * (4.0 / 3.0 * MU * c + MU * MU * (2.0 * psi).sin());
    [g * (1.0 + 4.0 / 3.0 * MU * s), NU * NU + aero_stiffness]
}
