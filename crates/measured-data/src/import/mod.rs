//! `hhc import`: measured data of other formats into a data folder.
//!
//! A source is recognised by its first bytes, read, checked, brought into the units of the data folder,
//! averaged down to a bounded number of samples if it has more, and written as `dataset.ron` with one
//! CSV table per run: the whole folder or nothing.

mod columns;
mod folder;
mod gather;
mod in_memory;
mod mapping;
mod mat;
mod micromag;
mod record;
mod sweep;
mod tdms;
mod text;
mod workbook;

pub use columns::ColumnOptions;
pub use folder::{ImportResult, ImportedRun};
pub use mapping::{deg_per_um_of_arm, import_mapped};
pub use mat::{MatValue, Variables, mat_file, read_variables};
pub use record::{EvenRecord, RecordColumn};

use crate::dataset::DatasetKind;
use crate::error::DataError;
use crate::files::{Folder, STANDARD_INPUT, Source, open_reader};
use crate::problem::{Fault, Place, Problem, Problems};
use columns::{Choice, no_effect};
use flate2::read::MultiGzDecoder;
use gather::{Gathered, Reduction};
use serde::{Deserialize, Serialize};
use std::io::{BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

/// The formats data are imported from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SourceKind {
    /// Text table, with or without a header.
    Csv,
    /// MAT file of level 5 (`save -v7`) or 4.
    Mat,
    /// TDMS file of `LabVIEW`.
    Tdms,
    /// First-order reversal curves of a MicroMag 2900/3900 magnetometer.
    MicromagForc,
}

impl SourceKind {
    /// The format in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Csv => "text table",
            Self::Mat => "MAT file",
            Self::Tdms => "TDMS file",
            Self::MicromagForc => "MicroMag FORC file",
        }
    }
}

/// The kinds of data folder records can be imported into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum ImportKind {
    /// Command, V, to displacement, um, of an actuator.
    ActuatorBench,
    /// Any input to any output, in their own units.
    GenericLoop,
    /// Points of test of a rotor, one row each.
    RotorSweep,
    /// Frequencies of a blade, one row for each mode at each rotor speed.
    BladeFrequencies,
    /// Loads of an oscillating section, one row for each motion, or histories.
    SectionLoops,
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
    /// Flap angle per displacement, deg/um, of an actuator bench.
    pub deg_per_um: Option<f64>,
    /// Whether a file is parted into runs, at rests, gaps of time and where the time begins again.
    pub split: bool,
}

/// Most samples of a run if the user does not say it.
pub const MOST_SAMPLES: usize = 1 << 18;

/// What the columns of a source are read into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reading {
    /// A run of a data folder: of this kind, or of the one they make.
    Folder(Option<ImportKind>),
    /// A record of its own, with every column in its unit.
    Record,
}

/// The records read from a source: one unless it was parted.
struct Table {
    parts: Vec<Gathered>,
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
    if let (Some(kind), Some(path)) = (sweep::asked_for(request), request.files.first()) {
        let refused = |fault| Problem::new(Place::file(path.display().to_string()), fault);
        refuse_without_effect(request, &[], "this is a table of points of test")
            .map_err(refused)?;
        return sweep::import_sweep(request, path, kind);
    }
    let mut problems = Problems::default();
    let mut sources = Vec::new();
    if let [a, b] = &request.files[..]
        && let Some(source) = read_joined([a, b], request)?
    {
        return folder::write(request, vec![source]);
    }
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
    let mut problems = Problems::default();
    let place = |option: &str| Place::file("hhc import").field(option);
    for (option, value) in
        [("--sampling-hz", request.sampling_hz), ("--reduce-to-hz", request.reduce_to_hz)]
    {
        if let Some(fault) = value.and_then(fault_of_rate) {
            problems.push(place(option), fault);
        }
    }
    let (low, high) = (64, 1 << 24);
    if !(low..=high).contains(&request.most_samples) {
        let (value, remedy) = (request.most_samples as f64, "leave it out for 262144");
        let (low, high, unit) = (low as f64, high as f64, "");
        let fault = Fault::OutOfRange { value, low, high, unit, remedy };
        problems.push(place("--max-samples"), fault);
    }
    if let Some(fault) = request.range.and_then(Fault::of_range) {
        problems.push(place("--range"), fault);
    }
    if let Some(value) = request.deg_per_um.filter(|v| !(v.is_finite() && *v > 0.0)) {
        let remedy =
            "give the angle of the flap for a um of the actuator, or its lever with --arm-mm";
        problems.push(place("--deg-per-um"), Fault::NotPositive { value, unit: "deg/um", remedy });
    }
    problems.into_result(Some(()))
}

