//! Which runs a set has: reference folder, designs of the measured folder, further experiments.

use super::draw::{Draw, Purpose};
use super::waveform::Waveform;
use crate::error::TruthError;

/// Bias of all runs, V.
pub const BIAS_VOLT: f64 = 65.0;

/// Voltages the actuator may see, V.
pub const RANGE_VOLT: (f64, f64) = (-20.0, 150.0);

/// What is fitted to the actuator besides the command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fitting {
    /// Nothing.
    Plain,
    /// A known spring in parallel, as a share of the actuator's stiffness.
    Spring(f64),
    /// A preload: no play, more friction.
    Preload,
    /// An ideal displacement sensor instead of the usual one.
    Laser,
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Unique id, also the name of the file.
    pub id: String,
    /// Rate of the record, Hz.
    pub rate_hz: u32,
    /// The command.
    pub waveform: Waveform,
    /// What is fitted to the actuator.
    pub fitting: Fitting,
}

/// The columns that are recorded besides time, command and displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Monitors {
    /// `amplifier_V`.
    pub amplifier: Monitor,
    /// `temperature_C`.
    pub temperature: Monitor,
    /// `load_N`.
    pub load: Monitor,
}

/// Whether a quantity is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Monitor {
    /// It is not.
    #[default]
    Absent,
    /// It is a column of every run.
    Recorded,
}

impl Monitors {
    /// All three.
    pub const ALL: Self = Self {
        amplifier: Monitor::Recorded,
        temperature: Monitor::Recorded,
        load: Monitor::Recorded,
    };
}

/// A design of the measured folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Design {
    /// Every kind of run that a cause of the library needs.
    Recommended,
    /// Multisines 1-35 Hz at two amplitudes.
    Multisine,
    /// Sines of five frequencies at two amplitudes.
    TwoAmplitudeSines,
    /// Triangle, multisine, steps, sines; nothing above 35 Hz.
    Mixed,
    /// Sines of five frequencies at one amplitude.
    OneAmplitudeSines,
}

/// Number of bases.
pub const BASES: u64 = 12;

impl Design {
    /// Design and monitors of a base.
    pub fn of_base(base: u64) -> (Self, Monitors) {
        let nothing = Monitors::default();
        match base % BASES {
            0..=3 => (Self::Recommended, Monitors::ALL),
            4..=6 => (Self::Recommended, nothing),
            7 | 8 => (Self::Multisine, nothing),
            9 => (Self::TwoAmplitudeSines, nothing),
            10 => (Self::Mixed, nothing),
            _ => (Self::OneAmplitudeSines, nothing),
        }
    }

    /// The id in files.
    pub fn id(self) -> &'static str {
        match self {
            Self::Recommended => "recommended",
            Self::Multisine => "multisine",
            Self::TwoAmplitudeSines => "two-amplitude-sines",
            Self::Mixed => "mixed",
            Self::OneAmplitudeSines => "one-amplitude-sines",
        }
    }
}

/// How long the records are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// About 5e4 samples in both folders.
    Small,
    /// 20 runs, about 5e5 samples in both folders.
    Full,
}

fn plan(id: &str, rate_hz: u32, waveform: Waveform) -> Plan {
    Plan { id: id.to_owned(), rate_hz, waveform, fitting: Fitting::Plain }
}

/// A multisine whose phases belong to the base and to its number there.
fn multisine(
    base: u64,
    number: u64,
    band_hz: (f64, f64),
    peak_volt: f64,
    seconds: f64,
) -> Waveform {
    Waveform::Multisine {
        low_hz: band_hz.0,
        high_hz: band_hz.1,
        spacing_hz: if band_hz.1 > 100.0 { 2.0 } else { 0.5 },
        peak_volt,
        seconds,
        key: 100 * base + number,
    }
}

const FLAP_BAND_HZ: (f64, f64) = (1.0, 35.0);
const WIDE_BAND_HZ: (f64, f64) = (5.0, 181.0);

