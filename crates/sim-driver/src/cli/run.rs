//! Bare `hhc`, `hhc run` and `hhc report`: a case run, stored and shown.

use super::args::{RunArgs, StudyArgs};
use super::{check_advance_ratio, folder_or, overridden, warn};
use crate::SimError;
use crate::actuator::case_actuators;
use crate::case::{LoadedCase, PAPER_CASE, load_case, shipped_case};
use crate::files::{refuse_unwritable, write_atomic};
use crate::output::{Format, Printable, json, print};
use crate::problem::{Fault, Place, Problems};
use crate::progress::Progress;
use crate::report::{
    StudyReport, histories_csv, measured_csv, report_html, robustness_csv, sensitivity_csv,
};
use crate::results::{Figures, RESULT_FILE, StoredResult, figures};
use crate::run::{RunOutcome, run_case, run_trimmed, steps_of, stored_of};
use crate::sweep::{
    SweepResult, SweepRow, at_advance_ratio, continued_trim, refuse_diverged, sweep_csv,
};
use crate::terminal::{details, summary};
use rotor_study::{Assumptions, robustness_flights, robustness_maps, sensitivities};
use std::path::Path;
use study_text::{airloads_csv, blade_loads_csv, costs_csv, fronts_csv, tip_csv, vortices_csv};
use trim::{TrimSolution, WakeTrim};

pub(super) fn study(args: &StudyArgs) -> Result<(), SimError> {
    let loaded = overridden(shipped_case(PAPER_CASE)?, Some(args.inflow));
    let scope = Scope { sensitivity: Some(Assumptions::WithoutWake), robustness: false };
    run_and_store(&loaded, &args.out, args.format.form(), scope)
}

pub(super) fn run(args: &RunArgs) -> Result<(), SimError> {
    let loaded = overridden(load_case(&args.case)?, args.inflow);
    let out = folder_or(args.out.as_ref(), &args.case);
    let sensitivity = args.sensitivity.then_some(Assumptions::WithWake);
    let scope = Scope { sensitivity, robustness: args.robustness };
    let format = args.format.form();
    if args.mu.is_empty() {
        return run_and_store(&loaded, &out, format, scope);
    }
    Sweep { loaded: &loaded, out: &out, scope, format }.run(&args.mu)
}

pub(super) fn report(dir: &Path, format: Format) -> Result<(), SimError> {
    let stored = StoredResult::read(dir)?;
    let figures = figures(&stored.result, &stored.setting()?);
    let report = StudyReport { stored: &stored, figures: &figures };
    write_shown(&report, dir)?;
    show(&report, dir, format)
}

/// What is computed beside the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Scope {
    sensitivity: Option<Assumptions>,
    robustness: bool,
}

impl Scope {
    /// Steps of the progress of a case with all of it.
    fn steps(self, loaded: &LoadedCase) -> usize {
        let flights = if self.robustness { robustness_flights(&loaded.case) } else { 0 };
        steps_of(loaded) + self.sensitivity.map_or(0, |which| which.rows(&loaded.case)) + flights
    }