/// What is wrong with a rate, Hz; none if it can be one.
fn fault_of_rate(value: f64) -> Option<Fault> {
    let remedy = "give the frequency, or leave it out";
    let is_rate = value.is_finite() && value > 0.0;
    (!is_rate).then_some(Fault::NotPositive { value, unit: "Hz", remedy })
}

/// Refuses options that mean nothing for a source; `words` say what it is.
fn refuse_without_effect(request: &ImportRequest, of: &[Taken], words: &str) -> Result<(), Fault> {
    let columns = &request.columns;
    let given = [
        (Taken::Variable, "--variable", request.variable.is_some()),
        (Taken::Columns, "--columns", columns.columns.is_some()),
        (Taken::Columns, "--input", columns.input.is_some()),
        (Taken::Columns, "--response", columns.response.is_some()),
        (Taken::Columns, "--convert", columns.convert.is_some()),
        (Taken::Columns, "--scale", columns.scale.is_some()),
        (Taken::Columns, "--offset", columns.offset.is_some()),
        (Taken::Samples, "--range", request.range.is_some()),
        (Taken::Samples, "--sampling-hz", request.sampling_hz.is_some()),
        (Taken::Samples, "--reduce-to-hz", request.reduce_to_hz.is_some()),
        (Taken::Samples, "--split", request.split),
        (Taken::Samples, "--deg-per-um", request.deg_per_um.is_some()),
    ];
    let idle = given.into_iter().find(|(needs, _, is_given)| *is_given && !of.contains(needs));
    idle.map_or(Ok(()), |(_, option, _)| Err(no_effect(option, words, "leave it out")))
}

/// What of a source options may speak of.
#[derive(Clone, Copy, PartialEq)]
enum Taken {
    /// One of its variables.
    Variable,
    /// Its columns.
    Columns,
    /// Samples in time.
    Samples,
}

impl SourceKind {
    /// What options may speak of.
    fn takes(self) -> &'static [Taken] {
        match self {
            Self::Csv | Self::Tdms => &[Taken::Columns, Taken::Samples],
            Self::Mat => &[Taken::Variable, Taken::Columns, Taken::Samples],
            Self::MicromagForc => &[],
        }
    }
}

/// The first bytes of a gzip archive.
const GZIP: &[u8] = b"\x1f\x8b";
/// Bytes by which a source is recognised, HDF5 by up to 65,544: its signature may stand behind a block of the user.
const RECOGNISED: usize = 1024;
const START: u64 = 65_544;
/// Most bytes of a source that is read whole.
const LARGEST_WHOLE: u64 = 1 << 30;

/// A source that was opened: unpacked, as UTF-8 where it is text.
struct OpenSource {
    name: String,
    kind: SourceKind,
    reader: Box<dyn BufRead>,
    /// What was unpacked, in words.
    packed: &'static str,
}

impl OpenSource {
    fn open(path: &Path, kind: Option<SourceKind>) -> Result<Self, Problem> {
        if path.as_os_str() == STANDARD_INPUT {
            let reader = Box::new(BufReader::new(std::io::stdin()));
            return Self::of(reader, Path::new("standard input"), kind);
        }
        Self::of(Box::new(open_reader(path)?), path, kind)
    }

