//! What several tests need.

use std::f64::consts::TAU;

/// Mean, and amplitude and phase (deg) of harmonic `n`, of uniform samples over a revolution.
pub(crate) fn harmonic(samples: &[f64], n: usize) -> [f64; 3] {
    let count = samples.len() as f64;
    let (mut c, mut s) = (0.0, 0.0);
    for (i, value) in samples.iter().enumerate() {
        let angle = TAU * (n * i) as f64 / count;
        c += 2.0 * value * angle.cos() / count;
        s += 2.0 * value * angle.sin() / count;
    }
    [samples.iter().sum::<f64>() / count, c.hypot(s), s.atan2(c).to_degrees()]
}
