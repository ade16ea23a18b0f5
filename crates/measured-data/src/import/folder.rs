//! Imported records as a data folder.

use super::columns::{Choice, no_effect};
use super::gather::Gathered;
use super::micromag::MicroMag;
use super::{ImportKind, ImportRequest, Imported, ReadSource, SourceKind, folder_kind};
use crate::dataset::{
    DATASET, DEFAULT_COMMAND_RANGE_VOLT, DatasetFile, DatasetKind, PLAUSIBLE_RANGE_VOLT, RunFile,
    check_bench_record, monitor_volts, range_unused,
};
use crate::error::DataError;
use crate::files::{ron_text, write_folder};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{
    Channel, ChannelFile, Record, Spans, check_record, check_rests, check_unit, limits, parted,
    several_runs, significant,
};
use serde::Serialize;
use std::ops::Range;
use std::path::Path;

/// Significant digits of the numbers written.
const DIGITS: usize = 9;
/// Significant digits of the times written.
const TIME_DIGITS: usize = 14;

/// What `hhc import` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportResult {
    /// Folder written.
    pub folder: String,
    /// Kind of the data set.
    pub kind: DatasetKind,
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
    /// Columns of the source that were called otherwise, or are not what they might be by their name, in words.
    pub renamed: Vec<String>,
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

pub(super) fn span(label: &str, values: &[f64]) -> ColumnSpan {
    // as written
    let (least, largest) = limits(values);
    let [least, largest] = [least, largest].map(|value| significant(value, DIGITS));
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
    spans: Vec<Spans>,
}

