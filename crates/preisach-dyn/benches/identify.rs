//! Identification of the shipped bench set, and of a record of ten million samples.
//!
//! Budget: 6 s on two cores for everything the shipped set is used for: the dynamic Preisach model, the
//! table of all models, cross-validation of family and order. Runs once and prints the figures beside
//! their bars.
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock and fixtures")]
#![expect(clippy::print_stdout, reason = "a benchmark reports")]

use preisach_dyn::identify::{
    BenchRecord, Candidates, RecordUse, Settings, StaticAccumulator, compare_models, identify,
};
use preisach_dyn::{PreisachError, StartState};
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

const BAR_S: f64 = 6.0;
const DEG_PER_UM: f64 = 0.039_537_815;
const STREAMED: usize = 10_000_000;

fn records() -> Result<Vec<BenchRecord>, Box<dyn Error>> {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/bench/apa500l_synthetic");
    let list = std::fs::read_to_string(folder.join("dataset.ron"))?;
    let files = list.split("file: \"").skip(1).filter_map(|rest| rest.split('"').next());
    files
        .map(|file| {
            let text = std::fs::read_to_string(folder.join(file))?;
            let rows = text
                .lines()
                .skip(1)
                .map(|line| line.split(',').map(str::parse).collect())
                .collect::<Result<Vec<Vec<f64>>, _>>()?;
            Ok(BenchRecord {
                id: file.trim_end_matches(".csv").to_owned(),
                time_step_s: (rows[rows.len() - 1][0] - rows[0][0]) / (rows.len() - 1) as f64,
                voltage_volt: rows.iter().map(|row| row[1]).collect(),
                output_deg: rows.iter().map(|row| row[2] * DEG_PER_UM).collect(),
                ..BenchRecord::default()
            })
        })
        .collect()
}

fn shipped_set() -> Result<(), Box<dyn Error>> {
    let records = records()?;
    let settings = Settings { deg_per_um: DEG_PER_UM, ..Settings::default() };
    let start = Instant::now();
    identify(&records, &settings)?;
    let first_s = start.elapsed().as_secs_f64();
    let table = compare_models(&records, &settings, &Candidates::default(), &|| ())?;
    let spent_s = start.elapsed().as_secs_f64();
    println!(
        "shipped set: dynamic Preisach {first_s:.2} s, with the table of models {spent_s:.2} s, {:.2} of the bar of {BAR_S} s",
        spent_s / BAR_S
    );
    println!("{:40} levels  left out  trained  held out  worst held out, NRMSE in %", "model");
    for row in table.rows.iter().chain(&table.orders) {
        let over = |u: RecordUse| table.error_over(row, u).unwrap_or((f64::NAN, f64::NAN));
        let (trained, held_out) = (over(RecordUse::Train), over(RecordUse::HeldOut));
        println!(
            "{:40} {:6} {:9.2} {:8.2} {:9.2} {:15.2}",
            row.family.name(),
            row.order.levels,
            100.0 * row.cross_validation.unwrap_or(f64::NAN),
            100.0 * trained.0,
            100.0 * held_out.0,
            100.0 * held_out.1
        );
    }
    if let Some(best) = table.best() {
        println!("chosen: {}, {} levels", best.family.name(), best.order.levels);
        if let Ok(fitted) = &best.fitted {
            for ((id, record_use), fit) in table.records.iter().zip(&fitted.fits) {
                let phase = fit.phase_error_deg.unwrap_or(f64::NAN);
                println!(
                    "  {id:22} {record_use:?} {:.2} %, phase {phase:+.2} deg",
                    fit.nrmse_percent()
                );
            }
            for p in &fitted.parameters {
                println!("  {}: {:.4} +- {:.4}", p.name, p.value, p.std_deviation);
            }
        }
    }
    Ok(())
}

fn streamed() -> Result<(), PreisachError> {
    let settings = Settings::default();
    let mut stream = StaticAccumulator::new(&settings, 16)?;
    let model = preisach_dyn::ActuatorModel::linear(settings.range_volt, 10.0, 1.0);
    let stepper = model.stepper(1e-4)?;
    let mut memory = model.start(65.0, StartState::Rest)?;
    let (mut volts, mut outputs) = (Vec::new(), Vec::new());
    let start = Instant::now();
    let mut done = 0;
    while done < STREAMED {
        volts.clear();
        outputs.clear();
        for i in done..done + 100_000 {
            let t = i as f64 * 1e-4;
            volts.push(65.0 + (40.0 + 0.04 * t) * (3.0 * t).sin());
            outputs.push(stepper.step(&mut memory, volts[volts.len() - 1], 0.0)?);
        }
        stream.push(&volts, &outputs)?;
        done += volts.len();
    }
    stream.fit()?;
    println!(
        "{STREAMED} samples streamed in {:.2} s, {} numbers kept",
        start.elapsed().as_secs_f64(),
        stream.kept_numbers()
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo test --benches` only wants to know that this compiles
    if std::env::args().any(|arg| arg == "--bench") {
        shipped_set()?;
        streamed()?;
    }
    Ok(())
}
