//! The simulation that a diagnosis is asked about, beside the data.

use crate::numbers::{less, slope};
use crate::record::Record;
use model_gap::NoiseDraw;
use preisach_dyn::{ActuatorModel, Drive, PreisachError};
use rotor_base::variance;

/// Error from which on a simulation is not of the bench, rms over the spread of the output, percent. A straight line
/// beside wide loops leaves 25.
const FOREIGN_PERCENT: f64 = 50.0;

/// How far a simulation describes runs in which nothing is missing, and the measured ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenModel {
    /// Error on the reference runs, on the measured ones where there are none: rms over the spread of the output, the
    /// zero left free, percent.
    pub error_percent: f64,
    /// The same on the measured runs.
    pub measured_error_percent: f64,
    /// Motion of the runs of [`Self::error_percent`] over that simulated, by least squares.
    pub scale: f64,
}

impl GivenModel {
    /// How a simulation describes reference and measured runs.
    ///
    /// # Errors
    /// As [`ActuatorModel::simulate_bench`].
    pub fn beside(
        model: &ActuatorModel,
        references: &[&Record],
        measured: &[&Record],
    ) -> Result<Self, PreisachError> {
        let ordinary = if references.is_empty() { measured } else { references };
        let measured_error_percent = error_percent(model, measured)?;
        let (error_percent, scale) = compared(model, ordinary)?;
        Ok(Self { error_percent, measured_error_percent, scale })
    }

    /// Whether the simulation leaves so much that it is of another bench, or its units are.
    pub fn is_foreign(&self) -> bool {
        self.error_percent > FOREIGN_PERCENT
    }
}

/// What a simulation would have read on measured runs, with their own noise drawn anew: reference runs where none were
/// measured.
///
/// # Errors
/// As [`ActuatorModel::simulate_bench`].
pub(crate) fn simulated_runs(
    model: &ActuatorModel,
    measured: &[&Record],
) -> Result<Vec<Record>, PreisachError> {
    let one = |(seed, run): (u64, &&Record)| {
        let mut output = simulated_um(model, run)?;
        let noise = NoiseDraw::SHARP.noise_of(&less(&run.output, &output));
        let drawn = NoiseDraw::SHARP.again(&noise, seed);
        output.iter_mut().zip(drawn).for_each(|(y, noise)| *y += noise);
        let (amplifier, temperature, load) = (None, None, None);
        Ok(Record { is_reference: true, output, amplifier, temperature, load, ..(*run).clone() })
    };
    (1..).zip(measured).map(one).collect()
}

/// What a simulation reads on a run, um.
pub(crate) fn simulated_um(model: &ActuatorModel, run: &Record) -> Result<Vec<f64>, PreisachError> {
    let simulated = model.simulate_bench(&Drive::new(&run.input, run.step_s))?;
    let um = |deg: &f64| model.calibration.displacement_um(*deg);
    Ok(simulated.measured_deg.iter().map(um).collect())
}

/// Error of a simulation on runs, rms over the spread of their output, zero left free, percent; and the motion of the
/// runs over that simulated.
fn compared(model: &ActuatorModel, runs: &[&Record]) -> Result<(f64, f64), PreisachError> {
    let (mut left, mut all, mut both, mut own) = (0.0, 0.0, 0.0, 0.0);
    for run in runs {
        let um = simulated_um(model, run)?;
        let (measured, um) = (run.judged_output(), run.judged(&um));
        let n = measured.len() as f64;
        left += n * variance(&less(measured, um));
        all += n * variance(measured);
        both += n * variance(um) * slope(um, measured);
        own += n * variance(um);
    }
    let scale = if own > 0.0 { both / own } else { 0.0 };
    Ok((100.0 * (left / all.max(1e-300)).sqrt(), scale))
}

/// Error of a simulation on runs, rms over the spread of their output, zero displacement left free, percent.
///
/// # Errors
/// As [`ActuatorModel::simulate_bench`].
pub(crate) fn error_percent(model: &ActuatorModel, runs: &[&Record]) -> Result<f64, PreisachError> {
    compared(model, runs).map(|(percent, _)| percent)
}
