//! `hhc sweep`: many variations of a case, on one machine or as a Slurm array.

use super::case_runner::CaseRunner;
use super::{ForceArgs, say, write_texts};
use crate::SimError;
use crate::case::load_case;
use crate::files::{Folder, RonIndex, Source, missing_file, refuse_unwritable};
use crate::output::{Format, json, print, table};
use crate::problem::Problem;
use crate::progress::{Progress, is_quiet};
use crate::results::{RESULT_FILE, from_json};
use case_sweep::{
    Done, Failed, Merged, Pace, PageChoice, Plan, Ran, Runner, Shard, Store, array_script, merge,
    plan, read_sweep_file, run, status,
};
use clap::{Args, Subcommand};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use study_text::known::{MERGED_FILES, SWEEP_PAGE};

/// `hhc sweep`.
#[derive(Debug, Clone, Subcommand)]
pub enum SweepAction {
    /// List the cases with their keys, and what is wrong in the sweep file.
    Plan(SweepArgs),
    /// Run what has no whole result yet; stop and start it again at will.
    Run {
        #[command(flatten)]
        sweep: SweepArgs,
        /// Part of the cases; in a Slurm array the part of the task, if left out.
        #[arg(long, value_name = "I/N")]
        shard: Option<String>,
        /// Compute failed cases again, as after a fault of the program was mended.
        #[arg(long)]
        retry_failed: bool,
    },
    /// Count what is done, failed, damaged, missing and foreign.
    Status(SweepArgs),
    /// Write sweep.csv and sweep.json from the results.
    Merge {
        #[command(flatten)]
        sweep: SweepArgs,
        /// Leave out what is missing, damaged or foreign.
        #[arg(long)]
        partial: bool,
        #[command(flatten)]
        force: ForceArgs,
    },
    /// Write sweep.html: maps and carpets over two axes, parallel coordinates, reduction of J against power.
    Report {
        #[command(flatten)]
        sweep: SweepArgs,
        #[command(flatten)]
        page: PageArgs,
        #[command(flatten)]
        force: ForceArgs,
    },
    /// Print the sbatch script of an array that runs the sweep.
    Slurm {
        #[command(flatten)]
        sweep: SweepArgs,
        /// Tasks of the array.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        tasks: u16,
        /// Processors of a task.
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        cpus: u16,
    },
}

/// What the page of a sweep shows.
#[derive(Debug, Clone, Args)]
pub struct PageArgs {
    /// Of a sweep: axis to the right; the first with several numbers if left out.
    #[arg(long, value_name = "FIELD")]
    x: Option<String>,
    /// Of a sweep: axis upwards, of carpets the second; the next one if left out.
    #[arg(long, value_name = "FIELD")]
    y: Option<String>,
    /// Of a sweep: columns of sweep.csv to show; every reduction of J, load at the blade number per rev without control and flap
    /// amplitude if left out.
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    of: Vec<String>,
    /// Of a sweep: only cases with this value on an axis; once for each axis.
    #[arg(long, value_name = "FIELD=VALUE")]
    at: Vec<String>,
}

impl PageArgs {
    fn choice(&self) -> PageChoice {
        let (x, y, of, at) = (self.x.clone(), self.y.clone(), self.of.clone(), self.at.clone());
        PageChoice { x, y, of, at }
    }

    /// Whether anything is chosen.
    pub(super) fn is_given(&self) -> bool {
        self.choice() != PageChoice::default()
    }
}

/// Field of a case whose default depends on another one.
const ACTUATORS: &str = "control.actuators";

/// Name of the file of merged results.
const MERGED_FILE: &str = "sweep.json";

