//! What the options of an import say, as a small RON file to keep beside recordings of one kind.
//!
//! ```text
//! (
//!     columns: [
//!         (name: "time_s", from: "Zeit"),
//!         (name: "command_V", from: "#2", scale: 15),
//!         (name: "displacement_um", from: "Laser", scale: 100, offset: -30000),
//!     ],
//!     sampling_hz: 10000,
//! )
//! ```

use super::{
    ColumnOptions, ImportKind, ImportRequest, ImportResult, MOST_SAMPLES, SourceKind, import,
};
use crate::error::DataError;
use crate::files::{RonFile, RonIndex, Source, read_ron};
use crate::problem::{Fault, Problems};
use crate::tables::{Channel, unknown_unit};
use serde::Deserialize;
use std::path::Path;

/// A format as the file spells it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
enum FormatName {
    Csv,
    Mat,
    Tdms,
    MicromagForc,
}

/// A column that is taken.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct ColumnMap {
    /// Name with unit under which it is written.
    name: String,
    /// Its header, MAT field or `#number` in the recording; the name if left out.
    #[serde(default)]
    from: Option<String>,
    /// What the recorder divided by; 1 if left out.
    #[serde(default)]
    scale: Option<f64>,
    /// What is added then, in the unit of the name; 0 if left out.
    #[serde(default)]
    offset: Option<f64>,
    /// Unit to convert into, of generic loops.
    #[serde(default)]
    convert: Option<String>,
}

/// The file.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct MappingFile {
    /// The columns taken.
    columns: Vec<ColumnMap>,
    /// Format of the files.
    format: Option<FormatName>,
    /// Kind of the data folder.
    kind: Option<ImportKind>,
    /// Name of the input of a generic loop.
    input: Option<String>,
    /// Name of the output of a generic loop.
    response: Option<String>,
    /// Variable of a MAT file.
    variable: Option<String>,
    /// Range of the input.
    range: Option<(f64, f64)>,
    /// Sampling frequency of files without a time, Hz.
    sampling_hz: Option<f64>,
    /// Sampling frequency to average down to, Hz.
    reduce_to_hz: Option<f64>,
    /// Most samples of a run.
    max_samples: Option<usize>,
    /// Title of the data set.
    title: Option<String>,
    /// Flap angle per displacement, deg/um.
    deg_per_um: Option<f64>,
    /// Lever from the actuator to the hinge, mm.
    arm_mm: Option<f64>,
    /// Whether files are parted into runs.
    split: bool,
}

/// What a column says, as an entry of the option of this meaning, from its name.
type Entry<'a> = &'a dyn Fn(&ColumnMap, &str) -> Option<String>;

/// A mapping that was read and checked.
struct Mapping {
    file: MappingFile,
    index: RonIndex,
}

/// Imports with what a mapping says; what the request says itself goes before it, a scale, an offset or a unit of a column
/// before that of this column alone.
///
/// # Errors
/// Every problem of the mapping with its line and field; a column that a file lacks, there too; what it says of a column that
/// the request does not take; those of [`import`].
pub fn import_mapped(request: ImportRequest, mapping: &Path) -> Result<ImportResult, DataError> {
    let mapping = Mapping::read(&Source::read(mapping)?)?;
    let takes_columns = request.columns.columns.is_none();
    let request = mapping.completed(request)?;
    import(&request).map_err(|error| match error {
        DataError::Rejected(problems) if takes_columns => mapping.placed(problems).into(),
        other => other,
    })
}

impl Mapping {
    fn read(source: &Source) -> Result<Self, Problems> {
        let RonFile { value, index, mut problems } = read_ron::<MappingFile>(source);
        if let Some(file) = &value {
            check(file, &index, &mut problems);
        }
        problems.into_result(value.map(|file| Self { file, index }))
    }

