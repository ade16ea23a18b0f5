//! Problems of user files: what is wrong, where, what was expected and the remedy.

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
///
/// A variant is what is found in several places; what one check alone finds is said by
/// [`Fault::Other`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// What was found, what is expected, what to do.
    #[error("{0}")]
    Other(String),
    /// A value was read but makes no sense: what its own check said.
    #[error("is refused: {message}")]
    Refused {
        /// What was found, what is expected, what to do.
        message: String,
    },

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
    /// A file is too large to be read whole.
    #[error(
        "has {megabytes} MB, more than the {limit_megabytes} MB read at once; `hhc import FILE -o DIR` streams it and averages it to fewer samples"
    )]
    TooLarge {
        /// Size, MB.
        megabytes: u64,
        /// Limit, MB.
        limit_megabytes: u64,
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
    /// The text is not RON.
    #[error(
        "is not valid RON: {message}; check brackets, commas and quotes just before this place"
    )]
    Syntax {
        /// What the reader said.
        message: String,
    },
    /// A key, choice or column that is not known.
    #[error("unknown {what} `{found}`{}; known here: {known}", suggestion(.nearest.as_ref()))]
    Unknown {
        /// `key`, `choice` or `column`.
        what: &'static str,
        /// The word found.
        found: String,
        /// The words known there.
        known: String,
        /// The known word it resembles most.
        nearest: Option<String>,
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
    /// A list or text is empty.
    #[error("is empty; give {of}")]
    Empty {
        /// What it should hold.
        of: &'static str,
    },

    // ---- tables ----
    /// A column is not there.
    #[error("the column `{wanted}` is missing, the header has {found}; {remedy}")]
    MissingColumn {
        /// The column wanted.
        wanted: String,
        /// The columns found.
        found: String,
        /// What to do.
        remedy: &'static str,
    },
    /// It is not said which columns are input and output.
    #[error(
        "the columns {columns} leave open which is the input and which the output; say it: {remedy}"
    )]
    AmbiguousColumns {
        /// The columns besides the time.
        columns: String,
        /// How to say it.
        remedy: &'static str,
    },
    /// Two runs of a data set have different columns.
    #[error("the columns are {found}, those of the runs before {expected}; convert one of them")]
    OtherColumns {
        /// Columns found.
        found: String,
        /// Columns of the runs before.
        expected: String,
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
        "`{text}` is not a number; expected a decimal number such as -1.25e-3{}; write plain numbers into the cells",
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
    /// Time does not increase.
    #[error(
        "time {time_s} s follows {before_s} s, expected increasing time; sort the rows, or import with --split, which parts the record there"
    )]
    TimeNotIncreasing {
        /// Time, s.
        time_s: f64,
        /// Time of the row before, s.
        before_s: f64,
    },
    /// The sampling is not uniform.
    #[error(
        "the time step is {step_s} s, the record's is {usual_s} s, expected uniform sampling; at a gap import with --split, which parts the record there; where the stamps scatter and the sampling does not, leave them out: --columns -,command_V,displacement_um --sampling-hz HZ"
    )]
    TimeStepUneven {
        /// The step, s.
        step_s: f64,
        /// Usual step of the record, s.
        usual_s: f64,
    },
}

impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        Self::Unreadable { reason: error.to_string() }
    }
}

impl Fault {
    /// The fault of a range that is none: upside down, or not finite.
    pub(crate) fn of_range((low, high): (f64, f64)) -> Option<Self> {
        let is_range = low.is_finite() && high.is_finite() && low < high;
        let message =
            format!("({low}, {high}) is no range; give the lower limit first, both finite");
        (!is_range).then_some(Self::Other(message))
    }
}

fn suggestion(nearest: Option<&String>) -> String {
    nearest.map(|n| format!(", did you mean `{n}`?")).unwrap_or_default()
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// One problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {fault}")]
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

/// Every problem found in a file or a data folder.
#[derive(Debug, Clone, PartialEq, Default, thiserror::Error)]
#[error("{}", listed(.0))]
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

    /// The value of a result; without one, its problem is added.
    pub fn note<T>(&mut self, result: Result<T, Problem>) -> Option<T> {
        result.map_err(|problem| self.0.push(problem)).ok()
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
                self.0.sort_by_cached_key(|Problem { place, .. }| {
                    (place.file.clone(), place.line, place.column)
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

fn listed(problems: &[Problem]) -> String {
    let mut lines: Vec<String> = problems.iter().map(Problem::to_string).collect();
    if lines.len() > 1 {
        lines.push(format!("{} problems", lines.len()));
    }
    lines.join("\n")
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
        .map(|c| (strsim::levenshtein(&found, &c.to_lowercase()), c))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, c)| c.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        assert_eq!(nearest("radius", ["radius_m", "blades"]).unwrap(), "radius_m");
        assert_eq!(nearest("uniform", ["Uniform", "Drees"]).unwrap(), "Uniform");
        assert_eq!(nearest("temperature", ["blades", "chord_r"]), None);
    }

    #[test]
    fn problems_are_listed_by_line() {
        let mut problems = Problems::default();
        problems.push(Place::at("a.ron", 9, 2), Fault::Empty { of: "a name" });
        let place = Place::at("a.ron", 3, 4).field("rotor.blades");
        problems.push(place, Fault::Empty { of: "a number" });
        let text = problems.into_result(Some(())).unwrap_err().to_string();
        assert!(text.starts_with("a.ron:3:4: rotor.blades: is empty; give"), "{text}");
        assert!(text.ends_with("2 problems"), "{text}");
    }
}
