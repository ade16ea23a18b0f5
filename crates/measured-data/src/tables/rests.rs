//! Records at rest, and records that hold several runs with rests between them.

use super::record_checks::{Record, limits};
use crate::problem::{Fault, Place, Problem, Problems};
use rotor_base::rests;
use std::ops::Range;

/// The limits of a record's columns, with the place and the unit of its input.
pub(crate) struct Spans {
    pub(crate) place: Place,
    pub(crate) unit: &'static str,
    pub(crate) input: (f64, f64),
    pub(crate) output: (f64, f64),
}

impl Spans {
    /// Those of a record.
    pub(crate) fn of(record: &Record<'_>) -> Self {
        let (label, unit, input) = record.input;
        let (input, output) = (limits(input), limits(record.output.2));
        Self { place: record.place(0, label), unit, input, output }
    }
}

/// An output that moves through this share of the others' ranges has an input that moves.
const MOVES_AT_REST: f64 = 0.25;

/// Judges the records whose input never changes: rests, which show noise, hum and drift, beside records that
/// move or alone; a wrong column where the output moves as beside an input that does.
pub(crate) fn check_rests(all: &[Spans], problems: &mut Problems, warnings: &mut Vec<Problem>) {
    let (rests, moving): (Vec<&Spans>, Vec<&Spans>) =
        all.iter().partition(|spans| spans.input.0 >= spans.input.1);
    let widest = moving.iter().map(|s| s.output.1 - s.output.0).fold(0.0, f64::max);
    for Spans { place, unit, input, output } in rests {
        let share = (output.1 - output.0) / widest;
        let level = input.0 + 0.0;
        if moving.is_empty() {
            let message = format!(
                "every sample is {level} {unit}, as in every other record: noise, hum and drift can be read from it, no model can; if the input was driven, the wrong column was recorded"
            );
            warnings.push(Problem::new(place.clone(), Fault::Other(message)));
        } else if share > MOVES_AT_REST {
            let message = format!(
                "every sample is {level} {unit}, while the output moves through {:.0} % of its largest range in the other runs: a system at rest does not; check that the right column was recorded",
                100.0 * share
            );
            problems.push(place.clone(), Fault::Other(message));
        } else {
            let message = format!(
                "every sample is {level} {unit}: a record at rest, used for noise, hum and drift and for no model"
            );
            warnings.push(Problem::new(place.clone(), Fault::Other(message)));
        }
    }
}

/// Share by which cycles differ that are not those of one run.
const OTHER: f64 = 0.1;

/// The first rest between cycles of different periods or amplitudes: several runs in one record.
pub(crate) fn several_runs(record: &Record<'_>) -> Option<Problem> {
    let (label, unit, input) = record.input;
    let differ = |a: f64, b: f64| (a / b - 1.0).abs() > OTHER;
    let different = |parted: &Parted| {
        let [before, after] = &parted.sides;
        differ(before.period, after.period) || differ(before.amplitude, after.amplitude)
    };
    let Parted { rest, sides: [before, after] } = parted(input).into_iter().find(different)?;
    let words = |side: &Side| {
        format!("cycles of {:.0} samples and {:.3} {unit}", side.period, side.amplitude)
    };
    let message = format!(
        "the input rests for {} samples between {} and {}: several runs in one record, whose period and amplitude would be mixed; give each its own run with `window_s`, or import with --split",
        rest.len(),
        words(&before),
        words(&after)
    );
    Some(Problem::new(record.place(rest.start, label), Fault::Other(message)))
}

/// A rest with the cycles before and behind it.
pub(crate) struct Parted {
    pub(crate) rest: Range<usize>,
    sides: [Side; 2],
}

/// Cycles on a side of a rest.
#[derive(Clone, Copy)]
struct Side {
    /// Period, samples.
    period: f64,
    /// Half peak to peak.
    amplitude: f64,
}

impl Side {
    fn of(input: &[f64]) -> Option<Self> {
        let (low, high) = limits(input);
        Some(Self { period: period(input)?, amplitude: 0.5 * (high - low) })
    }
}

