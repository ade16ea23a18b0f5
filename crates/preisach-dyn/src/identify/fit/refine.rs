//! Output-error refinement: the training records are simulated and compared.

use crate::identify::fit::output_error::{
    Covariance, Estimate, OutputError, Uncertainty, estimates,
};
use crate::identify::fit::rate_fit::room_for_g2;
use crate::identify::fit::training::Training;
use crate::laws::play_map::risen;
use crate::{
    ActuatorLaw, ActuatorModel, DynamicParameters, DynamicPreisach, PlayMap, PreisachError,
    RateForm,
};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// What the refinement did.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// Root mean square of the NRMSE of the training records before it.
    pub nrmse_before: f64,
    /// The same after it; equal to the former if it was dropped or left out.
    pub nrmse_after: f64,
    /// Steps tried.
    pub steps: usize,
    /// Whether its result was kept.
    pub outcome: RefinementOutcome,
}

impl Refinement {
    /// A model that was not refined.
    pub(crate) fn left_out(nrmse: f64) -> Self {
        let outcome = RefinementOutcome::LeftOut;
        Self { nrmse_before: nrmse, nrmse_after: nrmse, steps: 0, outcome }
    }
}

/// How a refinement ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RefinementOutcome {
    /// It lowered the error of the training records.
    Kept,
    /// It did not; the equation-error model stands.
    Dropped,
    /// It was not asked for.
    LeftOut,
}

/// A refined law with the uncertainty of its parameters.
pub(crate) struct Refined {
    pub(crate) law: ActuatorLaw,
    pub(crate) refinement: Refinement,
    /// The parameters where the refinement ended, as corrections to the model it began with.
    pub(crate) parameters: Vec<Estimate>,
    pub(crate) covariance: Option<Covariance>,
}

/// Refines a model on the training records.
///
/// ```text
/// mu0   -> mu0 exp(a1 + a2 s + a3 r + a4 s^2 + a5 s r + a6 r^2),  offset -> offset + a0
/// tau0  -> tau0 exp(b0),   f -> f exp(b1 + b2 s + b3 r)
/// G2    -> room tanh(c) G2,   room: the largest factor no reachable state folds with
/// ```
/// `s` in -1..1 is the centre, `r` in 0..1 the half-width of a play, over half the range. The
/// exponentials and the hyperbolic tangent keep every parameter inside the cone of the model.
///
/// The covariance is left out unless asked for.
pub(crate) fn refine(
    start: &DynamicPreisach,
    training: &Training,
    uncertainty: Uncertainty,
) -> Result<Refined, PreisachError> {
    let (settings, records) = (training.settings, training.all());
    let first = start.parameters();
    let mut x = DVector::zeros(PARAMETERS);
    if first.form == RateForm::WellPosed {
        let room = room_for_g2(&first.g1_s, &first.g2_s2_per_deg, first.unfolded_rate_deg_s);
        x[QUADRATIC] = room.recip().min(0.999).atanh();
    }
    let wrap = |law: DynamicPreisach| settings.actuator_of(ActuatorLaw::DynamicPreisach(law));
    // the model as it came, not as its parameters rebuild it
    let origin = x.clone();
    let build = |x: &DVector<f64>| -> Option<ActuatorModel> {
        if *x == origin { Some(wrap(start.clone())) } else { Some(wrap(corrected(first, x)?)) }
    };
    let problem = OutputError::new(&build, &records, &[], x.clone());
    let before = problem.nrmse().ok_or(PreisachError::Diverged {
        index: 0,
        last_output_deg: f64::NAN,
        bad_steps: 0,
    })?;
    let mut refinement = Refinement::left_out(before);
    let mut law = ActuatorLaw::DynamicPreisach(start.clone());
    if settings.refinement_patience > 0 {
        refinement.outcome = RefinementOutcome::Dropped;
        if let Some(minimum) = problem.minimise(settings.refinement_patience) {
            refinement.steps = minimum.steps;
            if minimum.nrmse < before {
                refinement.nrmse_after = minimum.nrmse;
                refinement.outcome = RefinementOutcome::Kept;
                (law, x) = (minimum.model.law, minimum.x);
            }
        }
    }
    let covariance = uncertainty.of(|| OutputError::new(&build, &records, &[], x.clone()));
    let parameters = estimates(&NAMES, &x, covariance.as_ref());
    Ok(Refined { law, refinement, parameters, covariance })
}

/// Place of each parameter in the vector.
const LAG_CONSTANT: usize = 7;
const LAG: usize = 8;
const QUADRATIC: usize = 11;
const PARAMETERS: usize = 12;
/// Parameters of [`reshaped`]: offset, then the shape.
pub(crate) const SHAPE: usize = 7;

/// What the parameters do, in their order.
pub(crate) const NAMES: [&str; PARAMETERS] = [
    "offset, deg",
    "ln mu0",
    "ln mu0 per centre",
    "ln mu0 per half-width",
    "ln mu0 per centre^2",
    "ln mu0 per centre x half-width",
    "ln mu0 per half-width^2",
    "ln tau0",
    "ln lag of the plays",
    "ln lag of the plays per centre",
    "ln lag of the plays per half-width",
    "share of the room for mu2, artanh",
];

/// Centre in -1..1 and half-width in 0..1 of knot `k` of play `j`.
fn place(levels: usize, j: usize, k: f64) -> (f64, f64) {
    let levels = levels as f64;
    ((2.0 * k + j as f64) / levels - 1.0, j as f64 / levels)
}

/// A static map moved by `x[0]` degrees, its density scaled by the exponential of a quadratic form.
pub(crate) fn reshaped(map: &PlayMap, x: &[f64]) -> PlayMap {
    let levels = map.nodes.len();
    let mut map = map.clone();
    map.constant += x[0];
    for (j, row) in map.nodes.iter_mut().enumerate() {
        let rises = row.windows(2).map(|pair| pair[1] - pair[0]).enumerate().map(|(k, rise)| {
            let (s, r) = place(levels, j, k as f64 + 0.5);
            let terms = [1.0, s, r, s * s, s * r, r * r];
            let exponent: f64 = terms.iter().zip(&x[1..SHAPE]).map(|(t, a)| t * a).sum();
            rise * exponent.exp()
        });
        *row = risen(row[0], rises);
    }
    map
}

/// The model of corrected parameters, unless it is not well posed or not finite.
fn corrected(start: &DynamicParameters, x: &DVector<f64>) -> Option<DynamicPreisach> {
    let levels = start.grid.levels();
    let g0_deg = reshaped(&start.g0_deg, x.as_slice());
    let mut g1_s = start.g1_s.clone();
    g1_s.constant *= x[LAG_CONSTANT].exp();
    for (j, row) in g1_s.nodes.iter_mut().enumerate() {
        for (k, value) in row.iter_mut().enumerate() {
            let (s, r) = place(levels, j, k as f64);
            *value *= (x[LAG] + x[LAG + 1] * s + x[LAG + 2] * r).exp();
        }
    }
    let g2 = &start.g2_s2_per_deg;
    let factor = match start.form {
        RateForm::WellPosed => {
            room_for_g2(&g1_s, g2, start.unfolded_rate_deg_s) * x[QUADRATIC].tanh()
        }
        RateForm::Literal => 1.0 + x[QUADRATIC],
    };
    let g2_s2_per_deg = g2.combined(factor, g2, 0.0);
    DynamicPreisach::new(DynamicParameters { g0_deg, g1_s, g2_s2_per_deg, ..start.clone() }).ok()
}
