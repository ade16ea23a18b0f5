//! What records of one set show beside one another: another sign, another gain, a limit that only some reach.

use crate::glance::{Glance, OF_BUTTERFLY};
use crate::identification::records;
use measured_data::{Channel, DataSet};
use preisach_dyn::identify::{Channel as Side, Finding, Subject};
use rotor_base::significant;

/// Records of one actuator at like frequencies differ in gain by less than this factor, whatever their amplitude.
const OTHER_GAIN: f64 = 3.0;
/// Up to this multiple of the lowest frequency of a set, frequencies are alike: far from any mode.
const LIKE: f64 = 3.0;
/// Part of its range by which an output must pass a level to be beyond it, and within which it ends at it.
const BEYOND: f64 = 0.05;
const AT: f64 = 0.005;

/// The records of a data folder at a glance, in the units of the subject; none of what is no record in time.
pub fn glances(data: &DataSet) -> (Vec<Glance>, Subject<'static>) {
    let (runs, subject) = match data {
        DataSet::Bench(data) => (&data.runs[..], Subject::Displacement),
        DataSet::Loops(data) => {
            let [input_unit, output_unit] = data.channels.both().map(|c: &Channel| c.unit.symbol);
            (&data.runs[..], Subject::Loop { input_unit, output_unit })
        }
        DataSet::Curves(_) | DataSet::Sweep(_) => (&[][..], Subject::Actuator),
    };
    (records(runs, 1.0).iter().map(Glance::of).collect(), subject)
}

/// What records beside one another show, each in a sentence with its remedy: one whose output falls where those of others
/// rise, one of another gain, one whose output rests at a level that others pass, and one that ends at the level where
/// another rests.
pub fn compared(glances: &[Glance], subject: Subject<'_>) -> Vec<String> {
    let mut said = Vec::from_iter(of_sign(glances));
    let butterflies = glances.iter().filter(|glance| glance.is_butterfly);
    said.extend(butterflies.map(|glance| format!("record {}: {OF_BUTTERFLY}", glance.id)));
    said.extend(of_gain(glances, subject));
    said.extend(of_clips(glances, subject));
    said
}

fn falls(glance: &Glance) -> bool {
    glance.findings.iter().any(|finding| matches!(finding, Finding::OutputFalls { .. }))
}

/// The frequency up to which records are far from any mode, Hz: behind one the output may lag by half a period.
fn highest_alike_hz(glances: &[Glance]) -> f64 {
    LIKE * glances.iter().filter_map(|glance| glance.frequency_hz).fold(f64::MAX, f64::min)
}

fn of_sign(glances: &[Glance]) -> Option<String> {
    let highest_hz = highest_alike_hz(glances);
    let is_slow = |glance: &&Glance| glance.frequency_hz.is_none_or(|hz| hz <= highest_hz);
    let ids = |is: &dyn Fn(&&Glance) -> bool| -> Vec<&str> {
        glances.iter().filter(is_slow).filter(is).map(|glance| glance.id.as_str()).collect()
    };
    let falling = ids(&|glance| falls(glance));
    let rising = ids(&|glance| !falls(glance) && glance.slope.is_some_and(|slope| slope > 0.0));
    let differ = !falling.is_empty() && !rising.is_empty();
    differ.then(|| {
        format!(
            "the output falls as the command rises in {}, and rises in {}: a sensor or a column changed its sign between them; import the ones apart, with --scale NAME=-1",
            falling.join(", "),
            rising.join(", ")
        )
    })
}

/// The middle of some values.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn of_gain(glances: &[Glance], subject: Subject<'_>) -> Vec<String> {
    let [input, output] = subject.units();
    let highest_hz = highest_alike_hz(glances);
    let size = |glance: &Glance| {
        let slope = glance.slope.filter(|slope| slope.is_finite() && slope.abs() > 0.0)?;
        (glance.frequency_hz? <= highest_hz).then_some(slope.abs())
    };
    let own: Vec<(&Glance, f64)> = glances.iter().filter_map(|g| Some((g, size(g)?))).collect();
    // of two nobody knows which one is right: the first is held against the second
    let usual = match own[..] {
        [_, (_, second)] => Some(second),
        _ => median(own.iter().map(|(_, size)| *size).collect()),
    };
    let said = |(glance, size): &(&Glance, f64)| {
        let usual = usual?;
        let factor = size / usual;
        let differs = !(1.0 / OTHER_GAIN..=OTHER_GAIN).contains(&factor);
        let [size, usual] = [*size, usual].map(|value| significant(value, 3));
        let swapped = (size * usual).ln().abs() < OTHER_GAIN.ln() / 2.0;
        let what = if swapped { "its columns have changed places, or it has" } else { "it has" };
        differs.then(|| {
            format!(
                "record {}: {size} {output}/{input}, where others of a like frequency have {usual}: {what} another unit, range of the amplifier or gain of the sensor; look at its header, import it apart with --columns or --scale",
                glance.id
            )
        })
    };
    own.iter().filter_map(said).collect()
}

