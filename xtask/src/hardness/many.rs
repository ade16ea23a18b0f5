//! A sweep of a thousand cases of the paper's rotor in Drees's inflow: what a case costs beside one on a core of its own, what the memory
//! does, and what a kill leaves.

use std::fmt;
use std::path::Path;
use std::process::Child;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::memory::{Watch, results};
use super::place::Place;
use crate::{XtaskError, files};

/// Part of the cases that one process computes on one core, which a case of the sweep is compared with: cases of the same
/// sweep, drawn by their keys. A further process of one case takes what reading and identifying the bench cost.
const ALONE_PART: usize = 25;
/// Part of the cases that is there when the sweep is killed.
const KILLED_AFTER: f64 = 0.1;
/// Time between two looks at a process, and at its results, of which there are many.
const LOOK: Duration = Duration::from_millis(20);
const LOOK_AT_RESULTS: Duration = Duration::from_millis(500);
/// Most that a case may cost beyond one on a core of its own, and most growth of the memory, MB.
const MOST_COST: f64 = 0.1;
const MOST_GROWTH_MB: f64 = 10.0;

/// Time of a process: on the clock, and of processors, s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Took {
    /// On the clock.
    pub wall_s: f64,
    /// Of processors.
    pub processor_s: f64,
}

impl Took {
    fn less(self, other: Self) -> Self {
        Self {
            wall_s: self.wall_s - other.wall_s,
            processor_s: self.processor_s - other.processor_s,
        }
    }

    fn times(self, factor: f64) -> Self {
        Self { wall_s: factor * self.wall_s, processor_s: factor * self.processor_s }
    }
}

/// What a sweep of many cases took.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Many {
    /// Cases.
    pub cases: usize,
    /// Threads.
    pub threads: usize,
    /// A further case in one process on one core, the mean of some of the cases.
    pub alone: Took,
    /// These.
    pub alone_cases: usize,
    /// A case of the sweep after the kill; on the clock times the threads.
    pub swept: Took,
    /// Results at the kill, and what was computed after it.
    pub resumed: [usize; 2],
    /// Memory after the kill.
    pub memory: super::memory::Memory,
    /// What must not be, apart from the bars.
    pub faults: Vec<String>,
}

impl Many {
    /// What a case costs beyond one on a core of its own: of processors, and of cores kept from others.
    pub fn more(&self) -> [f64; 2] {
        [
            self.swept.processor_s / self.alone.processor_s - 1.0,
            self.swept.wall_s / self.alone.wall_s - 1.0,
        ]
    }

    /// The faults, and every bar that is missed.
    pub fn all_faults(&self) -> Vec<String> {
        let mut faults = self.faults.clone();
        let [processor, core] = self.more();
        // NaN, of a time too short to be measured, is no proof
        if !(processor <= MOST_COST && core <= MOST_COST) {
            faults.push(format!(
                "a case costs {:+.1} % of processors and {:+.1} % of cores: at most {:+.0} %, on a machine that does nothing else",
                100.0 * processor,
                100.0 * core,
                100.0 * MOST_COST
            ));
        }
        if self.memory.growth_mb().is_none_or(|growth| growth > MOST_GROWTH_MB) {
            faults
                .push(format!("memory grows by more than {MOST_GROWTH_MB:.0} MB, or was not seen"));
        }
        faults
    }
}

impl fmt::Display for Many {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { cases, threads, alone, swept, resumed: [there, computed], memory, .. } = self;
        let [processor, core] = self.more().map(|more| 100.0 * more);
        writeln!(
            f,
            "one case on one core, mean of {}: {:.3} s of it, {:.3} s of processors",
            self.alone_cases, alone.wall_s, alone.processor_s
        )?;
        writeln!(
            f,
            "{cases} cases on {threads} threads: {:.3} s of a core a case ({core:+.1} %), {:.3} s of processors ({processor:+.1} %)",
            swept.wall_s, swept.processor_s
        )?;
        writeln!(f, "killed with {there} results there, {computed} computed after it")?;
        write!(f, "{memory}")
    }
}

