//! Reference tables of `fixtures/reference`.

use std::path::PathBuf;

use crate::root;

/// Why a reference table does not answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// It cannot be read.
    #[error("reference table {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: csv::Error,
    },
    /// It lacks a column, or a cell is no number.
    #[error("reference table {}, row {row}: column `{column}` {problem}", path.display())]
    Cell {
        /// The file.
        path: PathBuf,
        /// Row below the header, from 1.
        row: usize,
        /// The column.
        column: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// It lacks a row.
    #[error("reference table {} has no row `{row}`", path.display())]
    NoRow {
        /// The file.
        path: PathBuf,
        /// What the row is called.
        row: String,
    },
}

/// A table by column name.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// One row of a table.
#[derive(Debug, Clone, Copy)]
pub struct TableRow<'a> {
    table: &'a Table,
    index: usize,
}

impl Table {
    /// Reads `fixtures/reference/{file}`; lines that start with `#` are comments, and rows may end early.
    ///
    /// # Errors
    /// [`TableError`] if it cannot be read.
    pub fn read(file: &str) -> Result<Self, TableError> {
        let path = root().join("fixtures/reference").join(file);
        let failed = |source| TableError::Unreadable { path: path.clone(), source };
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
    pub fn rows(&self) -> impl Iterator<Item = TableRow<'_>> {
        (0..self.rows.len()).map(|index| TableRow { table: self, index })
    }

    /// The row whose cells in `columns` are `wanted`.
    ///
    /// # Errors
    /// [`TableError::NoRow`] if there is none.
    pub fn row(&self, columns: [&str; 2], wanted: [&str; 2]) -> Result<TableRow<'_>, TableError> {
        let matches = |row: &TableRow| {
            columns.iter().zip(wanted).all(|(column, w)| row.text(column).is_ok_and(|t| t == w))
        };
        self.rows()
            .find(matches)
            .ok_or_else(|| TableError::NoRow { path: self.path.clone(), row: wanted.join(" ") })
    }
}

impl<'a> TableRow<'a> {
    /// A text.
    ///
    /// # Errors
    /// [`TableError::Cell`] if it is missing.
    pub fn text(&self, column: &str) -> Result<&'a str, TableError> {
        let place = self.table.columns.iter().position(|name| name == column);
        let cell = place.and_then(|place| self.table.rows[self.index].get(place));
        cell.map(String::as_str).ok_or_else(|| self.fault(column, "is missing"))
    }

    /// A number.
    ///
    /// # Errors
    /// [`TableError::Cell`] if it is missing or not finite.
    pub fn number(&self, column: &str) -> Result<f64, TableError> {
        let value = self.text(column)?.parse().map_err(|_| self.fault(column, "is no number"))?;
        if f64::is_finite(value) { Ok(value) } else { Err(self.fault(column, "is not finite")) }
    }

    fn fault(&self, column: &str, problem: &'static str) -> TableError {
        TableError::Cell {
            path: self.table.path.clone(),
            row: self.index + 1,
            column: column.to_owned(),
            problem,
        }
    }
}

/// Numbers of a case of the crosscheck of the whole chain, `crosscheck_S1_S2.json`.
///
/// # Errors
/// [`TableError::NoRow`] if it is missing or of another length.
pub fn crosscheck<const N: usize>(case: &str, field: &str) -> Result<[f64; N], TableError> {
    let path = root().join("fixtures/reference/rotor/crosscheck_S1_S2.json");
    let missing = || TableError::NoRow { path: path.clone(), row: format!("{case} {field}") };
    let text = std::fs::read_to_string(&path).map_err(|_| missing())?;
    let json: serde_json::Value = serde_json::from_str(&text).map_err(|_| missing())?;
    let numbers: Option<Vec<f64>> = json
        .get(case)
        .and_then(|case| case.get(field)?.as_array())
        .and_then(|array| array.iter().map(serde_json::Value::as_f64).collect());
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(missing)
}

/// Rows of numbers of such a case.
///
/// # Errors
/// [`TableError::NoRow`] if they are missing.
pub fn crosscheck_rows(case: &str, field: &str) -> Result<Vec<Vec<f64>>, TableError> {
    let path = root().join("fixtures/reference/rotor/crosscheck_S1_S2.json");
    let missing = || TableError::NoRow { path: path.clone(), row: format!("{case} {field}") };
    let text = std::fs::read_to_string(&path).map_err(|_| missing())?;
    let json: serde_json::Value = serde_json::from_str(&text).map_err(|_| missing())?;
    let rows = json.get(case).and_then(|case| case.get(field)).cloned().ok_or_else(missing)?;
    serde_json::from_value(rows).map_err(|_| missing())
}
