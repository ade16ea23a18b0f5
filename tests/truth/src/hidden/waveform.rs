//! Commands of the runs, sampled as finely as the integration asks for.

use std::f64::consts::TAU;

use super::draw::{Draw, Purpose};

/// A command as a function of time; it begins at the bias.
#[derive(Debug, Clone, PartialEq)]
pub enum Waveform {
    /// Straight lines between points (s, V), the first at time zero.
    Path(Vec<(f64, f64)>),
    /// Sines of one frequency about the bias, one after the other, with a short rest before each.
    Bursts {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Mean voltage, V; from the bias it is reached by a ramp during the first rest.
        mean_volt: f64,
        /// Amplitude of each burst, V, and its number of cycles.
        bursts: Vec<(f64, u32)>,
    },
    /// Lines of equal height from `low_hz` to `high_hz` with random phases, about the bias, faded in.
    Multisine {
        /// Lowest line, Hz.
        low_hz: f64,
        /// Highest line, Hz.
        high_hz: f64,
        /// Distance of the lines, Hz.
        spacing_hz: f64,
        /// Largest deviation from the bias, V.
        peak_volt: f64,
        /// Duration, s.
        seconds: f64,
        /// Key of the phases.
        key: u64,
    },
}

/// Rest before each burst, s.
const REST_S: f64 = 0.1;

/// Fade-in of a multisine, s.
const FADE_S: f64 = 0.25;

impl Waveform {
    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        match self {
            Self::Path(points) => points.last().map_or(0.0, |point| point.0),
            Self::Bursts { frequency_hz, bursts, .. } => {
                bursts.iter().map(|(_, cycles)| REST_S + f64::from(*cycles) / frequency_hz).sum()
            }
            Self::Multisine { seconds, .. } => *seconds + REST_S,
        }
    }

    /// Triangles about the bias after a short rest.
    pub fn triangles(bias_volt: f64, frequency_hz: f64, amplitudes_volt: &[f64]) -> Self {
        let mut points = vec![(0.0, bias_volt), (REST_S, bias_volt)];
        let mut time_s = REST_S;
        for amplitude in amplitudes_volt {
            for (share, sign) in [(0.25, 1.0), (0.5, -1.0), (0.25, 0.0)] {
                time_s += share / frequency_hz;
                points.push((time_s, bias_volt + sign * amplitude));
            }
        }
        Self::Path(points)
    }

    /// Levels held one after the other, reached within 5 ms, after a short rest at the bias.
    pub fn steps(bias_volt: f64, levels_volt: &[f64], hold_s: f64) -> Self {
        let mut points = vec![(0.0, bias_volt), (REST_S, bias_volt)];
        let mut time_s = REST_S;
        for level in levels_volt {
            points.push((time_s + 0.005, *level));
            time_s += hold_s;
            points.push((time_s, *level));
        }
        Self::Path(points)
    }

    /// Straight lines of one speed from the bias through turning points, after a short rest.
    pub fn ramps(bias_volt: f64, speed_volt_per_s: f64, turning_points_volt: &[f64]) -> Self {
        let mut points = vec![(0.0, bias_volt), (REST_S, bias_volt)];
        let (mut time_s, mut from) = (REST_S, bias_volt);
        for to in turning_points_volt {
            time_s += (to - from).abs() / speed_volt_per_s;
            points.push((time_s, *to));
            from = *to;
        }
        Self::Path(points)
    }

    /// A rest at the bias, then one triangle of 0.2 s: ten periods of a hum pass over it.
    pub fn pulse(bias_volt: f64, rest_s: f64, amplitude_volt: f64) -> Self {
        Self::Path(vec![
            (0.0, bias_volt),
            (rest_s, bias_volt),
            (rest_s + 0.1, bias_volt + amplitude_volt),
            (rest_s + 0.2, bias_volt),
            (rest_s + 0.25, bias_volt),
        ])
    }

    /// The command at `count` instants, `dt_s` apart, the first at time zero; V.
    pub fn sample(&self, bias_volt: f64, dt_s: f64, count: usize) -> Vec<f64> {
        match self {
            Self::Path(points) => path(points, dt_s, count),
            Self::Bursts { frequency_hz, mean_volt, bursts } => {
                let mut starts = Vec::new();
                let mut time_s = 0.0;
                for (amplitude, cycles) in bursts {
                    let begin = time_s + REST_S;
                    time_s = begin + f64::from(*cycles) / frequency_hz;
                    starts.push((begin, time_s, *amplitude));
                }
                let mut at = 0;
                (0..count)
                    .map(|i| {
                        let t = i as f64 * dt_s;
                        while at + 1 < starts.len() && t > starts[at].1 {
                            at += 1;
                        }
                        let Some(&(begin, end, amplitude)) = starts.get(at) else {
                            return bias_volt;
                        };
                        let approach = (t / REST_S).min(1.0);
                        let mean = bias_volt + approach * (mean_volt - bias_volt);
                        let inside = t > begin && t < end;
                        let sine = (TAU * frequency_hz * (t - begin)).sin();
                        if inside { mean + amplitude * sine } else { mean }
                    })
                    .collect()
            }
            Self::Multisine { low_hz, high_hz, spacing_hz, peak_volt, key, .. } => {
                let mut draw = Draw::new(Purpose::Phases, &[*key]);
                let mut lines = Vec::new();
                let mut frequency = *low_hz;
                while frequency < high_hz + 0.5 * spacing_hz {
                    lines.push((frequency, draw.uniform(0.0, TAU)));
                    frequency += spacing_hz;
                }
                let mut sum = sum_of_lines(&lines, dt_s, count);
                let largest = sum.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (i, v) in sum.iter_mut().enumerate() {
                    let t = i as f64 * dt_s - REST_S;
                    let share = (t / FADE_S).clamp(0.0, 1.0);
                    let fade = 0.5 - 0.5 * (0.5 * TAU * share).cos();
                    *v = bias_volt + fade * *v * peak_volt / largest;
                }
                sum
            }
        }
    }
}

fn path(points: &[(f64, f64)], dt_s: f64, count: usize) -> Vec<f64> {
    let mut at = 0;
    (0..count)
        .map(|i| {
            let t = i as f64 * dt_s;
            while at + 2 < points.len() && t > points[at + 1].0 {
                at += 1;
            }
            let ((t0, v0), (t1, v1)) = (points[at], points[at + 1]);
            v0 + (v1 - v0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0)
        })
        .collect()
}

/// Sum of cosines of height 1, each turned on by a rotation from sample to sample.
fn sum_of_lines(lines: &[(f64, f64)], dt_s: f64, count: usize) -> Vec<f64> {
    let mut sum = vec![0.0; count];
    for (frequency_hz, phase) in lines {
        let (turn_sine, turn_cosine) = (TAU * frequency_hz * dt_s).sin_cos();
        let (mut sine, mut cosine) = phase.sin_cos();
        for v in &mut sum {
            *v += cosine;
            (cosine, sine) =
                (cosine * turn_cosine - sine * turn_sine, sine * turn_cosine + cosine * turn_sine);
        }
    }
    sum
}
