//! Text tables: a header whose cells carry units, and rows of numbers, read one after the other.

use super::sampling::Listing;
use super::units::Channel;
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems};
use csv::{ReaderBuilder, StringRecord, Terminator};
use std::collections::VecDeque;
use std::io::Read;

/// Rows below which nothing can be said about sampling.
pub(crate) const LEAST_ROWS: usize = 3;
/// Largest size of a number that can have been measured, in the units of any channel.
const LARGEST: f64 = 1e12;
/// What a line of comment begins with.
const COMMENT: u8 = b'#';
/// Characters of a row that are shown in a message.
const SHOWN: usize = 80;

/// The fault of a table with fewer rows than [`LEAST_ROWS`].
pub(crate) fn too_few_rows(rows: usize) -> Fault {
    Fault::Other(format!(
        "has {rows} rows of numbers, expected at least {LEAST_ROWS}; the record may be cut off"
    ))
}

/// A reader that remembers how its text ended, and which of its lines are empty or comments: those vanish behind it.
struct Ending<R> {
    inner: R,
    last: u8,
    is_at_end: bool,
    /// Line ends read.
    lines: usize,
    /// Numbers of the empty lines and of the comments, from 1, that no row was read behind yet.
    empty: VecDeque<usize>,
}

impl<R> Ending<R> {
    fn new(inner: R) -> Self {
        Self { inner, last: b'\n', is_at_end: false, lines: 0, empty: VecDeque::new() }
    }

    /// Takes the empty lines and comments before a line; how many there are.
    fn empty_before(&mut self, line: usize) -> usize {
        let count = self.empty.partition_point(|at| *at < line);
        self.empty.drain(..count).count()
    }
}

impl<R: Read> Read for Ending<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.is_at_end |= count == 0;
        for byte in &buffer[..count] {
            let begins = self.last == b'\n';
            if begins && matches!(*byte, b'\n' | COMMENT) {
                self.empty.push_back(self.lines + 1);
            }
            self.lines += usize::from(*byte == b'\n');
            self.last = *byte;
        }
        Ok(count)
    }
}

/// A row of cells.
struct Row {
    record: StringRecord,
    /// Where it stands.
    at: RowPlace,
    /// Whether a line end follows.
    is_ended: bool,
    /// Whether its cells hold nothing.
    is_blank: bool,
}

/// Where a row stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RowPlace {
    /// Its line in the file, from 1.
    pub(crate) line: usize,
    /// Blank lines and comments right before it.
    pub(crate) blank_before: usize,
}

impl Row {
    /// The cells with the columns of their first characters, from 1. Where blanks separate them,
    /// several are as good as one.
    fn cells(&self, separator: u8) -> Vec<(&str, usize)> {
        let mut column = 1;
        self.record
            .iter()
            .map(|raw| {
                let blanks = raw.chars().take_while(|c| c.is_whitespace()).count();
                let at = column + blanks;
                column += raw.chars().count() + 1;
                (raw.trim().trim_matches('"').trim(), at)
            })
            .filter(|(text, _)| separator != b' ' || !text.is_empty())
            .collect()
    }
}

/// A cell of a header.
pub(crate) struct HeaderCell {
    /// Its text.
    pub(crate) text: String,
    /// Its text with the unit of the second row, where that is the only one.
    pub(crate) full: String,
    /// Where it stands.
    pub(crate) place: Place,
}

impl HeaderCell {
    /// A cell with the unit it has itself.
    pub(crate) fn new(text: &str, place: Place) -> Self {
        Self { text: text.to_owned(), full: text.to_owned(), place }
    }
}

/// A text table whose header has been read.
pub(crate) struct TextTable<R> {
    file: String,
    separator: u8,
    /// Lines of the file before those of `reader`.
    before: usize,
    reader: csv::Reader<Ending<R>>,
    pending: Option<Row>,
    /// The cells of the first line.
    pub(crate) header: Vec<HeaderCell>,
    /// Whether the first line holds numbers, no names: it is the first row too.
    pub(crate) is_headless: bool,
    /// Whether a row of blank cells is one, as where the number of a row is its time.
    keeps_blank: bool,
}

impl<'a> TextTable<&'a [u8]> {
    /// Opens a table of a data folder: commas separate its fields.
    pub(crate) fn of_folder(source: &'a Source) -> Result<Self, Problem> {
        let table = Self::open(&source.name, source.text.as_bytes(), b',')?;
        let has = |separator| table.header.iter().any(|cell| cell.text.contains(separator));
        let separator = match table.header.len() {
            _ if has(';') => "semicolons",
            1 if has('\t') => "tabs",
            _ => return Ok(table),
        };
        let message = format!(
            "the fields are separated by {separator}, expected commas and decimal points; write it so, as `hhc import FILE -o DIR` does with a record that has command and displacement"
        );
        Err(Problem::new(table.header_place(), Fault::Other(message)))
    }
}

