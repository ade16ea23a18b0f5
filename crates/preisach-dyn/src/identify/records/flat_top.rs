//! Outputs that were cut off, seen through noise.
//!
//! ```text
//! W(d): command travel while the output is within d of its extreme level, over all tops there
//! cut off at a level:   W(d) = W0 + d / slope      a plateau with corners
//! a rounded top:        W(d) ~ sqrt(d)             a sine, a loop that flattens
//! a tip:                W(d) ~ d                   a triangle
//! saturation:           W(d) ~ W0 + ln d           the law flattens towards the end of its range
//! ```
//! So a cut shows in two ratios of `W` at `d`, `4 d` and `16 d`, with `d` three times the noise of a
//! mean over a few samples: the plateau hardly widens, and then widens as a straight line does. The
//! command must turn round on the plateau: lost motion rests after the turn only, friction slips before
//! it only.

use crate::check::extremes;
use crate::identify::records::noise::{Fine, median};
use crate::identify::{BenchRecord, Drive};
use crate::laws::play_map::split;
use std::ops::Range;

/// Half of the plateau's depth over the noise of the smoothed output.
const DEPTH: f64 = 3.0;
/// Least depth, as a share of the output's range: what averaging does to a corner is less deep.
const LEAST_DEPTH: f64 = 0.008;
/// Largest share of the range that the deepest of the three depths may take.
const MOST_DEPTH: f64 = 0.5;
/// Samples averaged: this share of those it takes to run through the range.
const SMOOTHED: f64 = 1.0 / 80.0;
/// Averaged at most.
const MOST_SMOOTHED: f64 = 64.0;
/// `W(4 d) / W(d)` of a plateau at most.
const PLATEAU: f64 = 1.5;
/// `[W(16 d) - W(4 d)] / [W(4 d) - W(d)]` of a corner at least: 4 of a sharp one, 2 of a rounded top.
const CORNER: f64 = 2.6;
/// Share of the travel on a plateau that each direction of the command has at least.
const BOTH_WAYS: f64 = 0.15;
/// Samples of a plateau at least, in the mean over all.
const FEWEST: usize = 4;
/// Command travel on a plateau at least, as a share of the command's range.
const MOVES: f64 = 0.02;

/// An output that rests at one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FlatTop {
    /// Where, deg.
    pub(crate) level_deg: f64,
    /// Share of the samples there.
    pub(crate) share: f64,
}

impl FlatTop {
    /// The cut of a record's output, the upper one of two; none if there is none that noise and the
    /// sampling (some 50 samples from end to end) let see.
    pub(crate) fn of(record: &BenchRecord, drive: &Drive, is_slow: bool) -> Option<Self> {
        let judged = record.judged_samples();
        let (y, u) = (&record.output_deg[judged.clone()], &record.voltage_volt[judged]);
        let fine = Fine::of(y);
        let travel = |values: &[f64]| values.windows(2).map(|p| (p[1] - p[0]).abs()).sum::<f64>();
        let range_volt = 2.0 * drive.amplitude_volt;
        let moving = u.windows(2).filter(|p| (p[1] - p[0]).abs() > 0.0).count() as f64;
        let crossing = moving * range_volt / travel(u);
        let (half, _) = split((SMOOTHED * crossing).clamp(0.0, MOST_SMOOTHED) / 2.0);
        let output = smoothed(y, half);
        let command = delayed(&smoothed(u, half), record, drive, is_slow);
        let noise = fine.std_deg / ((2 * half + 1) as f64).sqrt() + fine.quantum_deg;
        let [low, high] = extremes(output.iter().copied());
        let depth = (DEPTH * noise).max(LEAST_DEPTH * (high - low));
        if 16.0 * depth > MOST_DEPTH * (high - low) {
            return None;
        }
        [1.0, -1.0].into_iter().find_map(|sign| {
            let upright: Vec<f64> = output.iter().map(|y| sign * y).collect();
            let top = Top { output: &upright, command: &command, depth, noise };
            top.cut(range_volt).map(|cut| Self { level_deg: sign * cut.level_deg, ..cut })
        })
    }
}

/// The output right way up, with what is needed to judge its top.
struct Top<'a> {
    output: &'a [f64],
    command: &'a [f64],
    depth: f64,
    noise: f64,
}

