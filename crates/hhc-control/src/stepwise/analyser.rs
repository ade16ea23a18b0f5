//! Harmonics of signals over a sliding window of whole revolutions.

use crate::{ControlError, error};
use std::f64::consts::TAU;

/// Cosine and sine coefficients of several channels over the last whole revolutions.
///
/// ```text
/// c_n = 2/(R N) sum x_k cos(2 pi n k / N),   s_n = 2/(R N) sum x_k sin(2 pi n k / N)      the mean for n = 0
/// ```
/// `N` samples a revolution, `R` revolutions; the first sample stands at azimuth 0. Harmonics below `N/2` that do not
/// change are found exactly, whatever the others.
///
/// - *Lag.* A harmonic that changes steadily is shown as it was in the middle of the window, `R/2` revolutions ago
///   ([`Self::group_lag_rev`]).
/// - *Leakage.* A mean that ramps by `a` per revolution shows in every harmonic, however long the window
///   ([`Self::ramp_leakage`]): about `-a / (n pi)` in the sine.
///
/// Source: the discrete Fourier transform; A. Oppenheim, R. Schafer, *Discrete-Time Signal Processing*.
#[derive(Debug, Clone)]
pub struct HarmonicAnalyser {
    samples_per_rev: usize,
    harmonics: Vec<u32>,
    channels: usize,
    /// Weights of the sums: sample by sample, cosine and sine of every harmonic.
    waves: Vec<f64>,
    /// Coefficients of every revolution of the window, the present one last to be filled.
    revolutions: Vec<Vec<f64>>,
    present: usize,
    sample: usize,
    is_full: bool,
    coefficients: Vec<f64>,
}

