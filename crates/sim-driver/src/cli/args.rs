//! The arguments of `hhc`.

use crate::case::InflowChoice;
use crate::output::Format;
use clap::{Args, Parser, Subcommand, ValueEnum};
use flap_aero::{AttachedFlowModel, Motion};
use std::path::PathBuf;

/// Vibration control of a helicopter rotor with trailing-edge flaps on hysteretic piezo actuators.
///
/// Without a command: the paper's study on the shipped case and the shipped synthetic bench data.
#[derive(Debug, Clone, Parser)]
#[command(name = "hhc", version, args_conflicts_with_subcommands = true)]
#[command(
    after_help = "Exit codes: 0 done, 1 the numerics failed, 2 bad input, 3 a comparison failed."
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Options of the paper's study.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// The commands.
#[derive(Debug, Clone, Subcommand)]
pub enum Command {
    /// Trim a case and control its vibration.
    Run(RunArgs),
    /// Identify an actuator from bench data.
    Identify(IdentifyArgs),
    /// Rotating frequencies of a blade, and the data of a fan plot.
    Modes(ModesArgs),
    /// Harmonic response of a section with a trailing-edge flap.
    Section(SectionArgs),
    /// Check a case, a data folder or an actuator file; reports every problem with its line.
    Check(CheckArgs),
    /// Write a commented case to start from.
    Init(InitArgs),
    /// Write the HTML report again from stored results.
    Report(ReportArgs),
}

/// Form of the output.
#[derive(Debug, Clone, Copy, Args)]
pub struct FormatArgs {
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

/// Inflow models that can replace the case's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum InflowOverride {
    /// Momentum theory, uniform.
    Uniform,
    /// Momentum theory with Drees's gradients.
    Drees,
}

impl From<InflowOverride> for InflowChoice {
    fn from(given: InflowOverride) -> Self {
        match given {
            InflowOverride::Uniform => Self::Uniform,
            InflowOverride::Drees => Self::Drees,
        }
    }
}

/// Options of the paper's study.
#[derive(Debug, Clone, Args)]
pub struct StudyArgs {
    /// Folder of the results and the report.
    #[arg(long, value_name = "DIR", default_value = "out/paper")]
    pub out: PathBuf,
    /// Inflow model instead of the case's.
    #[arg(long, value_enum)]
    pub inflow: Option<InflowOverride>,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// `hhc run`.
#[derive(Debug, Clone, Args)]
pub struct RunArgs {
    /// Case file.
    #[arg(value_name = "CASE.ron")]
    pub case: PathBuf,
    /// Folder of the results; out/ and the name of the case if left out.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Inflow model instead of the case's.
    #[arg(long, value_enum)]
    pub inflow: Option<InflowOverride>,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// `hhc identify`.
#[derive(Debug, Clone, Args)]
pub struct IdentifyArgs {
    /// Folder with dataset.ron and its records.
    #[arg(value_name = "BENCH_DIR")]
    pub bench: PathBuf,
    /// Actuator file to write.
    #[arg(short, long, value_name = "ACTUATOR.ron")]
    pub output: PathBuf,
    /// Actuator file whose settings (levels, form, split rule) are taken up.
    #[arg(long, value_name = "ACTUATOR.ron")]
    pub start: Option<PathBuf>,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// `hhc modes`.
#[derive(Debug, Clone, Args)]
pub struct ModesArgs {
    /// Case file; the paper's rotor if left out.
    #[arg(value_name = "CASE.ron")]
    pub case: Option<PathBuf>,
    /// Leave the Coriolis coupling of lag and axial motion out.
    #[arg(long)]
    pub no_gyroscopic: bool,
    /// Pitch angle at 0.75 R, deg.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    pub pitch_deg: f64,
    /// Modes about the undeformed blade instead of the one that rotation deflects.
    #[arg(long)]
    pub undeformed: bool,
    /// Further rotor speeds over the nominal one, such as 0,0.25,0.5,0.75,1: a fan plot.
    #[arg(long, value_name = "RATIOS", value_delimiter = ',')]
    pub speeds: Vec<f64>,
    /// CSV file to write the fan plot to; without --speeds, from 0 to 1.2 in steps of 0.1.
    #[arg(long, value_name = "FILE.csv")]
    pub fan: Option<PathBuf>,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Section models on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SectionModelArg {
    /// Theodorsen's function set to 1, no apparent mass.
    QuasiSteady,
    /// Theodorsen's theory, Mach 0 only.
    Incompressible,
    /// Compressible indicial functions of the Hariharan-Leishman form (a reconstruction).
    HariharanLeishman,
}

impl From<SectionModelArg> for AttachedFlowModel {
    fn from(given: SectionModelArg) -> Self {
        match given {
            SectionModelArg::QuasiSteady => Self::QuasiSteady,
            SectionModelArg::Incompressible => Self::Incompressible,
            SectionModelArg::HariharanLeishman => Self::HariharanLeishman,
        }
    }
}

/// Motions on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MotionArg {
    /// Flap angle, trailing edge down positive.
    Flap,
    /// Pitch about the quarter chord, nose-up positive.
    Pitch,
    /// Plunge velocity over U, down positive.
    Plunge,
}

impl From<MotionArg> for Motion {
    fn from(given: MotionArg) -> Self {
        match given {
            MotionArg::Flap => Self::Flap,
            MotionArg::Pitch => Self::Pitch,
            MotionArg::Plunge => Self::Plunge,
        }
    }
}

/// `hhc section`.
#[derive(Debug, Clone, Args)]
pub struct SectionArgs {
    /// Section model.
    #[arg(long, value_enum, default_value_t = SectionModelArg::HariharanLeishman)]
    pub model: SectionModelArg,
    /// Mach number.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub mach: f64,
    /// Reduced frequency, omega c / (2 U).
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub reduced_frequency: f64,
    /// Flap chord over chord.
    #[arg(long, value_name = "E", default_value_t = 0.2, allow_negative_numbers = true)]
    pub flap_chord: f64,
    /// What moves.
    #[arg(long, value_enum, default_value_t = MotionArg::Flap)]
    pub motion: MotionArg,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// `hhc check`.
#[derive(Debug, Clone, Args)]
pub struct CheckArgs {
    /// Case, dataset.ron (or its folder) or actuator file.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Form of the output.
    #[command(flatten)]
    pub format: FormatArgs,
}

/// `hhc init`.
#[derive(Debug, Clone, Args)]
pub struct InitArgs {
    /// File to write; never overwritten.
    #[arg(value_name = "FILE", default_value = "case.ron")]
    pub file: PathBuf,
}

/// `hhc report`.
#[derive(Debug, Clone, Args)]
pub struct ReportArgs {
    /// Folder of a study's results.
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
}
