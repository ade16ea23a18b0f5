//! Spectra of what a model leaves of its records.

use crate::identification::BenchIdentification;
use model_gap::cosine_lines;
use preisach_dyn::identify::{BenchRecord, RecordReport};
use rayon::prelude::*;
use rotor_base::mean_square;
use std::fmt::Write;

/// Upper over lower end of a band.
const BAND: f64 = 1.15;

/// Spectrum of what the model leaves of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualSpectrum {
    /// The run.
    pub id: String,
    /// Middle frequency of each band, Hz, and the root mean square of the lines in it, in the unit of the
    /// output: white noise of a standard deviation has it in every band.
    pub bands: Vec<[f64; 2]>,
    /// Standard deviation of the noise, from repeated cycles; none without them.
    pub noise: Option<f64>,
}

/// Spectrum of the residual, measured less simulated, of every run over the samples judged.
///
/// ```text
/// rms of the band = sqrt( mean of its lines^2 ),  lines: orthonormal cosine transform of the residual
/// ```
pub fn spectra(found: &BenchIdentification, simulated: &[Vec<f64>]) -> Vec<ResidualSpectrum> {
    let zero = found.identification.zero_deg;
    let of = |((record, simulated), report): ((&BenchRecord, &Vec<f64>), &RecordReport)| {
        let window = record.judged_samples();
        let residual = window.map(|i| record.output_deg[i] - zero - simulated[i]);
        ResidualSpectrum {
            id: record.id.clone(),
            bands: bands(&residual.collect::<Vec<_>>(), record.time_step_s),
            noise: report.noise.map(|noise| noise.std_deg),
        }
    };
    let runs = found.records.par_iter().zip(simulated).zip(&found.identification.records);
    runs.map(of).collect()
}

/// Bands of a signal, the first one from the second line on: the first line is its mean.
fn bands(signal: &[f64], time_step_s: f64) -> Vec<[f64; 2]> {
    let lines = cosine_lines(signal);
    let hz = |k: f64| k / (2.0 * time_step_s * lines.len() as f64);
    let mut bands = Vec::new();
    let mut first = 1;
    while first < lines.len() {
        let limit = BAND * first as f64;
        let inside = (first..lines.len()).take_while(|k| *k == first || (*k as f64) < limit);
        let end = first + inside.count();
        let middle = (first as f64 * (end - 1) as f64).sqrt();
        bands.push([hz(middle), mean_square(&lines[first..end]).sqrt()]);
        first = end;
    }
    bands
}

/// The spectra as a table: run, frequency, residual, noise.
pub(crate) fn spectra_csv(spectra: &[ResidualSpectrum], unit: &str) -> String {
    let mut text = format!("run,frequency_Hz,residual{unit},noise{unit}\n");
    for own in spectra {
        let noise = own.noise.map_or_else(String::new, |noise| format!("{noise:.6e}"));
        for [hz, rms] in &own.bands {
            let _ = writeln!(text, "{},{hz:.6e},{rms:.6e},{noise}", own.id);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// White noise is level at its deviation; a sine stands out at its frequency.
    #[test]
    fn bands_tell_noise_from_a_sine() {
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // uniform with variance 1
            (f64::from(state >> 8) / f64::from(1_u32 << 24) - 0.5) * 12.0_f64.sqrt()
        };
        let signal: Vec<f64> =
            (0..8000).map(|i| noise() + (TAU * 0.05 * f64::from(i)).sin()).collect();
        let bands = bands(&signal, 1e-3);
        let largest = bands.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        assert!((largest[0] / 50.0 - 1.0).abs() < 0.1 && largest[1] > 2.0, "{largest:?}");
        let fast: Vec<f64> = bands.iter().filter(|own| own[0] > 100.0).map(|own| own[1]).collect();
        assert!(fast.iter().all(|rms| (rms - 1.0).abs() < 0.15), "{fast:?}");
        assert!(bands.iter().all(|own| own[0] <= 500.0));
    }
}
