//! Opening a data folder: `dataset.ron`, the checks all kinds share, and the files it names.

use super::file::{DatasetFile, DatasetKind};
use super::run::{Run, meant_by_id, samples_within};
use crate::files::{Folder, RonIndex, Source, read_ron};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{
    Channel, Declared, MeasuredTable, Record, Spans, check_rests, several_runs, unknown_unit,
};
use std::collections::BTreeMap;

/// Name of the file that describes a data folder.
pub const DATASET: &str = "dataset.ron";
/// Largest record file read at once, MB: about two million samples.
const LARGEST_RECORD_MB: u64 = 64;
/// Fewest samples of a window.
const LEAST_WINDOW: usize = 16;

/// The step of even times, and a little more: a window may end where the sample after the last one would be, s.
fn one_step(time_s: &[f64]) -> f64 {
    let spans = time_s.len().saturating_sub(1).max(1) as f64;
    let span = time_s.last().zip(time_s.first()).map_or(0.0, |(last, first)| last - first);
    1.01 * span / spans
}

/// Keys that not all kinds have, of the data set or its runs, with the kinds that have them.
const KEYS: [(&str, &str); 10] = [
    ("flap_deg_per_um", "ActuatorBench"),
    ("command_range_V", "ActuatorBench"),
    ("accuracy", "ActuatorBench"),
    ("input", "GenericLoop and ReversalCurves"),
    ("output", "GenericLoop and ReversalCurves"),
    ("input_range", "GenericLoop and ReversalCurves"),
    ("window_s", "ActuatorBench and GenericLoop"),
    ("sensor", "ActuatorBench and GenericLoop"),
    ("fitting", "ActuatorBench and GenericLoop"),
    ("calibration", "ReversalCurves"),
];

/// Reads the text of `dataset.ron`.
pub(crate) fn read_description(folder: &Folder) -> Result<Source, Problem> {
    folder.read(DATASET).map_err(|mut problem| {
        if let Fault::Unreadable { reason } = &mut problem.fault {
            reason.push_str("; a data folder is described by its dataset.ron");
        }
        problem
    })
}

/// A data folder while its records are read.
pub(crate) struct OpenDataset<'a> {
    folder: &'a Folder,
    pub(crate) dataset: DatasetFile,
    pub(crate) index: RonIndex,
    pub(crate) problems: Problems,
    pub(crate) warnings: Vec<Problem>,
    hash: blake3::Hasher,
}

impl<'a> OpenDataset<'a> {
    /// Reads `dataset.ron` and checks what all kinds share.
    pub(crate) fn open(folder: &'a Folder, kind: DatasetKind) -> Result<Self, Problems> {
        let source = read_description(folder)?;
        let mut hash = blake3::Hasher::new();
        hash.update(source.text.as_bytes());
        let file = read_ron::<DatasetFile>(&source);
        let Some(dataset) = file.value else {
            return file.problems.into_result(None);
        };
        let (index, problems, warnings) = (file.index, file.problems, vec![]);
        let mut open = Self { folder, dataset, index, problems, warnings, hash };
        if open.dataset.kind != kind {
            let message = format!(
                "is {:?}, expected {kind:?}; this command or case works on that kind only",
                open.dataset.kind
            );
            open.problems.push(open.index.place("kind"), Fault::Other(message));
            return open.problems.into_result(None);
        }
        open.check_title_and_runs();
        open.check_keys(kind);
        Ok(open)
    }

    /// Folder, for messages and results, and hash of everything read.
    pub(crate) fn origin(&self) -> (String, String) {
        let folder = self.folder.display("").trim_end_matches('/').to_owned();
        (folder, self.hash.finalize().to_hex().to_string())
    }

    /// What is said of the columns of input and output.
    pub(crate) fn declared(&self) -> Declared {
        [self.dataset.input.clone(), self.dataset.output.clone()]
    }

    /// The runs with their tables: `table` makes and checks one of a file.
    pub(crate) fn runs(
        &mut self,
        mut table: impl FnMut(&mut Self, &Source) -> Result<MeasuredTable, Problems>,
    ) -> Vec<Run> {
        let mut runs = Vec::with_capacity(self.dataset.runs.len());
        for (number, run) in self.dataset.runs.clone().into_iter().enumerate() {
            let source = self.read(&run.file, &run_field(number, "file"));
            match source.map(|source| table(self, &source)) {
                Some(Ok(table)) => {
                    self.check_window(number, &table.time_s);
                    self.check_run(number);
                    runs.push(Run::new(run, table));
                }
                Some(Err(more)) => self.problems.append(more),
                None => {}
            }
        }
        runs
    }

