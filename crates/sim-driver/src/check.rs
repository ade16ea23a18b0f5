//! `hhc check`: what kind of file it is, and every problem in it.

use crate::SimError;
use crate::actuator::{stored_actuator, with_flap_actuators};
use crate::case::{ActuatorSource, LoadedCase, read_case};
use crate::files::{
    BenchData, Channel, Channels, DATASET, DataSet, Folder, RonIndex, Source, missing_file,
    read_bench, read_dataset,
};
use crate::output::{Printable, counted};
use crate::problem::{Fault, Place, Problem, Problems};
use bench_study::identification::gain;
use bench_study::stored::{GainRule, actuator_warnings, read_actuator};
use measured_data::DatasetKind;
use preisach_dyn::identify::Settings;
use rotor_gap::check_columns;
use serde::Serialize;
use std::path::Path;

/// The kinds of file that can be checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FileKind {
    /// A case.
    Case,
    /// A bench data folder: `dataset.ron` and its records.
    Bench,
    /// A data folder of generic loops.
    GenericLoop,
    /// A data folder of first-order reversal curves.
    ReversalCurves,
    /// A data folder of points of test of a rotor.
    RotorSweep,
    /// A data folder of frequencies of a blade.
    BladeFrequencies,
    /// A data folder of loads of an oscillating section.
    SectionLoops,
    /// An actuator written by `hhc identify`.
    Actuator,
}

/// A file without problems.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CheckResult {
    /// The file.
    pub file: String,
    /// Its kind.
    pub kind: FileKind,
    /// What it holds, in one line.
    pub summary: String,
    /// What is no problem, but should be known.
    pub warnings: Vec<String>,
}

/// Checks a case, a data folder (or its `dataset.ron`) or an actuator file.
///
/// # Errors
/// Every problem found.
pub fn check_file(path: &Path) -> Result<CheckResult, Problems> {
    let name = path.display().to_string();
    if path.is_dir() {
        return check_data(&Folder::Disk(path.to_path_buf()), name);
    }
    let source = Source::read(path)?;
    let index = RonIndex::new(&source.name, &source.text);
    let kind = index.value_text("kind");
    // any other text in brackets is taken for a case, whose reader then names what is wrong
    let has_brackets = || source.text.lines().any(|line| line.trim().starts_with('('));
    if kind.is_some_and(|kind| kind.starts_with("Actuator") && !kind.starts_with("ActuatorBench")) {
        let stored = read_actuator(&source)?;
        let summary = format!("{}, {}", stored.title, counted(stored.runs.len(), "run"));
        let warnings = actuator_warnings(&stored, |field| index.place(field));
        Ok(CheckResult { file: name, kind: FileKind::Actuator, summary, warnings })
    } else if kind.is_some() || index.contains("runs") {
        check_data(&Folder::of_file(path), name)
    } else if has_brackets() {
        let loaded = read_case(&source, &Folder::of_file(path))?;
        let mut warnings = loaded.warnings.clone();
        warnings.extend(check_actuator_source(&loaded)?);
        warnings.extend(with_flap_actuators(&loaded)?.1);
        let doubts = rotor_study::refuse_resonance(&loaded.case)
            .and_then(|()| Ok(loaded.case.plausibility_warnings()?));
        let doubts = doubts.map_err(|error| {
            let (place, message) = match loaded.located(error) {
                SimError::Study { place, source } => (place, source.cause()),
                error => (loaded.index.place("rotor"), error.to_string()),
            };
            Problem::new(place, Fault::Refused { message })
        })?;
        warnings.extend(loaded.in_words(doubts));
        Ok(CheckResult { file: name, kind: FileKind::Case, summary: loaded.case.title, warnings })
    } else {
        let message = "is neither a case, a dataset.ron nor an actuator file; a case has sections such as rotor: and trim:, a data set begins with kind: ActuatorBench, GenericLoop, ReversalCurves or RotorSweep, an actuator file with kind: Actuator";
        Err(Problem::new(Place::file(name), Fault::Other(message.to_owned())).into())
    }
}

