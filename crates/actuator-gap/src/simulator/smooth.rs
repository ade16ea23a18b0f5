//! Linear stages and delays for inputs that are smooth between their samples.
//!
//! A stage that takes its input for straight between samples sees chords instead of arcs: at ten samples a
//! cycle a delay by half a sample loses 5 % of the amplitude, as a filter would, and a mode is driven by images
//! of the input at the sampling frequency. Here the input is the quintic through six neighbouring samples
//! where they lie on a smooth curve, and the chord where they do not (corners, steps).

use crate::numbers::range;
use nalgebra::Complex;
use std::borrow::Cow;

/// Samples that a quintic goes through, from the second before an interval to the second after it.
const POINTS: usize = 6;
/// Parts of an interval at whose ends a turn is looked for: what they miss of it is at most a 64th of what the samples may
/// miss.
const INSIDE: u32 = 8;
/// Largest exponent of a step up to which its moments are summed by quadrature.
const LARGEST_SUMMED: f64 = 6.0;
/// Nodes and weights of the Gauss-Legendre rule of ten points on -1..1, the positive half.
///
/// Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions* (1964), table 25.4.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// A record with how smooth it is in every interval.
pub(super) struct Smooth<'a> {
    samples: &'a [f64],
    /// Weight of the quintic over the chord, interval by interval.
    weights: Cow<'a, [f64]>,
}

/// Weight of the quintic over the chord in every interval of a record.
pub(super) type Weights = Vec<f64>;

impl<'a> Smooth<'a> {
    /// A record with its weights, known or found: looks at fourth over second differences: those of a sine of seven samples a cycle and more lie below
    /// 1, those of a corner at 2 and above.
    pub(super) fn new(samples: &'a [f64], known: Option<&'a Weights>) -> Self {
        let weights = known.map_or_else(|| Self::weights(samples).into(), Cow::from);
        Self { samples, weights }
    }

    /// The weights of a record.
    pub(super) fn weights(samples: &[f64]) -> Weights {
        let (low, high) = range(samples);
        let least = 1e-9 * (high - low);
        let count = samples.len();
        if count < 2 {
            return Vec::new();
        }
        // the second difference at every sample, held beyond either end
        let mut second = vec![0.0; count + 2];
        for (own, u) in second[2..].iter_mut().zip(samples.windows(3)) {
            *own = u[0] - 2.0 * u[1] + u[2];
        }
        second[..2].fill(samples[1] - samples[0]);
        second[count..].fill(samples[count - 2] - samples[count - 1]);
        second.windows(4).map(|s| weight([s[0], s[1], s[2], s[3]], least)).collect()
    }

    /// The six samples about an interval; the first and the last are held beyond the ends.
    fn about(&self, interval: usize) -> [f64; POINTS] {
        let last = self.samples.len() - 1;
        std::array::from_fn(|j| self.samples[(interval + j).saturating_sub(2).min(last)])
    }

    /// The record late by so many samples; before its first sample it is at rest.
    pub(super) fn late_by(&self, samples: f64) -> Vec<f64> {
        // one place in every interval
        let whole = samples.ceil();
        let place = Place::at(whole - samples);
        let first = self.samples.first().copied().unwrap_or_default();
        (0..self.samples.len())
            .map(|i| {
                let Some(k) = back(i, whole) else { return first };
                if k < self.weights.len() { self.between(k, &place) } else { self.samples[k] }
            })
            .collect()
    }

    /// The record at a step finer by a whole factor; every so many samples are its own.
    pub(super) fn refined(&self, factor: u32) -> Vec<f64> {
        let places: Vec<Place> =
            (0..factor).map(|part| Place::at(f64::from(part) / f64::from(factor))).collect();
        let intervals = 0..self.weights.len();
        let inside = |k: usize| places.iter().map(move |place| self.between(k, place));
        intervals.flat_map(inside).chain(self.samples.last().copied()).collect()
    }

    /// The record at a place inside an interval.
    fn between(&self, interval: usize, place: &Place) -> f64 {
        place.of(self.about(interval), self.weights[interval])
    }

    /// Behind a first-order lag, at rest at first: `tau y' = u - y`; one of no time constant changes nothing.
    pub(super) fn lagged(&self, tau_s: f64, step_s: f64) -> Vec<f64> {
        if tau_s <= 0.0 {
            return self.samples.to_vec();
        }
        let exponent = Complex::new(-step_s / tau_s, 0.0);
        let start = self.samples.first().copied().unwrap_or_default();
        self.follow(exponent, -exponent, Complex::new(start, 0.0)).map(|z| z.re).collect()
    }