impl HarmonicAnalyser {
    /// An analyser of `channels` channels.
    ///
    /// | argument | meaning | range |
    /// |---|---|---|
    /// | `channels` | signals per sample | 1 or more |
    /// | `samples_per_rev` | samples of a revolution, uniform in azimuth | above twice the highest harmonic |
    /// | `window_rev` | revolutions of the window | 1 or more |
    /// | `harmonics` | per rev; 0 is the mean | 1 or more of them |
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`].
    pub fn new(
        channels: usize,
        samples_per_rev: usize,
        window_rev: usize,
        harmonics: &[u32],
    ) -> Result<Self, ControlError> {
        for (what, count) in [
            ("channels of the analyser", channels),
            ("window of the analyser (revolutions)", window_rev),
            ("harmonics of the analyser", harmonics.len()),
        ] {
            error::check_range(count > 0, what, count as f64, "1 or more")?;
        }
        let highest = harmonics.iter().copied().max().unwrap_or_default() as usize;
        let (what, found) = ("samples per revolution", samples_per_rev as f64);
        let expected = "more than twice the highest harmonic";
        error::check_range(samples_per_rev > 2 * highest, what, found, expected)?;
        let scale = 1.0 / samples_per_rev as f64;
        let waves = (0..samples_per_rev)
            .flat_map(|k| harmonics.iter().map(move |&n| (k, n)))
            .flat_map(|(k, n)| {
                let (sin, cos) = (TAU * f64::from(n) * (k as f64 * scale)).sin_cos();
                let factor = if n == 0 { scale } else { 2.0 * scale };
                [factor * cos, factor * sin]
            })
            .collect();
        let length = channels * 2 * harmonics.len();
        Ok(Self {
            samples_per_rev,
            harmonics: harmonics.to_vec(),
            channels,
            waves,
            revolutions: vec![vec![0.0; length]; window_rev],
            present: 0,
            sample: 0,
            is_full: false,
            coefficients: vec![0.0; length],
        })
    }

    /// Takes the next sample, one number per channel. At the end of a revolution, once the window is full: channel by
    /// channel, harmonic by harmonic, cosine and sine, in the unit of the channel.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; the sample is then not taken.
    pub fn push(&mut self, values: &[f64]) -> Result<Option<&[f64]>, ControlError> {
        error::check_vector("sample of the analyser", values, self.channels)?;
        let width = 2 * self.harmonics.len();
        let waves = &self.waves[self.sample * width..][..width];
        let sums = &mut self.revolutions[self.present];
        if self.sample == 0 {
            sums.fill(0.0);
        }
        for (sums, value) in sums.chunks_exact_mut(width).zip(values) {
            for (sum, wave) in sums.iter_mut().zip(waves) {
                *sum += wave * value;
            }
        }
        self.sample += 1;
        if self.sample < self.samples_per_rev {
            return Ok(None);
        }
        self.sample = 0;
        self.present = (self.present + 1) % self.revolutions.len();
        self.is_full |= self.present == 0;
        if !self.is_full {
            return Ok(None);
        }
        let share = 1.0 / self.revolutions.len() as f64;
        for (index, coefficient) in self.coefficients.iter_mut().enumerate() {
            *coefficient = share * self.revolutions.iter().map(|sums| sums[index]).sum::<f64>();
        }
        Ok(Some(&self.coefficients))
    }

    /// Starts again with an empty window at azimuth 0.
    pub fn reset(&mut self) {
        (self.present, self.sample, self.is_full) = (0, 0, false);
    }

    /// Age of what the coefficients show, revolutions: half the window.
    pub fn group_lag_rev(&self) -> f64 {
        0.5 * self.revolutions.len() as f64
    }

    /// What a mean that rises by 1 per revolution adds to a harmonic above 0, `[cosine, sine]`.
    ///
    /// ```text
    /// [ -1/N,  -cot(pi n / N) / N ]        about [0, -1/(n pi)]
    /// ```
    pub fn ramp_leakage(&self, harmonic: u32) -> [f64; 2] {
        let count = self.samples_per_rev as f64;
        let angle = 0.5 * TAU * f64::from(harmonic) / count;
        [-1.0 / count, -1.0 / (count * angle.tan())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coefficients after a number of whole revolutions of one channel.
    fn analysed(window_rev: usize, revs: usize, signal: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut analyser = HarmonicAnalyser::new(1, 48, window_rev, &[0, 4]).unwrap();
        let mut found = None;
        for k in 0..revs * 48 {
            found = analyser.push(&[signal(k as f64 / 48.0)]).unwrap().map(<[f64]>::to_vec);
        }
        found.unwrap()
    }

    #[test]
    fn stationary_harmonics_are_exact() {
        for window_rev in [1, 3] {
            let found = analysed(window_rev, 7, |rev| {
                let psi = TAU * rev;
                0.7 + 2.0 * (4.0 * psi).cos() - 0.3 * (4.0 * psi).sin() + 5.0 * (3.0 * psi).sin()
            });
            for (found, exact) in found.iter().zip([0.7, 0.0, 2.0, -0.3]) {
                assert!((found - exact).abs() < 1e-13, "{found} {exact}");
            }
        }
    }

    #[test]
    fn a_ramp_leaks_as_stated_whatever_the_window() {
        let leak = HarmonicAnalyser::new(1, 48, 1, &[4]).unwrap().ramp_leakage(4);
        assert!((leak[1] + 1.0 / (4.0 * std::f64::consts::PI)).abs() < 2e-3, "{leak:?}");
        for window_rev in [1, 4] {
            let found = analysed(window_rev, 9, |rev| 0.2 * rev);
            assert!((found[2] - 0.2 * leak[0]).abs() < 1e-13, "{found:?}");
            assert!((found[3] - 0.2 * leak[1]).abs() < 1e-13, "{found:?}");
        }
    }

    /// A harmonic that grows is shown as it was half a window before the last sample.
    #[test]
    fn the_lag_is_half_the_window() {
        for window_rev in [1, 2, 4] {
            let found = analysed(window_rev, 8, |rev| rev * (4.0 * TAU * rev).cos());
            let lag = HarmonicAnalyser::new(1, 48, window_rev, &[4]).unwrap().group_lag_rev();
            let age = 8.0 - 0.5 / 48.0 - found[2];
            assert!((age - lag).abs() < 0.03, "{age} {lag}");
        }
    }

    #[test]
    fn a_window_that_is_not_full_gives_nothing_and_bad_input_is_refused() {
        let mut analyser = HarmonicAnalyser::new(2, 8, 2, &[1]).unwrap();
        for k in 0..16 {
            assert_eq!(analyser.push(&[1.0, 2.0]).unwrap().is_some(), k == 15);
        }
        assert!(analyser.push(&[1.0]).is_err() && analyser.push(&[1.0, f64::NAN]).is_err());
        analyser.reset();
        assert!(analyser.push(&[1.0, 2.0]).unwrap().is_none());
        for (channels, samples, window, harmonics) in
            [(0, 8, 1, vec![1]), (1, 8, 0, vec![1]), (1, 8, 1, vec![]), (1, 8, 1, vec![4])]
        {
            assert!(HarmonicAnalyser::new(channels, samples, window, &harmonics).is_err());
        }
    }
}
