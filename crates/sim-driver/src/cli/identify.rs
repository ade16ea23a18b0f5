//! `hhc identify`.

use super::args::{IdentifyArgs, InvertArgs, PredictArgs};
use super::{ColumnArgs, ForceArgs, refuse_inputs, warn, write_texts};
use crate::SimError;
use crate::actuator_use::{Work, used};
use crate::files::{DATASET, Folder, Source, read_dataset, refuse_inside, write_atomic};
use crate::output::{Format, Printable, counted, print};
use crate::problem::{Fault, Place, Problem};
use crate::progress::Progress;
use bench_study::any_data::{FoundModel, identified_data};
use bench_study::curves::CurvesResult;
use bench_study::figures::figure_files;
use bench_study::identification::{
    BenchIdentification, Comparing, IdentifyResult, MODELS_COMPARED,
};
use bench_study::page::{bench_page, curves_page};
use bench_study::samples_csv;
use bench_study::stored::{StoredActuator, actuator_warnings, read_actuator, write_actuator};
use measured_data::default_model_file;
use preisach_dyn::identify::{Family, Settings};
use report_page::MADE_HERE;
use std::path::{Path, PathBuf};

impl Printable for IdentifyResult {
    fn text(&self) -> String {
        Self::text(self)
    }

    fn details(&self) -> String {
        Self::details(self)
    }
}

impl Printable for CurvesResult {
    fn text(&self) -> String {
        Self::text(self)
    }
}

pub(super) fn identify(args: &IdentifyArgs) -> Result<(), SimError> {
    let base = match &args.start {
        Some(path) => read_actuator(&Source::read(path)?)?.settings,
        None => Settings::default(),
    };
    let output = &args.output.clone().unwrap_or_else(|| default_model_file(&args.bench));
    if output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
        let message = "is the name of a page, expected that of an actuator file, such as actuator.ron: the page is written beside it";
        let place = Place::file(output.display().to_string());
        return Err(Problem::new(place, Fault::Other(message.to_owned())).into());
    }
    refuse_inside(&args.bench, output)?;
    refuse_inputs(args.start.as_deref(), Some(output))?;
    let page_path = page_path(output);
    if let Some(path) = &page_path {
        refuse_inside(&args.bench, path)?;
    }
    args.force.actuator(output)?;
    args.force.holding(page_path.as_deref(), MADE_HERE, "page of hhc")?;
    let data = read_dataset(&Folder::Disk(args.bench.clone()))?;
    warn(data.warnings(), args.format.form());
    let (glances, subject) = bench_study::glances(&data);
    warn(&bench_study::compared(&glances, subject), args.format.form());
    let families = &families(args)?;
    // beside the families there are the orders of the one chosen
    let progress = Progress::new(MODELS_COMPARED + families.len() - Family::ALL.len());
    progress.begin(0, &format!("identifying from {}", counted(data.run_count(), "run")));
    let [written, page_written_to] =
        [Some(output), page_path.as_ref()].map(|path| path.map(|path| path.display().to_string()));
    let found =
        identified_data(&data, &base, Some(Comparing { families, done: &|| progress.step() }));
    progress.finish();
    let found = match found? {
        FoundModel::Curves(found) => {
            let figures = args.figures.as_ref().map(|_| found.figure_files()).transpose()?;
            let result = CurvesResult { page_written_to, ..found.summary(written) };
            Identified {
                stored: found.stored(),
                page: curves_page(&found, &result),
                text: result.render(args.format.form())?,
                figures,
            }
        }
        FoundModel::Records(mut found) => {
            found.pick(args.model)?;
            record_files(&found, [written, page_written_to], args)?
        }
    };
    let place = |_: &str| Place::file(format!("{}/{DATASET}", args.bench.display()));
    warn(&actuator_warnings(&found.stored, place), args.format.form());
    if let (Some(folder), Some(figures)) = (&args.figures, &found.figures) {
        args.force.tables(folder, figures, &[&args.bench])?;
    }
    write_actuator(&found.stored, output)?;
    if let Some(path) = &page_path {
        write_atomic(path, found.page.as_bytes())?;
    }
    if let (Some(folder), Some(figures)) = (&args.figures, found.figures) {
        write_texts(folder, figures)?;
    }
    print(&found.text)
}

/// The families to fit, the simplest first: all of them unless some are named.
///
/// # Errors
/// A model to judge that is not among them.
fn families(args: &IdentifyArgs) -> Result<Vec<Family>, Problem> {
    let is_named = |family: &Family| args.only.is_empty() || args.only.contains(&Some(*family));
    let families: Vec<Family> = Family::ALL.into_iter().filter(is_named).collect();
    if let Some(model) = args.model.filter(|model| !families.contains(model)) {
        let message = format!(
            "leaves out the model to judge, {}: name it here too, or leave --model out",
            model.name()
        );
        return Err(Problem::new(Place::file("--only"), Fault::Refused { message }));
    }
    Ok(families)
}

/// The page beside a model file; none beside a pipe or a device.
fn page_path(model: &Path) -> Option<PathBuf> {
    let is_other = model.exists() && !model.is_file();
    (!is_other).then(|| model.with_extension("html"))
}

pub(super) fn predict(args: &PredictArgs) -> Result<(), SimError> {
    put_to_work(
        (args.output.as_ref(), args.force),
        ([&args.actuator, &args.input], &args.columns),
        args.format,
        StoredActuator::predicted,
    )
}

pub(super) fn invert(args: &InvertArgs) -> Result<(), SimError> {
    put_to_work(
        (args.output.as_ref(), args.force),
        ([&args.actuator, &args.wanted], &args.columns),
        args.format,
        StoredActuator::inverted,
    )
}

/// Uses an actuator on a record; writes and prints what it did.
fn put_to_work(
    (output, force): (Option<&PathBuf>, ForceArgs),
    ([actuator, record], columns): ([&PathBuf; 2], &ColumnArgs),
    format: Format,
    of: Work,
) -> Result<(), SimError> {
    refuse_inputs(Some(actuator), output)?;
    refuse_inputs(Some(record), output)?;
    let said = (&columns.options(), columns.sampling_hz);
    let (own, warnings) = used([actuator, record], said, of)?;
    warn(&warnings, Format::Details);
    if let Some(path) = output {
        let samples = samples_csv(&own);
        if own.error.is_some() {
            force.table(Some(path), &samples)?;
        } else {
            // a record has this header too: only the same table is known
            force.holding(Some(path), &samples, "table of hhc")?;
        }
        write_atomic(path, samples.as_bytes())?;
    }
    print(&own.render(format)?)
}

/// What an identification writes and prints.
struct Identified {
    stored: StoredActuator,
    page: String,
    text: String,
    figures: Option<Vec<(String, String)>>,
}

fn record_files(
    found: &BenchIdentification,
    [written, page_written_to]: [Option<String>; 2],
    args: &IdentifyArgs,
) -> Result<Identified, SimError> {
    let figures = args.figures.as_ref().map(|_| figure_files(found)).transpose()?;
    let result = IdentifyResult { page_written_to, ..found.summary(written) };
    let page = bench_page(found, &result)?;
    Ok(Identified {
        stored: found.stored(),
        page,
        text: result.render(args.format.form())?,
        figures,
    })
}
