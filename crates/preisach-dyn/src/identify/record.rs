//! Bench records and what their command tells about them.

use crate::actuator::{SAMPLE_TOLERANCE, check_positive};
use crate::{PreisachError, VoltageRange};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Whether a record trains the model or tests it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordUse {
    /// The identification may look at it.
    Train,
    /// Kept aside; only the finished model is compared with it.
    HeldOut,
}

/// The parts of a record that train and that judge, as samples.
///
/// Whatever they are, a record is always simulated from its first sample, so that the memory is what
/// the whole history made of it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordWindows {
    /// Samples that train; none: all of them.
    pub train: Option<Range<usize>>,
    /// Samples the model is judged by; none: all of them.
    pub judge: Option<Range<usize>>,
}

/// One bench record: equally spaced samples of command and output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BenchRecord {
    /// Name, used in reports and messages.
    pub id: String,
    /// Time between samples, s.
    pub time_step_s: f64,
    /// Command, V.
    pub voltage_volt: Vec<f64>,
    /// Measured output as equivalent flap angle, deg: displacement times the bench gain.
    pub output_deg: Vec<f64>,
    /// Training or test; none leaves it to [`SplitRule`].
    pub record_use: Option<RecordUse>,
    /// Frequency of the command's period, Hz; none has it found from the command.
    pub base_frequency_hz: Option<f64>,
    /// Parts that train and judge.
    pub windows: RecordWindows,
}

/// The fewest samples a record may have.
const FEWEST_SAMPLES: usize = 16;

impl BenchRecord {
    /// Checks lengths, numbers and range.
    ///
    /// # Errors
    /// [`PreisachError::UnequalColumns`], [`PreisachError::TooFew`],
    /// [`PreisachError::NotPositive`], [`PreisachError::BadRecord`].
    pub fn check(&self, range: VoltageRange) -> Result<(), PreisachError> {
        let (voltages, outputs) = (self.voltage_volt.len(), self.output_deg.len());
        if voltages != outputs {
            return Err(PreisachError::UnequalColumns { id: self.id.clone(), voltages, outputs });
        }
        if voltages < FEWEST_SAMPLES {
            return Err(PreisachError::TooFew {
                quantity: "samples of a record",
                value: voltages,
                least: FEWEST_SAMPLES,
            });
        }
        check_positive("time_step_s", self.time_step_s)?;
        if let Some(hz) = self.base_frequency_hz {
            check_positive("base_frequency_hz", hz)?;
        }
        let bad = |index: usize, problem: &'static str, value: f64| {
            Err(PreisachError::BadRecord { id: self.id.clone(), index, problem, value })
        };
        let tolerance = SAMPLE_TOLERANCE * range.span_volt();
        for (index, (&u, &y)) in self.voltage_volt.iter().zip(&self.output_deg).enumerate() {
            if !u.is_finite() {
                return bad(index, "the voltage is not a finite number", u);
            }
            if !y.is_finite() {
                return bad(index, "the output is not a finite number", y);
            }
            if range.excess_volt(u) > tolerance {
                return bad(index, "the voltage is outside the actuator's range", u);
            }
        }
        if spread(&self.output_deg) == 0.0 {
            return bad(0, "the output never changes", self.output_deg[0]);
        }
        for window in [&self.windows.train, &self.windows.judge].into_iter().flatten() {
            if window.end > outputs || window.len() < FEWEST_SAMPLES {
                return Err(PreisachError::BadWindow {
                    id: self.id.clone(),
                    start: window.start,
                    end: window.end,
                    samples: outputs,
                });
            }
        }
        Ok(())
    }

    /// The samples that train.
    pub fn trained_samples(&self) -> Range<usize> {
        self.windows.train.clone().unwrap_or(0..self.output_deg.len())
    }

    /// The samples the model is judged by.
    pub fn judged_samples(&self) -> Range<usize> {
        self.windows.judge.clone().unwrap_or(0..self.output_deg.len())
    }

    /// What the command does.
    pub fn drive(&self) -> Drive {
        Drive::of(self)
    }
}

