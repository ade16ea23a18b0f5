//! A monitor of backlash: how it sees a gap grow from nothing, and the C code that does the same on board.
//!
//! ```text
//! cargo run --release -p actuator-export --example watch_a_flap
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use actuator_export::{Monitor, Target, export_monitor};
use preisach_dyn::{ActuatorModel, Backlash, LinkageStage, VoltageRange};
use std::f64::consts::TAU;

const STEP_S: f64 = 5e-4;

/// 10 deg over the range, 0.04 deg/um, with a gap.
fn actuator(width_um: f64) -> ActuatorModel {
    let linkage = vec![LinkageStage::Backlash(Backlash { width_um })];
    ActuatorModel { linkage, ..ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04) }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (sound, worn) = (actuator(0.0), actuator(6.0));
    let monitor = Monitor {
        base: &sound,
        extended: &worn,
        cause: "backlash of 6 um",
        threshold_deg: 0.02,
        memory_s: 0.5,
    };
    let volts: Vec<f64> =
        (0..6000).map(|i| 65.0 + 50.0 * (TAU * 10.0 * STEP_S * f64::from(i)).sin()).collect();
    println!("gap, um   residual, deg   amount   seen");
    for gap_um in [0.0, 0.5, 1.5, 3.0, 6.0] {
        let measured = actuator(gap_um).simulate(&volts, STEP_S)?.output_deg;
        if let Some(last) = monitor.watch(&volts, &measured, STEP_S)?.last() {
            let (residual, amount) = (last.residual_deg, last.amount);
            println!("{gap_um:7.1}   {residual:13.4}   {amount:6.2}   {:?}", last.seen);
        }
    }
    for (name, text) in export_monitor(&monitor, "watch", STEP_S, Target::C)? {
        println!("{name}: {} lines", text.lines().count());
    }
    Ok(())
}
