//! What can go wrong while a record is generated or written.

use std::path::PathBuf;

/// Every way in which this package fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TruthError {
    /// A physical parameter lies outside the range in which its equation makes sense.
    #[error(
        "{stage}: {parameter} = {value}, but it has to be {expected}; correct the parameter struct"
    )]
    Parameter {
        /// The stage the parameter belongs to.
        stage: &'static str,
        /// The name of the field.
        parameter: &'static str,
        /// The rejected value, in the unit the field name states.
        value: f64,
        /// The accepted range, in words.
        expected: &'static str,
    },
    /// The internal step is not a whole fraction of the sample interval.
    #[error(
        "run {run}: the internal rate of {internal_hz} Hz is not a whole multiple (at least 4) of the \
         record rate of {record_hz} Hz; choose one that is"
    )]
    Rate {
        /// The run's id.
        run: String,
        /// Rate of integration, Hz.
        internal_hz: u32,
        /// Rate of the record, Hz.
        record_hz: u32,
    },
    /// The command leaves the actuator's permitted range.
    #[error(
        "run {run}: the command reaches {voltage_volt} V at {time_s} s, outside {low_volt}..{high_volt} V; \
         lower its amplitude"
    )]
    CommandRange {
        /// The run's id.
        run: String,
        /// Time of the first violation, s.
        time_s: f64,
        /// Commanded voltage there, V.
        voltage_volt: f64,
        /// Lower limit, V.
        low_volt: f64,
        /// Upper limit, V.
        high_volt: f64,
    },
    /// A name that is none of the known ones.
    #[error("{what} {found:?} is not known; known are {known}")]
    UnknownName {
        /// What the name should be one of.
        what: &'static str,
        /// The name found.
        found: String,
        /// The names known.
        known: String,
    },
    /// A file could not be written.
    #[error("cannot write {path}: {source}; check that the folder exists and is writable")]
    Write {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
}

/// Accepts `value` if `accepted`, and otherwise names it.
pub(crate) fn require(
    accepted: bool,
    stage: &'static str,
    parameter: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<(), TruthError> {
    if accepted && value.is_finite() {
        Ok(())
    } else {
        Err(TruthError::Parameter { stage, parameter, value, expected })
    }
}
