//! One bench run: integrated finely, recorded coarsely.

use std::fmt::Write as _;

use crate::actuator::ActuatorParameters;
use crate::command::Command;
use crate::error::TruthError;
use crate::lvdt::Lvdt;
use crate::stage::Stage;

/// Rate at which every record is integrated, Hz.
pub const INTERNAL_RATE_HZ: u32 = 16_000;

/// What is done on the bench.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Short unique name; also the name of the file.
    pub id: String,
    /// One sentence for the reader of the data set.
    pub note: String,
    /// Rate of the record, Hz.
    pub sample_rate_hz: u32,
    /// Rest at the bias at the beginning of the record, s.
    pub rest_s: f64,
    /// What is commanded afterwards.
    pub command: Command,
}

/// Samples of one run, equally spaced from time zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Rate, Hz.
    pub sample_rate_hz: u32,
    /// Command, V.
    pub command_volt: Vec<f64>,
    /// Displacement, um; zero is the settled actuator at the bias.
    pub displacement_um: Vec<f64>,
}

impl Run {
    /// Number of samples, the one at time zero included.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a duration times a rate is a small positive number"
    )]
    pub fn samples(&self, bias_volt: f64) -> usize {
        let duration_s = self.rest_s + self.command.duration_s(bias_volt);
        (duration_s * f64::from(self.sample_rate_hz) + 1e-6).floor() as usize + 1
    }

    /// Passes the command through a chain that has rested at the bias; one output a sample.
    ///
    /// # Errors
    /// [`TruthError::Rate`] if the internal rate is not a multiple, at least fourfold, of the record
    /// rate; [`TruthError::CommandRange`] if the command leaves the permitted voltages.
    pub fn pass_through(
        &self,
        chain: &mut dyn Stage,
        actuator: &ActuatorParameters,
        internal_hz: u32,
    ) -> Result<Record, TruthError> {
        let substeps = self.substeps(internal_hz)?;
        let fine = self.pass_through_finely(chain, actuator, internal_hz)?;
        let (command_volt, displacement_um) = fine.into_iter().step_by(substeps).unzip();
        Ok(Record { sample_rate_hz: self.sample_rate_hz, command_volt, displacement_um })
    }

    /// As [`Run::pass_through`], with every internal step: pairs of command and output.
    ///
    /// # Errors
    /// As [`Run::pass_through`].
    pub fn pass_through_finely(
        &self,
        chain: &mut dyn Stage,
        actuator: &ActuatorParameters,
        internal_hz: u32,
    ) -> Result<Vec<(f64, f64)>, TruthError> {
        let steps = (self.samples(actuator.bias_volt) - 1) * self.substeps(internal_hz)?;
        let dt_s = 1.0 / f64::from(internal_hz);
        let mut signal = vec![(actuator.bias_volt, chain.settle(actuator.bias_volt))];
        for step in 1..=steps {
            let time_s = step as f64 * dt_s;
            let voltage_volt = self.command.voltage_volt(actuator.bias_volt, time_s - self.rest_s);
            if !(actuator.low_volt..=actuator.high_volt).contains(&voltage_volt) {
                return Err(TruthError::CommandRange {
                    run: self.id.clone(),
                    time_s,
                    voltage_volt,
                    low_volt: actuator.low_volt,
                    high_volt: actuator.high_volt,
                });
            }
            signal.push((voltage_volt, chain.step(voltage_volt, dt_s)));
        }
        Ok(signal)
    }

    /// Internal steps in one sample interval.
    ///
    /// # Errors
    /// [`TruthError::Rate`] if they are not a whole number of at least 4.
    pub fn substeps(&self, internal_hz: u32) -> Result<usize, TruthError> {
        let substeps = internal_hz / self.sample_rate_hz.max(1);
        if substeps < 4 || substeps * self.sample_rate_hz != internal_hz {
            return Err(TruthError::Rate {
                run: self.id.clone(),
                internal_hz,
                record_hz: self.sample_rate_hz,
            });
        }
        Ok(substeps as usize)
    }
}

impl Record {
    /// The record as the sensor sees it.
    #[must_use]
    pub fn measured_by(&self, sensor: &mut Lvdt) -> Self {
        let displacement_um = self.displacement_um.iter().map(|&y| sensor.read_um(y)).collect();
        Self { displacement_um, ..self.clone() }
    }

    /// The record as text: a header with units, then one line a sample.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("time_s,command_V,displacement_um\n");
        for (i, (u, y)) in self.command_volt.iter().zip(&self.displacement_um).enumerate() {
            let time_s = i as f64 / f64::from(self.sample_rate_hz);
            // Adding zero turns a negative zero into a positive one; a String takes every write.
            let _ = writeln!(text, "{time_s:.4},{:.4},{:.4}", u + 0.0, y + 0.0);
        }
        text
    }
}
