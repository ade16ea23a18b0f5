//! Harmonics of periodic signals.

use crate::{BaseError, Number};
use std::f64::consts::TAU;

/// One harmonic, `cosine cos(n psi) + sine sin(n psi)`.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Harmonic {
    /// Coefficient of `cos(n psi)`, in the signal's unit.
    pub cosine: f64,
    /// Coefficient of `sin(n psi)`, in the signal's unit.
    pub sine: f64,
}

impl Harmonic {
    /// The harmonic `A cos(n psi - phase)`, phase in rad.
    pub fn from_amplitude_phase(amplitude: f64, phase_rad: f64) -> Self {
        Self { cosine: amplitude * phase_rad.cos(), sine: amplitude * phase_rad.sin() }
    }

    /// Amplitude `A >= 0`, in the signal's unit.
    pub fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    /// Phase of `A cos(n psi - phase)`, rad in (-pi, pi]; positive means later.
    pub fn phase_rad(&self) -> f64 {
        self.sine.atan2(self.cosine)
    }

    /// Phase in degrees of the harmonic, in (-180, 180].
    pub fn phase_deg(&self) -> f64 {
        wrap_degrees(self.phase_rad().to_degrees())
    }
}

/// An angle in degrees brought into (-180, 180].
pub fn wrap_degrees(angle_deg: f64) -> f64 {
    let wrapped = angle_deg.rem_euclid(360.0);
    if wrapped > 180.0 { wrapped - 360.0 } else { wrapped }
}

/// `count` azimuths (rad) equally spaced over one revolution, from zero.
pub fn uniform_azimuths_rad(count: usize) -> Vec<f64> {
    (0..count).map(|i| TAU * i as f64 / count as f64).collect()
}

/// `1, cos psi, sin psi, cos 2 psi, sin 2 psi, ...` up to a harmonic.
pub fn harmonic_waves(azimuth_rad: f64, count: usize) -> impl Iterator<Item = f64> {
    let (sin1, cos1) = azimuth_rad.sin_cos();
    let turned = move |[cos_n, sin_n]: &[f64; 2]| {
        Some([cos_n * cos1 - sin_n * sin1, sin_n * cos1 + cos_n * sin1])
    };
    let pairs = std::iter::successors(Some([cos1, sin1]), turned).take(count);
    std::iter::once(1.0).chain(pairs.flatten())
}

/// A periodic signal as a truncated Fourier series,
/// `f(psi) = mean + sum_n (c_n cos n psi + s_n sin n psi)`.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct HarmonicSeries {
    /// Mean value.
    pub mean: f64,
    /// Harmonics 1, 2, 3...
    pub harmonics: Vec<Harmonic>,
}

impl HarmonicSeries {
    /// The zero signal with room for `count` harmonics.
    pub fn zero(count: usize) -> Self {
        Self { mean: 0.0, harmonics: vec![Harmonic::default(); count] }
    }

    /// Projection of samples taken at [`uniform_azimuths_rad`] on harmonics 1..=`count`.
    ///
    /// Exact for a signal whose highest harmonic `h` satisfies `h + count < samples.len()`.
    ///
    /// # Errors
    /// [`BaseError::TooFewSamples`] unless there are at least `2 count + 1` samples.
    pub fn from_uniform_samples(samples: &[f64], count: usize) -> Result<Self, BaseError> {
        let n = samples.len();
        let needed = 2 * count + 1;
        if n < needed {
            return Err(BaseError::TooFewSamples { samples: n, harmonics: count, needed });
        }
        let weights = vec![1.0 / n as f64; n];
        Ok(Self::project(&uniform_azimuths_rad(n), &weights, samples, count))
    }

    /// Projection of samples at any azimuths, with quadrature weights that sum to 1 over the
    /// period.
    ///
    /// ```text
    /// mean = sum_i w_i f_i,   c_n = 2 sum_i w_i f_i cos(n psi_i),   s_n = 2 sum_i w_i f_i sin(n psi_i)
    /// ```
    pub fn project(azimuths_rad: &[f64], weights: &[f64], samples: &[f64], count: usize) -> Self {
        let mut series = Self::zero(count);
        for ((&azimuth, &weight), &value) in azimuths_rad.iter().zip(weights).zip(samples) {
            let part = weight * value;
            series.mean += part;
            let (sin1, cos1) = azimuth.sin_cos();
            let (mut sin_n, mut cos_n) = (sin1, cos1);
            for h in &mut series.harmonics {
                h.cosine += 2.0 * part * cos_n;
                h.sine += 2.0 * part * sin_n;
                (cos_n, sin_n) = (cos_n * cos1 - sin_n * sin1, sin_n * cos1 + cos_n * sin1);
            }
        }
        series
    }

    /// Harmonic `n >= 1`; zero beyond the stored ones and for `n = 0`.
    pub fn harmonic(&self, n: usize) -> Harmonic {
        n.checked_sub(1).and_then(|i| self.harmonics.get(i)).copied().unwrap_or_default()
    }

    /// Sets harmonic `n >= 1`, growing the series if needed; `n = 0` changes nothing.
    pub fn set_harmonic(&mut self, n: usize, harmonic: Harmonic) {
        let Some(index) = n.checked_sub(1) else { return };
        if self.harmonics.len() <= index {
            self.harmonics.resize(index + 1, Harmonic::default());
        }
        self.harmonics[index] = harmonic;
    }

    /// Value at an azimuth.
    pub fn value(&self, azimuth_rad: f64) -> f64 {
        let (sin, cos) = azimuth_rad.sin_cos();
        self.value_of(sin, cos)
    }

