//! A document as JSON, CSV or MAT.

use crate::document::{Axis, Document, LabelledArray};
use actuator_export::{Json, number};
use measured_data::import::{MatValue, mat_file};
use std::fmt::Write;

/// A form of files of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataFormat {
    /// One JSON file.
    Json,
    /// A table for each array, and the notes as text.
    Csv,
    /// One MAT file of level 5, a structure for each array.
    Mat,
}

/// The files of a document, name and bytes of each. Every number reads back as the same bits.
///
/// - *JSON*: `values` are nested lists in the order of `axes`: `values[row][column][page]`.
/// - *CSV*: a line for each row, page by page; pages and rows by their names, with the unit of the row, a column for each
///   column.
/// - *MAT*: a structure for each array; `values(row, column, page)`, names and units of each axis as cells.
pub fn data_files(document: &Document, name: &str, format: DataFormat) -> Vec<(String, Vec<u8>)> {
    match format {
        DataFormat::Json => vec![(format!("{name}.json"), json(document).into_bytes())],
        DataFormat::Mat => vec![(format!("{name}.mat"), mat(document))],
        DataFormat::Csv => {
            let tables = document.arrays.iter();
            let mut files: Vec<(String, Vec<u8>)> = tables
                .map(|array| (format!("{name}_{}.csv", array.name), csv(array).into_bytes()))
                .collect();
            files.push((format!("{name}_notes.txt"), notes(document).into_bytes()));
            files
        }
    }
}

fn texts(texts: &[String]) -> Json {
    Json::List(texts.iter().map(|text| Json::text(text)).collect())
}

fn json(document: &Document) -> String {
    let axis = |axis: &Axis| {
        Json::Record(vec![
            ("name", Json::text(&axis.name)),
            ("labels", texts(&axis.labels)),
            ("units", texts(&axis.units)),
        ])
    };
    let array = |array: &LabelledArray| {
        let [rows, columns, pages] = array.sizes();
        let at = |i, j, k| Json::Number(array.at(i, j, k).unwrap_or_default());
        let row = |i| match array.axes.len() {
            1 => at(i, 0, 0),
            2 => Json::List((0..columns).map(|j| at(i, j, 0)).collect()),
            _ => Json::List(
                (0..columns)
                    .map(|j| Json::List((0..pages).map(|k| at(i, j, k)).collect()))
                    .collect(),
            ),
        };
        Json::Record(vec![
            ("name", Json::text(&array.name)),
            ("meaning", Json::text(&array.meaning)),
            ("axes", Json::List(array.axes.iter().map(axis).collect())),
            ("values", Json::List((0..rows).map(row).collect())),
        ])
    };
    Json::Record(vec![
        ("title", Json::text(&document.title)),
        ("notes", texts(&document.notes)),
        ("arrays", Json::List(document.arrays.iter().map(array).collect())),
    ])
    .document()
}

/// A cell of CSV, in quotes where it needs them.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn csv(array: &LabelledArray) -> String {
    let [rows, columns, pages] = array.sizes();
    let (row_axis, column_axis, page_axis) =
        (array.axes.first(), array.axes.get(1), array.axes.get(2));
    let label = |axis: Option<&Axis>, place: usize| {
        cell(axis.and_then(|axis| axis.labels.get(place)).map_or("", String::as_str))
    };
    let mut head: Vec<String> =
        [page_axis, row_axis].into_iter().flatten().map(|axis| cell(&axis.name)).collect();
    head.push("unit".to_owned());
    match column_axis {
        Some(_) => head.extend((0..columns).map(|j| label(column_axis, j))),
        None => head.push("value".to_owned()),
    }
    let mut text = head.join(",") + "\n";
    for k in 0..pages {
        for i in 0..rows {
            let mut line: Vec<String> =
                page_axis.map(|_| label(page_axis, k)).into_iter().collect();
            line.push(label(row_axis, i));
            line.push(cell(row_axis.and_then(|axis| axis.units.get(i)).map_or("", String::as_str)));
            line.extend((0..columns).map(|j| number(array.at(i, j, k).unwrap_or_default())));
            text.push_str(&line.join(","));
            text.push('\n');
        }
    }
    text
}

fn notes(document: &Document) -> String {
    let mut text = format!("{}\n", document.title);
    for note in &document.notes {
        let _ = writeln!(text, "\n{note}");
    }
    for array in &document.arrays {
        let _ = writeln!(text, "\n{}: {}", array.name, array.meaning);
        // the units of the rows stand in the table
        for (axis, what) in array.axes.iter().skip(1).zip(["columns", "pages"]) {
            let named = axis.labels.iter().zip(&axis.units).filter(|(_, unit)| !unit.is_empty());
            let named: Vec<String> =
                named.map(|(label, unit)| format!("{label} ({unit})")).collect();
            if !named.is_empty() {
                let _ = writeln!(text, "{what}: {}", named.join(", "));
            }
        }
    }
    text
}

