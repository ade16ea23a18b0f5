//! Imported records as a data folder.

use super::gather::Gathered;
use super::micromag::MicroMag;
use super::{ImportRequest, Imported, ReadSource, SourceKind, Table, folder_kind};
use crate::dataset::{
    DATASET, DEFAULT_COMMAND_RANGE_VOLT, DatasetFile, DatasetKind, RunFile, RunRole,
    check_bench_record,
};
use crate::error::DataError;
use crate::files::{ron_text, write_folder};
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};
use crate::tables::{
    Channel, ChannelFile, MeasuredTable, Record, check_record, check_unit, significant,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Significant digits of the numbers written.
const DIGITS: usize = 9;
/// Significant digits of the times written.
const TIME_DIGITS: usize = 14;

/// Voltages that piezo stacks, benders and their amplifiers reach, V.
const PLAUSIBLE_RANGE_VOLT: (f64, f64) = (-1000.0, 1000.0);

/// What `hhc import` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportResult {
    /// Folder written.
    pub folder: String,
    /// Kind of the data set.
    pub kind: &'static str,
    /// Title of the data set.
    pub title: String,
    /// The runs.
    pub runs: Vec<ImportedRun>,
    /// Range of the input, in its unit, and where it comes from; none for curves.
    pub range: Option<(f64, f64)>,
    /// Where the range comes from.
    pub range_rule: &'static str,
    /// What a reader should know.
    pub warnings: Vec<String>,
}

/// One imported run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportedRun {
    /// The source.
    pub source: String,
    /// Its format.
    pub source_kind: SourceKind,
    /// What was recognised, in words.
    pub recognised: String,
    /// Name of the run.
    pub id: String,
    /// File written.
    pub file: String,
    /// Samples read.
    pub samples_read: usize,
    /// Samples written.
    pub samples_written: usize,
    /// Samples read that were averaged into one; 1 if none were.
    pub block: usize,
    /// Time step written, s; none for curves.
    pub step_s: Option<f64>,
    /// Largest deviation of a time step read, percent; none for curves.
    pub jitter_percent: Option<f64>,
    /// Curves; none for records.
    pub curves: Option<usize>,
    /// The columns written, with their extremes.
    pub columns: Vec<ColumnSpan>,
    /// Columns of the source that were left out.
    pub left_out: Vec<String>,
}

/// A column and its extremes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnSpan {
    /// Name with unit.
    pub column: String,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub largest: f64,
}

fn span(label: &str, values: impl Iterator<Item = f64>) -> ColumnSpan {
    let (least, largest) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    ColumnSpan { column: label.to_owned(), least, largest }
}

/// What a data folder is made of.
#[derive(Default)]
struct Parts {
    runs: Vec<ImportedRun>,
    entries: Vec<RunFile>,
    files: Vec<(String, Vec<u8>)>,
    problems: Problems,
    warnings: Vec<Problem>,
}

/// Checks the records and writes the folder.
pub(super) fn write(
    request: &ImportRequest,
    sources: Vec<ReadSource>,
) -> Result<ImportResult, DataError> {
    let kind = sources.first().map_or(DatasetKind::GenericLoop, |s| folder_kind(&s.imported));
    let mut parts = Parts::default();
    let mut title = request.title.clone();
    let mut channels: Option<Vec<String>> = None;
    for source in sources {
        let name = source.path.display().to_string();
        let found = folder_kind(&source.imported);
        if found != kind {
            let fault = RecordFault::MixedKinds { found: found.word(), expected: kind.word() };
            parts.problems.push(Place::file(name), fault.into());
            continue;
        }
        let id = parts.new_id(&source.path);
        match source.imported {
            Imported::Record(ref table) => {
                if kind == DatasetKind::GenericLoop {
                    let labels = table.choice.labels();
                    let expected = channels.get_or_insert_with(|| labels.clone());
                    if *expected != labels {
                        let (found, expected) = (labels.join(", "), expected.join(", "));
                        let fault = RecordFault::OtherColumns { found, expected };
                        parts.problems.push(Place::file(&name), fault.into());
                    }
                }
                parts.record(request, &source, table, id);
            }
            Imported::Curves(ref curves) => {
                if title.is_none() && !curves.title.is_empty() {
                    title = Some(curves.title.clone());
                }
                parts.curves(&source, curves, id);
            }
        }
    }
    let Parts { runs, entries, mut files, problems, warnings } = parts;
    problems.into_result(Some(()))?;
    let title = title.unwrap_or_else(|| {
        let names: Vec<String> = runs.iter().map(|r| file_name(Path::new(&r.source))).collect();
        format!("imported from {}", names.join(", "))
    });
    let (range, range_rule) = range_of(request, kind, &runs);
    let dataset = dataset(kind, &title, entries, &runs, request.range, range);
    let text = ron_text(&dataset)
        .map_err(|e| DataError::NotWritten { path: request.out.clone(), reason: e.to_string() })?;
    let comment = format!(
        "// Written by `hhc import` {}: what was done stands in the notes of the runs.\n",
        env!("CARGO_PKG_VERSION")
    );
    let text = text.replacen('\n', &format!("\n{comment}"), 1);
    files.insert(0, (DATASET.to_owned(), text.into_bytes()));
    write_folder(&request.out, &files)?;
    Ok(ImportResult {
        folder: request.out.display().to_string(),
        kind: kind.word(),
        title,
        runs,
        range,
        range_rule,
        warnings: warnings.iter().map(Problem::to_string).collect(),
    })
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|n| n.display().to_string()).unwrap_or_default()
}

