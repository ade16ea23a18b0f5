//! Sums and multiples of series over a revolution.

use crate::{Harmonic, HarmonicSeries};

/// A harmonic times a factor.
pub fn times(harmonic: Harmonic, factor: f64) -> Harmonic {
    Harmonic { cosine: factor * harmonic.cosine, sine: factor * harmonic.sine }
}

/// A series times a factor.
pub fn scaled(series: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    let harmonics = series.harmonics.iter().map(|h| times(*h, factor)).collect();
    HarmonicSeries { mean: factor * series.mean, harmonics }
}

/// `factor (a - b)`.
pub fn weighted(a: &HarmonicSeries, b: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    scaled(&added(a, b, -1.0), factor)
}

/// `a + factor b`.
pub fn added(a: &HarmonicSeries, b: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    let mut out = HarmonicSeries::zero(a.harmonics.len().max(b.harmonics.len()));
    out.mean = a.mean + factor * b.mean;
    for n in 1..=out.harmonics.len() {
        let (x, y) = (a.harmonic(n), b.harmonic(n));
        let (cosine, sine) = (x.cosine + factor * y.cosine, x.sine + factor * y.sine);
        out.set_harmonic(n, Harmonic { cosine, sine });
    }
    out
}

/// Coefficients of a series to `count` harmonics: mean, then cosine and sine of each.
pub fn coefficients(series: &HarmonicSeries, count: usize) -> impl Iterator<Item = f64> {
    let harmonics = (1..=count).flat_map(|n| {
        let h = series.harmonic(n);
        [h.cosine, h.sine]
    });
    std::iter::once(series.mean).chain(harmonics)
}

/// The series of these coefficients: the mean, then cosine and sine of each harmonic.
///
/// # Panics
/// Without a mean.
pub fn series(coefficients: &[f64]) -> HarmonicSeries {
    let pairs = coefficients[1..].chunks_exact(2);
    let harmonics = pairs.map(|pair| Harmonic { cosine: pair[0], sine: pair[1] }).collect();
    HarmonicSeries { mean: coefficients[0], harmonics }
}

/// The series of which only the coefficient `k` is not zero.
pub fn only(k: usize, coefficient: f64) -> HarmonicSeries {
    let mut coefficients = vec![0.0; 2 * k.div_ceil(2) + 1];
    coefficients[k] = coefficient;
    series(&coefficients)
}

/// Place of the cosine, or the sine, of a harmonic (from 1) among the coefficients of a series.
pub fn place(harmonic: usize, sine: bool) -> usize {
    2 * harmonic - usize::from(!sine)
}
