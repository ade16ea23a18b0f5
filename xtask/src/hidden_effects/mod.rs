//! The suite of hidden effects: generated sets, diagnosed by the program, scored against their answers.
//!
//! Sets of one base and one noise level form a group: they share the reference folder and the actuator
//! identified from it. Groups run side by side, the sets of a group one after the other. The result of each set
//! is kept below `target/hidden-effects`, in a folder named after the two programs that made it (the one
//! diagnosing and this one, which holds the generator): an interrupted suite goes on where it was, a
//! changed program begins anew.

mod bench;
mod plan;

use std::path::Path;

use rayon::prelude::*;
use score::case::Case;
use score::metrics::{self, Metric};
use score::report;

pub use plan::{Group, Selection, groups};

use crate::XtaskError;
use crate::diagnosis::{
    Failure, Options, Oracle, closing, counted, exit_code, makers, pool, read_results, set_up,
};

/// What the suite found.
#[derive(Debug, Clone, PartialEq)]
pub struct SuiteReport {
    /// The scored sets, in order of seed and noise.
    pub cases: Vec<Case>,
    /// The metrics.
    pub metrics: Vec<Metric>,
    /// Sets without findings.
    pub failures: Vec<Failure>,
}

impl SuiteReport {
    /// The report of scored sets.
    pub fn of(mut cases: Vec<Case>, failures: Vec<Failure>) -> Self {
        cases.sort_by(|a, b| {
            let key = |case: &Case| (case.answer.seed, case.answer.snr_db.to_bits());
            key(a).cmp(&key(b))
        });
        Self { metrics: metrics::metrics(&cases), cases, failures }
    }

    /// Tables for the terminal.
    pub fn text(&self) -> String {
        let mut text = makers(self.cases.iter().map(|case| case.made_by.as_str()));
        text.push('\n');
        text += &report::confusion_table(&self.cases);
        text.push('\n');
        text += &report::metric_table(&self.metrics);
        text += &closing(self.cases.len(), &self.failures, &self.metrics);
        text
    }

    /// 0, or 3 where a bar is missed or a set failed.
    pub fn exit_code(&self) -> u8 {
        exit_code(&self.failures, &self.metrics)
    }
}

/// Runs the suite, telling its progress line by line.
///
/// # Errors
/// [`XtaskError`] where files cannot be written, programs not be started, or results kept earlier not be read.
pub fn run(
    root: &Path,
    options: &Options<Selection>,
    progress: impl Fn(&str) + Sync,
) -> Result<SuiteReport, XtaskError> {
    let (hhc, folder) = set_up(root, options, "hidden-effects")?;
    if hhc.oracle() == Oracle::Absent {
        progress(
            "hhc diagnose knows no --only: what a refit of the true cause gives stays unknown\n",
        );
    }
    let groups = groups(&options.selection);
    let total: usize = groups.iter().map(|group| group.seeds.len()).sum();
    progress(&format!(
        "{total} sets in {} groups, results in {}\n",
        groups.len(),
        folder.display()
    ));
    let pool = pool(options.threads)?;
    let tell = counted(total, &progress);
    let results = pool.install(|| {
        groups
            .par_iter()
            .with_max_len(1)
            .map(|group| bench::run_group(&hhc, &folder, group, &tell))
            .collect::<Result<Vec<_>, _>>()
    })?;
    let cases = stored(&folder, &options.selection)?;
    Ok(SuiteReport::of(cases, results.into_iter().flatten().collect()))
}

/// The results of a folder, of all blocks, that a selection admits by kind and noise level.
///
/// # Errors
/// [`XtaskError`] for results that cannot be read.
pub fn stored(folder: &Path, selection: &Selection) -> Result<Vec<Case>, XtaskError> {
    let mut cases: Vec<Case> = read_results(folder)?;
    cases.retain(|case| selection.admits_case(&case.answer.hidden, case.answer.snr_db));
    Ok(cases)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files;

    fn result(seed: u64, hidden: &str, made_by: &str) -> String {
        let findings = r#"{"verdict": "nothing-missing", "causes": [], "confidence": "confident", "parameters": {},
            "gain": {"heldout_rms_before": 1.0, "heldout_rms_after": 1.0, "ci95": [0.0, 0.0], "unit": "um"},
            "next_experiment": "small-motion", "not_observable": []}"#;
        format!(
            r#"{{"answer": {{"seed": {seed}, "snr_db": 40.0, "base": 1, "design": "mixed", "monitored": false,
            "hidden": "{hidden}", "effects": [], "noise_um": 1.0, "effect_um": 0.0, "effect_share": 0.0, "runs": [],
            "experiment": null}}, "findings": {findings}, "seconds": 1.0, "first_seconds": null, "oracle": null,
            "follow_up": null, "replicates": [], "made_by": "{made_by}"}}"#
        )
    }

    #[test]
    fn a_folder_of_results_grows_from_run_to_run_and_says_by_which_programs() {
        let folder = tempfile::tempdir().unwrap();
        let selection =
            Selection { seeds: 1, first_block: 0, snr_db: vec![40.0], only: String::new() };
        assert_eq!(stored(&folder.path().join("none"), &selection).unwrap(), []);
        for (seed, hidden, made_by) in
            [(1, "null", "hhc 1"), (40, "creep", "hhc 1"), (2, "null", "hhc 2")]
        {
            let path = folder.path().join(format!("base1_40db_seed{seed}.json"));
            files::write_atomically(&path, &result(seed, hidden, made_by)).unwrap();
        }
        let report = SuiteReport::of(stored(folder.path(), &selection).unwrap(), Vec::new());
        let text = report.text();
        assert!(text.contains("2 sets by hhc 1") && text.contains("1 sets by hhc 2"), "{text}");
        let nulls = Selection { only: "null".to_owned(), ..selection };
        assert_eq!(stored(folder.path(), &nulls).unwrap().len(), 2);
    }
}
