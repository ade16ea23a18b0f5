//! Errors of a set of experiments, trained and held out apart.

use crate::{FirstHarmonicError, Misfit, Use};

/// The errors of one experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct RunError {
    /// Name of the experiment.
    pub id: String,
    /// Whether it was trained on.
    pub used: Use,
    /// The misfit of the whole record.
    pub misfit: Misfit,
    /// Amplitude and phase of the first harmonic, where the input has one frequency.
    pub first_harmonic: Option<FirstHarmonicError>,
}

/// The worst experiment of a set in one measure.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstRun {
    /// Name of the experiment.
    pub id: String,
    /// Its error.
    pub value: f64,
}

/// The errors of one set.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Experiments in the set.
    pub experiments: usize,
    /// Mean of their NRMSE (1 = 100 %): each experiment counts once, however long.
    pub mean_nrmse: f64,
    /// Largest NRMSE.
    pub worst_nrmse: WorstRun,
    /// Largest phase error of a first harmonic in magnitude, degrees; `None` if no record has one.
    pub worst_phase_deg: Option<WorstRun>,
    /// Amplitude ratio farthest from 1, by its logarithm; `None` if no record has one.
    pub worst_amplitude_ratio: Option<WorstRun>,
}

impl Summary {
    /// The summary of the experiments of one use; `None` if there are none.
    pub fn of(errors: &[RunError], used: Use) -> Option<Self> {
        let set: Vec<&RunError> = errors.iter().filter(|run| run.used == used).collect();
        let worst = |value: &dyn Fn(&RunError) -> Option<f64>, size: fn(f64) -> f64| {
            set.iter()
                .filter_map(|run| value(run).map(|value| WorstRun { id: run.id.clone(), value }))
                .max_by(|a, b| size(a.value).total_cmp(&size(b.value)))
        };
        let worst_nrmse = worst(&|run| Some(run.misfit.nrmse), f64::abs)?;
        Some(Self {
            experiments: set.len(),
            mean_nrmse: set.iter().map(|run| run.misfit.nrmse).sum::<f64>() / set.len() as f64,
            worst_nrmse,
            worst_phase_deg: worst(
                &|run| run.first_harmonic.map(|first| first.phase_error_deg),
                f64::abs,
            ),
            worst_amplitude_ratio: worst(
                &|run| run.first_harmonic.map(|first| first.amplitude_ratio),
                |ratio| ratio.ln().abs(),
            ),
        })
    }
}