    /// The outcome with what is computed beside the case.
    fn added(
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

fn run_and_store(
    loaded: &LoadedCase,
    out: &Path,
    format: Format,
    scope: Scope,
) -> Result<(), SimError> {
    refuse_unwritable(out)?;
    let progress = Progress::new(scope.steps(loaded));
    let computed =
        run_case(loaded, &progress).and_then(|outcome| scope.added(loaded, outcome, &progress));
    progress.finish();
    let outcome = computed.inspect_err(|_| note_earlier(out))?;
    let figures = outcome.figures();
    let stored = store(loaded, &outcome, &figures, out)?;
    warn(&figures.warnings, format);
    show(&StudyReport { stored: &stored, figures: &figures }, out, format)?;
    refuse_diverged(loaded, outcome.trimmed.wake_diverged())
}

/// Writes everything a run leaves behind.
fn store(
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
    if let Some(WakeTrim { wake, .. }) = outcome.trimmed.wake() {
        let (planes, radius_m) = (loaded.case.vortex_planes_y_r(), loaded.case.rotor.radius_m);
        let vortices = vortices_csv(wake, &planes, radius_m);
        write_atomic(&out.join("vortices.csv"), vortices.as_bytes())?;
    }
    write_shown(&StudyReport { stored: &stored, figures }, out)?;
    Ok(stored)
}

/// Writes what follows from a stored result: tables, picture and report.
fn write_shown(report: &StudyReport<'_>, out: &Path) -> Result<(), SimError> {
    let StudyReport { stored, figures } = *report;
    let write = |name: &str, text: &str| write_atomic(&out.join(name), text.as_bytes());
    write("histories.csv", &histories_csv(&stored.result.control))?;
    if !figures.sensitivity.is_empty() {
        let harmonics = &stored.case.control.harmonics;
        write("sensitivity.csv", &sensitivity_csv(harmonics, &figures.sensitivity))?;
    }
    if !stored.result.robustness.is_empty() {
        write("robustness.csv", &robustness_csv(&stored.result.robustness))?;
    }
    if !figures.costs.is_empty() {
        write("costs.csv", &costs_csv(&figures.costs))?;
    }
    if figures.fronts.iter().any(|line| !line.points.is_empty()) {
        write("fronts.csv", &fronts_csv(&figures.fronts))?;
    }
    if stored.result.measured.is_some() {
        write("measured.csv", &measured_csv(figures))?;
    }
    let finding = report.finding();
    if finding.is_drawn() {
        write("figure.svg", &finding.svg(&stored.case.title))?;
    }
    Ok(write("report.html", &report_html(report))?)
}

/// Shows a stored result.
fn show(report: &StudyReport<'_>, folder: &Path, format: Format) -> Result<(), SimError> {
    print(&match format {
        // what was measured is asked for: it stands below the screen
        Format::Text => {
            let measured = report.measured().into_iter().map(|section| section.to_string());
            summary(report, folder) + &measured.collect::<String>()
        }
        Format::Details => format!(
            "{}{}\nResults, histories and report in {}\n",
            details(report.figures),
            report.text(),
            folder.display()
        ),
        Format::Json => json(report.figures)?,
    })
}

/// Name of the folder of the results at an advance ratio.
fn sweep_folder(advance_ratio: f64) -> String {
    format!("mu_{advance_ratio}")
}

/// A case at several advance ratios.
struct Sweep<'a> {
    loaded: &'a LoadedCase,
    out: &'a Path,
    scope: Scope,
    format: Format,
}

impl Sweep<'_> {
    fn run(&self, advance_ratios: &[f64]) -> Result<(), SimError> {
        let mut problems = Problems::default();
        for (i, &mu) in advance_ratios.iter().enumerate() {
            check_advance_ratio(&mut problems, mu);
            if advance_ratios[..i].iter().any(|before| sweep_folder(*before) == sweep_folder(mu)) {
                let message = format!("{mu} is given twice; give every advance ratio once");
                problems.push(Place::file("--mu"), Fault::Refused { message });
            }
        }
        problems.into_result(Some(()))?;
        refuse_unwritable(self.out)?;
        let mut rows = Vec::new();
        let ended = self.fill(&mut rows, advance_ratios);
        // what was found before an advance ratio that fails is of use
        if !rows.is_empty() {
            let sweep = SweepResult { rows };
            write_atomic(&self.out.join("sweep.csv"), sweep_csv(&sweep).as_bytes())?;
            print(&sweep.render(self.format)?)?;
            if self.format != Format::Json {
                let folder = self.out.display();
                print(&format!("\nResults in {folder}, a folder for each advance ratio\n"))?;
            }
        }
        ended
    }

    /// Runs the advance ratios, each from the one before, up to the first that fails.
    fn fill(&self, rows: &mut Vec<SweepRow>, advance_ratios: &[f64]) -> Result<(), SimError> {
        let actuators = case_actuators(self.loaded)?;
        let mut start: Option<TrimSolution> = None;
        // a wake that diverged does not keep the others from being found
        let mut ended = Ok(());
        for &mu in advance_ratios {
            let here = at_advance_ratio(self.loaded, mu);
            let folder = self.out.join(sweep_folder(mu));
            let progress = Progress::new(self.scope.steps(&here));
            progress.doing(format!("advance ratio {mu}"));
            let computed = continued_trim(&here, start.as_ref()).and_then(|trimmed| {
                run_trimmed(&here, actuators.clone(), trimmed, &progress)
                    .and_then(|outcome| self.scope.added(&here, outcome, &progress))
            });
            progress.finish();
            let computed = computed.inspect_err(|_| note_earlier(&folder));
            let stopped = |found, source| SimError::SweepEnded {
                advance_ratio: mu,
                found,
                source: Box::new(source),
            };
            let found = rows.iter().map(|row| row.advance_ratio).collect();
            let outcome = computed.map_err(|source| stopped(found, source))?;
            start = Some(outcome.trimmed.trim().clone());
            let figures = outcome.figures();
            store(&here, &outcome, &figures, &folder)?;
            warn(&figures.warnings, self.format);
            if outcome.trimmed.wake_diverged() && ended.is_ok() {
                ended = refuse_diverged(&here, true).map_err(|source| stopped(vec![], source));
            }
            rows.push(SweepRow { advance_ratio: mu, result: figures });
        }
        ended
    }
}

/// Says of a run that failed that the results in its folder are not its own.
fn note_earlier(out: &Path) {
    if out.join(RESULT_FILE).is_file() {
        eprintln!("note: the results in {} are of an earlier run", out.display());
    }
}
