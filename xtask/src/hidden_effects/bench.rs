//! Runs the program on generated folders.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

use score::case::Case;
use score::findings::{Findings, Gain, Verdict};
use truth::hidden::{Answer, File, Request, Size, is_experiment, measured_set, reference_files};

use super::{Failure, Group};
use crate::{XtaskError, files};

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
    /// What stands beside every result: which programs made it.
    made_by: String,
}

/// Builds the program as a user would.
pub(super) fn build(root: &Path) -> Result<PathBuf, XtaskError> {
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
    /// The program at a path.
    ///
    /// # Errors
    /// [`XtaskError::Start`] where it does not start, [`XtaskError::Program`] where it cannot diagnose.
    pub fn new(program: PathBuf) -> Result<Self, XtaskError> {
        let mut hhc = Self { program, oracle: Oracle::Absent, made_by: String::new() };
        let help = hhc.call(&["diagnose", "--help"], Path::new("."))?;
        if !help.status.success() {
            return Err(hhc.failed(&help));
        }
        if String::from_utf8_lossy(&help.stdout).contains("--only") {
            hhc.oracle = Oracle::Present;
        }
        Ok(hhc)
    }

    /// Marks every result with what made it.
    #[must_use]
    pub fn marked(self, made_by: &str) -> Self {
        Self { made_by: made_by.to_owned(), ..self }
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

    fn identify(&self, folder: &Path) -> Result<(), XtaskError> {
        let output = self.call(&["identify", "reference", "-o", "actuator.ron"], folder)?;
        if output.status.success() { Ok(()) } else { Err(self.failed(&output)) }
    }

    /// Findings and wall time of one diagnosis of `folder/measured`.
    fn diagnose(&self, folder: &Path, only: &[&str]) -> Result<(Findings, f64), XtaskError> {
        files::remove_folder(&folder.join("found"))?;
        // What the program keeps for a base lies in its own folder beside, and stays.
        let mut arguments = vec!["diagnose", "actuator.ron", "--data", "measured", "-o", "found"];
        let list = only.join(",");
        if !only.is_empty() {
            arguments.extend(["--only", &list]);
        }
        let begin = Instant::now();
        let output = self.call(&arguments, folder)?;
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

/// A result kept.
pub(super) fn read_case(path: &Path) -> Result<Case, XtaskError> {
    serde_json::from_str(&files::read(path)?)
        .map_err(|source| XtaskError::Findings { path: path.to_path_buf(), source })
}

/// Runs the sets of a group that were not done before and keeps their results; those without findings.
pub(super) fn run_group(
    hhc: &Hhc,
    folder: &Path,
    group: &Group,
    tell: &(impl Fn(&str) + Sync),
) -> Result<Vec<Failure>, XtaskError> {
    let name = format!("base{}_{}db", group.base, group.snr_db);
    let mut bench = Bench {
        hhc,
        folder: folder.join("bench").join(&name),
        prepared: false,
        follow_ups_left: FOLLOW_UPS,
    };
    let mut failures = Vec::new();
    for seed in &group.seeds {
        let set = format!("seed {seed}, {} dB, base {}", group.snr_db, group.base);
        let kept = folder.join(format!("{name}_seed{seed}.json"));
        let request = Request::new(*seed, group.snr_db);
        if kept.exists() {
            let case = read_case(&kept)?;
            bench.follow_ups_left -= u32::from(case.follow_up.is_some()).min(bench.follow_ups_left);
            tell(&format!("{set}: done before"));
            continue;
        }
        match bench.case(&request, group) {
            Ok(case) => {
                let text = serde_json::to_string(&case)
                    .map_err(|source| XtaskError::Findings { path: kept.clone(), source })?;
                files::write_atomically(&kept, &text)?;
                let hidden = &case.answer.hidden;
                let answer = case.findings.causes.join(", ");
                let verdict = case.findings.verdict;
                tell(&format!("{set}: {hidden} -> {verdict:?} {answer} ({:.1} s)", case.seconds));
            }
            Err(XtaskError::Refused { said, .. }) => {
                tell(&format!("{set}: {said}"));
                failures.push(Failure { set, said });
            }
            Err(other) => return Err(other),
        }
    }
    files::remove_folder(&bench.folder)?;
    Ok(failures)
}

/// The folder in which a group is diagnosed.
struct Bench<'a> {
    hhc: &'a Hhc,
    folder: PathBuf,
    prepared: bool,
    follow_ups_left: u32,
}

/// Proposed experiments that are done in a group: each is a design of its own, whose first diagnosis is slow.
const FOLLOW_UPS: u32 = 3;

/// Every so many seeds the gain is found again with other noise.
const REPLICATED: u64 = 6;

/// Further draws of the noise there.
const REPLICATES: u64 = 4;

impl Bench<'_> {
    /// Reference folder and actuator; a first diagnosis, of `request`, whose time it returns.
    fn prepare(&self, request: &Request, group: &Group) -> Result<f64, XtaskError> {
        let reference = reference_files(group.base, group.snr_db, Size::Small)?;
        self.write("reference", &reference)?;
        self.hhc.identify(&self.folder)?;
        self.measure(request)?;
        Ok(self.hhc.diagnose(&self.folder, &[])?.1)
    }

    /// Replaces a folder of data.
    fn write(&self, name: &str, content: &[File]) -> Result<(), XtaskError> {
        let folder = self.folder.join(name);
        files::remove_folder(&folder)?;
        for (file, text) in content {
            files::write_atomically(&folder.join(file), text)?;
        }
        Ok(())
    }

    fn measure(&self, request: &Request) -> Result<Answer, XtaskError> {
        let set = measured_set(request)?;
        self.write("measured", &set.files)?;
        Ok(set.answer)
    }

    fn case(&mut self, request: &Request, group: &Group) -> Result<Case, XtaskError> {
        let first_seconds = if self.prepared { None } else { Some(self.prepare(request, group)?) };
        self.prepared = true;
        let answer = self.measure(request)?;
        let (findings, seconds) = self.hhc.diagnose(&self.folder, &[])?;
        let (oracle, follow_up, replicates) = (None, None, Vec::new());
        let made_by = self.hhc.made_by.clone();
        let mut case = Case {
            answer,
            findings,
            seconds,
            first_seconds,
            oracle,
            follow_up,
            replicates,
            made_by,
        };
        case.oracle = self.oracle_gain(&case)?;
        case.replicates = self.replicate_gains(request, &case)?;
        case.follow_up = self.follow_up(request, &case)?;
        Ok(case)
    }

    fn oracle_gain(&self, case: &Case) -> Result<Option<Gain>, XtaskError> {
        let causes = case.causes();
        let named = !case.findings.names().is_empty();
        if causes.is_empty() || !named || self.hhc.oracle() == Oracle::Absent {
            return Ok(None);
        }
        Ok(Some(self.hhc.diagnose(&self.folder, &causes)?.0.gain))
    }

    fn replicate_gains(&self, request: &Request, case: &Case) -> Result<Vec<Gain>, XtaskError> {
        let wanted = case.single().is_some() && request.seed.is_multiple_of(REPLICATED);
        if !wanted || case.findings.names().is_empty() {
            return Ok(Vec::new());
        }
        (1..=REPLICATES)
            .map(|replicate| {
                self.measure(&Request { replicate, ..request.clone() })?;
                Ok(self.hhc.diagnose(&self.folder, &[])?.0.gain)
            })
            .collect()
    }

    /// The proposed experiment, done where the verdict is ambiguous.
    fn follow_up(
        &mut self,
        request: &Request,
        case: &Case,
    ) -> Result<Option<Findings>, XtaskError> {
        let proposed = &case.findings.next_experiment;
        let known = is_experiment(proposed);
        let open = case.findings.verdict == Verdict::Ambiguous && case.single().is_some();
        if !(known && open && self.follow_ups_left > 0) {
            return Ok(None);
        }
        self.follow_ups_left -= 1;
        self.measure(&Request { experiment: Some(proposed.clone()), ..request.clone() })?;
        Ok(Some(self.hhc.diagnose(&self.folder, &[])?.0))
    }
}
