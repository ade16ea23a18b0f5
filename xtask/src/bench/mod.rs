//! The speed of the whole: hot paths against bars and limits of the processor, whole commands, growth; one page in the book.
//!
//! The paths are measured by the benches of the crates, which criterion runs and keeps. Limits of the processor are measured by
//! a bench of the same run. Whole commands are run from outside.

pub mod commands;
pub mod growth;
pub mod machine;
pub mod page;
pub mod paths;
pub mod samples;

use std::path::{Path, PathBuf};

use crate::diagnosis::{self, write_folder};
use crate::{XtaskError, files};
use commands::{Program, TIMINGS, Timed, thinned};
use growth::Series;
use machine::Machine;
use page::Figures;
use samples::{Patience, Samples};

/// The page, from the root.
pub const PAGE: &str = "docs/src/performance.md";

/// Where a run keeps what it has measured, from the root.
const FOLDER: &str = "target/speed";

/// A part of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Part {
    /// Hot paths and limits of the processor.
    Paths,
    /// Whole commands.
    Commands,
    /// How times grow with sizes.
    Growth,
}

/// What to measure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// How long.
    pub patience: Patience,
    /// Only one part.
    pub only: Option<Part>,
    /// Root of a tree of an earlier commit, whose commands are timed beside.
    pub before: Option<PathBuf>,
}

impl Options {
    fn asks(&self, part: Part) -> bool {
        self.only.is_none_or(|only| only == part)
    }

    /// Whether the page of the book is made of this run.
    pub fn is_whole(&self) -> bool {
        self.patience == Patience::Usual && self.only.is_none()
    }
}

/// Groups of benches over a size: target, id, and what the page calls it.
const GROWING_BENCHES: [(&str, &str, &str); 7] = [
    ("response", "residual over stations", "residual of a revolution over stations, one core"),
    ("response", "residual over stations, 2 threads", "the same, two cores"),
    ("sweep", "sweep over azimuths", "sweep of the free wake over azimuths, one core"),
    ("sweep", "sweep over azimuths, 2 threads", "the same, two cores"),
    ("sweep", "sweep over turns", "sweep of the free wake over turns, one core"),
    ("sweep", "sweep over turns, 2 threads", "the same, two cores"),
    ("sample", "sample over levels", "dynamic Preisach model, a sample over levels"),
];

/// Bench set of which runs are left out.
const SET: &str = "fixtures/bench/apa500l_synthetic";
/// Which: sines of small amplitudes, so that all frequencies stay.
const LEFT_OUT: [&[&str]; 3] = [&["_25v", "_55v"], &["_25v"], &[]];
/// How many advance ratios one command has, and which.
const RATIOS: [(f64, &str); 3] = [(1.0, "0.30"), (2.0, "0.25,0.30"), (4.0, "0.20,0.25,0.30,0.35")];

/// Measures, and makes the page of it. What is measured is told line by line.
///
/// # Errors
/// [`XtaskError`] where a bench or a command cannot be built, run or read.
pub fn run(root: &Path, options: &Options, progress: impl Fn(&str)) -> Result<String, XtaskError> {
    let machine = Machine::here(root);
    let benches = benches(options);
    let targets: Vec<&str> = benches.iter().map(|(target, _)| *target).collect();
    progress("building\n");
    samples::build(root, &targets)?;
    let path = diagnosis::build(root)?;
    let kept = root.join(FOLDER).join("criterion");
    files::remove_folder(&kept)?;
    for (target, ids) in &benches {
        progress(&format!("bench {target}: {}\n", ids.join(", ")));
        samples::run(root, &kept, (target, ids), options.patience)?;
    }
    let samples = samples::read(&kept)?;
    let folder = root.join(FOLDER).join("run");
    files::remove_folder(&folder)?;
    let most_runs = if options.patience == Patience::Quick { 1 } else { 3 };
    let program = Program { root, path, folder, most_runs };
    let earlier = options.before.as_deref().map(|before| earlier(before, &program)).transpose()?;
    let commands = timed(&program, earlier.as_ref(), options, &progress)?;
    let before = options.before.as_deref().map(diagnosis::commit);
    let growth = growth(&program, options, &samples, &progress)?;
    let paths = if options.asks(Part::Paths) { paths::measured(&samples)? } else { Vec::new() };
    page::render(&Figures { machine, before, samples, paths, growth, commands })
}

