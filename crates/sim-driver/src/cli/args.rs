//! The arguments of `hhc`.

use super::sweep::{PageArgs, SweepAction};
use super::{ColumnArgs, ForceArgs};
use crate::case::{DynamicStallChoice, FreeWakeValues, InflowChoice};
use crate::choices::choice_parser;
use crate::choices::model_parser;
use crate::import::{ImportKind, MOST_SAMPLES, SourceKind};
use crate::output::Format;
use bench_study::identification::ModelChoice;
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
    /// No warnings and no progress on standard error; errors and results stay.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Options of the paper's study.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// The commands.
#[derive(Debug, Clone, Subcommand)]
pub enum Command {
    /// Trim a case and control its vibration.
    Run(RunArgs),
    /// Two results side by side: what differs in the cases, hub loads, trim, power, J, airloads.
    Compare(CompareArgs),
    /// Identify an actuator from bench data.
    Identify(IdentifyArgs),
    /// What an actuator does under the commands of a record.
    Predict(PredictArgs),
    /// The voltage under which an actuator moves as wanted, and the error left.
    Invert(InvertArgs),
    /// What other programs need: an actuator and its inverse; T, state space and controllers of a case.
    Export(ExportArgs),
    /// Find what a simulation of measured data lacks: cause, extended model, gain.
    Diagnose(DiagnoseArgs),
    /// From a linear actuator upwards by data alone: what each step lacks, gains, and is worth to a rotor.
    Ladder(LadderArgs),
    /// Import measured data (any text table, xlsx, TDMS, MAT, FORC) into a data folder.
    Import(ImportArgs),
    /// Rotating frequencies of a blade, and the data of a fan plot.
    Modes(ModesArgs),
    /// Trim a case in its free wake: geometry, inflow over the disk, convergence.
    Wake(WakeArgs),
    /// Flaps against pitch at the root of the blades, at equal reduction of vibration.
    RootPitch(RootPitchArgs),
    /// Fly a case in time: speed, thrust and a flap change, controllers side by side.
    Fly(FlyArgs),
    /// Responses of a section with a trailing-edge flap: harmonic, step, ramp, loop, polar.
    Section(SectionArgs),
    /// Many variations of a case: axes over any field, resumable, in parts, on a cluster.
    #[command(subcommand)]
    Sweep(SweepAction),
    /// Check a case, a data folder or an actuator file; reports every problem with its line.
    Check {
        /// Case, dataset.ron (or its folder) or actuator file.
        #[arg(value_name = "FILE")]
        file: PathBuf,
        /// Tables for people or JSON for programs.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Write a commented case to start from.
    Init {
        /// File to write; never overwritten.
        #[arg(value_name = "FILE", default_value = "case.ron")]
        file: PathBuf,
    },
    /// Completions for a shell, to standard output: `hhc completions bash > ~/.local/share/bash-completion/completions/hhc`.
    Completions {
        /// The shell.
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// The manual page of `hhc` or of one of its commands, to standard output: `hhc man import | man -l -`.
    Man {
        /// The command; the page of `hhc` if left out.
        #[arg(value_name = "COMMAND")]
        name: Option<String>,
    },
    /// Show stored results again, and write their report and tables anew; of a merged sweep its page sweep.html.
    Report {
        /// Folder of a study's results, or of a sweep's with its sweep.json.
        #[arg(value_name = "DIR")]
        dir: PathBuf,
        /// What the page of a sweep shows.
        #[command(flatten)]
        page: PageArgs,
        /// Leave to replace.
        #[command(flatten)]
        force: ForceArgs,
        /// Form of the output.
        #[command(flatten)]
        format: DetailArgs,
    },
}

/// Form of an output of which the terminal shows one screen.
#[derive(Debug, Clone, Copy, Args)]
pub struct DetailArgs {
    /// One screen for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Every table instead of one screen.
    #[arg(long, conflicts_with = "format")]
    details: bool,
}

impl DetailArgs {
    /// The form asked for.
    pub fn form(self) -> Format {
        if self.details { Format::Details } else { self.format }
    }
}

/// Inflow models that can replace the case's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum InflowOverride {
    /// Momentum theory, uniform.
    Uniform,
    /// Momentum theory with Drees's gradients.
    Drees,
    /// Pitt and Peters.
    PittPeters,
    /// The free wake.
    Free,
}

impl From<InflowOverride> for InflowChoice {
    fn from(given: InflowOverride) -> Self {
        match given {
            InflowOverride::Uniform => Self::Uniform,
            InflowOverride::Drees => Self::Drees,
            InflowOverride::PittPeters => Self::PittPeters,
            InflowOverride::Free => Self::FreeWake(FreeWakeValues::default()),
        }
    }
}

/// Options of the paper's study.
#[derive(Debug, Clone, Args)]
pub struct StudyArgs {
    /// Folder of the results and the report.
    #[arg(long, value_name = "DIR", default_value = "out/paper")]
    pub out: PathBuf,
    /// Inflow model: the paper's free wake unless another is asked for.
    #[arg(long, value_enum, visible_alias = "wake", default_value = "free")]
    pub inflow: InflowOverride,
    /// Form of the output.
    #[command(flatten)]
    pub format: DetailArgs,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
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
    #[arg(long, value_enum, visible_alias = "wake")]
    pub inflow: Option<InflowOverride>,
    /// Advance ratios instead of the case's: a sweep of one axis, with a folder of results for each, a table and sweep.csv.
    /// What is there already is not computed again.
    #[arg(long, value_name = "MU", value_delimiter = ',')]
    pub mu: Vec<f64>,
    /// Also change one assumption at a time, those of a free wake included: sensitivity.csv.
    #[arg(long)]
    pub sensitivity: bool,
    /// Also fly under noise, a wrong T and drift, and say how wrong T may be: robustness.csv. About a minute for three
    /// harmonics.
    #[arg(long)]
    pub robustness: bool,
    /// Form of the output.
    #[command(flatten)]
    pub format: DetailArgs,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc fly`.
#[derive(Debug, Clone, Args)]
pub struct FlyArgs {
    /// Case file with a section `flight`.
    #[arg(value_name = "CASE.ron")]
    pub case: PathBuf,
    /// Also show what control reaches when a flap or an actuator of one blade, or a load cell, fails, at the advance ratio of
    /// the case: failures.csv. Some 10 s more.
    #[arg(long)]
    pub failures: bool,
    /// Also show how wrong T may be: phase, gain, one flap, one load, the T of another speed; margins.csv.
    #[arg(long)]
    pub margins: bool,
    /// Also fly so many draws of the noise, the same for every controller: draws.csv.
    #[arg(long, value_name = "N")]
    pub draws: Option<usize>,
    /// Folder for flight.csv and flight.html; out/ and the name of the case if left out.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Inflow model instead of the case's.
    #[arg(long, value_enum, visible_alias = "wake")]
    pub inflow: Option<InflowOverride>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc compare`.
#[derive(Debug, Clone, Args)]
pub struct CompareArgs {
    /// Folder of the results of `hhc run`, or a case file, which is run.
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// The same of the result beside it; differences are B - A.
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Folder for compare.csv and compare.html.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Form of the output.
    #[command(flatten)]
    pub format: DetailArgs,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc identify`.
#[derive(Debug, Clone, Args)]
pub struct IdentifyArgs {
    /// Folder with dataset.ron and its records.
    #[arg(value_name = "DATA_DIR")]
    pub bench: PathBuf,
    /// Actuator file to write, `NAME.ron` of the folder's name if left out; the page of its pictures is written beside it as
    /// ACTUATOR.html.
    #[arg(short, long, value_name = "ACTUATOR.ron")]
    pub output: Option<PathBuf>,
    /// Actuator file whose settings (levels, form, split rule) are taken up.
    #[arg(long, value_name = "ACTUATOR.ron")]
    pub start: Option<PathBuf>,
    /// Folder for the data of the figures: loops with residuals, spectra, density, reversal curves; CSV.
    #[arg(long, value_name = "DIR")]
    pub figures: Option<PathBuf>,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
    /// Model to judge and to write; all of them are fitted and compared in any case.
    #[arg(long, value_parser = model_parser(true), default_value = "best")]
    pub model: ModelChoice,
    /// Fit and compare these families alone, by names of --model.
    #[arg(long, value_name = "FAMILY", value_parser = model_parser(false), value_delimiter = ',')]
    pub only: Vec<ModelChoice>,
    /// Form of the output.
    #[command(flatten)]
    pub format: DetailArgs,
}

/// `hhc predict`.
#[derive(Debug, Clone, Args)]
pub struct PredictArgs {
    /// Actuator file, from `hhc identify`.
    #[arg(value_name = "ACTUATOR.ron")]
    pub actuator: PathBuf,
    /// Record of time and command, in any format and units that `import` reads; with `displacement` or `flap_deg` beside, the
    /// error is told. `-` is standard input.
    #[arg(long, value_name = "RECORD")]
    pub input: PathBuf,
    /// Which column is which.
    #[command(flatten)]
    pub columns: ColumnArgs,
    /// Table to write.
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: Option<PathBuf>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc invert`.
#[derive(Debug, Clone, Args)]
pub struct InvertArgs {
    /// Actuator file, from `hhc identify`.
    #[arg(value_name = "ACTUATOR.ron")]
    pub actuator: PathBuf,
    /// Record of time and `displacement` or `flap_deg`, in any format and units that `import` reads: the motion that is wanted.
    /// `-` is standard input.
    #[arg(long, value_name = "MOTION")]
    pub wanted: PathBuf,
    /// Which column is which.
    #[command(flatten)]
    pub columns: ColumnArgs,
    /// Table to write.
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: Option<PathBuf>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// What `hhc export` writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ExportForm {
    /// C99: an actuator and its inverse, or the controllers of the flight of a case.
    C,
    /// Python: an actuator.
    Python,
    /// MATLAB code: an actuator.
    Matlab,
    /// JSON: the parameters of an actuator, or T of a case.
    Json,
    /// Tables: T of a case.
    Csv,
    /// MAT file of level 5: T of a case.
    Mat,
}

/// What of a case `hhc export` writes as numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum ExportMatrices {
    /// T of every set of harmonics at the knots of the flight, with baseline, conditions and covariance.
    #[default]
    T,
    /// The linearised rotor at the trim of the case: one blade over the azimuth, all blades with constant coefficients.
    StateSpace,
}

/// `hhc export`.
#[derive(Debug, Clone, Args)]
pub struct ExportArgs {
    /// Actuator file, from `hhc identify`, or a case; its text says which.
    #[arg(value_name = "ACTUATOR.ron|CASE.ron")]
    pub file: PathBuf,
    /// Form to write.
    #[arg(long, value_enum)]
    pub to: ExportForm,
    /// Numbers of a case to write as json, csv or mat; T if left out.
    #[arg(long, value_enum)]
    pub what: Option<ExportMatrices>,
    /// Samples per second of the step functions of an actuator.
    #[arg(long, value_name = "HZ", default_value_t = 2000.0)]
    pub sampling_hz: f64,
    /// Write the monitor of a cause instead: the stages of the actuator that it is, such as `Backlash`; from `hhc diagnose`
    /// they stand in extended.ron. In c, python, matlab or json.
    #[arg(long, value_name = "STAGES", value_delimiter = ',', requires = "threshold_deg")]
    pub monitor: Vec<String>,
    /// RMS residual that a sound actuator does not reach, deg: beyond it the monitor speaks. `hhc predict` tells that of a record.
    #[arg(long, value_name = "DEG", requires = "monitor", allow_negative_numbers = true)]
    pub threshold_deg: Option<f64>,
    /// Memory of the monitor, s; 1 if left out.
    #[arg(long, value_name = "S", requires = "monitor", allow_negative_numbers = true)]
    pub memory_s: Option<f64>,
    /// Name of files and functions, a lower-case identifier; `flap_actuator` of an actuator, `flap_monitor`, or `rotor` of a case
    /// if left out.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Folder to write, never overwritten; name of the file and form, such as `ACTUATOR_c`, if left out.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// `hhc import`.
#[derive(Debug, Clone, Args)]
pub struct ImportArgs {
    /// Files to import; each becomes a run of the data folder. `-` is standard input.
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Folder to write, never overwritten; the name of the first file without its ending if left out.
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What the files are; recognised by their first bytes if left out.
    #[arg(long = "as", value_parser = choice_parser::<SourceKind>(), value_name = "FORMAT")]
    pub source: Option<SourceKind>,
    /// Kind of the data folder; left out, an actuator bench if there are command and displacement, points
    /// of test if there are their columns, else a generic loop.
    #[arg(long, value_parser = choice_parser::<ImportKind>())]
    pub kind: Option<ImportKind>,
    /// What these options say, kept in a file: columns with their sources and factors, rate, range. An option given here too
    /// goes before it.
    #[arg(long, value_name = "MAP.ron")]
    pub mapping: Option<PathBuf>,
    /// Which column is which.
    #[command(flatten)]
    pub columns: ColumnArgs,
    /// Variable of a MAT file: bench.run(2).x, runs{3}.
    #[arg(long, value_name = "PATH")]
    pub variable: Option<String>,
    /// Name of the input of a generic loop.
    #[arg(long, value_name = "NAME")]
    pub input: Option<String>,
    /// Name of the output of a generic loop.
    #[arg(long, value_name = "NAME")]
    pub response: Option<String>,
    /// Units to convert into, for generic loops: `displacement_mm,force_N`.
    #[arg(long, value_name = "LIST")]
    pub convert: Option<String>,
    /// Flap angle per displacement of an actuator bench, deg/um.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub deg_per_um: Option<f64>,
    /// Lever from the actuator to the hinge of the flap, mm: the same as --deg-per-um 0.0573/MM.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, conflicts_with = "deg_per_um")]
    pub arm_mm: Option<f64>,
    /// Part files into runs: at rests longer than a period, gaps, and where the time begins again.
    #[arg(long)]
    pub split: bool,
    /// Range of the command in V, or of the input in its unit: LOW,HIGH.
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true)]
    pub range: Option<(f64, f64)>,
    /// Average whole blocks of samples down to this sampling frequency, Hz.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub reduce_to_hz: Option<f64>,
    /// Most samples of a run; longer ones are averaged in blocks of 2, 4, 8 ...
    #[arg(long, value_name = "N", default_value_t = MOST_SAMPLES)]
    pub max_samples: usize,
    /// Title of the data set.
    #[arg(long)]
    pub title: Option<String>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

/// Two numbers with a comma between them.
fn range(text: &str) -> Result<(f64, f64), String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[low, high]) => Ok((low, high)),
        _ => Err("expected LOW,HIGH, such as -20,150".to_owned()),
    }
}