    /// A request with what it leaves open.
    fn completed(&self, mut request: ImportRequest) -> Result<ImportRequest, Problems> {
        let Self { file, .. } = self;
        let source = |format| match format {
            FormatName::Csv => SourceKind::Csv,
            FormatName::Mat => SourceKind::Mat,
            FormatName::Tdms => SourceKind::Tdms,
            FormatName::MicromagForc => SourceKind::MicromagForc,
        };
        request.source = request.source.or(file.format.map(source));
        request.kind = request.kind.or(file.kind);
        request.variable = request.variable.or(file.variable.clone());
        request.range = request.range.or(file.range);
        request.sampling_hz = request.sampling_hz.or(file.sampling_hz);
        request.reduce_to_hz = request.reduce_to_hz.or(file.reduce_to_hz);
        if request.most_samples == MOST_SAMPLES {
            request.most_samples = file.max_samples.unwrap_or(MOST_SAMPLES);
        }
        request.title = request.title.or(file.title.clone());
        let of_arm = file.arm_mm.map(deg_per_um_of_arm);
        request.deg_per_um = request.deg_per_um.or(file.deg_per_um).or(of_arm);
        request.split |= file.split;
        let columns = &mut request.columns;
        columns.input = columns.input.take().or(file.input.clone());
        columns.response = columns.response.take().or(file.response.clone());
        let mut problems = Problems::default();
        self.complete(columns, &mut problems);
        problems.into_result(Some(request))
    }

    /// Takes up the columns, and of each its factor, offset and unit where the options say none of it.
    fn complete(&self, columns: &mut ColumnOptions, problems: &mut Problems) {
        let own = &self.file.columns;
        if columns.columns.is_none() && !own.is_empty() {
            let source = |own: &ColumnMap| own.from.clone().unwrap_or(own.name.clone());
            let entries = own.iter().map(|own| format!("{}={}", own.name, source(own)));
            columns.columns = Some(entries.collect::<Vec<_>>().join(","));
        }
        let taken: Vec<String> = entries_of(columns.columns.as_ref())
            .filter_map(|entry| Channel::parse(entry.split('=').next()?))
            .map(|channel| channel.label())
            .collect();
        let numbered = |name: &str, number: Option<f64>| Some(format!("{name}={}", number?));
        let lists: [(&str, &mut Option<String>, Entry<'_>); 3] = [
            ("scale", &mut columns.scale, &|own, name| numbered(name, own.scale)),
            ("offset", &mut columns.offset, &|own, name| numbered(name, own.offset)),
            ("convert", &mut columns.convert, &|own, name| {
                Some(format!("{name}_{}", own.convert.as_ref()?))
            }),
        ];
        for (key, list, entry) in lists {
            let said: Vec<String> = entries_of(list.as_ref()).filter_map(column_of).collect();
            let mut entries = Vec::new();
            for (i, own) in own.iter().enumerate() {
                let Some(channel) = Channel::parse(&own.name) else { continue };
                let Some(entry) = entry(own, &channel.name) else { continue };
                if said.contains(&channel.name) {
                    continue;
                }
                if !taken.contains(&channel.label()) {
                    let message = format!(
                        "is said of `{label}`, which --columns does not take; take it so: {label}=SOURCE, give --{key} for it, or leave --mapping out",
                        label = channel.label()
                    );
                    let place = self.index.place(&format!("columns[{i}].{key}"));
                    problems.push(place, Fault::Refused { message });
                }
                entries.push(entry);
            }
            entries.extend(list.take());
            *list = (!entries.is_empty()).then(|| entries.join(","));
        }
    }

    /// The problems of an import, those of columns that are missing at the lines that name them too.
    fn placed(&self, problems: Problems) -> Problems {
        let mut all = Problems::default();
        for problem in problems.as_slice() {
            let Fault::MissingColumn { wanted, found, .. } = &problem.fault else { continue };
            let names = |own: &ColumnMap| own.from.as_ref().unwrap_or(&own.name) == wanted;
            let Some(at) = self.file.columns.iter().position(names) else { continue };
            let key = if self.file.columns[at].from.is_some() { "from" } else { "name" };
            let message = format!(
                "names the column `{wanted}`, which {} does not have; it has {found}; correct it, or give its place as \"#1\", \"#2\", ...",
                problem.place.file
            );
            let place = self.index.place(&format!("columns[{at}].{key}"));
            all.push(place, Fault::Refused { message });
        }
        all.append(problems);
        all
    }
}

/// The entries of a list of an option.
fn entries_of(list: Option<&String>) -> impl Iterator<Item = &str> {
    list.into_iter().flat_map(|text| text.split(',')).map(str::trim)
}

/// The column that an entry of `--scale`, `--offset` or `--convert` is of.
fn column_of(entry: &str) -> Option<String> {
    match entry.split_once('=') {
        Some((name, _)) => Some(name.trim().to_owned()),
        None => Channel::parse(entry).map(|channel| channel.name),
    }
}

/// Flap angle per displacement of a lever, deg/um.
pub fn deg_per_um_of_arm(arm_mm: f64) -> f64 {
    (1e-3 / arm_mm).to_degrees()
}

/// Notes what makes no sense in a mapping.
fn check(file: &MappingFile, index: &RonIndex, problems: &mut Problems) {
    let mut refuse = |path: String, fault: Fault| problems.push(index.place(&path), fault);
    let mut before: Vec<String> = Vec::new();
    for (i, column) in file.columns.iter().enumerate() {
        let at = |key: &str| format!("columns[{i}].{key}");
        match Channel::parse(&column.name) {
            None => refuse(at("name"), unknown_unit(&column.name)),
            Some(channel) if before.contains(&channel.name) => {
                let message = format!("`{}` is taken twice; remove one of them", channel.name);
                refuse(at("name"), Fault::Refused { message });
            }
            Some(channel) => before.push(channel.name),
        }
        if column.name.contains([',', '=']) || column.from.as_ref().is_some_and(|f| !is_plain(f)) {
            let key = if column.name.contains([',', '=']) { "name" } else { "from" };
            let message = "is empty or holds a comma or an equals sign; give the place of the column: \"#1\", \"#2\", ...";
            refuse(at(key), Fault::Refused { message: message.to_owned() });
        }
        if let Some(scale) = column.scale.filter(|scale| !scale.is_finite() || scale.abs() <= 0.0) {
            let message = format!("is {scale}, expected a finite number other than 0");
            refuse(at("scale"), Fault::Refused { message });
        }
        if let Some(value) = column.offset.filter(|offset| !offset.is_finite()) {
            refuse(at("offset"), Fault::NotFinite { value });
        }
        let name = Channel::parse(&column.name).map(|channel| channel.name);
        let converted = name.zip(column.convert.as_ref()).map(|(n, unit)| format!("{n}_{unit}"));
        if let Some(label) = converted.filter(|label| Channel::parse(label).is_none()) {
            refuse(at("convert"), unknown_unit(&label));
        }
    }
    let remedy = "correct it, or leave it out";
    for (key, value, unit) in [
        ("sampling_hz", file.sampling_hz, "Hz"),
        ("reduce_to_hz", file.reduce_to_hz, "Hz"),
        ("deg_per_um", file.deg_per_um, "deg/um"),
        ("arm_mm", file.arm_mm, "mm"),
    ] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            refuse(key.to_owned(), Fault::NotPositive { value, unit, remedy });
        }
    }
    if file.deg_per_um.is_some() && file.arm_mm.is_some() {
        let message = "says the same as deg_per_um; leave one of them out".to_owned();
        refuse("arm_mm".to_owned(), Fault::Refused { message });
    }
    if let Some(fault) = file.range.and_then(Fault::of_range) {
        refuse("range".to_owned(), fault);
    }
}

