//! The program that diagnoses, run on generated folders; where the results of a suite are kept, and for which programs.

mod programs;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use score::findings::Findings;
use score::metrics::{Metric, Outcome};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{XtaskError, files};

pub(crate) use programs::{commit, said};

/// A set that could not be diagnosed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// The set.
    pub set: String,
    /// What was said.
    pub said: String,
}

/// What to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options<S> {
    /// Which sets.
    pub selection: S,
    /// Sets, or groups of them, at a time.
    pub threads: usize,
    /// The program that diagnoses; none: it is built.
    pub hhc: Option<PathBuf>,
    /// Folder of the results; none: one of the programs' own.
    pub out: Option<PathBuf>,
}

/// Tells every line with its number of so many.
pub(crate) fn counted(
    total: usize,
    progress: &(impl Fn(&str) + Sync),
) -> impl Fn(&str) + Sync + '_ {
    let done = AtomicUsize::new(0);
    move |line: &str| {
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress(&format!("{count}/{total} {line}\n"));
    }
}

/// The last lines of a report: what failed, and how many sets and bars.
pub(crate) fn closing(sets: usize, failures: &[Failure], metrics: &[Metric]) -> String {
    let mut text = String::new();
    for failure in failures {
        let _ = writeln!(text, "failed: {}: {}", failure.set, failure.said);
    }
    let (failed, missed) = (failures.len(), missed(metrics));
    let _ = writeln!(text, "{sets} sets scored, {failed} failed, {missed} bars missed");
    text
}

/// 0, or 3 where a bar is missed or a set failed.
pub(crate) fn exit_code(failures: &[Failure], metrics: &[Metric]) -> u8 {
    if missed(metrics) > 0 || !failures.is_empty() { 3 } else { 0 }
}

fn missed(metrics: &[Metric]) -> usize {
    metrics.iter().filter(|metric| metric.outcome() == Outcome::Missed).count()
}

/// Whether the program refits causes that are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Oracle {
    /// It knows `--only`.
    Present,
    /// It does not.
    Absent,
}

/// The program that diagnoses.
#[derive(Debug, Clone)]
pub struct Hhc {
    program: PathBuf,
    oracle: Oracle,
    made_by: String,
}

/// Builds the program as a user would.
pub(crate) fn build(root: &Path) -> Result<PathBuf, XtaskError> {
    let status = Command::new("cargo")
        .args(["build", "--release", "-p", "sim-driver"])
        .current_dir(root)
        .status()
        .map_err(|source| XtaskError::Start { program: "cargo".to_owned(), source })?;
    if !status.success() {
        let said = "cargo build --release -p sim-driver did not succeed".to_owned();
        return Err(XtaskError::Refused { program: "cargo".to_owned(), said });
    }
    Ok(root.join("target/release/hhc"))
}

impl Hhc {
    /// The program at a path, whose results are marked with what made them.
    ///
    /// # Errors
    /// [`XtaskError::Start`] where it does not start, [`XtaskError::Program`] where it cannot diagnose.
    fn new(program: PathBuf, made_by: String) -> Result<Self, XtaskError> {
        let mut hhc = Self { program, oracle: Oracle::Absent, made_by };
        let help = hhc.call(&["diagnose", "--help"], Path::new("."))?;
        if !help.status.success() {
            return Err(hhc.failed(&help));
        }
        if String::from_utf8_lossy(&help.stdout).contains("--only") {
            hhc.oracle = Oracle::Present;
        }
        Ok(hhc)
    }

    /// What stands beside every result: which programs made it.
    pub(crate) fn made_by(&self) -> &str {
        &self.made_by
    }

    /// Whether it refits causes that are given.
    pub fn oracle(&self) -> Oracle {
        self.oracle
    }

    fn call(&self, arguments: &[&str], folder: &Path) -> Result<Output, XtaskError> {
        let program = || self.program.display().to_string();
        Command::new(&self.program)
            .args(arguments)
            .current_dir(folder)
            // Groups run side by side already.
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .map_err(|source| XtaskError::Start { program: program(), source })
    }

    fn failed(&self, output: &Output) -> XtaskError {
        let said = String::from_utf8_lossy(&output.stderr);
        let said = said.lines().next().unwrap_or("nothing").to_owned();
        XtaskError::Refused { program: self.program.display().to_string(), said }
    }

    /// Identifies `folder/actuator.ron` from `folder/reference`; wall time, s.
    pub(crate) fn identify(&self, folder: &Path) -> Result<f64, XtaskError> {
        let begin = Instant::now();
        let output = self.call(&["identify", "reference", "-o", "actuator.ron"], folder)?;
        let seconds = begin.elapsed().as_secs_f64();
        if output.status.success() { Ok(seconds) } else { Err(self.failed(&output)) }
    }

    /// Findings and wall time of one diagnosis of `folder/measured`.
    pub(crate) fn diagnose(
        &self,
        folder: &Path,
        only: &[&str],
    ) -> Result<(Findings, f64), XtaskError> {
        files::remove_folder(&folder.join("found"))?;
        // What the program keeps for a base lies in its own folder beside, and stays.
        let mut arguments = vec!["diagnose", "actuator.ron", "--data", "measured", "-o", "found"];
        let list = only.join(",");
        if !only.is_empty() {
            arguments.extend(["--only", &list]);
        }
        self.found(&arguments, folder)
    }