/// `hhc diagnose`.
#[derive(Debug, Clone, Args)]
pub struct DiagnoseArgs {
    /// Actuator file, or a case with its actuator: the simulation that is asked about.
    #[arg(value_name = "ACTUATOR_OR_CASE.ron", required_unless_present_any = ["plan", "table"])]
    pub model: Option<PathBuf>,
    /// Folder with dataset.ron and the measured records; of several like specimens, one folder each.
    #[arg(long, value_name = "DIR", required_unless_present_any = ["plan", "table"])]
    pub data: Vec<PathBuf>,
    /// Folder to write to: findings, extended actuator, residuals; of several specimens in a folder each.
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["plan", "table"])]
    pub output: Option<PathBuf>,
    /// Take these causes for true and fit them, nothing refused; with a plan, ask about these alone.
    #[arg(long, value_name = "CAUSES", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Before anything is measured: which causes runs would tell apart, and at which size, on this actuator.
    #[arg(long, value_name = "ACTUATOR_OR_CASE.ron", conflicts_with_all = ["model", "data", "reference"])]
    pub plan: Option<PathBuf>,
    /// Anyone's simulator: a folder with measured.csv, predicted.csv, what is predicted with some of each suspect
    /// (`effect_NAME.csv`), and their amounts (table.ron).
    #[arg(long, value_name = "DIR", conflicts_with_all = ["model", "data", "reference", "plan"])]
    pub table: Option<PathBuf>,
    /// Runs of the plan: commands and channels of a folder with dataset.ron; the usual ones if left out.
    #[arg(long, value_name = "DIR", requires = "plan")]
    pub runs: Option<PathBuf>,
    /// What else the records need.
    #[command(flatten)]
    pub records: RecordsArgs,
}