/// Time of processors that children of this process took which have ended, s. None where the system does not say.
fn children_s() -> Option<f64> {
    // hundredths of a second, behind the name in brackets: fields 16 and 17
    let text = files::read(Path::new("/proc/self/stat")).ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    Some((ticks(13)? + ticks(14)?) / 100.0)
}

/// Waits for a child, looks at it now and then, and says what it took since it was started.
fn waited(
    mut child: Child,
    (begun, before_s): (Instant, f64),
    (every, mut look): (Duration, impl FnMut()),
) -> Result<Took, XtaskError> {
    let failed = |source| XtaskError::Start { program: "hhc sweep run".to_owned(), source };
    let status = loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            break status;
        }
        look();
        std::thread::sleep(every);
    };
    if !status.success() {
        let said = format!("ended with {status}");
        return Err(XtaskError::Refused { program: "hhc sweep run".to_owned(), said });
    }
    let processor_s = children_s().unwrap_or(f64::NAN) - before_s;
    Ok(Took { wall_s: begun.elapsed().as_secs_f64(), processor_s })
}

fn now() -> (Instant, f64) {
    (Instant::now(), children_s().unwrap_or(f64::NAN))
}

/// A sweep file: a Latin hypercube over advance ratio and torsion stiffness of `cases` cases.
fn write_sweep(place: &Place, name: &str, cases: usize) -> Result<(), XtaskError> {
    let text = format!(
        "(base: \"paper.ron\", axes: [\n    (field: \"advance_ratio\", from: 0.15, to: 0.35),\n    \
         (field: \"rotor.gj\", from: 0.005, to: 0.007),\n], sampling: LatinHypercube(count: {cases}, seed: 1))\n"
    );
    place.write(name, &text)
}

/// Runs the sweep: its cost, its memory, and what a kill in its first part leaves.
///
/// # Errors
/// [`XtaskError`] if the program cannot be run, or a sweep fails.
pub fn measure(
    root: &Path,
    program: &Path,
    cases: usize,
    threads: usize,
) -> Result<Many, XtaskError> {
    let place = Place::new(program)?;
    let case = files::read(&root.join("fixtures/cases/paper_mu030.ron"))?;
    // the bench inside the program is the same one
    place.write("paper.ron", &case.replace("../bench/", "shipped:"))?;
    let arguments = |name: &'static str, out: &'static str| ["sweep", "run", name, "--out", out];
    write_sweep(&place, "many.ron", cases)?;
    let mut one = Vec::new();
    for (out, parts) in [("one", cases), ("few", ALONE_PART.min(cases.div_ceil(2)))] {
        let shard = format!("1/{parts}");
        let shard = [&arguments("many.ron", out)[..], &["--shard", &shard]].concat();
        let begun = now();
        let took = waited(place.spawn(&shard)?, begun, (LOOK, || {}))?;
        one.push((took, place.files(out).len()));
    }
    let mut many = Many { cases, threads, ..Many::default() };
    let [(first, one), (few, some)] = [one[0], one[1]];
    many.alone_cases = some - one;
    many.alone = few.less(first).times(1.0 / many.alone_cases.max(1) as f64);
    let run = arguments("many.ron", "out");
    let (before, met) = killed(&place, &run, threads, cases)?;
    if !met {
        many.faults.push("the sweep had ended before the kill".to_owned());
    }
    let told = |action: &str| -> Result<Value, XtaskError> {
        let said =
            place.said(&["sweep", action, "many.ron", "--out", "out", "--format", "json"])?;
        serde_json::from_str(&said).map_err(|e| XtaskError::Study(format!("{e} in {said}")))
    };
    let there = before.len();
    let status = told("status")?;
    many.check_status(&status, [there, cases - there.min(cases)]);
    let mut watch = Watch::new(cases, there);
    let begun = now();
    let child = place.command(&run).env("RAYON_NUM_THREADS", threads.to_string()).spawn();
    let child = child
        .map_err(|source| XtaskError::Start { program: program.display().to_string(), source })?;
    let id = child.id();
    let took = waited(child, begun, (LOOK_AT_RESULTS, || watch.look(id, results(&place))))?;
    many.memory = watch.memory;
    let after = place.files("out");
    let computed = after.len().saturating_sub(there);
    many.resumed = [there, computed];
    let each = took.times(1.0 / computed.max(1) as f64);
    many.swept = Took { wall_s: threads as f64 * each.wall_s, ..each };
    let changed = before.iter().filter(|(name, bytes)| after.get(*name) != Some(bytes)).count();
    if changed > 0 {
        many.faults.push(format!("{changed} results that were there before the kill changed"));
    }
    many.check_status(&told("status")?, [cases, 0]);
    let again = told("run")?;
    if [&again["skipped"], &again["computed"]] != [cases, 0] {
        many.faults.push(format!("all {cases} results were there, the next run says {again}"));
    }
    place.said(&["sweep", "merge", "many.ron", "--out", "out"])?;
    Ok(many)
}

