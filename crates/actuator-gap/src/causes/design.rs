//! What measured runs contain: what a cause is judged observable by.

use crate::numbers::range;
use crate::record::{Record, slower};
use measured_data::Accuracy;
use model_gap::Sine;
use rotor_base::mean;

/// What the measured runs of a diagnosis contain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Design {
    /// Lowest and highest input of the measured runs.
    pub(crate) input: (f64, f64),
    /// Lowest and highest output of the measured runs.
    pub(crate) output: (f64, f64),
    /// Half the range of the output over the measured runs.
    pub(crate) half_stroke: f64,
    /// Longest measured run, s.
    pub(crate) longest_s: f64,
    /// Half the highest sampling frequency, Hz: what one run carries, the data carry.
    pub(crate) nyquist_hz: f64,
    /// Times slower than a usual bench the runs are: see [`slower`].
    pub(crate) slower: f64,
    /// Rate of the input that a twentieth of the samples exceed, per s.
    pub(crate) fast_rate: f64,
    /// The only frequency of all measured runs, if they are sines of one frequency.
    pub(crate) only_hz: Option<f64>,
    /// Number of measured runs with the terminal voltage beside them.
    pub(crate) monitored_runs: usize,
    /// Whether a thermometer was read.
    pub(crate) has_temperature: bool,
    /// Number of measured runs that a second, ideal sensor read.
    pub(crate) second_sensor_runs: usize,
    /// Load over displacement as a load cell saw it beyond that of the reference runs, N/um, and its standard error;
    /// none without a load cell.
    pub(crate) load_per_um: Option<(f64, f64)>,
    /// Load cells that read a load in the reference runs already do not tell a new load: a sensor that reads low shows
    /// more load per displacement too. Number of measured runs with one that does.
    pub(crate) load_told_runs: usize,
    /// Whether it is an actuator bench, with volt and um.
    pub(crate) is_bench: bool,
    /// Whether reference runs fix the base model.
    pub(crate) has_reference: bool,
}

impl Design {
    pub(crate) fn of(
        runs: &[&Record],
        references: &[&Record],
        accuracy: &Accuracy,
        is_bench: bool,
    ) -> Self {
        let output = range(runs.iter().flat_map(|r| r.judged_output()));
        let mut rates: Vec<f64> = runs
            .iter()
            .flat_map(|r| r.judged_input().windows(2).map(|w| (w[1] - w[0]).abs() / r.step_s))
            .collect();
        rates.sort_by(f64::total_cmp);
        let frequencies: Vec<Option<f64>> = runs
            .iter()
            .map(|r| Sine::of(r.judged_input(), r.step_s).map(|sine| sine.frequency_hz))
            .collect();
        let first = frequencies.first().copied().flatten();
        let only_hz = first
            .filter(|f| frequencies.iter().all(|g| g.is_some_and(|g| (g - f).abs() < 0.05 * f)));
        Self {
            input: range(runs.iter().flat_map(|r| r.judged_input())),
            output,
            half_stroke: 0.5 * (output.1 - output.0),
            longest_s: runs.iter().map(|r| r.duration_s()).fold(0.0, f64::max),
            nyquist_hz: runs.iter().map(|r| 0.5 / r.step_s).fold(0.0, f64::max),
            slower: slower(runs),
            fast_rate: rates.get(rates.len() * 19 / 20).copied().unwrap_or_default(),
            only_hz,
            monitored_runs: runs.iter().filter(|r| r.amplifier.is_some()).count(),
            has_temperature: runs.iter().any(|r| r.temperature.is_some()),
            second_sensor_runs: runs.iter().filter(|r| r.has_ideal_sensor()).count(),
            load_per_um: load_beyond(runs, references, 0.01 * accuracy.load_cell.gain_percent),
            load_told_runs: if reads_load(references) {
                0
            } else {
                runs.iter().filter(|r| r.load.is_some()).count()
            },
            is_bench,
            has_reference: !references.is_empty(),
        }
    }

    /// Nothing about rate can be said from one frequency.
    pub(super) fn one_frequency(&self) -> Option<String> {
        self.only_hz.map(|hz| {
            format!("every run is a sine of {hz:.3} Hz: nothing that depends on rate shows at one frequency")
        })
    }

    /// Nothing about a gain can be said without reference runs.
    pub(super) fn no_reference(&self) -> Option<String> {
        (!self.has_reference).then(|| {
            "without reference runs a pure gain cannot be told from the actuator's own".to_owned()
        })
    }
}

/// Standard errors that the slope of a load cell must stand out by.
pub(super) const SHOWS: f64 = 5.0;

/// Whether a load follows the displacement in runs.
pub(crate) fn reads_load(runs: &[&Record]) -> bool {
    load_per_um(runs).is_some_and(|(slope, error)| slope.abs() > SHOWS * error)
}

/// How far the load follows the displacement beyond what it did in the reference runs. A spring that was always there
/// is part of the actuator; a load cell is trusted to a part `gain` of what it reads.
fn load_beyond(runs: &[&Record], references: &[&Record], gain: f64) -> Option<(f64, f64)> {
    let (slope, error) = load_per_um(runs)?;
    let (before, error_before) = load_per_um(references).unwrap_or_default();
    Some((slope - before, error.hypot(error_before).hypot(gain * before)))
}

/// Slope of the load against the displacement over all runs with a load cell, each about its means, and its
/// standard error.
fn load_per_um(runs: &[&Record]) -> Option<(f64, f64)> {
    let centred = |v: &[f64]| -> Vec<f64> {
        let mean = mean(v);
        v.iter().map(|x| x - mean).collect()
    };
    let pairs: Vec<(f64, f64)> = runs
        .iter()
        .filter_map(|run| {
            let load = run.load.as_ref()?;
            Some((centred(run.judged_output()), centred(run.judged(load))))
        })
        .flat_map(|(y, load)| y.into_iter().zip(load))
        .collect();
    let square: f64 = pairs.iter().map(|p| p.0 * p.0).sum();
    if square <= 0.0 {
        return None;
    }
    let slope = pairs.iter().map(|p| p.0 * p.1).sum::<f64>() / square;
    let left: f64 = pairs.iter().map(|p| (p.1 - slope * p.0).powi(2)).sum();
    Some((slope, (left / pairs.len() as f64 / square).sqrt()))
}
