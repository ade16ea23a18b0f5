//! Which blade loads shake the hub: four identical blades pass 3/rev and 5/rev in-plane loads as 4/rev.
//!
//! ```text
//! cargo run -p rotor-base --example hub_harmonics
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_base::{BaseError, HarmonicSeries, RotorScales, rotating_to_fixed, uniform_azimuths_rad};
use std::f64::consts::TAU;

const BLADES: u32 = 4;

fn main() -> Result<(), BaseError> {
    println!("blade load of 1 N    amplitude of the hub force FX, N, at");
    println!("along the blade at     1/rev  2/rev  3/rev  4/rev  5/rev");
    for per_rev in 1..=5 {
        let hub_force: Vec<f64> = uniform_azimuths_rad(64)
            .iter()
            .map(|&azimuth| {
                (0..BLADES)
                    .map(|blade| azimuth + TAU * f64::from(blade) / f64::from(BLADES))
                    .map(|psi| {
                        rotating_to_fixed(psi, [(f64::from(per_rev) * psi).cos(), 0.0, 0.0])[0]
                    })
                    .sum()
            })
            .collect();
        let hub = HarmonicSeries::from_uniform_samples(&hub_force, 5)?;
        let passed: Vec<String> =
            (1..=5).map(|n| format!("{:6.3}", hub.harmonic(n).amplitude())).collect();
        println!("{per_rev:10}/rev         {}", passed.join(" "));
    }

    let scales = RotorScales::new(383.0 * TAU / 60.0, 4.94, 6.46)?;
    println!("\nRotor of the paper (383 rpm, R 4.94 m, m0 6.46 kg/m)");
    println!("  tip speed    {:8.1} m/s", scales.tip_speed_m_s());
    println!("  force unit   {:8.1} kN   m0 Omega^2 R^2", scales.force_newton() / 1e3);
    println!("  moment unit  {:8.1} kN m m0 Omega^2 R^3", scales.moment_newton_metre() / 1e3);
    Ok(())
}
