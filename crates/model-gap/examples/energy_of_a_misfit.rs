//! What a simulation leaves of a measured record: which part is noise, which part a better model could explain.
//!
//! The "measurement" is a flap motion at 3/rev (15 Hz) with noise. The simulations lack its lag, its amplitude,
//! its third harmonic, or nothing; the exact NRMSE without noise stands beside.
//!
//! ```text
//! cargo run -p model-gap --example energy_of_a_misfit
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use model_gap::{EnergySplit, FirstHarmonicError, GapError, Misfit, noise_variance};
use std::f64::consts::TAU;

const TIME_STEP_S: f64 = 1.0 / 3000.0;
const FREQUENCY_HZ: f64 = 15.0;

/// Amplitude in deg, lag in deg of the harmonic, share of a third harmonic.
fn wave(amplitude: f64, lag_deg: f64, third: f64) -> Vec<f64> {
    let phase = |i: u32| TAU * FREQUENCY_HZ * f64::from(i) * TIME_STEP_S - lag_deg.to_radians();
    (0..4000).map(|i| amplitude * (phase(i).cos() + third * (3.0 * phase(i)).cos())).collect()
}

/// Uniform noise of a linear congruential generator, standard deviation 0.02 deg.
fn noise() -> impl Iterator<Item = f64> {
    let next = |state: &u32| Some(state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    std::iter::successors(Some(1), next)
        .map(|state| 0.02 * 12.0_f64.sqrt() * (f64::from(state) / f64::from(u32::MAX) - 0.5))
}

fn main() -> Result<(), GapError> {
    let measured: Vec<f64> =
        wave(4.0, 41.0, 0.05).iter().zip(noise()).map(|(y, n)| y + n).collect();
    let variance = noise_variance(&measured, TIME_STEP_S, FREQUENCY_HZ)?;
    println!("noise from repeated cycles: {:.4} deg (planted 0.0200)", variance.sqrt());
    println!(
        "simulation lacks    NRMSE %  exact %  gain error %  phase error  noise %  structured %"
    );
    let lag = 2.0 * (0.5 * 41.0_f64.to_radians()).sin();
    for (lacks, simulated, exact) in [
        ("the lag", wave(4.0, 0.0, 0.0), lag.hypot(0.05)),
        ("10 % of gain", wave(3.6, 41.0, 0.05), 0.1 * 1.0_f64.hypot(0.05)),
        ("third harmonic", wave(4.0, 41.0, 0.0), 0.05),
        ("nothing", wave(4.0, 41.0, 0.05), 0.0),
    ] {
        let misfit = Misfit::of(&measured, &simulated)?;
        let first = FirstHarmonicError::of(&measured, &simulated, TIME_STEP_S, FREQUENCY_HZ)?;
        let energy = EnergySplit::of(&measured, &simulated, variance)?;
        println!(
            "{lacks:16} {:10.2} {:8.2} {:11.2} {:10.1} deg {:9.4} {:11.4}",
            100.0 * misfit.nrmse,
            100.0 * exact / 1.0_f64.hypot(0.05),
            100.0 * (first.amplitude_ratio - 1.0),
            first.phase_error_deg,
            100.0 * energy.noise,
            100.0 * energy.structured,
        );
    }
    Ok(())
}
