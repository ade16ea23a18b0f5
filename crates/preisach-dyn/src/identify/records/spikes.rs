//! Single samples that a recorder lost or a contact spoilt.
//!
//! ```text
//! a, b: straight on from the two samples before a stretch of one to three, and back from the two behind
//! spike:  every sample of it lies on the same side of both a and b, by more than
//!         12 sigma, 6 steps of the sensor, 8 usual bends from sample to sample nearby,
//!         1 % of the range, and 3 times what bends of the other channel nearby explain
//! ```
//! A longer stretch of one and the same value is a loss where it jumps off and back on the same side by as much.
//! `sigma` is the robust noise of the record, a bend the second difference. A step, a ramp, a tip and the
//! corner of a cut lie on `a` or on `b`; a pulse of the command bends the command.
//! Source: the identifier of F. R. Hampel, Journal of the American Statistical Association 69 (1974), with
//! a guard for each feature of a loop.

use crate::identify::records::noise::{Fine, median};
use crate::identify::{BenchRecord, Channel, Finding};

/// Samples of a spike at most.
const LONGEST: usize = 3;
/// Samples of one value that a recorder wrote in the place of lost ones, at most.
const LONGEST_HELD: usize = 12;
/// Samples on either side that it is compared with.
const BESIDE: usize = 2;
/// Size over the noise of the record: straight lines over two samples carry some of it.
const SIGMAS: f64 = 12.0;
/// Size over the step of a rounding sensor.
const QUANTA: f64 = 6.0;
/// Size over the usual bend from sample to sample around it.
const BENDS: f64 = 8.0;
/// Samples around it that show the usual bend.
const AROUND: usize = 12;
/// Least size, as a share of the record's range.
const LEAST: f64 = 0.01;
/// Size over what the bends of the other channel explain by the gain of the whole record.
const UNEXPLAINED: f64 = 3.0;
/// Share of spoilt samples beyond which they are a feature.
const MOST: f64 = 0.02;

/// A stretch of spoilt samples.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spike {
    first: usize,
    count: usize,
    /// Distance from its surroundings.
    size: f64,
}

impl BenchRecord {
    /// The record with its spikes replaced by straight lines, and what they were ([`Finding::Spikes`] of each channel); none if it
    /// has none.
    pub fn without_spikes(&self) -> Option<(Self, Vec<Finding>)> {
        mended(self)
    }
}

/// A record with its spikes replaced by straight lines, and what was found; none if it has none.
pub(crate) fn mended(record: &BenchRecord) -> Option<(BenchRecord, Vec<Finding>)> {
    let (u, y) = (&record.voltage_volt, &record.output_deg);
    let (in_output, in_command) = (spikes(y, u), spikes(u, y));
    if in_output.is_empty() && in_command.is_empty() {
        return None;
    }
    let worst = |(channel, values, spikes): (Channel, &[f64], &[Spike])| {
        let largest = spikes.iter().copied().reduce(|a, b| if b.size > a.size { b } else { a })?;
        let (id, index) = (record.id.clone(), largest.first);
        let time_s = index as f64 * record.time_step_s;
        let samples = spikes.iter().map(|s| s.count).sum();
        Some(Finding::Spikes { id, channel, samples, index, time_s, value: values[index] })
    };
    let channels = [(Channel::Output, &y[..], &in_output[..]), (Channel::Command, u, &in_command)];
    let findings = channels.into_iter().filter_map(worst).collect();
    let mut mended = record.clone();
    replace(&mut mended.output_deg, &in_output);
    replace(&mut mended.voltage_volt, &in_command);
    Some((mended, findings))
}

/// Straight lines over the spikes.
fn replace(values: &mut [f64], spikes: &[Spike]) {
    for spike in spikes {
        let (before, behind) = (values[spike.first - 1], values[spike.first + spike.count]);
        let step = (behind - before) / (spike.count + 1) as f64;
        let mut value = before;
        for sample in &mut values[spike.first..spike.first + spike.count] {
            value += step;
            *sample = value;
        }
    }
}

/// Second differences, without sign.
fn bends(values: &[f64]) -> impl Iterator<Item = f64> {
    values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs())
}

/// The range that all but one sample in a hundred at either end stay in.
fn usual_range(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let cut = values.len() / 100;
    sorted[values.len() - 1 - cut] - sorted[cut]
}