/// What records to be explained are compared with.
#[derive(Debug, Clone, Args)]
pub struct RecordsArgs {
    /// Folder with reference records; beside those of the data, or `../reference`, if left out.
    #[arg(long, value_name = "DIR")]
    pub reference: Option<PathBuf>,
    /// Folder to keep what surrogates of a base model leave, such as out/cache: computed once for a base and a design. Without
    /// it nothing is kept.
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Form of the output.
    #[command(flatten)]
    pub format: DetailArgs,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc ladder`.
#[derive(Debug, Clone, Args)]
pub struct LadderArgs {
    /// Case that says what a step is worth; the paper's if left out.
    #[arg(long, value_name = "CASE.ron")]
    pub case: Option<PathBuf>,
    /// Inflow model instead of the case's.
    #[arg(long, value_enum, visible_alias = "wake")]
    pub inflow: Option<InflowOverride>,
    /// Folder with dataset.ron and the measured records.
    #[arg(long, value_name = "DIR")]
    pub data: PathBuf,
    /// Folder to write to: ladder and extended actuator.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// What else the records need.
    #[command(flatten)]
    pub records: RecordsArgs,
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
    /// CSV file to write the fan plot to; without --speeds, from 0 to 1.2 in steps of 0.1. Folders on the way are made, as
    /// for every file that is written.
    #[arg(long, value_name = "FILE.csv")]
    pub fan: Option<PathBuf>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// `hhc root-pitch`.
#[derive(Debug, Clone, Args)]
pub struct RootPitchArgs {
    /// Case file; the paper's rotor if left out.
    #[arg(value_name = "CASE.ron")]
    pub case: Option<PathBuf>,
    /// Inflow model instead of the case's.
    #[arg(long, value_enum)]
    pub inflow: Option<InflowOverride>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

/// `hhc wake`.
#[derive(Debug, Clone, Args)]
pub struct WakeArgs {
    /// Case file; the paper's rotor if left out.
    #[arg(value_name = "CASE.ron")]
    pub case: Option<PathBuf>,
    /// Advance ratio instead of the case's.
    #[arg(long, value_name = "MU")]
    pub mu: Option<f64>,
    /// Folder for geometry (CSV, VTK legacy), inflow over the disk and convergence; in time, for the revolutions (CSV).
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// March rotor and wake in time and measure the means of so many revolutions: where no wake is periodic.
    #[arg(long, value_name = "REVOLUTIONS", num_args = 0..=1, require_equals = true, default_missing_value = "40")]
    pub in_time: Option<usize>,
    /// Revolutions of the march before it is measured.
    #[arg(long, value_name = "REVOLUTIONS", default_value_t = 24, requires = "in_time")]
    pub settling: usize,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}

/// Responses of a section on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ResponseArg {
    /// Complex amplitudes at one reduced frequency.
    Harmonic,
    /// History after a unit step.
    Step,
    /// History of a unit ramp over --rise semichords.
    Ramp,
    /// One cycle of a motion that repeats.
    Loop,
    /// Static curve over incidence.
    Polar,
}

/// `hhc section`.
#[derive(Debug, Clone, Args)]
pub struct SectionArgs {
    /// What is asked for.
    #[arg(long, value_enum, default_value_t = ResponseArg::Harmonic)]
    pub response: ResponseArg,
    /// Section model; not of a polar of a table [default: calibrated].
    #[arg(long, value_parser = choice_parser::<AttachedFlowModel>())]
    pub model: Option<AttachedFlowModel>,
    /// Mach number.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub mach: f64,
    /// Flap chord over chord; not of a polar of a table [default: 0.2].
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    pub flap_chord: Option<f64>,
    /// What moves, in every response but a polar [default: flap].
    #[arg(long, value_parser = choice_parser::<Motion>())]
    pub motion: Option<Motion>,
    /// Reduced frequency, omega c / (2 U), of a harmonic response or a loop.
    #[arg(
        long,
        value_name = "K",
        allow_negative_numbers = true,
        required_unless_present = "response",
        required_if_eq_any([("response", "harmonic"), ("response", "loop")])
    )]
    pub reduced_frequency: Option<f64>,
    /// Distance of a step or ramp response, semichords [default: 20].
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub distance: Option<f64>,
    /// Length of a ramp, semichords [default: 1].
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub rise: Option<f64>,
    /// Points of a step, ramp, loop or polar; a loop is marched finer and needs 3 [default: 200].
    #[arg(long, value_name = "N")]
    pub points: Option<usize>,
    /// Mean incidence of a loop, whatever moves; middle of a polar; deg [default: 0].
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub mean_deg: Option<f64>,
    /// Amplitude of what moves in a loop, half the range of a polar, deg [default: 10].
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub amplitude_deg: Option<f64>,
    /// Stall of a loop or of a polar without a table [default: off].
    #[arg(long, value_parser = choice_parser::<DynamicStallChoice>())]
    pub stall: Option<DynamicStallChoice>,
    /// C81 file whose polar is wanted (a rotor takes tables from its case); `shipped:naca0012_synthetic.c81` is a
    /// synthetic one.
    #[arg(long, value_name = "FILE")]
    pub table: Option<PathBuf>,
    /// Flap effectiveness in lift, moment and hinge moment, such as 0.78,1,1; not of a polar.
    #[arg(long, value_name = "FACTORS", value_delimiter = ',', num_args = 1)]
    pub effectiveness: Vec<f64>,
    /// CSV file to write.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Leave to replace.
    #[command(flatten)]
    pub force: ForceArgs,
}
