//! What a person checks at a glance of one record.

use measured_data::limits;
use preisach_dyn::identify::{BenchRecord, Drive, Finding, SplitRule, Subject, Waveform};
use rotor_base::{mean_square, rests, significant, wrap_degrees};
use serde::Serialize;
use std::f64::consts::TAU;
use std::ops::Range;

/// One record at a glance: what its command does, how the output follows, and what is suspect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Glance {
    /// The record.
    pub id: String,
    /// Shape of the command, in a word.
    pub signal: &'static str,
    /// Frequency of the strongest harmonic of a periodic command, Hz.
    pub frequency_hz: Option<f64>,
    /// Periods of it, rests left out.
    pub cycles: Option<f64>,
    /// Half peak to peak of the command, in the unit of the input.
    pub amplitude: f64,
    /// Middle between its extremes, in the unit of the input.
    pub middle: f64,
    /// Slope of the straight line through output over command; none at rest.
    pub slope: Option<f64>,
    /// Phase by which the output lags the command, of an inverted one turned, deg.
    pub lag_deg: Option<f64>,
    /// Rests of the command, s; none of a record that is one.
    pub rests_s: Vec<f64>,
    /// Length, s.
    pub duration_s: f64,
    /// Smallest and largest output, in its unit.
    pub output: (f64, f64),
    /// Whether the output runs through two cycles in each one of the command.
    pub is_butterfly: bool,
    /// What identification would say of it alone.
    pub findings: Vec<Finding>,
}

/// RMS over amplitude above which a wave is a square one, and a sine.
const SQUARE: f64 = 0.9;
const SINE: f64 = 0.65;

impl Glance {
    /// A record with its judged samples.
    pub fn of(given: &BenchRecord) -> Self {
        let without_spikes = given.without_spikes();
        let record = without_spikes.as_ref().map_or(given, |(record, _)| record);
        let drive = record.drive();
        let samples = record.judged_samples();
        let command = &record.voltage_volt[samples.clone()];
        let is_constant = drive.waveform == Waveform::Constant;
        let resting =
            if is_constant { Vec::new() } else { outside_cycles(command, &drive, record) };
        let step_s = record.time_step_s;
        let rested: usize = resting.iter().map(Range::len).sum();
        let moving_s = (samples.len() - rested) as f64 * step_s;
        let periodic = drive.is_periodic();
        let slope = (!is_constant).then(|| record.slope_deg_per_volt());
        let is_inverted = slope.is_some_and(|slope| slope < 0.0);
        let turned = |lag: f64| if is_inverted { wrap_degrees(lag - 180.0) } else { lag };
        let is_slow = SplitRule::default().is_quasi_static(&drive);
        Self {
            id: record.id.clone(),
            signal: signal(record, &drive),
            frequency_hz: periodic.then(|| drive.strongest_hz()),
            cycles: periodic.then_some(moving_s * drive.base_hz),
            amplitude: drive.amplitude_volt,
            middle: drive.middle_volt,
            slope,
            lag_deg: drive.lag_deg(record).filter(|_| periodic).map(turned),
            rests_s: resting.iter().map(|rest| rest.len() as f64 * step_s).collect(),
            duration_s: samples.len() as f64 * step_s,
            output: limits(&record.output_deg[samples]),
            is_butterfly: is_butterfly(record, &drive),
            findings: record
                .suspicions(is_slow)
                .into_iter()
                .chain(without_spikes.iter().flat_map(|(_, spikes)| spikes.clone()))
                .collect(),
        }
    }

