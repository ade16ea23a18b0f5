//! Bare `hhc`, `hhc run` and `hhc report`: a case run, stored and shown.

use super::args::{RunArgs, StudyArgs};
use super::left::{Scope, note_earlier, store, write_shown};
use super::speeds::{folder_at, run_speeds};
use super::sweep::{PageArgs, is_merged, report_merged};
use super::{ForceArgs, folder_or, overridden, warn};
use crate::SimError;
use crate::case::{LoadedCase, PAPER_CASE, load_case, shipped_case};
use crate::files::refuse_unwritable;
use crate::output::{Format, json, print};
use crate::problem::{Fault, Place, Problem};
use crate::progress::Progress;
use crate::report::StudyReport;
use crate::results::{StoredResult, figures};
use crate::run::run_case;
use crate::sweep::refuse_diverged;
use crate::terminal::{details, summary};
use rotor_study::Assumptions;
use std::path::Path;
use study_text::known::{MERGED_FILES, RUN_FILES, SWEEP_PAGE};

pub(super) fn study(args: &StudyArgs) -> Result<(), SimError> {
    let loaded = overridden(shipped_case(PAPER_CASE)?, Some(args.inflow));
    let scope = Scope { sensitivity: Some(Assumptions::WithoutWake), robustness: false };
    args.force.files(&args.out, RUN_FILES)?;
    run_and_store(&loaded, &args.out, args.format.form(), scope)
}

pub(super) fn run(args: &RunArgs) -> Result<(), SimError> {
    let loaded = overridden(load_case(&args.case)?, args.inflow);
    let out = folder_or(args.out.as_ref(), &args.case);
    let sensitivity = args.sensitivity.then_some(Assumptions::WithWake);
    let scope = Scope { sensitivity, robustness: args.robustness };
    let format = args.format.form();
    if args.mu.is_empty() {
        args.force.files(&out, RUN_FILES)?;
        return run_and_store(&loaded, &out, format, scope);
    }
    args.force.files(&out, MERGED_FILES)?;
    for &mu in &args.mu {
        args.force.files(&folder_at(&out, mu), RUN_FILES)?;
    }
    run_speeds(&loaded, &out, (scope, format), &args.mu)
}

pub(super) fn report(
    dir: &Path,
    (page, force): (&PageArgs, ForceArgs),
    format: Format,
) -> Result<(), SimError> {
    if is_merged(dir) {
        force.files(dir, SWEEP_PAGE)?;
        return report_merged(dir, page);
    }
    if page.is_given() {
        let message = format!(
            "{} has no sweep.json of a sweep, whose page they choose; leave them out, or merge the sweep before",
            dir.display()
        );
        return Err(
            Problem::new(Place::file("--x, --y, --of, --at"), Fault::Refused { message }).into()
        );
    }
    let stored = StoredResult::read(dir)?;
    let figures = figures(&stored.result, &stored.setting()?);
    let report = StudyReport { stored: &stored, figures: &figures };
    // result.json, the first, is read and not written
    force.files(dir, &RUN_FILES[1..])?;
    write_shown(&report, dir)?;
    show(&report, dir, format)
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
