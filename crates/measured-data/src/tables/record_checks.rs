//! Checks of a measured record against what hysteretic systems and their recorders can do.

use crate::problem::{Fault, Place, Problem, Problems};

/// A record to be checked: input and output with label, unit and samples.
pub(crate) struct Record<'a> {
    pub(crate) file: &'a str,
    /// Line of every sample; may be empty where the source has no lines.
    pub(crate) lines: &'a [usize],
    pub(crate) input: (&'a str, &'static str, &'a [f64]),
    pub(crate) output: (&'a str, &'static str, &'a [f64]),
}

impl Record<'_> {
    /// The place of a sample.
    pub(crate) fn place(&self, sample: usize, label: &str) -> Place {
        match self.lines.get(sample) {
            Some(&line) => Place::at(self.file, line, 1).field(label),
            None => Place::file(self.file).field(label),
        }
    }
}

/// Samples of a flat top that counts as clipping.
const CLIPPED_SAMPLES: usize = 8;
/// Movement of the input over a flat top that counts as clipping, as a share of the input's range.
const CLIPPED_MOVEMENT: f64 = 0.05;
/// Commands so many times beyond the range are in a thousand times smaller unit.
const UNIT_EXCESS: f64 = 20.0;
/// Lead of the output from which it cannot be an actuator's, deg.
const LEAST_LEAD_DEG: f64 = 2.0;

/// Distance from the range of all but one in a hundred values, over it, up to which a value is no stray one.
const STRAY: f64 = 0.5;
/// Step of the input between two samples that is a jump, as a share of the range.
const JUMP: f64 = 0.2;
/// Part of the path of the input that has to lie outside its jumps, for it to tell who leads.
const LEAST_PATH: f64 = 0.5;
/// Half-width of the play that tells the path of an input from its noise, as a share of the range.
const PATH_GAP: f64 = 0.01;

/// Smallest and largest of the values; infinite of none.
pub fn limits(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)))
}

/// Refuses outputs that never change and warns of those that are clipped; whether both columns
/// move. An input that never changes is judged beside the other records.
pub(crate) fn check_record(
    record: &Record<'_>,
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) -> bool {
    let [rests, is_dead] = [record.input.2, record.output.2].map(|values| {
        let (low, high) = limits(values);
        low >= high
    });
    if is_dead {
        let (label, unit, values) = record.output;
        // minus zero is zero
        let message = format!(
            "every sample is {} {unit}: nothing can be learnt from a constant output; check that the right column was recorded",
            limits(values).0 + 0.0
        );
        problems.push(record.place(0, label), Fault::Other(message));
    }
    if !rests && !is_dead {
        warnings.extend(clipped(record));
    }
    !rests && !is_dead
}

/// The longest flat top at either limit of the output while the input moves on.
///
/// A flat top is a row of samples equal to the limit; it counts from [`CLIPPED_SAMPLES`] samples and
/// [`CLIPPED_MOVEMENT`] of the input's range. An input that is held keeps the output flat too: that
/// is no clipping.
fn clipped(record: &Record<'_>) -> Vec<Problem> {
    let ((_, _, input), (label, unit, output)) = (record.input, record.output);
    let (low, high) = limits(output);
    let (input_low, input_high) = limits(input);
    let mut found = Vec::new();
    for (end, limit) in [("largest", high), ("smallest", low)] {
        let is_limit = |v: &f64| v.total_cmp(&limit).is_eq();
        let flats = output.chunk_by(|a, b| is_limit(a) == is_limit(b)).scan(0, |end, flat| {
            let start = *end;
            *end += flat.len();
            Some((is_limit(&flat[0]) && flat.len() >= CLIPPED_SAMPLES).then_some(start..*end))
        });
        let moved = flats.flatten().map(|flat| {
            let (low, high) = limits(&input[flat.clone()]);
            (flat.start, flat.len(), (high - low) / (input_high - input_low))
        });
        let longest = moved
            .filter(|(.., movement)| *movement > CLIPPED_MOVEMENT)
            .reduce(|best, next| if next.1 > best.1 { next } else { best });
        if let Some((sample, samples, movement)) = longest {
            let message = format!(
                "the output stays at its {end} {limit} {unit} for {samples} samples while the input moves through {:.0} % of its range: the record looks clipped; check the range of sensor and amplifier (a wide backlash looks the same)",
                100.0 * movement
            );
            found.push(Problem::new(record.place(sample, label), Fault::Other(message)));
        }
    }
    found
}