/// What every action needs.
#[derive(Debug, Clone, Args)]
pub struct SweepArgs {
    /// Sweep file: (base: "case.ron", axes: [(field: "rotor.gj", from: 0.005, to: 0.007, count: 3)]).
    #[arg(value_name = "SWEEP.ron")]
    file: PathBuf,
    /// Folder of the results; out/ and the name of the sweep file if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Tables for people or JSON for programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

impl SweepArgs {
    fn out(&self) -> PathBuf {
        let stem = || self.file.file_stem().map(PathBuf::from).unwrap_or_default();
        self.out.clone().unwrap_or_else(|| Path::new("out").join(stem()))
    }
}

pub(super) fn sweep(action: &SweepAction) -> Result<(), SimError> {
    match action {
        SweepAction::Plan(args) => show_plan(&Sweep::of(args)?, args.format),
        SweepAction::Run { sweep, shard, retry_failed } => {
            let part = shard.as_deref().map_or_else(task_of_array, Shard::parse)?;
            refuse_unwritable(&sweep.out())?;
            let failed = if *retry_failed { Failed::Again } else { Failed::Left };
            run_part(&Sweep::of(sweep)?, (part, failed), sweep.format)
        }
        SweepAction::Status(args) => show_status(&Sweep::of(args)?, args.format),
        SweepAction::Merge { sweep, partial, force } => {
            force.files(&sweep.out(), MERGED_FILES)?;
            write_merged(&Sweep::of(sweep)?, *partial, sweep.format)
        }
        SweepAction::Report { sweep, page, force } => {
            force.files(&sweep.out(), SWEEP_PAGE)?;
            write_page(sweep, &page.choice())
        }
        SweepAction::Slurm { sweep, tasks, cpus } => print_script(sweep, *tasks, *cpus),
    }
}

/// A sweep that was planned.
struct Sweep {
    plan: Plan,
    runner: CaseRunner,
    store: Store,
    out: PathBuf,
}

impl Sweep {
    fn of(args: &SweepArgs) -> Result<Self, SimError> {
        let folder = Folder::of_file(&args.file);
        let file = read_sweep_file(&Source::read(&args.file)?, &folder)?;
        if !folder.contains(&file.base) {
            return Err(Problem::new(file.base_place, missing_file(&folder, &file.base)).into());
        }
        let base = load_case(Path::new(&folder.display(&file.base)))?;
        let runner = CaseRunner::new(base.folder.clone());
        let mut text = CaseRunner::canonical(&base.case)?;
        // what follows from the model of the actuator, unless the case states it, follows from that of an axis
        if !base.index.contains(ACTUATORS) {
            text = RonIndex::new("case", &text).without(ACTUATORS).unwrap_or(text);
        }
        let plan = plan(&file, text, &runner)?;
        let out = args.out();
        Ok(Self { plan, runner, store: Store::new(&out), out })
    }
}

/// The part of this task of a Slurm array; all cases outside of one.
#[expect(clippy::disallowed_methods, reason = "Slurm says in the environment which task this is")]
fn task_of_array() -> Result<Shard, case_sweep::SweepError> {
    let value = |name: &str| std::env::var(format!("SLURM_ARRAY_TASK_{name}")).ok();
    let tasks = ["MIN", "MAX", "COUNT"].map(value);
    Shard::of_array(value("ID").as_deref(), tasks.each_ref().map(Option::as_deref))
}

fn show_plan(sweep: &Sweep, format: Format) -> Result<(), SimError> {
    if format == Format::Json {
        return print(&json(&sweep.plan)?);
    }
    let names = sweep.plan.axis_names();
    let fields = names.iter().map(String::as_str);
    let header: Vec<&str> = ["case"].into_iter().chain(fields).chain(["key"]).collect();
    let rows = sweep.plan.cases.iter().enumerate().map(|(i, case)| {
        let key = case.key.chars().take(12).collect();
        let number = [(i + 1).to_string()].into_iter();
        number.chain(case.values.iter().cloned()).chain([key]).collect()
    });
    let cases = sweep.plan.cases.len();
    let distinct = sweep.plan.distinct().len();
    let refused = sweep.plan.cases.iter().filter(|case| case.refused.is_some()).count();
    let together = match refused {
        0 => String::new(),
        _ => format!("; in {refused} the values do not go together: they will fail"),
    };
    let table = table(&header, rows);
    print(&format!("{table}\n{cases} cases, {distinct} of them different{together}\n"))
}

/// Time between two lines of a log, s.
const LOG_EVERY: Duration = Duration::from_secs(30);

fn run_part(sweep: &Sweep, part: (Shard, Failed), format: Format) -> Result<(), SimError> {
    let ran = run_shown(&sweep.plan, part, &sweep.store, &sweep.runner)?;
    print(&if format == Format::Json { json(&ran)? } else { ran_text(&ran, &sweep.out) })
}

/// Runs a part of a plan and shows how far it is.
#[expect(clippy::disallowed_methods, reason = "rate and time left are shown, not stored")]
pub(super) fn run_shown<R: Runner>(
    plan: &Plan,
    part: (Shard, Failed),
    store: &Store,
    runner: &R,
) -> Result<Ran, SimError> {
    let progress = Progress::new(1);
    progress.doing("sweep");
    let begun = Instant::now();
    let is_log = !std::io::stderr().is_terminal();
    let logged = Mutex::new(begun);
    let done = |done: Done| {
        let pace = Pace { done, elapsed_s: begun.elapsed().as_secs_f64() };
        progress.doing(pace.to_string());
        let mut logged = logged.lock().unwrap_or_else(PoisonError::into_inner);
        if is_log && !is_quiet() && logged.elapsed() > LOG_EVERY {
            say(&pace);
            *logged = Instant::now();
        }
    };
    let ran = run(plan, part, store, runner, &done);
    progress.finish();
    Ok(ran?)
}

/// Lines of failed cases that are shown.
const SHOWN: usize = 10;

fn failed_text<'a>(failed: impl ExactSizeIterator<Item = (&'a String, &'a String)>) -> String {
    let more = failed.len().saturating_sub(SHOWN);
    let mut lines: Vec<String> = Vec::new();
    for (key, reason) in failed.take(SHOWN) {
        lines.push(format!("failed {}: {}", &key[..12.min(key.len())], reason.replace('\n', " ")));
    }
    lines.extend((more > 0).then(|| format!("and {more} more; sweep.csv has them all")));
    lines.into_iter().map(|line| line + "\n").collect()
}

