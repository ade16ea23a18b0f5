//! Whole commands of the program: wall and processor time, on one thread and on two.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use super::paths::Before;
use crate::{XtaskError, files};

/// Ticks of a second in the processor times of `/proc`: the same on every Linux.
const TICKS_PER_S: f64 = 100.0;
/// Where the system keeps the processor time of programs that have ended.
const OWN_TIMES: &str = "/proc/self/stat";
/// A command is not begun again once its runs have taken so long, s.
const LONGEST_S: f64 = 12.0;

/// What a command took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spent {
    /// Time by the clock, s.
    pub wall_s: f64,
    /// Time of all processors, for user and system, s.
    pub cpu_s: f64,
}

/// A command that is timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// What it does.
    pub name: &'static str,
    /// Its arguments, with paths from the root.
    pub arguments: &'static str,
    /// Arguments of a command before it that makes what it needs; not timed.
    pub after: Option<&'static str>,
    /// Seconds that it may take on two threads: by the clock, or of all processors.
    pub bar_s: Option<f64>,
    /// Whether the bar is for processor time.
    pub bar_is_cpu: bool,
    /// What it took before the work on speed.
    pub before: Option<Before>,
    /// Whether it flies a rotor, so that it is made of residuals of a revolution.
    pub is_of_rotor: bool,
    /// Whether it is timed on two threads alone, and left out where there is no time.
    pub slow: bool,
}

/// The trim in the free wake alone.
pub const WAKE: Timing = Timing {
    name: "trim in the free wake alone",
    arguments: "wake fixtures/cases/paper_mu030.ron",
    after: None,
    bar_s: None,
    bar_is_cpu: false,
    before: None,
    is_of_rotor: true,
    slow: false,
};

/// The paper's case: three harmonics with three actuators.
pub const CASE: Timing = Timing {
    name: "case with 3 harmonics x 3 actuators in the free wake",
    arguments: "run fixtures/cases/paper_mu030.ron --inflow free",
    bar_s: Some(5.0),
    before: Some(Before::took(26.0, 26.0)),
    ..WAKE
};

/// The same with the table of assumptions.
pub const BARE: Timing = Timing {
    name: "the paper's study, bare `hhc`",
    arguments: "",
    bar_s: Some(15.0),
    before: Some(Before { range_s: [41.0; 2], otherwise: "its table in Drees's inflow" }),
    ..WAKE
};

/// All commands that are timed.
pub const TIMINGS: [Timing; 8] = [
    WAKE,
    CASE,
    Timing {
        name: "five advance ratios with control in the free wake",
        arguments: "run fixtures/cases/paper_mu030.ron --inflow free --mu 0.15,0.20,0.25,0.30,0.35",
        bar_s: Some(40.0),
        bar_is_cpu: true,
        before: Some(Before::took(344.0, 344.0)),
        slow: true,
        ..WAKE
    },
    BARE,
    Timing {
        name: "60 s of flight under three controllers, Drees's inflow",
        arguments: "fly fixtures/cases/flight_ramp.ron",
        bar_s: Some(20.0),
        is_of_rotor: false,
        ..WAKE
    },
    Timing {
        name: "how wrong T may be, and flights under noise, a wrong T and drift",
        arguments: "run fixtures/cases/paper_mu030.ron --robustness",
        bar_s: Some(60.0),
        slow: true,
        ..WAKE
    },
    Timing {
        name: "identification of the shipped bench set",
        arguments: "identify fixtures/bench/apa500l_synthetic -o a.ron",
        bar_s: Some(6.0),
        before: Some(Before::took(14.0, 20.0)),
        is_of_rotor: false,
        ..WAKE
    },
    Timing {
        name: "diagnosis of a set, nothing kept from others",
        arguments: "diagnose actuator.ron --data fixtures/bench/everyday_synthetic/a -o out/found",
        after: Some("identify fixtures/bench/everyday_synthetic/reference -o actuator.ron"),
        bar_s: Some(15.0),
        is_of_rotor: false,
        ..WAKE
    },
];

/// A command and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// The command.
    pub timing: Timing,
    /// On one thread, if it was timed so.
    pub one: Option<Spent>,
    /// On two threads.
    pub two: Spent,
    /// What the program of an earlier tree took on two threads, in the same run.
    pub earlier: Option<Spent>,
}

impl Timed {
    /// Seconds over which the bar is held.
    pub fn held_s(&self) -> f64 {
        self.held_of(self.two)
    }

    fn held_of(&self, spent: Spent) -> f64 {
        if self.timing.bar_is_cpu { spent.cpu_s } else { spent.wall_s }
    }

    /// What it took before: measured in the same run where there is an earlier program, or as it was noted.
    pub fn before(&self) -> Option<Before> {
        let noted = self.timing.before?;
        Some(self.earlier.map_or(noted, |earlier| Before {
            range_s: [self.held_of(earlier); 2],
            otherwise: noted.otherwise,
        }))
    }

    /// Processor seconds: those of one thread, where no thread waits for another.
    pub fn cpu_s(&self) -> f64 {
        self.one.unwrap_or(self.two).cpu_s
    }
}

/// The program, and how it is run.
#[derive(Debug, Clone)]
pub(super) struct Program<'a> {
    /// Root of the tree.
    pub(super) root: &'a Path,
    /// The program.
    pub(super) path: PathBuf,
    /// Folder of its own.
    pub(super) folder: PathBuf,
    /// Runs of a command at most, of which the least times count.
    pub(super) most_runs: usize,
}

