//! `cargo xtask`: the chores of the project.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::{Parser, Subcommand};
use everyday_bench::family::Family;
use everyday_bench::hidden::Deal;
use rotor_truth::kind::SetKind as PointKind;
use xtask::bench::samples::Patience;
use xtask::diagnosis::Options;
use xtask::{
    XtaskError, bench, calibrate, case_studies, ci, dependencies, dynamic_stall, everyday_errors,
    files, fuzz, hardness, hidden_effects, hover_refinement, layers, point_sets, refinement,
    regress, release, rooms, tidy, validate, wake_control, wake_inflow, wake_refinement, workspace,
};

/// Chores of the project.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Check that crates depend on strictly lower floors only, and modules inside them in no circle
    Layers,
    /// Check that every dependency is used and comes under an allowed licence
    Dependencies,
    /// Check the rules of the house that a text can break
    Tidy,
    /// Run every check against theory and published data, and write docs/src/validation.md
    Validate(Validation),
    /// Write the tables of the case fields in docs/src/case-format.md
    CaseFormat,
    /// Fit the calibrated section model to exact theory and write its table
    Calibrate {
        /// Write nothing; fail if the stored table is not what the fit gives
        #[arg(long)]
        check: bool,
    },
    /// Show what refining the paper's case does to its 4/rev hub loads
    Refinement,
    /// Show what grid, near wake and core of the free wake do to the paper's rotor, to a reference rotor and to a hovering tip
    /// vortex; minutes
    WakeRefinement,
    /// Show where the mean inflow of the free wake at the blades comes from, step by step and part by part
    WakeInflow,
    /// Compare a sweep of the whole program with its golden values
    Regress {
        /// Rewrite the goldens of the cases that differ
        #[arg(long)]
        bless: bool,
        /// Only some cases, for example mu=0.30,n=3
        #[arg(long, default_value = "")]
        filter: String,
        /// Folder of the goldens
        #[arg(long, value_name = "DIR")]
        golden: Option<PathBuf>,
    },
    /// Diagnose synthetic sets with hidden effects and score the findings against the answers
    HiddenEffects {
        /// Kind of the data
        #[arg(long, value_enum, default_value = "bench")]
        kind: SetKind,
        /// Sets of each cause at each noise level; ten without effect, four pairs, four unknown effects with each
        #[arg(long, default_value_t = 10)]
        seeds: u64,
        /// Block of seeds that the suite begins with
        #[arg(long, default_value_t = 0)]
        first_block: u64,
        /// Noise levels, dB; left out: 40,30,20, of a blade 60,50, of a section 40,30
        #[arg(long, value_delimiter = ',')]
        snr: Vec<f64>,
        /// Only some sets: null, pairs, outside, or the id of what is hidden
        #[arg(long, default_value = "")]
        only: String,
        #[command(flatten)]
        suite: Suite,
    },
    /// Diagnose synthetic benches with the everyday errors of a laboratory, one actuator a set, and score the findings
    EverydayErrors(Everyday),
    /// Measure hot paths against bars and limits of the processor, whole commands and growth, and write
    /// docs/src/performance.md; ten minutes on idle cores
    Bench {
        /// Measure shorter, without the slowest command; the page is shown, not written
        #[arg(long)]
        quick: bool,
        /// Only a part, which is shown, not written
        #[arg(long, value_enum)]
        only: Option<bench::Part>,
        /// Root of a checkout of an earlier commit: its commands are built and timed beside
        #[arg(long, value_name = "DIR")]
        before: Option<PathBuf>,
    },
    /// Compare dynamic stall with the measured loops of a folder, and write docs/src/dynamic-stall.md
    DynamicStall(Stall),
    /// Diagnose the measured points of the case studies, and write their figures and numbers
    CaseStudies(Studies),
    /// Give every reader of files changed inputs; a panic is exit code 3, its input is stored
    Fuzz(Fuzzing),
    /// Kill a sweep and studies at random moments, fill their disks; what must not be is exit code 3
    Kills {
        /// The program that is killed
        #[arg(long, value_name = "PROGRAM")]
        program: PathBuf,
        /// Kills of the sweep and of the study; a tenth of them of the paper's study
        #[arg(short = 'n', long, default_value_t = 50)]
        kills: usize,
        /// Seed of the moments
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Measure the memory of a process over the cases of a sweep; growth is exit code 3
    Memory {
        /// The program
        #[arg(long, value_name = "PROGRAM")]
        program: PathBuf,
        /// Cases
        #[arg(long, default_value_t = 1000)]
        cases: usize,
    },
    /// Run a sweep of the paper's rotor in Drees's inflow with a kill on its way: cost of a case beside one on a core of its own, memory,
    /// status and resumption; a missed bar is exit code 3. Twenty minutes on two idle cores
    ManyCases {
        /// The program
        #[arg(long, value_name = "PROGRAM")]
        program: PathBuf,
        /// Cases
        #[arg(short = 'n', long, default_value_t = 1000)]
        cases: usize,
        /// Threads
        #[arg(long, default_value_t = 2)]
        threads: usize,
    },
    /// Package all that is published and look whether each package has what it includes
    Packages {
        /// Install hhc from the packages alone, and run it outside of the repository
        #[arg(long)]
        install: bool,
    },
    /// Write docs/src/data-licences.md from what every folder of data says
    DataLicences {
        /// Write nothing; fail if the page is stale
        #[arg(long)]
        check: bool,
    },
    /// Run .ci/run: everything a change must pass
    Ci,
}