/// Spikes of one channel that the other does not explain, in their order.
fn spikes(values: &[f64], other: &[f64]) -> Vec<Spike> {
    let fine = Fine::of(values);
    let (range, other_range) = (usual_range(values), usual_range(other));
    if range <= 0.0 {
        return Vec::new();
    }
    let least = (SIGMAS * fine.std_deg).max(QUANTA * fine.quantum_deg).max(LEAST * range);
    let gain = if other_range > 0.0 { range / other_range } else { 0.0 };
    let mut found: Vec<Spike> = Vec::new();
    let mut first = BESIDE;
    while first + BESIDE < values.len() {
        // a spike bends away from the samples before it at once
        let bend = values[first - 2] - 2.0 * values[first - 1] + values[first];
        let spike = (bend.abs() > least)
            .then(|| {
                let is_held = |v: &&f64| v.total_cmp(&values[first]).is_eq();
                let held = values[first..].iter().take_while(is_held).count();
                let held = (held > LONGEST && held <= LONGEST_HELD).then_some(held);
                held.into_iter().chain((1..=LONGEST).rev()).find_map(|count| {
                    let size = match count {
                        ..=LONGEST => size(values, first, count),
                        _ => size_of_held(values, first, count),
                    };
                    let size = size.filter(|size| *size > least)?;
                    let near =
                        first.saturating_sub(AROUND)..(first + count + AROUND).min(other.len());
                    let other = bends(&other[near]).fold(0.0, f64::max);
                    (size > UNEXPLAINED * gain * other).then_some(Spike { first, count, size })
                })
            })
            .flatten();
        first += spike.map_or(1, |s| s.count + 1);
        found.extend(spike);
    }
    let samples: usize = found.iter().map(|s| s.count).sum();
    if samples as f64 > (MOST * values.len() as f64).max(2.0 * LONGEST as f64) {
        return Vec::new();
    }
    found
}

/// How far a stretch stands out from both sides; none if it does not, or no more than its surroundings
/// change anyway.
fn size(values: &[f64], first: usize, count: usize) -> Option<f64> {
    let end = first + count;
    if end + BESIDE > values.len() {
        return None;
    }
    let (before, behind) = (&values[first - BESIDE..first], &values[end..end + BESIDE]);
    let (mut above, mut below) = (f64::INFINITY, f64::INFINITY);
    for (j, value) in values[first..end].iter().enumerate() {
        let (from, left) = ((j + 1) as f64, (count - j) as f64);
        let on = before[1] + from * (before[1] - before[0]);
        let back = behind[0] + left * (behind[0] - behind[1]);
        above = above.min(value - on).min(value - back);
        below = below.min(on - value).min(back - value);
    }
    let size = above.max(below);
    let around = first.saturating_sub(AROUND)..(end + AROUND).min(values.len());
    (size > BENDS * median(bends(&values[around]).collect())).then_some(size)
}

