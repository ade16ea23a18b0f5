//! Records that were cut: one that begins in motion, where another ends.

use crate::record::{Record, is_near};

/// Part of a step of the input that rounding may take it off.
const ROUNDED: f64 = 0.05;
/// Typical steps of the output, its noise with them, between the last sample of one record and the first of the next.
const OUTPUT_STEPS: f64 = 12.0;

/// The records, each that goes on where another ends led by what came before: a model remembers it. What is judged stays
/// what it was.
///
/// Records begin at rest. One that begins in motion, on the line through the last samples of exactly one other of the
/// same sampling and fitting, is taken for its second part.
pub(crate) fn continued(records: &[Record]) -> Vec<Record> {
    let before = |own: &Record| {
        let mut all = records.iter().enumerate().filter(|(_, other)| goes_on(other, own));
        all.next().filter(|_| all.next().is_none()).map(|(number, _)| number)
    };
    let links: Vec<Option<usize>> = records.iter().map(before).collect();
    (0..records.len()).map(|number| led(records, &links, number)).collect()
}

/// Whether a record goes on where another ends.
fn goes_on(first: &Record, second: &Record) -> bool {
    let (Some([.., b, a]), [c, d, ..]) = (first.input.last_chunk::<2>(), second.input.as_slice())
    else {
        return false;
    };
    let (step, next) = (a - b, d - c);
    let moves = step.abs().max(next.abs());
    let alike = is_near(first.step_s, second.step_s)
        && first.is_reference == second.is_reference
        && first.sensor == second.sensor
        && first.fitting == second.fitting;
    let off = (c - a - step).abs().min((c - a - next).abs());
    let on_line = off <= (step - next).abs() + ROUNDED * moves;
    let (Some(y), Some(z)) = (first.output.last(), second.output.first()) else { return false };
    let rough = |y: &[f64]| {
        let steps = y.windows(2).map(|w| (w[1] - w[0]).abs());
        steps.sum::<f64>() / y.len().max(1) as f64
    };
    let typical = rough(&first.output).max(rough(&second.output));
    !std::ptr::eq(first, second)
        && alike
        && step.abs().min(next.abs()) > 0.0
        && on_line
        && (z - y).abs() <= OUTPUT_STEPS * typical
}

/// A record behind all that led to it.
fn led(records: &[Record], links: &[Option<usize>], number: usize) -> Record {
    let mut own = records[number].clone();
    let mut seen = vec![number];
    let mut at = number;
    while let Some(before) = links[at].filter(|before| !seen.contains(before)) {
        let lead = &records[before];
        let lead_samples = lead.input.len();
        own.input.splice(..0, lead.input.iter().copied());
        own.output.splice(..0, lead.output.iter().copied());
        for (ours, theirs) in [
            (&mut own.amplifier, &lead.amplifier),
            (&mut own.temperature, &lead.temperature),
            (&mut own.load, &lead.load),
        ] {
            *ours = match (ours.take(), theirs) {
                (Some(ours), Some(theirs)) => Some([theirs.as_slice(), &ours].concat()),
                _ => None,
            };
        }
        own.window = own.window.start + lead_samples..own.window.end + lead_samples;
        seen.push(before);
        at = before;
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(range: std::ops::Range<usize>) -> Record {
        let input = |i: usize| 65.0 + 40.0 * (0.02 * i as f64).sin() * (0.003 * i as f64).cos();
        let jitter = |i: usize| 0.3 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
        let inputs = range.clone().map(input).collect();
        let outputs = range.clone().map(|i| 2.5 * input(i) + jitter(i)).collect();
        Record::new(format!("{range:?}"), 1e-3, inputs, outputs)
    }

    #[test]
    fn the_second_part_remembers_the_first_whatever_their_order() {
        let whole = wave(0..2000);
        for (records, own) in
            [([wave(0..900), wave(900..2000)], 1), ([wave(900..2000), wave(0..900)], 0)]
        {
            let all = continued(&records);
            assert!(all[own].input == whole.input);
            assert_eq!(all[own].window, 900..2000);
            assert!(all[own].judged_output() == &whole.output[900..]);
            assert!(all[1 - own] == records[1 - own]);
        }
    }

    #[test]
    fn records_that_only_meet_stay_apart() {
        // another record, one that begins at rest, and one with a gap between
        let rest = Record::new("rest", 1e-3, vec![65.0; 500], vec![162.5; 500]);
        for second in [wave(1300..2000), rest, wave(930..2000)] {
            let records = [wave(0..900), second];
            assert!(continued(&records) == records, "{}", records[1].id);
        }
    }
}
