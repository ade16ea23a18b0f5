//! What a command does, found from its samples.

use crate::VoltageRange;
use crate::check::{extremes, largest_above};
use crate::identify::BenchRecord;
use crate::identify::records::fourier;
use crate::identify::records::repetition::{find_period, inner_stretch, steady_samples};
use crate::laws::play_map::split;
use rotor_base::wrap_degrees;
use serde::{Deserialize, Serialize};
use std::ops::Range;

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

impl BenchRecord {
    /// What the command does in the windows of the record; over all of it without any.
    pub fn drive(&self) -> Drive {
        let (trained, judged) = (self.trained_samples(), self.judged_samples());
        let window = trained.start.min(judged.start)..trained.end.max(judged.end);
        let u = &self.voltage_volt[window.clone()];
        let [low, high] = extremes(u.iter().copied());
        let mut drive = Drive {
            waveform: Waveform::Constant,
            base_hz: 0.0,
            strongest_harmonic: 1,
            amplitude_volt: 0.5 * (high - low),
            middle_volt: 0.5 * (high + low),
            steady: 0..0,
        };
        let Ok(swing) = VoltageRange::new(low, high) else {
            return drive;
        };
        let given = self.base_frequency_hz.map(|hz| 1.0 / (hz * self.time_step_s));
        let to_the_end = || {
            let period = given.or_else(|| find_period(u, swing))?;
            // a window may begin in the midst of cycles: the one before it is then the start-up
            let before = window.start.min(split(period).0 + 1);
            let wider = &self.voltage_volt[window.start - before..window.end];
            let steady = steady_samples(wider, period, drive.amplitude_volt)?;
            Some((period, steady.start.max(before) - before..steady.end - before))
        };
        if let Some((samples, steady)) = to_the_end().or_else(|| inner_stretch(u, given, swing)) {
            drive.base_hz = 1.0 / (samples * self.time_step_s);
            drive.steady = window.start + steady.start..window.start + steady.end;
            drive.find_harmonics(self);
        } else {
            let changes = || u.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let moves = changes().filter(|change| *change > 0.0).count().max(1);
            let speed = changes().sum::<f64>() / (moves as f64 * self.time_step_s);
            drive.waveform = Waveform::Transient;
            drive.base_hz = speed / (4.0 * drive.amplitude_volt);
        }
        drive
    }
}

impl Drive {
    fn find_harmonics(&mut self, record: &BenchRecord) {
        let count = self.harmonics_within(record.time_step_s, 8);
        let per_sample = self.base_hz * record.time_step_s;
        self.waveform = Waveform::Mix;
        let Ok(fit) = fourier::fit(&record.voltage_volt, self.steady.clone(), per_sample, count)
        else {
            return;
        };
        let powers: Vec<f64> = fit.series.harmonics.iter().map(|h| h.amplitude().powi(2)).collect();
        let total: f64 = powers.iter().sum();
        let (index, power) = largest_above(0.0, powers);
        self.strongest_harmonic = index + 1;
        if power >= SINGLE_SHARE * total {
            self.waveform = Waveform::SingleHarmonic;
        }
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
        let (periods, _) = split((available as f64 + 1.0) / period);
        let (samples, _) = split(periods as f64 * period + 0.5);
        (periods > 0).then(|| end - samples.min(available)..end)
    }

    /// How far the output lags the command at the strongest harmonic of the steady cycles, deg of
    /// harmonic phase, -180 to 180; none where the cycles cannot be fitted.
    pub fn lag_deg(&self, record: &BenchRecord) -> Option<f64> {
        let n = self.strongest_harmonic;
        let per_sample = self.base_hz * record.time_step_s;
        let count = self.harmonics_within(record.time_step_s, 8).max(n);
        let phase_deg = |values: &[f64]| {
            let fit = fourier::fit(values, self.steady.clone(), per_sample, count).ok()?;
            Some(fit.series.harmonic(n).phase_deg())
        };
        Some(wrap_degrees(phase_deg(&record.output_deg)? - phase_deg(&record.voltage_volt)?))
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
    pub(crate) fn harmonics_within(&self, time_step_s: f64, wanted: usize) -> usize {
        let most = (0.4 / (self.base_hz * time_step_s)).floor().min(wanted as f64);
        (most as usize).max(1)
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

    /// Two runs in one file, a rest between them: each window has its own frequency and amplitude.
    #[test]
    fn a_window_has_the_drive_of_its_samples() {
        let mut record = record(1e-3, 10.0, |t| match t {
            t if t < 4.0 => 65.0 + 60.0 * (TAU * t).sin(),
            t if t < 6.0 => 65.0,
            t => 65.0 + 20.0 * (TAU * 5.0 * (t - 6.0)).sin(),
        });
        for (window, hz, amplitude) in [(0..4000, 1.0, 60.0), (6000..10_000, 5.0, 20.0)] {
            record.windows.train = Some(window.clone());
            record.windows.judge = Some(window.clone());
            let drive = record.drive();
            assert_eq!(drive.waveform, Waveform::SingleHarmonic, "{drive:?}");
            assert!((drive.base_hz / hz - 1.0).abs() < 1e-3, "{drive:?}");
            assert!((drive.amplitude_volt - amplitude).abs() < 0.1, "{drive:?}");
            assert!(window.start <= drive.steady.start && drive.steady.end <= window.end);
            assert!(drive.steady_within(&window, 1e-3).is_some());
        }
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
