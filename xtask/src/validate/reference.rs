//! Reference tables of `fixtures/reference`.

use std::path::PathBuf;

use super::CheckError;

/// A table by column name.
pub(super) struct Table {
    path: PathBuf,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// One row of a table.
#[derive(Clone, Copy)]
pub(super) struct TableRow<'a> {
    table: &'a Table,
    index: usize,
}

impl Table {
    /// Reads `fixtures/reference/{file}`; lines that start with `#` are comments, and rows may end early.
    pub(super) fn read(file: &str) -> Result<Self, CheckError> {
        let path = crate::workspace::root().join("fixtures/reference").join(file);
        let failed = |source| CheckError::Table { path: path.clone(), source };
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .flexible(true)
            .trim(csv::Trim::All)
            .from_path(&path)
            .map_err(failed)?;
        let columns = reader.headers().map_err(failed)?.iter().map(str::to_owned).collect();
        let rows = reader
            .records()
            .map(|record| Ok(record?.iter().map(str::to_owned).collect()))
            .collect::<Result<_, csv::Error>>()
            .map_err(failed)?;
        Ok(Self { path, columns, rows })
    }

    /// The rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = TableRow<'_>> {
        (0..self.rows.len()).map(|index| TableRow { table: self, index })
    }

    /// The row whose cells in `columns` are `wanted`.
    pub(super) fn row(
        &self,
        columns: [&str; 2],
        wanted: [&str; 2],
    ) -> Result<TableRow<'_>, CheckError> {
        let matches = |row: &TableRow| {
            columns.iter().zip(wanted).all(|(column, w)| row.text(column).is_ok_and(|t| t == w))
        };
        self.rows()
            .find(matches)
            .ok_or_else(|| CheckError::NoRow { path: self.path.clone(), row: wanted.join(" ") })
    }
}

impl<'a> TableRow<'a> {
    /// A text.
    pub(super) fn text(&self, column: &str) -> Result<&'a str, CheckError> {
        let place = self.table.columns.iter().position(|name| name == column);
        let cell = place.and_then(|place| self.table.rows[self.index].get(place));
        cell.map(String::as_str).ok_or_else(|| self.fault(column, "is missing"))
    }

    /// A number.
    pub(super) fn number(&self, column: &str) -> Result<f64, CheckError> {
        let value = self.text(column)?.parse().map_err(|_| self.fault(column, "is no number"))?;
        if f64::is_finite(value) { Ok(value) } else { Err(self.fault(column, "is not finite")) }
    }

    fn fault(&self, column: &str, problem: &'static str) -> CheckError {
        CheckError::Cell {
            path: self.table.path.clone(),
            row: self.index + 1,
            column: column.to_owned(),
            problem,
        }
    }
}

/// Numbers of a case of the crosscheck of the whole chain, `crosscheck_S1_S2.json`.
pub(super) fn crosscheck<const N: usize>(case: &str, field: &str) -> Result<[f64; N], CheckError> {
    let path = crate::workspace::root().join("fixtures/reference/rotor/crosscheck_S1_S2.json");
    let missing = || CheckError::NoRow { path: path.clone(), row: format!("{case} {field}") };
    let text = std::fs::read_to_string(&path).map_err(|_| missing())?;
    let json: serde_json::Value = serde_json::from_str(&text).map_err(|_| missing())?;
    let numbers: Option<Vec<f64>> = json
        .get(case)
        .and_then(|case| case.get(field)?.as_array())
        .and_then(|array| array.iter().map(serde_json::Value::as_f64).collect());
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(missing)
}

/// Rows of numbers of such a case.
pub(super) fn crosscheck_rows(case: &str, field: &str) -> Result<Vec<Vec<f64>>, CheckError> {
    let path = crate::workspace::root().join("fixtures/reference/rotor/crosscheck_S1_S2.json");
    let missing = || CheckError::NoRow { path: path.clone(), row: format!("{case} {field}") };
    let text = std::fs::read_to_string(&path).map_err(|_| missing())?;
    let json: serde_json::Value = serde_json::from_str(&text).map_err(|_| missing())?;
    let rows = json.get(case).and_then(|case| case.get(field)).cloned().ok_or_else(missing)?;
    serde_json::from_value(rows).map_err(|_| missing())
}

/// The largest of at least `needed` values; the error of the first that could not be had.
pub(super) fn worst(
    what: &'static str,
    needed: usize,
    values: impl IntoIterator<Item = Result<f64, CheckError>>,
) -> Result<f64, CheckError> {
    let (mut largest, mut found) = (0.0_f64, 0);
    for value in values {
        let value = value?;
        // a NaN must not be lost in the comparison
        largest = if value.is_nan() { value } else { largest.max(value) };
        if value.is_nan() {
            return Ok(value);
        }
        found += 1;
    }
    if found < needed { Err(CheckError::TooFew { what, found, needed }) } else { Ok(largest) }
}