fn of_clips(glances: &[Glance], subject: Subject<'_>) -> Vec<String> {
    let unit = subject.units()[1];
    let mut said = Vec::new();
    for glance in glances {
        let level = glance.findings.iter().find_map(|finding| match finding {
            Finding::Clipped { channel: Side::Output, level, .. } => Some(*level),
            _ => None,
        });
        let Some(level) = level else { continue };
        let (least, largest) = glance.output;
        let span = largest - least;
        let is_upper = largest - level < level - least;
        let past = |other: &Glance| {
            if is_upper { other.output.1 - level } else { level - other.output.0 }
        };
        let others =
            || glances.iter().filter(|other| other.id != glance.id && other.slope.is_some());
        let names = |is: &dyn Fn(f64) -> bool| -> Vec<&str> {
            others().filter(|other| is(past(other) / span)).map(|other| other.id.as_str()).collect()
        };
        let beyond = names(&|part| part > BEYOND);
        let at = names(&|part| part.abs() < AT);
        let (level, id) = (significant(level, 4), &glance.id);
        if !beyond.is_empty() {
            said.push(format!(
                "record {id}: its output rests at {level} {unit}, which {} {}: no limit of the sensor but a stop, another range, or an offset of record {id}; check what changed between them",
                beyond.join(", "),
                if beyond.len() > 1 { "pass" } else { "passes" }
            ));
        } else if !at.is_empty() {
            said.push(format!(
                "{} end at {level} {unit} too, where the output of record {id} rests: the range of the sensor ends there; widen it and record these again",
                at.join(", ")
            ));
        }
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::identify::BenchRecord;
    use std::f64::consts::TAU;

    /// Slow sines through a gain, with a lag.
    fn seen(id: &str, amplitude: f64, output: impl Fn(f64) -> f64) -> Glance {
        let command = |t: f64| 70.0 + amplitude * (TAU * t).sin();
        let times: Vec<f64> = (0..4000).map(|i| 1e-3 * f64::from(i)).collect();
        Glance::of(&BenchRecord {
            id: id.into(),
            time_step_s: 1e-3,
            voltage_volt: times.iter().map(|t| command(*t)).collect(),
            output_deg: times.iter().map(|t| output(command(t - 0.02))).collect(),
            ..BenchRecord::default()
        })
    }

    fn said(all: &[Glance]) -> String {
        compared(all, Subject::Displacement).join("\n")
    }

    #[test]
    fn records_that_belong_together_say_nothing() {
        let all = [
            seen("a", 60.0, |u| 2.0 * u),
            seen("b", 20.0, |u| 1.4 * u),
            seen("c", 40.0, |u| 2.6 * u + 50.0),
        ];
        assert_eq!(said(&all), "");
        // a mode may do anything
        for gain in [20.0, -2.0] {
            let fast = Glance { frequency_hz: Some(20.0), ..seen("d", 20.0, |u| gain * u) };
            assert_eq!(said(&[&all[..], &[fast]].concat()), "");
        }
        // all of them inverted: each says it by itself
        let all = [seen("a", 60.0, |u| -2.0 * u), seen("b", 20.0, |u| -1.9 * u)];
        assert_eq!(said(&all), "");
    }

    #[test]
    fn another_sign_and_another_gain_are_named() {
        let mut all = vec![
            seen("a", 60.0, |u| 2.0 * u),
            seen("b", 20.0, |u| -2.0 * u),
            seen("c", 30.0, |u| 2.1 * u),
        ];
        let text = said(&all);
        assert!(text.contains("falls as the command rises in b, and rises in a, c"), "{text}");
        all[1] = seen("b", 20.0, |u| 0.5 * u);
        let text = said(&all);
        assert!(text.starts_with("record b: 0.49"), "{text}");
        assert!(text.contains("changed places"), "the inverse of 2 um/V: {text}");
        all[1] = seen("b", 20.0, |u| 2000.0 * u);
        let text = said(&all);
        assert!(text.starts_with("record b: 198") && text.contains("another unit"), "{text}");
        assert!(!text.contains("changed places"), "{text}");
    }

    #[test]
    fn a_level_is_held_against_the_other_records() {
        let cut = |u: f64| (2.0 * u).min(180.0);
        let all = [seen("a", 60.0, cut), seen("b", 60.0, |u| 2.0 * u)];
        let text = said(&all);
        assert!(text.contains("record a: its output rests at 180 um, which b passes"), "{text}");
        // a wave that only just reaches the limit shows no flat of its own
        let all = [seen("a", 60.0, cut), seen("b", 20.0, |u| 2.0 * u)];
        let text = said(&all);
        assert!(text.contains("b end at 180 um too"), "{text}");
    }
}