/// Standard deviation.
pub(super) fn spread(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// The shape of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Waveform {
    /// The voltage never changes.
    Constant,
    /// Periodic, one harmonic carries nearly all of it (sine or triangle).
    SingleHarmonic,
    /// Periodic, several harmonics.
    Mix,
    /// Not periodic: reversal curves, steps, fewer than two periods.
    Transient,
}

/// What a command does, found from its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Its shape.
    pub waveform: Waveform,
    /// Frequency of its period, Hz; for a transient the mean slope over four amplitudes, which is
    /// the frequency of a triangle of the same speed; 0 for a constant.
    pub base_hz: f64,
    /// The strongest harmonic of the period; 1 for a transient.
    pub strongest_harmonic: usize,
    /// Half peak to peak, V.
    pub amplitude_volt: f64,
    /// Middle between the extremes, V.
    pub middle_volt: f64,
    /// Samples of whole steady periods, the start-up period left out; empty unless periodic.
    pub steady: Range<usize>,
}

/// Share of the power one harmonic must carry to count as the only one.
const SINGLE_SHARE: f64 = 0.95;
/// Mismatch between periods that still counts as periodic, as a share of the amplitude.
const PERIODIC_MISMATCH: f64 = 0.02;

impl Drive {
    fn of(record: &BenchRecord) -> Self {
        let u = &record.voltage_volt;
        let (low, high) =
            u.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
        let mut drive = Self {
            waveform: Waveform::Constant,
            base_hz: 0.0,
            strongest_harmonic: 1,
            amplitude_volt: 0.5 * (high - low),
            middle_volt: 0.5 * (high + low),
            steady: 0..0,
        };
        if drive.amplitude_volt <= 0.0 {
            return drive;
        }
        let given = record.base_frequency_hz.map(|hz| 1.0 / (hz * record.time_step_s));
        let to_the_end = || {
            let period = given.or_else(|| find_period(u, &drive))?;
            Some((period, steady_samples(u, period, drive.amplitude_volt)?))
        };
        if let Some((samples, steady)) = to_the_end().or_else(|| inner_stretch(u, given, &drive)) {
            drive.base_hz = 1.0 / (samples * record.time_step_s);
            drive.steady = steady;
            drive.find_harmonics(record);
        } else {
            let moving: f64 = u.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
            let moves = u.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 0.0).count().max(1);
            let speed = moving / (moves as f64 * record.time_step_s);
            drive.waveform = Waveform::Transient;
            drive.base_hz = speed / (4.0 * drive.amplitude_volt);
        }
        drive
    }

    fn find_harmonics(&mut self, record: &BenchRecord) {
        let count = 8.min(self.harmonics_within(record.time_step_s, 8));
        let Ok(fit) = super::fourier::fit(
            &record.voltage_volt,
            self.steady.clone(),
            self.base_hz * record.time_step_s,
            count,
        ) else {
            self.waveform = Waveform::Mix;
            return;
        };
        let powers: Vec<f64> = fit.series.harmonics.iter().map(|h| h.amplitude().powi(2)).collect();
        let total: f64 = powers.iter().sum();
        let (index, power) = powers
            .iter()
            .copied()
            .enumerate()
            .fold((0, 0.0), |best, now| if now.1 > best.1 { now } else { best });
        self.strongest_harmonic = index + 1;
        self.waveform =
            if power >= SINGLE_SHARE * total { Waveform::SingleHarmonic } else { Waveform::Mix };
    }

    /// The last whole steady periods inside a window; none if there is not one.
    pub fn steady_within(&self, window: &Range<usize>, time_step_s: f64) -> Option<Range<usize>> {
        if !self.is_periodic() {
            return None;
        }
        let (start, end) = (self.steady.start.max(window.start), self.steady.end.min(window.end));
        let period = 1.0 / (self.base_hz * time_step_s);
        let available = end.saturating_sub(start);
        // a period found from samples is a little off: a sample short still counts as whole
        let (periods, _) = crate::play_map::split((available as f64 + 1.0) / period);
        let (samples, _) = crate::play_map::split(periods as f64 * period + 0.5);
        (periods > 0).then(|| end - samples.min(available)..end)
    }

    /// Frequency of the strongest harmonic, Hz.
    pub fn strongest_hz(&self) -> f64 {
        self.base_hz * self.strongest_harmonic as f64
    }

    /// Whether it repeats.
    pub fn is_periodic(&self) -> bool {
        matches!(self.waveform, Waveform::SingleHarmonic | Waveform::Mix)
    }

    /// The number of harmonics of the period, at most `wanted`, that stay below 0.4 times the
    /// sampling frequency.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive and held below `wanted`"
    )]
    pub(super) fn harmonics_within(&self, time_step_s: f64, wanted: usize) -> usize {
        let most = (0.4 / (self.base_hz * time_step_s)).floor().min(wanted as f64);
        (most as usize).max(1)
    }
}