    /// It in one line, in the units of the subject.
    pub fn line(&self, subject: Subject<'_>) -> String {
        let [input, output] = subject.units();
        let three = |value: f64| significant(value, 3);
        let mut line = self.signal.to_owned();
        if let (Some(hz), Some(cycles)) = (self.frequency_hz, self.cycles) {
            let cycles = (cycles * 10.0).round() / 10.0;
            let word = if (cycles - 1.0).abs() < 0.05 { "cycle" } else { "cycles" };
            line = format!("{line} {} Hz, {cycles} {word}", significant(hz, 4));
        }
        let middle = three(self.middle);
        line = if let Some(slope) = self.slope {
            let (amplitude, slope) = (three(self.amplitude), three(slope));
            format!("{line}, {amplitude} {input} about {middle} {input}; {slope} {output}/{input}")
        } else {
            let noise = self.findings.iter().find_map(|finding| match finding {
                Finding::ConstantCommand { noise, .. } => Some(noise.words(output)),
                _ => None,
            });
            format!("{line} {middle} {input}; {}", noise.unwrap_or_default())
        };
        if let Some(lag) = self.lag_deg {
            line = format!("{line}, lag {:.1} deg", lag + 0.0);
        }
        let longest = self.rests_s.iter().copied().fold(0.0, f64::max);
        line = match self.rests_s.len() {
            0 => line,
            1 => format!("{line}; rest {} s", three(longest)),
            count => format!("{line}; {count} rests, the longest {} s", three(longest)),
        };
        format!("{line}; {} s", significant(self.duration_s, 4))
    }
}

/// Whether the output has twice the frequency of the command, over its steady cycles: the second harmonic exceeds the
/// first, of a command in which it is small. A ceramic does so that is driven through its coercive field.
pub(crate) fn is_butterfly(record: &BenchRecord, drive: &Drive) -> bool {
    let per_sample = TAU * drive.base_hz * record.time_step_s;
    let size = |values: &[f64], order: f64| {
        let parts = drive.steady.clone().map(|i| {
            let (sin, cos) = (order * per_sample * i as f64).sin_cos();
            [values[i] * cos, values[i] * sin]
        });
        let [a, b] = parts.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        a.hypot(b)
    };
    let over = |values: &[f64]| {
        let mean = drive.steady.clone().map(|i| values[i]).sum::<f64>() / drive.steady.len() as f64;
        let about: Vec<f64> = values.iter().map(|value| value - mean).collect();
        size(&about, 2.0) / size(&about, 1.0)
    };
    let is_simple = drive.is_periodic() && drive.strongest_harmonic == 1;
    is_simple && over(&record.voltage_volt) < 0.1 && over(&record.output_deg) > 1.0
}

/// What to do with a butterfly.
pub(crate) const OF_BUTTERFLY: &str = "the output runs through two cycles in each cycle of the input: a butterfly, as of a ceramic driven through its coercive field. No model here holds one: in all of them the output rises with the input. Record one wing of it, between the turning points of the output";

/// The rests of a command that are no part of its cycles, as a cut top is, or half a square wave.
fn outside_cycles(command: &[f64], drive: &Drive, record: &BenchRecord) -> Vec<Range<usize>> {
    let all = rests(command);
    if !drive.is_periodic() {
        return all;
    }
    let period = 1.0 / (drive.base_hz * record.time_step_s);
    let is_inside = |rest: &Range<usize>| {
        rest.start > 0 && rest.end < command.len() && (rest.len() as f64) < period
    };
    let part = all.iter().filter(|rest| is_inside(rest)).map(Range::len).max().unwrap_or(0);
    // one at an end may be part of a cycle too
    all.into_iter().filter(|rest| rest.len() as f64 > 1.2 * part as f64).collect()
}