    /// Opens what a reader gives; `path` names it.
    fn of(
        mut reader: Box<dyn BufRead>,
        path: &Path,
        kind: Option<SourceKind>,
    ) -> Result<Self, Problem> {
        let name = path.display().to_string();
        let refused = |fault| Problem::new(Place::file(&name), fault);
        let whole = |reader: &mut dyn BufRead| {
            let bytes = read_at_most(reader, LARGEST_WHOLE + 1).map_err(|e| refused(e.into()))?;
            refuse_large(&bytes).map_err(refused)?;
            Ok::<_, Problem>(bytes)
        };
        let mut packed = "";
        if reader.fill_buf().map_err(|e| refused(e.into()))?.starts_with(GZIP) {
            reader = Box::new(BufReader::new(MultiGzDecoder::new(reader)));
            packed = ", unpacked";
        }
        if reader.fill_buf().map_err(|e| refused(e.into()))?.starts_with(workbook::MAGIC) {
            let sheet = workbook::read_sheet(&whole(&mut reader)?).map_err(refused)?;
            reader = Box::new(Cursor::new(sheet.into_bytes()));
            packed = ", the largest sheet of a workbook";
        }
        let start = read_at_most(&mut reader, START).map_err(|e| refused(e.into()))?;
        let mut reader: Box<dyn BufRead> = Box::new(Cursor::new(start.clone()).chain(reader));
        let mut head = start;
        if let Some(is_little) = text::utf16(&head[..head.len().min(RECOGNISED)]) {
            let text = text::from_utf16(&whole(&mut reader)?, is_little).into_bytes();
            head = text.iter().copied().take(RECOGNISED).collect();
            reader = Box::new(Cursor::new(text));
        }
        let kind = match kind {
            Some(kind) => kind,
            None => recognise(&head, path).map_err(refused)?,
        };
        Ok(Self { name, kind, reader, packed })
    }
}

/// Two text tables of a time and one channel each as one record; none of other files.
fn read_joined(
    paths: [&PathBuf; 2],
    request: &ImportRequest,
) -> Result<Option<ReadSource>, Problems> {
    if paths.iter().any(|path| path.as_os_str() == STANDARD_INPUT) {
        return Ok(None);
    }
    let open = |path: &PathBuf| {
        let source = OpenSource::open(path, request.source).ok()?;
        let is_text = source.kind == SourceKind::Csv;
        let opened = is_text.then(|| text::Opened::open(source.reader, &source.name).ok())??;
        opened.is_single().then_some((opened, source.name))
    };
    let Some(((a, name), (b, _))) = open(paths[0]).zip(open(paths[1])) else { return Ok(None) };
    let both = a.beside(b, &name)?;
    let into = Reading::Folder(request.kind);
    let table = text::read_csv(both, &name, &request.columns, into, request.reduction())?;
    Ok(Some(ReadSource {
        path: paths[0].clone(),
        kind: SourceKind::Csv,
        recognised: format!("text table, joined with that of {}", paths[1].display()),
        imported: Imported::Record(Box::new(table)),
    }))
}

impl ImportRequest {
    fn reduction(&self) -> Reduction {
        Reduction {
            // halving needs an even number
            most_samples: self.most_samples & !1,
            reduce_to_hz: self.reduce_to_hz,
            sampling_hz: self.sampling_hz,
            split: self.split,
        }
    }
}

fn refuse_large(bytes: &[u8]) -> Result<(), Fault> {
    if bytes.len() as u64 <= LARGEST_WHOLE {
        return Ok(());
    }
    let [megabytes, limit_megabytes] =
        [bytes.len() as u64, LARGEST_WHOLE].map(|bytes| bytes / 1_000_000);
    Err(Fault::TooLarge { megabytes, limit_megabytes })
}

fn read_source(path: &Path, request: &ImportRequest) -> Result<ReadSource, Problems> {
    let source = OpenSource::open(path, request.source)?;
    let kind = source.kind;
    let words = format!("this is a {}", kind.words());
    refuse_without_effect(request, kind.takes(), &words)
        .map_err(|fault| Problem::new(Place::file(&source.name), fault))?;
    let which = (&request.columns, request.variable.as_deref());
    let (imported, recognised) =
        source.imported(which, Reading::Folder(request.kind), request.reduction())?;
    Ok(ReadSource { path: path.to_path_buf(), kind, recognised, imported })
}

