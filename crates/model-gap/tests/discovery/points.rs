//! Tables of points: many experiments of one or two values each.

use crate::toy::{candidate, noise};
use model_gap::discovery::{Confidence, Discovery, Finding, Settings, Trace, TraceRole, Verdict};
use model_gap::discovery::{Signal, Simulator};
use model_gap::{Effect, GapError, Spectrum};
use nalgebra::DMatrix;

/// A quantity over a swept condition, so many values at each point; the first cause adds a narrow peak in the middle.
struct Points {
    points: usize,
    values: usize,
}

impl Points {
    fn peak(&self, point: usize) -> f64 {
        let x = point as f64 / self.points as f64;
        (-((x - 0.5) / 0.02).powi(2)).exp()
    }

    /// Noise of deviation 1, and what is added to every value of a point.
    fn traces(&self, seed: u64, added: impl Fn(usize) -> f64) -> Vec<Trace> {
        let mut state = seed;
        (0..self.points)
            .map(|point| Trace {
                experiment: point,
                step_s: 1.0,
                measured: (0..self.values).map(|_| noise(&mut state) + added(point)).collect(),
                sigma: 1.0,
                spectrum: Spectrum::default(),
                noise: 1.0,
                nuisance: DMatrix::zeros(self.values, 0),
                block: 1,
                role: TraceRole::Output,
            })
            .collect()
    }

    fn find(&self, traces: &[Trace]) -> Finding {
        let settings = Settings { resamplings: 50, ..Settings::default() };
        let candidates = [candidate("peak")];
        Discovery { settings, ..Discovery::new(traces, self, &candidates) }.find().unwrap()
    }
}

impl Simulator for Points {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        let size: f64 = effects.iter().map(|e| e.values[0]).sum();
        Ok((0..self.points).map(|p| vec![size * self.peak(p); self.values]).collect())
    }
}

/// With a normal approximation and no count of the points 20 of 100 tables of 40 points were `unknown`.
#[test]
fn points_of_pure_noise_show_nothing_however_many_they_are() {
    for (points, values) in [(40, 1), (40, 2), (20, 12), (200, 1)] {
        let table = Points { points, values };
        let shown = (0..100_u64)
            .filter(|seed| {
                let found = table.find(&table.traces(1 + 7 * seed, |_| 0.0));
                found.verdict == Verdict::Unknown || !found.causes.is_empty()
            })
            .count();
        assert!(shown <= 3, "{points} points of {values}: {shown} of 100");
    }
}

#[test]
fn a_point_far_off_is_no_narrow_peak() {
    let table = Points { points: 40, values: 1 };
    for (what, off) in [("one point", [20, 20]), ("two neighbours", [20, 21])] {
        for seed in 0..60_u64 {
            let traces = table.traces(1 + 7 * seed, |p| if off.contains(&p) { 8.0 } else { 0.0 });
            let found = table.find(&traces);
            let is_sure =
                found.verdict == Verdict::Named && found.confidence == Confidence::Confident;
            assert!(!is_sure, "{what}, {seed}: {:?}", found.reasons);
        }
    }
}