/// The shape of a command in a word.
fn signal(record: &BenchRecord, drive: &Drive) -> &'static str {
    let steady = record.voltage_volt.get(drive.steady.clone()).unwrap_or_default();
    let off: Vec<f64> = steady.iter().map(|u| u - drive.middle_volt).collect();
    let crest = mean_square(&off).sqrt() / drive.amplitude_volt;
    match drive.waveform {
        Waveform::Constant => "at rest",
        Waveform::Transient => "not periodic",
        Waveform::SingleHarmonic if crest > SINE => "sine",
        Waveform::SingleHarmonic => "triangle",
        Waveform::Mix if crest > SQUARE => "square",
        Waveform::Mix => "mix of harmonics",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn record(
        seconds: f64,
        command: impl Fn(f64) -> f64,
        output: impl Fn(f64) -> f64,
    ) -> BenchRecord {
        let times: Vec<f64> =
            (0..100_000).map(|i| 1e-3 * f64::from(i)).take_while(|t| *t < seconds).collect();
        BenchRecord {
            id: "r".into(),
            time_step_s: 1e-3,
            voltage_volt: times.iter().map(|t| command(*t)).collect(),
            output_deg: times.iter().map(|t| output(*t)).collect(),
            ..BenchRecord::default()
        }
    }

    /// After a rest of 0.3 s, 4 cycles of 60 V about 70 V; a gain of 2.27 and a lag of 7.6 deg.
    fn wave(gain: f64) -> BenchRecord {
        let phase = |t: f64| TAU * (t - 0.3).max(0.0);
        let lag = 7.6_f64.to_radians();
        record(
            4.3,
            |t| 70.0 + 60.0 * phase(t).sin(),
            |t| 100.0 + gain * 60.0 * (phase(t) - lag).sin(),
        )
    }

    /// A recorder writes -9999 where it has no sample: they are told, and the shape is that of the other samples.
    #[test]
    fn numbers_that_stand_for_none_are_spikes() {
        let whole = wave(2.29);
        let mut with_gaps = whole.clone();
        for sample in with_gaps.output_deg.iter_mut().skip(150).step_by(97) {
            *sample = -9999.0;
        }
        let (seen, of_whole) = (Glance::of(&with_gaps), Glance::of(&whole));
        assert!(!seen.is_butterfly, "{seen:?}");
        assert!((seen.slope.unwrap() - of_whole.slope.unwrap()).abs() < 1e-3, "{seen:?}");
        let spikes = seen.findings.iter().find_map(|finding| match finding {
            Finding::Spikes { samples, value, .. } => Some((*samples, *value)),
            _ => None,
        });
        let written = with_gaps.output_deg.iter().filter(|value| **value < -9000.0).count();
        assert_eq!(spikes, Some((written, -9999.0)));
    }

    #[test]
    fn a_line_says_what_a_person_checks() {
        let seen = Glance::of(&wave(2.29));
        assert_eq!(
            seen.line(Subject::Displacement),
            "sine 1 Hz, 4 cycles, 60 V about 70 V; 2.27 um/V, lag 7.6 deg; rest 0.307 s; 4.3 s"
        );
        assert!(seen.findings.is_empty(), "{:?}", seen.findings);
        let inverted = Glance::of(&wave(-2.29));
        let line = inverted.line(Subject::Displacement);
        assert!(line.contains("; -2.27 um/V, lag 7.6 deg"), "{line}");
        assert!(
            matches!(&inverted.findings[..], [Finding::OutputFalls { slope, .. }] if *slope < -2.0)
        );
        let clipped = record(
            4.0,
            |t| (65.0 + 60.0 * (TAU * t).sin()).min(110.0),
            |t| (65.0 + 60.0 * (TAU * t - 0.1).sin()).min(110.0),
        );
        let seen = Glance::of(&clipped);
        assert!(matches!(&seen.findings[..], [Finding::Clipped { .. }, ..]), "{:?}", seen.findings);
        let line = seen.line(Subject::Displacement);
        assert!(line.starts_with("sine 1 Hz, 4 cycles") && !line.contains("rest"), "{line}");
    }

    #[test]
    fn shapes_have_their_words() {
        let of = |command: fn(f64) -> f64| {
            Glance::of(&record(6.0, command, command)).line(Subject::Displacement)
        };
        let triangle = of(|t| 40.0 * (2.0 * t.rem_euclid(1.0) - 1.0).abs());
        assert!(triangle.starts_with("triangle 1 Hz"), "{triangle}");
        let square = of(|t| if t.rem_euclid(1.0) < 0.5 { 40.0 } else { 0.0 });
        assert!(square.starts_with("square 1 Hz, 6 cycles"), "{square}");
        let ramp = of(|t| 10.0 * t);
        assert!(ramp.starts_with("not periodic, 30 V about 30 V; 1 um/V"), "{ramp}");
        let rest = record(6.0, |_| 65.0, |t| 200.0 + 0.1 * (37.0 * t).sin());
        let seen = Glance::of(&rest);
        let line = seen.line(Subject::Displacement);
        assert!(line.starts_with("at rest 65 V; noise 0.07"), "{line}");
        assert!(line.contains("drift "), "{line}");
        assert!(matches!(&seen.findings[..], [Finding::ConstantCommand { .. }]));
    }
}
