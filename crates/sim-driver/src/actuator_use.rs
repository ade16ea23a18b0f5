//! An actuator file at work: what the flap does under a voltage, which voltage a wanted motion takes.

use crate::SimError;
use crate::files::{Source, significant};
use crate::output::{Column, Printable, Sheet, csv_of};
use crate::problem::{Fault, Place, Problem};
use crate::stored_actuator::{StoredActuator, read_actuator};
use measured_data::PointCsv;
use preisach_dyn::{Drive, HistoryInverseSettings};
use serde::Serialize;
use std::path::Path;

const TIME: &str = "time_s";
const COMMAND: &str = "command_V";
const DISPLACEMENT: &str = "displacement_um";
const FLAP: &str = "flap_deg";
/// Part of a step by which another may differ.
const EVEN: f64 = 0.01;

/// An actuator over one record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ActuatorUse {
    /// Title of the actuator.
    pub actuator: String,
    /// File of the record.
    pub record: String,
    /// Time between two samples, s.
    pub step_s: f64,
    /// Names of the columns of input and output, with their units.
    pub columns: [String; 2],
    /// How far the output is from what is beside it; none of a prediction with nothing beside it.
    pub error: Option<UseError>,
    /// Samples whose voltage is an end of the range; none of a prediction.
    pub at_limit: Option<usize>,
    /// Simulations of an inverse; none of a prediction.
    pub simulations: Option<usize>,
    /// The samples.
    #[serde(skip)]
    pub samples: Vec<UseSample>,
}

/// How far an output is from what was measured or wanted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UseError {
    /// Whether it was wanted, not measured.
    pub is_wanted: bool,
    /// Rms, in the unit of the output.
    pub rms: f64,
    /// Largest, in the unit of the output.
    pub largest: f64,
    /// Rms over the standard deviation of what is beside it, percent.
    pub nrmse_percent: f64,
}

/// One sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UseSample {
    time_s: f64,
    input: f64,
    output: f64,
    beside: Option<f64>,
}

/// A table of a record, evenly sampled.
struct Record {
    table: PointCsv,
    time_s: Vec<f64>,
    step_s: f64,
}

impl Record {
    fn read(path: &Path) -> Result<Self, SimError> {
        let table = PointCsv::read(&Source::read(path)?, &[])?;
        let time_s = table.full_column(TIME, "give the time of every sample, s")?;
        let [first, .., last] = time_s[..] else {
            let message = "one sample is no record: give two or more".to_owned();
            return Err(Problem::new(table.place(0, TIME), Fault::Refused { message }).into());
        };
        let step_s = (last - first) / (time_s.len() - 1) as f64;
        let is_even = |pair: &[f64]| (pair[1] - pair[0] - step_s).abs() <= EVEN * step_s;
        if let Some(row) = time_s.windows(2).position(|pair| !(step_s > 0.0 && is_even(pair))) {
            let message = format!(
                "{} s after the sample before, expected {step_s} s: give evenly spaced samples (`hhc import` resamples no record)",
                time_s[row + 1] - time_s[row]
            );
            let place = table.place(row + 1, TIME);
            return Err(Problem::new(place, Fault::Refused { message }).into());
        }
        Ok(Self { table, time_s, step_s })
    }

    /// The first of some columns that is there, with its name.
    fn one_of(&self, names: &[&str]) -> Result<Option<(String, Vec<f64>)>, SimError> {
        let Some(name) = names.iter().find(|name| self.table.has(name)) else { return Ok(None) };
        let values = self.table.full_column(name, "give every sample")?;
        Ok(Some(((*name).to_owned(), values)))
    }

    fn missing(&self, wanted: &str) -> SimError {
        self.table.missing(wanted, "name the columns in the first line, with units").into()
    }
}

/// An actuator with the names of its columns.
struct Named {
    stored: StoredActuator,
    input: Vec<String>,
    /// Of displacement, then of the flap angle.
    output: [Vec<String>; 2],
}

impl Named {
    fn read(path: &Path) -> Result<Self, SimError> {
        let stored = read_actuator(&Source::read(path)?)?;
        let (mut input, mut displacement) =
            (vec![COMMAND.to_owned()], vec![DISPLACEMENT.to_owned()]);
        if let Some(channels) = &stored.channels {
            input.insert(0, channels.input.clone());
            displacement.insert(0, channels.output.clone());
        }
        Ok(Self { stored, input, output: [displacement, vec![FLAP.to_owned()]] })
    }

    /// What the output column of a record is, as flap angles: its name, its values, and whether it is a displacement.
    fn output(&self, record: &Record) -> Result<Option<(String, Vec<f64>, bool)>, SimError> {
        for (names, is_displacement) in self.output.iter().zip([true, false]) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            if let Some((name, values)) = record.one_of(&names)? {
                return Ok(Some((name, values, is_displacement)));
            }
        }
        Ok(None)
    }

    /// A flap angle in the unit of a column.
    fn shown(&self, deg: f64, is_displacement: bool) -> f64 {
        if is_displacement { self.stored.model.calibration.displacement_um(deg) } else { deg }
    }

    fn failed(path: &Path, source: preisach_dyn::PreisachError) -> SimError {
        SimError::Actuator { place: Place::file(path.display().to_string()), source }
    }
}