/// How far a stretch of one value stands out: the lesser of the jumps into it and out of it; none if they are on either side.
fn size_of_held(values: &[f64], first: usize, count: usize) -> Option<f64> {
    let end = first + count;
    let behind = *values.get(end + BESIDE - 1).and(values.get(end))?;
    let (held, before) = (values[first], values[first - 1]);
    let size = (held - before).min(held - behind).max((before - held).min(behind - held));
    let around = first.saturating_sub(AROUND)..(end + AROUND).min(values.len());
    (size > BENDS * median(bends(&values[around]).collect())).then_some(size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ActuatorModel, AmplifierStage, Lag, LinkageStage, Resonance, VoltageRange};
    use chacha20::ChaCha8Rng;
    use rand::{Rng, RngExt, SeedableRng};
    use rand_distr::{Distribution, Normal};
    use std::f64::consts::TAU;

    fn simulated(volts: Vec<f64>, time_step_s: f64, noise: f64, rng: &mut impl Rng) -> BenchRecord {
        let mut model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
        model.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 1e-3 }));
        let mode = Resonance { frequency_hz: 120.0, damping_ratio: 0.02 };
        model.linkage.push(LinkageStage::Resonance(mode));
        let normal = Normal::new(0.0, noise).unwrap();
        let output = model.simulate(&volts, time_step_s).unwrap().output_deg;
        BenchRecord {
            id: "r".into(),
            time_step_s,
            voltage_volt: volts,
            output_deg: output.into_iter().map(|y| y + normal.sample(rng)).collect(),
            ..BenchRecord::default()
        }
    }

    /// Commands of every kind, sharp ones among them.
    fn commands() -> Vec<(f64, Vec<f64>)> {
        let at = |step_s: f64, u: &dyn Fn(f64) -> f64| -> (f64, Vec<f64>) {
            (step_s, (0..3000).map(|i| 65.0 + u(f64::from(i) * step_s)).collect())
        };
        let triangle = |t: f64| 80.0 * (1.0 - 4.0 * ((t + 0.25).rem_euclid(1.0) - 0.5).abs());
        vec![
            at(1e-3, &|t| 80.0 * (TAU * t).sin()),
            at(5e-4, &|t| 80.0 * (TAU * 20.0 * t).sin()),
            at(2e-3, &|t| 80.0 * (TAU * 20.0 * t).sin()),
            at(1e-3, &triangle),
            // steps, one of them a short pulse, and a rest
            at(1e-3, &|t| if t.rem_euclid(0.7) < 0.3 { 60.0 } else { -60.0 }),
            at(1e-3, &|t| if (1.0..1.002).contains(&t) { 70.0 } else { 0.0 }),
            at(1e-3, &|t| if t < 1.0 { 0.0 } else { 80.0 * (TAU * 3.0 * t).sin() }),
        ]
    }

    #[test]
    fn sharp_features_are_no_spikes() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        for (c, (step_s, volts)) in commands().into_iter().enumerate() {
            for noise in [0.0, 0.001, 0.02, 0.1] {
                for quantum in [0.0, 0.05] {
                    let mut record = simulated(volts.clone(), step_s, noise, &mut rng);
                    if quantum > 0.0 {
                        for y in &mut record.output_deg {
                            *y = (*y / quantum).round() * quantum;
                        }
                    }
                    let found = mended(&record);
                    assert!(found.is_none(), "{c} {noise} {quantum}: {:?}", found.map(|f| f.1));
                }
            }
        }
    }

    /// Spikes of 20 sigma and more, lost samples and short losses, in slow and fast sines and triangles:
    /// found with their place, and replaced to within the noise.
    #[test]
    fn spoilt_samples_are_found_and_mended() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let (mut right, mut all) = (0_u32, 0_u32);
        for (c, (step_s, volts)) in commands().into_iter().enumerate().take(4) {
            if c == 2 {
                // 25 samples a cycle: a spike is as sharp as the wave
                continue;
            }
            for noise in [0.005, 0.02, 0.1] {
                for _ in 0..40 {
                    let whole = simulated(volts.clone(), step_s, noise, &mut rng);
                    let mut spoilt = whole.clone();
                    let (index, count) = (rng.random_range(20..2900), rng.random_range(1..=3));
                    let jump = if rng.random_bool(0.5) { 50.0 } else { -50.0 } * noise.max(0.05);
                    for y in &mut spoilt.output_deg[index..index + count] {
                        *y += jump;
                    }
                    all += 1;
                    let Some((mended, findings)) = mended(&spoilt) else { continue };
                    let error = mended
                        .output_deg
                        .iter()
                        .zip(&whole.output_deg)
                        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                    right += u32::from(
                        matches!(&findings[..], [Finding::Spikes { channel: Channel::Output, samples, index: i, .. }]
                            if *samples == count && *i == index)
                            && error < 6.0 * noise + 0.3,
                    );
                }
            }
        }
        assert!(f64::from(right) >= 0.97 * f64::from(all), "{right} of {all}");
        // zeros in the place of lost samples
        let whole = simulated(commands().swap_remove(0).1, 1e-3, 0.02, &mut rng);
        let mut spoilt = whole.clone();
        for y in &mut spoilt.output_deg {
            *y += 50.0;
        }
        spoilt.output_deg[900..906].fill(0.0);
        let (_, findings) = mended(&spoilt).unwrap();
        assert!(matches!(&findings[..], [Finding::Spikes { samples: 6, index: 900, .. }]));
        // clipped it is no loss: the output goes there and back
        let mut clipped = whole;
        for y in &mut clipped.output_deg {
            *y = y.min(2.0);
        }
        assert!(mended(&clipped).is_none());
        // a lost sample of the command
        let (step_s, volts) = commands().swap_remove(0);
        let mut record = simulated(volts.clone(), step_s, 0.02, &mut rng);
        record.voltage_volt[700] = 0.0;
        let (mended, findings) = mended(&record).unwrap();
        assert!(matches!(
            &findings[..],
            [Finding::Spikes { channel: Channel::Command, samples: 1, index: 700, .. }]
        ));
        assert!((mended.voltage_volt[700] - volts[700]).abs() < 0.1);
        assert_eq!(mended.output_deg, record.output_deg);
    }
}