/// The runs of the reference folder of a base.
pub fn reference(base: u64, size: Size) -> Vec<Plan> {
    let reversals: Vec<f64> = (0..8)
        .flat_map(|i| [RANGE_VOLT.1, RANGE_VOLT.1 - 170.0 * f64::from(i + 1) / 8.0])
        .chain([RANGE_VOLT.1])
        .collect();
    let mut draw = Draw::new(Purpose::Run, &[base]);
    let levels: Vec<f64> = [40.0, -30.0, 75.0, -75.0, 15.0, 0.0]
        .iter()
        .map(|level| BIAS_VOLT + level * draw.uniform(0.85, 1.0))
        .collect();
    let mut runs = vec![
        plan("reversals", 250, Waveform::ramps(BIAS_VOLT, 120.0, &reversals)),
        plan("major", 250, Waveform::triangles(BIAS_VOLT, 0.25, &[85.0, 85.0])),
        plan("sine_1hz_60v", 500, bursts(1.0, BIAS_VOLT, &[(60.0, 4)])),
        plan("sine_10hz_60v", 1000, bursts(10.0, BIAS_VOLT, &[(60.0, 15)])),
        plan("sine_10hz_25v", 1000, bursts(10.0, BIAS_VOLT, &[(25.0, 15)])),
        plan("flap_band_80v", 1000, multisine(base, 1, FLAP_BAND_HZ, 80.0, 4.0)),
        plan("flap_band_35v", 1000, multisine(base, 2, FLAP_BAND_HZ, 35.0, 4.0)),
        plan("wide_band_25v", 2000, multisine(base, 3, WIDE_BAND_HZ, 25.0, 2.0)),
        plan("steps", 500, Waveform::steps(BIAS_VOLT, &levels, 1.0)),
    ];
    if size == Size::Full {
        lengthen(&mut runs, base, 40);
    }
    runs
}

/// Samples of each folder of a full set, about.
const FULL_SAMPLES: f64 = 250_000.0;

/// Further multisines, until there are ten runs with the samples of a full set.
fn lengthen(runs: &mut Vec<Plan>, base: u64, first_number: u64) {
    let samples = |plan: &Plan| plan.waveform.duration_s() * f64::from(plan.rate_hz);
    let missing = FULL_SAMPLES - runs.iter().map(samples).sum::<f64>();
    let added = 10_usize.saturating_sub(runs.len()).max(1) as u64;
    for number in 0..added {
        let peak_volt = if number == 0 { 80.0 } else { 45.0 };
        let seconds = (missing / added as f64 / 1000.0).floor();
        let band = multisine(base, first_number + number, FLAP_BAND_HZ, peak_volt, seconds);
        runs.push(plan(&format!("long_{}", number + 1), 1000, band));
    }
}

fn bursts(frequency_hz: f64, mean_volt: f64, bursts: &[(f64, u32)]) -> Waveform {
    Waveform::Bursts { frequency_hz, mean_volt, bursts: bursts.to_vec() }
}

fn sines(amplitude_volt: f64) -> Vec<Plan> {
    [(1.0, 3), (5.0, 10), (10.0, 20), (20.0, 40), (35.0, 70)]
        .into_iter()
        .map(|(frequency_hz, cycles)| {
            let id = format!("sine_{frequency_hz}hz_{amplitude_volt}v");
            plan(&id, 1000, bursts(frequency_hz, BIAS_VOLT, &[(amplitude_volt, cycles)]))
        })
        .collect()
}

fn triangle() -> Plan {
    plan("triangle", 500, Waveform::triangles(BIAS_VOLT, 1.0, &[85.0, 60.0, 30.0]))
}

fn steps() -> Plan {
    let levels = [115.0, 25.0, 140.0, -10.0, 65.0].as_slice();
    plan("steps", 500, Waveform::steps(BIAS_VOLT, levels, 1.5))
}

fn zero_input(rest_s: f64) -> Plan {
    plan("zero_input", 1000, Waveform::pulse(BIAS_VOLT, rest_s, 60.0))
}

