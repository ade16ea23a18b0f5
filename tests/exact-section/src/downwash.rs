//! The four downwashes of a section and the three loads, as cosine series in the angle of Glauert.
//!
//! ```text
//! x = -cos(theta), semichords aft of mid-chord;   hinge e = 1 - 2E = -cos(theta_h)
//! w(x)/U = alpha + q (x + 1/2)/2 + [x > e] (delta + q_delta (x - e)/2) = sum w_n cos(n theta)
//! ```

use num_complex::Complex64;
use std::f64::consts::PI;

/// Angle of the hinge.
pub(crate) fn hinge_angle(flap_chord: f64) -> f64 {
    (2.0 * flap_chord - 1.0).acos()
}

/// `integral of cos(n phi) over [from, pi]`.
fn tail(n: i64, from: f64) -> f64 {
    if n == 0 { PI - from } else { -(n as f64 * from).sin() / n as f64 }
}

/// Cosine coefficients of a function that is `f(theta) = a + b cos(theta)` behind the hinge.
fn behind_hinge(n: usize, hinge: f64, a: f64, b: f64) -> f64 {
    let n = i64::try_from(n).unwrap_or(i64::MAX);
    let integral = a * tail(n, hinge) + 0.5 * b * (tail(n + 1, hinge) + tail(n - 1, hinge));
    integral * if n == 0 { 1.0 } else { 2.0 } / PI
}

/// The cosine coefficient `n` of the four downwashes, `[alpha, q, delta, q_delta]`.
pub(crate) fn downwash(n: usize, hinge: f64) -> [f64; 4] {
    let [uniform, pitch] = match n {
        0 => [1.0, 0.25],
        1 => [0.0, -0.5],
        _ => [0.0, 0.0],
    };
    let flap = behind_hinge(n, hinge, 1.0, 0.0);
    let rate = behind_hinge(n, hinge, 0.5 * hinge.cos(), -0.5);
    [uniform, pitch, flap, rate]
}

/// Hinge moment per coefficient `n` of the loading
/// `c_p = a_0 (1 + cos)/sin + sum a_n sin(n phi)`:
/// `-(1/4) integral of c_p sin(phi) (cos(theta_h) - cos(phi)) over [theta_h, pi]`.
pub(crate) fn hinge_weight(n: usize, hinge: f64) -> f64 {
    let n = i64::try_from(n).unwrap_or(i64::MAX);
    let (c, t) = (hinge.cos(), |m: i64| tail(m, hinge));
    // cosine series of c_p sin(phi)
    let arm = |m: i64| c * t(m) - 0.5 * (t(m + 1) + t(m - 1));
    -0.25 * if n == 0 { arm(0) + arm(1) } else { 0.5 * (arm(n - 1) - arm(n + 1)) }
}

/// `[Cn, Cm, Ch]` of the coefficients of a loading.
pub(crate) fn loads(a: &[Complex64], hinge_moment: Complex64) -> [Complex64; 3] {
    let at = |n: usize| a.get(n).copied().unwrap_or_default();
    [0.5 * PI * (at(0) + 0.5 * at(1)), -PI / 16.0 * (at(1) - at(2)), hinge_moment]
}

/// Loads of the four downwashes at the start of a step of each, `[load][downwash]`: the pressure
/// difference of piston theory, `4 w / (M U)`.
pub fn start_loads(mach: f64, flap_chord: f64) -> [[f64; 4]; 3] {
    let (p, e) = (4.0 / mach, flap_chord);
    let e2 = e * e;
    [
        [p, p / 4.0, p * e, p * e2 / 2.0],
        [-p / 4.0, -7.0 * p / 48.0, -p * e * (0.75 - e / 2.0), -p * e2 * (9.0 - 4.0 * e) / 24.0],
        [-p * e2 / 2.0, -p * e2 * (e / 3.0 + (0.75 - e) / 2.0), -p * e2 / 2.0, -p * e2 * e / 3.0],
    ]
}

/// Loads of the four downwashes held for ever, `[load][downwash]`: Glauert's series over `beta`.
pub fn steady_loads(mach: f64, flap_chord: f64) -> [[f64; 4]; 3] {
    let hinge = hinge_angle(flap_chord);
    let beta = (1.0 - mach * mach).sqrt();
    let mut steady = [[0.0; 4]; 3];
    for n in 0..TERMS_OF_STEADY_HINGE {
        let weights = [
            [0.5 * PI, 0.25 * PI, 0.0].get(n).copied().unwrap_or(0.0),
            [0.0, -PI / 16.0, PI / 16.0].get(n).copied().unwrap_or(0.0),
            if flap_chord > 0.0 { hinge_weight(n, hinge) } else { 0.0 },
        ];
        for (j, w) in downwash(n, hinge).into_iter().enumerate() {
            let a = steady_coefficient(n, w, beta);
            for (row, weight) in steady.iter_mut().zip(weights) {
                row[j] += weight * a;
            }
        }
    }
    steady
}

/// Loading coefficient of a steady downwash coefficient, `w = (beta/4) (a_0 - sum a_n cos)`.
pub(crate) fn steady_coefficient(n: usize, w: f64, beta: f64) -> f64 {
    4.0 / beta * if n == 0 { w } else { -w }
}

/// The terms fall like `n^-3`: what is left out is below 1e-10.
const TERMS_OF_STEADY_HINGE: usize = 40_000;
