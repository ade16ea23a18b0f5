//! Inputs of the experiments that may be proposed, on the range of the measured runs.

use std::f64::consts::{PI, TAU};

/// Middle and half of the range of the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub(crate) middle: f64,
    pub(crate) half: f64,
}

/// Rest at the beginning of a run, s.
const REST_S: f64 = 0.1;

fn sampled(seconds: f64, step_s: f64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut values = Vec::new();
    let mut time_s = 0.0;
    while time_s < seconds {
        values.push(value(time_s));
        time_s = values.len() as f64 * step_s;
    }
    values
}

impl Span {
    /// A place in the range: -1 its low end, 1 its high end.
    pub(crate) fn at(self, place: f64) -> f64 {
        self.middle + place * self.half
    }

    /// Equal lines from `band.0` to `band.1`, Hz, `spacing_hz` apart, about the middle; `peak` is the
    /// largest deviation in half ranges.
    ///
    /// Phases that grow with the square of the number spread the lines over the period:
    /// M. R. Schroeder, IEEE Transactions on Information Theory 16 (1970).
    pub(crate) fn multisine(
        self,
        band: (f64, f64),
        spacing_hz: f64,
        peak: f64,
        seconds: f64,
        step_s: f64,
    ) -> Vec<f64> {
        let count = ((band.1 - band.0) / spacing_hz).floor() + 1.0;
        let mut sum = sampled(seconds, step_s, |_| 0.0);
        let mut line = 0.0;
        while line < count {
            let (hz, phase) = (band.0 + line * spacing_hz, -PI * line * line / count);
            for (i, v) in sum.iter_mut().enumerate() {
                *v += (TAU * hz * step_s * i as f64 + phase).cos();
            }
            line += 1.0;
        }
        let largest = sum.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
        sum.iter()
            .enumerate()
            .map(|(i, v)| {
                let fade = (i as f64 * step_s / REST_S).min(1.0);
                self.at(fade * peak * v / largest)
            })
            .collect()
    }

    /// Sines of one frequency about a place, of amplitudes in half ranges with their cycles, one after
    /// the other.
    pub(crate) fn bursts(
        self,
        hz: f64,
        about: f64,
        bursts: &[(f64, f64)],
        step_s: f64,
    ) -> Vec<f64> {
        let seconds: f64 = REST_S + bursts.iter().map(|b| b.1 / hz).sum::<f64>();
        sampled(seconds, step_s, |t| {
            let mut begin = REST_S;
            if t < begin {
                return self.at(about * t / REST_S);
            }
            for &(amplitude, cycles) in bursts {
                if t < begin + cycles / hz {
                    return self.at(about + amplitude * (TAU * hz * (t - begin)).sin());
                }
                begin += cycles / hz;
            }
            self.at(about)
        })
    }

    /// Straight lines through places, each reached at its time, s; the first at time zero.
    pub(crate) fn path(self, points: &[(f64, f64)], step_s: f64) -> Vec<f64> {
        let seconds = points.last().map_or(0.0, |p| p.0);
        sampled(seconds, step_s, |t| {
            let after = points.iter().position(|p| p.0 > t).unwrap_or(points.len() - 1).max(1);
            let ((t0, v0), (t1, v1)) = (points[after - 1], points[after]);
            self.at(v0 + (v1 - v0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0))
        })
    }

    /// Places held one after the other, each reached within 5 ms.
    pub(crate) fn steps(self, places: &[f64], hold_s: f64, step_s: f64) -> Vec<f64> {
        let mut points = vec![(0.0, 0.0), (REST_S, 0.0)];
        let mut time = REST_S;
        for &place in places {
            points.push((time + 0.005, place));
            time += hold_s;
            points.push((time, place));
        }
        self.path(&points, step_s)
    }

    /// Triangles about the middle, one of each amplitude.
    pub(crate) fn triangles(self, hz: f64, amplitudes: &[f64], step_s: f64) -> Vec<f64> {
        let mut points = vec![(0.0, 0.0), (REST_S, 0.0)];
        let mut time = REST_S;
        for amplitude in amplitudes {
            for (part, place) in [(0.25, 1.0), (0.75, -1.0), (1.0, 0.0)] {
                points.push((time + part / hz, place * amplitude));
            }
            time += 1.0 / hz;
        }
        self.path(&points, step_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_keeps_to_its_amplitude_and_length() {
        let span = Span { middle: 65.0, half: 85.0 };
        let inputs = [
            (span.multisine((5.0, 181.0), 2.0, 0.3, 2.0, 5e-4), 0.3, 4000),
            (span.bursts(10.0, 0.0, &[(0.2, 5.0), (0.5, 5.0)], 1e-3), 0.5, 1100),
            (span.steps(&[0.6, -0.6, 0.0], 0.5, 1e-2), 0.6, 160),
            (span.triangles(2.0, &[0.1, 0.4], 1e-3), 0.4, 1100),
        ];
        for (input, peak, samples) in inputs {
            let largest = input.iter().map(|u| (u - 65.0).abs()).fold(0.0, f64::max) / 85.0;
            assert!((largest / peak - 1.0).abs() < 0.02, "{largest} of {peak}");
            assert!(input.len().abs_diff(samples) <= 2, "{} of {samples}", input.len());
        }
    }
}