fn ran_text(ran: &Ran, out: &Path) -> String {
    let Ran { cases, skipped, computed, failed, damaged } = ran;
    let damaged = match damaged.len() {
        0 => String::new(),
        n => format!(", {n} of them again: their results were cut off or altered"),
    };
    let shown = failed_text(failed.iter().map(|(key, reason)| (key, reason)));
    format!(
        "{cases} cases: {skipped} were there, {computed} computed{damaged}; {} failed\n{shown}Results in {}\n",
        failed.len(),
        out.display()
    )
}

fn show_status(sweep: &Sweep, format: Format) -> Result<(), SimError> {
    let status = status(&sweep.store, &sweep.plan);
    if format == Format::Json {
        return print(&json(&status)?);
    }
    print(&format!(
        "{} cases: {} found, {} failed, {} damaged, {} missing; {} foreign files\n{}",
        status.cases,
        status.found,
        status.failed.len(),
        status.damaged.len(),
        status.missing.len(),
        status.foreign.len(),
        failed_text(status.failed.iter())
    ))
}

fn write_merged(sweep: &Sweep, partial: bool, format: Format) -> Result<(), SimError> {
    let merged = merge(&sweep.plan, &sweep.store, partial)?;
    write_texts(&sweep.out, merged_files(&merged)?)?;
    if format == Format::Json {
        return print(&json(&merged)?);
    }
    let failed = merged.cases.iter().filter_map(|case| Some((&case.key, case.failed.as_ref()?)));
    let failed: Vec<(&String, &String)> = failed.collect();
    print(&format!(
        "{} of {} cases, {} failed, in {}\n{}",
        merged.cases.len(),
        sweep.plan.cases.len(),
        failed.len(),
        sweep.out.join("sweep.csv").display(),
        failed_text(failed.into_iter())
    ))
}

/// The files of merged results.
pub(super) fn merged_files(merged: &Merged) -> Result<[(&'static str, String); 2], SimError> {
    Ok([("sweep.csv", merged.csv()), (MERGED_FILE, json(merged)?)])
}

/// Writes the page of the results that are there.
fn write_page(args: &SweepArgs, choice: &PageChoice) -> Result<(), SimError> {
    let sweep = Sweep::of(args)?;
    let merged = merge(&sweep.plan, &sweep.store, true)?;
    write_page_of(&merged, &args.file, &sweep.out, choice)
}

fn write_page_of(
    merged: &Merged,
    of: &Path,
    out: &Path,
    choice: &PageChoice,
) -> Result<(), SimError> {
    let page = merged.page(&format!("Sweep {}", of.display()), choice)?;
    write_texts(out, [("sweep.html", page)])?;
    print(&format!("Report in {}\n", out.join("sweep.html").display()))
}

/// Whether a folder holds merged results of a sweep, and no single one.
pub(super) fn is_merged(folder: &Path) -> bool {
    folder.join(MERGED_FILE).is_file() && !folder.join(RESULT_FILE).exists()
}

/// Writes the page of the merged results in a folder.
pub(super) fn report_merged(folder: &Path, page: &PageArgs) -> Result<(), SimError> {
    let source = Source::read(&folder.join(MERGED_FILE))?;
    let merged: Merged = from_json(&source)?;
    write_page_of(&merged, folder, folder, &page.choice())
}

/// Prints the script of an array; a sweep file with a fault is told before anything is submitted.
fn print_script(args: &SweepArgs, tasks: u16, cpus: u16) -> Result<(), SimError> {
    Sweep::of(args)?;
    let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("hhc"));
    // a task may start in another folder
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let command = [
        program.display().to_string(),
        "sweep".to_owned(),
        "run".to_owned(),
        absolute(&args.file).display().to_string(),
        "--out".to_owned(),
        absolute(&args.out()).display().to_string(),
    ];
    let name = args.file.file_stem().unwrap_or_default().to_string_lossy();
    print(&array_script(&name, tasks.into(), cpus.into(), &command))
}
