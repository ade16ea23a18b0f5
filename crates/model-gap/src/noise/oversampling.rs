//! Records sampled finer than they were measured: samples in between that tell nothing.

use nalgebra::{DMatrix, DVector};
use rotor_base::{mean_square, variance};

/// Samples on each side from which one in between is foretold.
const SIDE: usize = 3;
/// Samples on both.
const BOTH: usize = 2 * SIDE;
/// Samples in between that are foretold, to know the rule they follow.
const FORETOLD: usize = 600;
/// Error of samples in between, over that of measured ones from their neighbours: interpolated samples have only what
/// rounding leaves, samples of their own have all of their noise.
const OWN_SHARE: f64 = 0.1;
/// The same of values that are held, which foretell each other either way.
const HELD: f64 = 1e-6;
/// Error over the rms of a record that is rounding.
const ROUNDING: f64 = 1e-6;
/// Numbers of samples for each measured one that are tried, over and over again.
const PRIMES: [usize; 3] = [2, 3, 5];

/// The samples of a record that were measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Thinning {
    /// Number of the first.
    pub first: usize,
    /// Step from one to the next.
    pub every: usize,
}

impl Thinning {
    /// Finds samples that were not measured but interpolated; none where each was measured.
    ///
    /// Every `every`-th sample is taken as measured, the others are foretold from them by one linear rule of six neighbours,
    /// fitted to the record: a straight line, a cubic, a value held. The error of what is foretold is below a tenth of that
    /// of the measured samples, foretold from their neighbours, and below a tenth of the error the other way round. A smooth
    /// record fails the second: there both are alike. A record resampled by a longer filter is not found.
    pub fn of(signal: &[f64]) -> Option<Self> {
        let mut found: Option<Self> = None;
        let mut left = signal.to_vec();
        while let Some(more) = PRIMES.iter().find_map(|every| ruled(&left, *every)) {
            found = Some(found.map_or(more, |before| more.behind(before)));
            left = more.of_signal(&left);
        }
        found
    }

    /// This thinning of what another leaves.
    fn behind(self, before: Self) -> Self {
        Self { first: before.first + self.first * before.every, every: before.every * self.every }
    }

    /// The measured samples of a signal.
    pub fn of_signal(self, signal: &[f64]) -> Vec<f64> {
        signal.iter().skip(self.first).step_by(self.every).copied().collect()
    }
}

/// A record with this many samples for each measured one, whose rule holds for all in between.
fn ruled(signal: &[f64], every: usize) -> Option<Thinning> {
    let told = ROUNDING * mean_square(signal).sqrt()..1.01 * variance(signal).sqrt();
    let of = |first: usize| {
        let thin = Thinning { first, every };
        let measured = thin.of_signal(signal);
        let neighbours = |shift: usize| Thinning { first: first + shift, every }.of_signal(signal);
        let next = measured.get(1..)?;
        // rounding alone tells nothing
        let own = error(&measured, next, 1).filter(|own| told.contains(own))?;
        let most = OWN_SHARE * own.min(error(&neighbours(1), next, 0)?);
        let is_foretold = |shift| {
            error(&measured, &neighbours(shift), 0).is_some_and(|e| e < most.max(HELD * own))
        };
        (1..every).all(is_foretold).then_some(thin)
    };
    (0..every).find_map(of)
}

/// RMS error of samples foretold from their neighbours: `signal[i]` lies between `from[i]` and `from[i + 1 + gap]`, and
/// nothing of `from` between these is used.
fn error(from: &[f64], signal: &[f64], gap: usize) -> Option<f64> {
    let last = signal.len().min(from.len().saturating_sub(gap + SIDE));
    let places = SIDE - 1..last;
    let step = places.len().div_ceil(FORETOLD).max(1);
    let places: Vec<usize> = places.step_by(step).collect();
    if places.len() < 4 * BOTH {
        return None;
    }
    let rows = DMatrix::from_fn(places.len(), BOTH + 1, |row, at| match at {
        0..SIDE => from[places[row] + at + 1 - SIDE],
        SIDE..BOTH => from[places[row] + at + 1 - SIDE + gap],
        _ => 1.0,
    });
    let wanted = DVector::from_iterator(places.len(), places.iter().map(|i| signal[*i]));
    let rule = rows.clone().svd(true, true).solve(&wanted, 1e-12).ok()?;
    Some(((rows * rule - &wanted).norm_squared() / places.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SplitMix;
    use std::f64::consts::TAU;

    /// A wave of a period of 27 samples with noise of 1 %.
    fn record(noise: f64) -> Vec<f64> {
        let mut draw = SplitMix(5);
        let wave = |i: f64| (TAU * i / 27.0).sin() + 0.3 * (TAU * i / 61.0).cos();
        (0..1500).map(|i| wave(f64::from(i)) + noise * draw.normal()).collect()
    }

    /// Four points of a cubic through neighbours (Lagrange), `at` between the middle ones.
    fn cubic(p: &[f64], at: f64) -> f64 {
        let nodes = [-1.0, 0.0, 1.0, 2.0];
        let weight = |j: usize| {
            let others = nodes.iter().enumerate().filter(|(m, _)| *m != j);
            others.map(|(_, x)| (at - x) / (nodes[j] - x)).product::<f64>()
        };
        (0..4).map(|j| weight(j) * p[j]).sum()
    }

    /// A sample between the middle ones of four.
    type Rule = fn(&[f64], f64) -> f64;

    fn refined(signal: &[f64], every: usize, rule: Rule) -> Vec<f64> {
        let between = |p: &[f64]| -> Vec<f64> {
            (0..every).map(|k| rule(p, k as f64 / every as f64)).collect()
        };
        let fine: Vec<f64> = signal.windows(4).flat_map(between).collect();
        // as a file holds it
        fine.iter().map(|y| (y * 1e5).round() / 1e5).collect()
    }

    #[test]
    fn interpolated_records_give_back_what_was_measured() {
        let own = record(0.01);
        let rules: [(Rule, &[usize]); 3] = [
            (|p, at| p[1] + at * (p[2] - p[1]), &[2, 3, 4, 5, 6, 10]),
            (cubic, &[2, 3, 5]),
            (|p, _| p[1], &[2, 3, 4, 5]),
        ];
        for (number, (rule, factors)) in rules.into_iter().enumerate() {
            for &every in factors {
                let fine = refined(&own, every, rule);
                let found = Thinning::of(&fine).unwrap_or_else(|| panic!("rule {number}, {every}"));
                assert_eq!(found.every, every, "rule {number}");
                let left = found.of_signal(&fine);
                let worst = left.iter().zip(&own[1..]).map(|(a, b)| (a - b).abs());
                assert!(number == 2 || worst.fold(0.0, f64::max) <= 6e-6, "rule {number}, {every}");
            }
        }
    }

    /// Whatever the noise: a smooth record foretells its own samples too, but either half as well as the other.
    #[test]
    fn records_of_samples_of_their_own_stay() {
        for noise in [0.0, 1e-8, 1e-4, 0.01, 1.0] {
            assert_eq!(Thinning::of(&record(noise)), None, "{noise}");
        }
        for own in [&[1.0; 500][..], &[1.0, 2.0], &[]] {
            assert_eq!(Thinning::of(own), None);
        }
    }
}
