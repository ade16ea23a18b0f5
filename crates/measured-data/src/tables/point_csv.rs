//! Tables of points: one row per point of test, cells that may be blank.

use super::sampling::Listing;
use super::text::{TextTable, number};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems};

/// A table of points.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCsv {
    header: Vec<(String, Place)>,
    file: String,
    /// Cells by row and column: none where one is blank or holds text.
    numbers: Vec<Vec<Option<f64>>>,
    /// Cells of the columns of text, by row and column; empty elsewhere.
    texts: Vec<Vec<String>>,
    /// Line of every row in the file, from 1.
    lines: Vec<usize>,
}

impl PointCsv {
    /// Reads a table. The columns `texts` may hold words, every other cell is a number or blank.
    ///
    /// # Errors
    /// A header without names or with one twice, a cell that is no finite number, a row of another length, no row: each with
    /// line and column.
    pub fn read(source: &Source, texts: &[&str]) -> Result<Self, Problems> {
        let table = TextTable::of_folder(source)?;
        let mut problems = Problems::default();
        if table.is_headless {
            let message = "the first line holds numbers, expected the names of the columns";
            problems.push(table.header_place(), Fault::Other(message.to_owned()));
            return problems.into_result(None);
        }
        let header: Vec<(String, Place)> =
            table.header.iter().map(|cell| (cell.text.clone(), cell.place.clone())).collect();
        for (i, (name, place)) in header.iter().enumerate() {
            if name.is_empty() {
                problems.push(place.clone(), Fault::Empty { of: "a name of the column" });
            } else if header[..i].iter().any(|(before, _)| before == name) {
                let message = format!("the column `{name}` is there twice; give each column once");
                problems.push(place.clone(), Fault::Other(message));
            }
        }
        let is_text: Vec<bool> = header.iter().map(|own| texts.contains(&own.0.as_str())).collect();
        let mut own = Self {
            header,
            file: source.name.clone(),
            numbers: vec![],
            texts: vec![],
            lines: vec![],
        };
        let mut faults = Listing::default();
        let Self { header, file, numbers, texts, lines } = &mut own;
        let read = table.rows(&mut problems, |cells, row, problems| {
            let Some(cells) = cells else { return };
            let cell = |(column, (text, at)): (usize, &(&str, usize))| {
                if text.is_empty() || is_text[column] {
                    return None;
                }
                let place = || Place::at(&*file, row.line, *at).field(&header[column].0);
                number(text).map_err(|fault| faults.push(problems, place(), fault)).ok()
            };
            numbers.push(cells.iter().enumerate().map(cell).collect());
            let word = |(text, is_text): (&(&str, usize), &bool)| {
                if *is_text { text.0.to_owned() } else { String::new() }
            };
            texts.push(cells.iter().zip(&is_text).map(word).collect());
            lines.push(row.line);
        });
        faults.finish(&mut problems);
        if problems.note(read).is_some() && own.lines.is_empty() {
            let fault = Fault::Empty { of: "at least one row" };
            problems.push(Place::file(&source.name), fault);
        }
        problems.into_result(Some(own))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The names of the columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.header.iter().map(|(name, _)| name.as_str())
    }

    /// Whether there is a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.names().any(|own| own == name)
    }

    /// The cells of a column, none where one is blank; none if the table lacks it.
    pub fn column(&self, name: &str) -> Option<Vec<Option<f64>>> {
        let place = self.names().position(|own| own == name)?;
        Some(self.numbers.iter().map(|row| row[place]).collect())
    }

    /// The cells of a column of text; none if the table lacks it.
    pub fn text_column(&self, name: &str) -> Option<Vec<String>> {
        let place = self.names().position(|own| own == name)?;
        Some(self.texts.iter().map(|row| row[place].clone()).collect())
    }

    /// The numbers of a column without blank cells.
    ///
    /// # Errors
    /// [`Fault::MissingColumn`]; a blank cell, with its line.
    pub fn full_column(&self, name: &str, remedy: &'static str) -> Result<Vec<f64>, Problem> {
        let column = self.column(name).ok_or_else(|| self.missing(name, remedy))?;
        let full = column.iter().enumerate().map(|(row, value)| {
            value.ok_or_else(|| {
                let message = "the cell is blank, expected a number";
                Problem::new(self.place(row, name), Fault::Other(message.to_owned()))
            })
        });
        full.collect()
    }

    /// That a column is missing.
    pub fn missing(&self, wanted: &str, remedy: &'static str) -> Problem {
        let found = self.names().collect::<Vec<_>>().join(", ");
        let fault = Fault::MissingColumn { wanted: wanted.to_owned(), found, remedy };
        Problem::new(self.header_place(), fault)
    }

    /// The place of the header line.
    pub fn header_place(&self) -> Place {
        let line = self.header.first().and_then(|(_, place)| place.line);
        Place { line, ..Place::file(&self.file) }
    }

    /// The place of the name of a column.
    pub fn column_place(&self, name: &str) -> Place {
        let own = self.header.iter().find(|(own, _)| own == name);
        own.map_or_else(|| self.header_place(), |(_, place)| place.clone())
    }

    /// The place of a row, counted from 0, in a column.
    pub fn place(&self, row: usize, column: &str) -> Place {
        let line = self.lines.get(row).copied();
        Place { line, ..Place::file(&self.file) }.field(column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PointCsv, Problems> {
        PointCsv::read(&Source { name: "a.csv".into(), text: text.into() }, &["point"])
    }

    #[test]
    fn blank_cells_and_labels_are_read() {
        let table = read("# sweep\npoint,mu,fz_N\nfirst,0.1,12.5\nsecond,0.2,\n").unwrap();
        assert_eq!((table.rows(), table.names().count()), (2, 3));
        assert_eq!(table.column("fz_N"), Some(vec![Some(12.5), None]));
        assert_eq!(table.text_column("point").unwrap(), ["first", "second"]);
        assert_eq!(table.full_column("mu", "").unwrap(), [0.1, 0.2]);
        let blank = table.full_column("fz_N", "").unwrap_err().to_string();
        assert!(blank.starts_with("a.csv:4: fz_N: ") && blank.contains("blank"), "{blank}");
        let missing = table.full_column("fx_N", "add it").unwrap_err().to_string();
        assert!(missing.contains("`fx_N` is missing"), "{missing}");
    }

    #[test]
    fn faults_name_their_line() {
        let text = |text: &str| read(text).unwrap_err().to_string();
        assert!(text("point,mu\na,x\n").starts_with("a.csv:2:3: mu: `x` is not a number"));
        assert!(text("point,mu\na,NaN\n").starts_with("a.csv:2:3: mu: "));
        assert!(text("point,mu,mu\na,1,2\n").contains("twice"));
        assert!(text("point,mu\na,1,2\n").contains("3 fields"));
        assert!(text("1,2\n3,4\n").contains("names of the columns"));
        assert!(text("point,mu\n").contains("at least one row"));
        assert!(text("point;mu\na;1\n").contains("semicolons"));
    }
}
