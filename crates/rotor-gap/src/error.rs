//! What can go wrong in the diagnosis of a rotor.

use flap_aero::AeroError;
use model_gap::GapError;
use rotor_study::StudyError;

/// A diagnosis that cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RotorGapError {
    /// A column whose name says nothing.
    #[error("the column `{name}` is not known: {reason}")]
    Column {
        /// The column.
        name: String,
        /// What was expected.
        reason: String,
    },
    /// No point of the sweep can be flown.
    #[error("no point of the sweep can be flown; the first: {first}")]
    NoPoint {
        /// Why the first one cannot.
        first: String,
    },
    /// A field that is said to be uncertain.
    #[error("uncertain[{number}]: `{field}` {reason}")]
    Uncertain {
        /// Its number, from 0.
        number: usize,
        /// The field.
        field: String,
        /// What is wrong.
        reason: String,
    },
    /// The rotor of a point.
    #[error("point {point}: {source}")]
    Study {
        /// The point.
        point: String,
        /// Why.
        source: Box<StudyError>,
    },
    /// A mode that was measured and that the simulated blade does not have.
    #[error(
        "the blade has no mode `{mode}`: it has {found}; raise `structure.modes` or `structure.elements` of the case"
    )]
    Mode {
        /// The mode.
        mode: String,
        /// What it has.
        found: String,
    },
    /// The section at a motion.
    #[error("{point}: {source}")]
    Section {
        /// The motion.
        point: String,
        /// Why.
        source: AeroError,
    },
    /// The engine.
    #[error(transparent)]
    Gap(#[from] GapError),
}
