//! Energy of a signal octave by octave.

use num_complex::Complex;
use rustfft::FftPlanner;
use std::f64::consts::TAU;
use std::ops::Range;

/// Lines of the first band: under a window of Hann a line of the record's own length spreads over as many.
const FIRST_LINES: usize = 4;

/// Lines of a signal under a window of Hann, scaled so that their squares sum to its sum of squares.
#[derive(Debug, Clone)]
pub(crate) struct Lines(Vec<Complex<f64>>);

impl Lines {
    /// Of a signal less its mean.
    pub(crate) fn of(signal: &[f64]) -> Self {
        let n = signal.len();
        let mean = signal.iter().sum::<f64>() / n.max(1) as f64;
        let window = |i: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / n as f64).cos();
        let mut lines: Vec<Complex<f64>> = signal
            .iter()
            .enumerate()
            .map(|(i, y)| Complex::new((y - mean) * window(i), 0.0))
            .collect();
        if n > 0 {
            FftPlanner::new().plan_fft_forward(n).process(&mut lines);
        }
        lines.truncate(n / 2);
        // two halves of the spectrum; the window leaves 3/8 of the mean square
        let scale = (2.0 * 8.0 / 3.0 / n.max(1) as f64).sqrt();
        for line in &mut lines {
            *line *= scale;
        }
        Self(lines)
    }

    /// Sum of squares in a band.
    pub(crate) fn energy(&self, band: &Range<usize>) -> f64 {
        self.0[band.clone()].iter().map(Complex::norm_sqr).sum()
    }

    /// Share of the energy of this signal in a band that another, with one gain and phase, gives: 0 to 1.
    pub(crate) fn coherence(&self, other: &Self, band: &Range<usize>) -> f64 {
        let pairs = self.0[band.clone()].iter().zip(&other.0[band.clone()]);
        let both: Complex<f64> = pairs.map(|(a, b)| a * b.conj()).sum();
        let energies = self.energy(band) * other.energy(band);
        if energies > 0.0 { both.norm_sqr() / energies } else { 0.0 }
    }
}

/// Bands of a signal of `samples` samples, each an octave wide but for the first, which begins behind the mean; as
/// numbers of lines, a line being one cycle in the record.
pub(crate) fn octaves(samples: usize) -> Vec<Range<usize>> {
    let lines = samples / 2;
    // two values hold a mean and no line
    if lines < 2 {
        return Vec::new();
    }
    let starts = std::iter::successors(Some(FIRST_LINES), |k| Some(2 * k));
    let starts: Vec<usize> =
        std::iter::once(1).chain(starts).take_while(|k| *k < lines.max(2)).collect();
    let ends = starts[1..].iter().copied().chain([lines.max(1)]);
    starts.iter().copied().zip(ends).map(|(from, to)| from..to).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bands_hold_the_energy_where_it_is() {
        let n = 1000;
        let signal: Vec<f64> =
            (0..n).map(|i| 0.5 + 2.0 * (TAU * 30.0 * i as f64 / n as f64).sin()).collect();
        let lines = Lines::of(&signal);
        let bands = octaves(n);
        assert_eq!(bands.first(), Some(&(1..4)));
        assert_eq!(bands.last(), Some(&(256..500)));
        for band in &bands {
            let own = lines.energy(band);
            let expected = if band.contains(&30) { 2000.0 } else { 0.0 };
            assert!((own - expected).abs() < 0.02 * 2000.0, "{band:?}: {own}");
        }
    }

    #[test]
    fn a_lagging_copy_is_coherent_and_another_line_is_not() {
        let wave = |cycles: f64, lag: f64| -> Vec<f64> {
            (0..1000).map(|i| (TAU * cycles * f64::from(i) / 1000.0 - lag).sin()).collect()
        };
        let own = Lines::of(&wave(20.0, 0.0));
        let band = 16..32;
        assert!(own.coherence(&Lines::of(&wave(20.0, 1.1)), &band) > 0.999);
        assert!(own.coherence(&Lines::of(&wave(27.0, 0.0)), &band) < 0.01);
    }
}