    /// Behind a mode, at rest at first: `y'' + 2 zeta w y' + w^2 y = w^2 u`, `zeta` below 1.
    ///
    /// ```text
    /// y = Im(w^2 / w_d z),   z' = lambda z + u,   lambda = -zeta w + i w_d,   w_d = w sqrt(1 - zeta^2)
    /// ```
    pub(super) fn through_mode(&self, frequency_hz: f64, zeta: f64, step_s: f64) -> Vec<f64> {
        let omega = std::f64::consts::TAU * frequency_hz;
        let damped = omega * (1.0 - zeta * zeta).max(1e-12).sqrt();
        let exponent = Complex::new(-zeta * omega, damped) * step_s;
        let gain = Complex::new(omega * omega / damped * step_s, 0.0);
        let start = self.samples.first().copied().unwrap_or_default();
        self.follow(exponent, gain, -gain / exponent * start).map(|z| z.im).collect()
    }

    /// `z' = exponent z + gain u` per step from a start: exact for the quintics and the chords.
    fn follow(
        &self,
        exponent: Complex<f64>,
        gain: Complex<f64>,
        start: Complex<f64>,
    ) -> impl Iterator<Item = Complex<f64>> {
        let moments = moments(exponent);
        let of = |polynomial: &[f64]| -> Complex<f64> {
            polynomial.iter().zip(moments).map(|(c, m)| m * *c).sum::<Complex<f64>>() * gain
        };
        let chord = [of(&[1.0, -1.0]), of(&[0.0, 1.0])];
        let mut quintic = polynomials().map(|polynomial| of(&polynomial));
        quintic[2] -= chord[0];
        quintic[3] -= chord[1];
        let decay = exponent.exp();
        let mut z = start;
        (0..self.samples.len()).map(move |i| {
            if let Some(k) = i.checked_sub(1) {
                let mut driven = chord[0] * self.samples[k] + chord[1] * self.samples[i];
                let weight = self.weights[k];
                if weight > 0.0 {
                    let bent: Complex<f64> =
                        quintic.iter().zip(self.about(k)).map(|(b, u)| b * u).sum();
                    driven += bent * weight;
                }
                z = decay * z + driven;
            }
            z
        })
    }
}

/// Weight of the quintic on an interval with these second differences about it; below the least there is no bend.
#[inline]
fn weight(second: [f64; 4], least: f64) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let [a, b, c, d] = second.map(f64::abs);
    let bend = larger(larger(a, b), larger(c, d));
    let fourth = |i: usize| (second[i - 1] - 2.0 * second[i] + second[i + 1]).abs();
    if bend > least { (2.0 - larger(fourth(1), fourth(2)) / bend).clamp(0.0, 1.0) } else { 0.0 }
}

/// A record as a joint feels it: its samples with their numbers, and between two of them without a number how far a
/// smooth record goes where it turns there.
///
/// At ten samples a cycle the samples alone miss up to 5 % of the amplitude.
pub(super) fn turning(samples: &[f64]) -> impl Iterator<Item = (Option<usize>, f64)> {
    let places: Vec<Place> =
        (1..INSIDE).map(|part| Place::at(f64::from(part) / f64::from(INSIDE))).collect();
    let (low, high) = range(samples);
    let least = 1e-9 * (high - low);
    samples.iter().enumerate().flat_map(move |(i, &sample)| {
        let turn = i.checked_sub(1).and_then(|before| turn(samples, before, least, &places));
        turn.map(|far| (None, far)).into_iter().chain(std::iter::once((Some(i), sample)))
    })
}

/// How far a record goes beyond both samples of an interval, where it is smooth and turns inside.
fn turn(samples: &[f64], interval: usize, least: f64, places: &[Place]) -> Option<f64> {
    let about: [f64; POINTS] = samples.get(interval.checked_sub(2)?..)?.first_chunk().copied()?;
    let (into, out) = (about[2] - about[1], about[4] - about[3]);
    if into * out >= 0.0 {
        return None;
    }
    let second = std::array::from_fn(|k| about[k] - 2.0 * about[k + 1] + about[k + 2]);
    let weight = weight(second, least);
    let sign = into.signum();
    let inside = places.iter().map(|place| sign * place.of(about, weight));
    let farthest = inside.fold(f64::NEG_INFINITY, f64::max);
    (farthest > (sign * about[2]).max(sign * about[3])).then_some(sign * farthest)
}

/// A place inside every interval.
struct Place {
    /// Part of the interval before it.
    part: f64,
    /// Weights of the six samples there.
    quintic: [f64; POINTS],
}