    /// Findings and wall time of one diagnosis of the case `folder/case.ron` from a table in `folder`.
    pub(crate) fn diagnose_points(
        &self,
        folder: &Path,
        table: &str,
    ) -> Result<(Findings, f64), XtaskError> {
        let output = self.call(&["import", table, "-o", "measured"], folder)?;
        if !output.status.success() {
            return Err(self.failed(&output));
        }
        self.found(&["diagnose", "case.ron", "--data", "measured", "-o", "found"], folder)
    }

    /// The findings that a call writes to `folder/found`, and its wall time.
    fn found(&self, arguments: &[&str], folder: &Path) -> Result<(Findings, f64), XtaskError> {
        let begin = Instant::now();
        let output = self.call(arguments, folder)?;
        let seconds = begin.elapsed().as_secs_f64();
        if !output.status.success() {
            return Err(self.failed(&output));
        }
        let path = folder.join("found/findings.json");
        let findings = Findings::parse(&files::read(&path)?)
            .map_err(|source| XtaskError::Findings { path, source })?;
        Ok((findings, seconds))
    }
}

/// A program and the folder of its results: that of the options, or one below `target/NAME` that is named after the
/// programs.
pub(crate) fn set_up<S>(
    root: &Path,
    options: &Options<S>,
    name: &str,
) -> Result<(Hhc, PathBuf), XtaskError> {
    let program = options.hhc.clone().map_or_else(|| build(root), Ok)?;
    // It is started from the folders of the data.
    let program = program
        .canonicalize()
        .map_err(|source| XtaskError::Read { path: program.clone(), source })?;
    let programs = programs::Programs::of(root, &program)?;
    let own = || root.join("target").join(name).join(&programs.key);
    let folder = options.out.clone().unwrap_or_else(own);
    Ok((Hhc::new(program, programs.text)?, folder))
}

/// Threads of their own for the sets of a suite.
pub(crate) fn pool(threads: usize) -> Result<rayon::ThreadPool, XtaskError> {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
        XtaskError::Start { program: "threads".to_owned(), source: std::io::Error::other(error) }
    })
}

/// Replaces the files of a folder.
pub(crate) fn write_folder(folder: &Path, content: &[(String, String)]) -> Result<(), XtaskError> {
    files::remove_folder(folder)?;
    for (file, text) in content {
        files::write_atomically(&folder.join(file), text)?;
    }
    Ok(())
}

/// A set of a suite: its name in reports, and that of its files.
pub(crate) struct SetName {
    pub(crate) told: String,
    pub(crate) file: String,
}

/// Makes the result of a set that was not made before, in a folder that is gone afterwards, keeps it and tells its line; a
/// failure where there are no findings.
pub(crate) fn kept_or_made<T: Serialize + DeserializeOwned>(
    folder: &Path,
    SetName { told, file }: SetName,
    (line, tell): (fn(&T) -> String, &(impl Fn(&str) + Sync)),
    made: impl FnOnce(&Path) -> Result<T, XtaskError>,
) -> Result<Option<Failure>, XtaskError> {
    let kept = folder.join(format!("{file}.json"));
    if kept.exists() {
        tell(&format!("{told}: {}, done before", line(&read_result(&kept)?)));
        return Ok(None);
    }
    let place = folder.join("sets").join(file);
    let found = made(&place);
    files::remove_folder(&place)?;
    match found {
        Ok(result) => {
            keep_result(&kept, &result)?;
            tell(&format!("{told}: {}", line(&result)));
            Ok(None)
        }
        Err(XtaskError::Refused { said, .. }) => {
            tell(&format!("{told}: {said}"));
            Ok(Some(Failure { set: told, said }))
        }
        Err(other) => Err(other),
    }
}

/// A result kept.
pub(crate) fn read_result<T: DeserializeOwned>(path: &Path) -> Result<T, XtaskError> {
    serde_json::from_str(&files::read(path)?)
        .map_err(|source| XtaskError::Findings { path: path.to_path_buf(), source })
}

/// Keeps a result.
pub(crate) fn keep_result<T: Serialize>(path: &Path, result: &T) -> Result<(), XtaskError> {
    let text = serde_json::to_string(result)
        .map_err(|source| XtaskError::Findings { path: path.to_path_buf(), source })?;
    files::write_atomically(path, &text)
}

/// All results of a folder.
pub(crate) fn read_results<T: DeserializeOwned>(folder: &Path) -> Result<Vec<T>, XtaskError> {
    let all = files::in_folder(folder)?;
    let results = all.iter().filter(|path| path.extension().is_some_and(|end| end == "json"));
    results.map(|path| read_result(path)).collect()
}

/// How many results each pair of programs made, one line each.
pub(crate) fn makers<'a>(made_by: impl Iterator<Item = &'a str>) -> String {
    let mut made: BTreeMap<&str, usize> = BTreeMap::new();
    for programs in made_by {
        *made.entry(programs).or_default() += 1;
    }
    let mut text = String::new();
    for (programs, sets) in made {
        let _ = writeln!(text, "{sets} sets by {programs}");
    }
    text
}
