//! Fourier series of steady cycles: averages the cycles, and is the only thing differentiated.

use crate::PreisachError;
use nalgebra::{DMatrix, DVector};
use rotor_base::{Harmonic, HarmonicSeries, LANES, Lanes, Number as _};
use std::f64::consts::TAU;
use std::ops::Range;

/// A Fourier series fitted to samples over whole periods.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FourierFit {
    /// The series about `phase(i)`.
    pub(crate) series: HarmonicSeries,
    /// Cycles per sample.
    cycles_per_sample: f64,
    /// Standard deviation of what the series leaves: noise, and whatever does not repeat.
    pub(crate) noise: f64,
}

impl FourierFit {
    /// Phase of a sample, rad.
    fn phase_rad(&self, index: usize) -> f64 {
        TAU * (self.cycles_per_sample * index as f64).fract()
    }

    /// Sine and cosine of the phases of at most [`LANES`] samples.
    fn unit(&self, samples: Range<usize>) -> [Lanes; 2] {
        let mut of = [Lanes::default(); 2];
        for (lane, index) in samples.take(LANES).enumerate() {
            (of[0].0[lane], of[1].0[lane]) = self.phase_rad(index).sin_cos();
        }
        of
    }

    /// Value at a sample, and its time derivative per sample.
    pub(crate) fn value_and_rate(&self, index: usize) -> (f64, f64) {
        let [value, rate, _] = self.series.value_and_rates(self.phase_rad(index));
        (value, rate * TAU * self.cycles_per_sample)
    }
}

/// Least squares fit of mean and `count` harmonics to the samples of a range.
///
/// # Errors
/// [`PreisachError::OutOfRange`] if the samples cannot carry the harmonics.
pub(crate) fn fit(
    values: &[f64],
    range: Range<usize>,
    cycles_per_sample: f64,
    count: usize,
) -> Result<FourierFit, PreisachError> {
    let unknowns = 2 * count + 1;
    let mut right = DVector::zeros(unknowns);
    let mut result =
        FourierFit { series: HarmonicSeries::zero(count), cycles_per_sample, noise: 0.0 };
    // sums of cos n phi and sin n phi over the samples: products of two harmonics are made of them
    let mut sums = vec![(0.0, 0.0); unknowns];
    // some samples side by side: a harmonic waits for the one before it
    for first in range.clone().step_by(LANES) {
        let places = first..range.end.min(first + LANES);
        let samples = &values[places.clone()];
        let [sin1, cos1] = result.unit(places);
        let (mut s, mut c) = (Lanes::default(), Lanes::of(1.0));
        for (n, sum) in sums.iter_mut().enumerate() {
            for (lane, value) in samples.iter().enumerate() {
                let (s, c) = (s.0[lane], c.0[lane]);
                *sum = (sum.0 + c, sum.1 + s);
                if n == 0 {
                    right[0] += value;
                } else if n <= count {
                    right[2 * n - 1] += c * value;
                    right[2 * n] += s * value;
                }
            }
            (c, s) = (c * cos1 - s * sin1, s * cos1 + c * sin1);
        }
    }
    // unknown k is of harmonic (k + 1) / 2; a sine if k is even, and the mean is a cosine
    let normal = DMatrix::from_fn(unknowns, unknowns, |i, j| {
        let (low, high) = (i.min(j), i.max(j));
        let (a, b) = (low.div_ceil(2), high.div_ceil(2));
        let is_sine = |k: usize| k > 0 && k.is_multiple_of(2);
        let (less, more) = (sums[b - a], sums[b + a]);
        match (is_sine(low), is_sine(high)) {
            (false, false) => 0.5 * (less.0 + more.0),
            (true, true) => 0.5 * (less.0 - more.0),
            (false, true) => 0.5 * (more.1 + less.1),
            (true, false) => 0.5 * (more.1 - less.1),
        }
    });
    let Some(factor) = normal.cholesky().filter(|_| range.len() >= unknowns) else {
        let (quantity, value) = ("samples of steady cycles", range.len() as f64);
        let expected = format!("at least {unknowns} and not all alike").into();
        return Err(PreisachError::OutOfRange { quantity, value, expected });
    };
    let solution = factor.solve(&right);
    result.series.mean = solution[0];
    for (n, h) in result.series.harmonics.iter_mut().enumerate() {
        *h = Harmonic { cosine: solution[2 * n + 1], sine: solution[2 * n + 2] };
    }
    let mut left = 0.0;
    for first in range.clone().step_by(LANES) {
        let places = first..range.end.min(first + LANES);
        let [sin, cos] = result.unit(places.clone());
        let fitted = result.series.value_of(sin, cos);
        for (value, fitted) in values[places].iter().zip(fitted.0) {
            left += (value - fitted).powi(2);
        }
    }
    let freedom = (range.len() - unknowns).max(1);
    result.noise = (left / freedom as f64).sqrt();
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use chacha20::ChaCha8Rng;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    /// 2 + 3 sin + 0.5 cos 3 at 66.67 samples per cycle.
    fn signal(i: usize) -> f64 {
        let psi = TAU * i as f64 * 0.015;
        2.0 + 3.0 * psi.sin() + 0.5 * (3.0 * psi).cos()
    }

    #[test]
    fn a_series_is_found_exactly_though_a_cycle_is_no_whole_number_of_samples() {
        let values: Vec<f64> = (0..500).map(signal).collect();
        let found = fit(&values, 100..300, 0.015, 8).unwrap();
        assert_abs_diff_eq!(found.series.mean, 2.0, epsilon = 1e-12);
        assert_abs_diff_eq!(found.series.harmonic(1).sine, 3.0, epsilon = 1e-12);
        assert_abs_diff_eq!(found.series.harmonic(3).cosine, 0.5, epsilon = 1e-12);
        assert!(found.noise < 1e-12);
        let (value, rate) = found.value_and_rate(777);
        assert_abs_diff_eq!(value, signal(777), epsilon = 1e-11);
        let central = 0.5 * (signal(778) - signal(776));
        assert_abs_diff_eq!(rate, central, epsilon = 3e-2);
    }

    #[test]
    fn noise_is_measured_and_hardly_reaches_the_derivative() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let noise = Normal::new(0.0, 0.02).unwrap();
        let values: Vec<f64> = (0..2000).map(|i| signal(i) + noise.sample(&mut rng)).collect();
        let found = fit(&values, 0..2000, 0.015, 10).unwrap();
        assert!((found.noise / 0.02 - 1.0).abs() < 0.1, "{}", found.noise);
        let exact = fit(&(0..2000).map(signal).collect::<Vec<_>>(), 0..2000, 0.015, 10).unwrap();
        let square = |rate: f64, i: usize| (rate - exact.value_and_rate(i).1).powi(2);
        let (series, differences) = (1..1999).fold((0.0, 0.0), |(a, b), i| {
            let central = 0.5 * (values[i + 1] - values[i - 1]);
            (a + square(found.value_and_rate(i).1, i), b + square(central, i))
        });
        // differences of the samples carry far more of the noise
        assert!(series * 100.0 < differences, "{series} {differences}");
    }

    #[test]
    fn too_few_samples_are_refused() {
        assert!(fit(&[0.0; 10], 0..10, 0.1, 5).is_err());
    }
}
