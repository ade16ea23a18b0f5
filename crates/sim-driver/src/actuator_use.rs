//! An actuator file at work: what the flap does under a voltage, which voltage a wanted motion takes.

use crate::SimError;
use crate::files::{Source, significant};
use crate::output::{Column, Printable, Sheet, csv_of};
use crate::problem::Place;
use actuator_gap::{ActuatorUse, UseError, UseSample};
use bench_study::BenchError;
use bench_study::stored::{StoredActuator, read_actuator};
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

/// The samples as CSV: time, input, output, and what is beside it.
pub fn samples_csv(own: &ActuatorUse) -> String {
    let [input, output] = &own.columns;
    let word = own.error.as_ref().map(|own| if own.is_wanted { "wanted" } else { "measured" });
    let beside = word.map(|word| format!("{word}_{output}"));
    let mut columns: Vec<Column<'_, UseSample>> = vec![
        ("time_s", &|own| own.time_s.to_string()),
        (input, &|own| own.input.to_string()),
        (output, &|own| own.output.to_string()),
    ];
    if let Some(name) = &beside {
        columns.push((name, &|own| own.beside.unwrap_or_default().to_string()));
    }
    csv_of(own.samples.iter().copied(), &columns)
}

/// An error, with an exponent where it is next to nothing.
fn told(error: f64) -> String {
    if error < 1e-4 { format!("{error:.1e}") } else { significant(error, 3).to_string() }
}

impl Printable for ActuatorUse {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let range = |of: fn(&UseSample) -> f64| {
            let all = self.samples.iter().map(of);
            let (low, high) =
                all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
            format!("{} to {}", significant(low, 5), significant(high, 5))
        };
        sheet.labelled("Actuator", &self.actuator);
        let (count, step) = (self.samples.len(), significant(self.step_s, 6));
        sheet.labelled("Record", &format!("{}, {count} samples, step {step} s", self.record));
        sheet.labelled("Input", &format!("{}: {}", self.columns[0], range(|own| own.input)));
        sheet.labelled("Output", &format!("{}: {}", self.columns[1], range(|own| own.output)));
        if let Some(error) = &self.error {
            let of = if error.is_wanted { "of the wanted" } else { "of the measured" };
            sheet.labelled(
                "Error",
                &format!(
                    "rms {}, largest {}; {} % rms of the deviation {of} motion",
                    told(error.rms),
                    told(error.largest),
                    told(error.nrmse_percent)
                ),
            );
        }
        if let (Some(at_limit), Some(simulations)) = (self.at_limit, self.simulations) {
            let text = if at_limit == 0 {
                format!("within the range at every sample; {simulations} simulations")
            } else {
                format!(
                    "at the end of the range at {at_limit} samples: the motion is out of reach there; ask for less, or shift it"
                )
            };
            sheet.labelled("Voltage", &text);
        }
        sheet.finish()
    }
}
