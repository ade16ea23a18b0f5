//! The `hhc` command: arguments, dispatch, exit codes.

mod args;
mod case_runner;
mod compare;
mod data;
mod diagnose;
mod export;
mod fly;
mod identify;
mod left;
mod rotor;
mod run;
mod section;
mod speeds;
mod sweep;

pub use args::{
    Cli, Command, CompareArgs, DetailArgs, DiagnoseArgs, FlyArgs, IdentifyArgs, ImportArgs,
    InflowOverride, ModesArgs, RunArgs, SectionArgs, StudyArgs, WakeArgs,
};

use crate::SimError;
use crate::case::{InflowChoice, LoadedCase, PAPER_CASE, load_case, shipped_case};
use crate::choices::check_range;
use crate::files::{
    refuse_foreign, refuse_input, refuse_inside, refuse_other_kind, refuse_other_text, write_atomic,
};
use crate::import::ColumnOptions;
use crate::output::{Format, warnings_text};
use crate::problem::Problems;
use crate::progress::{is_quiet, set_quiet};
use crate::sweep::at_advance_ratio;
use clap::{Args, Parser};
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use study_text::known::Known;

/// Runs the command with the arguments of the process.
///
/// Exit codes: 0 done, 1 the physics or numerics failed (or a bug, which says so), 2 bad input, 3 a
/// comparison failed. A panic never reaches the user as such.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|info| {
        say(&bug_message(&info.to_string()));
    }));
    let cli = Cli::parse();
    // within the threads of the pool a parallel step needs no change of thread
    let outcome = std::panic::catch_unwind(|| rayon::scope(|_| execute(&cli)));
    match outcome {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(error)) => {
            say(&format_args!("error: {error}"));
            ExitCode::from(error.exit_code())
        }
        // the hook has printed what happened
        Err(_) => ExitCode::from(1),
    }
}

/// Says something on standard error; one that takes no more, such as a log on a full disk, is no fault of the run.
pub(super) fn say(what: &dyn Display) {
    let _ = writeln!(std::io::stderr(), "{what}");
}

fn bug_message(panic: &str) -> String {
    format!(
        "hhc {} has met a bug of its own and stops; files already complete are kept, none is half-written.\nPlease report it with the command and the files used:\n{panic}",
        crate::VERSION
    )
}

/// Does what the arguments ask for and prints the result.
///
/// # Errors
/// Whatever stopped it; [`SimError::exit_code`] says what the process should return.
pub fn execute(cli: &Cli) -> Result<(), SimError> {
    set_quiet(cli.quiet);
    match &cli.command {
        None => run::study(&cli.study),
        Some(Command::Run(args)) => run::run(args),
        Some(Command::Fly(args)) => fly::fly(args),
        Some(Command::Compare(args)) => compare::compare(args),
        Some(Command::Identify(args)) => identify::identify(args),
        Some(Command::Predict(args)) => identify::predict(args),
        Some(Command::Invert(args)) => identify::invert(args),
        Some(Command::Export(args)) => export::export(args),
        Some(Command::Diagnose(args)) => diagnose::diagnose(args),
        Some(Command::Ladder(args)) => diagnose::ladder(args),
        Some(Command::Import(args)) => data::import(args),
        Some(Command::Modes(args)) => rotor::modes(args),
        Some(Command::Wake(args)) => rotor::wake(args),
        Some(Command::RootPitch(args)) => rotor::root_pitch(args),
        Some(Command::Sweep(action)) => sweep::sweep(action),
        Some(Command::Section(args)) => section::section(args),
        Some(Command::Check { file, format }) => data::check(file, *format),
        Some(Command::Init { file }) => data::init(file),
        Some(Command::Completions { shell }) => data::completions(*shell),
        Some(Command::Man { name }) => data::man(name.as_deref()),
        Some(Command::Report { dir, page, force, format }) => {
            run::report(dir, (page, *force), format.form())
        }
    }
}

/// Prints warnings to standard error: short on one screen, whole with every table and where no screen cuts them.
fn warn<T: Display>(warnings: &[T], format: Format) {
    if is_quiet() {
        return;
    }
    let is_screen = std::io::stderr().is_terminal();
    let format = if is_screen { format } else { Format::Details };
    let text = warnings_text(warnings, format, "in the report, or with --details");
    if !text.is_empty() {
        say(&text.trim_end());
    }
}

/// Whether the rotor can fly at an advance ratio of the command line.
fn check_advance_ratio(problems: &mut Problems, mu: f64) {
    let remedy = "the attached-flow rotor model ends at 0.5; 0 is hover";
    check_range(problems, "--mu", mu, [0.0, 0.5], "", remedy);
}

/// The case at an advance ratio of the command line, if one is given.
///
/// # Errors
/// An advance ratio at which the rotor cannot fly.
pub fn moved_to(loaded: LoadedCase, mu: Option<f64>) -> Result<LoadedCase, SimError> {
    let Some(mu) = mu else { return Ok(loaded) };
    let mut problems = Problems::default();
    check_advance_ratio(&mut problems, mu);
    problems.into_result(Some(()))?;
    Ok(at_advance_ratio(&loaded, mu))
}

