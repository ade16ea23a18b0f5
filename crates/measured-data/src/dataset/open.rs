//! Opening a data folder: `dataset.ron`, the checks all kinds share, and the files it names.

use super::file::{DatasetFile, DatasetKind, RunFile};
use super::run::{meant_by_id, samples_within};
use crate::files::{Folder, RonIndex, Source, read_ron};
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};
use crate::tables::{Channel, Unit};
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// Name of the file that describes a data folder.
pub const DATASET: &str = "dataset.ron";
/// Largest record file read at once, MB: about two million samples.
const LARGEST_RECORD_MB: u64 = 64;
/// Fewest samples of a window.
const LEAST_WINDOW: usize = 16;

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
        let mut open = Self { folder, dataset, index: file.index, problems: file.problems, hash };
        if open.dataset.kind != kind {
            let fault = RecordFault::OtherKind {
                found: open.dataset.kind.word(),
                expected: kind.word(),
                remedy: "this command or case works on that kind only",
            };
            open.problems.push(open.index.place("kind"), fault.into());
            return open.problems.into_result(None);
        }
        open.check_title_and_runs();
        open.check_keys(kind);
        Ok(open)
    }

    /// Folder for messages and results.
    pub(crate) fn folder_name(&self) -> String {
        self.folder.display("").trim_end_matches('/').to_owned()
    }

    /// Reads a file of a run; `path` is its field in `dataset.ron`.
    pub(crate) fn read(&mut self, file: &str, path: &str) -> Option<Source> {
        let place = self.index.place(path);
        if !is_plain(file) {
            self.problems.push(place, Fault::NotPlainFile { path: file.to_owned() });
            return None;
        }
        if !self.folder.contains(file) {
            let folder = self.folder.display("");
            self.problems.push(place, Fault::MissingFile { file: file.to_owned(), folder });
            return None;
        }
        let megabytes = self.folder.size_bytes(file) / 1_000_000;
        if megabytes > LARGEST_RECORD_MB {
            let limit_megabytes = LARGEST_RECORD_MB;
            let fault = RecordFault::TooLarge { megabytes, limit_megabytes };
            self.problems.push(Place::file(self.folder.display(file)), fault.into());
            return None;
        }
        match self.folder.read(file) {
            Ok(source) => {
                self.hash.update(source.text.as_bytes());
                Some(source)
            }
            Err(problem) => {
                self.problems.push(problem.place, problem.fault);
                None
            }
        }
    }

    /// Checks the window of run `number` against its times.
    pub(crate) fn check_window(&mut self, number: usize, time_s: &[f64]) {
        let Some(window_s) = self.dataset.runs[number].window_s else { return };
        let samples = samples_within(time_s, Some(window_s)).len();
        let (from_s, to_s) = window_s;
        if let (Some(&first_s), Some(&last_s)) = (time_s.first(), time_s.last())
            && (samples < LEAST_WINDOW || from_s < first_s || to_s > last_s)
        {
            let least = LEAST_WINDOW;
            let fault = RecordFault::Window { from_s, to_s, samples, first_s, last_s, least };
            self.problems.push(self.index.place(&format!("runs[{number}].window_s")), fault.into());
        }
    }

    /// Checks the conditions of run `number`; warns where its id stands for a sensor or a fitting.
    pub(crate) fn check_run(&mut self, number: usize, warnings: &mut Vec<Problem>) {
        let run = &self.dataset.runs[number];
        for (name, value) in &run.conditions {
            let place = || self.index.place(&format!("runs[{number}].conditions.{name}"));
            if Channel::parse(name).is_none() {
                let (found, known) = (name.clone(), Unit::known());
                self.problems.push(place(), RecordFault::UnknownUnit { found, known }.into());
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
                let fault = RecordFault::MeantById { key };
                let place = self.index.place(&run_field(number, "id"));
                warnings.push(Problem::new(place, fault.into()));
            }
        }
    }

    /// Hash of everything read.
    pub(crate) fn content_hash(&self) -> String {
        self.hash.finalize().to_hex().to_string()
    }

    fn check_title_and_runs(&mut self) {
        let Self { dataset, index, problems, .. } = self;
        if dataset.title.trim().is_empty() {
            let of = "one line about the data: what was measured, where, on what";
            problems.push(index.place("title"), Fault::EmptyText { of });
        }
        if dataset.runs.is_empty() {
            problems.push(index.place("runs"), Fault::EmptyList { of: "run" });
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
                let path = format!("runs[{i}].{key}");
                if value.trim().is_empty() {
                    problems.push(index.place(&path), Fault::EmptyText { of: "a name" });
                    continue;
                }
                let line = index.line(&path).unwrap_or_default();
                if let Some(first_line) = seen.insert(unique.clone(), line) {
                    let fault = Fault::Repeated { name: value.clone(), of, first_line };
                    problems.push(index.place(&path), fault);
                }
            }
            if let Some(value) = run.start_s.filter(|v| !(v.is_finite() && *v >= 0.0)) {
                let (low, high, unit) = (0.0, 1e9, "s");
                let remedy = "give the seconds since switch-on, or leave it out";
                let fault = Fault::OutOfRange { value, low, high, unit, remedy };
                problems.push(index.place(&format!("runs[{i}].start_s")), fault);
            }
        }
    }

    /// Keys that belong to another kind.
    fn check_keys(&mut self, kind: DatasetKind) {
        use DatasetKind::{ActuatorBench, ReversalCurves};
        let d = &self.dataset;
        let both = "GenericLoop and ReversalCurves";
        let mut keys = vec![
            ("flap_deg_per_um".to_owned(), d.flap_deg_per_um.is_some(), ActuatorBench.word()),
            ("command_range_V".to_owned(), d.command_range_volt.is_some(), ActuatorBench.word()),
            ("input".to_owned(), d.input.is_some(), both),
            ("output".to_owned(), d.output.is_some(), both),
            ("input_range".to_owned(), d.input_range.is_some(), both),
        ];
        for (i, run) in d.runs.iter().enumerate() {
            let windows = "ActuatorBench and GenericLoop";
            keys.push((format!("runs[{i}].window_s"), run.window_s.is_some(), windows));
            keys.push((run_field(i, "sensor"), run.sensor.is_some(), windows));
            keys.push((run_field(i, "fitting"), run.fitting.is_some(), windows));
            let curves = ReversalCurves.word();
            keys.push((format!("runs[{i}].calibration"), run.calibration.is_some(), curves));
        }
        for (key, given, belongs) in keys {
            if given && !belongs.contains(kind.word()) {
                let fault = RecordFault::KeyOfOtherKind { belongs, kind: kind.word() };
                self.problems.push(self.index.place(&key), fault.into());
            }
        }
    }

    /// A range of `dataset.ron`, checked.
    pub(crate) fn check_range(&mut self, key: &str, range: (f64, f64)) -> Option<(f64, f64)> {
        let (low, high) = range;
        if low.is_finite() && high.is_finite() && low < high {
            return Some(range);
        }
        self.problems.push(self.index.place(key), Fault::EmptyRange { low, high });
        None
    }
}

/// What the records of all kinds share in `dataset.ron`.
pub(crate) fn run_field(number: usize, key: &str) -> String {
    format!("runs[{number}].{key}")
}

fn is_plain(file: &str) -> bool {
    let mut components = Path::new(file).components();
    matches!(components.next(), Some(Component::Normal(_)))
        && components.all(|c| matches!(c, Component::Normal(_)))
}

/// The runs of a data set with their numbers.
pub(crate) fn numbered(runs: &[RunFile]) -> Vec<(usize, RunFile)> {
    runs.iter().cloned().enumerate().collect()
}
