//! The text of a table: lines, fields, numbers with their places, even time steps.

use super::significant;
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};

/// Problems of one kind listed one by one before the rest is only counted.
const LISTED: usize = 5;
/// Rows below which nothing can be said about sampling.
pub(crate) const LEAST_ROWS: usize = 3;

/// A line of the file that holds data.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    /// Its number in the file, from 1.
    pub(crate) number: usize,
    /// Its text without the line end.
    pub(crate) text: &'a str,
    /// Whether a line end follows.
    ended: bool,
}

impl<'a> Line<'a> {
    /// Fields with the column of their first character, from 1.
    pub(crate) fn fields(self) -> Vec<(&'a str, usize)> {
        let mut column = 1;
        self.text
            .split(',')
            .map(|raw| {
                let blanks = raw.chars().take_while(|c| c.is_whitespace()).count();
                let at = column + blanks;
                column += raw.chars().count() + 1;
                (raw.trim().trim_matches('"').trim(), at)
            })
            .collect()
    }
}

/// The lines that hold data: comments (`#`) and empty ones are left out.
pub(crate) fn split_lines(text: &str) -> Vec<Line<'_>> {
    text.split_inclusive('\n')
        .enumerate()
        .map(|(i, line)| Line {
            number: i + 1,
            ended: line.ends_with('\n'),
            text: line.trim_end_matches(['\n', '\r']),
        })
        .filter(|line| !line.text.trim().is_empty() && !line.text.starts_with('#'))
        .collect()
}

/// The fault of a header whose fields something else than commas separates.
pub(crate) fn other_separator(header: &str) -> Option<RecordFault> {
    let separator = match (header.contains(','), header.contains(';'), header.contains('\t')) {
        (_, true, _) => "semicolons",
        (false, false, true) => "tabs",
        _ => return None,
    };
    Some(RecordFault::OtherSeparator { separator })
}

/// Largest size of a number that can have been measured, in the units of any channel.
const LARGEST: f64 = 1e12;

/// The numbers of a table while it is read.
pub(crate) struct Rows {
    /// The columns.
    pub(crate) values: Vec<Vec<f64>>,
    /// Line of every row.
    pub(crate) lines: Vec<usize>,
}

impl Rows {
    /// Reads every row; `labels` name the columns.
    pub(crate) fn read(
        source: &Source,
        lines: &[Line<'_>],
        labels: &[&str],
        problems: &mut Problems,
    ) -> Self {
        let mut rows = Self { values: vec![Vec::new(); labels.len()], lines: Vec::new() };
        let mut lists = [Listing::default(), Listing::default(), Listing::default()];
        let [field_counts, words, infinities] = &mut lists;
        let last = lines.len().saturating_sub(1);
        for (i, line) in lines.iter().enumerate() {
            let fields = line.fields();
            if i == last {
                let before = i.checked_sub(1).map(|b| lines[b].fields());
                if is_cut_off(line, &fields, before.as_deref(), labels.len()) {
                    let text = line.text.to_owned();
                    let fault = Fault::Truncated { text, expected: labels.len() };
                    problems.push(Place::at(&source.name, line.number, 1), fault);
                    break;
                }
            }
            if fields.len() != labels.len() {
                let fault = Fault::FieldCount { found: fields.len(), expected: labels.len() };
                field_counts.push(problems, Place::at(&source.name, line.number, 1), fault);
                continue;
            }
            rows.lines.push(line.number);
            for ((text, at), (values, label)) in
                fields.iter().zip(rows.values.iter_mut().zip(labels))
            {
                let place = || Place::at(&source.name, line.number, *at).field(*label);
                let value = text.parse::<f64>();
                match value {
                    Ok(value) if value.abs() <= LARGEST => {}
                    Ok(value) if value.is_finite() => {
                        let fault = Fault::TooLarge { value, most: LARGEST };
                        infinities.push(problems, place(), fault);
                    }
                    Ok(value) => infinities.push(problems, place(), Fault::NotFinite { value }),
                    Err(_) => {
                        let fault = Fault::NotANumber { text: (*text).to_owned() };
                        words.push(problems, place(), fault);
                    }
                }
                values.push(value.unwrap_or(f64::NAN));
            }
        }
        for list in lists {
            list.finish(problems);
        }
        rows
    }
}

/// Whether the last line of a file stops early: too few fields, or no line end behind a last number
/// that has fewer decimals than all the table's lines before promise.
fn is_cut_off(
    line: &Line<'_>,
    fields: &[(&str, usize)],
    before: Option<&[(&str, usize)]>,
    expected: usize,
) -> bool {
    if line.ended {
        return false;
    }
    let decimals =
        |f: &[(&str, usize)]| f.last().and_then(|(t, _)| t.split_once('.')).map(|(_, d)| d.len());
    let shorter = match before.and_then(decimals) {
        Some(usual) => decimals(fields).is_none_or(|d| d < usual),
        None => false,
    };
    fields.len() < expected || fields.last().is_some_and(|(t, _)| t.is_empty()) || shorter
}

/// How a record is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Mean time step, s.
    pub step_s: f64,
    /// Largest deviation of a step from the usual one, as a fraction of it.
    pub jitter: f64,
}

/// Deviation of a time step from the usual one that is taken for the rounding of its digits.
pub const ROUNDING_JITTER: f64 = 0.02;
/// Deviation of a time step up to which a record is brought onto an even step.
pub const RESAMPLED_JITTER: f64 = 0.2;

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
    let jitter_percent = significant(100.0 * sampling.jitter, 3);
    let fault = RecordFault::Resampled { jitter_percent, step_s: significant(sampling.step_s, 9) };
    Problem::new(Place::file(file).field(label), fault.into())
}

/// Whether a column looks like a time: it increases in equal steps.
pub(crate) fn increases_evenly(values: &[f64]) -> bool {
    let span = values.last().zip(values.first()).map_or(0.0, |(b, a)| b - a);
    let step = span / (values.len().max(2) - 1) as f64;
    step > 0.0 && values.windows(2).all(|w| ((w[1] - w[0]) / step - 1.0).abs() < RESAMPLED_JITTER)
}

/// Brings columns from uneven times onto equal steps between the first and the last, by straight
/// lines between neighbours.
///
/// Assumes: times increase; every column is as long as `time_s`.
pub fn resample(time_s: &mut Vec<f64>, columns: &mut [&mut Vec<f64>]) {
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
            problems.push(place, Fault::More { count: self.count - LISTED });
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
