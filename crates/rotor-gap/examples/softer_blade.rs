//! A blade whose torsional stiffness is 15 % less than its simulation says, found from its frequencies.
//!
//! ```text
//! cargo run --release -p rotor-gap --example softer_blade
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use measured_data::{DatasetKind, PointData, Source};
use rotor_case::Case;
use rotor_gap::CaseQuestion;
use rotor_gap::blade::{Frequencies, diagnose_blade, usual_blade_uncertain};
use rotor_study::{ModesQuestion, numbered, rotating_modes};
use std::fmt::Write;

const MODES: [&str; 6] = ["flap 1", "flap 2", "flap 3", "lag 1", "lag 2", "torsion 1"];

/// The table of a bench on which the softer blade was spun up: every frequency to 0.3 %.
fn measured() -> Result<String, Box<dyn std::error::Error>> {
    let mut blade = Case::default();
    blade.rotor.gj *= 0.85;
    let speed_ratios = vec![0.0, 0.4, 0.7, 1.0];
    let question = ModesQuestion { speed_ratios: speed_ratios.clone(), ..ModesQuestion::default() };
    let found = rotating_modes(&blade, &question)?;
    let mut table = String::from("rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n");
    for (ratio, at) in speed_ratios.iter().zip(&found.fan) {
        let rpm = ratio * blade.rotor.omega_rpm;
        for (name, mode) in numbered(&at.modes).zip(&at.modes) {
            if MODES.contains(&name.as_str()) {
                writeln!(table, "{rpm},{name},{},{}", mode.hz, 0.003 * mode.hz)?;
            }
        }
    }
    Ok(table)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let source = Source { name: "spun_up.csv".into(), text: measured()? };
    let points = PointData::read_with(&source, DatasetKind::BladeFrequencies.words())?;
    let case = Case::default();
    let uncertain = usual_blade_uncertain();
    let question =
        CaseQuestion { case: &case, uncertain: &uncertain, only: &[], begun: &|_, _| {} };
    let own = diagnose_blade(&question, &Frequencies::of(&points)?)?;
    println!("verdict: {:?}", own.found.finding.verdict);
    for cause in &own.found.finding.causes {
        println!("missing: {}", own.found.candidates[cause.candidate].id);
    }
    if let Some(extended) = &own.extended {
        let share = extended.rotor.gj / case.rotor.gj;
        println!("torsional stiffness over that of the simulation: {share:.3}, true 0.850");
    }
    Ok(())
}
