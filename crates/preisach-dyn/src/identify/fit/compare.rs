//! How well a model reproduces a record.

use crate::check::extremes;
use crate::identify::records::fourier;
use crate::identify::records::prepared::Prepared;
use crate::identify::records::record::spread;
use crate::{ActuatorModel, PreisachError, StepCounts};
use rotor_base::{mean_square, wrap_degrees};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A model against one record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RecordFit {
    /// Root mean square error over the standard deviation of the measured output; over the judged
    /// samples: the whole record, start-up included, unless the record says otherwise.
    pub nrmse: f64,
    /// Root mean square error with its mean removed over the range of the measured output, percent;
    /// over the judged samples.
    pub range_percent: f64,
    /// Largest error before the judged samples, less the mean error of the judged ones, over the range
    /// of the measured output, percent: the miss of the start-up. None if everything is judged.
    pub start_up_percent: Option<f64>,
    /// Amplitude error at the strongest harmonic of the command over the steady periods judged,
    /// percent of the measured one; none for transients.
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

/// Simulates a model over a record from its first sample and compares.
pub(crate) fn compare(
    model: &ActuatorModel,
    prepared: &Prepared,
) -> Result<RecordFit, PreisachError> {
    let Prepared { record, drive, .. } = prepared;
    let simulation = model.simulate(&record.voltage_volt, record.time_step_s)?;
    let (ours, theirs) = (&simulation.output_deg, &record.output_deg);
    let judged = record.judged_samples();
    let error = |i: usize| ours[i] - theirs[i];
    let count = judged.len() as f64;
    let mean_error = judged.clone().map(error).sum::<f64>() / count;
    let squares: f64 = judged.clone().map(|i| error(i).powi(2)).sum();
    let about_mean: f64 = judged.clone().map(|i| (error(i) - mean_error).powi(2)).sum();
    let measured = &theirs[judged.clone()];
    let [low, high] = extremes(measured.iter().copied());
    let of_range = 100.0 / (high - low);
    let start_up = (judged.start > 0).then(|| {
        // what lies before the samples that train, or else before those that judge
        let end = record.windows.train.as_ref().map_or(judged.start, |w| w.start.min(judged.start));
        (0..end).fold(0.0, |m, i| (error(i) - mean_error).abs().max(m)) * of_range
    });
    let mut fit = RecordFit {
        nrmse: (squares / count).sqrt() / spread(measured),
        range_percent: (about_mean / count).sqrt() * of_range,
        start_up_percent: start_up,
        amplitude_error_percent: None,
        phase_error_deg: None,
        counts: simulation.counts,
    };
    if let Some(steady) = drive.steady_within(&judged, record.time_step_s) {
        let count = drive.harmonics_within(record.time_step_s, HARMONICS);
        let per_sample = drive.base_hz * record.time_step_s;
        let n = drive.strongest_harmonic;
        let series =
            |values: &[f64]| fourier::fit(values, steady.clone(), per_sample, count.max(n));
        let (ours, theirs) = (series(ours)?.series.harmonic(n), series(theirs)?.series.harmonic(n));
        fit.amplitude_error_percent = Some(100.0 * (ours.amplitude() / theirs.amplitude() - 1.0));
        fit.phase_error_deg = Some(wrap_degrees(ours.phase_deg() - theirs.phase_deg()));
    }
    Ok(fit)
}

/// NRMSE over the samples of a record that train: what choices may rest on.
pub(crate) fn training_nrmse(
    model: &ActuatorModel,
    prepared: &Prepared,
) -> Result<f64, PreisachError> {
    nrmse_over(model, prepared, prepared.record.trained_samples())
}

/// Root mean square error over some samples of a record, run from its first, over the spread of those that train.
pub(crate) fn nrmse_over(
    model: &ActuatorModel,
    prepared: &Prepared,
    samples: Range<usize>,
) -> Result<f64, PreisachError> {
    let Prepared { record, spread_deg, .. } = prepared;
    let simulation = model.simulate(&record.voltage_volt[..samples.end], record.time_step_s)?;
    let errors = samples.map(|i| simulation.output_deg[i] - record.output_deg[i]);
    Ok(mean_square(&errors.collect::<Vec<_>>()).sqrt() / spread_deg)
}

/// Harmonics fitted to the steady periods to find amplitude and phase of one.
const HARMONICS: usize = 20;