impl Top<'_> {
    fn cut(&self, range_volt: f64) -> Option<FlatTop> {
        let highest = self.output.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // the highest of many noisy samples lies above the level of the plateau
        let near = highest - 2.0 * DEPTH * self.noise;
        let level_deg = median(self.output.iter().copied().filter(|y| *y >= near).collect());
        let mut widths = [0.0; 3];
        let (mut up, mut down, mut samples, mut tops) = (0.0, 0.0, 0, 0);
        for outer in self.runs(0..self.output.len(), level_deg - 16.0 * self.depth) {
            let hull = |depth: f64| {
                let mut runs = self.runs(outer.clone(), level_deg - depth);
                let first = runs.next()?;
                Some(first.start..runs.last().map_or(first.end, |last| last.end))
            };
            // only tops that reach the level, and not those the record begins or ends with
            let Some(inner) = hull(self.depth) else { continue };
            if outer.start == 0 || outer.end == self.output.len() {
                continue;
            }
            let middle = hull(4.0 * self.depth)?;
            let runs = [(1.0, &inner), (4.0, &middle), (16.0, &outer)];
            for (width, (times, run)) in widths.iter_mut().zip(runs) {
                *width += self.width(run, level_deg - times * self.depth);
            }
            let [rising, falling] = self.travel(&inner);
            (up, down) = (up + rising, down + falling);
            (samples, tops) = (samples + inner.len(), tops + 1);
        }
        let [inner, middle, outer] = widths;
        let rests = tops > 0 && samples >= FEWEST * tops && inner > MOVES * range_volt;
        let flat = middle <= PLATEAU * inner;
        let sharp = outer - middle >= CORNER * (middle - inner);
        let both = up.min(down) >= BOTH_WAYS * (up + down);
        let share = samples as f64 / self.output.len() as f64;
        (rests && flat && sharp && both).then_some(FlatTop { level_deg, share })
    }

    /// Runs of samples at or above a level.
    fn runs(&self, within: Range<usize>, level: f64) -> impl Iterator<Item = Range<usize>> {
        let mut next = within.start;
        std::iter::from_fn(move || {
            while next < within.end && self.output[next] < level {
                next += 1;
            }
            let start = next;
            while next < within.end && self.output[next] >= level {
                next += 1;
            }
            (next > start).then_some(start..next)
        })
    }

    /// Travel of the command over a run, up to where the output, straight between samples, crosses the
    /// level.
    fn width(&self, run: &Range<usize>, level: f64) -> f64 {
        let edge = |inside: usize, outside: usize| {
            let (a, b) = (self.output[inside] - level, level - self.output[outside]);
            (self.command[inside] - self.command[outside]).abs() * a
                / (a + b).max(f64::MIN_POSITIVE)
        };
        let inner: f64 = self.travel(run).iter().sum();
        inner + edge(run.start, run.start - 1) + edge(run.end - 1, run.end)
    }

    /// How far the command rises and falls over a run.
    fn travel(&self, run: &Range<usize>) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for pair in self.command[run.start..run.end].windows(2) {
            let change = pair[1] - pair[0];
            sums[usize::from(change < 0.0)] += change.abs();
        }
        sums
    }
}

/// Means over `half` samples before and behind.
fn smoothed(values: &[f64], half: usize) -> Vec<f64> {
    (0..values.len())
        .map(|i| {
            let around = &values[i.saturating_sub(half)..(i + half + 1).min(values.len())];
            around.iter().sum::<f64>() / around.len() as f64
        })
        .collect()
}

