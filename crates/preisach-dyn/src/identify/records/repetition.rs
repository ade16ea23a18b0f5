//! The period of a command, and the part of a record over which it repeats.

use crate::VoltageRange;
use crate::check::extremes;
use crate::laws::play_map::split;
use rotor_base::mean_square;
use std::ops::Range;

/// Mismatch between periods that still counts as periodic, as a share of the amplitude.
const PERIODIC_MISMATCH: f64 = 0.02;

/// Upward crossings of the middle level from a sample on, in samples.
fn crossings(u: &[f64], first: usize, swing: VoltageRange) -> Vec<f64> {
    let band = 0.1 * (0.5 * swing.span_volt());
    let mut armed = false;
    let mut found = Vec::new();
    for i in first..u.len() - 1 {
        let (a, b) = (u[i] - swing.middle_volt(), u[i + 1] - swing.middle_volt());
        armed |= a < -band;
        if armed && a < 0.0 && b >= 0.0 {
            found.push(i as f64 + a / (a - b));
            armed = false;
        }
    }
    found
}

/// Crossings that one period may hold at most.
const MOST_CROSSINGS: usize = 12;

/// Period in samples of a command that repeats to its end; none if nothing repeats.
pub(crate) fn find_period(u: &[f64], swing: VoltageRange) -> Option<f64> {
    // the later part of the record: rests and fade-ins come first
    let first = u.len() * 2 / 5;
    let crossings = crossings(u, first, swing);
    // a period may hold several crossings
    (1..=MOST_CROSSINGS.min(crossings.len().saturating_sub(1))).find_map(|per_period| {
        let periods = (crossings.len() - 1) / per_period;
        let last = crossings.len() - 1;
        let period = (crossings[last] - crossings[last - periods * per_period]) / periods as f64;
        let repeats = mismatch(u, first, period)? <= PERIODIC_MISMATCH * (0.5 * swing.span_volt());
        repeats.then_some(period)
    })
}

/// Share of a record that must repeat if its end does not.
const LEAST_STEADY: f64 = 0.25;

/// Period and whole periods of a command that repeats between a fade-in and a fade-out, one period
/// fewer than there are; none unless two periods or more and a quarter of the record repeat.
pub(crate) fn inner_stretch(
    u: &[f64],
    given: Option<f64>,
    swing: VoltageRange,
) -> Option<(f64, Range<usize>)> {
    let crossings = crossings(u, 0, swing);
    let per_period = 1..=MOST_CROSSINGS.min(crossings.len().saturating_sub(1));
    let medians = per_period.map(|count| {
        let mut spans: Vec<f64> =
            crossings.iter().zip(&crossings[count..]).map(|(a, b)| b - a).collect();
        spans.sort_by(f64::total_cmp);
        spans[spans.len() / 2]
    });
    let candidates: Vec<f64> = given.map_or_else(|| medians.collect(), |period| vec![period]);
    let allowed = 3.0 * PERIODIC_MISMATCH * (0.5 * swing.span_volt());
    candidates.into_iter().find_map(|median| {
        let (mut longest, mut begin) = (0..0, 0);
        for i in 0..u.len() {
            match later(u, i, median) {
                Some(v) if (v - u[i]).abs() <= allowed => {
                    if i + 1 - begin > longest.len() {
                        longest = begin..i + 1;
                    }
                }
                _ => begin = i + 1,
            }
        }
        let (samples, _) = split(median);
        let end = longest.end + samples;
        let enough = end as f64 - longest.start as f64 >= LEAST_STEADY * u.len() as f64;
        if !enough || (longest.len() as f64) < median || rests(&u[longest.start..end], swing) {
            return None;
        }
        let inside: Vec<f64> = crossings
            .iter()
            .copied()
            .filter(|c| (longest.start as f64..end as f64).contains(c))
            .collect();
        // refined between crossings that are whole periods apart
        let last = *inside.last()?;
        let apart = inside.iter().map(|c| (last - c) / median);
        let whole = apart.filter(|n| *n > 0.5 && (n - n.round()).abs() < 0.05);
        let most = whole.fold(0.0, f64::max);
        let period = match given {
            Some(period) => period,
            None if most > 0.0 => most * median / most.round(),
            None => median,
        };
        let (periods, _) = split((end - longest.start) as f64 / period);
        let (used, _) = split((periods.max(2) - 1) as f64 * period + 0.5);
        // a period less than there are, in the middle: the tolerance lets in a little of the fades
        let start = longest.start + (end - longest.start).saturating_sub(used) / 2;
        (periods >= 2).then(|| (period, start..(start + used).min(end)))
    })
}

/// Whether the command does not use half its amplitude: a rest repeats at any period.
fn rests(u: &[f64], swing: VoltageRange) -> bool {
    let [low, high] = extremes(u.iter().copied());
    high - low < 0.5 * swing.span_volt()
}

/// Root mean square of `u(i + period) - u(i)` from `first` on; none if less than half a period is
/// left to compare.
fn mismatch(u: &[f64], first: usize, period: f64) -> Option<f64> {
    let changes = (first..u.len()).map_while(|i| Some(later(u, i, period)? - u[i]));
    let changes: Vec<f64> = changes.collect();
    (changes.len() as f64 >= 0.5 * period).then(|| mean_square(&changes).sqrt())
}

/// `u` a period after sample `index`, by linear interpolation.
fn later(u: &[f64], index: usize, period: f64) -> Option<f64> {
    let (whole, part) = split(period);
    let a = u.get(index + whole)?;
    let b = if part > 0.0 { u.get(index + whole + 1)? } else { a };
    Some(a + part * (b - a))
}

/// The last whole periods of a record over which the command repeats, the first one left out if
/// there are at least two.
pub(crate) fn steady_samples(u: &[f64], period: f64, amplitude: f64) -> Option<Range<usize>> {
    let allowed = 3.0 * PERIODIC_MISMATCH * amplitude;
    let last_pair = (0..u.len()).rev().find(|&i| later(u, i, period).is_some())?;
    let repeats = |i: usize| later(u, i, period).is_some_and(|v| (v - u[i]).abs() <= allowed);
    let begin = (0..=last_pair).rev().take_while(|&i| repeats(i)).last()?;
    let (periods, _) = split((u.len() - begin) as f64 / period + 1e-6);
    let used = if periods >= 2 { periods - 1 } else { periods };
    let (samples, _) = split(used as f64 * period + 0.5);
    (used > 0).then(|| u.len() - samples..u.len())
}