/// Kinds of data with hidden effects.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum SetKind {
    /// Records of an actuator on a bench.
    Bench,
    /// Points of test of a rotor: `--seeds` sets of each effect at each noise.
    Rotor,
    /// Frequencies of a blade, as many.
    Blade,
    /// Loads of an oscillating section, as many.
    Section,
}

impl SetKind {
    /// Noise levels of a suite that names none, dB.
    fn usual_snr_db(self) -> Vec<f64> {
        match self {
            Self::Bench | Self::Rotor => vec![40.0, 30.0, 20.0],
            Self::Blade => vec![60.0, 50.0],
            Self::Section => vec![40.0, 30.0],
        }
    }
}

/// Families of a suite.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Families {
    Relays,
    Duhem,
    Both,
}

impl Families {
    fn list(self) -> Vec<Family> {
        match self {
            Self::Relays => vec![Family::Relays],
            Self::Duhem => vec![Family::Duhem],
            Self::Both => vec![Family::Relays, Family::Duhem],
        }
    }
}

/// How a suite of synthetic sets is run.
#[derive(clap::Args)]
struct Suite {
    /// Sets at a time, or groups of them that share reference runs
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// The program that diagnoses; left out, it is built
    #[arg(long, value_name = "PROGRAM")]
    hhc: Option<PathBuf>,
    /// Folder of the results: sets that are there are not run again, the report is on all of them
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Suite {
    fn options<S>(self, selection: S) -> Options<S> {
        let Self { threads, hhc, out } = self;
        Options { selection, threads, hhc, out }
    }
}

#[derive(clap::Args)]
struct Fuzzing {
    /// For how long at most, s
    #[arg(long, default_value_t = 60)]
    seconds: u64,
    /// Inputs of all readers at which the run ends, those of its earlier parts included
    #[arg(long, default_value_t = u64::MAX, hide_default_value = true)]
    inputs: u64,
    /// Threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Seed of the changes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// File that says how far the run is; left out, target/fuzz/seed-N.json
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Forget earlier parts of the run
    #[arg(long)]
    fresh: bool,
    /// Give one stored input to a reader instead
    #[arg(long, value_name = "FILE", requires = "reader")]
    replay: Option<PathBuf>,
    /// That reader
    #[arg(long)]
    reader: Option<String>,
}

#[derive(clap::Args)]
struct Stall {
    /// Folder of the loops
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Fit the constants anew and show them; nothing is written
    #[arg(long)]
    fit: bool,
    /// Show the page, write nothing
    #[arg(long, conflicts_with = "fit")]
    show: bool,
}

#[derive(clap::Args)]
struct Studies {
    /// Name of a page in docs/src/case-studies; left out, all of them
    name: Option<String>,
    /// Only those of seconds
    #[arg(long, conflicts_with = "name")]
    quick: bool,
    /// Write nothing; fail if a page or a figure is not what the program says
    #[arg(long)]
    check: bool,
}

#[derive(clap::Args)]
struct Everyday {
    /// Number of sets
    #[arg(long, default_value_t = 60)]
    sets: u64,
    /// The first of their seeds; the others follow it
    #[arg(long, default_value_t = 0)]
    first_seed: u64,
    /// Hysteresis: relays, duhem, or both in turn
    #[arg(long, default_value = "both")]
    family: Families,
    /// What the seeds are dealt: everyday, singles, nulls, all
    #[arg(long, default_value = "all")]
    kind: Deal,
    #[command(flatten)]
    suite: Suite,
}

#[derive(clap::Args)]
struct Validation {
    /// Only the rows with this text in id or heading; the page is left alone
    #[arg(long, default_value = "", conflicts_with = "check")]
    filter: String,
    /// Write nothing; fail if the page does not say what the rows say
    #[arg(long)]
    check: bool,
    /// Run no test: take the rows that tests have written to this folder (`VALIDATION_ROWS`)
    #[arg(long, value_name = "DIR")]
    rows: Option<PathBuf>,
    /// Profile the tests are built with; the rows are the same in all of them
    #[arg(long, default_value = "release", value_name = "PROFILE")]
    profile: String,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let root = workspace::root();
    match run(arguments.chore, &root) {
        Ok(code) => code,
        Err(error) => {
            say(&mut std::io::stderr(), &format!("error: {error}\n"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// Shows what became of the inputs, and stores those at which a reader panicked or was slow.
fn fuzz_readers(root: &Path, asked: Fuzzing) -> Result<ExitCode, XtaskError> {
    let Fuzzing { seconds, inputs, threads, seed, state, fresh, replay, reader } = asked;
    if let Some((file, reader)) = replay.zip(reader) {
        let found = fuzz::replay(root, &reader, &files::read_bytes(&file)?)?;
        let said = found.map_or_else(
            || format!("there is no reader {reader}\n"),
            |(taken, s)| format!("{} in {s:.3} s\n", if taken { "taken" } else { "refused" }),
        );
        say(&mut std::io::stdout(), &said);
        return Ok(ExitCode::from(if found.is_some() { 0 } else { 2 }));
    }
    let folder = root.join("target/fuzz");
    let state = state.unwrap_or_else(|| folder.join(format!("seed-{seed}.json")));
    if fresh && state.exists() {
        std::fs::remove_file(&state)
            .map_err(|source| XtaskError::Write { path: state.clone(), source })?;
    }
    let options = fuzz::Options {
        budget: Duration::from_secs(seconds),
        most_inputs: inputs,
        seed,
        threads,
        state: Some(state),
    };
    let tallies = fuzz::fuzz(root, &options)?;
    for tally in &tallies {
        say(&mut std::io::stdout(), &format!("{tally}\n"));
        let name = tally.reader.replace(' ', "_");
        for (input, name) in [(&tally.panicked, name.clone()), (&tally.slow, name + ".slow")] {
            let Some(input) = input else { continue };
            let path = folder.join(name);
            sim_driver::files::write_atomic(&path, input).map_err(sim_driver::SimError::from)?;
            say(&mut std::io::stdout(), &format!("  its input is in {}\n", path.display()));
        }
    }
    let inputs: u64 = tallies.iter().map(|tally| tally.inputs).sum();
    let time_s: f64 = tallies.iter().map(|tally| tally.spent_s).sum();
    let per_s = inputs as f64 / time_s.max(1e-9);
    say(
        &mut std::io::stdout(),
        &format!("{inputs} inputs in {time_s:.0} s of all threads, {per_s:.0} per s and thread\n"),
    );
    let panicked = tallies.iter().any(|tally| tally.panicked.is_some());
    Ok(if panicked { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

/// What a program stands: kills, then disks without space.
fn kill_program(program: &Path, kills: usize, seed: u64) -> Result<ExitCode, XtaskError> {
    let killed = hardness::kills::kill(program, kills, seed)?;
    let disks = hardness::disks::fill(program)?;
    let lines = killed.iter().map(ToString::to_string).chain(disks.iter().map(ToString::to_string));
    let lines: Vec<String> = lines.map(|line| line + "\n").collect();
    let faults = killed.iter().flat_map(|own| &own.faults);
    let faults: Vec<&String> = faults.chain(disks.iter().flat_map(|own| &own.faults)).collect();
    Ok(compared(&faults, &lines.concat()))
}

fn memory(program: &Path, cases: usize) -> Result<ExitCode, XtaskError> {
    let found = hardness::memory::measure(program, cases)?;
    let faults: &[&str] = if found.is_flat() { &[] } else { &["memory grows with the cases"] };
    Ok(compared(faults, &format!("{found}\n")))
}

fn packages(root: &Path, install: bool) -> Result<ExitCode, XtaskError> {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let packed = release::packages::check(root, &root.join(target), install)?;
    let summary = format!(
        "{}\n{} packages, {} KB, {} faults\n",
        packed.steps.join("\n"),
        packed.names.len(),
        packed.bytes / 1024,
        packed.faults.len()
    );
    Ok(verdict(&packed.faults, &summary))
}

fn data_licences(root: &Path, check: bool) -> Result<ExitCode, XtaskError> {
    let (page, mut faults) = release::data_licences::fresh(root)?;
    let path = root.join(release::data_licences::PAGE);
    if check {
        let is_stale = files::read(&path).unwrap_or_default() != page;
        faults.extend(is_stale.then(|| format!("{}: stale", release::data_licences::PAGE)));
    } else if faults.is_empty() {
        files::write_atomically(&path, &page)?;
    }
    Ok(verdict(&faults, &format!("{} faults\n", faults.len())))
}

/// What the choices of the free wake do.
fn wake_tables() -> Result<ExitCode, XtaskError> {
    let line = |line: &str| say(&mut std::io::stdout(), line);
    wake_refinement::paper_table(line);
    line("\n");
    wake_control::table(line).map_err(|error| XtaskError::Study(error.to_string()))?;
    line("\n");
    wake_refinement::table(line);
    line("\n");
    hover_refinement::table(line);
    Ok(ExitCode::SUCCESS)
}

/// Faults of the layers, and the lines of code of every crate.
fn layer_rule(root: &Path) -> Result<ExitCode, XtaskError> {
    let members = workspace::members(root)?;
    let mut faults: Vec<String> = layers::check(&members).iter().map(ToString::to_string).collect();
    let tree = tidy::Tree::load(root)?;
    faults.extend(rooms::check(&tree).iter().map(ToString::to_string));
    let lines = rooms::lines_of_code(&tree);
    let product = lines.iter().filter(|(member, _)| member.starts_with("crates/"));
    let all: usize = product.clone().map(|(_, lines)| lines).sum();
    let by_crate: Vec<String> =
        product.map(|(member, lines)| format!("{lines:6} lines of code in {member}")).collect();
    let summary = format!(
        "{}\n{all:6} in all crates\n{} members, {} faults\n",
        by_crate.join("\n"),
        members.len(),
        faults.len()
    );
    Ok(verdict(&faults, &summary))
}

fn run(chore: Chore, root: &Path) -> Result<ExitCode, XtaskError> {
    match chore {
        Chore::Layers => layer_rule(root),
        Chore::Dependencies => {
            let unused = dependencies::unused(&workspace::members(root)?, &tidy::Tree::load(root)?);
            let (packages, unlicensed) = dependencies::licences(root)?;
            let faults: Vec<String> = unused
                .iter()
                .map(ToString::to_string)
                .chain(unlicensed.iter().map(ToString::to_string))
                .collect();
            Ok(verdict(&faults, &format!("{packages} packages, {} faults\n", faults.len())))
        }
        Chore::Tidy => {
            let tree = tidy::Tree::load(root)?;
            let findings = tidy::check(&tree, &workspace::members(root)?);
            let summary = format!("{} texts, {} faults\n", tree.texts.len(), findings.len());
            Ok(verdict(&findings, &summary))
        }
        Chore::Validate(options) => validation(root, &options),
        Chore::CaseFormat => {
            let path = root.join("docs/src/case-format.md");
            let fresh = sim_driver::case::case_format_page(&files::read(&path)?);
            let said = if let Some(page) = &fresh {
                files::write_atomically(&path, page)?;
                "written"
            } else {
                "not written, as the marks of the fields are missing"
            };
            say(&mut std::io::stdout(), &format!("{}: {said}\n", path.display()));
            Ok(ExitCode::from(if fresh.is_some() { 0 } else { 3 }))
        }
        Chore::Calibrate { check: true } => {
            let differences = calibrate::check(root)?;
            let lines: Vec<String> = differences.iter().map(|line| format!("{line}\n")).collect();
            let summary = format!("{} lines differ\n", differences.len());
            say(&mut std::io::stdout(), &(lines.concat() + &summary));
            Ok(ExitCode::from(if differences.is_empty() { 0 } else { 3 }))
        }
        Chore::Calibrate { check: false } => {
            calibrate::write(root)?;
            say(&mut std::io::stdout(), &format!("written: {}\n", calibrate::TABLE));
            Ok(ExitCode::SUCCESS)
        }
        Chore::Fuzz(asked) => fuzz_readers(root, asked),
        Chore::Kills { program, kills, seed } => kill_program(&program, kills, seed),
        Chore::Memory { program, cases } => memory(&program, cases),
        Chore::ManyCases { program, cases, threads } => {
            let many = hardness::many::measure(root, &program, cases, threads)?;
            Ok(compared(&many.all_faults(), &format!("{many}\n")))
        }
        Chore::Packages { install } => packages(root, install),
        Chore::DataLicences { check } => data_licences(root, check),
        Chore::Refinement => {
            say(&mut std::io::stdout(), &refinement::table()?);
            Ok(ExitCode::SUCCESS)
        }
        Chore::WakeRefinement => wake_tables(),
        Chore::WakeInflow => {
            wake_inflow::tables(|line| say(&mut std::io::stdout(), line))
                .map_err(|error| XtaskError::Study(error.to_string()))?;
            Ok(ExitCode::SUCCESS)
        }
        Chore::Regress { bless, filter, golden } => {
            let folder = golden.unwrap_or_else(|| root.join("fixtures/golden"));
            let mode = if bless { regress::Mode::Bless } else { regress::Mode::Compare };
            let filter = regress::Filter::parse(&filter)?;
            let program = regress::Program::new()?;
            let report = regress::run(&folder, mode, &filter, |point| program.sweep_point(point))?;
            say(&mut std::io::stdout(), &report.text());
            Ok(ExitCode::from(report.exit_code()))
        }
        Chore::HiddenEffects { kind, seeds, first_block, snr, only, suite } => {
            let snr_db = if snr.is_empty() { kind.usual_snr_db() } else { snr };
            let selection = hidden_effects::Selection { seeds, first_block, snr_db, only };
            hidden(root, kind, &suite.options(selection))
        }
        Chore::EverydayErrors(options) => everyday(root, options),
        Chore::Bench { quick, only, before } => speed(root, quick, only, before),
        Chore::DynamicStall(options) => stall(root, &options),
        Chore::CaseStudies(Studies { name, quick, check }) => {
            studies(root, &case_studies::Options { name, quick, check })
        }
        Chore::Ci => ci::run(root),
    }
}

/// Prints summary and faults; what was found otherwise than expected is a failed comparison.
fn compared<F: std::fmt::Display>(faults: &[F], summary: &str) -> ExitCode {
    let lines: Vec<String> = faults.iter().map(|fault| format!("{fault}\n")).collect();
    say(&mut std::io::stdout(), &format!("{summary}{}{} faults\n", lines.concat(), faults.len()));
    if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(3) }
}

/// Prints faults and summary; a broken rule is bad input.
fn verdict<F: std::fmt::Display>(faults: &[F], summary: &str) -> ExitCode {
    let lines: Vec<String> = faults.iter().map(|fault| format!("{fault}\n")).collect();
    say(&mut std::io::stdout(), &(lines.concat() + summary));
    if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(2) }
}

fn validation(root: &Path, options: &Validation) -> Result<ExitCode, XtaskError> {
    let folder = match &options.rows {
        Some(folder) => folder.clone(),
        None => validate::run_tests(root, &options.filter, &options.profile)?,
    };
    let collected = validate::collect(&folder, &options.filter)?;
    let mut text = validate::text(&collected);
    let page = root.join("docs/src/validation.md");
    let mut failed = !collected.passes();
    if options.check {
        let stale = validate::stale_lines(&files::read(&page)?, &collected.rows);
        text.extend(stale.iter().map(|line| format!("stale page, {line}\n")));
        failed |= !stale.is_empty();
    } else if collected.left_out() > 0 {
        text.push_str("not written, as rows were left out; without `--rows` they are computed\n");
        failed = true;
    } else if options.filter.is_empty() && collected.missing.is_empty() {
        files::write_atomically(&page, &validate::render(&collected.rows))?;
        text.extend(["written: ", &page.display().to_string(), "\n"]);
    }
    say(&mut std::io::stdout(), &text);
    Ok(if failed { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

fn studies(root: &Path, options: &case_studies::Options) -> Result<ExitCode, XtaskError> {
    let stale = case_studies::run(root, options, |line| say(&mut std::io::stdout(), line))?;
    let lines: Vec<String> = stale.iter().map(|path| format!("stale: {path}\n")).collect();
    say(&mut std::io::stdout(), &lines.concat());
    Ok(if stale.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(3) })
}

fn hidden(
    root: &Path,
    kind: SetKind,
    options: &Options<hidden_effects::Selection>,
) -> Result<ExitCode, XtaskError> {
    let progress = |line: &str| say(&mut std::io::stderr(), line);
    let of_points = match kind {
        SetKind::Bench => None,
        SetKind::Rotor => Some(PointKind::Rotor),
        SetKind::Blade => Some(PointKind::Blade),
        SetKind::Section => Some(PointKind::Section),
    };
    let (text, code) = if let Some(kind) = of_points {
        let report = point_sets::run(root, kind, options, progress)?;
        (report.text(), report.exit_code())
    } else {
        let report = hidden_effects::run(root, options, progress)?;
        (report.text(), report.exit_code())
    };
    say(&mut std::io::stdout(), &text);
    Ok(ExitCode::from(code))
}

fn everyday(root: &Path, options: Everyday) -> Result<ExitCode, XtaskError> {
    let Everyday { sets, first_seed, family, kind, suite } = options;
    let families = family.list();
    let selection = everyday_errors::Selection { sets, first_seed, families, deal: kind };
    let progress = |line: &str| say(&mut std::io::stderr(), line);
    let report = everyday_errors::run(root, &suite.options(selection), progress)?;
    say(&mut std::io::stdout(), &report.text());
    Ok(ExitCode::from(report.exit_code()))
}

fn speed(
    root: &Path,
    quick: bool,
    only: Option<bench::Part>,
    before: Option<PathBuf>,
) -> Result<ExitCode, XtaskError> {
    let patience = if quick { Patience::Quick } else { Patience::Usual };
    // its programs run in folders of their own
    let absolute =
        |path: PathBuf| path.canonicalize().map_err(|source| XtaskError::Read { path, source });
    let before = before.map(absolute).transpose()?;
    let options = bench::Options { patience, only, before };
    let page = bench::run(root, &options, |line| say(&mut std::io::stderr(), line))?;
    let text = if options.is_whole() {
        files::write_atomically(&root.join(bench::PAGE), &page)?;
        format!("written: {}\n", bench::PAGE)
    } else {
        page
    };
    say(&mut std::io::stdout(), &text);
    Ok(ExitCode::SUCCESS)
}

fn stall(root: &Path, options: &Stall) -> Result<ExitCode, XtaskError> {
    let text = if options.fit {
        dynamic_stall::fitted(&options.data)?
    } else if options.show {
        dynamic_stall::page(&options.data)?
    } else {
        let page = dynamic_stall::page(&options.data)?;
        files::write_atomically(&root.join(dynamic_stall::PAGE), &page)?;
        format!("written: {}\n", dynamic_stall::PAGE)
    };
    say(&mut std::io::stdout(), &text);
    Ok(ExitCode::SUCCESS)
}

/// Writes text; a reader that has gone away is no reason to fail.
fn say(stream: &mut impl Write, text: &str) {
    let _ = stream.write_all(text.as_bytes());
}
