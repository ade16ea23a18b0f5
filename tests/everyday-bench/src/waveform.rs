//! Commands of the runs, as deviations from the bias.

use std::f64::consts::{PI, TAU};

use crate::draw::Draw;

/// Rest at the beginning of a run and before each burst, s.
pub(crate) const REST_S: f64 = 0.1;

/// Fade-in of a multisine, s.
const FADE_S: f64 = 0.2;

/// A deviation from the bias as a function of time; it begins at zero.
#[derive(Debug, Clone, PartialEq)]
pub enum Waveform {
    /// Straight lines between points (s, V), the first at time zero.
    Lines(Vec<(f64, f64)>),
    /// Sines of one frequency, one burst after the other, with a rest before each.
    Bursts {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Amplitude of each burst, V, and its number of cycles.
        bursts: Vec<(f64, u32)>,
    },
    /// Lines of equal height and random phases, faded in.
    Multisine {
        /// Lowest line, Hz.
        low_hz: f64,
        /// Highest line, Hz.
        high_hz: f64,
        /// Distance of the lines, Hz.
        spacing_hz: f64,
        /// Largest deviation, V.
        peak_volt: f64,
        /// Duration, s.
        seconds: f64,
        /// Keys of the phases.
        keys: [u64; 2],
    },
}

impl Waveform {
    /// Triangles of one frequency after a rest.
    pub(crate) fn triangles(frequency_hz: f64, amplitudes_volt: &[f64]) -> Self {
        let quarter = 0.25 / frequency_hz;
        let mut points = vec![(0.0, 0.0), (REST_S, 0.0)];
        for (begin, amplitude) in amplitudes_volt.iter().enumerate() {
            let begin_s = REST_S + 4.0 * quarter * begin as f64;
            points.extend([
                (begin_s + quarter, *amplitude),
                (begin_s + 3.0 * quarter, -amplitude),
                (begin_s + 4.0 * quarter, 0.0),
            ]);
        }
        Self::Lines(points)
    }

    /// Lines of one slope (V/s) through turning points (V) after a rest.
    pub(crate) fn ramps(speed_volt_per_s: f64, turns_volt: &[f64]) -> Self {
        let mut points = vec![(0.0, 0.0), (REST_S, 0.0)];
        let (mut time_s, mut from) = (REST_S, 0.0_f64);
        for turn in turns_volt {
            time_s += (turn - from).abs() / speed_volt_per_s;
            from = *turn;
            points.push((time_s, from));
        }
        Self::Lines(points)
    }

    /// Levels (V) held one after the other, each reached within 5 ms, after a rest.
    pub(crate) fn steps(levels_volt: &[f64], hold_s: f64) -> Self {
        let mut points = vec![(0.0, 0.0), (REST_S, 0.0)];
        for (i, level) in levels_volt.iter().enumerate() {
            let begin_s = REST_S + hold_s * i as f64;
            points.extend([(begin_s + 0.005, *level), (begin_s + hold_s, *level)]);
        }
        Self::Lines(points)
    }

    /// Nothing for a while, then one short triangle and nothing again.
    pub(crate) fn pulse(rest_s: f64, peak_volt: f64) -> Self {
        let end_s = rest_s + 0.2;
        Self::Lines(vec![
            (0.0, 0.0),
            (rest_s, 0.0),
            (rest_s + 0.05, peak_volt),
            (rest_s + 0.1, 0.0),
            (end_s, 0.0),
        ])
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        match self {
            Self::Lines(points) => points.last().map_or(0.0, |point| point.0),
            Self::Bursts { frequency_hz, bursts } => {
                bursts.iter().map(|(_, cycles)| REST_S + f64::from(*cycles) / frequency_hz).sum()
            }
            Self::Multisine { seconds, .. } => REST_S + seconds,
        }
    }

    /// The deviation at `count` instants, `dt_s` apart, the first at time zero; V.
    pub fn sample(&self, dt_s: f64, count: usize) -> Vec<f64> {
        let times = (0..count).map(|i| i as f64 * dt_s);
        match self {
            Self::Lines(points) => {
                let mut at = 0;
                let value = |t: f64| {
                    while at + 2 < points.len() && t > points[at + 1].0 {
                        at += 1;
                    }
                    let (from, to) = (points[at], points[at + 1]);
                    from.1 + (to.1 - from.1) * ((t - from.0) / (to.0 - from.0)).clamp(0.0, 1.0)
                };
                times.map(value).collect()
            }
            Self::Bursts { frequency_hz, bursts } => {
                let mut end_s = 0.0;
                let mut spans = Vec::new();
                for (amplitude, cycles) in bursts {
                    let begin_s = end_s + REST_S;
                    end_s = begin_s + f64::from(*cycles) / frequency_hz;
                    spans.push((begin_s, end_s, *amplitude));
                }
                let value = |t: f64| {
                    let inside = spans.iter().find(|(begin, end, _)| t > *begin && t < *end);
                    inside.map_or(0.0, |(begin, _, a)| a * (TAU * frequency_hz * (t - begin)).sin())
                };
                times.map(value).collect()
            }
            Self::Multisine { low_hz, high_hz, spacing_hz, peak_volt, keys, .. } => {
                let mut draw = Draw::new("phases", keys);
                let mut sum = vec![0.0; count];
                let mut frequency_hz = *low_hz;
                while frequency_hz < high_hz + 0.5 * spacing_hz {
                    add_line(&mut sum, frequency_hz * dt_s, draw.uniform(0.0, TAU));
                    frequency_hz += spacing_hz;
                }
                let largest = sum.iter().fold(f64::MIN_POSITIVE, |m, v| v.abs().max(m));
                for (v, t) in sum.iter_mut().zip(times) {
                    let share = ((t - REST_S) / FADE_S).clamp(0.0, 1.0);
                    *v *= peak_volt / largest * 0.5 * (1.0 - (PI * share).cos());
                }
                sum
            }
        }
    }
}

/// Adds `cos(2 pi turns i + phase)`: `c(i+1) = 2 cos(2 pi turns) c(i) - c(i-1)`.
fn add_line(sum: &mut [f64], turns: f64, phase: f64) {
    let twice = 2.0 * (TAU * turns).cos();
    let (mut before, mut now) = ((phase - TAU * turns).cos(), phase.cos());
    for v in sum {
        *v += now;
        (before, now) = (now, twice * now - before);
    }
}