/// The rests of an input that part runs: each longer than a period of the cycles on one of its sides.
pub(crate) fn parted(input: &[f64]) -> Vec<Parted> {
    let rests = rests(input);
    let starts = std::iter::once(0).chain(rests.iter().map(|rest| rest.end));
    let ends = rests.iter().map(|rest| rest.start).chain([input.len()]);
    let moving: Vec<Option<Side>> =
        starts.zip(ends).map(|(start, end)| Side::of(&input[start..end])).collect();
    let parts = |(rest, sides): (Range<usize>, &[Option<Side>])| {
        let &[Some(before), Some(after)] = sides else { return None };
        let is_long = rest.len() as f64 > before.period.min(after.period);
        is_long.then_some(Parted { rest, sides: [before, after] })
    };
    rests.into_iter().zip(moving.windows(2)).filter_map(parts).collect()
}

/// Samples from one rise of an input through its middle to the next, where there are two rises at least.
fn period(input: &[f64]) -> Option<f64> {
    let (low, high) = limits(input);
    let (middle, band) = (0.5 * (low + high), 0.1 * (high - low));
    let mut is_below = false;
    let mut rises = Vec::new();
    for (i, v) in input.iter().enumerate() {
        if is_below && *v > middle {
            rises.push(i);
        }
        is_below = if *v < middle - band { true } else { is_below && *v <= middle };
    }
    let (first, last) = (rises.first()?, rises.last()?);
    (last > first).then(|| (last - first) as f64 / (rises.len() - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// 4 s at 1 Hz, a rest of 1.5 s, then another frequency; 1000 samples a second.
    fn two_runs(rest: bool, hz: f64) -> Vec<f64> {
        let wave = |t: f64| match t {
            t if t < 4.0 => 60.0 * (TAU * t).sin(),
            t if t < 5.5 && rest => 0.0,
            t => (if hz > 1.0 { 20.0 } else { 60.0 }) * (TAU * hz * (t - 5.5)).sin(),
        };
        (0..8000).map(|i| wave(1e-3 * f64::from(i))).collect()
    }

    #[test]
    fn runs_are_parted_at_rests_longer_than_a_period() {
        let found = parted(&two_runs(true, 5.0));
        let [Parted { rest, .. }] = &found[..] else { panic!("{}", found.len()) };
        assert!(rest.start.abs_diff(4000) < 20 && rest.end.abs_diff(5500) < 20, "{rest:?}");
        assert!(parted(&two_runs(false, 5.0)).is_empty());
        let input = two_runs(true, 5.0);
        let said = |input: &[f64]| {
            let columns = [("command_V", "V", input), ("displacement_um", "um", input)];
            let [input, output] = columns;
            let record = Record { file: "r.csv", lines: &[], input, output };
            several_runs(&record).map(|problem| problem.to_string())
        };
        let text = said(&input).unwrap();
        assert!(text.contains("several runs in one record") && text.contains("--split"), "{text}");
        // bursts of one kind are one run
        assert_eq!(said(&two_runs(true, 1.0)), None);
    }

    #[test]
    fn a_record_at_rest_is_data_and_a_wrong_column_is_not() {
        let spans = |input, output| Spans { place: Place::file("r"), unit: "V", input, output };
        let moving = || spans((-20.0, 150.0), (0.0, 400.0));
        let judged = |rest: Spans, others: Vec<Spans>| {
            let (mut problems, mut warnings) = (Problems::default(), Vec::new());
            let all: Vec<Spans> = others.into_iter().chain([rest]).collect();
            check_rests(&all, &mut problems, &mut warnings);
            let said = |all: &[Problem]| all.iter().map(ToString::to_string).collect::<String>();
            (said(problems.as_slice()), said(&warnings))
        };
        let (problems, warnings) = judged(spans((65.0, 65.0), (200.0, 203.0)), vec![moving()]);
        assert!(problems.is_empty() && warnings.contains("a record at rest"), "{problems}");
        let (problems, _) = judged(spans((65.0, 65.0), (50.0, 350.0)), vec![moving()]);
        assert!(problems.contains("moves through 75 % of its largest range"), "{problems}");
        // alone it says nothing of a wrong column
        let (problems, warnings) = judged(spans((65.0, 65.0), (200.0, 203.0)), vec![]);
        assert!(problems.is_empty(), "{problems}");
        assert!(warnings.contains("every sample is 65 V, as in every other record"), "{warnings}");
    }
}
