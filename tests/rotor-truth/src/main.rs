//! Makes a set of points of test of a rotor with a hidden effect.
#![expect(clippy::disallowed_methods, reason = "a generator writes its files")]
#![expect(clippy::print_stdout, reason = "a command says what it wrote")]

use clap::{Parser, ValueEnum};
use rotor_truth::error::RotorTruthError;
use rotor_truth::physics::balance::Resolution;
use rotor_truth::set::made::{Request, make};
use std::path::{Path, PathBuf};

/// Synthetic points of test of a rotor, with a hidden effect.
#[derive(Debug, Parser)]
#[command(name = "rotor-truth", version)]
struct Arguments {
    /// Folder of sweep.csv and case.ron.
    #[arg(long)]
    out: PathBuf,
    /// Seed of everything that is drawn.
    #[arg(long)]
    seed: u64,
    /// Noise below the readings, dB.
    #[arg(long, default_value_t = 40.0)]
    snr_db: f64,
    /// Effect, by its name; left out, the seed draws one.
    #[arg(long)]
    effect: Option<String>,
    /// Size of its first parameter; left out, the seed draws one.
    #[arg(long, allow_negative_numbers = true)]
    size: Option<f64>,
    /// Number of points, 4 to 400; left out, the seed draws 20 to 50.
    #[arg(long)]
    points: Option<usize>,
    /// Whether the uncertain inputs of the case are off by their deviations.
    #[arg(long, value_enum, default_value_t = BaseError::Usual)]
    base_error: BaseError,
    /// File of the answer, outside of the folder.
    #[arg(long)]
    answer: PathBuf,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BaseError {
    None,
    Usual,
}

fn write(path: &Path, text: &str) -> Result<(), RotorTruthError> {
    std::fs::write(path, text)
        .map_err(|source| RotorTruthError::Write { path: path.to_path_buf(), source })
}

fn run(given: Arguments) -> Result<(), RotorTruthError> {
    let made = make(&Request {
        seed: given.seed,
        snr_db: given.snr_db,
        effect: given.effect,
        size: given.size,
        points: given.points,
        base_error: given.base_error == BaseError::Usual,
        resolution: Resolution::default(),
    })?;
    std::fs::create_dir_all(&given.out)
        .map_err(|source| RotorTruthError::Write { path: given.out.clone(), source })?;
    write(&given.out.join("sweep.csv"), &made.sweep_csv)?;
    write(&given.out.join("case.ron"), &made.case_ron)?;
    write(&given.answer, &(serde_json::to_string_pretty(&made.answer)? + "\n"))?;
    println!("{} points written to {}", made.answer.points, given.out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    match run(Arguments::parse()) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rotor-truth: {error}");
            std::process::ExitCode::from(2)
        }
    }
}
