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
use truth::hidden::{self, EXPERIMENTS, Hidden, Request, Size};
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
    /// A reference folder and a measured folder with an effect that a hash of the seed chooses.
    Hidden(HiddenArguments),
}

#[derive(Debug, clap::Args)]
struct HiddenArguments {
    /// Folder to write to: it gets `reference` and `measured`.
    #[arg(long)]
    out: PathBuf,
    /// Chooses base, effect, strength, and noise.
    #[arg(long)]
    seed: u64,
    /// Rms of the output over that of the noise, dB.
    #[arg(long, default_value_t = 40.0)]
    snr: f64,
    /// File for the answer; left out, nobody learns it.
    #[arg(long)]
    answer: Option<PathBuf>,
    /// Another effect than the seed's own: `null`, a cause, two causes joined by `+`, `outside-...`.
    #[arg(long)]
    effect: Option<String>,
    /// Another base than the seed's own, 0 to 11.
    #[arg(long)]
    base: Option<u64>,
    /// Another strength than the seed's own: rms of the effect over that of the output.
    #[arg(long)]
    share: Option<f64>,
    /// A further experiment of the catalogue, or several joined by `+`.
    #[arg(long, value_parser = known_experiment)]
    experiment: Option<String>,
    /// Another draw of the noise of the measured runs, for the same truth.
    #[arg(long, default_value_t = 0)]
    replicate: u64,
    /// Long records: 20 runs, about 5e5 samples.
    #[arg(long)]
    full: bool,
}

/// An experiment of the catalogue, or several joined by `+`.
fn known_experiment(text: &str) -> Result<String, String> {
    if hidden::is_experiment(text) {
        Ok(text.to_owned())
    } else {
        Err(format!("none of {}, nor several of them joined by `+`", EXPERIMENTS.join(", ")))
    }
}

fn main() -> ExitCode {
    let written = match Arguments::parse().what {
        What::Bench { out, seed } => write_bench(&out, seed).map(|files| {
            format!("{files} files written to {}; README.md holds the table", out.display())
        }),
        What::Hidden(arguments) => write_hidden(&arguments)
            .map(|files| format!("{files} files written to {}", arguments.out.display())),
    };
    match written {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write_bench(out: &Path, seed: u64) -> Result<usize, TruthError> {
    write_folder(out, &report::files(&bench::generate(ActuatorParameters::apa500l(), seed)?)?)
}

fn write_hidden(arguments: &HiddenArguments) -> Result<usize, TruthError> {
    let request = Request {
        seed: arguments.seed,
        snr_db: arguments.snr,
        hidden: arguments.effect.as_deref().map(Hidden::parse).transpose()?,
        base: arguments.base,
        share: arguments.share,
        experiment: arguments.experiment.clone(),
        size: if arguments.full { Size::Full } else { Size::Small },
        replicate: arguments.replicate,
    };
    let base = request.assignment().base;
    let reference = hidden::reference_files(base, request.snr_db, request.size)?;
    let set = hidden::measured_set(&request)?;
    let mut written = write_folder(&arguments.out.join("reference"), &reference)?;
    written += write_folder(&arguments.out.join("measured"), &set.files)?;
    if let Some(path) = &arguments.answer {
        let failed = |source| TruthError::Write { path: path.clone(), source };
        let text = serde_json::to_string_pretty(&set.answer)
            .map_err(|error| failed(std::io::Error::other(error)))?;
        std::fs::write(path, text + "\n").map_err(failed)?;
    }
    Ok(written)
}

/// Writes files into a folder; those of the same name are replaced.
fn write_folder(out: &Path, files: &[(String, String)]) -> Result<usize, TruthError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| TruthError::Write { path, source }
    };
    std::fs::create_dir_all(out).map_err(failed(out))?;
    for (name, content) in files {
        // A neighbour is written first and then takes the name: no half-written file is left.
        let (path, part) = (out.join(name), out.join(format!("{name}.part")));
        std::fs::write(&part, content).map_err(failed(&part))?;
        std::fs::rename(&part, &path).map_err(failed(&path))?;
    }
    Ok(files.len())
}
