//! What measured runs and reference runs, taken in two sessions, have in common: zero, range, scale and noise.

mod continued;
mod doubt;
mod given;
mod over_time;

pub(crate) use continued::continued;
pub(crate) use doubt::{Sessions, doubt};
pub use given::GivenModel;
pub(crate) use given::{error_percent, simulated_runs, simulated_um};

use crate::base::{BaseModel, white_noise};
use crate::numbers::{range, slope};
use crate::record::Record;
use model_gap::discovery::Reason;
use rotor_base::variance;

/// Times the noise of the reference runs from which a reading is another.
const NOISIER: f64 = 2.0;
/// Part of the range of the reference runs by which an input may lie beyond it.
const REACHED: f64 = 0.02;

/// What is said of the measured run whose reading is noisier than that of the reference runs by most. No cause of a
/// simulation adds noise, but a sensor or an amplifier that has become noisy is no longer what it was.
pub(crate) fn noisier(runs: &[&Record], base: &BaseModel) -> Option<Reason> {
    let times = |run: &&Record| white_noise(&base.residual(run)) / base.noise;
    let (run, times) = runs
        .iter()
        .map(|run| (run, times(run)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, times)| *times > NOISIER)?;
    Some(Reason::Noisier { run: run.id.clone(), times })
}

/// Slope of what runs did against what the base model expects of them, each about its mean.
pub(crate) fn scale_of(runs: &[&Record], base: &BaseModel) -> f64 {
    let (mut both, mut own) = (0.0, 0.0);
    for run in runs {
        let expected = base.predict(&run.input, run.step_s);
        let expected = run.judged(&expected);
        let n = expected.len() as f64 * variance(expected);
        both += n * slope(expected, run.judged_output());
        own += n;
    }
    if own > 0.0 { both / own } else { 1.0 }
}

/// Share of the samples of runs whose input no reference run has reached; 0 without any.
pub(crate) fn share_beyond(runs: &[&Record], references: &[&Record]) -> f64 {
    if references.is_empty() {
        return 0.0;
    }
    let (low, high) = range(references.iter().flat_map(|run| run.judged_input()));
    let margin = REACHED * (high - low);
    let reached = low - margin..=high + margin;
    let beyond = |run: &&Record| run.judged_input().iter().filter(|u| !reached.contains(u)).count();
    let all: usize = runs.iter().map(|run| run.judged_input().len()).sum();
    runs.iter().map(beyond).sum::<usize>() as f64 / all.max(1) as f64
}

/// What the sensor reads at the beginning of runs, the middle one of all, output's unit.
pub(crate) fn beginning<'r>(runs: impl Iterator<Item = &'r Record>) -> f64 {
    let mut first: Vec<f64> = runs.filter_map(|run| run.output.first().copied()).collect();
    first.sort_by(f64::total_cmp);
    first.get(first.len() / 2).copied().unwrap_or_default()
}

/// The range of the base model: that of the data set, widened to every input that occurs.
pub(crate) fn range_of(given: (f64, f64), a: &[&Record], b: &[&Record]) -> (f64, f64) {
    range([&given.0, &given.1].into_iter().chain(a.iter().chain(b).flat_map(|r| &r.input)))
}
