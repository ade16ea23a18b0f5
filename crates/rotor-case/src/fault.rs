//! What can be wrong with a value of a case, and where: a path of field names such as `flaps[1].start_r`.

use thiserror::Error;

/// What is wrong with a value: what was found, what was expected, what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CaseFault {
    /// A number lies outside its range.
    #[error("is {value}{unit}, expected {low} to {high}{unit}; {remedy}", unit = suffix(.unit))]
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
    /// A number is larger than anything it can stand for.
    #[error("is {value:e}{}, expected at most {most:e}; {remedy}", suffix(.unit))]
    Beyond {
        /// The number found.
        value: f64,
        /// The largest that is taken.
        most: f64,
        /// Unit, empty for a pure number.
        unit: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A rule between fields, or one of a text, a list or a pair, is broken.
    #[error("{message}")]
    Rule {
        /// What is wrong, and what to do.
        message: String,
    },
    /// A value that no rotor or no model can have.
    #[error("is refused: {message}")]
    Refused {
        /// Why, and what to do.
        message: String,
    },
}

impl CaseFault {
    /// Of a number that is to be from `low` to `high`, both included; NaN is outside.
    pub(super) fn of_number(
        value: f64,
        (low, high): (f64, f64),
        unit: &'static str,
        remedy: &'static str,
    ) -> Option<Self> {
        let within = value >= low && value <= high;
        (!within).then_some(Self::OutOfRange { value, low, high, unit, remedy })
    }

    /// Of a count that is to be from `low` to `high`.
    pub(super) fn of_count(
        value: usize,
        (low, high): (usize, usize),
        remedy: &'static str,
    ) -> Option<Self> {
        Self::of_number(value as f64, (low as f64, high as f64), "", remedy)
    }
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// A fault with the path of its field.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field}: {fault}")]
pub struct FieldFault {
    /// Names from the root of the case, `flaps[1].start_r`.
    pub field: String,
    /// What is wrong.
    pub fault: CaseFault,
}

/// Every fault of a case.
#[derive(Debug, Clone, PartialEq, Default, Error)]
#[error("{}", self.0.iter().map(FieldFault::to_string).collect::<Vec<_>>().join("\n"))]
pub struct CaseFaults(pub Vec<FieldFault>);
