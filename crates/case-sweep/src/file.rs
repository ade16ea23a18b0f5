//! The sweep file: a base case, axes over its fields, and how they are sampled.

use measured_data::problem::{Fault, Place, Problem, Problems};
use measured_data::{Folder, RonIndex, Source, read_ron};
use ron::value::RawValue;
use serde::Deserialize;
use std::collections::BTreeSet;

/// Most cases of one sweep.
pub(crate) const MOST_CASES: usize = 1_000_000;

/// A field of the case and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Path of the field, such as `rotor.gj` or `flaps[0].start_r`.
    pub field: String,
    /// Its values.
    pub values: AxisValues,
    /// Where the field is named.
    pub place: Place,
}

/// The values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisValues {
    /// Values as RON texts, each with its place.
    List(Vec<(String, Place)>),
    /// A range, in the unit of the field. `count` values at equal distances, ends included, belong to a grid.
    Range {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Values of a grid.
        count: Option<usize>,
        /// Where the range stands.
        place: Place,
    },
}

/// How the axes are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum Sampling {
    /// Every value with every other; the last axis changes first.
    #[default]
    Grid,
    /// A Latin hypercube: each axis in `count` parts of equal size, one case in each.
    LatinHypercube {
        /// Number of cases.
        count: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
    /// The rows of a CSV: the n-th case has the n-th value of every axis.
    Rows,
}

/// A sweep file that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepFile {
    /// Its name, for messages.
    pub name: String,
    /// Path of the base case, relative to the folder of the sweep file.
    pub base: String,
    /// Where the base case is named.
    pub base_place: Place,
    /// The axes.
    pub axes: Vec<Axis>,
    /// How they are sampled.
    pub sampling: Sampling,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    base: String,
    #[serde(default)]
    axes: Vec<AxisText>,
    #[serde(default)]
    sampling: Sampling,
    rows: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisText {
    field: String,
    values: Option<Vec<Box<RawValue>>>,
    from: Option<f64>,
    to: Option<f64>,
    count: Option<usize>,
}

/// Reads a sweep file; the CSV it may name is in `folder`.
///
/// # Errors
/// Every problem of the file, each with line, field and remedy.
pub fn read_sweep_file(source: &Source, folder: &Folder) -> Result<SweepFile, Problems> {
    let read = read_ron::<Text>(source);
    let (mut problems, index) = (read.problems, read.index);
    let Some(text) = read.value else { return problems.into_result(None) };
    let mut axes = Vec::new();
    let mut fields = BTreeSet::new();
    for (i, axis) in text.axes.iter().enumerate() {
        let place = index.place(&format!("axes[{i}].field"));
        if !fields.insert(axis.field.clone()) {
            problems
                .push(place, other(&format!("{} is an axis already; give it once", axis.field)));
            continue;
        }
        if let Some(values) = problems.note(axis_values(axis, i, text.sampling, &index)) {
            axes.push(Axis { field: axis.field.clone(), values, place });
        }
    }
    let mut sampling = text.sampling;
    if let Some(file) = text.rows {
        let place = index.place("rows");
        if text.axes.is_empty() && sampling == Sampling::Grid {
            axes = row_axes(&folder.read(&file)?)?;
            sampling = Sampling::Rows;
        } else {
            let message = "rows name their own fields and are all the cases there are; leave axes and sampling out";
            problems.push(place, other(message));
        }
    } else if sampling == Sampling::Rows {
        problems.push(
            index.place("sampling"),
            other("Rows needs a table; give rows: \"FILE.csv\" alone"),
        );
    } else if text.axes.is_empty() {
        let fault =
            Fault::Empty { of: "an axis such as (field: \"advance_ratio\", values: [0.2, 0.3])" };
        problems.push(index.place("axes"), fault);
    }
    if let Sampling::LatinHypercube { count, .. } = sampling
        && !(1..=MOST_CASES).contains(&count)
    {
        let message = format!("has {count} cases, expected 1 to {MOST_CASES}; give another count");
        problems.push(index.place("sampling.count"), other(&message));
    }
    let base_place = index.place("base");
    let name = source.name.clone();
    problems.into_result(Some(SweepFile { name, base: text.base, base_place, axes, sampling }))
}

fn other(message: &str) -> Fault {
    Fault::Other(message.to_owned())
}

fn axis_values(
    axis: &AxisText,
    i: usize,
    sampling: Sampling,
    index: &RonIndex,
) -> Result<AxisValues, Problem> {
    let at = |name: &str| index.place(&format!("axes[{i}].{name}"));
    let refused = |name: &str, message: &str| Err(Problem::new(at(name), other(message)));
    match (&axis.values, axis.from, axis.to) {
        (Some(values), None, None) if axis.count.is_none() => {
            if values.is_empty() {
                return Err(Problem::new(at("values"), Fault::Empty { of: "at least one value" }));
            }
            let place = |k: usize| at(&format!("values[{k}]"));
            let texts = values.iter().enumerate();
            let texts = texts.map(|(k, value)| (value.get_ron().trim().to_owned(), place(k)));
            Ok(AxisValues::List(texts.collect()))
        }
        (None, Some(from), Some(to)) => {
            if !(from.is_finite() && to.is_finite() && from < to) {
                return refused(
                    "from",
                    &format!("{from} to {to} is no range; give the lower end first"),
                );
            }
            let count = axis.count;
            if sampling == Sampling::Grid && !count.is_some_and(|n| (2..=MOST_CASES).contains(&n)) {
                return refused(
                    "count",
                    &format!("a range of a grid has 2 to {MOST_CASES} values; give count: 5"),
                );
            }
            Ok(AxisValues::Range { from, to, count, place: at("from") })
        }
        _ => refused(
            "field",
            "an axis has values: [...], or from, to and count; give one of the two",
        ),
    }
}

