//! Problems of user files: what is wrong, where, what was expected and the remedy.

mod record_fault;

pub use record_fault::RecordFault;
use std::fmt;

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Place {
    /// File as the user named it, or the name of a file shipped inside the program.
    pub file: String,
    /// Line, from 1.
    pub line: Option<usize>,
    /// Column of the line in characters, from 1.
    pub column: Option<usize>,
    /// Field of a RON file (`rotor.radius_m`, `flaps[1].start_r`) or column of a table.
    pub field: Option<String>,
}

impl Place {
    /// A whole file.
    pub fn file(file: impl Into<String>) -> Self {
        Self { file: file.into(), ..Self::default() }
    }

    /// A line and column of a file, both from 1.
    pub fn at(file: impl Into<String>, line: usize, column: usize) -> Self {
        Self { file: file.into(), line: Some(line), column: Some(column), field: None }
    }

    /// The same place with the name of the field or table column found there.
    #[must_use]
    pub fn field(mut self, field: impl Into<String>) -> Self {
        self.field = Some(field.into());
        self
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        for number in [self.line, self.column].into_iter().flatten() {
            write!(f, ":{number}")?;
        }
        match &self.field {
            Some(field) => write!(f, ": {field}"),
            None => Ok(()),
        }
    }
}

/// What is wrong at a place, what was expected there, and the remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    // ---- files ----
    /// A file or folder cannot be read.
    #[error("cannot be read ({reason}); check the path and the permissions")]
    Unreadable {
        /// What the operating system said.
        reason: String,
    },
    /// A file is not UTF-8 text.
    #[error(
        "is not UTF-8 text (byte {offset}); save it as UTF-8, and check that it is no binary file"
    )]
    NotText {
        /// First offending byte, from 0.
        offset: usize,
    },
    /// A named file does not exist in the data folder.
    #[error("names the file {file}, which is not in {folder}; correct the name or add the file")]
    MissingFile {
        /// The name given.
        file: String,
        /// Where it was looked for.
        folder: String,
    },
    /// A path of a shipped file leads out of the shipped files.
    #[error("{path} is not shipped inside the program; run `hhc init` to start a case on disk")]
    NotShipped {
        /// The path asked for.
        path: String,
    },
    /// A file is of no kind the program knows.
    #[error(
        "is neither a case, a dataset.ron nor an actuator file; a case has sections such as rotor: and trim:, a data set begins with kind: ActuatorBench, GenericLoop or ReversalCurves, an actuator file with kind: Actuator"
    )]
    UnknownKind,

    // ---- RON ----
    /// The text is not RON.
    #[error(
        "is not valid RON: {message}; check brackets, commas and quotes just before this place"
    )]
    Syntax {
        /// What the reader said.
        message: String,
    },
    /// A key the file format does not have.
    #[error("unknown key `{found}`{}; known here: {known}", suggestion(.nearest.as_ref()))]
    UnknownKey {
        /// The key found.
        found: String,
        /// The keys known there.
        known: String,
        /// The known key it resembles most.
        nearest: Option<String>,
    },
    /// A choice the file format does not have.
    #[error("unknown choice `{found}`{}; known here: {known}", suggestion(.nearest.as_ref()))]
    UnknownChoice {
        /// The word found.
        found: String,
        /// The choices known there.
        known: String,
        /// The known choice it resembles most.
        nearest: Option<String>,
    },
    /// A required key is missing.
    #[error("the key `{key}` is missing; add `{key}: ...`")]
    MissingKey {
        /// The key.
        key: String,
    },
    /// A key is given twice.
    #[error("the key `{key}` is given twice; remove one of them")]
    RepeatedKey {
        /// The key.
        key: String,
    },
    /// A value has the wrong type.
    #[error("has the wrong type: {message}; write a value of the type shown by `hhc init`")]
    WrongType {
        /// What the reader said.
        message: String,
    },

    /// A value was read but makes no sense.
    #[error("is refused: {message}")]
    Refused {
        /// What the value's own check said.
        message: String,
    },

    /// A value of a case that is out of range or goes against another one.
    #[error("{message}")]
    Value {
        /// What was found, what is expected, what to do.
        message: String,
    },

    /// A value can be, but hardly is.
    #[error("{message}")]
    Doubtful {
        /// What was found, what would be expected, the remedy.
        message: String,
    },

    // ---- values ----
    /// A number lies outside its range.
    #[error("is {value}{0}, expected {low} to {high}{0}; {remedy}", suffix(.unit))]
    OutOfRange {
        /// The number found.
        value: f64,
        /// Smallest accepted.
        low: f64,
        /// Largest accepted.
        high: f64,
        /// Unit, empty for a pure number.
        unit: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A number that must be positive is not.
    #[error("is {value}{}, expected a positive finite number; {remedy}", suffix(.unit))]
    NotPositive {
        /// The number found.
        value: f64,
        /// Unit, empty for a pure number.
        unit: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A count lies outside its range.
    #[error("is {value}, expected {low} to {high}; {remedy}")]
    CountOutOfRange {
        /// The count found.
        value: usize,
        /// Smallest accepted.
        low: usize,
        /// Largest accepted.
        high: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// A list is empty.
    #[error("is empty; give at least one {of}")]
    EmptyList {
        /// What the list holds.
        of: &'static str,
    },
    /// A text is empty.
    #[error("is empty; give {of}")]
    EmptyText {
        /// What it should say.
        of: &'static str,
    },
    /// A name that must be unique is used twice.
    #[error("`{name}` is used already on line {first_line}; give every {of} its own")]
    Repeated {
        /// The name.
        name: String,
        /// What the name stands for.
        of: &'static str,
        /// Line of its first use.
        first_line: usize,
    },
    /// A range of voltages reaches beyond what the actuator's records cover.
    #[error(
        "({low_volt}, {high_volt}) V reaches beyond the ({known_low_volt}, {known_high_volt}) V the actuator was identified over; narrow the range, or record wider ones"
    )]
    RangeBeyondRecords {
        /// Lower limit, V.
        low_volt: f64,
        /// Upper limit, V.
        high_volt: f64,
        /// Lower limit of the actuator model, V.
        known_low_volt: f64,
        /// Upper limit of the actuator model, V.
        known_high_volt: f64,
    },
    /// A range is upside down.
    #[error("({low}, {high}) is no range; give the lower limit first, both finite")]
    EmptyRange {
        /// Lower limit.
        low: f64,
        /// Upper limit.
        high: f64,
    },
    /// A path is absolute or leads out of its folder.
    #[error(
        "{path} is not a plain file name inside the data folder; give the name of a file beside dataset.ron"
    )]
    NotPlainFile {
        /// The path.
        path: String,
    },
    // ---- tables ----
    /// A required column is missing.
    #[error(
        "the column `{column}` is missing, the header has {found}; add the column, or correct its name"
    )]
    MissingColumn {
        /// The column wanted, with its unit.
        column: &'static str,
        /// The columns found.
        found: String,
    },
    /// A column has no unit.
    #[error(
        "the column `{found}` has no unit; name it `{expected}` (or `name [unit]`, or give a second row of units in brackets)"
    )]
    MissingUnit {
        /// The column found.
        found: String,
        /// The name expected.
        expected: &'static str,
    },
    /// A column has the wrong unit.
    #[error("the unit is {found}, expected {expected}; {}", unit_remedy(*.factor, .column))]
    WrongUnit {
        /// The full name expected.
        column: &'static str,
        /// The unit found.
        found: String,
        /// The unit expected.
        expected: &'static str,
        /// Factor that converts one into the other, if there is one.
        factor: Option<f64>,
    },
    /// A column nobody knows.
    #[error("unknown column `{found}`{}; known: {known}", suggestion(.nearest.as_ref()))]
    UnknownColumn {
        /// The column found.
        found: String,
        /// All columns known.
        known: String,
        /// The one it resembles most.
        nearest: Option<String>,
    },
    /// A column is there twice.
    #[error("the column `{column}` is there twice; remove one of them")]
    RepeatedColumn {
        /// The column.
        column: &'static str,
    },
    /// A table has too few rows.
    #[error("has {rows} rows of numbers, expected at least {least}; the record may be cut off")]
    TooFewRows {
        /// Rows found.
        rows: usize,
        /// Rows wanted.
        least: usize,
    },
    /// A row has the wrong number of fields.
    #[error(
        "the row has {found} fields, the header has {expected}; check separators and decimal commas"
    )]
    FieldCount {
        /// Fields found.
        found: usize,
        /// Fields wanted.
        expected: usize,
    },
    /// The last line stops early.
    #[error(
        "the last line is cut off (`{text}`, {expected} fields expected and a line end): the file is truncated; copy it again from its source, or delete the last line"
    )]
    Truncated {
        /// The line.
        text: String,
        /// Fields wanted.
        expected: usize,
    },
    /// A field is no number.
    #[error(
        "`{text}` is not a number; expected a decimal number such as -1.25e-3{}",
        if .text.contains(',') { ", with a decimal point: replace the decimal commas" } else { "" }
    )]
    NotANumber {
        /// The field.
        text: String,
    },
    /// A field is NaN or infinite.
    #[error(
        "the value is {value}, expected a finite number; remove the record's bad samples at the source, they are not interpolated here"
    )]
    NotFinite {
        /// The value.
        value: f64,
    },
    /// A number beyond anything that is measured.
    #[error(
        "the value is {value:e}, expected no more than {most:e} in size: no channel of a bench reads so much; remove the record's bad samples at the source, they are not interpolated here"
    )]
    TooLarge {
        /// The number.
        value: f64,
        /// Largest size.
        most: f64,
    },
    /// Time does not increase.
    #[error(
        "time {time_s} s follows {before_s} s, expected increasing time; sort the rows or split the record"
    )]
    TimeNotIncreasing {
        /// Time, s.
        time_s: f64,
        /// Time of the row before, s.
        before_s: f64,
    },
    /// The sampling is not uniform.
    #[error(
        "the time step is {step_s} s, the record's is {usual_s} s, expected uniform sampling; resample the record, or split it at the gap"
    )]
    TimeStepUneven {
        /// The step, s.
        step_s: f64,
        /// Median step of the record, s.
        usual_s: f64,
    },
    /// A command lies outside the actuator's range.
    #[error(
        "the command {voltage_volt} V lies outside command_range_V ({low_volt}, {high_volt}) of dataset.ron; correct the range, or remove the record"
    )]
    CommandOutsideRange {
        /// Command, V.
        voltage_volt: f64,
        /// Lower limit, V.
        low_volt: f64,
        /// Upper limit, V.
        high_volt: f64,
    },
    /// A measured record or its import.
    #[error(transparent)]
    Record(#[from] RecordFault),
    /// Problems of one kind that are not listed one by one.
    #[error("{count} more problems of this kind follow")]
    More {
        /// How many.
        count: usize,
    },
}