/// The program of an earlier tree, built there.
fn earlier<'a>(root: &'a Path, program: &Program<'_>) -> Result<Program<'a>, XtaskError> {
    let path = diagnosis::build(root)?;
    Ok(Program { root, path, folder: program.folder.join("before"), most_runs: 1 })
}

/// The benches asked for, by target.
fn benches(options: &Options) -> Vec<(&'static str, Vec<&'static str>)> {
    let mut all = if options.asks(Part::Paths) { paths::benches() } else { Vec::new() };
    for (target, id, _) in GROWING_BENCHES.iter().filter(|_| options.asks(Part::Growth)) {
        paths::add(&mut all, target, id);
    }
    all
}

/// The commands asked for, those of an earlier program beside.
fn timed(
    program: &Program<'_>,
    earlier: Option<&Program<'_>>,
    options: &Options,
    progress: &impl Fn(&str),
) -> Result<Vec<Timed>, XtaskError> {
    let quick = options.patience == Patience::Quick;
    let asked = TIMINGS.iter().filter(|t| options.asks(Part::Commands) && !(quick && t.slow));
    let one = |timing| {
        let mut timed = program.timed(timing)?;
        if let Some(earlier) = earlier.filter(|_| timing.before.is_some()) {
            timed.earlier = Some(earlier.least(timing.arguments, 2)?);
        }
        progress(&format!("hhc {}: {:.1} s\n", timing.arguments, timed.two.wall_s));
        Ok(timed)
    };
    asked.map(one).collect()
}

/// The series asked for: of the benches, and of commands.
fn growth(
    program: &Program<'_>,
    options: &Options,
    samples: &Samples,
    progress: &impl Fn(&str),
) -> Result<Vec<Series>, XtaskError> {
    if !options.asks(Part::Growth) {
        return Ok(Vec::new());
    }
    let of_group = |(_, id, name): &(&str, &str, &str)| Series::of_group(samples, id, name);
    let mut all: Vec<Series> = GROWING_BENCHES.iter().map(of_group).collect();
    let mut command = |name: &str, runs: &[(f64, String)]| -> Result<(), XtaskError> {
        for threads in [1, 2] {
            let mut points = Vec::new();
            for (size, arguments) in runs {
                let spent = program.least(arguments, threads)?;
                progress(&format!("hhc {arguments}: {:.1} s\n", spent.wall_s));
                points.push((*size, spent.wall_s));
            }
            let cores = if threads == 1 { "one core" } else { "two cores" };
            all.push(Series { name: format!("{name}, {cores}"), points });
        }
        Ok(())
    };
    command("identification over runs of the bench set", &thinned_sets(program)?)?;
    let case = |ratios: &str| format!("run fixtures/cases/paper_mu030.ron --mu {ratios}");
    let cases = RATIOS.map(|(count, ratios)| (count, case(ratios)));
    command("study in Drees's inflow over cases", &cases)?;
    Ok(all)
}

/// Data folders with ever more runs of the shipped set: how many, and the command that identifies from them.
fn thinned_sets(program: &Program<'_>) -> Result<Vec<(f64, String)>, XtaskError> {
    let mut content = Vec::new();
    for path in files::in_folder(&program.root.join(SET))? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        content.push((name, files::read(&path)?));
    }
    let of = |without: &[&str]| -> Result<(f64, String), XtaskError> {
        let mut content = content.clone();
        let mut runs = 0;
        for (_, text) in content.iter_mut().filter(|(name, _)| name == "dataset.ron") {
            (*text, runs) = thinned(text, without);
        }
        let folder = format!("runs_{runs}");
        write_folder(&program.folder.join(&folder), &content)?;
        Ok((runs as f64, format!("identify {folder} -o out/a.ron")))
    };
    LEFT_OUT.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_asks_for_its_own_benches_and_a_whole_run_for_all() {
        let of = |only| benches(&Options { patience: Patience::Quick, only, before: None });
        assert!(of(Some(Part::Commands)).is_empty());
        let growing = of(Some(Part::Growth));
        assert_eq!(
            growing.iter().map(|(t, _)| *t).collect::<Vec<_>>(),
            ["response", "sweep", "sample"]
        );
        let all = of(None);
        assert_eq!(all[0].0, "machine");
        for (target, ids) in of(Some(Part::Paths)).iter().chain(&growing) {
            let known = &all.iter().find(|(other, _)| other == target).unwrap().1;
            assert!(ids.iter().all(|id| known.contains(id)), "{target}: {ids:?}");
        }
    }
}