impl Program<'_> {
    /// Times a command.
    pub(super) fn timed(&self, timing: &Timing) -> Result<Timed, XtaskError> {
        if let Some(before) = timing.after {
            self.run(before, 2)?;
        }
        let one = if timing.slow { None } else { Some(self.least(timing.arguments, 1)?) };
        let two = self.least(timing.arguments, 2)?;
        Ok(Timed { timing: *timing, one, two, earlier: None })
    }

    /// The least times of some runs, each from nothing.
    pub(super) fn least(&self, arguments: &str, threads: usize) -> Result<Spent, XtaskError> {
        let failed = |source| XtaskError::Write { path: self.folder.clone(), source };
        std::fs::create_dir_all(&self.folder).map_err(failed)?;
        let mut least = Spent { wall_s: f64::INFINITY, cpu_s: f64::INFINITY };
        let mut all_s = 0.0;
        for _ in 0..self.most_runs {
            // results and what is kept for later runs
            files::remove_folder(&self.folder.join("out"))?;
            let spent = self.run(arguments, threads)?;
            least.wall_s = least.wall_s.min(spent.wall_s);
            least.cpu_s = least.cpu_s.min(spent.cpu_s);
            all_s += spent.wall_s;
            if all_s > LONGEST_S {
                break;
            }
        }
        Ok(least)
    }

    fn run(&self, arguments: &str, threads: usize) -> Result<Spent, XtaskError> {
        let from_root = |word: &str| match word.strip_prefix("fixtures/") {
            Some(_) => self.root.join(word).into_os_string(),
            None => word.into(),
        };
        let mut command = Command::new(&self.path);
        command.args(arguments.split_whitespace().map(from_root));
        command.current_dir(&self.folder).env("RAYON_NUM_THREADS", threads.to_string());
        let program = || format!("hhc {arguments}");
        let (started, cpu_s) = (Instant::now(), ended_programs_s()?);
        let output = command
            .stdin(Stdio::null())
            .output()
            .map_err(|source| XtaskError::Start { program: program(), source })?;
        let wall_s = started.elapsed().as_secs_f64();
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            let said = said.lines().next().unwrap_or("nothing").to_owned();
            return Err(XtaskError::Refused { program: program(), said });
        }
        Ok(Spent { wall_s, cpu_s: ended_programs_s()? - cpu_s })
    }
}

/// Processor time of all programs that this one has started and that have ended, s.
fn ended_programs_s() -> Result<f64, XtaskError> {
    ended_in(&files::read(Path::new(OWN_TIMES))?).ok_or_else(|| XtaskError::Speed {
        what: OWN_TIMES.to_owned(),
        said: "no processor times where Linux has them".to_owned(),
    })
}

/// The same in a text of `/proc/PID/stat`: its fields `cutime` and `cstime`, the 16th and 17th.
fn ended_in(stat: &str) -> Option<f64> {
    // the second field, the name, may hold blanks and brackets
    let (_, rest) = stat.rsplit_once(')')?;
    let mut ticks = rest.split_whitespace().skip(13).map(|field| field.parse::<u32>().ok());
    Some(f64::from(ticks.next()?? + ticks.next()??) / TICKS_PER_S)
}

/// The list of a data folder without the runs whose lines hold one of some texts, and how many runs are left. Each run has a line
/// that begins with `(id:`.
pub(super) fn thinned(dataset: &str, without: &[&str]) -> (String, usize) {
    let is_run = |line: &&str| line.trim_start().starts_with("(id:");
    let is_left = |line: &&str| !without.iter().any(|text| line.contains(text));
    let stays = |line: &&str| !is_run(line) || is_left(line);
    let runs = dataset.lines().filter(|line| is_run(line) && is_left(line)).count();
    (dataset.lines().filter(stays).flat_map(|line| [line, "\n"]).collect(), runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_times_are_found_behind_any_name() {
        let stat = "17 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 11 12 250 75 20 0 1";
        assert_eq!(ended_in(stat), Some(3.25));
        for stat in ["", "17 (a) S 1 2", "17 (a) S 1 2 3 4 5 6 7 8 9 10 11 12 x 75"] {
            assert_eq!(ended_in(stat), None, "{stat}");
        }
    }

    #[test]
    fn a_thinned_set_lacks_the_runs_that_are_named() {
        let dataset = "(\n    runs: [\n        (id: \"a_25v\"),\n        (id: \"b\"),\n    ],\n    note: \"25v\",\n)\n";
        assert_eq!(thinned(dataset, &[]), (dataset.to_owned(), 2));
        let left = dataset.replace("        (id: \"a_25v\"),\n", "");
        assert_eq!(thinned(dataset, &["25v"]), (left, 1));
        assert_eq!(thinned(dataset, &["25v", "b"]).1, 0);
    }

    #[test]
    fn a_program_that_fails_says_so_and_processor_time_is_counted() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let program = |path: &str| Program {
            root,
            path: path.into(),
            folder: root.to_path_buf(),
            most_runs: 2,
        };
        let spent = program("true").least("", 1).unwrap();
        assert!(spent.wall_s > 0.0 && spent.cpu_s >= 0.0, "{spent:?}");
        let failed = program("ls").least("fixtures/none", 1).unwrap_err().to_string();
        assert!(failed.contains("hhc fixtures/none failed"), "{failed}");
        let missing = program("no such program").least("", 1).unwrap_err();
        assert!(matches!(missing, XtaskError::Start { .. }));
    }
}