/// The range of the inputs and the rule it comes from.
fn range_of(
    request: &ImportRequest,
    kind: DatasetKind,
    runs: &[ImportedRun],
) -> (Option<(f64, f64)>, &'static str) {
    if kind == DatasetKind::ReversalCurves {
        return (None, "curves need none");
    }
    if request.range.is_some() {
        return (request.range, "given by --range");
    }
    let inputs = runs.iter().filter_map(|r| r.columns.first());
    let (low, high) = inputs
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c.least), h.max(c.largest)));
    (Some((low, high)), "from the smallest to the largest input of all runs")
}

fn dataset(
    kind: DatasetKind,
    title: &str,
    runs: Vec<RunFile>,
    imported: &[ImportedRun],
    given: Option<(f64, f64)>,
    range: Option<(f64, f64)>,
) -> DatasetFile {
    let column = |i: usize| {
        let column = imported.first()?.columns.get(i)?.column.clone();
        Some(ChannelFile { column, unit: None })
    };
    let is_loop = kind != DatasetKind::ActuatorBench;
    DatasetFile {
        kind,
        title: title.to_owned(),
        runs,
        flap_deg_per_um: None,
        // a bench without a range would get the default one
        command_range_volt: if is_loop { None } else { range },
        input: is_loop.then(|| column(0)).flatten(),
        output: is_loop.then(|| column(1)).flatten(),
        input_range: if kind == DatasetKind::GenericLoop { given } else { None },
    }
}

impl Parts {
    /// The name of a run: that of its file, made unique.
    fn new_id(&self, path: &Path) -> String {
        let stem = path.file_stem().map(|s| s.display().to_string()).unwrap_or_default();
        let plain: String = stem
            .chars()
            .map(|c| if c.is_alphanumeric() || matches!(c, '.' | '-' | '_') { c } else { '_' })
            .collect();
        let plain = if plain.trim_matches('.').is_empty() { "run".to_owned() } else { plain };
        let taken = |id: &str| self.entries.iter().any(|e| e.id == id);
        if !taken(&plain) {
            return plain;
        }
        // one of one more name than there are runs is free
        (2..self.entries.len() + 3)
            .map(|n| format!("{plain}_{n}"))
            .find(|id| !taken(id))
            .unwrap_or(plain)
    }

    fn record(&mut self, request: &ImportRequest, source: &ReadSource, record: &Table, id: String) {
        let Table { gathered, choice } = record;
        let name = source.path.display().to_string();
        self.warnings.extend(gathered.warnings.iter().cloned());
        let before = self.problems.as_slice().len();
        if choice.shape == super::Shape::Bench {
            self.check_bench(&name, gathered, request.range);
        } else {
            self.check_loop(&name, record, request.range);
        }
        if self.problems.as_slice().len() > before {
            return;
        }
        let labels = choice.labels();
        let file = format!("{id}.csv");
        let columns = labels[1..]
            .iter()
            .zip(&gathered.columns)
            .map(|(label, values)| span(label, values.iter().copied()))
            .collect();
        self.files.push((file.clone(), record_csv(&labels, gathered)));
        let samples_written = gathered.time_s.len();
        let step_s = significant(gathered.sampling.step_s * gathered.block as f64, 9);
        self.runs.push(ImportedRun {
            source: name,
            source_kind: source.kind,
            recognised: source.recognised.clone(),
            id: id.clone(),
            file: file.clone(),
            samples_read: gathered.count,
            samples_written,
            block: gathered.block,
            step_s: Some(step_s),
            jitter_percent: Some(significant(100.0 * gathered.sampling.jitter, 3)),
            curves: None,
            columns,
            left_out: choice.left_out.clone(),
        });
        let from = file_name(&source.path);
        let note = if gathered.block == 1 {
            format!("{from}, every sample")
        } else {
            format!("{from}, means of {} samples", gathered.block)
        };
        self.entries.push(entry(id, file, note, None));
    }

    fn check_bench(&mut self, name: &str, gathered: &Gathered, range: Option<(f64, f64)>) {
        let measured = MeasuredTable {
            time_s: vec![],
            time_step_s: gathered.sampling.step_s,
            command_volt: gathered.columns[0].clone(),
            displacement_um: gathered.columns[1].clone(),
            amplifier_volt: None,
            temperature_celsius: None,
            load_newton: None,
            lines: gathered.lines.clone(),
            warnings: vec![],
        };
        let Self { problems, warnings, .. } = self;
        check_bench_record(name, &measured, range, problems, warnings);
        if range.is_some() {
            return;
        }
        // without a range, what piezo actuators see at all tells volts from their thousandths, and the
        // range of a common stack from their thousands
        let record = Record {
            file: name,
            lines: &measured.lines,
            input: ("command_V", "V", &measured.command_volt),
            output: ("displacement_um", "um", &measured.displacement_um),
        };
        if check_unit(&record, PLAUSIBLE_RANGE_VOLT, problems) {
            let (low, high) = DEFAULT_COMMAND_RANGE_VOLT;
            let command = span("", measured.command_volt.iter().copied());
            let percent = 100.0 * (command.largest - command.least) / (high - low);
            if percent < 0.5 && percent > 0.0 {
                let fault = RecordFault::RangeUnused { percent, low, high };
                warnings.push(Problem::new(Place::file(name).field("command_V"), fault.into()));
            }
        }
    }