/// Runs the sweep until a part of its results is there, and kills it: the results that are there then, and whether it still ran.
fn killed(
    place: &Place,
    run: &[&str],
    threads: usize,
    cases: usize,
) -> Result<(super::place::Files, bool), XtaskError> {
    let failed = |source| XtaskError::Start { program: "hhc sweep run".to_owned(), source };
    let mut child =
        place.command(run).env("RAYON_NUM_THREADS", threads.to_string()).spawn().map_err(failed)?;
    let wanted = KILLED_AFTER * cases as f64;
    while (results(place) as f64) < wanted.max(1.0) && child.try_wait().map_err(failed)?.is_none() {
        std::thread::sleep(LOOK);
    }
    let met = child.try_wait().map_err(failed)?.is_none();
    child.kill().map_err(failed)?;
    child.wait().map_err(failed)?;
    Ok((place.files("out"), met))
}

impl Many {
    /// Compares what `hhc sweep status` says with the results that are there and missing.
    fn check_status(&mut self, status: &Value, [there, missing]: [usize; 2]) {
        let count = |key: &str| status[key].as_array().map(Vec::len);
        let failed = status["failed"].as_object().map_or(0, serde_json::Map::len);
        let found = status["found"].as_u64().map(|found| found + failed as u64);
        let found = status["cases"] == there + missing && found == Some(there as u64);
        let lists =
            ["missing", "damaged", "foreign"].map(count) == [Some(missing), Some(0), Some(0)];
        if !(found && lists) {
            self.faults.push(format!(
                "{there} results are there, {missing} are missing, the status says {status}"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hardness::memory::Memory;

    fn many(processor_s: f64, wall_s: f64, growth_mb: f64) -> Many {
        let tenths_mb = vec![None, Some(50.0), Some(50.0 + growth_mb)];
        Many {
            alone: Took { wall_s: 1.0, processor_s: 1.0 },
            swept: Took { wall_s, processor_s },
            memory: Memory { tenths_mb, ..Memory::default() },
            ..Many::default()
        }
    }

    #[test]
    fn each_bar_is_one() {
        for (processor_s, wall_s, growth_mb, faults) in [
            (1.09, 1.09, 9.0, 0),
            (1.11, 1.0, 0.0, 1),
            (1.0, 1.11, 0.0, 1),
            (f64::NAN, 1.0, 0.0, 1),
            (1.0, 1.0, 11.0, 1),
        ] {
            let said = many(processor_s, wall_s, growth_mb).all_faults();
            assert_eq!(said.len(), faults, "{processor_s} {wall_s} {growth_mb}: {said:?}");
        }
    }

    #[test]
    fn a_status_that_says_otherwise_is_a_fault() {
        let of = |found: usize, missing: &[&str], foreign: &[&str]| {
            let status = serde_json::json!({"cases": 3, "found": found, "failed": {}, "damaged": [],
                "missing": missing, "foreign": foreign});
            let mut many = Many::default();
            many.check_status(&status, [2, 1]);
            many.faults.len()
        };
        assert_eq!(of(2, &["a"], &[]), 0);
        assert_eq!([of(3, &[], &[]), of(2, &[], &[]), of(2, &["a"], &["b"])], [1, 1, 1]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_time_of_children_that_ended_is_told() {
        let before_s = children_s().unwrap();
        let work = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done";
        std::process::Command::new("sh").args(["-c", work]).status().unwrap();
        assert!(children_s().unwrap() > before_s);
    }
}
