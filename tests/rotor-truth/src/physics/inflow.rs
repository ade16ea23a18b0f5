//! Inflow through the disk: momentum theory with gradients, or the map of undistorted helices.

use super::fourier::Fourier;
use super::span::Span;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// How the induced inflow is spread over the disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum InflowKind {
    /// Alike everywhere.
    Uniform,
    /// With the gradients of Drees.
    Drees,
    /// As undistorted helices of tip vortices induce it.
    Helices,
}

/// Shape of the induced inflow.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Alike everywhere.
    Uniform,
    /// `1 + x (k_x cos psi + k_y sin psi)`.
    Drees,
    /// Given, by station and azimuth, with a mean of 1 over the disk.
    Map(Vec<Vec<f64>>),
}

/// Gradients of Drees: aft and starboard.
///
/// ```text
/// k_x = 4/3 (1 - cos chi - 1.8 mu^2)/sin chi,   k_y = -2 mu,   chi = atan2(mu, lambda)
/// ```
pub fn drees(mu: f64, lambda: f64) -> (f64, f64) {
    let chi = mu.atan2(lambda);
    (4.0 / 3.0 * (1.0 - chi.cos() - 1.8 * mu * mu) / chi.sin().max(1e-6), -2.0 * mu)
}

/// Induced inflow of momentum theory less the given one, by thrust coefficient.
pub fn momentum_defect(mu: f64, lambda: f64, lambda_i: f64, thrust_coefficient: f64) -> f64 {
    lambda_i - thrust_coefficient / (2.0 * mu.hypot(lambda))
}

/// Induced inflow of momentum theory at a tilt.
pub fn glauert(mu: f64, tilt_rad: f64, thrust_coefficient: f64) -> f64 {
    let mut own = (0.5 * thrust_coefficient).sqrt();
    for _ in 0..200 {
        let lambda = mu * tilt_rad.tan() + own;
        own = 0.5 * (own + thrust_coefficient / (2.0 * mu.hypot(lambda)));
    }
    own
}

/// Turns of a helix.
const TURNS: f64 = 3.0;
/// Length of its segments, rad.
const SEGMENT: f64 = TAU / 72.0;
/// Core radius, R.
const CORE: f64 = 0.02;

/// Downwash of helices of constant circulation by station and azimuth, normalised to a mean of 1 over the disk, and that mean
/// for a circulation of 1.
///
/// The vortex that blade `k` left at age `z` lies at `(cos(psi_k - z) + mu z, sin(psi_k - z), -lambda z)`. Velocity of a segment
/// with a core after Vatistas (n = 2).
pub fn helices(
    span: &Span,
    fourier: &Fourier,
    blades: usize,
    mu: f64,
    lambda: f64,
) -> (Vec<Vec<f64>>, f64) {
    let count =
        (1..10_000_u32).find(|n| f64::from(*n) * SEGMENT >= TURNS * TAU - 1e-9).unwrap_or(1);
    let mut map = vec![vec![0.0; fourier.azimuths]; span.len()];
    for sample in 0..fourier.azimuths {
        let psi = fourier.azimuth(sample);
        for blade in 0..blades {
            let own = psi + TAU * blade as f64 / blades as f64;
            let at = |age: f64| {
                let (sin, cos) = (own - age).sin_cos();
                [cos + mu * age, sin, -lambda * age]
            };
            let line: Vec<[f64; 3]> = (0..=count).map(|n| at(f64::from(n) * SEGMENT)).collect();
            for (row, x) in map.iter_mut().zip(&span.x) {
                let target = [x * psi.cos(), x * psi.sin(), 0.0];
                row[sample] -=
                    line.windows(2).map(|ends| segment(target, ends[0], ends[1])).sum::<f64>();
            }
        }
    }
    let mut mean = 0.0;
    for (row, (x, w)) in map.iter().zip(span.x.iter().zip(&span.weight)) {
        mean += 2.0 * x * w * row.iter().sum::<f64>() / fourier.azimuths as f64;
    }
    for own in map.iter_mut().flatten() {
        *own /= mean;
    }
    (map, mean)
}

/// Velocity along `z` that a segment of circulation 1 induces.
fn segment(target: [f64; 3], begin: [f64; 3], end: [f64; 3]) -> f64 {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (l, r1, r2) = (minus(end, begin), minus(target, begin), minus(target, end));
    let cross =
        [l[1] * r1[2] - l[2] * r1[1], l[2] * r1[0] - l[0] * r1[2], l[0] * r1[1] - l[1] * r1[0]];
    let (square, length) = (dot(cross, cross), dot(l, l));
    let ends =
        dot(l, r1) / dot(r1, r1).sqrt().max(1e-12) - dot(l, r2) / dot(r2, r2).sqrt().max(1e-12);
    ends * cross[2] / (4.0 * PI * (square * square + CORE.powi(4) * length * length).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn momentum_theory_at_the_reference_point() {
        let (mu, tilt) = (0.3, 5.0_f64.to_radians());
        let own = glauert(mu, tilt, 0.0049);
        assert!((own - 0.008_114).abs() < 1e-6);
        let (k_x, k_y) = drees(mu, mu * tilt.tan() + own);
        assert!((k_x - 0.972).abs() < 1e-3 && (k_y + 0.6).abs() < 1e-12);
    }

    /// Mean over that of momentum theory by another program: 1.06, 1.10, 1.21, 1.24 for `Gamma = 2 pi CT/Nb`.
    #[test]
    fn helices_induce_the_mean_of_another_program() {
        let (span, fourier) = (Span::new(&[], 6, 0.1), Fourier::new(4, 72));
        let thrust = 0.0049;
        for (mu, known) in [(0.1, 1.06), (0.2, 1.10), (0.3, 1.21), (0.35, 1.24)] {
            let tilt = f64::atan(mu * mu * 0.01 / (2.0 * thrust));
            let lambda_i = glauert(mu, tilt, thrust);
            let (map, mean) = helices(&span, &fourier, 4, mu, mu * tilt.tan() + lambda_i);
            let ratio = mean * TAU * thrust / 4.0 / lambda_i;
            println!("{mu} {ratio}");
            assert!((ratio - known).abs() < 0.02, "{mu} {ratio}");
            let row = &map[span.len() - 8];
            assert!(row[0] > row[36], "more aft than ahead");
        }
    }
}