impl Place {
    fn at(part: f64) -> Self {
        let value = |p: [f64; POINTS]| p.iter().rev().fold(0.0, |sum, c| sum * part + c);
        Self { part, quintic: polynomials().map(value) }
    }

    /// The record there, of the six samples about the interval and the weight of the quintic.
    fn of(&self, about: [f64; POINTS], weight: f64) -> f64 {
        let chord = about[2] + self.part * (about[3] - about[2]);
        let smooth: f64 = self.quintic.iter().zip(about).map(|(c, u)| c * u).sum();
        chord + weight * (smooth - chord)
    }
}

/// The sample a whole number before; none before the first.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole and not negative"
)]
fn back(sample: usize, by: f64) -> Option<usize> {
    if by > sample as f64 { None } else { Some(sample - by.max(0.0) as usize) }
}

/// Coefficients, lowest first, of the Lagrange polynomials through the samples at -2..3.
fn polynomials() -> [[f64; POINTS]; POINTS] {
    let place = |j: usize| j as f64 - 2.0;
    std::array::from_fn(|j| {
        let mut product = [0.0; POINTS];
        product[0] = 1.0;
        for m in (0..POINTS).filter(|m| *m != j) {
            let scale = 1.0 / (place(j) - place(m));
            for p in (0..POINTS).rev() {
                let below = if p > 0 { product[p - 1] } else { 0.0 };
                product[p] = scale * (below - place(m) * product[p]);
            }
        }
        product
    })
}

