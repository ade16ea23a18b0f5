//! An actuator at work: what it does under a voltage, which voltage a wanted motion takes.

use super::history_inverse::{HistoryInverseSettings, history_inverse};
use crate::StoredActuator;
use measured_data::Channel;
use measured_data::import::{EvenRecord, RecordColumn};
use measured_data::problem::{Fault, Place, Problem};
use preisach_dyn::identify::{BenchRecord, Finding, Subject, Waveform};
use preisach_dyn::{Drive, PreisachError};
use serde::Serialize;

const FLAP: &str = "flap_deg";

/// Why an actuator cannot be used on a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UseError {
    /// The record.
    #[error(transparent)]
    Record(#[from] Problem),
    /// The actuator.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
}

/// An actuator over one record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ActuatorUse {
    /// Title of the actuator.
    pub actuator: String,
    /// Name of the record.
    pub record: String,
    /// Time between two samples, s.
    pub step_s: f64,
    /// Names of the columns of input and output, with their units.
    pub columns: [String; 2],
    /// Names of the columns of the record that they were read from, with their units; none of what is no column of it.
    pub read_from: [Option<String>; 2],
    /// How far the output is from what is beside it; none of a prediction with nothing beside it.
    pub error: Option<Deviation>,
    /// Samples whose voltage is an end of the range; none of a prediction.
    pub at_limit: Option<usize>,
    /// Simulations of an inverse; none of a prediction.
    pub simulations: Option<usize>,
    /// What is suspect about the record, a sentence each; of an inverse nothing is looked at.
    pub suspicions: Vec<String>,
    /// The samples.
    #[serde(skip)]
    pub samples: Vec<UseSample>,
}

/// A voltage under which an actuator moves as wanted, and what is left of the wanted motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Commanded {
    /// Voltage at every sample, in the unit of the input.
    pub input: Vec<f64>,
    /// Motion under it, in the unit of the wanted one.
    pub output: Vec<f64>,
    /// How far that motion is from the wanted one.
    pub error: Deviation,
    /// Samples whose voltage is an end of the range.
    pub at_limit: usize,
    /// Simulations it took.
    pub simulations: usize,
}

/// How far an output is from what was measured or wanted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Deviation {
    /// Whether it was wanted, not measured.
    pub is_wanted: bool,
    /// Rms, in the unit of the output.
    pub rms: f64,
    /// Largest, in the unit of the output.
    pub largest: f64,
    /// Rms over the standard deviation of what is beside it, percent.
    pub nrmse_percent: f64,
    /// Mean of output less what is beside it, in the unit of the output.
    pub mean: f64,
}

/// One sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UseSample {
    /// Time, s.
    pub time_s: f64,
    /// Input.
    pub input: f64,
    /// Output.
    pub output: f64,
    /// What was measured or wanted; none of a prediction with nothing beside it.
    pub beside: Option<f64>,
}

/// An output column of a record: its name, what it was read from, whether it is a displacement.
type Output = (String, RecordColumn, bool);

/// The output that a record has beside its times.
fn output_of(own: &StoredActuator, record: &EvenRecord) -> Result<Option<Output>, Problem> {
    let (input, output) = (own.input_column(), own.output_column());
    if let Some(own) = record.column(&output, &input)? {
        return Ok(Some((output, own, true)));
    }
    // another angle than that of its name is no flap
    Ok(record.column(FLAP, FLAP)?.map(|own| (FLAP.to_owned(), own, false)))
}

/// Flap angles in the unit of an output column.
fn shown(own: &StoredActuator, angles_deg: &[f64], is_displacement: bool) -> Vec<f64> {
    let calibration = own.model.calibration;
    let one = |deg: &f64| if is_displacement { calibration.displacement_um(*deg) } else { *deg };
    angles_deg.iter().map(one).collect()
}

/// An error with what to do about a record that goes beyond the range.
fn remedied(error: PreisachError, record: &str, column: &str) -> UseError {
    if !matches!(error, PreisachError::VoltageOutOfRange { .. }) {
        return error.into();
    }
    let message = format!(
        "{error}: identify the actuator from runs that go as far; the numbers of a monitor output are brought back with --scale {column}=FACTOR"
    );
    Problem::new(Place::file(record), Fault::Other(message)).into()
}

/// How far outputs are from what is beside them.
fn deviation_of(output: &[f64], beside: &[f64], is_wanted: bool) -> Deviation {
    let off: Vec<f64> = output.iter().zip(beside).map(|(own, beside)| own - beside).collect();
    let rms = rotor_base::mean_square(&off).sqrt();
    let largest = off.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
    let nrmse_percent = 100.0 * rms / rotor_base::variance(beside).sqrt();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    Deviation { is_wanted, rms, largest, nrmse_percent, mean }
}