/// Checks the data folder or actuator file a case names; warnings about it.
fn check_actuator_source(loaded: &LoadedCase) -> Result<Vec<String>, Problems> {
    let missing = |folder: &Folder, file: &str| {
        let place = loaded.index.place("actuator.model");
        Problems::from(Problem::new(place, missing_file(folder, file)))
    };
    match &loaded.actuator_source() {
        ActuatorSource::Ideal => Ok(vec![]),
        ActuatorSource::Bench(folder) if !folder.contains(DATASET) => Err(missing(folder, DATASET)),
        ActuatorSource::Bench(folder) => Ok(bench_warnings(&read_bench(folder)?)),
        ActuatorSource::Stored { folder, file } if !folder.contains(file) => {
            Err(missing(folder, file))
        }
        ActuatorSource::Stored { folder, file } => {
            stored_actuator(loaded, &folder.read(file)?).map(|(_, warnings)| warnings)
        }
    }
}

/// Warnings of bench data, and that nothing says how far the flap turns.
fn bench_warnings(data: &BenchData) -> Vec<String> {
    let mut warnings: Vec<String> = data.warnings.iter().map(Problem::to_string).collect();
    let (gain, rule) = gain(data, &Settings::default());
    let message = match rule {
        GainRule::Assumed => "is not given and no run is a slow loop to scale by: 1 deg/um will be assumed, expected the gain of the linkage; give it, or a full loop at 0.2 Hz".to_owned(),
        GainRule::WidestSlowLoop => format!(
            "is not given: {gain:.4} deg/um will make the widest slow loop +-10 deg, whatever the linkage does; give its gain, or import with --deg-per-um or --arm-mm"
        ),
        GainRule::DataSet => return warnings,
    };
    let place = Place::file(format!("{}/{DATASET}", data.folder)).field("flap_deg_per_um");
    warnings.push(Problem::new(place, Fault::Other(message)).to_string());
    warnings
}

fn check_data(folder: &Folder, file: String) -> Result<CheckResult, Problems> {
    let data = read_dataset(folder)?;
    let warnings = match &data {
        DataSet::Bench(data) => bench_warnings(data),
        other => other.warnings().iter().map(Problem::to_string).collect(),
    };
    let runs = counted(data.run_count(), "run");
    let labels = |channels: &Channels| channels.both().map(Channel::label).join(" to ");
    let (kind, summary) = match &data {
        DataSet::Bench(data) => {
            let samples: usize = data.runs.iter().map(|run| run.table.time_s.len()).sum();
            (FileKind::Bench, format!("{}: {runs}, {samples} samples", data.title))
        }
        DataSet::Loops(data) => {
            let samples: usize = data.runs.iter().map(|run| run.table.time_s.len()).sum();
            let [input, output] = data.channels.both().map(Channel::label);
            let (low, high) = data.input_range;
            let summary = format!(
                "{}: {input} to {output}, {runs}, {samples} samples, input {low} to {high} ({})",
                data.title, data.range_rule
            );
            (FileKind::GenericLoop, summary)
        }
        DataSet::Curves(data) => {
            let curves: usize = data.runs.iter().map(|run| run.curves.len()).sum();
            let summary =
                format!("{}: {}, {}", data.title, labels(&data.channels), counted(curves, "curve"));
            (FileKind::ReversalCurves, summary)
        }
        DataSet::Sweep(data) => {
            let kind = match data.kind {
                DatasetKind::BladeFrequencies => FileKind::BladeFrequencies,
                DatasetKind::SectionLoops => FileKind::SectionLoops,
                _ => FileKind::RotorSweep,
            };
            check_columns(data)?;
            let (rows, columns) = (data.points.ids.len(), data.points.columns.len());
            let (rows, columns) = (counted(rows, "row"), counted(columns, "column"));
            (kind, format!("{}: {rows}, {columns}", data.title))
        }
    };
    Ok(CheckResult { file, kind, summary, warnings })
}

impl Printable for CheckResult {
    fn text(&self) -> String {
        let kind = match self.kind {
            FileKind::Case => "case",
            FileKind::Bench => "bench data",
            FileKind::GenericLoop => "generic loops",
            FileKind::ReversalCurves => "reversal curves",
            FileKind::RotorSweep => "points of a rotor",
            FileKind::BladeFrequencies => "frequencies of a blade",
            FileKind::SectionLoops => "loads of a section",
            FileKind::Actuator => "actuator",
        };
        format!("{}: {kind}, no problems ({})", self.file, self.summary)
    }
}