impl<R: Read> TextTable<R> {
    /// A table whose header has been read already, and some lines of its file `before` the rows.
    pub(crate) fn behind(
        file: &str,
        reader: R,
        (separator, before): (char, usize),
        header: Vec<HeaderCell>,
    ) -> Self {
        let separator = u8::try_from(separator).unwrap_or(b',');
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(false)
            .flexible(true)
            .comment(Some(COMMENT))
            .terminator(Terminator::Any(b'\n'))
            .from_reader(Ending::new(reader));
        let (file, pending) = (file.to_owned(), None);
        let (is_headless, keeps_blank) = (false, false);
        Self { file, separator, before, reader, pending, header, is_headless, keeps_blank }
    }

    /// The same with rows whose cells are all blank, which are left out else.
    pub(crate) fn with_blank_rows(self) -> Self {
        Self { keeps_blank: true, ..self }
    }

    /// Opens a table and reads its header, a second line of units in brackets included. Lines that
    /// begin with `#` are comments.
    pub(crate) fn open(file: &str, reader: R, separator: u8) -> Result<Self, Problem> {
        let mut table = Self::behind(file, reader, (separator.into(), 0), vec![]);
        let Some(first) = table.row()? else {
            return Err(Problem::new(Place::file(&table.file), too_few_rows(0)));
        };
        let cell = |(text, at): (&str, usize)| {
            HeaderCell::new(text, Place::at(&table.file, first.at.line, at))
        };
        table.header = first.cells(separator).into_iter().map(cell).collect();
        let is_number =
            |cell: &HeaderCell| cell.text.is_empty() || cell.text.parse::<f64>().is_ok();
        if table.header.iter().all(is_number) {
            (table.is_headless, table.pending) = (true, Some(first));
            return Ok(table);
        }
        table.pending = table.row()?;
        let second = table.pending.as_ref().map(|row| row.cells(separator));
        if let Some(units) = second.filter(|cells| cells.iter().all(|(text, _)| is_unit(text))) {
            for (cell, (unit, _)) in table.header.iter_mut().zip(units) {
                if Channel::parse(&cell.text).is_none() {
                    cell.full.push_str(unit);
                }
            }
            table.pending = None;
        }
        Ok(table)
    }

    /// The place of the header line.
    pub(crate) fn header_place(&self) -> Place {
        Place::at(&self.file, self.header[0].place.line.unwrap_or(1), 1)
    }

