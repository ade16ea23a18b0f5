//! What is read off a record: amplitude, phase, loop width, distance between two records.

use std::f64::consts::TAU;

/// Amplitude and phase of one frequency of a signal, `a sin(2 pi f t + phase)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phasor {
    /// Amplitude, in the unit of the signal.
    pub amplitude: f64,
    /// Phase, deg.
    pub phase_deg: f64,
}

/// Projects equally spaced samples that span whole periods on one frequency.
///
/// | argument | unit | range |
/// |---|---|---|
/// | `samples` | any | whole periods of the frequency, the end point excluded |
/// | `cycles_per_sample` | - | frequency over sample rate, 0..0.5 |
///
/// ```text
/// a sin p = 2 mean(y cos 2 pi f t),   a cos p = 2 mean(y sin 2 pi f t)
/// ```
pub fn phasor(samples: &[f64], cycles_per_sample: f64) -> Phasor {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (i, y) in samples.iter().enumerate() {
        let (s, c) = (TAU * cycles_per_sample * i as f64).sin_cos();
        sine += y * s;
        cosine += y * c;
    }
    let scale = 2.0 / samples.len() as f64;
    Phasor { amplitude: scale * sine.hypot(cosine), phase_deg: cosine.atan2(sine).to_degrees() }
}

/// An angle brought into (-180, 180], deg.
pub fn wrap_deg(angle_deg: f64) -> f64 {
    180.0 - (180.0 - angle_deg).rem_euclid(360.0)
}

/// Half the distance between the largest and the smallest value.
pub fn half_peak_to_peak(samples: &[f64]) -> f64 {
    let high = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = samples.iter().copied().fold(f64::INFINITY, f64::min);
    0.5 * (high - low)
}

/// Greatest vertical opening of a closed loop, as a share of its peak-to-peak output.
///
/// `voltage` and `output` hold one period of a command with one maximum and one minimum.
pub fn loop_width(voltage: &[f64], output: &[f64]) -> f64 {
    let n = voltage.len();
    let top = (0..n).fold(0, |best, i| if voltage[i] > voltage[best] { i } else { best });
    let bottom = (0..n).fold(0, |best, i| if voltage[i] < voltage[best] { i } else { best });
    let branch = |from: usize, to: usize| -> Vec<(f64, f64)> {
        let length = (to + n - from) % n;
        (0..=length).map(|i| (from + i) % n).map(|i| (voltage[i], output[i])).collect()
    };
    let rising = branch(bottom, top);
    let mut falling = branch(top, bottom);
    falling.reverse();
    let widest =
        rising.iter().map(|&(u, y)| (interpolate(&falling, u) - y).abs()).fold(0.0, f64::max);
    widest / (2.0 * half_peak_to_peak(output))
}

/// Linear interpolation in points of increasing abscissa, constant outside.
fn interpolate(points: &[(f64, f64)], x: f64) -> f64 {
    let above = points.partition_point(|&(u, _)| u < x);
    match (points.get(above.wrapping_sub(1)), points.get(above)) {
        (Some(&(u0, y0)), Some(&(u1, y1))) if u1 > u0 => y0 + (y1 - y0) * (x - u0) / (u1 - u0),
        (_, Some(&(_, y))) | (Some(&(_, y)), None) => y,
        (None, None) => 0.0,
    }
}

/// Root mean square of `model - measured` over the standard deviation of `measured`.
pub fn nrmse(model: &[f64], measured: &[f64]) -> f64 {
    let n = measured.len() as f64;
    let mean = measured.iter().sum::<f64>() / n;
    let error: f64 = model.iter().zip(measured).map(|(a, b)| (a - b).powi(2)).sum();
    let variance: f64 = measured.iter().map(|y| (y - mean).powi(2)).sum();
    (error / variance).sqrt()
}

/// Position of the smallest value of a function with one minimum between `low` and `high`.
pub fn golden_section(mut low: f64, mut high: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..30 {
        if fa < fb {
            (high, b, fb) = (b, a, fa);
            a = high - ratio * (high - low);
            fa = f(a);
        } else {
            (low, a, fa) = (a, b, fb);
            b = low + ratio * (high - low);
            fb = f(b);
        }
    }
    0.5 * (low + high)
}