/// What an import would say of input and output: spikes, an output that falls, leads or is clipped.
fn suspicions(
    own: &StoredActuator,
    record: &EvenRecord,
    [input, output]: [&[f64]; 2],
    is_displacement: bool,
) -> Vec<String> {
    // an actuator's records are told in V and um, or deg
    let subject = match &own.channels {
        Some(channels) => {
            let unit = |label: &str| Channel::parse(label).map_or("", |own| own.unit.symbol);
            Subject::Loop { input_unit: unit(&channels.input), output_unit: unit(&channels.output) }
        }
        None if is_displacement => Subject::Displacement,
        None => Subject::Actuator,
    };
    let given = BenchRecord {
        id: record.name.clone(),
        time_step_s: record.step_s,
        voltage_volt: input.to_vec(),
        output_deg: output.to_vec(),
        ..BenchRecord::default()
    };
    let (mended, mut found) = given.without_spikes().unwrap_or((given, Vec::new()));
    // noise and drift of a rest are no fault of it
    if mended.drive().waveform != Waveform::Constant {
        found.extend(mended.suspicions(false));
    }
    let told = |own: &Finding| format!("{}; {}", subject.finding(own), subject.remedy(own));
    found.iter().map(told).collect()
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

impl StoredActuator {
    /// What it does under the commands of a record; beside what was measured, where the record has it.
    ///
    /// # Errors
    /// [`UseError`]: no command or two of its name, a command outside the range.
    pub fn predicted(&self, record: &EvenRecord) -> Result<ActuatorUse, UseError> {
        let (input, output) = (self.input_column(), self.output_column());
        let command = record.column(&input, &output)?.ok_or_else(|| record.missing(&input))?;
        let measured = output_of(self, record)?;
        let (name, is_displacement) = match &measured {
            Some((name, _, is_displacement)) => (name.clone(), *is_displacement),
            None => (output, true),
        };
        let output = self
            .output_under(&command.values, record.step_s, is_displacement)
            .map_err(|error| remedied(error, &record.name, &command.name))?;
        let beside = measured.as_ref().map(|own| &own.1.values[..]);
        let samples = samples(&record.time_s, &command.values, &output, beside);
        Ok(ActuatorUse {
            actuator: self.title.clone(),
            record: record.name.clone(),
            step_s: record.step_s,
            columns: [input, name],
            read_from: [Some(command.label), measured.as_ref().map(|own| own.1.label.clone())],
            error: beside.map(|beside| deviation_of(&output, beside, false)),
            at_limit: None,
            simulations: None,
            suspicions: measured.as_ref().map_or_else(Vec::new, |own| {
                let [input, output] = [&command.values, &own.1.values];
                suspicions(self, record, [input, output], is_displacement)
            }),
            samples,
        })
    }

    /// The voltage under which it moves as a record wants. A motion out of reach is no error: what is left of it is told.
    ///
    /// # Errors
    /// [`UseError`]: no motion or two of its name, an actuator that does not move.
    pub fn inverted(&self, record: &EvenRecord) -> Result<ActuatorUse, UseError> {
        let (name, wanted, is_displacement) =
            output_of(self, record)?.ok_or_else(|| record.missing(&self.output_column()))?;
        let found = self.command_for(&wanted.values, record.step_s, is_displacement)?;
        let samples = samples(&record.time_s, &found.input, &found.output, Some(&wanted.values));
        Ok(ActuatorUse {
            actuator: self.title.clone(),
            record: record.name.clone(),
            step_s: record.step_s,
            columns: [self.input_column(), name],
            read_from: [None, Some(wanted.label)],
            error: Some(found.error),
            at_limit: Some(found.at_limit),
            simulations: Some(found.simulations),
            suspicions: Vec::new(),
            samples,
        })
    }

    /// What it does under a command: the displacement as its sensor reads it, in the unit of its data, or the flap angle, deg.
    ///
    /// | argument | meaning | unit |
    /// |---|---|---|
    /// | `command` | input at every sample | V, or the unit of its data |
    /// | `step_s` | time between two samples, above 0 | s |
    ///
    /// # Errors
    /// As [`ActuatorModel::simulate_bench`](preisach_dyn::ActuatorModel::simulate_bench).
    pub fn output_under(
        &self,
        command: &[f64],
        step_s: f64,
        is_displacement: bool,
    ) -> Result<Vec<f64>, PreisachError> {
        let found = self.model.simulate_bench(&Drive::new(command, step_s))?;
        let angles = if is_displacement { &found.measured_deg } else { &found.output_deg };
        Ok(shown(self, angles, is_displacement))
    }

    /// The command under which it moves as wanted: a displacement in the unit of its data, or a flap angle, deg. What is out of
    /// reach stays as error.
    ///
    /// # Errors
    /// As [`history_inverse`].
    pub fn command_for(
        &self,
        wanted: &[f64],
        step_s: f64,
        is_displacement: bool,
    ) -> Result<Commanded, PreisachError> {
        let calibration = self.model.calibration;
        let angle =
            |value: &f64| if is_displacement { calibration.output_deg(*value) } else { *value };
        let angles: Vec<f64> = wanted.iter().map(angle).collect();
        let settings = HistoryInverseSettings::default();
        let found = history_inverse(&self.model, &angles, step_s, &settings)?;
        let output = shown(self, &found.output_deg, is_displacement);
        Ok(Commanded {
            error: deviation_of(&output, wanted, true),
            input: found.voltage_volt,
            output,
            at_limit: found.at_limit,
            simulations: found.iterations,
        })
    }
}
