//! An actuator at work: what it does under a voltage, which voltage a wanted motion takes.

use crate::StoredActuator;
use measured_data::EvenRecord;
use measured_data::problem::Problem;
use preisach_dyn::{Drive, HistoryInverseSettings, PreisachError};
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
    /// How far the output is from what is beside it; none of a prediction with nothing beside it.
    pub error: Option<Deviation>,
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
pub struct Deviation {
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
    /// Time, s.
    pub time_s: f64,
    /// Input.
    pub input: f64,
    /// Output.
    pub output: f64,
    /// What was measured or wanted; none of a prediction with nothing beside it.
    pub beside: Option<f64>,
}

/// An output column of a record: its name, its values, whether it is a displacement.
type Output = (String, Vec<f64>, bool);

/// The output that a record has beside its times.
fn output_of(own: &StoredActuator, record: &EvenRecord) -> Result<Option<Output>, Problem> {
    if let Some((name, values)) = record.one_of(&own.output_columns())? {
        return Ok(Some((name, values, true)));
    }
    Ok(record.one_of(&[FLAP.to_owned()])?.map(|(name, values)| (name, values, false)))
}

/// Flap angles in the unit of an output column.
fn shown(own: &StoredActuator, angles_deg: &[f64], is_displacement: bool) -> Vec<f64> {
    let calibration = own.model.calibration;
    let one = |deg: &f64| if is_displacement { calibration.displacement_um(*deg) } else { *deg };
    angles_deg.iter().map(one).collect()
}

/// How far outputs are from what is beside them.
fn deviation_of(samples: &[UseSample], is_wanted: bool) -> Option<Deviation> {
    let beside: Vec<f64> = samples.iter().filter_map(|own| own.beside).collect();
    let off: Vec<f64> = samples.iter().filter_map(|own| Some(own.output - own.beside?)).collect();
    let rms = rotor_base::mean_square(&off).sqrt();
    let largest = off.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
    let nrmse_percent = 100.0 * rms / rotor_base::variance(&beside).sqrt();
    (!beside.is_empty()).then_some(Deviation { is_wanted, rms, largest, nrmse_percent })
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
    /// [`UseError`]: no command, blank cells, a command outside the range.
    pub fn predicted(&self, record: &EvenRecord) -> Result<ActuatorUse, UseError> {
        let inputs = self.input_columns();
        let (input, command) = record.one_of(&inputs)?.ok_or_else(|| record.missing(&inputs[0]))?;
        let measured = output_of(self, record)?;
        let (name, is_displacement) = match &measured {
            Some((name, _, is_displacement)) => (name.clone(), *is_displacement),
            None => (self.output_columns().swap_remove(0), true),
        };
        let found = self.model.simulate_bench(&Drive::new(&command, record.step_s))?;
        // a displacement is what its sensor reads
        let angles = if is_displacement { &found.measured_deg } else { &found.output_deg };
        let output = shown(self, angles, is_displacement);
        let beside = measured.as_ref().map(|own| &own.1[..]);
        let samples = samples(&record.time_s, &command, &output, beside);
        Ok(ActuatorUse {
            actuator: self.title.clone(),
            record: record.table.header_place().file,
            step_s: record.step_s,
            columns: [input, name],
            error: deviation_of(&samples, false),
            at_limit: None,
            simulations: None,
            samples,
        })
    }

    /// The voltage under which it moves as a record wants. A motion out of reach is no error: what is left of it is told.
    ///
    /// # Errors
    /// [`UseError`]: no motion, blank cells, an actuator that does not move.
    pub fn inverted(&self, record: &EvenRecord) -> Result<ActuatorUse, UseError> {
        let (name, wanted, is_displacement) =
            output_of(self, record)?.ok_or_else(|| record.missing(&self.output_columns()[0]))?;
        let calibration = self.model.calibration;
        let angle =
            |value: &f64| if is_displacement { calibration.output_deg(*value) } else { *value };
        let angles: Vec<f64> = wanted.iter().map(angle).collect();
        let settings = HistoryInverseSettings::default();
        let found = self.model.history_inverse(&angles, record.step_s, &settings)?;
        let output = shown(self, &found.output_deg, is_displacement);
        let samples = samples(&record.time_s, &found.voltage_volt, &output, Some(&wanted));
        Ok(ActuatorUse {
            actuator: self.title.clone(),
            record: record.table.header_place().file,
            step_s: record.step_s,
            columns: [self.input_columns().swap_remove(0), name],
            error: deviation_of(&samples, true),
            at_limit: Some(found.at_limit),
            simulations: Some(found.iterations),
            samples,
        })
    }
}
