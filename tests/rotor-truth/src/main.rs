//! Makes a set of points of test of a rotor, a blade or a section with a hidden effect.
#![expect(clippy::disallowed_methods, reason = "a generator writes its files")]
#![expect(clippy::print_stdout, reason = "a command says what it wrote")]

use clap::{Parser, ValueEnum};
use rotor_truth::asked::Asked;
use rotor_truth::error::RotorTruthError;
use rotor_truth::kind::SetKind;
use std::path::{Path, PathBuf};

/// Synthetic points of test of a rotor, a blade or a section, with a hidden effect.
#[derive(Debug, Parser)]
#[command(name = "rotor-truth", version)]
struct Arguments {
    /// What is tested.
    #[arg(long, value_enum, default_value_t = SetKind::Rotor)]
    kind: SetKind,
    /// Folder of case.ron and sweep.csv, frequencies.csv or loops.csv.
    #[arg(long)]
    out: PathBuf,
    /// Seed of everything that is drawn.
    #[arg(long)]
    seed: u64,
    /// Noise below the readings, dB; left out, 40, of a blade 53.
    #[arg(long)]
    snr_db: Option<f64>,
    /// Effect, by its name; left out, the seed draws one.
    #[arg(long)]
    effect: Option<String>,
    /// Size of its first parameter; left out, the seed draws one.
    #[arg(long, allow_negative_numbers = true)]
    size: Option<f64>,
    /// Number of points, 4 to 400 of a rotor, 3 to 60 of rotor speeds or motions; left out, the seed draws it.
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
    let made = given.kind.make(&Asked {
        seed: given.seed,
        snr_db: given.snr_db.unwrap_or(given.kind.usual_snr_db()),
        effect: given.effect,
        size: given.size,
        points: given.points,
        base_error: given.base_error == BaseError::Usual,
    })?;
    std::fs::create_dir_all(&given.out)
        .map_err(|source| RotorTruthError::Write { path: given.out.clone(), source })?;
    write(&given.out.join(given.kind.table_name()), &made.table_csv)?;
    write(&given.out.join("case.ron"), &made.case_ron)?;
    write(&given.answer, &(serde_json::to_string_pretty(&made.answer)? + "\n"))?;
    println!("{} points written to {}", made.points, given.out.display());
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
