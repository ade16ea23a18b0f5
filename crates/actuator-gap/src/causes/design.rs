//! What measured runs contain: what a cause is judged observable by.

use crate::record::Record;
use model_gap::Stimulus;
use rotor_base::variance;

/// What the measured runs of a diagnosis contain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Design {
    /// Lowest and highest input of the measured runs.
    pub(crate) input: (f64, f64),
    /// Spread of the output over the measured runs.
    pub(crate) spread: f64,
    /// Lowest and highest output of the measured runs.
    pub(crate) output: (f64, f64),
    /// Half the range of the output over the measured runs.
    pub(crate) half_stroke: f64,
    /// Longest measured run, s.
    pub(crate) longest_s: f64,
    /// Half the highest sampling frequency, Hz: what one run carries, the data carry.
    pub(crate) nyquist_hz: f64,
    /// Rate of the input that a twentieth of the samples exceed, per s.
    pub(crate) fast_rate: f64,
    /// The only frequency of all measured runs, if they are sines of one frequency.
    pub(crate) only_hz: Option<f64>,
    /// Number of measured runs with the terminal voltage beside them.
    pub(crate) monitored_runs: usize,
    /// Whether a thermometer was read.
    pub(crate) has_temperature: bool,
    /// Load over displacement as a load cell saw it, N/um, and its standard error; none without a load cell.
    pub(crate) load_per_um: Option<(f64, f64)>,
    /// Whether it is an actuator bench, with volt and um.
    pub(crate) is_bench: bool,
    /// Whether reference runs fix the base model.
    pub(crate) has_reference: bool,
}

impl Design {
    pub(crate) fn of(runs: &[&Record], is_bench: bool, has_reference: bool) -> Self {
        let all = |f: fn(&Record) -> &[f64]| runs.iter().flat_map(move |r| f(r).iter().copied());
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let input = range(&mut all(Record::judged_input));
        let output = range(&mut all(Record::judged_output));
        let count: usize = runs.iter().map(|r| r.judged_output().len()).sum();
        let square = |r: &&Record| variance(r.judged_output()) * r.judged_output().len() as f64;
        let spread2 = runs.iter().map(square).sum::<f64>();
        let mut rates: Vec<f64> = runs
            .iter()
            .flat_map(|r| r.judged_input().windows(2).map(|w| (w[1] - w[0]).abs() / r.step_s))
            .collect();
        rates.sort_by(f64::total_cmp);
        let fast_rate = rates.get(rates.len() * 19 / 20).copied().unwrap_or_default();
        let frequencies: Vec<Option<f64>> = runs
            .iter()
            .map(|r| match Stimulus::of(r.judged_input(), r.step_s) {
                Stimulus::Sine { frequency_hz, .. } => Some(frequency_hz),
                Stimulus::Other => None,
            })
            .collect();
        let first = frequencies.first().copied().flatten();
        let only_hz = first
            .filter(|f| frequencies.iter().all(|g| g.is_some_and(|g| (g - f).abs() < 0.05 * f)));
        Self {
            input,
            spread: (spread2 / count.max(1) as f64).sqrt(),
            output,
            half_stroke: 0.5 * (output.1 - output.0),
            longest_s: runs.iter().map(|r| r.duration_s()).fold(0.0, f64::max),
            nyquist_hz: runs.iter().map(|r| 0.5 / r.step_s).fold(0.0, f64::max),
            fast_rate,
            only_hz,
            monitored_runs: runs.iter().filter(|r| r.amplifier.is_some()).count(),
            has_temperature: runs.iter().any(|r| r.temperature.is_some()),
            load_per_um: load_per_um(runs),
            is_bench,
            has_reference,
        }
    }

    /// Nothing about rate can be said from one frequency.
    pub(super) fn one_frequency(&self) -> Option<String> {
        self.only_hz.map(|hz| {
            format!("every run is a sine of {hz:.3} Hz: nothing that depends on rate shows at one frequency")
        })
    }
}

/// Slope of the load against the displacement over all runs with a load cell, each about its means, and its
/// standard error.
fn load_per_um(runs: &[&Record]) -> Option<(f64, f64)> {
    let centred = |v: &[f64]| -> Vec<f64> {
        let mean = v.iter().sum::<f64>() / v.len().max(1) as f64;
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
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>();
    let square = sum(&|p| p.0 * p.0);
    if square <= 0.0 {
        return None;
    }
    let slope = sum(&|p| p.0 * p.1) / square;
    let left = sum(&|p| (p.1 - slope * p.0).powi(2));
    Some((slope, (left / pairs.len() as f64 / square).sqrt()))
}
