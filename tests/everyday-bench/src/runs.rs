//! Which runs the two folders hold.

use crate::draw::Draw;
use crate::waveform::Waveform;

/// Bias of all runs, V.
pub const BIAS_VOLT: f64 = 65.0;

/// Voltages the actuator may see, V.
pub const RANGE_VOLT: (f64, f64) = (-20.0, 150.0);

/// Largest deviation from the bias inside the range, V.
pub(crate) const FULL_VOLT: f64 = 85.0;

/// Largest deviation of reference runs of [`Drive::Small`], V.
const SMALL_VOLT: f64 = 25.0;

/// How far the reference runs are driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Drive {
    /// Over the whole range.
    #[default]
    Full,
    /// 25 V about the bias, so that measured runs leave what the reference runs have seen.
    Small,
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Unique id, also the name of the file.
    pub id: String,
    /// Rate of the record, Hz.
    pub rate_hz: u32,
    /// The command without its bias.
    pub waveform: Waveform,
    /// What the waveform is multiplied with.
    pub factor: f64,
}

impl Run {
    fn new(id: &str, rate_hz: u32, waveform: Waveform) -> Self {
        Self { id: id.to_owned(), rate_hz, waveform, factor: 1.0 }
    }

    /// Number of samples of the record.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a duration times a rate is a small positive number"
    )]
    pub fn samples(&self) -> usize {
        (self.waveform.duration_s() * f64::from(self.rate_hz) + 1e-6).floor() as usize + 1
    }

    /// The command at `count` instants, `dt_s` apart; V.
    pub fn command_volt(&self, dt_s: f64, count: usize) -> Vec<f64> {
        let deviation = self.waveform.sample(dt_s, count);
        deviation.into_iter().map(|v| BIAS_VOLT + self.factor * v).collect()
    }

    /// Whether the command moves for most of the time.
    pub fn is_driven(&self) -> bool {
        self.id != ZERO_INPUT
    }

    fn held_within(mut self, limit_volt: f64) -> Self {
        let count = self.samples();
        let values = self.waveform.sample(1.0 / f64::from(self.rate_hz), count);
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        self.factor = (limit_volt / largest.max(limit_volt)).min(1.0);
        self
    }
}

/// Id of the run at rest.
const ZERO_INPUT: &str = "zero_input";

/// A multisine of an actuator; `number` chooses its phases.
fn multisine(seed: u64, number: u64, peak_volt: f64, seconds: f64) -> Waveform {
    let (low_hz, high_hz, spacing_hz) = (1.0, 35.0, 0.5);
    Waveform::Multisine { low_hz, high_hz, spacing_hz, peak_volt, seconds, keys: [seed, number] }
}

fn wide_band(seed: u64, number: u64, peak_volt: f64, seconds: f64) -> Waveform {
    let (low_hz, high_hz, spacing_hz) = (5.0, 181.0, 2.0);
    Waveform::Multisine { low_hz, high_hz, spacing_hz, peak_volt, seconds, keys: [seed, number] }
}

fn sine(frequency_hz: f64, bursts: &[(f64, u32)]) -> Waveform {
    Waveform::Bursts { frequency_hz, bursts: bursts.to_vec() }
}

/// The ten runs of the reference folder, about 27 000 samples.
pub fn reference(seed: u64, drive: Drive) -> Vec<Run> {
    let mut draw = Draw::new("levels", &[seed]);
    let reversals: Vec<f64> = (1..=8)
        .flat_map(|i| [FULL_VOLT, FULL_VOLT - 2.0 * FULL_VOLT * f64::from(i) / 8.0])
        .chain([FULL_VOLT])
        .collect();
    let levels = [45.0, -35.0, 80.0, -80.0, 20.0, 0.0].map(|v| v * draw.uniform(0.85, 1.0));
    let runs = [
        Run::new("reversals", 250, Waveform::ramps(120.0, &reversals)),
        Run::new("major", 250, Waveform::triangles(0.25, &[FULL_VOLT, FULL_VOLT])),
        Run::new("sine_1hz_60v", 500, sine(1.0, &[(60.0, 4)])),
        Run::new("sine_10hz_60v", 1000, sine(10.0, &[(60.0, 15)])),
        Run::new("sine_10hz_25v", 1000, sine(10.0, &[(25.0, 15)])),
        Run::new("multisine_80v", 1000, multisine(seed, 1, 80.0, 4.0)),
        Run::new("multisine_35v", 1000, multisine(seed, 2, 35.0, 4.0)),
        Run::new("wide_band_25v", 2000, wide_band(seed, 3, 25.0, 2.0)),
        Run::new("steps", 500, Waveform::steps(&levels, 1.0)),
        Run::new("triangle", 250, Waveform::triangles(0.5, &[70.0, 40.0])),
    ];
    match drive {
        Drive::Full => runs.to_vec(),
        Drive::Small => runs.map(|run| run.held_within(SMALL_VOLT)).to_vec(),
    }
}

/// The nine runs of the measured folder, about 26 000 samples; the last repeats a reference run.
pub fn measured(seed: u64, drive: Drive) -> Vec<Run> {
    let levels = [50.0, -40.0, 75.0, -75.0, 0.0];
    let mut runs = vec![
        Run::new("triangles", 500, Waveform::triangles(1.0, &[FULL_VOLT, 60.0, 30.0])),
        Run::new("multisine_75v", 1000, multisine(seed, 11, 75.0, 3.0)),
        Run::new("multisine_30v", 1000, multisine(seed, 12, 30.0, 3.0)),
        Run::new("wide_band_20v", 2000, wide_band(seed, 13, 20.0, 1.6)),
        Run::new("long_steps", 250, Waveform::steps(&levels, 1.5)),
        Run::new("bursts_10hz", 1000, sine(10.0, &[(20.0, 5), (50.0, 5), (80.0, 5)])),
        Run::new("warm_up", 200, sine(20.0, &[(75.0, 500), (25.0, 300)])),
        Run::new(ZERO_INPUT, 1000, Waveform::pulse(1.2, 60.0)),
    ];
    let repeated = ["sine_10hz_60v", "sine_1hz_60v", "triangle"];
    let which = repeated[Draw::new("repeated", &[seed]).below(repeated.len())];
    let again = reference(seed, drive).into_iter().filter(|run| run.id == which);
    runs.extend(again.map(|run| Run { id: format!("again_{which}"), ..run }));
    runs
}