    /// Judges runs beside one another, each inside its window: which rest, which hold several runs. `columns` are
    /// input and output with their units.
    pub(crate) fn check_together(
        &mut self,
        runs: &[Run],
        [input, output]: [(&str, &'static str); 2],
    ) -> Vec<Spans> {
        let mut spans = Vec::with_capacity(runs.len());
        for run in runs {
            let (table, window) = (&run.table, run.window());
            let name = self.folder.display(&run.entry.file);
            let record = Record {
                file: &name,
                lines: table.lines.get(window.clone()).unwrap_or_default(),
                input: (input.0, input.1, table.input.get(window.clone()).unwrap_or_default()),
                output: (output.0, output.1, table.output.get(window).unwrap_or_default()),
            };
            spans.push(Spans::of(&record));
            self.warnings.extend(several_runs(&record));
        }
        check_rests(&spans, &mut self.problems, &mut self.warnings);
        spans
    }

    /// Reads a file of a run; `path` is its field in `dataset.ron`.
    pub(crate) fn read(&mut self, file: &str, path: &str) -> Option<Source> {
        let source = self.checked(file, path);
        let source = self.problems.note(source)?;
        self.hash.update(source.text.as_bytes());
        Some(source)
    }

    fn checked(&self, file: &str, path: &str) -> Result<Source, Problem> {
        let refused = |fault| Err(Problem::new(self.index.place(path), fault));
        if let Some(fault) = self.folder.leads_out(file) {
            return refused(fault);
        }
        if !self.folder.contains(file) {
            let folder = self.folder.display("");
            return refused(Fault::MissingFile { file: file.to_owned(), folder });
        }
        let megabytes = self.folder.size_bytes(file) / 1_000_000;
        if megabytes > LARGEST_RECORD_MB {
            let fault = Fault::TooLarge { megabytes, limit_megabytes: LARGEST_RECORD_MB };
            return Err(Problem::new(Place::file(self.folder.display(file)), fault));
        }
        self.folder.read(file)
    }

    /// Checks the window of run `number` against its times.
    fn check_window(&mut self, number: usize, time_s: &[f64]) {
        let Some((from_s, to_s)) = self.dataset.runs[number].window_s else { return };
        let samples = samples_within(time_s, Some((from_s, to_s))).len();
        if let (Some(&first_s), Some(&last_s)) = (time_s.first(), time_s.last())
            && (samples < LEAST_WINDOW || from_s < first_s || to_s > last_s + one_step(time_s))
        {
            let message = format!(
                "the window ({from_s}, {to_s}) s holds {samples} samples of the record, which runs from {first_s} to {last_s} s; give (t0, t1) with t0 < t1 inside the record and at least {LEAST_WINDOW} samples"
            );
            let place = self.index.place(&run_field(number, "window_s"));
            self.problems.push(place, Fault::Other(message));
        }
    }

    /// Checks the conditions of run `number`; warns where its id stands for a sensor or a fitting.
    fn check_run(&mut self, number: usize) {
        let run = &self.dataset.runs[number];
        for (name, value) in &run.conditions {
            let place = || self.index.place(&run_field(number, &format!("conditions.{name}")));
            if Channel::parse(name).is_none() {
                self.problems.push(place(), unknown_unit(name));
            }
            if !value.is_finite() {
                self.problems.push(place(), Fault::NotFinite { value: *value });
            }
        }
        let (sensor, fitting) = meant_by_id(&run.id);
        for (is_meant, key) in [
            (sensor.is_some() && run.sensor.is_none(), "sensor: Ideal"),
            (fitting.is_some() && run.fitting.is_none(), "fitting: Preloaded"),
        ] {
            if is_meant {
                let message = format!(
                    "the id says how the run was measured; write `{key}` beside it: ids will lose that meaning"
                );
                let place = self.index.place(&run_field(number, "id"));
                self.warnings.push(Problem::new(place, Fault::Other(message)));
            }
        }
    }

    fn check_title_and_runs(&mut self) {
        let Self { dataset, index, problems, .. } = self;
        if dataset.title.trim().is_empty() {
            let of = "one line about the data: what was measured, where, on what";
            problems.push(index.place("title"), Fault::Empty { of });
        }
        if dataset.runs.is_empty() {
            problems.push(index.place("runs"), Fault::Empty { of: "at least one run" });
        }
        let mut ids = BTreeMap::new();
        let mut files = BTreeMap::new();
        for (i, run) in dataset.runs.iter().enumerate() {
            // a file is another record in another window
            let window = run.window_s.map(|(from, to)| format!(" {from} {to}")).unwrap_or_default();
            let record = format!("{}{window}", run.file);
            for (key, value, unique, seen, of) in [
                ("id", &run.id, &run.id, &mut ids, "run"),
                ("file", &run.file, &record, &mut files, "run file"),
            ] {
                let path = run_field(i, key);
                if value.trim().is_empty() {
                    problems.push(index.place(&path), Fault::Empty { of: "a name" });
                    continue;
                }
                let line = index.line(&path).unwrap_or_default();
                if let Some(first_line) = seen.insert(unique.clone(), line) {
                    let message = format!(
                        "`{value}` is used already on line {first_line}; give every {of} its own"
                    );
                    problems.push(index.place(&path), Fault::Other(message));
                }
            }
            if let Some(value) = run.start_s.filter(|v| !(v.is_finite() && *v >= 0.0)) {
                let (low, high, unit) = (0.0, 1e9, "s");
                let remedy = "give the seconds since switch-on, or leave it out";
                let fault = Fault::OutOfRange { value, low, high, unit, remedy };
                problems.push(index.place(&run_field(i, "start_s")), fault);
            }
        }
    }

    /// Keys that belong to another kind.
    fn check_keys(&mut self, kind: DatasetKind) {
        let runs = 0..self.dataset.runs.len();
        let kind = format!("{kind:?}");
        for (key, belongs) in KEYS.into_iter().filter(|(_, of)| !of.contains(&kind)) {
            let of_runs = runs.clone().map(|run| run_field(run, key));
            for path in std::iter::once(key.to_owned()).chain(of_runs) {
                if self.index.contains(&path) {
                    let message = format!(
                        "belongs to kind {belongs}, the data set is {kind}; remove it, or change the kind"
                    );
                    self.problems.push(self.index.place(&path), Fault::Other(message));
                }
            }
        }
    }

    /// A range of `dataset.ron`, checked.
    pub(crate) fn check_range(&mut self, key: &str, range: (f64, f64)) -> Option<(f64, f64)> {
        let Some(fault) = Fault::of_range(range) else { return Some(range) };
        self.problems.push(self.index.place(key), fault);
        None
    }
}

/// What the records of all kinds share in `dataset.ron`.
pub(crate) fn run_field(number: usize, key: &str) -> String {
    format!("runs[{number}].{key}")
}
