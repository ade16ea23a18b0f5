//! The shipped bench records: stroke of the flap against frequency, beside what the paper reports.
//!
//! The records are synthetic; they were generated for the paper's two amplitudes.
//!
//! ```text
//! cargo run -p measured-data --example bench_stroke
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use measured_data::{Folder, problem::Problems, read_bench};
use std::path::PathBuf;

/// Flap amplitudes of the paper at 85 V, deg.
const PAPER: [(&str, &str); 2] = [("major_0p2hz", "10"), ("sine_15hz_85v", "about 4")];

fn amplitude(samples: &[f64]) -> f64 {
    let range =
        samples.iter().fold([f64::MAX, f64::MIN], |[low, high], &x| [low.min(x), high.max(x)]);
    0.5 * (range[1] - range[0])
}

fn main() -> Result<(), Problems> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/bench/apa500l_synthetic");
    let bench = read_bench(&Folder::Disk(PathBuf::from(folder)))?;
    println!("{}", bench.title);
    let gain = bench.flap_deg_per_um.unwrap_or(f64::NAN);
    println!("\nrun                  samples  step, ms  amplitude, V      um  flap, deg  paper");
    for run in &bench.runs {
        let table = &run.table;
        // the last half: the start from rest is over
        let half = table.time_s.len() / 2;
        let (volt, um) = (amplitude(&table.input[half..]), amplitude(&table.output[half..]));
        let paper = PAPER.iter().find(|(id, _)| *id == run.entry.id).map_or("", |(_, deg)| deg);
        println!(
            "{:20} {:7} {:9.2} {volt:13.1} {um:7.1} {:10.2}  {paper}",
            run.entry.id,
            table.time_s.len(),
            1e3 * table.time_step_s,
            gain * um,
        );
    }
    for warning in &bench.warnings {
        println!("warning: {warning}");
    }
    Ok(())
}