/// Upward crossings of the middle level from a sample on, in samples.
fn crossings(u: &[f64], first: usize, drive: &Drive) -> Vec<f64> {
    let band = 0.1 * drive.amplitude_volt;
    let mut armed = false;
    let mut found = Vec::new();
    for i in first..u.len() - 1 {
        let (a, b) = (u[i] - drive.middle_volt, u[i + 1] - drive.middle_volt);
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
fn find_period(u: &[f64], drive: &Drive) -> Option<f64> {
    // the later part of the record: rests and fade-ins come first
    let first = u.len() * 2 / 5;
    let crossings = crossings(u, first, drive);
    // a period may hold several crossings
    (1..=MOST_CROSSINGS.min(crossings.len().saturating_sub(1))).find_map(|per_period| {
        let periods = (crossings.len() - 1) / per_period;
        let last = crossings.len() - 1;
        let period = (crossings[last] - crossings[last - periods * per_period]) / periods as f64;
        let repeats = mismatch(u, first, period)? <= PERIODIC_MISMATCH * drive.amplitude_volt;
        repeats.then_some(period)
    })
}

/// Share of a record that must repeat if its end does not.
const LEAST_STEADY: f64 = 0.25;

/// Period and whole periods of a command that repeats between a fade-in and a fade-out, one period
/// fewer than there are; none unless two periods or more and a quarter of the record repeat.
fn inner_stretch(u: &[f64], given: Option<f64>, drive: &Drive) -> Option<(f64, Range<usize>)> {
    let crossings = crossings(u, 0, drive);
    let per_period = 1..=MOST_CROSSINGS.min(crossings.len().saturating_sub(1));
    let medians = per_period.map(|count| {
        let mut spans: Vec<f64> =
            crossings.iter().zip(&crossings[count..]).map(|(a, b)| b - a).collect();
        spans.sort_by(f64::total_cmp);
        spans[spans.len() / 2]
    });
    let candidates: Vec<f64> = given.map_or_else(|| medians.collect(), |period| vec![period]);
    let allowed = 3.0 * PERIODIC_MISMATCH * drive.amplitude_volt;
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
        let (samples, _) = crate::play_map::split(median);
        let end = longest.end + samples;
        let enough = end as f64 - longest.start as f64 >= LEAST_STEADY * u.len() as f64;
        if !enough || (longest.len() as f64) < median || rests(&u[longest.start..end], drive) {
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
        let (periods, _) = crate::play_map::split((end - longest.start) as f64 / period);
        let (used, _) = crate::play_map::split((periods.max(2) - 1) as f64 * period + 0.5);
        // a period less than there are, in the middle: the tolerance lets in a little of the fades
        let start = longest.start + (end - longest.start).saturating_sub(used) / 2;
        (periods >= 2).then(|| (period, start..(start + used).min(end)))
    })
}

/// Whether the command does not use half its amplitude: a rest repeats at any period.
fn rests(u: &[f64], drive: &Drive) -> bool {
    let (low, high) =
        u.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    0.5 * (high - low) < 0.5 * drive.amplitude_volt
}

/// Root mean square of `u(i + period) - u(i)` from `first` on; none if less than half a period is
/// left to compare.
fn mismatch(u: &[f64], first: usize, period: f64) -> Option<f64> {
    let pairs: Vec<f64> = (first..u.len()).map_while(|i| later(u, i, period)).collect();
    if (pairs.len() as f64) < 0.5 * period {
        return None;
    }
    let sum: f64 = pairs.iter().enumerate().map(|(k, v)| (v - u[first + k]).powi(2)).sum();
    Some((sum / pairs.len() as f64).sqrt())
}

/// `u` a period after sample `index`, by linear interpolation.
fn later(u: &[f64], index: usize, period: f64) -> Option<f64> {
    let (whole, part) = crate::play_map::split(period);
    let a = u.get(index + whole)?;
    let b = if part > 0.0 { u.get(index + whole + 1)? } else { a };
    Some(a + part * (b - a))
}

/// The last whole periods of a record over which the command repeats, the first one left out if
/// there are at least two.
fn steady_samples(u: &[f64], period: f64, amplitude: f64) -> Option<Range<usize>> {
    let allowed = 3.0 * PERIODIC_MISMATCH * amplitude;
    let last_pair = (0..u.len()).rev().find(|&i| later(u, i, period).is_some())?;
    let repeats = |i: usize| later(u, i, period).is_some_and(|v| (v - u[i]).abs() <= allowed);
    let begin = (0..=last_pair).rev().take_while(|&i| repeats(i)).last()?;
    let (periods, _) = crate::play_map::split((u.len() - begin) as f64 / period + 1e-6);
    let used = if periods >= 2 { periods - 1 } else { periods };
    if used == 0 {
        return None;
    }
    let (samples, _) = crate::play_map::split(used as f64 * period + 0.5);
    Some(u.len() - samples..u.len())
}

/// Which records train and which test, where the data set does not say.
///
/// Trained: everything quasi-static, and single-harmonic records at `trained_hz` whose amplitude is
/// the largest or the smallest of that frequency. Everything else is held out: by experiment, never
/// by sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SplitRule {
    /// Up to this frequency a record is quasi-static, Hz.
    pub quasi_static_hz: f64,
    /// Frequencies to train at, Hz.
    pub trained_hz: Vec<f64>,
}

