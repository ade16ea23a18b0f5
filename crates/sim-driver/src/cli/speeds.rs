//! `hhc run --mu`: a case over advance ratios. It is a sweep of one axis, with the whole result of every case in a folder of its own.

use super::case_runner::{CaseRunner, found_of, no_numbers};
use super::left::{ALWAYS, Scope, note_earlier, store};
use super::sweep::{merged_files, run_shown};
use super::{check_advance_ratio, warn, write_texts};
use crate::SimError;
use crate::actuator::{CaseActuators, actuators_with};
use crate::case::LoadedCase;
use crate::files::refuse_unwritable;
use crate::output::{Format, Printable, print};
use crate::problem::{Fault, Place, Problems};
use crate::progress::Progress;
use crate::results::{Figures, StoredResult, figures};
use crate::run::run_trimmed;
use crate::sweep::{SweepResult, SweepRow, at_advance_ratio, continued_trim, refuse_diverged};
use case_sweep::{
    Axis, AxisValues, Failed, Found, NoNumbers, Outcome, ReadCase, Runner, Sampling, Shard, State,
    Store, SweepFile, merge, plan,
};
use rotor_study::WakeStatus;
use std::path::{Path, PathBuf};

/// What the values of the axis are called in messages.
const OPTION: &str = "--mu";

/// Folder of the result at an advance ratio.
pub(super) fn folder_at(out: &Path, advance_ratio: f64) -> PathBuf {
    out.join(format!("mu_{advance_ratio}"))
}

/// Runs a case at advance ratios, those that have no whole result yet. A failure at one of them is told at the end and keeps none of the
/// others from being found.
pub(super) fn run_speeds(
    loaded: &LoadedCase,
    out: &Path,
    (scope, format): (Scope, Format),
    advance_ratios: &[f64],
) -> Result<(), SimError> {
    let axis = axis_of(advance_ratios)?;
    refuse_unwritable(out)?;
    let name = OPTION.to_owned();
    let base_place = Place::file(OPTION);
    let file = SweepFile {
        name,
        base: String::new(),
        base_place,
        axes: vec![axis],
        sampling: Sampling::Grid,
    };
    let runner = SpeedRunner { loaded, out, scope, cases: CaseRunner::new(loaded.folder.clone()) };
    let planned = plan(&file, CaseRunner::canonical(&loaded.case)?, &runner)?;
    let kept = Store::new(out);
    let cases = || advance_ratios.iter().copied().zip(&planned.cases);
    for (mu, case) in cases() {
        // a result without its folder is none
        if kept.get(&case.key).0 == State::Found && runner.whole(mu).is_none() {
            kept.forget(&case.key)?;
        }
    }
    let ran = run_shown(&planned, (Shard::WHOLE, Failed::Left), &kept, &runner)?;
    let (mut rows, mut failed) = (Vec::new(), Vec::new());
    for (mu, case) in cases() {
        if let Some(result) = runner.whole(mu) {
            warn(&result.warnings, format);
            let diverged = result.wake == Some(WakeStatus::Diverged);
            let ended = refuse_diverged(&at_advance_ratio(loaded, mu), diverged);
            failed.extend(ended.err().map(|error| (mu, error.to_string())));
            rows.push(SweepRow { advance_ratio: mu, result });
        } else if let Some(Outcome::Failed { reason }) = kept.get(&case.key).1.map(|c| c.outcome) {
            note_earlier(&folder_at(out, mu));
            failed.push((mu, reason));
        }
    }
    write_texts(out, merged_files(&merge(&planned, &kept, true)?)?)?;
    let found = rows.iter().map(|row| row.advance_ratio).collect();
    if !rows.is_empty() {
        print(&SweepResult { rows }.render(format)?)?;
        if format != Format::Json {
            let there = if ran.skipped > 0 {
                format!("; {} of {} were there", ran.skipped, ran.cases)
            } else {
                String::new()
            };
            let folder = out.display();
            print(&format!("\nResults in {folder}, a folder for each advance ratio{there}\n"))?;
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(SimError::SpeedsFailed { failed, found }) }
}

/// The axis of the advance ratios, each of them in range and given once.
fn axis_of(advance_ratios: &[f64]) -> Result<Axis, Problems> {
    let place = Place::file(OPTION);
    let mut problems = Problems::default();
    let mut values: Vec<(String, Place)> = Vec::new();
    for &mu in advance_ratios {
        check_advance_ratio(&mut problems, mu);
        let value = (mu.to_string(), place.clone());
        if values.contains(&value) {
            let message = format!("{mu} is given twice; give every advance ratio once");
            problems.push(place.clone(), Fault::Refused { message });
        }
        values.push(value);
    }
    let values = AxisValues::List(values);
    problems.into_result(Some(Axis { field: "advance_ratio".to_owned(), values, place }))
}

/// Runs a case at an advance ratio and writes its folder.
struct SpeedRunner<'a> {
    /// The case, with its places and what was measured.
    loaded: &'a LoadedCase,
    out: &'a Path,
    scope: Scope,
    cases: CaseRunner,
}

impl Runner for SpeedRunner<'_> {
    type Case = LoadedCase;

    fn version(&self) -> &str {
        self.cases.version()
    }

    fn folder(&self) -> String {
        self.cases.folder()
    }

    fn read(&self, text: &str) -> Result<ReadCase<LoadedCase>, Problems> {
        let read = self.cases.read(text)?;
        let case = at_advance_ratio(self.loaded, read.case.case.advance_ratio);
        let mut inputs = self.cases.inputs(&case)?;
        // what is computed beside the case is part of the result
        inputs.extend(self.scope.names());
        Ok(ReadCase { canonical: CaseRunner::canonical(&case.case)?, inputs, case })
    }

    fn unit(&self, case: &LoadedCase, field: &str) -> Option<String> {
        self.cases.unit(case, field)
    }

    fn run(&self, case: LoadedCase) -> Result<Found, NoNumbers> {
        self.found(&case).map_err(no_numbers)
    }
}

impl SpeedRunner<'_> {
    fn found(&self, here: &LoadedCase) -> Result<Found, SimError> {
        let bench = self.cases.bench(here)?;
        let actuators = actuators_with(here, bench.as_deref())?;
        let actuators = CaseActuators { bench: bench.as_deref().cloned(), ..actuators };
        let hidden = Progress::hidden();
        let trimmed = continued_trim(here, None)?;
        let outcome = run_trimmed(here, actuators, trimmed, &hidden)?;
        let outcome = self.scope.added(here, outcome, &hidden)?;
        let figures = outcome.figures();
        store(here, &outcome, &figures, &folder_at(self.out, here.case.advance_ratio))?;
        // looked at in its folder, but no result of a sweep
        refuse_diverged(here, outcome.trimmed.wake_diverged())?;
        Ok(found_of(figures, here))
    }

    /// The figures of the result in the folder of an advance ratio, if it is whole, and of this case and scope.
    fn whole(&self, advance_ratio: f64) -> Option<Figures> {
        let here = at_advance_ratio(self.loaded, advance_ratio);
        let folder = folder_at(self.out, advance_ratio);
        let stored = StoredResult::read(&folder).ok()?;
        let is_there = ALWAYS.iter().all(|name| folder.join(name).is_file());
        let is_own = stored.is_of(&here.case, &self.cases.inputs(&here).ok()?);
        if !(is_there && is_own && self.scope.is_of(&stored.result)) {
            return None;
        }
        Some(figures(&stored.result, &stored.setting().ok()?))
    }
}
