//! An actuator file at work: what the flap does under a voltage, which voltage a wanted motion takes.

use crate::SimError;
use crate::files::Source;
use crate::output::Printable;
use crate::problem::{Place, Problem};
use actuator_gap::{ActuatorUse, UseError};
use bench_study::stored::{StoredActuator, read_actuator};
use bench_study::{BenchError, use_text};
use measured_data::EvenRecord;
use measured_data::import::ColumnOptions;
use std::path::Path;

/// What an actuator does with a record: [`StoredActuator::predicted`] or [`StoredActuator::inverted`].
pub type Work = fn(&StoredActuator, &EvenRecord) -> Result<ActuatorUse, UseError>;

/// Uses the actuator of a file on a record of another; also what a reader should know of how the record was read. `columns` and
/// `sampling_hz` say of the record what it does not say itself, see [`EvenRecord::open`].
///
/// # Errors
/// Files that cannot be read, a record unevenly sampled or without the columns that are needed, what the actuator cannot do: each
/// at its place.
pub fn used(
    [actuator, record]: [&Path; 2],
    (columns, sampling_hz): (&ColumnOptions, Option<f64>),
    of: Work,
) -> Result<(ActuatorUse, Vec<Problem>), SimError> {
    let own = read_actuator(&Source::read(actuator)?)?;
    let given = EvenRecord::open(record, columns, sampling_hz)?;
    let used = of(&own, &given).map_err(|error| match error {
        UseError::Record(problem) => SimError::from(problem),
        UseError::Actuator(source) => {
            let place = Place::file(&given.name);
            BenchError::Actuator { place, source }.into()
        }
    })?;
    Ok((used, given.warnings))
}

impl Printable for ActuatorUse {
    fn text(&self) -> String {
        use_text(self)
    }
}
