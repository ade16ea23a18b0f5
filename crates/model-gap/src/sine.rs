//! Inputs that are one sine.

use nalgebra::{Matrix4, Vector4};
use std::f64::consts::TAU;
use std::ops::Range;

/// One sinusoid about a mean, with or without a rest before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct Sine {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude, in the input's unit.
    pub amplitude: f64,
    /// Mean, in the input's unit.
    pub mean: f64,
    /// The samples (from 0) over which it lasts. The response to the first cycles may still be
    /// settling.
    pub samples: Range<usize>,
}

/// Part of the energy beside the sinusoid that still passes for a sine (-30 dB, 3 % in amplitude).
const LARGEST_REST: f64 = 1e-3;

/// Part of the range that a signal must swing to either side of its middle to count as crossing it.
const CROSSING_BAND: f64 = 0.2;

/// Part of the range within which the input is at rest.
const REST_BAND: f64 = 0.01;

/// Distance from the sine, over its amplitude, within which a sample belongs to it.
const ON_SINE: f64 = 1e-3;

const REFINEMENTS: usize = 8;

impl Sine {
    /// The sine that an input is, of at least nine tenths of a cycle; time step in s. None for anything
    /// else: steps, ramps, reversal curves, mixtures.
    ///
    /// The frequency is guessed from the crossings of the middle and refined by the four-parameter
    /// least squares fit of a sine (mean, cosine, sine, frequency).
    pub fn of(record: &[f64], time_step_s: f64) -> Option<Self> {
        let moving = moving(record)?;
        let samples = record.get(moving.clone())?;
        let duration = samples.len() as f64;
        let guess = cycles_per_sample(samples)?;
        let mut frequency = guess;
        let mut fit = Vector4::zeros();
        let mut rest = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            let angle = |i: usize| TAU * (frequency * i as f64).fract();
            let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
            for (i, &value) in samples.iter().enumerate() {
                let (sin, cos) = angle(i).sin_cos();
                let time = i as f64 / duration - 0.5;
                let slope = time * (fit[2] * cos - fit[1] * sin);
                let row = Vector4::new(1.0, cos, sin, slope);
                normal += row * row.transpose();
                right += row * value;
            }
            if fit[1] == 0.0 && fit[2] == 0.0 {
                normal[(3, 3)] = 1.0; // first pass: frequency held
            }
            // the last unknown is the change of phase, in rad, from one end of the record to the other
            let found = normal.cholesky()?.solve(&right);
            let change = found[3] / (TAU * duration);
            fit = found;
            let (mut left, mut energy) = (0.0, 0.0);
            for (i, &value) in samples.iter().enumerate() {
                let (sin, cos) = angle(i).sin_cos();
                let about = value - fit[0];
                left += (about - fit[1] * cos - fit[2] * sin).powi(2);
                energy += about.powi(2);
            }
            rest = left / energy;
            if change.abs() <= 1e-12 * frequency && found[3] != 0.0 {
                break;
            }
            frequency += change;
            if !(0.5 * guess..2.0 * guess).contains(&frequency) {
                return None;
            }
        }
        if frequency * duration < 0.9 || rest > LARGEST_REST {
            return None;
        }
        // The ends of the sine may lie inside the band of the rest.
        let amplitude = fit[1].hypot(fit[2]);
        let on_sine = |i: usize| {
            let angle = TAU * frequency * (i as f64 - moving.start as f64);
            let sine = fit[0] + fit[1] * angle.cos() + fit[2] * angle.sin();
            (record[i] - sine).abs() <= ON_SINE * amplitude
        };
        let start = (0..moving.start).rev().take_while(|&i| on_sine(i)).last();
        let end = (moving.end..record.len()).take_while(|&i| on_sine(i)).last();
        let samples = start.unwrap_or(moving.start)..end.map_or(moving.end, |last| last + 1);
        Some(Self { frequency_hz: frequency / time_step_s, amplitude, mean: fit[0], samples })
    }
}

/// The samples between a rest at the start and a rest at the end, if there are such.
fn moving(record: &[f64]) -> Option<Range<usize>> {
    let (low, high) = range(record);
    let (first, last) = (record.first()?, record.last()?);
    let away = |value: f64, rest: f64| (value - rest).abs() > REST_BAND * (high - low);
    let start = record.iter().position(|&value| away(value, *first))?;
    let end = record.iter().rposition(|&value| away(value, *last))?;
    (start < end).then_some(start..end + 1)
}

fn range(samples: &[f64]) -> (f64, f64) {
    samples
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

/// Cycles per sample from the crossings of the middle, each armed by leaving a band about it.
fn cycles_per_sample(samples: &[f64]) -> Option<f64> {
    let (low, high) = range(samples);
    let (middle, band) = (f64::midpoint(low, high), CROSSING_BAND * (high - low));
    let mut side = 0.0;
    let mut since = 0;
    let mut crossings: Vec<f64> = Vec::new();
    for (i, &value) in samples.iter().enumerate() {
        let about = value - middle;
        if side * about < 0.0 && since == 0 {
            since = i;
        } else if side * about > 0.0 {
            since = 0;
        }
        if about.abs() > band {
            if side * about < 0.0 {
                let (a, b) = (samples[since - 1] - middle, samples[since] - middle);
                crossings.push((since - 1) as f64 + a / (a - b));
                since = 0;
            }
            side = about.signum();
        }
    }
    let (first, last) = (crossings.first()?, crossings.last()?);
    (crossings.len() >= 2).then(|| 0.5 * (crossings.len() - 1) as f64 / (last - first))
}
