//! An actuator file at work: what the flap does under a voltage, which voltage a wanted motion takes.

use crate::SimError;
use crate::files::Source;
use crate::output::Printable;
use crate::problem::Place;
use actuator_gap::{ActuatorUse, UseError};
use bench_study::stored::{StoredActuator, read_actuator};
use bench_study::{BenchError, use_text};
use measured_data::EvenRecord;
use std::path::Path;

/// Uses the actuator of a file on a record of another.
///
/// # Errors
/// Files that cannot be read, a record unevenly sampled or without the columns that are needed, what the actuator cannot do: each
/// at its place.
pub fn used(
    [actuator, record]: [&Path; 2],
    of: fn(&StoredActuator, &EvenRecord) -> Result<ActuatorUse, UseError>,
) -> Result<ActuatorUse, SimError> {
    let own = read_actuator(&Source::read(actuator)?)?;
    let given = EvenRecord::read(&Source::read_or_stdin(record)?)?;
    of(&own, &given).map_err(|error| match error {
        UseError::Record(problem) => problem.into(),
        UseError::Actuator(source) => {
            let place = Place::file(record.display().to_string());
            BenchError::Actuator { place, source }.into()
        }
    })
}

impl Printable for ActuatorUse {
    fn text(&self) -> String {
        use_text(self)
    }
}