    fn check_loop(&mut self, name: &str, record: &Table, range: Option<(f64, f64)>) {
        let Table { gathered, choice } = record;
        let channels: [&Channel; 2] = [&choice.columns[0].channel, &choice.columns[1].channel];
        let labels = channels.map(Channel::label);
        let part =
            |i: usize| (labels[i].as_str(), channels[i].unit.symbol, &gathered.columns[i][..]);
        let record = Record { file: name, lines: &gathered.lines, input: part(0), output: part(1) };
        check_record(&record, &mut self.problems, &mut self.warnings);
        if let Some((low, high)) = range {
            let input = span("", gathered.columns[0].iter().copied());
            for value in [input.least, input.largest] {
                if value < low || value > high {
                    let unit = channels[0].unit.symbol;
                    let remedy = "correct --range, or its unit";
                    let fault = Fault::OutOfRange { value, low, high, unit, remedy };
                    self.problems.push(Place::file(name).field(&labels[0]), fault);
                }
            }
        }
    }

    fn curves(&mut self, source: &ReadSource, found: &MicroMag, id: String) {
        let labels = [found.input.label(), found.output.label()];
        let points = || found.curves.iter().flat_map(|c| c.points.iter().copied());
        let count = points().count();
        let calibrations: Vec<(usize, (f64, f64))> = found
            .curves
            .iter()
            .enumerate()
            .filter_map(|(i, c)| Some((i, c.calibration?)))
            .collect();
        let header = format!("curve,{},{}\n", labels[0], labels[1]);
        let mut text = header.clone();
        for (i, curve) in found.curves.iter().enumerate() {
            for (h, m) in &curve.points {
                push_row(&mut text, &[(i + 1).to_string(), number(*h), number(*m)]);
            }
        }
        let file = format!("{id}.csv");
        self.files.push((file.clone(), text.into_bytes()));
        let mut calibration = None;
        // fewer than three would be no table, and no drift could be told from them
        if calibrations.len() > 2 {
            let mut text = header;
            for (i, (h, m)) in &calibrations {
                push_row(&mut text, &[(i + 1).to_string(), number(*h), number(*m)]);
            }
            let file = format!("{id}_calibration.csv");
            self.files.push((file.clone(), text.into_bytes()));
            calibration = Some(file);
        }
        let note = format!(
            "{}, {} curves, {} drift calibrations, drift not taken off",
            file_name(&source.path),
            found.curves.len(),
            calibrations.len()
        );
        self.runs.push(ImportedRun {
            source: source.path.display().to_string(),
            source_kind: source.kind,
            recognised: format!("{}, {} drift calibrations", source.recognised, calibrations.len()),
            id: id.clone(),
            file: file.clone(),
            samples_read: count + calibrations.len(),
            samples_written: count,
            block: 1,
            step_s: None,
            jitter_percent: None,
            curves: Some(found.curves.len()),
            columns: vec![
                span(&labels[0], points().map(|p| p.0)),
                span(&labels[1], points().map(|p| p.1)),
            ],
            left_out: vec![],
        });
        self.entries.push(entry(id, file, note, calibration));
    }
}

fn entry(id: String, file: String, note: String, calibration: Option<String>) -> RunFile {
    RunFile {
        id,
        file,
        role: RunRole::Reference,
        note,
        start_s: None,
        use_as: None,
        window_s: None,
        sensor: None,
        fitting: None,
        conditions: BTreeMap::new(),
        calibration,
    }
}

fn number(value: f64) -> String {
    significant(value, DIGITS).to_string()
}

fn push_row(text: &mut String, fields: &[String]) {
    text.push_str(&fields.join(","));
    text.push('\n');
}

fn record_csv(labels: &[String], gathered: &Gathered) -> Vec<u8> {
    let mut text = labels.join(",") + "\n";
    let step = (gathered.time_s[gathered.time_s.len() - 1] - gathered.time_s[0])
        / (gathered.time_s.len() - 1) as f64;
    for (i, time) in gathered.time_s.iter().enumerate() {
        // digits beyond a millionth of the step are noise of the sums
        let grain = significant(step, 1) * 1e-7;
        let time = (time / grain).round() * grain;
        let _ = write!(text, "{}", significant(time, TIME_DIGITS));
        for column in &gathered.columns {
            let _ = write!(text, ",{}", number(column[i]));
        }
        text.push('\n');
    }
    text.into_bytes()
}