    /// Value where sine and cosine of the azimuth are known, at one azimuth or at several side by side.
    pub fn value_of<N: Number>(&self, sin: N, cos: N) -> N {
        let (mut sin_n, mut cos_n) = (sin, cos);
        let mut value = N::of(self.mean);
        for h in &self.harmonics {
            value += cos_n * h.cosine + sin_n * h.sine;
            (cos_n, sin_n) = (cos_n * cos - sin_n * sin, sin_n * cos + cos_n * sin);
        }
        value
    }

    /// Value, first and second derivative with respect to azimuth.
    pub fn value_and_rates(&self, azimuth_rad: f64) -> [f64; 3] {
        let (sin1, cos1) = azimuth_rad.sin_cos();
        let (mut sin_n, mut cos_n) = (sin1, cos1);
        let mut out = [self.mean, 0.0, 0.0];
        for (i, h) in self.harmonics.iter().enumerate() {
            let n = (i + 1) as f64;
            let even = h.cosine * cos_n + h.sine * sin_n;
            out[0] += even;
            out[1] += n * (h.sine * cos_n - h.cosine * sin_n);
            out[2] -= n * n * even;
            (cos_n, sin_n) = (cos_n * cos1 - sin_n * sin1, sin_n * cos1 + cos_n * sin1);
        }
        out
    }

    /// The derivative with respect to azimuth, as a series.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let harmonics = self
            .harmonics
            .iter()
            .enumerate()
            .map(|(i, h)| {
                let n = (i + 1) as f64;
                Harmonic { cosine: n * h.sine, sine: -n * h.cosine }
            })
            .collect();
        Self { mean: 0.0, harmonics }
    }

    /// The same signal seen `shift_rad` of azimuth later: `g(psi) = f(psi + shift)`.
    #[must_use]
    pub fn shifted(&self, shift_rad: f64) -> Self {
        let harmonics = self
            .harmonics
            .iter()
            .enumerate()
            .map(|(i, h)| {
                let (s, c) = ((i + 1) as f64 * shift_rad).sin_cos();
                Harmonic { cosine: h.cosine * c + h.sine * s, sine: h.sine * c - h.cosine * s }
            })
            .collect();
        Self { mean: self.mean, harmonics }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;

    fn example() -> HarmonicSeries {
        let harmonics = [(1.0, -2.0), (0.5, 0.25), (-0.1, 0.7)]
            .map(|(cosine, sine)| Harmonic { cosine, sine })
            .to_vec();
        HarmonicSeries { mean: 0.3, harmonics }
    }

    #[test]
    fn projection_returns_the_series_it_samples() {
        let f = example();
        let samples: Vec<f64> = uniform_azimuths_rad(16).iter().map(|&p| f.value(p)).collect();
        let g = HarmonicSeries::from_uniform_samples(&samples, 5).unwrap();
        assert_abs_diff_eq!(g.mean, f.mean, epsilon = 1e-14);
        for n in 1..=5 {
            assert_abs_diff_eq!(g.harmonic(n).cosine, f.harmonic(n).cosine, epsilon = 1e-14);
            assert_abs_diff_eq!(g.harmonic(n).sine, f.harmonic(n).sine, epsilon = 1e-14);
        }
    }

    #[test]
    fn waves_are_cosines_and_sines_of_the_multiples() {
        let found: Vec<f64> = harmonic_waves(0.7, 20).collect();
        assert_eq!((found.len(), found[0].to_bits()), (41, 1.0_f64.to_bits()));
        for k in 1..=20 {
            let (sin, cos) = (0.7 * k as f64).sin_cos();
            assert_abs_diff_eq!(found[2 * k - 1], cos, epsilon = 1e-14);
            assert_abs_diff_eq!(found[2 * k], sin, epsilon = 1e-14);
        }
    }

    #[test]
    fn too_few_samples_are_refused() {
        assert!(HarmonicSeries::from_uniform_samples(&[0.0; 4], 2).is_err());
    }

    #[test]
    fn rates_are_the_derivatives() {
        let f = example();
        let (d1, d2) = (f.derivative(), f.derivative().derivative());
        for psi in uniform_azimuths_rad(7) {
            let [value, rate, acceleration] = f.value_and_rates(psi);
            assert_abs_diff_eq!(value, f.value(psi), epsilon = 1e-15);
            assert_abs_diff_eq!(rate, d1.value(psi), epsilon = 1e-13);
            assert_abs_diff_eq!(acceleration, d2.value(psi), epsilon = 1e-13);
            let h = 1e-6;
            let central = (f.value(psi + h) - f.value(psi - h)) / (2.0 * h);
            assert_abs_diff_eq!(rate, central, epsilon = 1e-8);
        }
    }

    #[test]
    fn degrees_wrap_into_the_half_open_interval() {
        for (given, expected) in
            [(180.0, 180.0), (-180.0, 180.0), (190.0, -170.0), (-540.0, 180.0), (720.5, 0.5)]
        {
            assert_abs_diff_eq!(wrap_degrees(given), expected, epsilon = 1e-12);
        }
    }

    proptest! {
        #[test]
        fn amplitude_and_phase_round_trip(amplitude in 1e-6..1e3_f64, phase in -3.1..3.1_f64) {
            let h = Harmonic::from_amplitude_phase(amplitude, phase);
            prop_assert!((h.amplitude() - amplitude).abs() <= 1e-12 * amplitude);
            prop_assert!((h.phase_rad() - phase).abs() <= 1e-12);
        }

        #[test]
        fn shifting_is_reading_later(shift in -7.0..7.0_f64, psi in 0.0..6.3_f64) {
            let f = example();
            prop_assert!((f.shifted(shift).value(psi) - f.value(psi + shift)).abs() < 1e-12);
        }
    }
}