/// Refuses millivolts declared as volts: commands far outside the range that would fit into it as a
/// thousandth. Whether the unit is plausible.
pub(crate) fn check_unit(
    record: &Record<'_>,
    range_volt: (f64, f64),
    problems: &mut Problems,
) -> bool {
    let (low, high) = range_volt;
    let (label, unit, values) = record.input;
    let largest = low.abs().max(high.abs());
    let (at, reached) = values
        .iter()
        .enumerate()
        .fold((0, 0.0_f64), |best, (i, v)| if v.abs() > best.1.abs() { (i, *v) } else { best });
    let times = reached.abs() / largest;
    let slack = 0.01 * (high - low);
    let (least, most) = limits(values);
    let fits = 1e-3 * least >= low - slack && 1e-3 * most <= high + slack;
    if times < UNIT_EXCESS || !fits {
        return true;
    }
    let message = format!(
        "reaches {reached} {unit}, {times:.0} times the largest of the range ({low}, {high}) {unit}, and would fit as mV: name the column `command_mV` and convert it with `hhc import`, or multiply it by 0.001"
    );
    problems.push(record.place(at, label), Fault::Other(message));
    false
}

/// Refuses a displacement that leads its command.
pub(crate) fn check_lag(record: &Record<'_>, problems: &mut Problems) {
    let lead_deg = lead_deg(record.input.2, &without_strays(record.output.2));
    if lead_deg > LEAST_LEAD_DEG {
        let label = record.input.0;
        let message = format!(
            "the displacement leads the command by {lead_deg:.1} deg over the record, expected a lag: an actuator at rest does not move before it is driven; command and displacement are swapped, or one has the wrong delay. Swap their names in the header; if it is no actuator, make the data set a GenericLoop"
        );
        problems.push(record.place(0, label), Fault::Other(message));
    }
}

/// Values with those far outside the usual range drawn to its neighbourhood: a recorder's word for a lost sample is no motion.
fn without_strays(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let cut = sorted.len() / 100;
    let (low, high) = (sorted[cut], sorted[sorted.len() - 1 - cut]);
    let range = high - low;
    let near = |value: &f64| value.clamp(low - STRAY * range, high + STRAY * range);
    values.iter().map(near).collect()
}

