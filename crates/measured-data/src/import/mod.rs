//! `hhc import`: measured data of other formats into a data folder.
//!
//! A source is recognised by its first bytes, read, checked, brought into the units of the data folder,
//! averaged down to a bounded number of samples if it has more, and written as `dataset.ron` with one
//! CSV table per run: the whole folder or nothing.

mod columns;
mod csv_source;
mod folder;
mod gather;
mod mat;
mod micromag;

pub use columns::ColumnOptions;
pub use folder::{ImportResult, ImportedRun};

use crate::dataset::DatasetKind;
use crate::error::DataError;
use crate::files::{Folder, Source, open_reader};
use crate::problem::{Place, Problem, Problems, RecordFault};
use columns::{Choice, Shape};
use gather::{Gathered, Reduction};
use mat::MatLevel;
use serde::Serialize;
use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

/// The formats data are imported from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SourceKind {
    /// Text table, with or without a header.
    Csv,
    /// MAT file of level 5 (`save -v7`).
    Mat,
    /// First-order reversal curves of a MicroMag 2900/3900 magnetometer.
    MicromagForc,
}

impl SourceKind {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Csv, Self::Mat, Self::MicromagForc];

    /// The word that names the format.
    pub fn word(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Mat => "mat",
            Self::MicromagForc => "micromag-forc",
        }
    }

    /// The format in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Csv => "text table",
            Self::Mat => "MAT file of level 5",
            Self::MicromagForc => "MicroMag FORC file",
        }
    }
}

/// The kinds of data folder records can be imported into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImportKind {
    /// Command, V, to displacement, um, of an actuator.
    ActuatorBench,
    /// Any input to any output, in their own units.
    GenericLoop,
}

impl ImportKind {
    /// Every kind.
    pub const ALL: [Self; 2] = [Self::ActuatorBench, Self::GenericLoop];

    /// The word that names the kind.
    pub fn word(self) -> &'static str {
        match self {
            Self::ActuatorBench => "actuator-bench",
            Self::GenericLoop => "generic-loop",
        }
    }
}

/// What to import and how.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportRequest {
    /// The files; each becomes a run.
    pub files: Vec<PathBuf>,
    /// Folder to write.
    pub out: PathBuf,
    /// Format of the files; recognised if none.
    pub source: Option<SourceKind>,
    /// Kind of the folder; none: an actuator bench if there are `command` and `displacement` and no
    /// input or response is named, else a generic loop.
    pub kind: Option<ImportKind>,
    /// Which columns, in which units.
    pub columns: ColumnOptions,
    /// Variable of a MAT file, such as `bench.run(2)`.
    pub variable: Option<String>,
    /// Range of the command (V) or the input (its unit); none: from the smallest to the largest.
    pub range: Option<(f64, f64)>,
    /// Sampling frequency of sources without a time, Hz.
    pub sampling_hz: Option<f64>,
    /// Sampling frequency the records are averaged down to, Hz.
    pub reduce_to_hz: Option<f64>,
    /// Most samples of a run.
    pub most_samples: usize,
    /// Title of the data set; made of the file names if none.
    pub title: Option<String>,
}

/// Most samples of a run if the user does not say it.
pub const MOST_SAMPLES: usize = 1 << 18;

/// A record read from a source.
struct Table {
    gathered: Gathered,
    choice: Choice,
}

/// What a source holds.
enum Imported {
    Record(Box<Table>),
    Curves(micromag::MicroMag),
}

/// A source that was read.
struct ReadSource {
    path: PathBuf,
    kind: SourceKind,
    /// What was recognised, in words.
    recognised: String,
    imported: Imported,
}

/// Imports measured data into a new data folder.
///
/// # Errors
/// [`DataError::Rejected`] with every problem found, [`DataError::WouldOverwrite`],
/// [`DataError::NotWritten`]; then nothing is written.
pub fn import(request: &ImportRequest) -> Result<ImportResult, DataError> {
    if request.out.exists() {
        return Err(DataError::WouldOverwrite { path: request.out.clone() });
    }
    check_request(request)?;
    let mut problems = Problems::default();
    let mut sources = Vec::new();
    for path in &request.files {
        match read_source(path, request) {
            Ok(source) => sources.push(source),
            Err(more) => problems.append(more),
        }
    }
    let sources = problems.into_result(Some(sources))?;
    folder::write(request, sources)
}

/// Refuses numbers no import can be done with.
fn check_request(request: &ImportRequest) -> Result<(), Problems> {
    use crate::problem::Fault;
    let mut problems = Problems::default();
    let place = |option: &str| Place::file("hhc import").field(option);
    for (option, value) in
        [("--sampling-hz", request.sampling_hz), ("--reduce-to-hz", request.reduce_to_hz)]
    {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            let remedy = "give the frequency, or leave it out";
            let fault = Fault::NotPositive { value, unit: "Hz", remedy };
            problems.push(place(option), fault);
        }
    }
    let (low, high) = (64, 1 << 24);
    if !(low..=high).contains(&request.most_samples) {
        let (value, remedy) = (request.most_samples, "leave it out for 262144");
        let fault = Fault::CountOutOfRange { value, low, high, remedy };
        problems.push(place("--max-samples"), fault);
    }
    if let Some((low, high)) = request.range
        && !(low.is_finite() && high.is_finite() && low < high)
    {
        problems.push(place("--range"), Fault::EmptyRange { low, high });
    }
    problems.into_result(Some(()))
}