/// The columns of a CSV as axes: the header names the fields, cells are RON texts.
fn row_axes(source: &Source) -> Result<Vec<Axis>, Problem> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(source.text.as_bytes());
    let fault = |error: csv::Error| {
        let line = error.position().map(|at| usize::try_from(at.line()).unwrap_or(usize::MAX));
        let place = Place { line, ..Place::file(&source.name) };
        let message = format!("is no table: {error}; give every row a cell for each field");
        Problem::new(place, Fault::Other(message))
    };
    let fields = reader.headers().map_err(fault)?.clone();
    let header = Place { line: Some(1), ..Place::file(&source.name) };
    let mut columns: Vec<Vec<(String, Place)>> = vec![vec![]; fields.len()];
    for row in reader.records() {
        let row = row.map_err(fault)?;
        let line = row.position().map(|at| usize::try_from(at.line()).unwrap_or(usize::MAX));
        for ((column, cell), field) in columns.iter_mut().zip(&row).zip(&fields) {
            let place = Place { line, ..Place::file(&source.name) }.field(field);
            if cell.is_empty() {
                return Err(Problem::new(place, Fault::Empty { of: "a value for each field" }));
            }
            column.push((cell.to_owned(), place));
        }
    }
    if columns.first().is_none_or(Vec::is_empty) {
        let of = "a header of fields and a row for each case";
        return Err(Problem::new(header, Fault::Empty { of }));
    }
    let names: BTreeSet<&str> = fields.iter().collect();
    if names.len() < fields.len() {
        return Err(Problem::new(header, other("names a field twice; give every field once")));
    }
    let axes = fields.iter().zip(columns).map(|(field, values)| Axis {
        field: field.to_owned(),
        values: AxisValues::List(values),
        place: header.clone().field(field),
    });
    Ok(axes.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<SweepFile, String> {
        let source = Source { name: "s.ron".into(), text: text.into() };
        read_sweep_file(&source, &Folder::Disk("none".into())).map_err(|error| error.to_string())
    }

    #[test]
    fn axes_hold_values_of_any_kind_and_ranges() {
        let file = read(
            "(base: \"c.ron\", // why\n axes: [(field: \"inflow.model\", values: [Drees, FreeWake(preset: Fast)]), (field: \"x\", from: 1, to: 2.5, count: 4)])",
        )
        .unwrap();
        assert_eq!((file.base.as_str(), file.sampling), ("c.ron", Sampling::Grid));
        let AxisValues::List(values) = &file.axes[0].values else { panic!("no list") };
        assert_eq!(values[1].0, "FreeWake(preset: Fast)");
        assert_eq!(values[1].1.line, Some(2));
        assert!(matches!(file.axes[1].values, AxisValues::Range { count: Some(4), .. }));
        let file = read("(base: \"c\", axes: [(field: \"x\", from: 1, to: 2)], sampling: LatinHypercube(count: 7, seed: 3))").unwrap();
        assert_eq!(file.sampling, Sampling::LatinHypercube { count: 7, seed: 3 });
    }

    #[test]
    fn what_is_wrong_has_line_field_and_remedy() {
        for (axes, wanted) in [
            ("(field: \"x\", values: [])", "s.ron:2:15: axes[0].values: is empty; give at least"),
            ("(field: \"x\", from: 3, to: 2, count: 3)", "axes[0].from: 3 to 2 is no range; give"),
            ("(field: \"x\", from: 1, to: 2)", "axes[0].count: a range of a grid has 2 to"),
            ("(field: \"x\", from: 1, values: [1])", "axes[0].field: an axis has values"),
            (
                "(field: \"x\", values: [1]), (field: \"x\", values: [2])",
                "axes[1].field: x is an axis",
            ),
            ("(felid: \"x\", values: [1])", "did you mean `field`"),
            ("", "axes: is empty; give an axis such as"),
        ] {
            let text = read(&format!("(base: \"c\", axes: [\n {axes}])")).unwrap_err();
            assert!(text.contains(wanted), "{text}");
        }
        let text = read(
            "(base: \"c\", axes: [(field: \"x\", from: 1, to: 2)], sampling: LatinHypercube(count: 0, seed: 3))",
        );
        assert!(text.unwrap_err().contains("has 0 cases, expected 1 to"));
    }

    #[test]
    fn rows_of_a_csv_are_cases() {
        let rows = |text: &str| {
            row_axes(&Source { name: "r.csv".into(), text: text.into() }).map_err(|e| e.to_string())
        };
        let axes = rows("# why\nadvance_ratio,control.harmonics\n0.2,\"[[2], [3]]\"\n0.3,[[4]]\n")
            .unwrap();
        assert_eq!(axes[1].field, "control.harmonics");
        let AxisValues::List(values) = &axes[1].values else { panic!("no list") };
        assert_eq!((values[0].0.as_str(), values[0].1.line), ("[[2], [3]]", Some(3)));
        assert!(rows("a,b\n1\n").unwrap_err().contains("r.csv:2: is no table"));
        assert!(rows("a,b\n1,\n").unwrap_err().contains("r.csv:2: b: is empty"));
        assert!(rows("a,a\n1,2\n").unwrap_err().contains("twice"));
        assert!(rows("a,b\n").is_err() && rows("").is_err());
    }
}
