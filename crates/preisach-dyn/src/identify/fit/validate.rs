//! Cross-validation over experiments: how smooth the rate maps should be.

use crate::identify::RateSmoothness;
use crate::identify::fit::training::Training;
use crate::identify::fit::{compare, rate_fit};
use crate::{ActuatorLaw, PlayMap, PreisachError};
use rayon::prelude::*;
use rotor_base::mean_square;
use serde::{Deserialize, Serialize};

/// Candidates, from the loosest.
const CANDIDATES: [f64; 5] = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1];
/// Taken where there is nothing to leave out.
const UNTESTED: f64 = 1e-3;
/// A looser candidate is preferred if its error is at most this much larger.
const WITHIN: f64 = 1.05;

/// How a smoothness did on experiments it was not fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// The weight of the smoothness.
    pub smoothness: f64,
    /// Root mean square of the NRMSE of the fast training records, each left out of the fit in
    /// turn; infinite if a fit failed or a simulation diverged.
    pub nrmse: f64,
}

/// The smoothness to use and what the choice rests on.
///
/// Every fast training record is left out of the rate fit in turn and simulated with the maps
/// fitted to the others: by experiment, never by sample. Of the candidates within 5 % of the best
/// the loosest is taken, because all records together carry more than all but one.
pub(crate) fn smoothness(training: &Training, g0_deg: &PlayMap) -> (f64, Vec<Validation>) {
    let Training { settings, fast, .. } = training;
    if let RateSmoothness::Fixed(smoothness) = settings.rate_smoothness {
        return (smoothness, Vec::new());
    }
    if fast.len() < 3 {
        return (UNTESTED, Vec::new());
    }
    let left_out = |index: usize, smoothness: f64| -> Result<f64, PreisachError> {
        let mut others = training.clone();
        let tested = others.fast.remove(index);
        let model = rate_fit::fit(&others, g0_deg, smoothness)?.model(training, g0_deg)?;
        let actuator = settings.actuator_of(ActuatorLaw::DynamicPreisach(model));
        compare::training_nrmse(&actuator, tested)
    };
    let table: Vec<Validation> = CANDIDATES
        .par_iter()
        .map(|&smoothness| {
            let errors = (0..fast.len()).map(|index| left_out(index, smoothness));
            let errors = errors.collect::<Result<Vec<_>, _>>();
            Validation {
                smoothness,
                nrmse: errors.map_or(f64::INFINITY, |e| mean_square(&e).sqrt()),
            }
        })
        .collect();
    let best = table.iter().fold(f64::INFINITY, |least, v| least.min(v.nrmse));
    let chosen = table.iter().find(|v| v.nrmse <= WITHIN * best);
    (chosen.map_or(UNTESTED, |v| v.smoothness), table)
}