/// Bytes by which a source is recognised.
const START: usize = 1024;
/// Most bytes of a source that is read whole.
const LARGEST_WHOLE: u64 = 1 << 30;

fn read_source(path: &Path, request: &ImportRequest) -> Result<ReadSource, Problems> {
    let name = path.display().to_string();
    let refused = |fault: RecordFault| Problem::new(Place::file(&name), fault.into());
    let mut reader = open_reader(path)?;
    let start = {
        let mut start = Vec::new();
        let read = (&mut reader).take(START as u64).read_to_end(&mut start);
        read.map_err(|e| {
            let fault = crate::problem::Fault::Unreadable { reason: e.to_string() };
            Problem::new(Place::file(&name), fault)
        })?;
        start
    };
    let recognised = recognise(&start, path);
    if let Some(Err(fault)) = &recognised {
        return Err(refused(fault.clone()).into());
    }
    let ((Some(kind), _) | (None, Some(Ok(kind)))) = (request.source, recognised) else {
        return Err(refused(RecordFault::UnknownSource).into());
    };
    let reduction = Reduction {
        // halving needs an even number
        most_samples: request.most_samples & !1,
        reduce_to_hz: request.reduce_to_hz,
        sampling_hz: request.sampling_hz,
    };
    let shape = request.kind.map(|kind| match kind {
        ImportKind::ActuatorBench => Shape::Bench,
        ImportKind::GenericLoop => Shape::Loop,
    });
    let mut recognised = kind.words().to_owned();
    let mut whole = start.chain(reader);
    let imported = match kind {
        SourceKind::Csv => {
            let table = csv_source::read_csv(whole, &name, &request.columns, shape, reduction)?;
            Imported::Record(Box::new(table))
        }
        SourceKind::Mat => {
            let bytes = read_whole(&mut whole, &name)?;
            let which = (&request.columns, request.variable.as_deref());
            let (table, taken) = mat::read_mat(&bytes, &name, which, shape, reduction)?;
            recognised = format!("{recognised}, {taken}");
            Imported::Record(Box::new(table))
        }
        SourceKind::MicromagForc => {
            let bytes = read_whole(&mut whole, &name)?;
            let text = String::from_utf8(bytes).map_err(|e| {
                let offset = e.utf8_error().valid_up_to();
                Problem::new(Place::file(&name), crate::problem::Fault::NotText { offset })
            })?;
            Imported::Curves(micromag::read_micromag(&Source { name: name.clone(), text })?)
        }
    };
    Ok(ReadSource { path: path.to_path_buf(), kind, recognised, imported })
}

fn read_whole(reader: &mut impl BufRead, name: &str) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    let read = reader.take(LARGEST_WHOLE + 1).read_to_end(&mut bytes);
    read.map_err(|e| {
        let fault = crate::problem::Fault::Unreadable { reason: e.to_string() };
        Problem::new(Place::file(name), fault)
    })?;
    if bytes.len() as u64 > LARGEST_WHOLE {
        let (megabytes, limit_megabytes) =
            (bytes.len() as u64 / 1_000_000, LARGEST_WHOLE / 1_000_000);
        let fault = RecordFault::TooLarge { megabytes, limit_megabytes };
        return Err(Problem::new(Place::file(name), fault.into()));
    }
    Ok(bytes)
}

/// The format by the first bytes; an error for formats that are known but not read.
fn recognise(start: &[u8], path: &Path) -> Option<Result<SourceKind, RecordFault>> {
    let named_mat = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("mat"));
    match mat::mat_level(start, named_mat) {
        Some(MatLevel::Five { .. }) => return Some(Ok(SourceKind::Mat)),
        Some(MatLevel::Four) => return Some(Err(RecordFault::Mat4)),
        Some(MatLevel::Hdf5) => return Some(Err(RecordFault::Hdf5)),
        None => {}
    }
    if micromag::is_micromag(start) {
        return Some(Ok(SourceKind::MicromagForc));
    }
    // text: no control characters but blanks, and no other known notation
    let text = start.iter().all(|b| *b >= 0x20 || matches!(b, b'\t' | b'\n' | b'\r' | 0x0c));
    let notation = start.iter().find(|b| !b.is_ascii_whitespace());
    let other = matches!(notation, Some(b'{' | b'[' | b'<') | None);
    (text && !other && !named_mat).then_some(Ok(SourceKind::Csv))
}

/// The kind of folder a source goes into.
fn folder_kind(imported: &Imported) -> DatasetKind {
    match imported {
        Imported::Curves(_) => DatasetKind::ReversalCurves,
        Imported::Record(table) => match table.choice.shape {
            Shape::Bench => DatasetKind::ActuatorBench,
            Shape::Loop => DatasetKind::GenericLoop,
        },
    }
}

/// The folder used if the user names none: the name of the first file without its ending.
pub fn default_folder(file: &Path) -> PathBuf {
    let stem = file.file_stem().map(PathBuf::from).unwrap_or_default();
    let taken = Folder::Disk(PathBuf::new()).contains(&stem.display().to_string());
    // a file without an ending would be in the way of its own folder
    if taken || stem.as_os_str().is_empty() {
        PathBuf::from(format!("{}_data", stem.display()))
    } else {
        stem
    }
}
