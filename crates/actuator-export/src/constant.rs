//! Named numbers, each with its unit and meaning, and how they are printed.

use crate::ExportError;

/// A number, or numbers, that the generated code knows by name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Constant {
    /// Upper case, unit at the end.
    pub(crate) name: &'static str,
    /// Empty for a pure number.
    pub(crate) unit: &'static str,
    pub(crate) meaning: &'static str,
    pub(crate) value: Value,
}

/// What a constant holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    /// Length of lists, a number of levels.
    Count(usize),
    Scalar(f64),
    List(Vec<f64>),
    /// Rows of a triangle: the first is the longest, each later one shorter.
    Triangle(Vec<Vec<f64>>),
}

impl Constant {
    pub(crate) fn scalar(
        name: &'static str,
        value: f64,
        unit: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self { name, unit, meaning, value: Value::Scalar(value) }
    }

    pub(crate) fn count(name: &'static str, value: usize, meaning: &'static str) -> Self {
        Self { name, unit: "", meaning, value: Value::Count(value) }
    }

    pub(crate) fn list(
        name: &'static str,
        value: Vec<f64>,
        unit: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self { name, unit, meaning, value: Value::List(value) }
    }

    pub(crate) fn triangle(
        name: &'static str,
        value: &[Vec<f64>],
        unit: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self { name, unit, meaning, value: Value::Triangle(value.to_vec()) }
    }

    /// Refuses a number that no language has a word for.
    pub(crate) fn check(&self) -> Result<(), ExportError> {
        let bad = |values: &[f64]| values.iter().copied().find(|value| !value.is_finite());
        let found = match &self.value {
            Value::Count(_) => None,
            Value::Scalar(value) => bad(&[*value]),
            Value::List(values) => bad(values),
            Value::Triangle(rows) => rows.iter().find_map(|row| bad(row)),
        };
        match found {
            Some(value) => Err(ExportError::NotFinite { number: self.name.to_lowercase(), value }),
            None => Ok(()),
        }
    }

    /// Meaning and unit, for a comment.
    pub(crate) fn comment(&self) -> String {
        match self.unit {
            "" => self.meaning.to_owned(),
            unit => format!("{}, {unit}", self.meaning),
        }
    }
}

/// A number that reads back as the same bits.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Numbers between commas, in lines of at most `width` characters that end in `end` and begin with
/// `indent`; the first line is not indented.
pub fn wrapped(values: &[f64], width: usize, indent: &str, end: &str) -> String {
    let mut text = String::new();
    let mut length = 0;
    for (index, &value) in values.iter().enumerate() {
        let word = number(value);
        if index > 0 {
            text.push(',');
            if indent.len() + length + word.len() + 2 > width {
                text.push_str(end);
                text.push('\n');
                text.push_str(indent);
                length = 0;
            } else {
                text.push(' ');
            }
        }
        length += word.len() + 2;
        text.push_str(&word);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        for value in [0.1, 1.0, -1.0 / 3.0, 1e-300, f64::MIN_POSITIVE, 6.02e23, 5e-324] {
            let read: f64 = number(value).parse().unwrap();
            assert_eq!(read.to_bits(), value.to_bits());
            assert!(number(value).contains(['.', 'e']), "an integer in C: {}", number(value));
        }
    }

    #[test]
    fn long_lists_are_broken_into_lines() {
        let text = wrapped(&[1.0, 2.0, 3.0, 4.0], 12, "  ", "");
        assert_eq!(text, "1.0, 2.0,\n  3.0, 4.0");
    }
}
