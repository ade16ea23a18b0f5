//! Lift of an oscillating flap by three models, beside the exact solution of Possio's equation.
//!
//! ```text
//! cargo run -p flap-aero --example flap_lift
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use flap_aero::{AeroError, AttachedFlowModel, FlapChord, Mach, Motion, harmonic_response};

/// Mach number, real and imaginary part of `Cn` per rad of flap angle: flap of 0.2 chord, reduced frequency
/// 0.3, from `fixtures/reference/aero/possio_flap.csv`.
const POSSIO: [(f64, f64, f64); 3] = [
    (0.3, 2.367_832_20, -0.410_639_880),
    (0.5, 2.401_210_31, -0.622_476_039),
    (0.7, 2.342_700_62, -1.048_283_85),
];

fn main() -> Result<(), AeroError> {
    let flap = FlapChord::new(0.2)?;
    println!("Mach  model                 Cn real   Cn imag   error, % of |Cn|");
    for (mach, real, imaginary) in POSSIO {
        println!("{mach:4}  {:20} {real:8.4}  {imaginary:8.4}", "Possio (exact)");
        for model in [
            AttachedFlowModel::QuasiSteady,
            AttachedFlowModel::HariharanLeishman,
            AttachedFlowModel::Calibrated,
        ] {
            let section = model.coefficients(Mach::new(mach)?, flap)?;
            let [cn, _, _] = harmonic_response(&section, 0.3, Motion::Flap);
            let error = (cn.re - real).hypot(cn.im - imaginary) / real.hypot(imaginary);
            let name = format!("{model:?}");
            println!("      {name:20} {:8.4}  {:8.4}  {:8.1}", cn.re, cn.im, 100.0 * error);
        }
    }
    Ok(())
}
