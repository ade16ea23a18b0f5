//! How well a model fits the records, judged by `model-gap` from simulated outputs: the identification
//! does not mark its own work.

use super::DataHeading;
use crate::SimError;
use crate::problem::Place;
use crate::stored_actuator::{FitUse, StoredFit};
use model_gap::{EnergySplit, FirstHarmonicError, GapError, Misfit, NoiseEstimate, RunError, Use};
use preisach_dyn::identify::{BenchRecord, Identification, RecordUse};
use preisach_dyn::{ActuatorModel, PreisachError};
use rayon::prelude::*;

/// A model against every record, and the static model of the same identification beside it.
///
/// # Errors
/// [`SimError::Actuator`], [`SimError::Loop`] or [`SimError::Misfit`] at the place of the data set.
pub(super) fn judged(
    heading: &DataHeading,
    records: &[BenchRecord],
    identification: &Identification,
    model: &ActuatorModel,
) -> Result<Vec<RunFit>, SimError> {
    judge(records, identification, model).map_err(|e| match e {
        Judged::Model(source) => heading.failed(source),
        Judged::Misfit { id, source } => {
            let place = Place::file(format!("{}/dataset.ron", heading.folder)).field(&id);
            SimError::Misfit { place, source }
        }
    })
}

/// Why a record cannot be judged.
enum Judged {
    Model(PreisachError),
    Misfit { id: String, source: GapError },
}

fn judge(
    records: &[BenchRecord],
    identification: &Identification,
    model: &ActuatorModel,
) -> Result<Vec<RunFit>, Judged> {
    records
        .par_iter()
        .zip(&identification.records)
        .map(|(record, report)| {
            let failed = |source| Judged::Misfit { id: record.id.clone(), source };
            let simulate = |model: &ActuatorModel| {
                let run = model.simulate(&record.voltage_volt, record.time_step_s);
                run.map(|simulation| simulation.output_deg).map_err(Judged::Model)
            };
            let measured: Vec<f64> =
                record.output_deg.iter().map(|y| y - identification.zero_deg).collect();
            let simulated = simulate(model)?;
            let quasi_static = simulate(&identification.static_only)?;
            // simulated from the first sample, judged inside the window
            let window = record.judged_samples();
            let judged = &measured[window.clone()];
            let (drive, step_s) = (&report.drive, record.time_step_s);
            // amplitude, phase and noise from the whole steady cycles of the window
            let steady = drive.steady_within(&window, step_s);
            let first_harmonic = steady
                .clone()
                .map(|steady| {
                    let (y, model) = (&measured[steady.clone()], &simulated[steady]);
                    FirstHarmonicError::of(y, model, step_s, drive.strongest_hz()).map_err(failed)
                })
                .transpose()?;
            // a record without repeats tells no noise
            let noise = steady.and_then(|steady| {
                NoiseEstimate::from_cycles(&measured[steady], step_s, drive.base_hz).ok()
            });
            let structured = noise
                .map(|noise| {
                    let split = EnergySplit::of(judged, &simulated[window.clone()], noise.variance);
                    split.map(|split| split.structured).map_err(failed)
                })
                .transpose()?;
            let misfit = Misfit::of(judged, &simulated[window.clone()]).map_err(failed)?;
            let (low, high) = judged
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &y| (l.min(y), h.max(y)));
            let of_range = 100.0 / (high - low);
            let start_up = StartUp::of(&measured[..window.start], &simulated, misfit.bias);
            Ok(RunFit {
                range_percent: (misfit.rms.powi(2) - misfit.bias.powi(2)).max(0.0).sqrt()
                    * of_range,
                start_up_percent: start_up.map(|miss| miss.largest * of_range),
                start_up_rms_percent: start_up.map(|miss| miss.rms * of_range),
                error: RunError {
                    id: record.id.clone(),
                    used: match report.record_use {
                        RecordUse::Train => Use::Train,
                        RecordUse::HeldOut => Use::HeldOut,
                    },
                    misfit,
                    first_harmonic,
                },
                static_nrmse: Misfit::of(judged, &quasi_static[window]).map_err(failed)?.nrmse,
                structured,
                frequency_hz: drive.strongest_hz(),
                amplitude_volt: drive.amplitude_volt,
            })
        })
        .collect()
}

/// What a model misses before a window, about the mean error inside it, in the unit of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StartUp {
    largest: f64,
    rms: f64,
}

impl StartUp {
    /// None without samples before the window.
    fn of(measured: &[f64], simulated: &[f64], mean_error: f64) -> Option<Self> {
        if measured.is_empty() {
            return None;
        }
        let missed = || measured.iter().zip(simulated).map(|(y, model)| y - model - mean_error);
        let squares: f64 = missed().map(|e| e * e).sum();
        Some(Self {
            largest: missed().map(f64::abs).fold(0.0, f64::max),
            rms: (squares / measured.len() as f64).sqrt(),
        })
    }
}

/// How a model fits one record, over the window of its run if it has one.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFit {
    /// Misfit of the model.
    pub error: RunError,
    /// Root mean square error with its mean removed over the range of the measured output, percent.
    pub range_percent: f64,
    /// Largest error before the window, less the mean error inside, over the range of the measured
    /// output inside, percent: the miss of the start-up. None without a window that begins later.
    pub start_up_percent: Option<f64>,
    /// RMS error of the same samples, percent of the same range.
    pub start_up_rms_percent: Option<f64>,
    /// NRMSE of the static model.
    pub static_nrmse: f64,
    /// Share of the output's energy that is neither explained nor noise; none without repeated cycles.
    pub structured: Option<f64>,
    /// Frequency of the strongest harmonic of the command, Hz.
    pub frequency_hz: f64,
    /// Half peak to peak of the command, V.
    pub amplitude_volt: f64,
}

impl RunFit {
    /// The same as an actuator file holds it.
    pub(super) fn stored(&self) -> StoredFit {
        let first = self.error.first_harmonic.as_ref();
        StoredFit {
            id: self.error.id.clone(),
            use_as: match self.error.used {
                Use::Train => FitUse::Trained,
                Use::HeldOut => FitUse::HeldOut,
            },
            frequency_hz: self.frequency_hz,
            amplitude_volt: self.amplitude_volt,
            nrmse_percent: 100.0 * self.error.misfit.nrmse,
            range_percent: Some(self.range_percent),
            offset: Some(self.error.misfit.bias),
            start_up_percent: self.start_up_percent,
            start_up_rms_percent: self.start_up_rms_percent,
            static_nrmse_percent: 100.0 * self.static_nrmse,
            amplitude_error_percent: first.map(|f| 100.0 * (f.amplitude_ratio - 1.0)),
            phase_error_deg: first.map(|f| f.phase_error_deg),
            structured_percent: self.structured.map(|s| 100.0 * s),
        }
    }
}