impl OpenSource {
    /// What it holds; also what was recognised, in words. `which`: its columns, and the variable of a MAT file.
    fn imported(
        self,
        which: (&ColumnOptions, Option<&str>),
        into: Reading,
        reduction: Reduction,
    ) -> Result<(Imported, String), Problems> {
        let Self { name, kind, mut reader, packed } = self;
        let refused = |fault| Problem::new(Place::file(&name), fault);
        let recognised = format!("{}{packed}", kind.words());
        if kind == SourceKind::Csv {
            let opened = text::Opened::open(reader, &name)?;
            let recognised = format!("{recognised}, {}", opened.words());
            let table = text::read_csv(opened, &name, which.0, into, reduction)?;
            return Ok((Imported::Record(Box::new(table)), recognised));
        }
        let bytes = read_at_most(&mut reader, LARGEST_WHOLE + 1);
        let bytes = bytes.map_err(|e| refused(e.into()))?;
        refuse_large(&bytes).map_err(refused)?;
        let (table, taken) = match kind {
            SourceKind::Mat => mat::read_mat(&bytes, &name, which, into, reduction)?,
            SourceKind::Tdms => {
                let found = tdms::read_tdms(&bytes).map_err(refused)?;
                found.table(&name, which.0, into, reduction)?
            }
            SourceKind::Csv | SourceKind::MicromagForc => {
                let text = String::from_utf8(bytes).map_err(|e| {
                    refused(Fault::NotText { offset: e.utf8_error().valid_up_to() })
                })?;
                let curves = micromag::read_micromag(&Source { name: name.clone(), text })?;
                return Ok((Imported::Curves(curves), recognised));
            }
        };
        Ok((Imported::Record(Box::new(table)), format!("{recognised}, {taken}")))
    }
}

fn read_at_most(reader: &mut (impl Read + ?Sized), most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A whole number that was computed or written as a decimal one.
fn whole(value: f64) -> usize {
    format!("{value:.0}").parse().unwrap_or(usize::MAX)
}

/// The format by the first bytes.
///
/// # Errors
/// What to do with a format that is not read.
fn recognise(start: &[u8], path: &Path) -> Result<SourceKind, Fault> {
    let named_mat = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("mat"));
    if let Some(byte_order) = mat::byte_order(start, named_mat) {
        return byte_order.map(|_| SourceKind::Mat);
    }
    let start = &start[..start.len().min(RECOGNISED)];
    if start.starts_with(tdms::MAGIC) {
        return Ok(SourceKind::Tdms);
    }
    if micromag::is_micromag(start) {
        return Ok(SourceKind::MicromagForc);
    }
    if let Some(fault) = text::foreign(start) {
        return Err(fault);
    }
    if text::is_text(start) && !named_mat {
        return Ok(SourceKind::Csv);
    }
    let message = "is not recognised as a text table, MAT, TDMS or a MicroMag FORC file; export the record as CSV, or say what it is with --as";
    Err(Fault::Other(message.to_owned()))
}

/// The kind of folder a source goes into.
fn folder_kind(imported: &Imported) -> DatasetKind {
    match imported {
        Imported::Curves(_) => DatasetKind::ReversalCurves,
        Imported::Record(table) => match table.choice.kind {
            ImportKind::ActuatorBench => DatasetKind::ActuatorBench,
            // points are no record: they are imported before
            _ => DatasetKind::GenericLoop,
        },
    }
}

/// The folder used if the user names none: the name of the first file without its ending.
pub fn default_folder(file: &Path) -> PathBuf {
    let stem = file.file_stem().map(PathBuf::from).unwrap_or_default();
    let stem = if stem.as_os_str() == STANDARD_INPUT { "record".into() } else { stem };
    let taken = Folder::Disk(PathBuf::new()).contains(&stem.display().to_string());
    // a file without an ending would be in the way of its own folder
    if taken || stem.as_os_str().is_empty() {
        PathBuf::from(format!("{}_data", stem.display()))
    } else {
        stem
    }
}
