//! What an amplifier of limited current leaves of a voltage, over frequency: amplitude and lag.
//!
//! ```text
//! cargo run -p actuator-stages --example slew_limit
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use actuator_stages::{AmplifierStage, CurrentLimit, Lag, StageError, Step};
use std::f64::consts::TAU;

/// Drive at the bench: amplitude about a bias, V.
const AMPLITUDE_VOLT: f64 = 85.0;
const BIAS_VOLT: f64 = 65.0;
/// 80 mA into 10 uF.
const SLEW_RATE_VOLT_PER_S: f64 = 8000.0;
const SAMPLES_PER_CYCLE: u32 = 2000;
const CYCLES: u32 = 6;

/// Amplitude (V) and lag (deg) of the first harmonic behind the stages, over the last cycle.
fn behind(stages: &[AmplifierStage], frequency_hz: f64) -> (f64, f64) {
    let per_sample = TAU / f64::from(SAMPLES_PER_CYCLE);
    let phases: Vec<f64> =
        (0..SAMPLES_PER_CYCLE * CYCLES).map(|i| f64::from(i) * per_sample).collect();
    let mut volt: Vec<f64> = phases.iter().map(|p| BIAS_VOLT + AMPLITUDE_VOLT * p.sin()).collect();
    let step_s = per_sample / (TAU * frequency_hz);
    for stage in stages {
        stage.prepared(step_s).pass(&mut volt);
    }
    let last = SAMPLES_PER_CYCLE as usize;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (phase, value) in phases.iter().zip(&volt).rev().take(last) {
        sine += value * phase.sin() * per_sample / (0.5 * TAU);
        cosine += value * phase.cos() * per_sample / (0.5 * TAU);
    }
    (sine.hypot(cosine), (-cosine).atan2(sine).to_degrees())
}

fn main() -> Result<(), StageError> {
    let stages = [
        AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: SLEW_RATE_VOLT_PER_S }),
        AmplifierStage::Lag(Lag { tau_s: 5e-4 }),
    ];
    for stage in &stages {
        stage.checked().1?;
    }
    println!("   Hz   amplitude, V   lag, deg");
    for frequency_hz in [1.0, 5.0, 10.0, 15.0, 20.0, 30.0] {
        let (amplitude_volt, lag_deg) = behind(&stages, frequency_hz);
        println!("{frequency_hz:5.0} {amplitude_volt:14.1} {lag_deg:10.1}");
    }
    Ok(())
}
