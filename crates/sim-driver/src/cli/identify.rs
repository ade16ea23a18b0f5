//! `hhc identify`.

use super::args::{ExportArgs, IdentifyArgs, InvertArgs, PredictArgs};
use super::{refuse_inputs, warn, write_texts};
use crate::SimError;
use crate::actuator_use::{samples_csv, used};
use crate::files::{
    DATASET, DataSet, Folder, Source, read_dataset, refuse_inside, refuse_other_kind, write_atomic,
    write_folder,
};
use crate::output::{Format, Printable, print};
use crate::problem::{Fault, Place, Problem};
use crate::progress::Progress;
use actuator_gap::{ActuatorUse, UseError};
use bench_study::BenchError;
use bench_study::curves::{CurvesResult, identify_curves};
use bench_study::figures::figure_files;
use bench_study::identification::{
    BenchIdentification, IdentifyResult, MODELS_COMPARED, identify_bench, identify_loops,
};
use bench_study::stored::{StoredActuator, actuator_warnings, read_actuator, write_actuator};
use measured_data::EvenRecord;
use preisach_dyn::identify::Settings;
use std::path::PathBuf;

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
    refuse_inside(&args.bench, &args.output)?;
    refuse_inputs(args.start.as_deref(), Some(&args.output))?;
    if !args.force {
        refuse_other_kind(&args.output, "Actuator")?;
    }
    let data = read_dataset(&Folder::Disk(args.bench.clone()))?;
    warn(data.warnings(), args.format.form());
    let progress = Progress::new(MODELS_COMPARED);
    progress.begin(0, &format!("identifying from {} runs", data.run_count()));
    let written = Some(args.output.display().to_string());
    let (stored, text, figures) = match &data {
        DataSet::Curves(curves) => {
            let found = identify_curves(curves);
            progress.finish();
            let found = found?;
            let figures = args.figures.as_ref().map(|_| found.figure_files()).transpose()?;
            (found.stored(), found.summary(written).render(args.format.form())?, figures)
        }
        DataSet::Sweep(sweep) => {
            let place = Place::file(format!("{}/dataset.ron", sweep.folder)).field("kind");
            let message =
                "points of a rotor identify no actuator: hhc diagnose CASE.ron --data DIR -o OUT"
                    .to_owned();
            return Err(Problem::new(place, Fault::Refused { message }).into());
        }
        DataSet::Bench(bench) => {
            let found = identify_bench(bench, &base, Some(&|| progress.step()));
            record_files(&picked(found, args, &progress)?, written, args)?
        }
        DataSet::Loops(loops) => {
            let found = identify_loops(loops, &base, Some(&|| progress.step()));
            record_files(&picked(found, args, &progress)?, written, args)?
        }
    };
    let place = |_: &str| Place::file(format!("{}/{DATASET}", args.bench.display()));
    warn(&actuator_warnings(&stored, place), args.format.form());
    write_actuator(&stored, &args.output)?;
    if let (Some(folder), Some(figures)) = (&args.figures, figures) {
        write_texts(folder, figures)?;
    }
    print(&text)
}

pub(super) fn predict(args: &PredictArgs) -> Result<(), SimError> {
    put_to_work(
        args.output.as_ref(),
        [&args.actuator, &args.input],
        args.format,
        StoredActuator::predicted,
    )
}

pub(super) fn invert(args: &InvertArgs) -> Result<(), SimError> {
    put_to_work(
        args.output.as_ref(),
        [&args.actuator, &args.wanted],
        args.format,
        StoredActuator::inverted,
    )
}

pub(super) fn export(args: &ExportArgs) -> Result<(), SimError> {
    let own = read_actuator(&Source::read(&args.actuator)?)?;
    let files = actuator_export::export(&own.model, &args.name, 1.0 / args.sampling_hz, args.to);
    let files = files.map_err(|error| {
        let place = Place::file(args.actuator.display().to_string());
        Problem::new(place, Fault::Refused { message: error.to_string() })
    })?;
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let text = format!("{} written to {}\n", names.join(", "), args.output.display());
    warn(&actuator_export::remarks(&own.model), Format::Details);
    let files: Vec<(String, Vec<u8>)> =
        files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
    write_folder(&args.output, &files)?;
    print(&text)
}

/// Uses an actuator on a record; writes and prints what it did.
fn put_to_work(
    output: Option<&PathBuf>,
    [actuator, record]: [&PathBuf; 2],
    format: Format,
    of: fn(&StoredActuator, &EvenRecord) -> Result<ActuatorUse, UseError>,
) -> Result<(), SimError> {
    refuse_inputs(Some(actuator), output)?;
    refuse_inputs(Some(record), output)?;
    let own = used([actuator, record], of)?;
    if let Some(path) = output {
        write_atomic(path, samples_csv(&own).as_bytes())?;
    }
    print(&own.render(format)?)
}

/// Model file, printed text and tables of the figures.
type IdentifiedFiles = (StoredActuator, String, Option<Vec<(String, String)>>);

fn record_files(
    found: &BenchIdentification,
    written: Option<String>,
    args: &IdentifyArgs,
) -> Result<IdentifiedFiles, SimError> {
    let figures = args.figures.as_ref().map(|_| figure_files(found)).transpose()?;
    Ok((found.stored(), found.summary(written).render(args.format.form())?, figures))
}

/// The identification with the model that is wanted in place.
fn picked(
    found: Result<BenchIdentification, BenchError>,
    args: &IdentifyArgs,
    progress: &Progress,
) -> Result<BenchIdentification, SimError> {
    progress.finish();
    let mut found = found?;
    found.pick(args.model)?;
    Ok(found)
}
