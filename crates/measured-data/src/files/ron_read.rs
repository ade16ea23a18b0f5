//! Reading RON: every unknown key and every wrongly typed value in one pass, each with its place.

use super::{RonIndex, Source};
use crate::problem::{Fault, Problems, nearest};
use ron::error::{Error as RonError, SpannedError};
use ron::extensions::Extensions;
use ron::ser::PrettyConfig;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ops::Range;

/// A RON file: the value if it could be read, the places of its fields, and what was wrong.
#[derive(Debug, Clone)]
pub struct RonFile<T> {
    /// The value. Fields that could not be read hold their defaults; then there are problems.
    pub value: Option<T>,
    /// The places of its fields.
    pub index: RonIndex,
    /// What could not be read.
    pub problems: Problems,
}

/// Most problems of one file looked for; a file with more is not the file that was meant.
const MOST_PROBLEMS: usize = 50;

fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// Reads a RON text, going on behind unknown keys and values of the wrong type.
///
/// The RON reader stops at the first flaw. A flaw that belongs to one field is noted, the field is
/// blanked out, and the text is read again: the report then holds every such flaw.
pub fn read_ron<T: DeserializeOwned>(source: &Source) -> RonFile<T> {
    let index = RonIndex::new(&source.name, &source.text);
    let mut text = source.text.clone();
    let mut problems = Problems::default();
    let mut blanked: Vec<String> = Vec::new();
    let options = options();
    for _ in 0..MOST_PROBLEMS {
        let error = match options.from_str::<T>(&text) {
            Ok(value) => return RonFile { value: Some(value), index, problems },
            Err(error) => error,
        };
        let field = note(&error, &index, &blanked, &mut problems);
        let Some((path, range)) = field.filter(|(path, _)| !blanked.contains(path)) else { break };
        blanked.push(path);
        blank(&mut text, range);
    }
    RonFile { value: None, index, problems }
}

/// Writes a value as readable RON.
///
/// # Errors
/// The error of the RON writer: a value that RON cannot express.
pub fn ron_text<T: Serialize>(value: &T) -> Result<String, RonError> {
    let pretty = PrettyConfig::new().separate_tuple_members(false).compact_arrays(true);
    let text = options().to_string_pretty(value, pretty)?;
    Ok(format!("#![enable(implicit_some, unwrap_variant_newtypes)]\n{text}\n"))
}

/// Notes an error; returns the path and the bytes of the field it belongs to, if it is confined to one.
fn note(
    error: &SpannedError,
    index: &RonIndex,
    blanked: &[String],
    problems: &mut Problems,
) -> Option<(String, Range<usize>)> {
    let start = index.byte(error.span.start.line, error.span.start.col);
    let end = index.byte(error.span.end.line, error.span.end.col).max(start);
    let ranges = [start..end, start..start, end..end];
    let entry = ranges.iter().find_map(|r| index.innermost(r));
    let section = match entry {
        Some(entry) => index.place_of_byte(entry.start).field(&entry.path),
        None => index.place_of_byte(start),
    };
    match (&error.code, entry) {
        (RonError::MissingStructField { field, .. }, _) => {
            let inside = entry.map(|e| format!("{}.{field}", e.path));
            let name = inside.as_deref().unwrap_or(field);
            let suffix = format!(".{field}");
            // a field blanked out above is not missing
            if !blanked.iter().any(|b| b == name || b.ends_with(&suffix)) {
                let message = format!("the key `{field}` is missing; add `{field}: ...`");
                problems.push(section, Fault::Other(message));
            }
            return None;
        }
        (RonError::DuplicateStructField { field, .. }, _) => {
            let message = format!("the key `{field}` is given twice; remove one of them");
            problems.push(section, Fault::Other(message));
            return None;
        }
        (code, Some(entry)) => {
            // the reader may take the front part of a number for the whole: 4 of 4.5
            let value = index.text(&entry.value);
            let inside = entry.value.start < start && start < entry.value.end;
            let front = inside && !value.contains(['(', '[', '{', '"']);
            let part =
                || wrong_type(&format!("`{value}` is not a value of the kind expected here"));
            if let Some(fault) = field_fault(code).or_else(|| front.then(part)) {
                problems.push(section, fault);
                return Some((entry.path.clone(), entry.start..entry.value.end));
            }
        }
        (_, None) => {}
    }
    problems.push(index.place_of_byte(start), Fault::Syntax { message: sentence(&error.code) });
    None
}

