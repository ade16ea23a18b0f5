//! The voltage under which an actuator with hysteresis moves as wanted, and the error left.
//!
//! ```text
//! cargo run --release -p actuator-gap --example voltage_for_a_motion
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use actuator_gap::{StoredActuator, StoredKind};
use measured_data::{EvenRecord, Source};
use preisach_dyn::identify::Settings;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, BoucWen, BoucWenParameters, Calibration, Envelope, VoltageRange,
};
use std::f64::consts::TAU;
use std::fmt::Write;

fn actuator() -> Result<StoredActuator, Box<dyn std::error::Error>> {
    let range_volt = VoltageRange::amplified_stack();
    let law = BoucWen::new(BoucWenParameters {
        range_volt,
        gain_deg_per_volt: 0.12,
        half_height_deg: 0.9,
        rise_volt: 30.0,
        sigma: 0.8,
        exponent: 2.0,
        envelope: Envelope { offset_deg: 0.0, quadratic: 0.0, cubic: 0.0 },
    })?;
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    Ok(StoredActuator {
        kind: StoredKind::Actuator,
        title: "made up".into(),
        dataset: String::new(),
        data_hash: String::new(),
        program_version: String::new(),
        channels: None,
        gain: None,
        settings: Settings::default(),
        runs: Vec::new(),
        model: ActuatorModel::new(ActuatorLaw::BoucWen(law), range_volt, calibration),
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut wanted = "time_s,flap_deg\n".to_owned();
    for i in 0..400 {
        let time_s = 1e-3 * f64::from(i);
        let fade = (time_s / 0.1).min(1.0);
        writeln!(wanted, "{time_s:.3},{:.6}", 3.0 * fade * (TAU * 10.0 * time_s).sin())?;
    }
    let record = EvenRecord::read(&Source { name: "wanted.csv".into(), text: wanted })?;
    let found = actuator()?.inverted(&record)?;
    let largest = found.samples.iter().map(|own| own.input).fold(f64::NEG_INFINITY, f64::max);
    println!("largest voltage {largest:.1} V, {} samples", found.samples.len());
    if let Some(error) = &found.error {
        println!("error left: rms {:.2e} deg, largest {:.2e} deg", error.rms, error.largest);
    }
    Ok(())
}
