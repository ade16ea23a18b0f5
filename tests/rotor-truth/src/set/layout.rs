//! Which points are flown: conditions, and drives at each of them.

use super::drive::{GAIN_DEG_PER_VOLT, Voltage};
use super::fly::{Condition, Group};
use super::machine::NOMINAL_RPM;
use crate::physics::fourier::Pair;
use chacha20::ChaCha8Rng;
use rand::RngExt;
use std::f64::consts::TAU;

/// What is driven over the set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drives {
    /// Whether any flap is.
    pub is_driven: bool,
    /// Middle amplitude, V.
    pub middle_volt: f64,
    /// Middle harmonic.
    pub middle_harmonic: usize,
}

/// Points of a set.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Conditions with their drives.
    pub groups: Vec<Group>,
    /// What is driven.
    pub drives: Drives,
}

/// Flat-plate area of the fuselage over the disk area, for a tilt that is plausible.
const DRAG_AREA: f64 = 0.01;
/// Solidity, for the same.
const SOLIDITY: f64 = 0.07;

fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

fn condition(rng: &mut ChaCha8Rng, place: f64, speeds: &[f64]) -> Condition {
    // half of the range is drawn, half is a sweep
    let mu = 0.10 + 0.25 * place + rng.random_range(-0.015..0.015);
    let advance_ratio = rounded(mu.clamp(0.10, 0.35), 0.005);
    let ct_sigma = rounded(rng.random_range(0.055..0.085), 0.001);
    let level = (0.5 * advance_ratio * advance_ratio * DRAG_AREA / (ct_sigma * SOLIDITY)).atan();
    let tilt_deg = rounded(level.to_degrees() + rng.random_range(-0.5..1.5), 0.25);
    let omega_rpm = speeds[rng.random_range(0..speeds.len())];
    Condition { advance_ratio, ct_sigma, tilt_deg, omega_rpm }
}

/// Drives of a condition but the flaps at rest: amplitude steps at one phase, then other phases.
fn drives(rng: &mut ChaCha8Rng, count: usize, harmonic: usize) -> (Vec<Vec<Voltage>>, Vec<f64>) {
    let which = rng.random_range(0..3);
    let begin = rng.random_range(0.0..TAU);
    let top_deg = rng.random_range(2.0..4.0);
    let steps = count.div_ceil(2).max(2);
    let mut volts = Vec::new();
    let all = (0..count)
        .map(|k| {
            let (part, phase) = if k < steps {
                ((k + 1) as f64 / steps as f64, begin)
            } else {
                (0.7, begin + TAU * (k + 1 - steps) as f64 / (count + 1 - steps) as f64)
            };
            let volt = rounded(part * top_deg / GAIN_DEG_PER_VOLT, 0.1);
            volts.push(volt);
            let (sin, cos) = phase.sin_cos();
            let own = vec![(
                harmonic,
                Pair { cosine: rounded(volt * cos, 0.01), sine: rounded(volt * sin, 0.01) },
            )];
            match which {
                0 => vec![own.clone(), own],
                1 => vec![Voltage::new(), own],
                _ => vec![own, Voltage::new()],
            }
        })
        .collect();
    (all, volts)
}

fn middle<T: Copy>(mut all: Vec<T>, order: impl Fn(&T, &T) -> std::cmp::Ordering) -> Option<T> {
    all.sort_by(order);
    all.get(all.len() / 2).copied()
}

impl Layout {
    /// Draws a layout of about `points` points.
    pub fn draw(rng: &mut ChaCha8Rng, points: usize, needs_drive: bool) -> Self {
        let is_driven = rng.random_range(0..7) > 0 || needs_drive;
        let per_condition = if is_driven { rng.random_range(4..8) } else { 1 };
        let count = points.div_ceil(per_condition).max(2);
        let speeds =
            if rng.random_range(0..3) == 0 { vec![NOMINAL_RPM, 356.0] } else { vec![NOMINAL_RPM] };
        let mut left = points;
        let (mut volts, mut harmonics, mut groups) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..count {
            let place = (k as f64 + 0.5) / count as f64;
            let condition = condition(rng, place, &speeds);
            let harmonic = rng.random_range(2..6);
            let further = per_condition.min(left).saturating_sub(1);
            let mut all = vec![vec![Voltage::new(), Voltage::new()]];
            if is_driven && further > 0 {
                let (more, own) = drives(rng, further, harmonic);
                all.extend(more);
                volts.extend(own);
                harmonics.push(harmonic);
            }
            left = left.saturating_sub(all.len());
            groups.push(Group { condition, drives: all });
        }
        let middle_volt = middle(volts, f64::total_cmp).unwrap_or(20.0);
        let middle_harmonic = middle(harmonics, usize::cmp).unwrap_or(3);
        Self { groups, drives: Drives { is_driven, middle_volt, middle_harmonic } }
    }
}
