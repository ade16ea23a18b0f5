//! Loads in the first moments after a step, in closed form.
//!
//! ```text
//! t = S/(2M) = a time / chord,    m = 1 - M
//! ```
//! Exact until a pressure wave has crossed what it loads: the chord for `alpha` and `q`,
//! `t <= 1/(1 + M)`; the flap for `delta`, `q_delta` and the hinge moment, `t <= E/(1 + M)`, before the
//! wave of the leading edge has come to it, `t <= (1 - E)/(1 + M)`.
//!
//! Source: Lomax, Heaslet, Fuller and Sluder, NACA Report 1077 (1952), for `alpha` and `q`; the flap
//! by the same rule (Evvard's, in the x-t plane), derived for this project.

use crate::ExactError;

/// A load that has a closed form: `[alpha, q, delta, q_delta]`, none where it has not.
pub type ShortTime = [[Option<f64>; 4]; 3];

/// Loads `[Cn, Cm, Ch]` at the distance `semichords` after a unit step of each downwash; `None`
/// beyond the reach of the closed form.
///
/// # Errors
/// [`ExactError::OutOfRange`] unless `0 < mach < 1`, `0 < flap_chord < 1` and `semichords >= 0`.
pub fn short_time(mach: f64, flap_chord: f64, semichords: f64) -> Result<ShortTime, ExactError> {
    for (quantity, value, fits) in [
        ("Mach number", mach, mach > 0.0 && mach < 1.0),
        ("flap chord ratio", flap_chord, flap_chord > 0.0 && flap_chord < 1.0),
        ("distance", semichords, semichords >= 0.0),
    ] {
        if !fits {
            return Err(ExactError::OutOfRange { quantity, value });
        }
    }
    let t = 0.5 * semichords / mach;
    let m = 1.0 - mach;
    let mut loads = [[None; 4]; 3];
    // a whole crossing is within reach, rounding included
    let reach = |chord: f64| t <= chord / (1.0 + mach) * (1.0 + 1e-12);
    if reach(1.0) {
        let [cn, cm] = rigid(mach, m, t);
        for j in 0..2 {
            loads[0][j] = Some(cn[j]);
            loads[1][j] = Some(cm[j]);
        }
    }
    if reach(flap_chord) {
        let (cn, cm, ch) = flapped(mach, m, flap_chord, t);
        for (row, values) in loads.iter_mut().zip([cn, cm]) {
            row[2] = Some(values[0]);
            row[3] = Some(values[1]);
        }
        loads[2][2] = Some(ch);
    }
    if reach(flap_chord.min(1.0 - flap_chord)) {
        let [alpha, q, rate] = hinge(mach, m, flap_chord, t);
        loads[2][0] = Some(alpha);
        loads[2][1] = Some(q);
        loads[2][3] = Some(rate);
    }
    Ok(loads)
}

/// `Cn` and `Cm` of `alpha` and `q`.
fn rigid(mach: f64, m: f64, t: f64) -> [[f64; 2]; 2] {
    let (p, t2, t3) = (1.0 / mach, t * t, t * t * t);
    let wave = mach * (2.0 - mach) * t2;
    let cubic = 2.0 * (1.0 + mach + 3.0 * mach.powi(2) - mach.powi(3)) * t3;
    [
        [4.0 * p * (1.0 - m * t), p * (1.0 - m * t + wave)],
        [-p * (1.0 - m * t - wave), -p / 12.0 * (7.0 - 15.0 * m * t + 6.0 * m * m * t2 + cubic)],
    ]
}

/// `Ch` of `alpha`, `q` and `q_delta`.
///
/// The trailing edge takes from a downwash `1` the force `m t/2` with the moment `3 m^2 t^2/16` about the edge,
/// from a downwash `-s` (`s` ahead of the edge) `m^2 t^2/16` and `m^3 t^3/48`, times `4/M`. The bend at the
/// hinge gives the flap the moment `t^3 X` about it: the response to a step of the downwash there has the slope
/// `S' = (1 - M/y)/(pi sqrt(1 - (y - M)^2))` in `y`, the distance aft over `t`, and `X = int y^3 S' dy / 6`.
fn hinge(mach: f64, m: f64, e: f64, t: f64) -> [f64; 3] {
    let p = 4.0 / mach;
    let (mt, e2) = (m * t, e * e);
    let even = 0.5 * e * mt - 0.1875 * mt * mt;
    let sloped = e * mt * mt / 16.0 - mt * mt * mt / 48.0;
    let beta = (1.0 - mach * mach).sqrt();
    let quarter = std::f64::consts::FRAC_PI_2;
    let bend = (beta - beta * beta * beta / 3.0 + mach * (quarter + mach.asin()))
        / (6.0 * std::f64::consts::PI);
    [
        -p * (0.5 * e2 - even),
        -p * (0.375 * e2 - e2 * e / 6.0 - 0.75 * even - sloped),
        -p * (e2 * e / 3.0 - e * even - sloped + bend * t * t * t),
    ]
}

/// `Cn` and `Cm` of `delta` and `q_delta`, and `Ch` of `delta`.
fn flapped(mach: f64, m: f64, e: f64, t: f64) -> ([f64; 2], [f64; 2], f64) {
    let p = 4.0 / mach;
    let (t2, t3, m2) = (t * t, t * t * t, m * m);
    let beta = (1.0 - mach * mach).sqrt();
    let share = 0.125 + (mach.asin() + mach * beta) / (4.0 * std::f64::consts::PI);
    let cn =
        [p * (e - 0.5 * m * t), p * (0.5 * e * e - 0.5 * e * m * t - m2 * t2 / 16.0 + 0.25 * t2)];
    let cm = [
        -p * (e * (0.75 - 0.5 * e) - 0.375 * m * t + 0.1875 * m2 * t2 - 0.25 * t2),
        -p * (e * e * (0.375 - e / 6.0) - 0.375 * e * m * t + 0.1875 * e * m2 * t2
            - 3.0 / 64.0 * m2 * t2
            + m2 * m * t3 / 48.0
            + 0.25 * (0.75 - e) * t2
            + mach * t3 / 6.0),
    ];
    let ch = -p * (0.5 * e * e - 0.5 * e * m * t + 0.1875 * m2 * t2 - share * t2);
    (cn, cm, ch)
}
