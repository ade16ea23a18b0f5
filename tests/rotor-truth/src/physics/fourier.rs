//! Truncated Fourier series on equal azimuths.

use std::f64::consts::TAU;

/// Cosines and sines on equal azimuths.
#[derive(Debug, Clone)]
pub struct Fourier {
    /// Highest harmonic.
    pub harmonics: usize,
    /// Number of azimuths.
    pub azimuths: usize,
    /// Value of every member of the basis `1, cos, sin, cos 2, sin 2, ...` by azimuth.
    basis: Vec<Vec<f64>>,
}

/// A harmonic: `cosine cos n psi + sine sin n psi`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pair {
    /// Cosine part.
    pub cosine: f64,
    /// Sine part.
    pub sine: f64,
}

impl Pair {
    /// The harmonic later by an angle of its own phase.
    #[must_use]
    pub fn later(self, phase_rad: f64) -> Self {
        let (sin, cos) = phase_rad.sin_cos();
        Self {
            cosine: self.cosine * cos - self.sine * sin,
            sine: self.sine * cos + self.cosine * sin,
        }
    }

    /// The harmonic times a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { cosine: self.cosine * factor, sine: self.sine * factor }
    }
}

impl Fourier {
    /// Series of some harmonics on some azimuths.
    pub fn new(harmonics: usize, azimuths: usize) -> Self {
        let basis = (0..azimuths)
            .map(|k| {
                let psi = TAU * k as f64 / azimuths as f64;
                let mut row = vec![1.0];
                for n in 1..=harmonics {
                    let (sin, cos) = (n as f64 * psi).sin_cos();
                    row.extend([cos, sin]);
                }
                row
            })
            .collect();
        Self { harmonics, azimuths, basis }
    }

    /// Number of coefficients of a series.
    pub fn size(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Azimuth of a sample, rad.
    pub fn azimuth(&self, sample: usize) -> f64 {
        TAU * sample as f64 / self.azimuths as f64
    }

    /// Value and two derivatives of a series at a sample.
    pub fn at(&self, coefficients: &[f64], sample: usize) -> [f64; 3] {
        let row = &self.basis[sample];
        let mut out = [coefficients[0], 0.0, 0.0];
        for n in 1..=self.harmonics {
            let order = n as f64;
            let (c, s) = (coefficients[2 * n - 1], coefficients[2 * n]);
            let value = c * row[2 * n - 1] + s * row[2 * n];
            out[0] += value;
            out[1] += order * (s * row[2 * n - 1] - c * row[2 * n]);
            out[2] -= order * order * value;
        }
        out
    }

    /// Adds the share of one sample to the coefficients of a series.
    pub fn project(&self, value: f64, sample: usize, coefficients: &mut [f64]) {
        let unit = value / self.azimuths as f64;
        let row = &self.basis[sample];
        coefficients[0] += unit;
        for (own, basis) in coefficients[1..].iter_mut().zip(&row[1..]) {
            *own += 2.0 * unit * basis;
        }
    }
}

/// A harmonic of equal samples; of harmonic 0 the mean is the cosine.
pub fn harmonic_of(samples: &[f64], harmonic: usize) -> Pair {
    let count = samples.len() as f64;
    let mut out = Pair::default();
    for (k, value) in samples.iter().enumerate() {
        let (sin, cos) = (TAU * (harmonic * k % samples.len()) as f64 / count).sin_cos();
        out.cosine += value * cos;
        out.sine += value * sin;
    }
    out.times(if harmonic == 0 { 1.0 } else { 2.0 } / count)
}

/// Matrix of the derivative of the trigonometric polynomial through equal samples, of an even number, row by row.
pub fn differentiation(azimuths: usize) -> Vec<f64> {
    let mut out = vec![0.0; azimuths * azimuths];
    let half_step = 0.5 * TAU / azimuths as f64;
    for j in 0..azimuths {
        for k in 0..azimuths {
            if j != k {
                let difference = j as f64 - k as f64;
                let sign = if (j + k) % 2 == 0 { 0.5 } else { -0.5 };
                out[j * azimuths + k] = sign / (half_step * difference).tan();
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_comes_back_from_its_samples() {
        let fourier = Fourier::new(3, 16);
        let series = [0.3, 1.0, -0.5, 0.2, 0.7, -0.1, 0.4];
        let mut back = [0.0; 7];
        let slope = differentiation(16);
        let samples: Vec<[f64; 3]> = (0..16).map(|k| fourier.at(&series, k)).collect();
        for (k, own) in samples.iter().enumerate() {
            fourier.project(own[0], k, &mut back);
            let by_matrix: f64 = (0..16).map(|j| slope[k * 16 + j] * samples[j][0]).sum();
            assert!((by_matrix - own[1]).abs() < 1e-12);
        }
        for (a, b) in series.iter().zip(&back) {
            assert!((a - b).abs() < 1e-14);
        }
        let values: Vec<f64> = samples.iter().map(|own| own[0]).collect();
        assert!((harmonic_of(&values, 2).sine - 0.7).abs() < 1e-14);
    }
}
