//! The records of a diagnosis, in the units of the bench.

use super::base::{mean_square, variance};
use crate::files::{BenchData, LoopData, RunRole, RunUse};

/// One record: input, output and what else was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name of the run.
    pub id: String,
    /// Whether it shows the system with nothing missing.
    pub is_reference: bool,
    /// Time between samples, s.
    pub step_s: f64,
    /// Input: V on a bench.
    pub input: Vec<f64>,
    /// Output: um on a bench.
    pub output: Vec<f64>,
    /// Terminal voltage, V.
    pub amplifier: Option<Vec<f64>>,
    /// Temperature, degrees Celsius.
    pub temperature: Option<Vec<f64>>,
    /// Load on the actuator, N.
    pub load: Option<Vec<f64>>,
}

impl Record {
    /// Whether the run was read by a second, ideal sensor: its name begins with `laser_`.
    pub fn has_ideal_sensor(&self) -> bool {
        self.id.starts_with("laser_")
    }

    /// Whether the lever was preloaded, so that no joint has play: its name begins with `preload_`.
    pub fn is_preloaded(&self) -> bool {
        self.id.starts_with("preload_")
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.step_s * self.input.len() as f64
    }

    /// Frequency of a sine that moves as fast as the input, for its size, Hz: RMS of the rate over the spread.
    pub(crate) fn frequency_hz(&self) -> f64 {
        let rates: Vec<f64> = self.input.windows(2).map(|w| (w[1] - w[0]) / self.step_s).collect();
        let spread = variance(&self.input).sqrt();
        if spread > 0.0 { mean_square(&rates).sqrt() / spread / std::f64::consts::TAU } else { 0.0 }
    }
}

/// Records with their range and units.
#[derive(Debug, Clone, PartialEq)]
pub struct Records {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub folder: String,
    /// The records.
    pub runs: Vec<Record>,
    /// Range of the input.
    pub range: (f64, f64),
    /// Unit of the input.
    pub input_unit: String,
    /// Unit of the output.
    pub output_unit: String,
    /// Name and unit of the input, such as `command_V`.
    pub input_label: String,
    /// Name and unit of the output.
    pub output_label: String,
    /// Flap angle per output, deg/um, if it is an actuator and the data say it.
    pub deg_per_um: Option<f64>,
    /// Whether this is an actuator bench.
    pub is_bench: bool,
    /// blake3 of the data.
    pub content_hash: String,
}

/// A run may be a reference by its role. In a set without any measured run, where the sides of the
/// split are stated, those to be held out are what has to be explained.
fn reference_flags(runs: &[(RunRole, Option<RunUse>)]) -> Vec<bool> {
    let all_reference = runs.iter().all(|r| r.0 == RunRole::Reference);
    let some_held_out = runs.iter().any(|r| r.1 == Some(RunUse::HeldOut));
    runs.iter()
        .map(|r| match r.0 {
            RunRole::Measured => false,
            RunRole::Reference => !(all_reference && some_held_out && r.1 == Some(RunUse::HeldOut)),
        })
        .collect()
}

impl From<&BenchData> for Records {
    fn from(data: &BenchData) -> Self {
        let flags: Vec<_> = data.runs.iter().map(|r| (r.role, r.use_as)).collect();
        let runs = data
            .runs
            .iter()
            .zip(reference_flags(&flags))
            .map(|(run, is_reference)| Record {
                id: run.id.clone(),
                is_reference,
                step_s: run.table.time_step_s,
                input: run.table.command_volt.clone(),
                output: run.table.displacement_um.clone(),
                amplifier: run.table.amplifier_volt.clone(),
                temperature: run.table.temperature_celsius.clone(),
                load: run.table.load_newton.clone(),
            })
            .collect();
        Self {
            title: data.title.clone(),
            folder: data.folder.clone(),
            runs,
            range: data.command_range_volt,
            input_unit: "V".into(),
            output_unit: "um".into(),
            input_label: "command_V".into(),
            output_label: "displacement_um".into(),
            deg_per_um: data.flap_deg_per_um,
            is_bench: true,
            content_hash: data.content_hash.clone(),
        }
    }
}

impl From<&LoopData> for Records {
    fn from(data: &LoopData) -> Self {
        let flags: Vec<_> = data.runs.iter().map(|r| (r.role, r.use_as)).collect();
        let runs = data
            .runs
            .iter()
            .zip(reference_flags(&flags))
            .map(|(run, is_reference)| Record {
                id: run.id.clone(),
                is_reference,
                step_s: run.table.time_step_s,
                input: run.table.input.clone(),
                output: run.table.output.clone(),
                amplifier: None,
                temperature: None,
                load: None,
            })
            .collect();
        Self {
            title: data.title.clone(),
            folder: data.folder.clone(),
            runs,
            range: data.input_range.limits(),
            input_unit: data.channels.input.unit.symbol.to_owned(),
            output_unit: data.channels.output.unit.symbol.to_owned(),
            input_label: data.channels.input.label(),
            output_label: data.channels.output.label(),
            deg_per_um: None,
            is_bench: false,
            content_hash: data.content_hash.clone(),
        }
    }
}
