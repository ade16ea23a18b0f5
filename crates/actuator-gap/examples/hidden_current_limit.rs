//! A bench with an effect that its reference runs do not have: which cause is named, and how large?
//!
//! The actuator is a Preisach model; on the measured runs its amplifier can deliver a limited current.
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use actuator_gap::{Question, Record, Records, diagnose};
use measured_data::Accuracy;
use model_gap::Findings;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, CurrentLimit, Drive, PlayMap,
    PreisachError, PreisachGrid, StaticPreisach, VoltageRange,
};

const STEP_S: f64 = 1e-3;
const DEG_PER_UM: f64 = 0.04;
/// Largest current over the capacitance of the actuator, V/s.
const PLANTED_SLEW_RATE: f64 = 4000.0;

/// A multisine from 1 to 31 Hz about the bias, V.
fn command(amplitude_volt: f64) -> Vec<f64> {
    let tone = |t: f64, hz: f64| (std::f64::consts::TAU * hz * t + hz * hz).sin();
    let wave = |t| [1.0, 3.0, 7.0, 13.0, 19.0, 31.0].map(|hz| tone(t, hz)).iter().sum::<f64>();
    (0..6000).map(|i| 65.0 + amplitude_volt / 6.0 * wave(f64::from(i) * STEP_S)).collect()
}

fn run(id: &str, is_reference: bool, amplitude_volt: f64) -> Result<Record, PreisachError> {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 12)?;
    let rises: Vec<Vec<f64>> =
        (0..12).map(|play| vec![if play == 0 { 1.2 } else { 0.06 }; 12 - play]).collect();
    let law = StaticPreisach::new(grid, PlayMap::from_rises(&grid, 0.0, &rises)?)?;
    let calibration = Calibration { deg_per_um: DEG_PER_UM, zero_um: 0.0 };
    let mut actuator =
        ActuatorModel::new(ActuatorLaw::StaticPreisach(law), grid.range(), calibration);
    if !is_reference {
        let limit = CurrentLimit { slew_rate_volt_per_s: PLANTED_SLEW_RATE };
        actuator.amplifier = vec![AmplifierStage::CurrentLimit(limit)];
    }
    let input = command(amplitude_volt);
    let bench = actuator.simulate_bench(&Drive::new(&input, STEP_S))?;
    let noise = (0_u32..).map(|i| f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5);
    let output = bench.measured_deg.iter().zip(noise).map(|(y, n)| y / DEG_PER_UM + n).collect();
    let amplifier = Some(bench.terminal_volt);
    Ok(Record { is_reference, amplifier, ..Record::new(id, STEP_S, input, output) })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runs = [("large", 80.0), ("middle", 55.0), ("small", 30.0)]
        .map(|(id, volt)| [run(&format!("reference, {id}"), true, volt), run(id, false, volt)]);
    let runs = runs.into_iter().flatten().collect::<Result<_, _>>()?;
    let records = Records {
        title: "a planted current limit".into(),
        folder: "none".into(),
        range: (-20.0, 150.0),
        input_unit: "V".into(),
        output_unit: "um".into(),
        input_label: "command_V".into(),
        output_label: "displacement_um".into(),
        deg_per_um: Some(DEG_PER_UM),
        accuracy: Accuracy::default(),
        is_bench: true,
        content_hash: String::new(),
        runs,
    };
    let found = Findings::from(&diagnose(&records, &Question::default())?);
    println!("verdict: {:?}, {:?}", found.verdict, found.confidence);
    for (cause, parameters) in &found.parameters {
        for (name, value) in parameters {
            let [low, high] = value.ci95;
            println!("  {cause}: {name} {:.0} {} ({low:.0} to {high:.0})", value.value, value.unit);
        }
    }
    println!("planted: amplifier-current-limit: slew_rate {PLANTED_SLEW_RATE} V/s");
    if let Some(gain) = found.gain {
        let (before, after) = (gain.heldout_rms_before, gain.heldout_rms_after);
        println!("held-out error: {before:.2} um -> {after:.2} um; noise 0.29 um");
    }
    Ok(())
}
