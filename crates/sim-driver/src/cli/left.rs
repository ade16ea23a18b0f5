//! What is computed of a case beside it, and what its run leaves behind.

use super::say;
use crate::SimError;
use crate::case::LoadedCase;
use crate::files::{remove_own, write_atomic};
use crate::progress::Progress;
use crate::report::{StudyReport, histories_csv, measured_csv, report_html, sensitivity_csv};
use crate::results::{Figures, RESULT_FILE, RunResult, StoredResult};
use crate::run::{RunOutcome, steps_of, stored_of};
use rotor_study::{Assumptions, robustness_flights, robustness_maps, sensitivities};
use std::path::Path;
use study_text::known::RUN_FILES;
use study_text::{
    airloads_csv, blade_loads_csv, costs_csv, fronts_csv, robustness_csv, tip_csv, vortices_csv,
};
use trim::WakeTrim;

/// What is computed beside the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scope {
    /// One assumption changed at a time.
    pub(super) sensitivity: Option<Assumptions>,
    /// Flights under noise, a wrong T and drift.
    pub(super) robustness: bool,
}

impl Scope {
    /// Steps of the progress of a case with all of it.
    pub(super) fn steps(self, loaded: &LoadedCase) -> usize {
        let flights = if self.robustness { robustness_flights(&loaded.case) } else { 0 };
        steps_of(loaded) + self.sensitivity.map_or(0, |which| which.rows(&loaded.case)) + flights
    }

    /// What is computed, in words.
    pub(super) fn names(self) -> Vec<String> {
        let names = [(self.sensitivity.is_some(), "sensitivity"), (self.robustness, "robustness")];
        names.iter().filter(|(is_asked, _)| *is_asked).map(|(_, name)| (*name).to_owned()).collect()
    }

    /// Whether a result has what is computed, and no more.
    pub(super) fn is_of(self, result: &RunResult) -> bool {
        self.sensitivity.is_none() == result.sensitivity.is_empty()
            && self.robustness != result.robustness.is_empty()
    }

    /// The outcome with what is computed beside the case.
    pub(super) fn added(
        self,
        loaded: &LoadedCase,
        mut outcome: RunOutcome,
        progress: &Progress,
    ) -> Result<RunOutcome, SimError> {
        if let Some(which) = self.sensitivity {
            progress.doing("sensitivity");
            let done = || progress.step();
            let RunOutcome { trimmed, drives, .. } = &outcome;
            outcome.result.sensitivity = sensitivities(&loaded.case, trimmed, drives, which, &done)
                .map_err(|error| loaded.located(error))?;
        }
        if self.robustness {
            progress.doing("robustness");
            let done = || progress.step();
            let RunOutcome { trimmed, drives, .. } = &outcome;
            (outcome.result.robustness, outcome.result.margins) =
                robustness_maps(&loaded.case, trimmed, drives, &done)
                    .map_err(|error| loaded.located(error))?;
        }
        Ok(outcome)
    }
}

/// Files that every run leaves beside its result.
pub(super) const ALWAYS: [&str; 5] =
    ["blade_loads.csv", "airloads.csv", "tip.csv", "histories.csv", "report.html"];

/// Writes everything a run leaves behind; what an earlier run has left and this one has not goes.
pub(super) fn store(
    loaded: &LoadedCase,
    outcome: &RunOutcome,
    figures: &Figures,
    out: &Path,
) -> Result<StoredResult, SimError> {
    let stored = stored_of(loaded, outcome)?;
    stored.write(&out.join(RESULT_FILE))?;
    let blade_loads = blade_loads_csv(&outcome.blade_loads, &loaded.case.scales());
    write_atomic(&out.join("blade_loads.csv"), blade_loads.as_bytes())?;
    let airloads = airloads_csv(&outcome.airloads);
    write_atomic(&out.join("airloads.csv"), airloads.as_bytes())?;
    write_atomic(&out.join("tip.csv"), tip_csv(&outcome.tip).as_bytes())?;
    let vortices = outcome.trimmed.wake().map(|WakeTrim { wake, .. }| {
        let (planes, radius_m) = (loaded.case.vortex_planes_y_r(), loaded.case.rotor.radius_m);
        vortices_csv(wake, &planes, radius_m)
    });
    write_or_remove(&out.join("vortices.csv"), vortices)?;
    write_shown(&StudyReport { stored: &stored, figures }, out)?;
    Ok(stored)
}

/// Writes what follows from a stored result: tables, picture and report.
pub(super) fn write_shown(report: &StudyReport<'_>, out: &Path) -> Result<(), SimError> {
    let StudyReport { stored, figures } = *report;
    let (result, case) = (&stored.result, &stored.case);
    let finding = report.finding();
    let swept = |table: &[_]| sensitivity_csv(&case.control.harmonics, table);
    let flown = |cells: &[_]| robustness_csv(cells, &result.margins);
    let has_front = figures.fronts.iter().any(|line| !line.points.is_empty());
    let files = [
        ("histories.csv", Some(histories_csv(&result.control))),
        ("sensitivity.csv", filled(&figures.sensitivity).map(swept)),
        ("robustness.csv", filled(&result.robustness).map(flown)),
        ("costs.csv", filled(&figures.costs).map(costs_csv)),
        ("fronts.csv", has_front.then(|| fronts_csv(&figures.fronts))),
        ("measured.csv", result.measured.is_some().then(|| measured_csv(figures))),
        ("figure.svg", finding.is_drawn().then(|| finding.svg(&case.title))),
        ("report.html", Some(report_html(report))),
    ];
    files.into_iter().try_for_each(|(name, text)| write_or_remove(&out.join(name), text))
}

/// A table, unless it has no row.
fn filled<T>(rows: &[T]) -> Option<&[T]> {
    (!rows.is_empty()).then_some(rows)
}

/// Writes a file; without a text, one that an earlier run has left goes.
fn write_or_remove(path: &Path, text: Option<String>) -> Result<(), SimError> {
    if let Some(text) = text {
        return Ok(write_atomic(path, text.as_bytes())?);
    }
    let known = RUN_FILES.iter().find(|(name, _)| path.ends_with(name));
    remove_own(path, |text| known.is_some_and(|(_, held)| text.contains(held)))?;
    Ok(())
}

/// Says of a run that failed that the results in its folder are not its own.
pub(super) fn note_earlier(out: &Path) {
    if out.join(RESULT_FILE).is_file() {
        say(&format_args!("note: the results in {} are of an earlier run", out.display()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::{RobustnessCell, Sensitivity};

    /// A result with more than was asked for, or with less, is computed again; its key says what was asked for.
    #[test]
    fn a_result_is_of_the_scope_that_it_has() {
        let scopes = [(false, false), (true, false), (false, true), (true, true)]
            .map(|(s, r)| Scope { sensitivity: s.then_some(Assumptions::WithWake), robustness: r });
        let results = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(s, r): (usize, usize)| RunResult {
            sensitivity: vec![Sensitivity::default(); s],
            robustness: vec![RobustnessCell::default(); r],
            ..RunResult::default()
        });
        for (i, scope) in scopes.into_iter().enumerate() {
            for (j, result) in results.iter().enumerate() {
                assert_eq!(scope.is_of(result), i == j, "{scope:?} {j}");
            }
        }
        assert_eq!(
            scopes.map(|scope| scope.names().join(" ")),
            ["", "sensitivity", "robustness", "sensitivity robustness"]
        );
    }
}
