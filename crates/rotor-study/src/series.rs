//! Sums and multiples of series over a revolution.

use rotor_base::{Harmonic, HarmonicSeries};

/// A series times a factor.
pub(crate) fn scaled(series: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    let harmonics = series
        .harmonics
        .iter()
        .map(|h| Harmonic { cosine: factor * h.cosine, sine: factor * h.sine })
        .collect();
    HarmonicSeries { mean: factor * series.mean, harmonics }
}

/// `factor (a - b)`.
pub(crate) fn weighted(a: &HarmonicSeries, b: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    scaled(&added(a, b, -1.0), factor)
}

/// `a + factor b`.
pub(crate) fn added(a: &HarmonicSeries, b: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    let mut out = HarmonicSeries::zero(a.harmonics.len().max(b.harmonics.len()));
    out.mean = a.mean + factor * b.mean;
    for n in 1..=out.harmonics.len() {
        let (x, y) = (a.harmonic(n), b.harmonic(n));
        let (cosine, sine) = (x.cosine + factor * y.cosine, x.sine + factor * y.sine);
        out.set_harmonic(n, Harmonic { cosine, sine });
    }
    out
}