/// How far outputs are from what is beside them.
fn error_of(samples: &[UseSample], is_wanted: bool) -> Option<UseError> {
    let beside: Vec<f64> = samples.iter().filter_map(|own| own.beside).collect();
    let off: Vec<f64> = samples.iter().filter_map(|own| Some(own.output - own.beside?)).collect();
    let rms = rotor_base::mean_square(&off).sqrt();
    let largest = off.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
    let nrmse_percent = 100.0 * rms / rotor_base::variance(&beside).sqrt();
    (!beside.is_empty()).then_some(UseError { is_wanted, rms, largest, nrmse_percent })
}

fn samples(
    time_s: &[f64],
    input: &[f64],
    output: &[f64],
    beside: Option<&[f64]>,
) -> Vec<UseSample> {
    let rows = time_s.iter().zip(input).zip(output).enumerate();
    rows.map(|(k, ((time_s, input), output))| UseSample {
        time_s: *time_s,
        input: *input,
        output: *output,
        beside: beside.map(|own| own[k]),
    })
    .collect()
}

/// What an actuator does under the commands of a record.
///
/// # Errors
/// Files that cannot be read, a record without `time_s` and command or unevenly sampled, commands outside the range: each at
/// its place.
pub fn predict(actuator: &Path, record_file: &Path) -> Result<ActuatorUse, SimError> {
    let (own, record) = (Named::read(actuator)?, Record::read(record_file)?);
    let inputs: Vec<&str> = own.input.iter().map(String::as_str).collect();
    let (input, command) = record.one_of(&inputs)?.ok_or_else(|| record.missing(inputs[0]))?;
    let measured = own.output(&record)?;
    let (name, is_displacement) = match &measured {
        Some((name, _, is_displacement)) => (name.clone(), *is_displacement),
        None => (own.output[0][0].clone(), true),
    };
    let drive = Drive::new(&command, record.step_s);
    let found = own.stored.model.simulate_bench(&drive);
    let found = found.map_err(|source| Named::failed(record_file, source))?;
    // a displacement is what its sensor reads
    let angles = if is_displacement { &found.measured_deg } else { &found.output_deg };
    let output: Vec<f64> = angles.iter().map(|deg| own.shown(*deg, is_displacement)).collect();
    let beside = measured.as_ref().map(|own| &own.1[..]);
    let samples = samples(&record.time_s, &command, &output, beside);
    Ok(ActuatorUse {
        actuator: own.stored.title,
        record: record_file.display().to_string(),
        step_s: record.step_s,
        columns: [input, name],
        error: error_of(&samples, false),
        at_limit: None,
        simulations: None,
        samples,
    })
}

/// The voltage under which an actuator moves as wanted.
///
/// # Errors
/// Files that cannot be read, a record without `time_s` and a motion or unevenly sampled, an actuator that does not move: each
/// at its place. A motion out of reach is no error: what is left of it is in the result.
pub fn invert(actuator: &Path, record_file: &Path) -> Result<ActuatorUse, SimError> {
    let (own, record) = (Named::read(actuator)?, Record::read(record_file)?);
    let (name, wanted, is_displacement) =
        own.output(&record)?.ok_or_else(|| record.missing(&own.output[0][0]))?;
    let calibration = own.stored.model.calibration;
    let as_angle =
        |value: &f64| if is_displacement { calibration.output_deg(*value) } else { *value };
    let angles: Vec<f64> = wanted.iter().map(as_angle).collect();
    let settings = HistoryInverseSettings::default();
    let found = own.stored.model.history_inverse(&angles, record.step_s, &settings);
    let found = found.map_err(|source| Named::failed(record_file, source))?;
    let output: Vec<f64> =
        found.output_deg.iter().map(|deg| own.shown(*deg, is_displacement)).collect();
    let samples = samples(&record.time_s, &found.voltage_volt, &output, Some(&wanted));
    Ok(ActuatorUse {
        actuator: own.stored.title,
        record: record_file.display().to_string(),
        step_s: record.step_s,
        columns: [own.input[0].clone(), name],
        error: error_of(&samples, true),
        at_limit: Some(found.at_limit),
        simulations: Some(found.iterations),
        samples,
    })
}

impl ActuatorUse {
    /// The samples as CSV: time, input, output, and what is beside it with the error.
    pub fn csv(&self) -> String {
        let [input, output] = &self.columns;
        let word = self.error.as_ref().map(|own| if own.is_wanted { "wanted" } else { "measured" });
        let beside = word.map(|word| format!("{word}_{output}"));
        let mut columns: Vec<Column<'_, UseSample>> = vec![
            (TIME, &|own| own.time_s.to_string()),
            (input, &|own| own.input.to_string()),
            (output, &|own| own.output.to_string()),
        ];
        if let Some(name) = &beside {
            columns.push((name, &|own| own.beside.unwrap_or_default().to_string()));
        }
        csv_of(self.samples.iter().copied(), &columns)
    }
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