/// The command as late as the strongest harmonic of the output is behind it, where that can be told:
/// the top of a fast loop lies behind that of its command.
fn delayed(command: &[f64], record: &BenchRecord, drive: &Drive, is_slow: bool) -> Vec<f64> {
    let lag = if drive.is_periodic() && !is_slow { drive.lag_deg(record) } else { None };
    let per_sample = drive.base_hz * record.time_step_s * drive.strongest_harmonic as f64;
    let (whole, _) = split(lag.map_or(0.0, |lag_deg| lag_deg / 360.0 / per_sample).max(0.0));
    let first = command.first().copied().unwrap_or_default();
    std::iter::repeat_n(first, whole).chain(command.iter().copied()).take(command.len()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ActuatorLaw, ActuatorModel, Backlash, Calibration, CoulombFriction, LinkageStage, PlayMap,
        PrandtlStop, PreisachGrid, Relaxation, RelaxationElement, StaticPreisach, StopParameters,
        VoltageRange, WeightedStop,
    };
    use chacha20::ChaCha8Rng;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use std::f64::consts::TAU;

    /// Loops of about +-10 deg; `bend` of them flattens the law towards the ends of its range.
    fn actuator(bend: f64, linkage: Vec<LinkageStage>) -> ActuatorModel {
        let range = VoltageRange::amplified_stack();
        let grid = PreisachGrid::new(range, 24).unwrap();
        let rises: Vec<Vec<f64>> = (0..24_u32)
            .map(|j| {
                (0..24 - j)
                    .map(|k| {
                        let (s, r) = (f64::from(2 * k + j) / 24.0 - 1.0, f64::from(j) / 24.0);
                        let weight = if j == 0 { 12.0 } else { 1.0 };
                        weight * (-3.0 * r - bend * s * s).exp() / 18.0
                    })
                    .collect()
            })
            .collect();
        let total: f64 = rises.iter().flatten().sum();
        let scaled: Vec<Vec<f64>> =
            rises.iter().map(|row| row.iter().map(|v| v * 20.0 / total).collect()).collect();
        let map = PlayMap::from_rises(&grid, 0.0, &scaled).unwrap();
        let law = ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, map).unwrap());
        let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
        ActuatorModel { linkage, ..ActuatorModel::new(law, range, calibration) }
    }

    /// Sines, a triangle, a mix and reversal curves, each with its rate of samples.
    fn commands() -> Vec<(&'static str, f64, Vec<f64>)> {
        let at = |count: usize, step_s: f64, u: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..count).map(|i| 65.0 + u(i as f64 * step_s)).collect()
        };
        let triangle = |t: f64| 85.0 * (1.0 - 4.0 * ((t + 0.25).rem_euclid(1.0) - 0.5).abs());
        let reversals = |t: f64| {
            // down from the top ever deeper, and up again
            let depth = 20.0 + 15.0 * (t / 2.0).floor();
            85.0 - depth * (1.0 - (t.rem_euclid(2.0) - 1.0).abs())
        };
        let mix = |t: f64| {
            let wave = |n: f64, phase: f64| (TAU * 5.0 * n * t + phase).cos();
            28.0 * (wave(2.0, 0.3) + wave(3.0, 1.0) + wave(4.0, 2.0))
        };
        let mut all = vec![
            ("triangle", 1e-3, at(4000, 1e-3, &triangle)),
            ("reversals", 2e-3, at(9000, 2e-3, &reversals)),
            ("mix", 5e-4, at(3700, 5e-4, &mix)),
        ];
        for (name, hz, step_s, count) in [
            ("0.2 Hz", 0.2, 2.5e-3, 5000),
            ("1 Hz", 1.0, 1e-3, 6000),
            ("10 Hz", 10.0, 5e-4, 2900),
            ("20 Hz", 20.0, 5e-4, 2500),
            ("20 Hz, coarse", 20.0, 2e-3, 1000),
        ] {
            all.push((name, step_s, at(count, step_s, &|t| 85.0 * (TAU * hz * t).sin())));
        }
        all
    }

    fn judged(
        model: &ActuatorModel,
        step_s: f64,
        volts: &[f64],
        sensor: &mut dyn FnMut(f64) -> f64,
    ) -> Option<FlatTop> {
        let output = model.simulate(volts, step_s).unwrap().output_deg;
        let record = BenchRecord {
            id: "r".into(),
            time_step_s: step_s,
            voltage_volt: volts.to_vec(),
            output_deg: output.into_iter().map(sensor).collect(),
            ..BenchRecord::default()
        };
        let drive = record.drive();
        let is_slow = crate::identify::SplitRule::default().is_quasi_static(&drive);
        FlatTop::of(&record, &drive, is_slow)
    }

    fn lagging() -> LinkageStage {
        let element = RelaxationElement { share: 0.95, time_constant_s: 0.008 };
        LinkageStage::Relaxation(Relaxation { elements: vec![element] })
    }

    /// Records of 100 samples a cycle and more, cut off at 8 to 40 % below either end, seen through noise
    /// of 0.02 to 0.1 deg on 20 deg: at least 95 % of them are found, and where.
    #[test]
    fn cut_outputs_are_found_through_noise() {
        let (mut found, mut missed) = (0, Vec::new());
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for linkage in [Vec::new(), vec![lagging()]] {
            let model = actuator(0.3, linkage);
            let fine = |(name, ..): &(&str, f64, Vec<f64>)| !name.ends_with("coarse");
            for (name, step_s, volts) in &commands().into_iter().filter(fine).collect::<Vec<_>>() {
                let clean = model.simulate(volts, *step_s).unwrap().output_deg;
                let low = clean.iter().copied().fold(f64::INFINITY, f64::min);
                let high = clean.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                for noise in [0.0, 0.02, 0.05, 0.1] {
                    let normal = Normal::new(0.0, noise).unwrap();
                    for share in [0.08, 0.15, 0.25, 0.4] {
                        for end in [1.0, -1.0] {
                            let level = if end > 0.0 {
                                high - share * (high - low)
                            } else {
                                low + share * (high - low)
                            };
                            let mut cut =
                                |y: f64| end * (end * y).min(end * level) + normal.sample(&mut rng);
                            let top = judged(&model, *step_s, volts, &mut cut);
                            let right = |t: FlatTop| {
                                (t.level_deg - level).abs() < 0.02 + noise && t.share > 0.01
                            };
                            if top.is_some_and(right) {
                                found += 1;
                            } else {
                                missed.push((*name, noise, share, end, top));
                            }
                        }
                    }
                }
            }
        }
        let rate = f64::from(found) / (f64::from(found) + missed.len() as f64);
        assert!(rate >= 0.95, "{rate}: {missed:#?}");
    }

    /// What rests or flattens by itself is no cut: rounded and sharp tops, laws that flatten, gaps and
    /// friction in joints, sensors that round, at any frequency and noise.
    #[test]
    fn whole_outputs_raise_no_alarm() {
        let joint = |width_um: f64| {
            vec![
                vec![LinkageStage::Backlash(Backlash { width_um })],
                vec![LinkageStage::CoulombFriction(CoulombFriction { width_um })],
            ]
        };
        let mut models: Vec<ActuatorModel> =
            [0.0, 0.3, 1.0, 3.0, 6.0].map(|bend| actuator(bend, Vec::new())).to_vec();
        models.push(actuator(0.3, vec![lagging()]));
        models.push(actuator(3.0, vec![lagging()]));
        // 1 and 3 % of the stroke
        models.extend([5.0, 15.0].into_iter().flat_map(joint).map(|l| actuator(0.3, l)));
        // springs that slip: the output rests at a level until the input turns
        let range_volt = VoltageRange::amplified_stack();
        let stop = WeightedStop { threshold_volt: 20.0, stiffness_deg_per_volt: 0.5 };
        let stops = PrandtlStop::new(StopParameters {
            range_volt,
            stiffness_deg_per_volt: 0.0,
            stops: vec![stop],
            viscosity_deg_s_per_volt: 0.0,
            offset_deg: 0.0,
        });
        let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
        let law = ActuatorLaw::PrandtlStop(stops.unwrap());
        models.push(ActuatorModel::new(law, range_volt, calibration));
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        let mut alarms = Vec::new();
        for (m, model) in models.iter().enumerate() {
            for (name, step_s, volts) in &commands() {
                for noise in [0.0, 0.005, 0.02, 0.05, 0.1] {
                    let normal = Normal::new(0.0, noise).unwrap();
                    for quantum in [0.0, 0.02, 0.1] {
                        let mut read = |y: f64| {
                            let y = y + normal.sample(&mut rng);
                            if quantum > 0.0 { (y / quantum).round() * quantum } else { y }
                        };
                        if let Some(top) = judged(model, *step_s, volts, &mut read) {
                            alarms.push((m, *name, noise, quantum, top));
                        }
                    }
                }
            }
        }
        assert!(alarms.is_empty(), "{}: {alarms:#?}", alarms.len());
    }
}
