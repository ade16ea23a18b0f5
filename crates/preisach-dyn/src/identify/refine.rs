//! Output-error refinement: the training records are simulated and compared.

use super::Settings;
use super::prepared::Prepared;
use super::rate_fit::room_for_g2;
use crate::{
    DynamicParameters, DynamicPreisach, OutputHistory, PlayMemory, PreisachError, RateForm,
    StartState, StepCounts,
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Residuals kept of one record at most; all samples are simulated.
const MOST_RESIDUALS: usize = 800;
/// Step of the difference quotients.
const DIFFERENCE: f64 = 1e-5;

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
    pub(super) fn left_out(nrmse: f64) -> Self {
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

/// Refines a model on the training records.
///
/// ```text
/// mu0   -> mu0 exp(a1 + a2 s + a3 r + a4 s^2 + a5 s r + a6 r^2),  offset -> offset + a0
/// tau0  -> tau0 exp(b0),   f -> f exp(b1 + b2 s + b3 r)
/// G2    -> room tanh(c) G2,   room: the largest factor no reachable state folds with
/// ```
/// `s` in -1..1 is the centre, `r` in 0..1 the half-width of a play, over half the range. The
/// exponentials and the hyperbolic tangent keep every parameter inside the cone of the model.
pub(super) fn refine(
    start: DynamicPreisach,
    records: &[&Prepared],
    settings: &Settings,
) -> Result<(DynamicPreisach, Refinement), PreisachError> {
    let problem = Problem::new(&start, records);
    let before = problem.error().ok_or(PreisachError::Diverged {
        index: 0,
        last_output_deg: f64::NAN,
        bad_steps: 0,
    })?;
    let mut result = Refinement {
        nrmse_before: before,
        nrmse_after: before,
        steps: 0,
        outcome: RefinementOutcome::LeftOut,
    };
    if settings.refinement_patience == 0 {
        return Ok((start, result));
    }
    let (problem, report) = LevenbergMarquardt::new()
        .with_patience(settings.refinement_patience)
        .with_ftol(1e-4)
        .with_xtol(1e-4)
        .minimize(problem);
    result.steps = report.number_of_evaluations;
    let refined = problem.model();
    let after = problem.error();
    if let (Some(model), Some(after)) = (refined, after.filter(|&after| after < before)) {
        result.nrmse_after = after;
        result.outcome = RefinementOutcome::Kept;
        return Ok((model, result));
    }
    result.outcome = RefinementOutcome::Dropped;
    Ok((start, result))
}

/// Place of each parameter in the vector.
const OFFSET: usize = 0;
const STATIC: usize = 1;
const LAG_CONSTANT: usize = 7;
const LAG: usize = 8;
const QUADRATIC: usize = 11;
const PARAMETERS: usize = 12;

struct Problem<'a> {
    start: &'a DynamicParameters,
    records: &'a [&'a Prepared<'a>],
    parameters: DVector<f64>,
    /// The model of the present parameters; none outside the model's domain.
    model: Option<DynamicPreisach>,
}

impl<'a> Problem<'a> {
    fn new(start: &'a DynamicPreisach, records: &'a [&'a Prepared<'a>]) -> Self {
        let model = Some(start.clone());
        let start = start.parameters();
        let mut parameters = DVector::zeros(PARAMETERS);
        if start.form == RateForm::WellPosed {
            let room = room_for_g2(&start.g1_s, &start.g2_s2_per_deg, start.unfolded_rate_deg_s);
            parameters[QUADRATIC] = room.recip().min(0.999).atanh();
        }
        Self { start, records, parameters, model }
    }

    /// The model of the present parameters, unless it is not well posed or not finite.
    fn model(&self) -> Option<DynamicPreisach> {
        self.model.clone()
    }

    fn build(&self, x: &DVector<f64>) -> Option<DynamicPreisach> {
        let start = self.start;
        let levels = start.grid.levels() as f64;
        // centre in -1..1 and half-width in 0..1 of knot k of play j
        let place = |j: usize, k: f64| ((2.0 * k + j as f64) / levels - 1.0, j as f64 / levels);
        let mut g0_deg = start.g0_deg.clone();
        g0_deg.constant += x[OFFSET];
        for (j, row) in g0_deg.nodes.iter_mut().enumerate() {
            let rises: Vec<f64> = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let mut value = row[0];
            for (k, rise) in rises.iter().enumerate() {
                let (s, r) = place(j, k as f64 + 0.5);
                let terms = [1.0, s, r, s * s, s * r, r * r];
                let exponent: f64 =
                    terms.iter().zip(x.iter().skip(STATIC)).map(|(t, a)| t * a).sum();
                value += rise * exponent.exp();
                row[k + 1] = value;
            }
        }
        let mut g1_s = start.g1_s.clone();
        g1_s.constant *= x[LAG_CONSTANT].exp();
        for (j, row) in g1_s.nodes.iter_mut().enumerate() {
            for (k, value) in row.iter_mut().enumerate() {
                let (s, r) = place(j, k as f64);
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
        DynamicPreisach::new(DynamicParameters { g0_deg, g1_s, g2_s2_per_deg, ..start.clone() })
            .ok()
    }

    /// Weighted residuals of all records, one after another; none if the model diverges.
    fn residuals_of(&self, model: &DynamicPreisach) -> Option<DVector<f64>> {
        let mut residuals = Vec::new();
        for &&Prepared { record, spread_deg, .. } in self.records {
            let trained = record.trained_samples();
            let count = trained.len();
            let stride = count.div_ceil(MOST_RESIDUALS).max(1);
            let kept = count.div_ceil(stride) as f64 * self.records.len() as f64;
            let weight = 1.0 / (spread_deg * kept.sqrt());
            let first_volt = record.voltage_volt[0];
            let mut memory = PlayMemory::new(model.grid(), first_volt, StartState::Rest);
            let mut history = OutputHistory::at_rest(model.maps(&memory)[0]);
            let mut counts = StepCounts::default();
            let samples = record.voltage_volt.iter().zip(&record.output_deg).enumerate();
            for (i, (&u, &measured)) in samples.take(trained.end) {
                let output =
                    model.step(&mut memory, &mut history, &mut counts, u, record.time_step_s);
                if trained.contains(&i) && (i - trained.start).is_multiple_of(stride) {
                    residuals.push(weight * (output - measured));
                }
            }
        }
        let residuals = DVector::from_vec(residuals);
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    /// Root mean square of the NRMSE of the records.
    fn error(&self) -> Option<f64> {
        Some(self.residuals_of(self.model.as_ref()?)?.norm())
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.parameters.copy_from(x);
        self.model = self.build(x);
    }

    fn params(&self) -> DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.residuals_of(self.model.as_ref()?)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let here = self.residuals()?;
        let columns = (0..PARAMETERS)
            .into_par_iter()
            .map(|k| {
                let mut x = self.parameters.clone();
                x[k] += DIFFERENCE;
                let there = self.residuals_of(&self.build(&x)?)?;
                Some((there - &here) / DIFFERENCE)
            })
            .collect::<Option<Vec<_>>>()?;
        Some(DMatrix::from_columns(&columns))
    }
}