fn suggestion(nearest: Option<&String>) -> String {
    nearest.map(|n| format!(", did you mean `{n}`?")).unwrap_or_default()
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

fn unit_remedy(factor: Option<f64>, column: &str) -> String {
    match factor {
        Some(factor) => format!("multiply the column by {factor} and name it `{column}`"),
        None => format!("give the column as `{column}`"),
    }
}

/// One problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Where.
    pub place: Place,
    /// What.
    pub fault: Fault,
}

impl Problem {
    /// A fault at a place.
    pub fn new(place: Place, fault: Fault) -> Self {
        Self { place, fault }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.fault)
    }
}

/// Every problem found in a file or a data folder.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Problems(Vec<Problem>);

impl Problems {
    /// The problems in the order they were found.
    pub fn as_slice(&self) -> &[Problem] {
        &self.0
    }

    /// Adds one.
    pub fn push(&mut self, place: Place, fault: Fault) {
        self.0.push(Problem::new(place, fault));
    }

    /// Adds all of another list.
    pub fn append(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// `value` if there is no problem, else the problems ordered by file and line.
    ///
    /// # Errors
    /// The problems.
    pub fn into_result<T>(mut self, value: Option<T>) -> Result<T, Self> {
        match value {
            Some(value) if self.0.is_empty() => Ok(value),
            _ => {
                self.0.sort_by(|a, b| {
                    let key = |p: &Problem| (p.place.line, p.place.column);
                    a.place.file.cmp(&b.place.file).then(key(a).cmp(&key(b)))
                });
                self.0.dedup();
                Err(self)
            }
        }
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

impl FromIterator<Problem> for Problems {
    fn from_iter<I: IntoIterator<Item = Problem>>(problems: I) -> Self {
        Self(problems.into_iter().collect())
    }
}

impl std::error::Error for Problems {}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.0.len();
        for (index, problem) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
        }
        if count > 1 {
            write!(f, "\n{count} problems")?;
        }
        Ok(())
    }
}

/// The candidate nearest to a word, if it is near enough to be what was meant.
pub(crate) fn nearest<'a>(
    found: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let found = found.to_lowercase();
    let allowed = (found.chars().count() / 3).max(2);
    candidates
        .into_iter()
        .map(|c| (edit_distance(&found, &c.to_lowercase()), c))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, c)| c.to_owned())
}

/// Levenshtein distance: insertions, deletions and replacements that turn `a` into `b`.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &cb) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(nearest("radius", ["radius_m", "blades"]).unwrap(), "radius_m");
        assert_eq!(nearest("uniform", ["Uniform", "Drees"]).unwrap(), "Uniform");
        assert_eq!(nearest("temperature", ["blades", "chord_r"]), None);
    }

    #[test]
    fn problems_are_listed_by_line() {
        let mut problems = Problems::default();
        problems.push(Place::at("a.ron", 9, 2), Fault::UnknownKind);
        problems.push(Place::at("a.ron", 3, 4).field("rotor.blades"), Fault::UnknownKind);
        let text = problems.into_result(Some(())).unwrap_err().to_string();
        assert!(text.starts_with("a.ron:3:4: rotor.blades: is neither"), "{text}");
        assert!(text.ends_with("2 problems"), "{text}");
    }
}
