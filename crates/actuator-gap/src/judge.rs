//! How well a model fits the records, judged by `model-gap` from simulated outputs: the identification
//! does not mark its own work.

use crate::{DiagnosisError, HarmonicResponse, StoredFit};
use measured_data::limits;
use model_gap::{EnergySplit, FirstHarmonicError, Misfit, noise_variance};
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::{BenchRecord, Identification, RecordReport};
use rayon::prelude::*;
use std::ops::Range;

/// A record whose fit cannot be judged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("record {id}: {source}")]
pub struct NotJudged {
    /// The record.
    pub id: String,
    /// Why.
    pub source: DiagnosisError,
}

/// A model against every record, and the static model of the same identification beside it.
///
/// # Errors
/// [`NotJudged`] if a model cannot follow a record, or nothing in it moves.
pub fn judged(
    records: &[BenchRecord],
    identification: &Identification,
    model: &ActuatorModel,
) -> Result<Vec<StoredFit>, NotJudged> {
    records
        .par_iter()
        .zip(&identification.records)
        .map(|(record, report)| {
            judge(record, report, identification, model)
                .map_err(|source| NotJudged { id: record.id.clone(), source })
        })
        .collect()
}

fn judge(
    record: &BenchRecord,
    report: &RecordReport,
    identification: &Identification,
    model: &ActuatorModel,
) -> Result<StoredFit, DiagnosisError> {
    let simulate = |model: &ActuatorModel| {
        let run = model.simulate(&record.voltage_volt, record.time_step_s);
        run.map(|simulation| simulation.output_deg)
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
    let against = |steady: &Range<usize>, other: &[f64]| {
        let y = &measured[steady.clone()];
        // a period found from samples is a little off: a sample short is a whole cycle still
        let hz = drive.strongest_hz().max(1.0 / (y.len() as f64 * step_s));
        FirstHarmonicError::of(y, &other[steady.clone()], step_s, hz)
    };
    let first = steady.as_ref().map(|steady| against(steady, &simulated)).transpose()?;
    let command =
        steady.as_ref().map(|steady| against(steady, &record.voltage_volt)).transpose()?;
    let response = steady.as_ref().zip(command).map(|(steady, command)| {
        let scatter = report.noise.map(|noise| noise.std_deg * (2.0 / steady.len() as f64).sqrt());
        response(&command, scatter)
    });
    // a record without repeats tells no noise
    let noise =
        steady.and_then(|steady| noise_variance(&measured[steady], step_s, drive.base_hz).ok());
    let structured = noise
        .map(|noise| EnergySplit::of(judged, &simulated[window.clone()], noise))
        .transpose()?;
    let misfit = Misfit::of(judged, &simulated[window.clone()])?;
    let (low, high) = limits(judged);
    let of_range = 100.0 / (high - low);
    let start_up = start_up(&measured[..window.start], &simulated, misfit.bias);
    let error_without_mean = (misfit.rms.powi(2) - misfit.bias.powi(2)).max(0.0).sqrt();
    Ok(StoredFit {
        id: record.id.clone(),
        use_as: report.record_use,
        frequency_hz: drive.strongest_hz(),
        amplitude_volt: drive.amplitude_volt,
        nrmse_percent: 100.0 * misfit.nrmse,
        range_percent: Some(error_without_mean * of_range),
        offset: Some(misfit.bias),
        start_up_percent: start_up.map(|[largest, _]| largest * of_range),
        start_up_rms_percent: start_up.map(|[_, rms]| rms * of_range),
        static_nrmse_percent: 100.0 * Misfit::of(judged, &quasi_static[window])?.nrmse,
        amplitude_error_percent: first.as_ref().map(|f| 100.0 * (f.amplitude_ratio - 1.0)),
        phase_error_deg: first.map(|f| f.phase_error_deg),
        structured_percent: structured.map(|split| 100.0 * split.structured),
        response,
    })
}

/// Gain and lag of the measured harmonic over the command, which stands in the place of the simulation;
/// `scatter`: standard deviation of the measured amplitude, in the unit of the output.
///
/// ```text
/// sd(a) = sigma sqrt(2 / N),  sd(gain) = sd(a) / a_u,  sd(lag) = sd(a) / a      N samples of white noise sigma
/// ```
fn response(command: &FirstHarmonicError, scatter: Option<f64>) -> HarmonicResponse {
    let [input, output] = [command.simulated, command.measured].map(|own| own.amplitude());
    HarmonicResponse {
        gain: output / input,
        // no minus before zero
        lag_deg: 0.0 - command.phase_error_deg,
        std_deviation: scatter.map(|own| [own / input, (own / output).to_degrees()]),
    }
}

/// What a model misses before a window, about the mean error inside it, in the unit of the output: the
/// largest error and the RMS error; none without samples before the window.
fn start_up(measured: &[f64], simulated: &[f64], mean_error: f64) -> Option<[f64; 2]> {
    if measured.is_empty() {
        return None;
    }
    let missed = || measured.iter().zip(simulated).map(|(y, model)| y - model - mean_error);
    let squares: f64 = missed().map(|e| e * e).sum();
    let largest = missed().map(f64::abs).fold(0.0, f64::max);
    Some([largest, (squares / measured.len() as f64).sqrt()])
}
