//! A measured piezo stage: a model identified from its first record, judged on the second.
//!
//! ```text
//! cargo run --release -p bench-study --example stage_from_records
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use bench_study::identification::identify_bench;
use bench_study::{compared, glances};
use measured_data::{DataSet, Folder, read_dataset};
use preisach_dyn::identify::Settings;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/measured/piezo_stage");
    let data = read_dataset(&Folder::Disk(folder.into()))?;
    // what a person checks before anything is computed
    let (runs, subject) = glances(&data);
    for run in &runs {
        println!("{:10} {}", run.id, run.line(subject));
    }
    for said in compared(&runs, subject) {
        println!("{said}");
    }
    let DataSet::Bench(bench) = &data else { return Err("this is no bench".into()) };
    let found = identify_bench(bench, &Settings::default(), None)?;
    println!("{:10} {:>9} {:>14}", "run", "use", "NRMSE, percent");
    for fit in &found.fits {
        println!("{:10} {:>9} {:14.2}", fit.id, format!("{:?}", fit.use_as), fit.nrmse_percent);
    }
    Ok(())
}
