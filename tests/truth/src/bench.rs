//! The bench data set: which runs, and how they are generated.

use crate::actuator::ActuatorParameters;
use crate::command::{Command, Tone};
use crate::error::TruthError;
use crate::lvdt::Lvdt;
use crate::measure::half_peak_to_peak;
use crate::record::{INTERNAL_RATE_HZ, Record, Run};

/// Seed of the committed data.
pub const SEED: u64 = 20_200;

/// Flap deflection of the full-scale 0.2 Hz run, half peak to peak, deg.
pub const FULL_SCALE_FLAP_DEG: f64 = 10.0;

/// The run that fixes the ratio of flap angle to displacement.
pub const MAJOR_LOOP_ID: &str = "major_0p2hz";

/// Speed of the reversal curves: that of a triangle over the whole range at 0.2 Hz, V/s.
const RAMP_VOLT_PER_S: f64 = 68.0;

/// Number of reversals in each family of reversal curves.
const REVERSALS: u32 = 12;

/// A run with its results.
#[derive(Debug, Clone)]
pub struct BenchRun {
    /// What was done.
    pub run: Run,
    /// Displacement without sensor.
    pub exact: Record,
    /// Displacement as recorded.
    pub measured: Record,
}

/// All runs of the bench.
#[derive(Debug, Clone)]
pub struct BenchData {
    /// The actuator.
    pub actuator: ActuatorParameters,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// Flap deflection per displacement, deg/um; [`FULL_SCALE_FLAP_DEG`] at [`MAJOR_LOOP_ID`].
    pub flap_deg_per_um: f64,
    /// The runs, in the order of the data set.
    pub runs: Vec<BenchRun>,
}

/// The programme of the bench for an actuator that may be driven from `low_volt` to `high_volt`.
pub fn programme(actuator: &ActuatorParameters) -> Vec<Run> {
    let mut runs = vec![Run {
        id: MAJOR_LOOP_ID.to_owned(),
        note: "0.2 Hz major loop, 85 V, four cycles from rest at the bias".to_owned(),
        sample_rate_hz: 200,
        rest_s: 0.5,
        command: Command::Sine { frequency_hz: 0.2, amplitude_volt: 85.0, cycles: 4 },
    }];
    let families = [
        ("forc_from_150v", actuator.high_volt, actuator.low_volt, "falling from 150 V"),
        ("forc_from_minus20v", actuator.low_volt, actuator.high_volt, "rising from -20 V"),
    ];
    for (id, saturation_volt, opposite_volt, what) in families {
        let mut turning_points_volt = vec![saturation_volt];
        for i in 1..=REVERSALS {
            let depth = f64::from(i) / f64::from(REVERSALS);
            turning_points_volt.push(saturation_volt + depth * (opposite_volt - saturation_volt));
            turning_points_volt.push(saturation_volt);
        }
        runs.push(Run {
            id: id.to_owned(),
            note: format!("{REVERSALS} first-order reversals, {what}, 68 V/s (0.2 Hz triangle)"),
            sample_rate_hz: 200,
            rest_s: 0.5,
            command: Command::Ramps { speed_volt_per_s: RAMP_VOLT_PER_S, turning_points_volt },
        });
    }
    for (frequency_hz, sample_rate_hz, cycles) in
        [(1_u32, 1000, 6), (5, 2000, 8), (10, 2000, 12), (15, 2000, 15), (20, 2000, 20)]
    {
        for amplitude_volt in [85_u32, 55, 25] {
            runs.push(Run {
                id: format!("sine_{frequency_hz}hz_{amplitude_volt}v"),
                note: format!(
                    "{frequency_hz} Hz sine, {amplitude_volt} V, {cycles} cycles from rest at the bias"
                ),
                sample_rate_hz,
                rest_s: 0.25,
                command: Command::Sine {
                    frequency_hz: f64::from(frequency_hz),
                    amplitude_volt: f64::from(amplitude_volt),
                    cycles,
                },
            });
        }
    }
    let tone = |per_rev, amplitude_volt, phase_deg| Tone { per_rev, amplitude_volt, phase_deg };
    runs.push(Run {
        id: "mix_2_3_4_per_rev".to_owned(),
        note: "2, 3 and 4/rev together (10, 15, 20 Hz at 5 rev/s), eight revolutions, the first \
               faded in"
            .to_owned(),
        sample_rate_hz: 2000,
        rest_s: 0.25,
        command: Command::Mix {
            revolution_hz: 5.0,
            tones: vec![tone(2, 30.0, 0.0), tone(3, 30.0, 70.0), tone(4, 25.0, 200.0)],
            revolutions: 8,
        },
    });
    runs
}

/// Generates all runs.
///
/// Each run starts from the same state: after an infinitely long rest at the bias, with the walls
/// on the anhysteretic curve, nothing left to relax and nothing left to creep. The noise of a run
/// depends on the seed and on the run's place in the programme.
///
/// # Errors
/// As [`Run::pass_through`], and [`TruthError::Parameter`] for parameters out of range.
pub fn generate(actuator: ActuatorParameters, seed: u64) -> Result<BenchData, TruthError> {
    let mut runs = Vec::new();
    let mut flap_deg_per_um = f64::NAN;
    for (stream, run) in (0_u64..).zip(programme(&actuator)) {
        let exact = run.pass_through(&mut actuator.chain()?, &actuator, INTERNAL_RATE_HZ)?;
        if run.id == MAJOR_LOOP_ID {
            let steady = steady_window(&run, &exact.displacement_um);
            flap_deg_per_um = FULL_SCALE_FLAP_DEG / half_peak_to_peak(steady);
        }
        let measured = exact.measured_by(&mut Lvdt::new(actuator.lvdt, seed, stream)?);
        runs.push(BenchRun { run, exact, measured });
    }
    Ok(BenchData { actuator, seed, flap_deg_per_um, runs })
}

/// The last whole cycles of a run, as many as have a whole number of samples.
///
/// One cycle of a 0.2 Hz sine, three of a 1 Hz sine, the last 0.6 s of a faster run. Ramps have no
/// steady part: everything after the rest counts.
pub fn steady_window<'a>(run: &Run, samples: &'a [f64]) -> &'a [f64] {
    let rate = run.sample_rate_hz as usize;
    let end = samples.len() - 1;
    let length = match &run.command {
        Command::Sine { frequency_hz, .. } if *frequency_hz < 1.0 => 5 * rate,
        Command::Sine { frequency_hz, .. } if *frequency_hz < 5.0 => 3 * rate,
        Command::Sine { .. } | Command::Mix { .. } => 3 * rate / 5,
        Command::Ramps { .. } => end - rate / 2,
    };
    &samples[end - length..end]
}
