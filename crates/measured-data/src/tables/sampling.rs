//! Sampling of records: even time steps, and records brought onto them.

use super::significant;
use crate::problem::{Fault, Place, Problem, Problems};

/// Problems of one kind listed one by one before the rest is only counted.
const LISTED: usize = 5;

/// How a record is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampling {
    /// Mean time step, s.
    pub(crate) step_s: f64,
    /// Largest deviation of a step from the usual one, as a fraction of it.
    pub(crate) jitter: f64,
}

/// Deviation of a time step from the usual one that is taken for the rounding of its digits.
pub(crate) const ROUNDING_JITTER: f64 = 0.02;
/// Deviation of a time step up to which a record is brought onto an even step.
pub(crate) const RESAMPLED_JITTER: f64 = 0.2;

/// The sampling of a time column; problems for steps that go back or are far from the usual one.
pub(crate) fn check_time(
    file: &str,
    label: &str,
    time_s: &[f64],
    lines: &[usize],
    problems: &mut Problems,
) -> Sampling {
    let steps: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    let mut sorted: Vec<f64> = steps.iter().copied().filter(|s| *s > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN);
    let (mut back, mut uneven) = (Listing::default(), Listing::default());
    let mut jitter = 0.0_f64;
    for (i, &step) in steps.iter().enumerate() {
        let place = || Place::at(file, lines[i + 1], 1).field(label);
        let deviation = (step - usual).abs() / usual;
        if step <= 0.0 {
            let fault = Fault::TimeNotIncreasing { time_s: time_s[i + 1], before_s: time_s[i] };
            back.push(problems, place(), fault);
        } else if i > 0 && steps[i - 1] <= 0.0 {
            // the step out of a time that ran back is long for that reason alone
        } else if deviation > RESAMPLED_JITTER {
            let fault = Fault::TimeStepUneven { step_s: step, usual_s: usual };
            uneven.push(problems, place(), fault);
        } else {
            jitter = jitter.max(deviation);
        }
    }
    back.finish(problems);
    uneven.finish(problems);
    let span = time_s.last().zip(time_s.first()).map(|(b, a)| b - a);
    Sampling { step_s: span.map_or(f64::NAN, |s| s / steps.len() as f64), jitter }
}

/// The warning about a record that was brought onto even steps.
pub(crate) fn resampled(file: &str, label: &str, sampling: Sampling) -> Problem {
    let message = format!(
        "the time steps differ by up to {} %; resampled to {} s by straight lines",
        significant(100.0 * sampling.jitter, 3),
        significant(sampling.step_s, 9)
    );
    Problem::new(Place::file(file).field(label), Fault::Other(message))
}

/// Notes which columns look like the time, at the place of one that does not increase: they increase
/// in equal steps.
pub(crate) fn note_swapped<'a>(
    place: &Place,
    others: impl IntoIterator<Item = (&'a str, &'a Vec<f64>)>,
    problems: &mut Problems,
) {
    for (other, values) in others {
        let span = values.last().zip(values.first()).map_or(0.0, |(b, a)| b - a);
        let step = span / (values.len().max(2) - 1) as f64;
        let is_even = |w: &[f64]| ((w[1] - w[0]) / step - 1.0).abs() < RESAMPLED_JITTER;
        if step > 0.0 && values.windows(2).all(is_even) {
            let message = format!(
                "does not increase, but `{other}` increases in equal steps: the two columns are swapped; swap their names in the header"
            );
            problems.push(place.clone(), Fault::Other(message));
        }
    }
}

/// Brings columns from uneven times onto equal steps between the first and the last, by straight
/// lines between neighbours.
///
/// Assumes: times increase; every column is as long as `time_s`.
pub(crate) fn resample(time_s: &mut Vec<f64>, columns: &mut [&mut Vec<f64>]) {
    let count = time_s.len();
    let Some((&first, &last)) = time_s.first().zip(time_s.last()).filter(|_| count > 2) else {
        return;
    };
    let step = (last - first) / (count - 1) as f64;
    let even: Vec<f64> = (0..count).map(|i| first + step * i as f64).collect();
    let mut at = 0;
    let weights: Vec<(usize, f64)> = even
        .iter()
        .map(|&t| {
            while at + 2 < count && time_s[at + 1] <= t {
                at += 1;
            }
            let part = (t - time_s[at]) / (time_s[at + 1] - time_s[at]);
            (at, part.clamp(0.0, 1.0))
        })
        .collect();
    for column in columns {
        let new = weights.iter().map(|&(i, w)| column[i] + w * (column[i + 1] - column[i]));
        **column = new.collect();
    }
    *time_s = even;
}

/// Lists the first few problems of one kind and counts the rest.
#[derive(Debug, Default)]
pub(crate) struct Listing {
    count: usize,
    next: Option<Place>,
}

impl Listing {
    pub(crate) fn push(&mut self, problems: &mut Problems, place: Place, fault: Fault) {
        self.count += 1;
        if self.count <= LISTED {
            problems.push(place, fault);
        } else if self.next.is_none() {
            self.next = Some(place);
        }
    }

    pub(crate) fn finish(self, problems: &mut Problems) {
        if let Some(place) = self.next {
            let message = format!("{} more problems of this kind follow", self.count - LISTED);
            problems.push(place, Fault::Other(message));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line survives resampling exactly, a parabola to the square of the step.
    #[test]
    fn resampling_is_of_second_order() {
        let miss = |n: usize| {
            let mut time: Vec<f64> = (0..n)
                .map(|i| (i as f64 + if i % 2 == 1 { 0.15 } else { 0.0 }) / (n - 1) as f64)
                .collect();
            let mut line: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
            let mut square: Vec<f64> = time.iter().map(|t| t * t).collect();
            resample(&mut time, &mut [&mut line, &mut square]);
            let worst = |y: &[f64], f: &dyn Fn(f64) -> f64| {
                time.iter().zip(y).map(|(&t, y)| (y - f(t)).abs()).fold(0.0, f64::max)
            };
            assert!(worst(&line, &|t| 3.0 - 2.0 * t) < 1e-14);
            worst(&square, &|t| t * t)
        };
        let order = (miss(101) / miss(201)).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}
