//! `truth`: writes synthetic measurements.
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "this command writes the files"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use truth::actuator::ActuatorParameters;
use truth::bench;
use truth::error::TruthError;
use truth::report;

/// Generates synthetic measurements from a known physics that no model of the product contains.
///
/// The physics (domain-wall hysteresis, relaxation, creep, sensor) is described in the README that
/// is written beside the data, and with equations and sources in this package's documentation.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Which data set to write.
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Bench records of an APA500L-like amplified piezo actuator: CSV files, dataset.ron, README.md.
    Bench {
        /// Folder to write to; created if missing, files of the same name are replaced.
        #[arg(long)]
        out: PathBuf,
        /// Seed of the sensor noise.
        #[arg(long, default_value_t = bench::SEED)]
        seed: u64,
    },
}

fn main() -> ExitCode {
    let What::Bench { out, seed } = Arguments::parse().what;
    match write_bench(&out, seed) {
        Ok(files) => {
            println!("{files} files written to {}; README.md holds the table", out.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write_bench(out: &Path, seed: u64) -> Result<usize, TruthError> {
    let files = report::files(&bench::generate(ActuatorParameters::apa500l(), seed)?)?;
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| TruthError::Write { path, source }
    };
    std::fs::create_dir_all(out).map_err(failed(out))?;
    for (name, content) in &files {
        // A neighbour is written first and then takes the name: no half-written file is left.
        let (path, part) = (out.join(name), out.join(format!("{name}.part")));
        std::fs::write(&part, content).map_err(failed(&part))?;
        std::fs::rename(&part, &path).map_err(failed(&path))?;
    }
    Ok(files.len())
}