/// Lead of the output over the input, deg of the sine with the same loop area per path.
///
/// ```text
/// r = y - (g u + c)                     what a straight line leaves
/// s = sum r du / (sum |du| std y)       = sqrt(2) pi/4 sin(lead) for a sine
/// ```
/// The straight line takes off what an open path would add; a loop's area does not feel it. The path is that
/// of a play of [`PATH_GAP`] of the range: the noise of a finely sampled record would make it long.
/// Jumps of the input are left out of both: where everything happens between two samples, a recorder that is
/// one sample late on one channel decides who seems to lead. What is left of an input that is mostly jumps tells nothing.
fn lead_deg(input: &[f64], output: &[f64]) -> f64 {
    let n = input.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
    let (u0, y0) = (mean(input), mean(output));
    let (mut uu, mut uy, mut yy) = (0.0, 0.0, 0.0);
    for (u, y) in input.iter().zip(output) {
        uu += (u - u0) * (u - u0);
        uy += (u - u0) * (y - y0);
        yy += (y - y0) * (y - y0);
    }
    let gain = uy / uu;
    let rest = |i: usize| output[i] - y0 - gain * (input[i] - u0);
    let (low, high) = limits(input);
    let half_gap = PATH_GAP * (high - low);
    let mut followed = input.first().copied().unwrap_or_default();
    let (mut area, mut path, mut whole) = (0.0, 0.0, 0.0);
    for (i, pair) in input.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        let last = followed;
        followed = followed.min(pair[1] + half_gap).max(pair[1] - half_gap);
        whole += (followed - last).abs();
        if step.abs() < JUMP * (high - low) {
            area += 0.5 * (rest(i) + rest(i + 1)) * step;
            path += (followed - last).abs();
        }
    }
    if path <= LEAST_PATH * whole {
        return 0.0;
    }
    let share = area * gain.signum() / (path * (yy / n).sqrt());
    let sine = share / (std::f64::consts::SQRT_2 * std::f64::consts::FRAC_PI_4);
    sine.clamp(-1.0, 1.0).asin().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sine(lag_deg: f64, offset: f64) -> (Vec<f64>, Vec<f64>) {
        let phase = |i: u32| TAU * f64::from(i) / 500.0;
        let u = (0..=2000).map(|i| 65.0 + 80.0 * phase(i).sin()).collect();
        let y =
            (0..=2000).map(|i| offset + 9.0 * (phase(i) - lag_deg.to_radians()).sin()).collect();
        (u, y)
    }

    #[test]
    fn the_lead_of_a_sine_is_found() {
        for lag in [-40.0, -5.0, 0.0, 5.0, 40.0] {
            let (u, y) = sine(lag, 12.0);
            assert!(
                (lead_deg(&u, &y) + lag).abs() < 0.05 * (1.0 + lag.abs()),
                "{lag}: {}",
                lead_deg(&u, &y)
            );
            let turned: Vec<f64> = y.iter().map(|y| -y).collect();
            assert!(
                (lead_deg(&u, &turned) + lag).abs() < 0.05 * (1.0 + lag.abs()),
                "an inverting sensor"
            );
            assert!((lead_deg(&y, &u) - lag).abs() < 0.05 * (1.0 + lag.abs()), "swapped");
        }
    }

    /// A displacement with its noise in place of the command, sampled finely: as clear as without noise.
    #[test]
    fn jumps_do_not_tell_who_leads() {
        // held steps with a creeping answer, the recorder of the command one sample late
        let level = |i: usize| [0.0, 0.6, -0.4, 1.0, -0.8][(i / 100) % 5];
        let u: Vec<f64> = (0..1000).map(level).collect();
        let y: Vec<f64> =
            (0..1000).map(|i| level(i + 1) * (1.0 + 0.0004 * (i % 100) as f64)).collect();
        assert!(lead_deg(&u, &y).abs() < 0.5, "{}", lead_deg(&u, &y));
        // the same of a triangle is a lead: it moves all the time
        let ramp = |i: usize| (((i % 40) as f64) - 20.0).abs();
        let u: Vec<f64> = (0..1000).map(ramp).collect();
        let y: Vec<f64> = (0..1000).map(|i| ramp(i + 1)).collect();
        assert!(lead_deg(&u, &y) > 5.0, "{}", lead_deg(&u, &y));
    }

    #[test]
    fn noise_does_not_hide_swapped_columns() {
        let (u, y) = sine(8.0, 0.0);
        let fine = |v: &[f64]| -> Vec<f64> {
            let pairs = v.windows(2);
            pairs
                .flat_map(|p| (0..20).map(move |k| p[0] + 0.05 * f64::from(k) * (p[1] - p[0])))
                .collect()
        };
        let noisy: Vec<f64> = fine(&y)
            .iter()
            .enumerate()
            .map(|(i, y)| y + 0.05 * (7919.0 * i as f64).sin())
            .collect();
        let lead = lead_deg(&noisy, &fine(&u));
        assert!((lead - 8.0).abs() < 0.6, "{lead}");
    }

    /// Numbers that a recorder writes for lost samples do not make the output lead.
    #[test]
    fn stray_values_do_not_tell_who_leads() {
        let (u, mut y) = sine(4.0, 0.0);
        for (i, stray) in [(480, 9999.0), (481, 9999.0), (482, 9999.0), (1300, -9999.99)] {
            y[i] = stray;
        }
        let mut problems = Problems::default();
        let (input, output) = (("u", "V", &u[..]), ("y", "um", &y[..]));
        check_lag(&Record { file: "r.csv", lines: &[], input, output }, &mut problems);
        assert!(problems.is_empty() && lead_deg(&u, &y) > LEAST_LEAD_DEG, "{}", lead_deg(&u, &y));
    }

    fn warned(input: &[f64], output: &[f64]) -> usize {
        let (input, output) = (("u", "V", input), ("y", "um", output));
        clipped(&Record { file: "r.csv", lines: &[], input, output }).len()
    }

    #[test]
    fn clipping_is_told_from_a_held_input_and_from_rounding() {
        let (u, y) = sine(8.0, 0.0);
        assert_eq!(warned(&u, &y), 0);
        let rounded: Vec<f64> = y.iter().map(|y| (y * 100.0).round() / 100.0).collect();
        assert_eq!(warned(&u, &rounded), 0);
        let upper: Vec<f64> = y.iter().map(|y| y.min(8.0)).collect();
        assert_eq!(warned(&u, &upper), 1);
        let both: Vec<f64> = y.iter().map(|y| y.clamp(-8.0, 8.0)).collect();
        assert_eq!(warned(&u, &both), 2);
        let held_u: Vec<f64> = u.iter().map(|u| u.min(120.0)).collect();
        let held_y: Vec<f64> = held_u.iter().map(|u| 0.1 * u).collect();
        assert_eq!(warned(&held_u, &held_y), 0);
    }
}