/// The runs of the measured folder of a base.
pub fn measured(base: u64, size: Size) -> Vec<Plan> {
    let flap = |id: &str, number: u64, peak_volt: f64| {
        plan(id, 1000, multisine(base, number, FLAP_BAND_HZ, peak_volt, 4.0))
    };
    let mut runs = match Design::of_base(base).0 {
        Design::Recommended => vec![
            triangle(),
            flap("flap_band_75v", 11, 75.0),
            flap("flap_band_30v", 12, 30.0),
            plan("wide_band_20v", 2000, multisine(base, 13, WIDE_BAND_HZ, 20.0, 2.0)),
            steps(),
            plan("bursts_10hz", 1000, bursts(10.0, BIAS_VOLT, &[(20.0, 8), (50.0, 8), (80.0, 8)])),
            plan("warm_up", 200, bursts(20.0, BIAS_VOLT, &[(75.0, 500), (25.0, 300)])),
            zero_input(2.0),
        ],
        Design::Multisine => vec![
            flap("flap_band_75v", 11, 75.0),
            flap("flap_band_30v", 12, 30.0),
            flap("flap_band_75v_again", 14, 75.0),
            zero_input(2.0),
        ],
        Design::TwoAmplitudeSines => [sines(75.0), sines(30.0)].concat(),
        Design::Mixed => {
            let mut runs = vec![triangle(), flap("flap_band_60v", 11, 60.0), steps()];
            runs.extend(sines(50.0));
            runs
        }
        Design::OneAmplitudeSines => sines(60.0),
    };
    if size == Size::Full {
        lengthen(&mut runs, base, 60);
    }
    runs
}

/// A second, ideal displacement sensor on every run, added ones included.
const LASER: &str = "laser-cross-check";

/// Ids of the catalogue of experiments.
pub const EXPERIMENTS: [&str; 15] = [
    "multisine-5-181Hz",
    "amplifier-monitor",
    "temperature-monitor",
    LASER,
    "amplitude-sweep",
    "frequency-sweep",
    "overdrive-two-biases",
    "bias-sweep",
    "hold-steps-100s",
    "cold-hot-cold",
    "ring-down",
    "zero-input-record",
    "two-springs",
    "preload",
    "small-motion",
];

/// What an experiment changes in the measured folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Runs in addition.
    pub runs: Vec<Plan>,
    /// Columns of all runs.
    pub monitors: Monitors,
    /// Voltages the actuator may see, V.
    pub range_volt: (f64, f64),
}

/// Whether an id names an experiment of the catalogue, or several joined by `+`.
pub fn is_experiment(id: &str) -> bool {
    id.split('+').all(|part| EXPERIMENTS.contains(&part))
}

/// The experiment of an id for a base that records `monitors` anyway; of ids joined by `+`, all of them.
///
/// # Errors
/// [`TruthError::UnknownName`] with all that are known.
pub fn experiment(id: &str, base: u64, monitors: Monitors) -> Result<Experiment, TruthError> {
    let mut joined = Experiment { runs: Vec::new(), monitors, range_volt: RANGE_VOLT };
    for part in id.split('+') {
        let own = one_experiment(part, base, joined.monitors)?;
        let again = |plan: &&Plan| joined.runs.iter().any(|other| other.id == plan.id);
        let runs: Vec<Plan> = own.runs.iter().filter(|plan| !again(plan)).cloned().collect();
        joined.runs.extend(runs);
        joined.monitors = own.monitors;
        let (low, high) = joined.range_volt;
        joined.range_volt = (low.min(own.range_volt.0), high.max(own.range_volt.1));
    }
    if id.split('+').any(|part| part == LASER) {
        let added = joined.runs.iter().filter(|run| run.fitting == Fitting::Plain);
        let twins: Vec<Plan> = added.map(by_laser).collect();
        joined.runs.extend(twins);
    }
    Ok(joined)
}

/// A run once more, read by the second sensor.
fn by_laser(run: &Plan) -> Plan {
    Plan { id: format!("laser_{}", run.id), fitting: Fitting::Laser, ..run.clone() }
}

