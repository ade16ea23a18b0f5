//! Errors that are not white: their variance line by line.

use num_complex::Complex;
use rustfft::FftPlanner;
use std::f64::consts::PI;

/// Variances of the lines of a record's cosine transform, [`cosine_lines`], over that of a white error that the samples
/// are weighed by. Line `k` of `n` samples with step `h` stands for the frequency `k / (2 n h)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectrum(Vec<f64>);

impl Spectrum {
    /// From a variance per line, none below zero; white without any.
    pub fn new(variances: Vec<f64>) -> Self {
        Self(variances)
    }

    /// Energy of a signal with each line multiplied by its variance, and as it is.
    pub(crate) fn energies(&self, signal: &[f64]) -> [f64; 2] {
        let plain: f64 = signal.iter().map(|x| x * x).sum();
        if self.0.len() != signal.len() || plain <= 0.0 {
            return [plain, plain];
        }
        let lines = cosine_lines(signal);
        [lines.iter().zip(&self.0).map(|(line, variance)| line * line * variance).sum(), plain]
    }
}

/// Cosine transform of a signal, type II, orthonormal: white noise of a variance has lines of that variance. It continues
/// a record evenly at its ends, so that a trend does not leak into the fast lines as under a Fourier transform.
///
/// Source: J. Makhoul, IEEE Transactions on Acoustics, Speech, and Signal Processing 28 (1980) 27, by one Fourier transform
/// of the same length.
pub fn cosine_lines(signal: &[f64]) -> Vec<f64> {
    let n = signal.len();
    let mut reordered = vec![Complex::new(0.0, 0.0); n];
    for (i, x) in signal.iter().enumerate() {
        reordered[if i % 2 == 0 { i / 2 } else { n - 1 - i / 2 }].re = *x;
    }
    FftPlanner::new().plan_fft_forward(n).process(&mut reordered);
    let turned = reordered.iter().enumerate().map(|(k, own)| {
        let size = if k == 0 { 1.0 } else { 2.0 } / n as f64;
        size.sqrt() * (own * Complex::from_polar(1.0, -PI * k as f64 / (2.0 * n as f64))).re
    });
    turned.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum that defines the transform; energy is kept.
    #[test]
    fn the_lines_are_those_of_the_definition() {
        for n in [1, 2, 7, 100] {
            let signal: Vec<f64> =
                (0..n).map(|i| (0.3 * f64::from(i)).sin() + 0.2 * f64::from(i % 3)).collect();
            let lines = cosine_lines(&signal);
            for (k, line) in lines.iter().enumerate() {
                let size = if k == 0 { 1.0 } else { 2.0 } / f64::from(n);
                let wave = |i: usize| (PI * (i as f64 + 0.5) * k as f64 / f64::from(n)).cos();
                let sum: f64 = signal.iter().enumerate().map(|(i, x)| x * wave(i)).sum();
                assert!((line - size.sqrt() * sum).abs() < 1e-11, "{n} {k}: {line}");
            }
            let energy = |s: &[f64]| s.iter().map(|x| x * x).sum::<f64>();
            assert!((energy(&lines) / energy(&signal) - 1.0).abs() < 1e-12 || n == 1);
        }
    }

    #[test]
    fn a_line_weighs_with_the_variance_at_its_frequency() {
        let n = 256_usize;
        let variances = (0..n).map(|k| if k < 64 { 1.0 } else { 0.01 }).collect();
        let spectrum = Spectrum::new(variances);
        let wave = |k: f64| -> Vec<f64> {
            (0..n).map(|i| (PI * (i as f64 + 0.5) * k / n as f64).cos()).collect()
        };
        for (k, share) in [(20.0, 1.0), (100.0, 0.01)] {
            let [coloured, plain] = spectrum.energies(&wave(k));
            assert!((coloured / plain - share).abs() < 1e-10, "{k}");
        }
    }
}
