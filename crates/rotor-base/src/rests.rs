//! Stretches over which a signal rests.

use crate::variance;
use std::ops::Range;

/// A signal rests while it stays within this share of its range.
const BAND: f64 = 0.02;
/// Part of a period that a rest lasts at least.
const LEAST_PERIOD: f64 = 0.1;
/// Fewest samples of a rest.
const LEAST_SAMPLES: f64 = 8.0;
/// Spread, as a share of the band, that a parabola must not explain: a wave near its extreme is one.
const LEAST_SPREAD: f64 = 0.05;
/// Part of the spread of a rest that a parabola may explain.
const MOST_EXPLAINED: f64 = 0.5;

/// Smallest and largest value.
fn ends(signal: &[f64]) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    signal.iter().fold(none, |[low, high], &v| [low.min(v), high.max(v)])
}

/// The stretches over which a signal rests, as samples, in order; all of it where it never moves.
///
/// A rest stays within 2 % of the range for more than a tenth of the period that a triangle as fast as the signal on
/// average would have, and is neither a ramp nor the round top of a wave.
pub fn rests(signal: &[f64]) -> Vec<Range<usize>> {
    let [low, high] = ends(signal);
    let band = BAND * (high - low);
    if band <= 0.0 || signal.is_empty() {
        return std::iter::once(0..signal.len()).filter(|all| !all.is_empty()).collect();
    }
    // the way of a play half as wide as the band: noise makes none
    let half_gap = 0.25 * band;
    let mut followed = signal[0];
    let steps = signal.iter().map(|&v| {
        let last = followed;
        followed = followed.min(v + half_gap).max(v - half_gap);
        (followed - last).abs()
    });
    let way = steps.sum::<f64>().max(high - low);
    let period = 2.0 * (high - low) * signal.len() as f64 / way;
    let least = (LEAST_PERIOD * period).max(LEAST_SAMPLES);
    let stretches = stretches(signal, band).into_iter();
    stretches.filter(|s| s.len() as f64 > least && is_flat(&signal[s.clone()], band)).collect()
}

/// Whether the middle half of a stretch is no parabola, or next to none.
fn is_flat(stretch: &[f64], band: f64) -> bool {
    let quarter = stretch.len() / 4;
    let values = &stretch[quarter..stretch.len() - quarter];
    // Legendre polynomials over the places of the samples
    let place = |i: usize| 2.0 * i as f64 / (values.len() - 1) as f64 - 1.0;
    let about_mean = variance(values);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let part = |shape: &dyn Fn(f64) -> f64| {
        let (mut along, mut size) = (0.0, 0.0);
        for (i, v) in values.iter().enumerate() {
            let s = shape(place(i));
            along += s * (v - mean);
            size += s * s;
        }
        along * along / (size * values.len() as f64)
    };
    let explained = part(&|x| x) + part(&|x| 0.5 * (3.0 * x * x - 1.0));
    about_mean.sqrt() <= LEAST_SPREAD * band || explained <= MOST_EXPLAINED * about_mean
}

/// A signal cut where it leaves a band that begins at the first sample of the stretch; neighbours of nearly one
/// level are one.
fn stretches(signal: &[f64], band: f64) -> Vec<Range<usize>> {
    let mut found: Vec<(Range<usize>, f64)> = Vec::new();
    let mut start = 0;
    let mut within = [f64::INFINITY, f64::NEG_INFINITY];
    for end in 1..=signal.len() {
        let v = signal[end - 1];
        within = [within[0].min(v), within[1].max(v)];
        let next = signal.get(end).copied();
        if next.is_some_and(|v| v.max(within[1]) - v.min(within[0]) <= band) {
            continue;
        }
        let mean = signal[start..end].iter().sum::<f64>() / (end - start) as f64;
        match found.last_mut() {
            Some((stretch, level)) if (mean - *level).abs() < 0.5 * band => {
                let share = (end - start) as f64 / (end - stretch.start) as f64;
                *level += share * (mean - *level);
                stretch.end = end;
            }
            _ => found.push((start..end, mean)),
        }
        start = end;
        within = [f64::INFINITY, f64::NEG_INFINITY];
    }
    found.into_iter().map(|(stretch, _)| stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A signal of so many samples a second.
    fn sampled(rate: f64, seconds: f64, signal: impl Fn(f64) -> f64) -> Vec<f64> {
        let times = std::iter::successors(Some(0.0), |i| Some(i + 1.0)).map(|i| i / rate);
        times.take_while(|t| *t < seconds).map(signal).collect()
    }

    #[test]
    fn waves_have_no_rest() {
        for rate in [50.0, 1e3, 1e5] {
            let sine = sampled(rate, 3.3, |t| 65.0 + 40.0 * (TAU * t).sin());
            assert_eq!(rests(&sine), Vec::<Range<usize>>::new(), "{rate}");
            let triangle = sampled(rate, 3.3, |t| (t.rem_euclid(1.0) - 0.5).abs());
            assert_eq!(rests(&triangle), Vec::<Range<usize>>::new(), "{rate}");
        }
        let mix = sampled(1e3, 2.0, |t| (TAU * 2.0 * t).sin() + (TAU * 3.0 * t).cos());
        assert_eq!(rests(&mix), Vec::<Range<usize>>::new());
    }

    #[test]
    fn rests_are_found_with_their_ends_in_noise_too() {
        for noise in [0.0, 0.002] {
            let two = sampled(1e3, 6.0, |t| {
                let wave = match t {
                    t if t < 0.5 => 0.0,
                    t if t < 2.5 => (TAU * t * 1.0 + 0.5 * TAU).sin(),
                    t if t < 4.0 => 0.0,
                    t => (TAU * 5.0 * t).sin(),
                };
                wave + noise * (7919.0 * t * 1e3).sin()
            });
            let found = rests(&two);
            assert_eq!(found.len(), 2, "{found:?}");
            for (rest, (start, end)) in found.iter().zip([(0, 500), (2500, 4000)]) {
                assert!(rest.start.abs_diff(start) < 10 && rest.end.abs_diff(end) < 10, "{rest:?}");
            }
        }
    }

    #[test]
    fn a_constant_rests_and_held_steps_rest_at_each() {
        assert_eq!(rests(&[2.0; 50]).first(), Some(&(0..50)));
        assert_eq!(rests(&[]), Vec::<Range<usize>>::new());
        let steps = sampled(100.0, 5.0, |t| (2.0 * t.floor()).rem_euclid(5.0));
        assert_eq!(rests(&steps), [0..100, 100..200, 200..300, 300..400, 400..500]);
    }
}