/// Checks the records and writes the folder.
pub(super) fn write(
    request: &ImportRequest,
    sources: Vec<ReadSource>,
) -> Result<ImportResult, DataError> {
    let kind = sources.first().map_or(DatasetKind::GenericLoop, |s| folder_kind(&s.imported));
    let not_written = |reason: String| DataError::NotWritten { path: request.out.clone(), reason };
    let mut parts = Parts::default();
    let mut title = request.title.clone();
    let mut channels: Option<Vec<String>> = None;
    for source in sources {
        let found = folder_kind(&source.imported);
        if found != kind {
            let message = format!(
                "holds {found:?}, the files before it {kind:?}; import them into folders of their own"
            );
            parts.problems.push(source.place(), Fault::Other(message));
            continue;
        }
        match &source.imported {
            Imported::Record(table) => {
                let labels = table.choice.labels();
                let expected = channels.get_or_insert_with(|| labels.clone());
                if kind == DatasetKind::GenericLoop && *expected != labels {
                    let (found, expected) = (labels.join(", "), expected.join(", "));
                    parts.problems.push(source.place(), Fault::OtherColumns { found, expected });
                }
                if kind != DatasetKind::ActuatorBench && request.deg_per_um.is_some() {
                    let remedy = "leave it out, or name the columns `command` and `displacement`";
                    let fault = no_effect("--deg-per-um", "this is no actuator bench", remedy);
                    parts.problems.push(source.place(), fault);
                }
                for gathered in &table.parts {
                    let record = parts.record(request, &source, (&table.choice, gathered));
                    record.map_err(|e| not_written(e.to_string()))?;
                }
            }
            Imported::Curves(curves) => {
                if title.is_none() && !curves.title.is_empty() {
                    title = Some(curves.title.clone());
                }
                let id = parts.new_id(&source.path);
                let written = parts.curves(&source, curves, id);
                written.map_err(|e| not_written(e.to_string()))?;
            }
        }
    }
    let Parts { runs, entries, mut files, mut problems, mut warnings, spans } = parts;
    check_rests(&spans, &mut problems, &mut warnings);
    if kind == DatasetKind::ActuatorBench
        && let Some((fault, first)) = monitor_volts(&spans).zip(spans.first())
    {
        warnings.push(Problem::new(first.place.clone(), fault));
    }
    problems.into_result(Some(()))?;
    let title = title.unwrap_or_else(|| {
        let mut names: Vec<String> = runs.iter().map(|r| file_name(Path::new(&r.source))).collect();
        names.dedup();
        format!("imported from {}", names.join(", "))
    });
    let (range, range_rule) = range_of(request, kind, &runs);
    let is_loop = kind != DatasetKind::ActuatorBench;
    let column = |i: usize| {
        let column = runs.first().filter(|_| is_loop)?.columns.get(i)?.column.clone();
        Some(ChannelFile { column, unit: None })
    };
    let dataset = DatasetFile {
        kind,
        title: title.clone(),
        runs: entries,
        flap_deg_per_um: request.deg_per_um,
        accuracy: None,
        // a bench without a range would get the default one
        command_range_volt: range.filter(|_| !is_loop),
        input: column(0),
        output: column(1),
        input_range: request.range.filter(|_| kind == DatasetKind::GenericLoop),
    };
    let text = ron_text(&dataset).map_err(|e| not_written(e.to_string()))?;
    let comment = format!(
        "// Written by `hhc import` {}: what was done stands in the notes of the runs.\n",
        env!("CARGO_PKG_VERSION")
    );
    let text = text.replacen('\n', &format!("\n{comment}"), 1);
    files.insert(0, (DATASET.to_owned(), text.into_bytes()));
    write_folder(&request.out, &files)?;
    Ok(ImportResult {
        folder: request.out.display().to_string(),
        kind,
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
    let ends: Vec<f64> = inputs.flat_map(|input| [input.least, input.largest]).collect();
    let (low, high) = limits(&ends);
    if low >= high {
        let (usual_low, usual_high) = DEFAULT_COMMAND_RANGE_VOLT;
        return (
            Some((usual_low.min(low), usual_high.max(high))),
            "the usual one, as no input moves; correct it with the records that do",
        );
    }
    (Some((low, high)), "from the smallest to the largest input of all runs")
}

impl ReadSource {
    fn place(&self) -> Place {
        Place::file(self.path.display().to_string())
    }

    /// A run of the numbers of samples read and written, not yet described.
    fn run(&self, id: String, [samples_read, samples_written]: [usize; 2]) -> ImportedRun {
        ImportedRun {
            source: self.path.display().to_string(),
            source_kind: self.kind,
            recognised: self.recognised.clone(),
            file: format!("{id}.csv"),
            id,
            samples_read,
            samples_written,
            block: 1,
            step_s: None,
            jitter_percent: None,
            curves: None,
            columns: vec![],
            left_out: vec![],
            renamed: vec![],
        }
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
        let plain =
            if plain.trim_matches(['.', '-']).is_empty() { "run".to_owned() } else { plain };
        let taken = |id: &str| self.entries.iter().any(|e| e.id == id);
        let numbered = (2..).map(|n| format!("{plain}_{n}"));
        let mut ids = std::iter::once(plain.clone()).chain(numbered);
        ids.find(|id| !taken(id)).unwrap_or_default()
    }

    fn record(
        &mut self,
        request: &ImportRequest,
        source: &ReadSource,
        (choice, gathered): (&Choice, &Gathered),
    ) -> Result<(), csv::Error> {
        self.warnings.extend(gathered.warnings.iter().cloned());
        let before = self.problems.as_slice().len();
        let windows = if request.split { windows(&gathered.columns[0]) } else { Vec::new() };
        self.check(source, (choice, gathered), request.range, &windows);
        if self.problems.as_slice().len() > before {
            return Ok(());
        }
        let labels = choice.labels();
        let from = file_name(&source.path);
        let mut note = match gathered.block {
            1 => format!("{from}, every sample"),
            block => format!("{from}, means of {block} samples"),
        };
        for said in choice.renamed.iter().chain(&choice.corrections) {
            note = format!("{note}, {said}");
        }
        let step_s = gathered.sampling.step_s * gathered.block as f64;
        let times = written_times(gathered);
        let first = self.new_id(&source.path);
        let file = format!("{first}.csv");
        self.files.push((file.clone(), csv_table(&labels, record_rows(&times, gathered))?));
        let whole = 0..times.len();
        let parts = if windows.is_empty() { vec![whole.clone()] } else { windows };
        for part in parts {
            let columns = labels[1..].iter().zip(&gathered.columns);
            let run = ImportedRun {
                file: file.clone(),
                block: gathered.block,
                step_s: Some(significant(step_s, 9)),
                jitter_percent: Some(significant(100.0 * gathered.sampling.jitter, 3)),
                left_out: choice.left_out.clone(),
                renamed: choice.renamed.clone(),
                columns: columns.map(|(label, v)| span(label, &v[part.clone()])).collect(),
                ..source.run(self.new_id(&source.path), [gathered.count, part.len()])
            };
            let window_s = (part != whole).then(|| (times[part.start], times[part.end - 1]));
            self.push(run, RunFile { note: note.clone(), window_s, ..RunFile::default() });
        }
        Ok(())
    }

    /// Adds a run to the folder and its description.
    fn push(&mut self, run: ImportedRun, entry: RunFile) {
        let (id, file) = (run.id.clone(), run.file.clone());
        self.entries.push(RunFile { id, file, ..entry });
        self.runs.push(run);
    }

    fn check(
        &mut self,
        source: &ReadSource,
        (choice, gathered): (&Choice, &Gathered),
        range: Option<(f64, f64)>,
        windows: &[Range<usize>],
    ) {
        let Self { problems, warnings, spans, .. } = self;
        let name = source.path.display().to_string();
        let channels: [&Channel; 2] = [&choice.columns[0].channel, &choice.columns[1].channel];
        let labels = channels.map(Channel::label);
        let part =
            |i: usize| (labels[i].as_str(), channels[i].unit.symbol, &gathered.columns[i][..]);
        let (input, output) = (part(0), part(1));
        let record = Record { file: &name, lines: &gathered.lines, input, output };
        spans.push(Spans::of(&record));
        if windows.is_empty() {
            warnings.extend(several_runs(&record));
        }
        let place = || source.place().field(&labels[0]);
        let (least, largest) = limits(&gathered.columns[0]);
        let (unit, remedy) = (channels[0].unit.symbol, "correct --range, or its unit");
        for value in [least, largest] {
            let left = range.filter(|(low, high)| value < *low || value > *high);
            if let Some((low, high)) = left {
                problems.push(place(), Fault::OutOfRange { value, low, high, unit, remedy });
            }
        }
        match choice.kind {
            ImportKind::GenericLoop
            | ImportKind::RotorSweep
            | ImportKind::BladeFrequencies
            | ImportKind::SectionLoops => {
                check_record(&record, problems, warnings);
            }
            ImportKind::ActuatorBench => {
                check_bench_record(&record, [range; 2], problems, warnings);
                // without a range, what piezo actuators see at all tells volts from their
                // thousandths, and the range of a common stack from their thousands
                if range.is_none() && check_unit(&record, PLAUSIBLE_RANGE_VOLT, problems) {
                    let unused = range_unused(largest - least, DEFAULT_COMMAND_RANGE_VOLT);
                    warnings.extend(unused.map(|fault| Problem::new(place(), fault)));
                }
            }
        }
    }

    fn curves(
        &mut self,
        source: &ReadSource,
        found: &MicroMag,
        id: String,
    ) -> Result<(), csv::Error> {
        let labels = ["curve".to_owned(), found.input.label(), found.output.label()];
        let row = |(curve, (field, moment)): (usize, (f64, f64))| {
            vec![(curve + 1).to_string(), number(field), number(moment)]
        };
        let curves = || found.curves.iter().enumerate();
        let points: Vec<(usize, (f64, f64))> =
            curves().flat_map(|(i, c)| c.points.iter().map(move |point| (i, *point))).collect();
        let calibrations: Vec<(usize, (f64, f64))> =
            curves().filter_map(|(i, c)| Some((i, c.calibration?))).collect();
        let note = format!(
            "{}, {} curves, {} drift calibrations, drift not taken off",
            file_name(&source.path),
            found.curves.len(),
            calibrations.len()
        );
        let fields: Vec<f64> = points.iter().map(|(_, (field, _))| *field).collect();
        let moments: Vec<f64> = points.iter().map(|(_, (_, moment))| *moment).collect();
        let run = ImportedRun {
            recognised: format!("{}, {} drift calibrations", source.recognised, calibrations.len()),
            curves: Some(found.curves.len()),
            columns: vec![span(&labels[1], &fields), span(&labels[2], &moments)],
            ..source.run(id, [points.len() + calibrations.len(), points.len()])
        };
        self.files.push((run.file.clone(), csv_table(&labels, points.into_iter().map(row))?));
        let mut calibration = None;
        // fewer than three would be no table, and no drift could be told from them
        if calibrations.len() > 2 {
            let file = format!("{}_calibration.csv", run.id);
            let table = csv_table(&labels, calibrations.into_iter().map(row))?;
            self.files.push((file.clone(), table));
            calibration = Some(file);
        }
        self.push(run, RunFile { note, calibration, ..RunFile::default() });
        Ok(())
    }
}

fn number(value: f64) -> String {
    significant(value, DIGITS).to_string()
}

/// The text of a table.
fn csv_table(
    labels: &[String],
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(labels)?;
    for row in rows {
        writer.write_record(row)?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// The times of a record as they are written.
fn written_times(gathered: &Gathered) -> Vec<f64> {
    let time_s = &gathered.time_s;
    let step = (time_s[time_s.len() - 1] - time_s[0]) / (time_s.len() - 1) as f64;
    // digits beyond a millionth of the step are noise of the sums
    let grain = significant(step, 1) * 1e-7;
    let written = |time: &f64| significant((time / grain).round() * grain, TIME_DIGITS);
    time_s.iter().map(written).collect()
}

fn record_rows(times: &[f64], gathered: &Gathered) -> impl Iterator<Item = Vec<String>> {
    times.iter().enumerate().map(|(i, time)| {
        let numbers = gathered.columns.iter().map(|column| number(column[i]));
        std::iter::once(time.to_string()).chain(numbers).collect()
    })
}

/// The samples of each run of an input that holds several, cut in the middle of the rests between them; none of
/// an input that holds one.
fn windows(input: &[f64]) -> Vec<Range<usize>> {
    let cuts: Vec<usize> =
        parted(input).into_iter().map(|p| p.rest.start.midpoint(p.rest.end)).collect();
    if cuts.is_empty() {
        return Vec::new();
    }
    let starts = std::iter::once(0).chain(cuts.iter().copied());
    let ends = cuts.iter().copied().chain([input.len()]);
    starts.zip(ends).map(|(start, end)| start..end).collect()
}