    /// The cells of the header, for messages.
    pub(crate) fn names(&self) -> String {
        self.header.iter().map(|cell| cell.text.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// The next row that holds anything, or blank cells that are kept.
    fn row(&mut self) -> Result<Option<Row>, Problem> {
        if let Some(row) = self.pending.take() {
            return Ok(Some(row));
        }
        let refused = |fault| Problem::new(Place::file(&self.file), fault);
        let mut blank_before = 0;
        loop {
            let mut record = csv::ByteRecord::new();
            let read = self.reader.read_byte_record(&mut record);
            let read = read.map_err(|e| refused(std::io::Error::from(e).into()))?;
            if !read {
                return Ok(None);
            }
            let ending = self.reader.get_ref();
            let is_ended = !ending.is_at_end || ending.last == b'\n';
            let (end, fields) = (self.reader.position(), record.len());
            let (end_byte, end_line) = (to_usize(end.byte()), to_usize(end.line()));
            let record = StringRecord::from_byte_record(record).map_err(|e| {
                let (flaw, record) = (e.utf8_error().clone(), e.into_byte_record());
                let start = record.range(flaw.field()).map_or(0, |range| range.start);
                let behind = record.as_slice().len() - start + fields - 1 - flaw.field();
                let offset = end_byte - behind - usize::from(is_ended) + flaw.valid_up_to();
                refused(Fault::NotText { offset })
            })?;
            let own_line = end_line - usize::from(is_ended);
            blank_before += self.reader.get_mut().empty_before(own_line);
            let is_blank = record.iter().all(|field| field.trim().is_empty());
            let has_cells = record.len() > 1 && self.separator != b' ';
            if !is_blank || self.keeps_blank && has_cells {
                let at = RowPlace { line: self.before + own_line, blank_before };
                return Ok(Some(Row { record, at, is_ended, is_blank }));
            }
            blank_before += 1;
        }
    }

    /// Reads the cells of every row, each with the column of its first character. `take` gets them with the place of the
    /// row, or none where the row has another number of fields than the header: `problems` then say so.
    pub(crate) fn rows(
        mut self,
        problems: &mut Problems,
        mut take: impl FnMut(Option<&[(&str, usize)]>, RowPlace, &mut Problems),
    ) -> Result<(), Problem> {
        let expected = self.header.len();
        let mut counts = Listing::default();
        let mut usual_decimals = None;
        while let Some(row) = self.row()? {
            if row.is_blank {
                take(Some(&vec![("", 1); expected]), row.at, problems);
                continue;
            }
            let mut cells = row.cells(self.separator);
            let place = Place::at(&self.file, row.at.line, 1);
            // separators behind the last field
            while cells.len() > expected && cells.last().is_some_and(|(text, _)| text.is_empty()) {
                cells.pop();
            }
            let last = cells.last().map_or("", |(text, _)| *text);
            let decimals = last.split_once('.').map(|(_, decimals)| decimals.len());
            // a last number with fewer decimals than the rows before promise is cut off as well
            let is_short = usual_decimals.is_some_and(|usual| decimals.is_none_or(|d| d < usual));
            if !row.is_ended && (cells.len() < expected || last.is_empty() || is_short) {
                let text = cells.iter().map(|(text, _)| *text).collect::<Vec<_>>().join(",");
                let text = text.chars().take(SHOWN).collect();
                problems.push(place, Fault::Truncated { text, expected });
                break;
            }
            usual_decimals = decimals;
            if cells.len() != expected {
                let fault = Fault::Other(format!(
                    "the row has {} fields, the header has {expected}; check separators and decimal commas, or delete the line if it is no sample",
                    cells.len()
                ));
                counts.push(problems, place, fault);
                take(None, row.at, problems);
                continue;
            }
            take(Some(&cells), row.at, problems);
        }
        counts.finish(problems);
        Ok(())
    }

    /// Reads the numbers of every row in the columns `wanted`, each with its label; `read` takes them from the texts of
    /// their columns. `take` gets them with the place of the row, or none where the row cannot be read: `problems` then say why.
    pub(crate) fn numbers(
        self,
        wanted: &[(usize, String)],
        read: impl Fn(usize, &str) -> Result<f64, Fault>,
        problems: &mut Problems,
        mut take: impl FnMut(Option<&[f64]>, RowPlace, &mut Problems),
    ) -> Result<(), Problem> {
        let file = self.file.clone();
        let mut lists: [Listing; 2] = Default::default();
        let [sizes, words] = &mut lists;
        let mut numbers = Vec::with_capacity(wanted.len());
        self.rows(problems, |cells, row, problems| {
            let Some(cells) = cells else { return take(None, row, problems) };
            numbers.clear();
            for (column, label) in wanted {
                let (text, at) = cells[*column];
                let field = || Place::at(&file, row.line, at).field(label);
                match read(*column, text) {
                    Ok(value) => numbers.push(value),
                    Err(fault @ Fault::NotANumber { .. }) => words.push(problems, field(), fault),
                    Err(fault) => sizes.push(problems, field(), fault),
                }
            }
            let good = (numbers.len() == wanted.len()).then_some(numbers.as_slice());
            take(good, row, problems);
        })?;
        for list in lists {
            list.finish(problems);
        }
        Ok(())
    }
}

/// The number of a cell.
///
/// # Errors
/// [`Fault::NotANumber`], [`Fault::NotFinite`], or a number no channel reads.
pub(crate) fn number(text: &str) -> Result<f64, Fault> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= LARGEST => Ok(value),
        Ok(value) if value.is_finite() => Err(Fault::Other(format!(
            "the value is {value:e}, expected no more than {LARGEST:e} in size: no channel of a bench reads so much; remove the record's bad samples at the source, they are not interpolated here"
        ))),
        Ok(value) => Err(Fault::NotFinite { value }),
        Err(_) => Err(Fault::NotANumber { text: text.to_owned() }),
    }
}

fn to_usize(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

/// Whether a cell is a unit in brackets.
fn is_unit(text: &str) -> bool {
    (text.starts_with('(') && text.ends_with(')')) || (text.starts_with('[') && text.ends_with(']'))
}

/// The numbers of a table of a data folder by column, and the line of every row.
pub(crate) fn columns(
    table: TextTable<&[u8]>,
    wanted: &[(usize, String)],
    problems: &mut Problems,
) -> (Vec<Vec<f64>>, Vec<usize>) {
    let (mut columns, mut lines) = (vec![Vec::new(); wanted.len()], Vec::new());
    let file = Place::file(&table.file);
    let read = table.numbers(
        wanted,
        |_, text| number(text),
        problems,
        |numbers, row, _| {
            for (column, number) in columns.iter_mut().zip(numbers.into_iter().flatten()) {
                column.push(*number);
            }
            lines.push(row.line);
        },
    );
    if problems.note(read).is_some() && lines.len() < LEAST_ROWS {
        problems.push(file, too_few_rows(lines.len()));
    }
    (columns, lines)
}