/// `M_p = int_0^1 exp(a (1 - s)) s^p ds` for p from 0 to 5: by `M_p = (p M_(p-1) - 1) / a` where `a` is large, by
/// quadrature where that would lose digits.
fn moments(a: Complex<f64>) -> [Complex<f64>; POINTS] {
    let mut moments = [Complex::new(0.0, 0.0); POINTS];
    if a.norm() > LARGEST_SUMMED {
        let mut before = (a.exp() - 1.0) / a;
        for (p, moment) in moments.iter_mut().enumerate() {
            if p > 0 {
                before = (before * p as f64 - 1.0) / a;
            }
            *moment = before;
        }
        return moments;
    }
    for (node, weight) in GAUSS {
        for s in [0.5 * (1.0 + node), 0.5 * (1.0 - node)] {
            let mut value = (a * (1.0 - s)).exp() * (0.5 * weight);
            for moment in &mut moments {
                *moment += value;
                value *= s;
            }
        }
    }
    moments
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Ten samples a cycle, as 20 Hz read at 200 Hz.
    const STEP_S: f64 = 5e-3;
    const HZ: f64 = 20.0;

    fn wave(t: f64) -> f64 {
        (TAU * HZ * t).sin()
    }

    fn samples() -> Vec<f64> {
        (0..400).map(|i| wave(STEP_S * f64::from(i))).collect()
    }

    /// Largest error once the start is forgotten.
    fn error(found: &[f64], exact: impl Fn(f64) -> f64) -> f64 {
        let late = found.iter().enumerate().skip(200).take(190);
        late.map(|(i, y)| (y - exact(STEP_S * i as f64)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_sine_of_ten_samples_a_cycle_comes_late_without_losing_amplitude() {
        let samples = samples();
        let smooth = Smooth::new(&samples, None);
        for delay in [0.4, 0.5, 1.0, 2.3] {
            let left = error(&smooth.late_by(delay), |t| wave(t - delay * STEP_S));
            assert!(left < 5e-4, "{left} for {delay}");
        }
        // chords lose a twentieth
        let chords = Smooth { samples: &samples, weights: vec![0.0; samples.len() - 1].into() };
        assert!(error(&chords.late_by(0.5), |t| wave(t - 0.5 * STEP_S)) > 0.04);
    }

    #[test]
    fn a_finer_record_keeps_its_samples_and_follows_the_sine_between() {
        let samples = samples();
        let fine = Smooth::new(&samples, None).refined(4);
        assert_eq!(fine.len(), 4 * (samples.len() - 1) + 1);
        for (i, y) in fine.iter().enumerate().skip(40).take(1500) {
            assert!((y - wave(0.25 * STEP_S * i as f64)).abs() < 5e-4, "{i}");
            assert!(i % 4 != 0 || (y - samples[i / 4]).abs() < 1e-12);
        }
    }

    /// Samples of a sine that miss its turns by up to 5 %: the largest value is that of the sine, and no sample is lost.
    #[test]
    fn a_sine_of_ten_samples_a_cycle_turns_where_it_turns() {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        for phase in [0.0, 0.1, 0.2] {
            let late = phase / (TAU * HZ);
            let samples: Vec<f64> = (0..100).map(|i| wave(STEP_S * f64::from(i) + late)).collect();
            let (own, turns): (Vec<_>, Vec<_>) = turning(&samples).partition(|own| own.0.is_some());
            let of =
                |some: &[(Option<usize>, f64)]| some.iter().map(|own| own.1).collect::<Vec<_>>();
            assert_eq!(of(&own), samples);
            // two turns a cycle, but for those at either end
            assert!((18..=20).contains(&turns.len()), "{}", turns.len());
            let missed = 1.0 - largest(&of(&turns));
            assert!(missed.abs() < 3e-3, "{missed} at {phase}");
            let by_samples = 1.0 - largest(&samples);
            assert!(missed.abs() < 0.2 * by_samples, "{missed} {by_samples}");
        }
    }

    #[test]
    fn what_does_not_turn_smoothly_turns_at_its_samples() {
        let triangle: Vec<f64> =
            (0..60).map(|i| f64::from(if i % 20 < 10 { i % 20 } else { 20 - i % 20 })).collect();
        let step: Vec<f64> = (0..60).map(|i| f64::from(i / 30)).collect();
        for samples in [triangle, step, vec![1.0; 9], vec![1.0], Vec::new()] {
            assert!(turning(&samples).all(|(number, _)| number.is_some()), "{samples:?}");
        }
    }

    #[test]
    fn a_lag_and_a_mode_answer_a_sine_as_theory_says() {
        let samples = samples();
        let smooth = Smooth::new(&samples, None);
        let omega = TAU * HZ;
        for tau in [1e-5, 2e-4, 1e-3, 0.02] {
            let answer = Complex::new(1.0, omega * tau).inv();
            let exact = |t: f64| (answer * Complex::from_polar(1.0, omega * t)).im;
            let left = error(&smooth.lagged(tau, STEP_S), exact);
            assert!(left < 3e-4, "{left} for {tau} s");
        }
        // a mode beyond half the sampling frequency, close to an image of the sine
        for (hz, zeta, most) in [(206.0, 0.02, 2e-3), (60.0, 0.05, 5e-4)] {
            let w = TAU * hz;
            let answer = Complex::new(1.0 - (omega / w).powi(2), 2.0 * zeta * omega / w).inv();
            let exact = |t: f64| (answer * Complex::from_polar(1.0, omega * t)).im;
            let left = error(&smooth.through_mode(hz, zeta, STEP_S), exact);
            assert!(left < most, "{left} for {hz} Hz");
        }
        let chords = Smooth { samples: &samples, weights: vec![0.0; samples.len() - 1].into() };
        let mode = chords.through_mode(206.0, 0.02, STEP_S);
        assert!(error(&mode, wave) > 0.03, "chords drive the mode by their images");
    }

    #[test]
    fn a_corner_and_a_step_do_not_overshoot() {
        let mut samples = vec![0.0; 40];
        samples.extend((0..40).map(f64::from));
        samples.extend(vec![100.0; 40]);
        let late = Smooth::new(&samples, None).late_by(0.5);
        let overshoot = late.iter().fold(0.0_f64, |most, v| most.max(v - 100.0).max(-v));
        assert!(overshoot < 1.0, "{overshoot}");
        let lagged = Smooth::new(&samples, None).lagged(1e-4, 1e-3);
        assert!(lagged.iter().all(|v| (-0.5..100.5).contains(v)));
    }

    #[test]
    fn moments_agree_where_both_ways_hold() {
        for a in [Complex::new(-6.1, 0.0), Complex::new(-0.3, 6.2), Complex::new(-3.0, 5.5)] {
            let above = moments(a);
            let below = moments(a * (5.9 / a.norm()));
            // both close to a fine sum of their own
            for (a, found) in [(a, above), (a * (5.9 / a.norm()), below)] {
                for (p, moment) in found.iter().enumerate() {
                    let n = 20_000;
                    let sum: Complex<f64> = (0..n)
                        .map(|i| {
                            let s = (f64::from(i) + 0.5) / f64::from(n);
                            (a * (1.0 - s)).exp() * s.powi(i32::try_from(p).unwrap()) / f64::from(n)
                        })
                        .sum();
                    assert!((sum - moment).norm() < 1e-7, "{a} {p}");
                }
            }
        }
    }

    #[test]
    fn records_of_few_samples_pass() {
        for n in 1..5 {
            let samples = vec![1.0; n];
            let smooth = Smooth::new(&samples, None);
            assert_eq!(smooth.late_by(1.5).len(), n);
            assert_eq!(smooth.lagged(0.1, 0.1).len(), n);
        }
    }
}