/// What is wrong with a field, if the error is about one field alone.
fn field_fault(code: &RonError) -> Option<Fault> {
    match code {
        RonError::NoSuchStructField { expected, found, .. } => {
            Some(unknown("key", found, expected))
        }
        RonError::NoSuchEnumVariant { expected, found, .. } => {
            Some(unknown("choice", found, expected))
        }
        RonError::InvalidValueForType { .. }
        | RonError::ExpectedDifferentLength { .. }
        | RonError::ExpectedFloat
        | RonError::ExpectedInteger
        | RonError::ExpectedBoolean
        | RonError::ExpectedString
        | RonError::ExpectedArray
        | RonError::ExpectedStructLike
        | RonError::ExpectedNamedStructLike(_)
        | RonError::ExpectedIdentifier
        | RonError::ExpectedOption
        | RonError::ExpectedUnit
        | RonError::IntegerOutOfBounds
        | RonError::InvalidIntegerDigit { .. } => Some(wrong_type(&sentence(code))),
        RonError::Message(message) => Some(Fault::Refused { message: message.clone() }),
        _ => None,
    }
}

fn unknown(what: &'static str, found: &str, expected: &[&'static str]) -> Fault {
    let nearest = nearest(found, expected.iter().copied());
    Fault::Unknown { what, found: found.to_owned(), known: expected.join(", "), nearest }
}

fn wrong_type(message: &str) -> Fault {
    Fault::Other(format!(
        "has the wrong type: {message}; write one as the page of file formats shows it, of a case `hhc init` too"
    ))
}

/// The RON reader's own words, beginning in lower case.
fn sentence(code: &RonError) -> String {
    let text = code.to_string();
    let mut chars = text.chars();
    chars.next().into_iter().flat_map(char::to_lowercase).chain(chars).collect()
}

/// Replaces bytes and the comma behind them by blanks; lines stay where they are.
fn blank(text: &mut String, range: Range<usize>) {
    let behind = &text[range.end..];
    let comma = behind.trim_start().starts_with(',').then(|| behind.find(',')).flatten();
    let end = range.end + comma.map_or(0, |c| c + 1);
    let blanks: String =
        text[range.start..end].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect();
    text.replace_range(range.start..end, &blanks);
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields, default)]
    struct Inner {
        radius_m: f64,
        blades: usize,
    }

    impl Default for Inner {
        fn default() -> Self {
            Self { radius_m: 4.94, blades: 4 }
        }
    }

    #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
    enum Choice {
        #[default]
        Uniform,
        Given(Inner),
    }

    #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields, default)]
    struct Outer {
        rotor: Inner,
        choice: Choice,
        optional: Option<f64>,
        list: Vec<Inner>,
    }

    fn read(text: &str) -> RonFile<Outer> {
        read_ron(&Source { name: "t.ron".into(), text: text.into() })
    }

    #[test]
    fn good_text_is_read_and_written_back() {
        let file =
            read("(rotor: (radius_m: 5), choice: Given(blades: 2), optional: 3, list: [(), ()])");
        assert!(file.problems.is_empty(), "{}", file.problems);
        let value = file.value.unwrap();
        assert_eq!(value.choice, Choice::Given(Inner { radius_m: 4.94, blades: 2 }));
        let again = read(&ron_text(&value).unwrap());
        assert_eq!(again.value.unwrap(), value);
    }

    #[test]
    fn all_flaws_are_reported_each_with_its_place() {
        let file = read(
            "(\n  rotor: (\n    radius: 5,\n    blades: 4.5,\n  ),\n  choice: Unifrom,\n  list: [(radius_m: \"x\")],\n  flaps: 3\n)",
        );
        let text = file.problems.to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 6, "{text}");
        assert!(
            lines[0].starts_with(
                "t.ron:3:5: rotor.radius: unknown key `radius`, did you mean `radius_m`?"
            ),
            "{text}"
        );
        assert!(lines[1].starts_with("t.ron:4:5: rotor.blades: has the wrong type"), "{text}");
        assert!(
            lines[2].starts_with(
                "t.ron:6:3: choice: unknown choice `Unifrom`, did you mean `Uniform`?"
            ),
            "{text}"
        );
        assert!(lines[3].starts_with("t.ron:7:11: list[0].radius_m: has the wrong type"), "{text}");
        assert!(lines[4].starts_with("t.ron:8:3: flaps: unknown key"), "{text}");
        assert!(file.value.is_some(), "the rest is read");
    }

    #[test]
    fn broken_syntax_has_a_place() {
        let file = read("(\n  rotor: (radius_m: 5,\n");
        let text = file.problems.to_string();
        assert!(
            text.starts_with("t.ron:3:1: is not valid RON") || text.starts_with("t.ron:2:"),
            "{text}"
        );
        let file = read("(rotor: (radius_m: 5) choice: Uniform)");
        assert!(file.problems.to_string().contains("expected comma"), "{}", file.problems);
        let file = read("(optional: 1, optional: 2)");
        assert!(file.problems.to_string().contains("given twice"), "{}", file.problems);
    }
}