/// Whether a text can stand as a source in a list of columns.
fn is_plain(text: &str) -> bool {
    !text.trim().is_empty() && !text.contains([',', '='])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write_atomic;
    use std::fmt::Write;

    const MAP: &str = "(
    columns: [
        (name: \"time_s\", from: \"Zeit\"),
        (name: \"command_V\", from: \"#3\", scale: 15),
        (name: \"displacement_um\", from: \"Laser\", scale: 100, offset: -300),
    ],
    title: \"a bench\",
    arm_mm: 1.45,
)";

    /// Imports one recording with a mapping; the folder's record and description.
    fn tried(map: &str, own: ColumnOptions) -> Result<[String; 2], String> {
        let folder = tempfile::tempdir().unwrap();
        let mut table = "Zeit;Laser;Ch 2;spare\n".to_owned();
        for i in 0..200 {
            let volt = 4.0 + 3.0 * (0.1 * f64::from(i)).sin();
            writeln!(table, "{};{};{volt};x", 0.01 * f64::from(i), 0.2 * volt + 3.0).unwrap();
        }
        let path = |name: &str| folder.path().join(name);
        write_atomic(&path("a.txt"), table.as_bytes()).unwrap();
        write_atomic(&path("map.ron"), map.as_bytes()).unwrap();
        let request = ImportRequest {
            files: vec![path("a.txt")],
            out: path("out"),
            source: None,
            kind: None,
            columns: own,
            variable: None,
            range: None,
            sampling_hz: None,
            reduce_to_hz: None,
            most_samples: MOST_SAMPLES,
            title: None,
            deg_per_um: None,
            split: false,
        };
        let done = import_mapped(request, &path("map.ron")).map_err(|e| e.to_string());
        assert_eq!(done.is_ok(), path("out").exists(), "nothing is half-written");
        let text = |name: &str| Source::read(&path(name)).map(|source| source.text);
        done.map(|_| [text("out/a.csv").unwrap(), text("out/dataset.ron").unwrap()])
    }

    #[test]
    fn a_mapping_says_what_the_options_say() {
        let [record, dataset] = tried(MAP, ColumnOptions::default()).unwrap();
        // 15 x 4 V, and 100 x 3.8 - 300 um
        assert!(record.starts_with("time_s,command_V,displacement_um\n0,60,80\n"), "{record}");
        assert!(
            dataset.contains("title: \"a bench\"") && dataset.contains("0.039514"),
            "{dataset}"
        );
        assert!(
            dataset.contains("command x 15, displacement x 100, displacement -300"),
            "{dataset}"
        );
        // an option goes before what the mapping says of its column, and leaves the others alone
        let own = ColumnOptions { scale: Some("command=1".into()), ..ColumnOptions::default() };
        let [record, _] = tried(MAP, own).unwrap();
        assert!(record.contains("\n0,4,80\n"), "{record}");
        let own = ColumnOptions { offset: Some("command=2".into()), ..ColumnOptions::default() };
        let [record, _] = tried(MAP, own).unwrap();
        assert!(record.contains("\n0,62,80\n"), "{record}");
        // other sources of the same columns keep their factors
        let columns = |text: &str| ColumnOptions {
            columns: Some(text.to_owned()),
            ..ColumnOptions::default()
        };
        let [record, _] =
            tried(MAP, columns("time_s=Zeit,command_V=#2,displacement_um=#3")).unwrap();
        assert!(record.contains("\n0,57,100\n"), "{record}");
        let said = tried(MAP, columns("time_s=Zeit,command_V=#3,displacement_mm=#2")).unwrap_err();
        assert!(said.contains("map.ron:5:"), "{said}");
        assert!(
            said.contains("columns[2].offset: is refused: is said of `displacement_um`"),
            "{said}"
        );
        assert!(!said.contains("command"), "{said}");
    }

    #[test]
    fn what_is_wrong_has_file_line_and_field() {
        let said = |from: &str, to: &str| {
            let map = MAP.replacen(from, to, 1);
            assert_ne!(map, MAP);
            tried(&map, ColumnOptions::default()).unwrap_err()
        };
        for (from, to, place, part) in [
            (
                "\"Laser\"",
                "\"Lasr\"",
                "map.ron:5:",
                "columns[2].from: is refused: names the column `Lasr`",
            ),
            ("command_V", "command_furlong", "map.ron:4:", "columns[1].name"),
            ("scale: 15", "scale: 0", "map.ron:4:", "columns[1].scale: is refused: is 0, expected"),
            ("scale: 15", "scal: 15", "map.ron:4:", "unknown key `scal`"),
            (
                "\"Zeit\"",
                "\"a, b\"",
                "map.ron:3:",
                "columns[0].from: is refused: is empty or holds",
            ),
            ("arm_mm: 1.45", "arm_mm: -1", "map.ron:8:", "arm_mm: is -1 mm, expected a positive"),
            ("command_V", "time_ms", "map.ron:4:", "`time` is taken twice"),
            ("title", "sampling_hz: 100, title", "a.txt", "the file has a time column"),
        ] {
            let text = said(from, to);
            assert!(text.contains(place) && text.contains(part), "{part}: {text}");
        }
        let text = said("\"Laser\"", "\"Lasr\"");
        assert!(text.contains("it has Zeit, Laser, Ch 2, spare"), "{text}");
    }
}