fn mat(document: &Document) -> Vec<u8> {
    let text = |text: &String| MatValue::Text(text.clone());
    let cells = |texts: &[String]| MatValue::Cell(texts.iter().map(text).collect());
    let array = |array: &LabelledArray| {
        let [rows, columns, pages] = array.sizes();
        // MATLAB knows no trailing dimension of 1
        let sizes = if pages > 1 { vec![rows, columns, pages] } else { vec![rows, columns] };
        let mut fields = vec![
            ("values".to_owned(), MatValue::Numeric { sizes, values: array.values.clone() }),
            ("meaning".to_owned(), text(&array.meaning)),
        ];
        for (axis, place) in array.axes.iter().zip(["row", "column", "page"]) {
            fields.push((format!("{place}_axis"), text(&axis.name)));
            fields.push((format!("{place}_labels"), cells(&axis.labels)));
            fields.push((format!("{place}_units"), cells(&axis.units)));
        }
        (array.name.clone(), MatValue::Struct(fields))
    };
    let mut variables = vec![
        ("title".to_owned(), text(&document.title)),
        ("notes".to_owned(), cells(&document.notes)),
    ];
    variables.extend(document.arrays.iter().map(array));
    mat_file(&variables)
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::import::read_variables;

    fn document() -> Document {
        let axis = |name: &str, count: usize, unit: &str| {
            Axis::of_unit(name, (0..count).map(|k| format!("{name}, {k}")).collect(), unit)
        };
        let axes = vec![axis("load", 2, "N"), axis("control", 3, "V"), axis("point", 4, "")];
        let one = LabelledArray::from_fn("one", "m", axes[..1].to_vec(), |i, _, _| 0.1 + i as f64);
        let two = LabelledArray::from_fn("two", "m", axes[..2].to_vec(), |i, j, _| {
            1e-17 * (1.0 + i as f64) / (3.0 + j as f64)
        });
        let three = LabelledArray::from_fn("three", "m", axes, |i, j, k| {
            -(1.0 + i as f64) / (7.0 + 10.0 * j as f64 + 100.0 * k as f64)
        });
        let arrays = vec![one, two, three];
        Document { title: "a \"b\"".to_owned(), notes: vec!["n".to_owned()], arrays }
    }

    fn file(format: DataFormat, name: &str) -> Vec<u8> {
        let files = data_files(&document(), "x", format);
        files.into_iter().find(|(found, _)| found == name).unwrap().1
    }

    #[test]
    fn json_reads_back_bit_by_bit() {
        let read: serde_json::Value =
            serde_json::from_slice(&file(DataFormat::Json, "x.json")).unwrap();
        assert_eq!(read["title"], "a \"b\"");
        for (array, read) in document().arrays.iter().zip(read["arrays"].as_array().unwrap()) {
            let [rows, columns, pages] = array.sizes();
            for (i, j, k) in places([rows, columns, pages]) {
                let mut found = &read["values"][i];
                found = if array.axes.len() > 1 { &found[j] } else { found };
                found = if array.axes.len() > 2 { &found[k] } else { found };
                let exact = array.at(i, j, k).unwrap();
                assert_eq!(found.as_f64().unwrap().to_bits(), exact.to_bits());
            }
            assert_eq!(read["axes"][0]["units"][1], "N");
        }
    }

    fn places([rows, columns, pages]: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..pages)
            .flat_map(move |k| (0..columns).flat_map(move |j| (0..rows).map(move |i| (i, j, k))))
    }

    #[test]
    fn mat_reads_back_bit_by_bit() {
        let read = read_variables(&file(DataFormat::Mat, "x.mat")).unwrap();
        for (array, (name, read)) in document().arrays.iter().zip(&read[2..]) {
            let MatValue::Struct(fields) = read else { panic!("{read:?}") };
            let MatValue::Numeric { sizes, values } = &fields[0].1 else { panic!("{fields:?}") };
            assert_eq!((name, values), (&array.name, &array.values));
            assert_eq!(sizes[..2], array.sizes()[..2]);
            assert_eq!(fields.len(), 2 + 3 * array.axes.len());
        }
    }

    #[test]
    fn tables_name_page_row_and_column() {
        let text = String::from_utf8(file(DataFormat::Csv, "x_three.csv")).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 1 + 2 * 4);
        assert_eq!(lines[0], "point,load,unit,\"control, 0\",\"control, 1\",\"control, 2\"");
        assert!(lines[4].starts_with("\"point, 1\",\"load, 1\",N,"), "{}", lines[4]);
        let last: f64 = lines[4].rsplit(',').next().unwrap().parse().unwrap();
        assert_eq!(last.to_bits(), document().arrays[2].at(1, 2, 1).unwrap().to_bits());
        let single = String::from_utf8(file(DataFormat::Csv, "x_one.csv")).unwrap();
        assert!(single.starts_with("load,unit,value\n\"load, 0\",N,0.1\n"), "{single}");
        let notes = String::from_utf8(file(DataFormat::Csv, "x_notes.txt")).unwrap();
        assert!(notes.contains("three: m\ncolumns: control, 0 (V), control, 1 (V)"), "{notes}");
    }
}
