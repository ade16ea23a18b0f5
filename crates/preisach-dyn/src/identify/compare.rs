//! How well a model reproduces a record.

use super::prepared::Prepared;
use crate::{ActuatorModel, PreisachError, StepCounts};
use rotor_base::wrap_degrees;
use serde::{Deserialize, Serialize};

/// A model against one record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RecordFit {
    /// Root mean square error over the standard deviation of the measured output; over the whole
    /// record, start-up included.
    pub nrmse: f64,
    /// Amplitude error at the strongest harmonic of the command over the steady periods, percent of
    /// the measured one; none for transients.
    pub amplitude_error_percent: Option<f64>,
    /// Phase error there, deg of harmonic phase; positive if the model lags too much.
    pub phase_error_deg: Option<f64>,
    /// What happened to the time steps.
    pub counts: StepCounts,
}

impl RecordFit {
    /// NRMSE in percent.
    pub fn nrmse_percent(&self) -> f64 {
        100.0 * self.nrmse
    }
}

/// Simulates a model over a record and compares.
pub(super) fn compare(
    model: &ActuatorModel,
    prepared: &Prepared,
) -> Result<RecordFit, PreisachError> {
    let Prepared { record, drive, spread_deg, cycles, .. } = prepared;
    let simulation = model.simulate(&record.voltage_volt, record.time_step_s)?;
    let errors = simulation.output_deg.iter().zip(&record.output_deg);
    let squares: f64 = errors.map(|(a, b)| (a - b).powi(2)).sum();
    let nrmse = (squares / record.output_deg.len() as f64).sqrt() / spread_deg;
    let mut fit = RecordFit {
        nrmse,
        amplitude_error_percent: None,
        phase_error_deg: None,
        counts: simulation.counts,
    };
    if let Some(cycles) = cycles {
        let simulated = super::fourier::fit(
            &simulation.output_deg,
            drive.steady.clone(),
            drive.base_hz * record.time_step_s,
            cycles.series.harmonics.len(),
        )?;
        let n = drive.strongest_harmonic;
        let (ours, theirs) = (simulated.series.harmonic(n), cycles.series.harmonic(n));
        fit.amplitude_error_percent = Some(100.0 * (ours.amplitude() / theirs.amplitude() - 1.0));
        fit.phase_error_deg = Some(wrap_degrees(ours.phase_deg() - theirs.phase_deg()));
    }
    Ok(fit)
}
