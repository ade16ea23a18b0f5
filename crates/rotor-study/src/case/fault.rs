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
    /// A text or a list is empty.
    #[error("is empty; give {of}")]
    Empty {
        /// What it should hold.
        of: &'static str,
    },
    /// Something that must be unique is there twice.
    #[error("`{name}` is used already at {first}; give every {of} once")]
    Repeated {
        /// The value.
        name: String,
        /// What it stands for.
        of: &'static str,
        /// Field of its first use.
        first: String,
    },
    /// A range is upside down.
    #[error("({low}, {high}) is no range; give the lower limit first, both finite")]
    EmptyRange {
        /// Lower limit.
        low: f64,
        /// Upper limit.
        high: f64,
    },
    /// A flap does not fit between the cut-out, its neighbour and the tip.
    #[error(
        "the flap spans {start_r} R to {end_r} R, expected {from_r} R (cut-out or the flap before) <= start_r < end_r <= 1 R; keep it on the blade, and list flaps from root to tip without overlap"
    )]
    FlapSpan {
        /// Inboard edge, R.
        start_r: f64,
        /// Outboard edge, R.
        end_r: f64,
        /// Where the free span begins, R.
        from_r: f64,
    },
    /// The control voltage leaves the actuator's range.
    #[error(
        "the voltage {bias_volt} V +- {amplitude_volt} V leaves the actuator's range {low_volt} V to {high_volt} V; lower control.amplitude_V to {room_volt} V or move control.bias_V"
    )]
    VoltageOutsideRange {
        /// Bias, V.
        bias_volt: f64,
        /// Amplitude, V.
        amplitude_volt: f64,
        /// Lower limit, V.
        low_volt: f64,
        /// Upper limit, V.
        high_volt: f64,
        /// Largest amplitude about this bias, V.
        room_volt: f64,
    },
    /// Two fields that do not go together.
    #[error("{rule}")]
    Conflict {
        /// What is wrong, and what to do.
        rule: &'static str,
    },
    /// A value that no rotor or no model can have.
    #[error("is refused: {message}")]
    Refused {
        /// Why, and what to do.
        message: String,
    },
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
