//! Writes the synthetic NACA 0012 table of `fixtures/airfoils`:
//!
//! ```text
//! cargo run -p flap-aero --example naca0012_synthetic > fixtures/airfoils/naca0012_synthetic.c81
//! ```
//! No measurement is in it. The law, `alpha` in rad, `s = 1` up to 25 deg, `0` from 45 deg, a cubic between:
//!
//! ```text
//! Cn = s (2 pi/beta) alpha K(f) + (1 - s) 1.9 sin(alpha),   K(f) = ((1 + sqrt f)/2)^2
//! Cc = s eta (2 pi/beta) alpha^2 sqrt f
//! Cl = Cn cos(alpha) + Cc sin(alpha),   Cd = 0.0080 + 0.2 max(M - 0.75, 0) + Cn sin(alpha) - Cc cos(alpha)
//! Cm = s [k0 + k1 (1 - f) + k2 sin(pi f^2)] (2 pi/beta) alpha K(f) - (1 - s) 0.45 sin(alpha) (1 - cos(alpha)/4)
//! from behind (beyond 135 deg):   Cn with alpha - pi in the first term and f of half the stall angle,   Cc = 0
//! ```
//! `f` and its constants are the static part of Leishman and Beddoes's stall of the NACA 0012
//! (`StallParameters::naca_0012`), so that table and dynamic stall agree on the static curve.
#![expect(clippy::print_stdout, reason = "the table is what it prints")]

use flap_aero::{AeroError, C81Airfoil, C81Table, Mach, StallParameters};
use std::f64::consts::{PI, TAU};

const MACHS: [f64; 9] = [0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.9];

/// Every degree to 20, every second to 30, every fifth or tenth beyond: a file holds 99 at most.
fn incidences_deg() -> Vec<f64> {
    let near = (1..=20).map(f64::from);
    let middle = (11..=15).map(|i| 2.0 * f64::from(i));
    let far = [35, 40, 45, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 155, 160, 165, 170];
    let last = far.into_iter().chain([175, 180]).map(f64::from);
    let positive: Vec<f64> = near.chain(middle).chain(last).collect();
    let negative = positive.iter().rev().map(|a| -a);
    negative.chain([0.0]).chain(positive.iter().copied()).collect()
}

/// `[Cl, Cd, Cm]`.
fn coefficients(degrees: f64, mach: f64) -> Result<[f64; 3], AeroError> {
    let (alpha, mach_number) = (degrees.to_radians(), Mach::new(mach)?);
    let p = StallParameters::naca_0012(mach_number);
    let slope = TAU / mach_number.beta();
    let share = |from: f64, to: f64| {
        let t = ((degrees.abs() - from) / (to - from)).clamp(0.0, 1.0);
        1.0 - t * t * (3.0 - 2.0 * t)
    };
    let (ahead, behind) = (share(25.0, 45.0), 1.0 - share(135.0, 165.0));
    let f = p.separation(alpha);
    let attached = slope * alpha * StallParameters::kirchhoff(f);
    let reversed = alpha - PI.copysign(alpha);
    let f_reversed = p.separation(2.0 * reversed);
    let from_behind = -slope * reversed * StallParameters::kirchhoff(f_reversed);
    let plate = 1.9 * alpha.sin();
    let between = 1.0 - ahead - behind;
    let normal = ahead * attached + between * plate + behind * from_behind;
    let chord = ahead * p.eta * slope * alpha * alpha * f.sqrt();
    let arm = p.k0 + p.k1 * (1.0 - f) + p.k2 * (PI * f * f).sin();
    let (sin, cos) = alpha.sin_cos();
    let moment = ahead * arm * attached - (1.0 - ahead) * 0.45 * sin * (1.0 - 0.25 * cos);
    let drag = 0.008 + 0.2 * (mach - 0.75).max(0.0) + normal * sin - chord * cos;
    // four decimals: with more, negative numbers would lose one that positive ones keep
    Ok([normal * cos + chord * sin, drag, moment].map(|c| (1e4 * c).round() / 1e4))
}

fn main() -> Result<(), AeroError> {
    let angles = incidences_deg();
    let mut values = [const { Vec::new() }; 3];
    for degrees in &angles {
        for mach in MACHS {
            for (column, value) in values.iter_mut().zip(coefficients(*degrees, mach)?) {
                column.push(value);
            }
        }
    }
    let table = |values: Vec<f64>| C81Table::new(MACHS.to_vec(), angles.clone(), values);
    let [lift, drag, moment] = values;
    let name = "NACA 0012 SYNTHETIC, NOT MEAS".to_owned();
    let own = C81Airfoil { name, lift: table(lift)?, drag: table(drag)?, moment: table(moment)? };
    print!("{}", own.rounded().write()?);
    Ok(())
}
