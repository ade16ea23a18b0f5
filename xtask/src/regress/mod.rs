//! The regression sweep: the whole program at 24 conditions with Drees's inflow and five in a free wake, against golden
//! values.
//!
//! A golden is kept for what has no exact answer. Each channel is compared with a tolerance relative
//! to its own value, so that a change of 1 % of any one is seen; counts of solver steps are compared
//! exactly.

mod compare;
mod filter;
mod snapshot;
mod source;
mod sweep;

use std::path::Path;

use rayon::prelude::*;

pub use compare::{Difference, compare, unfit_for_a_golden};
pub use filter::Filter;
pub use snapshot::{GUARDED_CHANGE, Group, Snapshot, Tolerance};
pub use source::{Program, SweepError};
pub use sweep::{
    ADVANCE_RATIOS, FREE_WAKE_ADVANCE_RATIOS, FREE_WAKE_HARMONIC_PER_REV, HARMONICS_PER_REV,
    HUB_LOADS, SweepInflow, SweepPoint, SweepResult, TrimChannels, all_points,
};

use crate::XtaskError;

/// What to do with the goldens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Report differences.
    Compare,
    /// Rewrite the goldens of the cases that differ, and only those.
    Bless,
}

/// What became of one case.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// The golden agrees.
    Same,
    /// The golden does not agree.
    Different(Vec<Difference>),
    /// The golden did not agree and was rewritten; these were the differences.
    Blessed(Vec<Difference>),
    /// The case could not be computed.
    Failed(String),
}

/// A case, or a golden file without one, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseReport {
    /// The case as the filter names it, or the name of a file that belongs to none.
    pub case: String,
    /// What became of it.
    pub verdict: Verdict,
}

/// The whole sweep, case by case in a fixed order.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The cases.
    pub cases: Vec<CaseReport>,
}

/// Computes the cases that `filter` admits and compares them with the goldens in `folder`.
///
/// Cases run in parallel; the report does not depend on the number of threads.
///
/// # Errors
/// [`XtaskError`] if the folder cannot be read, or a golden not be written. What the computation or
/// the comparison has to say is in the [`Report`].
pub fn run<S, E>(
    folder: &Path,
    mode: Mode,
    filter: &Filter,
    source: S,
) -> Result<Report, XtaskError>
where
    S: Fn(SweepPoint) -> Result<SweepResult, E> + Sync,
    E: std::error::Error,
{
    let points: Vec<SweepPoint> =
        all_points().into_iter().filter(|point| filter.admits(point)).collect();
    let results: Vec<Result<Snapshot, String>> = points
        .par_iter()
        .map(|point| match source(*point) {
            Ok(result) => Ok(result.snapshot(*point)),
            Err(error) => Err(with_causes(&error)),
        })
        .collect();
    let mut cases = Vec::new();
    for (point, result) in points.iter().zip(results) {
        let verdict = match result {
            Err(message) => Verdict::Failed(message),
            Ok(now) => judge(&folder.join(point.file_name()), mode, point, &now)?,
        };
        cases.push(CaseReport { case: point.to_string(), verdict });
    }
    if filter.is_everything() {
        cases.extend(orphans(folder)?);
    }
    Ok(Report { cases })
}

/// An error with all its causes, on one line.
fn with_causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let part = error.to_string();
        if !text.contains(&part) {
            text = format!("{text}: {part}");
        }
        cause = error.source();
    }
    text
}

/// Compares one case with its golden, and rewrites that if asked to and needed.
fn judge(
    path: &Path,
    mode: Mode,
    point: &SweepPoint,
    now: &Snapshot,
) -> Result<Verdict, XtaskError> {
    let unfit = unfit_for_a_golden(now);
    if !unfit.is_empty() {
        return Ok(Verdict::Different(unfit));
    }
    let differences = if path.exists() {
        match Snapshot::from_ron(&crate::files::read(path)?) {
            Ok(golden) => compare(&golden, now),
            Err(error) => vec![Difference::Unreadable { message: error.to_string() }],
        }
    } else {
        vec![Difference::NoGolden]
    };
    if differences.is_empty() {
        return Ok(Verdict::Same);
    }
    if mode == Mode::Compare {
        return Ok(Verdict::Different(differences));
    }
    let text = now
        .to_ron()
        .map_err(|source| XtaskError::GoldenText { case: point.to_string(), source })?;
    crate::files::write_atomically(path, &text)?;
    Ok(Verdict::Blessed(differences))
}

/// Files in the folder of goldens that belong to no case.
fn orphans(folder: &Path) -> Result<Vec<CaseReport>, XtaskError> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let failed = |source| XtaskError::Read { path: folder.to_path_buf(), source };
    let known: Vec<String> = all_points().iter().map(SweepPoint::file_name).collect();
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        names.push(entry.map_err(failed)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names
        .into_iter()
        .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "ron"))
        .filter(|name| !known.contains(name))
        .map(|case| CaseReport { case, verdict: Verdict::Different(vec![Difference::Orphan]) })
        .collect())
}

impl Report {
    /// Exit code: 0 nothing to report, 1 a case could not be computed, 3 a golden does not agree.
    pub fn exit_code(&self) -> u8 {
        let any = |wanted: fn(&Verdict) -> bool| self.cases.iter().any(|c| wanted(&c.verdict));
        if any(|verdict| matches!(verdict, Verdict::Failed(_))) {
            1
        } else if any(|verdict| matches!(verdict, Verdict::Different(_))) {
            3
        } else {
            0
        }
    }

    /// Number of cases with a verdict.
    fn count(&self, wanted: fn(&Verdict) -> bool) -> usize {
        self.cases.iter().filter(|case| wanted(&case.verdict)).count()
    }

    /// The report as text: a table of all differences, failures, and a summary.
    pub fn text(&self) -> String {
        let mut table = comfy_table::Table::new();
        table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
        table.set_header(["case", "channel", "golden", "now", "change", "allowed"]);
        let mut failures = Vec::new();
        for case in &self.cases {
            match &case.verdict {
                Verdict::Same => {}
                Verdict::Different(differences) | Verdict::Blessed(differences) => {
                    for difference in differences {
                        let cells = [case.case.clone()].into_iter().chain(difference.cells());
                        table.add_row(cells.collect::<Vec<_>>());
                    }
                }
                Verdict::Failed(message) => {
                    failures.push(format!("{}: not computed: {message}\n", case.case));
                }
            }
        }
        let same = self.count(|verdict| matches!(verdict, Verdict::Same));
        let different = self.count(|verdict| matches!(verdict, Verdict::Different(_)));
        let blessed = self.count(|verdict| matches!(verdict, Verdict::Blessed(_)));
        let failed = self.count(|verdict| matches!(verdict, Verdict::Failed(_)));
        let shown = if different + blessed == 0 { String::new() } else { format!("{table}\n") };
        format!(
            "{shown}{}{same} of {} cases as the goldens have them, {different} different, {blessed} \
             blessed, {failed} not computed\n",
            failures.concat(),
            self.cases.len()
        )
    }
}