fn one_experiment(id: &str, base: u64, monitors: Monitors) -> Result<Experiment, TruthError> {
    let mut done = Experiment { runs: Vec::new(), monitors, range_volt: RANGE_VOLT };
    let wide = |id: &str, number: u64, peak_volt: f64| {
        plan(id, 2000, multisine(base, number, WIDE_BAND_HZ, peak_volt, 2.0))
    };
    match id {
        "multisine-5-181Hz" => {
            done.runs = vec![wide("added_wide_12v", 31, 12.0), wide("added_wide_30v", 32, 30.0)];
        }
        "amplifier-monitor" => done.monitors.amplifier = Monitor::Recorded,
        "temperature-monitor" => done.monitors.temperature = Monitor::Recorded,
        LASER => done.runs = measured(base, Size::Small).iter().map(by_laser).collect(),
        "amplitude-sweep" => {
            let waveform = bursts(10.0, BIAS_VOLT, &[10.0, 20.0, 40.0, 60.0, 80.0].map(|a| (a, 6)));
            done.runs = vec![plan("added_amplitudes", 1000, waveform)];
        }
        "frequency-sweep" => {
            for (hz, cycles) in
                [(0.5, 2), (1.0, 2), (2.0, 4), (5.0, 8), (10.0, 12), (20.0, 20), (40.0, 40)]
            {
                let id = format!("added_sine_{hz}hz");
                done.runs.push(plan(&id, 1000, bursts(hz, BIAS_VOLT, &[(40.0, cycles)])));
            }
        }
        "overdrive-two-biases" => {
            for (id, mean) in [("added_overdrive_low", 45.0), ("added_overdrive_high", 85.0)] {
                done.runs.push(plan(id, 1000, bursts(2.0, mean, &[(82.0, 6)])));
            }
            done.range_volt = (-40.0, 170.0);
        }
        "bias-sweep" => {
            let mut points = Vec::new();
            for bias in [65.0, -5.0, 30.0, 65.0, 100.0, 135.0, -10.0, 65.0] {
                points.extend([bias, bias + 10.0, bias - 10.0, bias + 10.0, bias]);
            }
            done.runs = vec![plan("added_biases", 500, Waveform::ramps(BIAS_VOLT, 100.0, &points))];
        }
        "hold-steps-100s" => {
            let waveform = Waveform::steps(BIAS_VOLT, &[120.0, 20.0, 65.0], 33.0);
            done.runs = vec![plan("added_holds", 50, waveform)];
        }
        "cold-hot-cold" => {
            let program = [(30.0, 40), (80.0, 1200), (30.0, 800)];
            done.runs = vec![plan("added_hot", 200, bursts(20.0, BIAS_VOLT, &program))];
            done.monitors.temperature = Monitor::Recorded;
        }
        "ring-down" => {
            let levels = [85.0, 65.0, 45.0, 65.0, 85.0, 65.0, 45.0, 65.0];
            done.runs =
                vec![plan("added_ring_down", 2000, Waveform::steps(BIAS_VOLT, &levels, 0.25))];
        }
        "zero-input-record" => {
            done.runs = vec![Plan { id: "added_zero_input".to_owned(), ..zero_input(8.0) }];
        }
        "two-springs" | "preload" => {
            let fittings: &[(&str, Fitting)] = if id == "preload" {
                &[("preload", Fitting::Preload)]
            } else {
                &[("soft_spring", Fitting::Spring(0.1)), ("hard_spring", Fitting::Spring(0.2))]
            };
            for (name, fitting) in fittings {
                let band = multisine(base, 33, FLAP_BAND_HZ, 60.0, 3.0);
                let pair = [triangle(), plan("flap_band", 1000, band)];
                done.runs.extend(pair.map(|run| Plan {
                    id: format!("{name}_{}", run.id),
                    fitting: *fitting,
                    ..run
                }));
            }
            if id == "two-springs" {
                done.monitors.load = Monitor::Recorded;
            }
        }
        "small-motion" => {
            let volts = [1.0, 1.0, 2.0, 2.0, 5.0, 5.0, 10.0, 10.0];
            done.runs = vec![plan("added_small", 500, Waveform::triangles(BIAS_VOLT, 2.0, &volts))];
        }
        _ => {
            return Err(TruthError::UnknownName {
                what: "experiment",
                found: id.to_owned(),
                known: EXPERIMENTS.join(", "),
            });
        }
    }
    Ok(done)
}