/// The case of a file; the paper's if none is given.
///
/// # Errors
/// As [`load_case`].
pub fn case_or_paper(path: Option<&PathBuf>) -> Result<LoadedCase, SimError> {
    Ok(path.map_or_else(|| shipped_case(PAPER_CASE), |path| load_case(path))?)
}

/// Folder of the results of a case file, if none is given: `out/` and its name.
fn folder_or(given: Option<&PathBuf>, case: &Path) -> PathBuf {
    let stem = case.file_stem().map(PathBuf::from).unwrap_or_default();
    given.cloned().unwrap_or_else(|| Path::new("out").join(stem))
}

/// Writes named texts into a folder.
fn write_texts<N: AsRef<Path>>(
    folder: &Path,
    files: impl IntoIterator<Item = (N, String)>,
) -> Result<(), SimError> {
    for (name, text) in files {
        write_atomic(&folder.join(name), text.as_bytes())?;
    }
    Ok(())
}

/// The case in another inflow; a case with a free wake keeps its own where one is asked for.
pub fn overridden(mut loaded: LoadedCase, inflow: Option<InflowOverride>) -> LoadedCase {
    let has_one = matches!(loaded.case.inflow.model, InflowChoice::FreeWake(_));
    if let Some(inflow) = inflow.filter(|i| !(has_one && *i == InflowOverride::Free)) {
        loaded.case.inflow.model = inflow.into();
    }
    loaded
}

/// Refuses to write to a file that is read, where both are given.
fn refuse_inputs(read: Option<&Path>, written: Option<&PathBuf>) -> Result<(), SimError> {
    read.zip(written).map_or(Ok(()), |(read, written)| Ok(refuse_input(read, written)?))
}

/// What a recorder did not write into its file.
#[derive(Debug, Clone, Args)]
pub struct ColumnArgs {
    /// Names and units of the columns: `time_s,displacement_um,command_V` in the order of the file, with
    /// - for a column to leave out; or `NAME_UNIT=SOURCE` with a header, a MAT field or #number.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub columns: Option<String>,
    /// Factors of columns whose recorder divided: `command=15,displacement=100`.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub scale: Option<String>,
    /// What to add to columns then, in their units: `displacement=-30000`.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub offset: Option<String>,
    /// Sampling frequency of files without a time column, Hz.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub sampling_hz: Option<f64>,
}

impl ColumnArgs {
    /// What they say about the columns.
    pub fn options(&self) -> ColumnOptions {
        ColumnOptions {
            columns: self.columns.clone(),
            scale: self.scale.clone(),
            offset: self.offset.clone(),
            ..ColumnOptions::default()
        }
    }
}

/// Leave to replace what is in the way.
#[derive(Debug, Clone, Copy, Args)]
pub struct ForceArgs {
    /// Replace files in the way even if hhc did not write them.
    #[arg(long)]
    force: bool,
}

impl ForceArgs {
    /// Refuses to replace a table with another header line, if one is to be written.
    fn table(self, path: Option<&Path>, text: &str) -> Result<(), SimError> {
        let head = text.split_inclusive('\n').next().unwrap_or_default();
        self.holding(path, head, "table of hhc")
    }

    /// Refuses to replace a file that does not hold a text which is in all files of a kind, if one is to be written.
    fn holding(self, path: Option<&Path>, held: &str, kind: &'static str) -> Result<(), SimError> {
        let path = path.filter(|_| !self.force);
        path.map_or(Ok(()), |path| Ok(refuse_other_text(path, held, kind)?))
    }

    /// Refuses to replace files of a folder that hold something else than those of `hhc`.
    fn files(self, folder: &Path, known: &Known) -> Result<(), SimError> {
        if self.force {
            return Ok(());
        }
        Ok(refuse_foreign(folder, known.iter().copied())?)
    }

    /// Refuses to replace tables of a folder with other header lines than those to be written, and files of the folders with data,
    /// which no command replaces.
    fn tables(
        self,
        folder: &Path,
        texts: &[(String, String)],
        data: &[&Path],
    ) -> Result<(), SimError> {
        for ((name, _), data) in
            texts.iter().flat_map(|text| data.iter().map(move |own| (text, own)))
        {
            refuse_inside(data, &folder.join(name))?;
        }
        let is_table = |name: &str| [".csv", ".vtp"].iter().any(|ending| name.ends_with(ending));
        let tables = texts.iter().filter(|(name, _)| is_table(name));
        tables.into_iter().try_for_each(|(name, text)| self.table(Some(&folder.join(name)), text))
    }

    /// Refuses to replace a file that is no actuator file.
    fn actuator(self, path: &Path) -> Result<(), SimError> {
        if self.force { Ok(()) } else { Ok(refuse_other_kind(path, "Actuator")?) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_argument_definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_bug_is_called_a_bug() {
        let text = bug_message("panicked at somewhere");
        assert!(text.contains("bug") && text.contains("panicked at somewhere"), "{text}");
    }
}
