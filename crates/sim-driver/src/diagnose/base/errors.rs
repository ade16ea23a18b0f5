//! Errors of the base model: noise of the reading, structure it leaves, and how long that keeps its sign.

use super::super::record::Record;
use nalgebra::{Matrix3, Vector3};

/// What the base model leaves on one run, and how that error is made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ErrorModel {
    /// White noise of the reading, output's unit.
    pub(crate) noise: f64,
    /// Structural error of the model, output's unit, rms.
    pub(crate) structure: f64,
    /// Samples over which the structural error keeps its sign.
    pub(crate) correlation: f64,
}

impl ErrorModel {
    /// Standard deviation that an independent sample would need to weigh as little.
    pub(crate) fn effective(&self) -> f64 {
        (self.noise.powi(2) + self.correlation * self.structure.powi(2)).sqrt()
    }
}

/// What is known of the structure on one kind of run: its size and how long it keeps its sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// Spread of the output.
    spread: f64,
    /// Frequency of the input, Hz: rms rate over rms, over 2 pi.
    frequency_hz: f64,
    /// Structure the fit leaves, rms.
    pub(super) left: f64,
    /// Time over which it keeps its sign, s.
    pub(super) kept_s: f64,
}

impl Seen {
    /// A reference run with what the fit leaves of it.
    pub(super) fn of(run: &Record, residual: &[f64]) -> Self {
        let white = white_noise(residual);
        let total = mean_square(residual);
        // structure under the noise is not seen: no less than a seventh of the noise is granted
        let left = (total - white * white).max(0.02 * white * white).sqrt();
        let kept_s = correlation_samples(residual, white) * run.step_s;
        let (spread, frequency_hz) = place_of(run);
        Self { spread, frequency_hz, left, kept_s }
    }
}

/// Spread of the output and frequency of the input of a run; a run at rest has the frequency of its length.
fn place_of(run: &Record) -> (f64, f64) {
    let rate: f64 = run.input.windows(2).map(|w| ((w[1] - w[0]) / run.step_s).powi(2)).sum();
    let rate = (rate / run.input.len().max(2) as f64).sqrt();
    let rms = variance(&run.input).sqrt();
    let slowest = 1.0 / run.duration_s().max(run.step_s);
    let frequency_hz = if rms > 0.0 { rate / rms / std::f64::consts::TAU } else { slowest };
    (variance(&run.output).sqrt().max(1e-300), frequency_hz.max(slowest))
}

/// Laws of structure over spread and frequency, straight in the logarithms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StructureLaw {
    size: Vector3<f64>,
    time: Vector3<f64>,
    /// Range of spread, frequency, structure and time seen: nothing is carried far beyond it.
    spread: (f64, f64),
    frequency_hz: (f64, f64),
}

/// Slopes of the logarithms that the data have to speak against: structure grows with the root of the
/// output and does not depend on frequency; it keeps its sign over a part of a period.
const USUAL_SIZE: [f64; 2] = [0.5, 0.0];
const USUAL_TIME: [f64; 2] = [0.0, -0.5];
/// How much they may be off, and the scatter of a run about the laws.
const SLOPE_ERROR: f64 = 0.3;
const SCATTER: f64 = 0.5;

impl StructureLaw {
    /// The laws of reference runs.
    pub(super) fn fit(seen: &[Seen]) -> Self {
        let ends = |of: fn(&Seen) -> f64| {
            seen.iter().map(of).fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)))
        };
        Self {
            size: straight(seen, |s| s.left, USUAL_SIZE),
            time: straight(seen, |s| s.kept_s, USUAL_TIME),
            spread: ends(|s| s.spread),
            frequency_hz: ends(|s| s.frequency_hz),
        }
    }

    /// Structure (rms) and the time it keeps its sign on a run.
    pub(super) fn at(&self, run: &Record) -> (f64, f64) {
        let (spread, frequency_hz) = place_of(run);
        let inside = |v: f64, (low, high): (f64, f64)| v.clamp(0.5 * low, 2.0 * high.max(low)).ln();
        let place = Vector3::new(
            1.0,
            inside(spread, self.spread),
            inside(frequency_hz, self.frequency_hz),
        );
        (self.size.dot(&place).exp(), self.time.dot(&place).exp())
    }
}

/// Logarithm of a quantity straight in those of spread and frequency, by least squares with the usual
/// slopes as prior.
fn straight(seen: &[Seen], of: fn(&Seen) -> f64, usual: [f64; 2]) -> Vector3<f64> {
    let prior = Vector3::new(0.0, usual[0], usual[1]);
    let precision = 1.0 / (SLOPE_ERROR * SLOPE_ERROR);
    let mut gram = Matrix3::from_diagonal(&Vector3::new(1e-9, precision, precision));
    let mut right = gram * prior;
    for own in seen {
        let row = Vector3::new(1.0, own.spread.ln(), own.frequency_hz.ln());
        let weight = 1.0 / (SCATTER * SCATTER);
        gram += weight * row * row.transpose();
        right += weight * of(own).max(1e-300).ln() * row;
    }
    gram.cholesky().map_or(prior, |c| c.solve(&right))
}

pub(super) fn pooled_spread(runs: &[&Record]) -> f64 {
    let count: usize = runs.iter().map(|r| r.output.len()).sum();
    let sum: f64 = runs.iter().map(|r| variance(&r.output) * r.output.len() as f64).sum();
    (sum / count.max(1) as f64).sqrt()
}

pub(crate) fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
}

pub(crate) fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64
}

/// White noise under a smooth residual: rms of its second differences over the root of 6, robustly
/// from the median, so that a few jumps do not count.
pub(crate) fn white_noise(residual: &[f64]) -> f64 {
    let mut sizes: Vec<f64> =
        residual.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    // median of |N(0,1)| is 0.6745
    *median / 0.6745 / 6.0_f64.sqrt()
}

/// Integrated correlation of a residual without its noise, samples: one and twice the sum of the
/// correlations up to the first that is not positive.
pub(super) fn correlation_samples(residual: &[f64], noise: f64) -> f64 {
    let n = residual.len();
    let total = mean_square(residual);
    let smooth = total - noise * noise;
    if smooth <= 0.05 * total {
        return 1.0;
    }
    let mut sum = 1.0;
    let mut lag = 1;
    let mut step = 1;
    while lag < n / 4 {
        let products: f64 = residual.iter().zip(&residual[lag..]).map(|(a, b)| a * b).sum::<f64>()
            / (n - lag) as f64;
        let rho = products / smooth;
        if rho <= 0.05 {
            break;
        }
        sum += 2.0 * rho.min(1.0) * step as f64;
        if lag >= 16 {
            step = lag / 8;
        }
        lag += step;
    }
    sum
}
