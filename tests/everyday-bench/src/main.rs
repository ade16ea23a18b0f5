//! `everyday-bench`: writes a set.
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "this command writes the files"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use everyday_bench::error::EverydayError;
use everyday_bench::family::Family;
use everyday_bench::hidden::{Deal, Hidden};
use everyday_bench::runs::Drive;
use everyday_bench::set::{Request, set};
use everyday_bench::text::{Column, File};

/// Writes a synthetic bench with an everyday error: DIR/reference and DIR/measured.
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Folder to write to: it gets `reference` and `measured`.
    #[arg(long)]
    out: PathBuf,
    /// Hysteresis: relays or duhem.
    #[arg(long)]
    family: Family,
    /// Chooses actuator, hidden thing, its size, columns and noise.
    #[arg(long)]
    seed: u64,
    /// What seeds are dealt: all, everyday, singles, nulls.
    #[arg(long, default_value = "all")]
    kind: Deal,
    /// Another hidden thing than the seed's own: `null`, or `ID[:SIZE]`, several joined by `+`. SIZE is a share of the
    /// output for causes of a usual library, else the quantity itself.
    #[arg(long)]
    hidden: Option<Hidden>,
    /// Rms of the effect over rms of the output, for causes of a usual library.
    #[arg(long)]
    share: Option<f64>,
    /// Rms of the output over that of the noise, dB.
    #[arg(long, default_value_t = 40.0)]
    snr: f64,
    /// File for the answer; left out, nobody learns it.
    #[arg(long)]
    answer: Option<PathBuf>,
    /// Another draw of all noise for the same truth.
    #[arg(long, default_value_t = 0)]
    draw: u64,
    /// Record the terminal voltage, whatever the seed says.
    #[arg(long)]
    monitor: bool,
    /// Record the load, whatever the seed says.
    #[arg(long)]
    load_cell: bool,
    /// Measure the reference runs again instead of others.
    #[arg(long)]
    repeat: bool,
    /// Drive the reference runs by 25 V alone.
    #[arg(long)]
    reference_small: bool,
}

fn main() -> ExitCode {
    match write(Arguments::parse()) {
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

fn write(arguments: Arguments) -> Result<String, EverydayError> {
    let mut request = Request::new(arguments.family, arguments.seed, arguments.kind);
    request.snr_db = arguments.snr;
    request.share = arguments.share;
    request.draw = arguments.draw;
    request.repeats = arguments.repeat;
    if let Some(hidden) = arguments.hidden {
        request.hidden = hidden;
    }
    if arguments.monitor {
        request.columns.push(Column::Amplifier);
    }
    if arguments.load_cell {
        request.columns.push(Column::Load);
    }
    if arguments.reference_small {
        request.drive = Drive::Small;
        if request.hidden == Hidden::default() {
            request.hidden = "small-reference".parse()?;
        }
    }
    let set = set(&request);
    let mut written = write_folder(&arguments.out.join("reference"), &set.reference)?;
    written += write_folder(&arguments.out.join("measured"), &set.measured)?;
    if let Some(path) = &arguments.answer {
        let failed = |source| EverydayError::Write { path: path.clone(), source };
        let text = serde_json::to_string_pretty(&set.answer)
            .map_err(|error| failed(std::io::Error::other(error)))?;
        std::fs::write(path, text + "\n").map_err(failed)?;
    }
    Ok(format!("{written} files written to {}", arguments.out.display()))
}

/// Writes files into a folder; those of the same name are replaced.
fn write_folder(out: &Path, files: &[File]) -> Result<usize, EverydayError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| EverydayError::Write { path, source }
    };
    std::fs::create_dir_all(out).map_err(failed(out))?;
    for (name, content) in files {
        let path = out.join(name);
        std::fs::write(&path, content).map_err(failed(&path))?;
    }
    Ok(files.len())
}