impl Default for SplitRule {
    /// Quasi-static to 0.5 Hz; trained at 1 and 10 Hz, the paper's choice.
    fn default() -> Self {
        Self { quasi_static_hz: 0.5, trained_hz: vec![1.0, 10.0] }
    }
}

impl SplitRule {
    /// Whether a command is quasi-static.
    pub fn is_quasi_static(&self, drive: &Drive) -> bool {
        drive.strongest_hz() <= self.quasi_static_hz
    }

    /// The use of every record, in order; what a record says itself goes first.
    pub fn uses(&self, records: &[BenchRecord], drives: &[Drive]) -> Vec<RecordUse> {
        let near = |drive: &Drive, hz: f64| {
            drive.waveform == Waveform::SingleHarmonic
                && (drive.strongest_hz() / hz - 1.0).abs() <= 0.05
        };
        records
            .iter()
            .zip(drives)
            .map(|(record, drive)| {
                if let Some(given) = record.record_use {
                    return given;
                }
                let extreme = self.trained_hz.iter().any(|&hz| {
                    let amplitudes =
                        drives.iter().filter(|d| near(d, hz)).map(|d| d.amplitude_volt);
                    let (low, high) =
                        amplitudes.fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(a), h.max(a)));
                    let own = drive.amplitude_volt;
                    near(drive, hz) && (own <= 1.02 * low || own >= 0.98 * high)
                });
                if extreme || (self.is_quasi_static(drive) && drive.waveform != Waveform::Constant)
                {
                    RecordUse::Train
                } else {
                    RecordUse::HeldOut
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn record(time_step_s: f64, seconds: f64, voltage: impl Fn(f64) -> f64) -> BenchRecord {
        let mut voltage_volt = Vec::new();
        while voltage_volt.len() as f64 * time_step_s <= seconds {
            voltage_volt.push(voltage(voltage_volt.len() as f64 * time_step_s));
        }
        BenchRecord {
            id: "test".into(),
            time_step_s,
            output_deg: voltage_volt.clone(),
            voltage_volt,
            ..BenchRecord::default()
        }
    }

    #[test]
    fn a_sine_after_a_rest_is_found_with_its_steady_cycles() {
        // 15 Hz at 2 kHz: 133.33 samples per period
        let rest = |t: f64| (TAU * 15.0 * (t - 0.25).max(0.0)).sin();
        let drive = record(5e-4, 1.0, |t| 65.0 + 40.0 * rest(t)).drive();
        assert_eq!(drive.waveform, Waveform::SingleHarmonic);
        assert!((drive.base_hz - 15.0).abs() < 1e-3, "{drive:?}");
        assert!((drive.amplitude_volt - 40.0).abs() < 0.1);
        // 0.75 s hold 11 periods; the first is left out
        assert_eq!(drive.steady, 2001 - 1333..2001);
    }

    #[test]
    fn a_mix_has_the_period_of_the_revolution() {
        let mix = |t: f64| {
            let psi = TAU * 5.0 * t;
            65.0 + 30.0 * (2.0 * psi).cos()
                + 30.0 * (3.0 * psi - 1.2).cos()
                + 20.0 * (4.0 * psi).sin()
        };
        let drive = record(1e-3, 1.6, mix).drive();
        assert_eq!(drive.waveform, Waveform::Mix);
        assert!((drive.base_hz - 5.0).abs() < 1e-3, "{drive:?}");
        assert!([2, 3].contains(&drive.strongest_harmonic));
    }

    #[test]
    fn triangles_steps_and_constants_are_told_apart() {
        let triangle = |t: f64| {
            let phase = (0.2 * t).fract();
            65.0 + 85.0 * (1.0 - 4.0 * (phase - 0.5).abs())
        };
        let drive = record(5e-3, 20.0, triangle).drive();
        assert_eq!(drive.waveform, Waveform::SingleHarmonic);
        assert!((drive.base_hz - 0.2).abs() < 1e-4, "{drive:?}");
        // one sweep: no period to find, the speed of a 0.2 Hz triangle
        let drive = record(5e-3, 2.4, triangle).drive();
        assert_eq!(drive.waveform, Waveform::Transient);
        assert!((drive.base_hz - 0.2).abs() < 0.01, "{drive:?}");
        let drive = record(5e-3, 2.0, |_| 65.0).drive();
        assert_eq!((drive.waveform, drive.base_hz), (Waveform::Constant, 0.0));
        // a drifting frequency does not repeat
        let drive = record(1e-3, 5.0, |t| 65.0 + 50.0 * (TAU * (t + 0.3 * t * t)).sin()).drive();
        assert_eq!(drive.waveform, Waveform::Transient);
    }

    #[test]
    fn a_command_that_fades_in_and_out_has_the_frequency_of_its_steady_part() {
        // two periods up, three steady, two down, as a test machine is run
        let fading = |t: f64| {
            let n = 0.25 * t;
            let gain = (n / 2.25).min((7.0 - n) / 1.75).clamp(0.0, 1.0);
            gain * (TAU * n).sin()
        };
        let drive = record(1.0 / 256.0, 28.0, fading).drive();
        assert_eq!(drive.waveform, Waveform::SingleHarmonic, "{drive:?}");
        assert!((drive.base_hz - 0.25).abs() < 5e-4, "{drive:?}");
        let [start, end] = [drive.steady.start, drive.steady.end].map(|i| i as f64 / 256.0);
        assert!(start > 9.0 && end < 21.0 && end - start > 7.9, "{start} to {end} s");
        // ever larger to the end: nothing repeats
        let growing = record(1.0 / 256.0, 28.0, |t| t * (TAU * 0.25 * t).sin()).drive();
        assert_eq!(growing.waveform, Waveform::Transient);
    }

    #[test]
    fn a_given_frequency_is_used() {
        let mut sine = record(1e-3, 3.0, |t| 65.0 + 50.0 * (TAU * 2.0 * t).sin());
        sine.base_frequency_hz = Some(1.0);
        let drive = sine.drive();
        assert!((drive.base_hz - 1.0).abs() < 1e-12 && drive.strongest_harmonic == 2, "{drive:?}");
    }
}
