//! Tables by column name: numbers, and a column of texts that says which rows belong together.

use super::text::{TextTable, columns};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems, nearest};

/// Name of the column that says which rows belong together.
const CASE: &str = "case";

/// The numbers of a table by column.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnTable {
    header: Place,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// Line of every row in the file, from 1.
    pub lines: Vec<usize>,
}

impl ColumnTable {
    /// The numbers of a column; none if the table lacks it.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let place = self.names.iter().position(|own| own == name)?;
        self.columns.get(place).map(Vec::as_slice)
    }

    /// The same of a column that must be there.
    ///
    /// # Errors
    /// [`Fault::MissingColumn`] with the columns found.
    pub fn column(&self, name: &str, remedy: &'static str) -> Result<&[f64], Problem> {
        self.get(name).ok_or_else(|| self.missing(name, remedy))
    }

    /// That columns are missing.
    pub fn missing(&self, wanted: &str, remedy: &'static str) -> Problem {
        let found = self.names.join(", ");
        let fault = Fault::MissingColumn { wanted: wanted.to_owned(), found, remedy };
        Problem::new(self.header.clone(), fault)
    }

    /// The place of a row, counted from 0, in a column.
    pub fn place(&self, row: usize, column: &str) -> Place {
        let line = self.lines.get(row).copied();
        Place { line, ..Place::file(&self.header.file) }.field(column)
    }
}

/// Reads a table whose columns are all `known`, and of its rows those of a `case`, the text in the column of that name.
///
/// Lines that begin with `#` are comments. Without a column `case` all rows are read.
///
/// # Errors
/// An unknown column, a cell that is no finite number, rows of several cases where none is asked for, a case that is not
/// there; each with line and column.
pub fn parse_columns(
    source: &Source,
    case: Option<&str>,
    known: &[&str],
) -> Result<ColumnTable, Problems> {
    let chosen = rows_of(source, case)?;
    let table = TextTable::of_folder(&chosen)?;
    let mut problems = Problems::default();
    let mut wanted: Vec<(usize, String)> = Vec::new();
    for (i, cell) in table.header.iter().enumerate().filter(|(_, cell)| cell.text != CASE) {
        let name = &cell.text;
        let fault = if !known.contains(&name.as_str()) {
            Fault::Unknown {
                what: "column",
                found: name.clone(),
                known: [&[CASE], known].concat().join(", "),
                nearest: nearest(name, known.iter().copied()),
            }
        } else if wanted.iter().any(|(_, before)| before == name) {
            Fault::Other(format!("the column `{name}` is there twice; give each column once"))
        } else {
            wanted.push((i, name.clone()));
            continue;
        };
        problems.push(cell.place.clone(), fault);
    }
    let header = table.header_place();
    let (columns, lines) = columns(table, &wanted, &mut problems);
    let names = wanted.into_iter().map(|(_, name)| name).collect();
    problems.into_result(Some(ColumnTable { header, names, columns, lines }))
}

/// The text with the rows of other cases made comments, so that lines keep their numbers.
fn rows_of(source: &Source, case: Option<&str>) -> Result<Source, Problem> {
    let is_row = |line: &str| !line.starts_with('#') && !line.trim().is_empty();
    let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect();
    let header = source.text.lines().enumerate().find(|(_, line)| is_row(line));
    let (first, names): (usize, Vec<String>) = header.map_or((0, vec![]), |(i, l)| (i, cells(l)));
    let column = names.iter().position(|name| name == CASE);
    let refused = |message| {
        let place = Place { line: Some(first + 1), ..Place::file(&source.name) }.field(CASE);
        Err(Problem::new(place, Fault::Other(message)))
    };
    let column = match (column, case) {
        (Some(column), _) => column,
        (None, None) => return Ok(source.clone()),
        (None, Some(case)) => {
            return refused(format!(
                "there is no column `{CASE}`, but the rows of `{case}` are asked for; leave `{CASE}` out to take all rows"
            ));
        }
    };
    let of = |line: &str| line.split(',').nth(column).map(str::trim).unwrap_or_default().to_owned();
    let rows = source.text.lines().skip(first + 1).filter(|line| is_row(line));
    let mut cases: Vec<String> = rows.map(of).collect();
    cases.sort();
    cases.dedup();
    let listed = cases.join(", ");
    let wanted = match case {
        Some(case) if cases.iter().any(|own| own == case) => case.to_owned(),
        Some(case) => {
            return refused(format!("no row is of `{case}`; the file has rows of: {listed}"));
        }
        None if cases.len() > 1 => {
            return refused(format!(
                "the file has rows of several cases and none is chosen; give `{CASE}`, one of: {listed}"
            ));
        }
        None => cases.first().cloned().unwrap_or_default(),
    };
    let kept = source.text.split_inclusive('\n').enumerate().map(|(i, line)| {
        let is_other = i > first && is_row(line) && of(line) != wanted;
        if is_other { "#\n".to_owned() } else { line.to_owned() }
    });
    Ok(Source { name: source.name.clone(), text: kept.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str =
        "# measured\ncase,azimuth_deg,cn\nA,0,1.5\nB,5,2.5\nA,10,3.5\nB,7,0.5\nA,20,4.5\n";

    fn read(text: &str, case: Option<&str>) -> Result<ColumnTable, Problems> {
        let source = Source { name: "a.csv".into(), text: text.into() };
        parse_columns(&source, case, &["azimuth_deg", "cn"])
    }

    #[test]
    fn the_rows_of_a_case_keep_their_lines() {
        let table = read(TABLE, Some("A")).unwrap();
        assert_eq!(table.get("azimuth_deg").unwrap(), [0.0, 10.0, 20.0]);
        assert_eq!(table.column("cn", "").unwrap(), [1.5, 3.5, 4.5]);
        assert_eq!(table.lines, [3, 5, 7]);
        assert_eq!(table.place(1, "cn").to_string(), "a.csv:5: cn");
        let without = "azimuth_deg,cn\n0,1\n5,2\n9,3\n";
        assert_eq!(read(without, None).unwrap().lines, [2, 3, 4]);
    }

    #[test]
    fn faults_name_line_column_and_remedy() {
        let text = |text: &str, case| read(text, case).unwrap_err().to_string();
        let several = text(TABLE, None);
        assert!(several.starts_with("a.csv:2: case: ") && several.contains("A, B"), "{several}");
        let none = text(TABLE, Some("C"));
        assert!(none.contains("no row is of `C`") && none.contains("A, B"), "{none}");
        let no_column = text("azimuth_deg,cn\n0,1\n5,2\n9,3\n", Some("A"));
        assert!(no_column.contains("there is no column `case`"), "{no_column}");
        let word = text(&TABLE.replace("3.5", "x"), Some("A"));
        assert!(word.starts_with("a.csv:5:6: cn: `x` is not a number"), "{word}");
        // a fault in the rows of another case is none of this one
        assert!(read(&TABLE.replace("2.5", "x"), Some("A")).is_ok());
        let unknown = text(&TABLE.replace("azimuth_deg", "azimut_deg"), Some("A"));
        assert!(unknown.contains("did you mean `azimuth_deg`"), "{unknown}");
        let twice = text(&TABLE.replace("azimuth_deg", "cn"), Some("A"));
        assert!(twice.contains("twice"), "{twice}");
        let missing = read(TABLE, Some("A")).unwrap().column("cm", "add it").unwrap_err();
        assert!(missing.to_string().contains("`cm` is missing"), "{missing}");
        assert!(text("", None).contains("0 rows"));
    }
}
