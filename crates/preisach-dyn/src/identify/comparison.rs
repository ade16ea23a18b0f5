//! The table of all models, and which of them to use.

use super::families::{self, Family, Fitted, Given, Training};
use super::output_error::Estimate;
use super::prepared::Prepared;
use super::roles::{Bench, Sorted};
use super::{
    BenchRecord, FlapZero, Identifiability, RecordFit, RecordUse, Settings, compare, layered,
    static_fit, validate,
};
use crate::{ActuatorModel, PreisachError, PreisachGrid};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A simpler family is preferred if its error is at most this much larger.
const WITHIN: f64 = 1.03;

/// Levels of the memory and of the rate maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// Levels of the memory and of `mu0`.
    pub levels: usize,
    /// Levels of `mu1` and `mu2`; a divisor of `levels`.
    pub rate_levels: usize,
}

/// What a comparison tries.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Candidates {
    /// The families, the simplest first.
    pub families: Vec<Family>,
    /// Orders tried for the family chosen, beside that of the settings; none leaves it at that.
    pub orders: Vec<Order>,
}

impl Default for Candidates {
    /// All families; for the chosen one 12, 24 and 36 levels.
    fn default() -> Self {
        let order = |levels, rate_levels| Order { levels, rate_levels };
        Self { families: Family::ALL.to_vec(), orders: vec![order(12, 4), order(36, 4)] }
    }
}

/// How one family did.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelRow {
    /// The family.
    pub family: Family,
    /// Levels of its memory, where it has one.
    pub order: Order,
    /// Root mean square of the NRMSE of training experiments that were left out of the fit in turn;
    /// none if there were too few to leave one out.
    pub cross_validation: Option<f64>,
    /// The model fitted to all training records, or why there is none.
    pub fitted: Result<FittedModel, PreisachError>,
}

/// A fitted model with its fits.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedModel {
    /// The model.
    pub model: ActuatorModel,
    /// Its fit of every record, in the order given.
    pub fits: Vec<RecordFit>,
    /// Parameters that were found by output error, as the fit holds them, with their standard
    /// deviations.
    pub parameters: Vec<Estimate>,
}

/// The table of all models.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelComparison {
    /// One row per family, in the order asked for; the orders tried for the chosen one follow.
    pub rows: Vec<ModelRow>,
    /// The row to use.
    pub chosen: usize,
    /// Ids of the records and their uses, in the order given.
    pub records: Vec<(String, RecordUse)>,
    /// Output of the records that is zero flap angle of the models, deg.
    pub zero_deg: f64,
    /// What the records cannot tell.
    pub summary: Identifiability,
}

impl ModelComparison {
    /// The model to use; none if no family could be fitted.
    pub fn model(&self) -> Option<&ActuatorModel> {
        Some(&self.rows.get(self.chosen)?.fitted.as_ref().ok()?.model)
    }

    /// Root mean square and largest NRMSE of a row over the records of one use; none without any.
    pub fn error_over(&self, row: &ModelRow, record_use: RecordUse) -> Option<(f64, f64)> {
        let fits = &row.fitted.as_ref().ok()?.fits;
        let pairs = self.records.iter().zip(fits);
        let of_use: Vec<f64> =
            pairs.filter(|((_, u), _)| *u == record_use).map(|(_, fit)| fit.nrmse).collect();
        if of_use.is_empty() {
            return None;
        }
        let squares: f64 = of_use.iter().map(|e| e * e).sum();
        let largest = of_use.iter().copied().fold(0.0, f64::max);
        Some(((squares / of_use.len() as f64).sqrt(), largest))
    }
}

/// Fits every family to the same training records and chooses by cross-validation over experiments.
///
/// Each fast training record (each slow one where there are no fast ones) is left out of the fit in
/// turn and simulated. The family with the smallest error is chosen, a simpler one if it is within
/// 3 %; then the order of the memory likewise. Held-out records are never looked at for choosing:
/// they only stand in the table.
///
/// # Errors
/// As [`super::identify`] for the records; a family that cannot be fitted has its error in its row.
pub fn compare_models(
    records: &[BenchRecord],
    settings: &Settings,
    candidates: &Candidates,
) -> Result<ModelComparison, PreisachError> {
    let contest = Contest::new(records, settings)?;
    let own = Order { levels: settings.levels, rate_levels: settings.rate_levels };
    let mut rows: Vec<ModelRow> = candidates
        .families
        .par_iter()
        .map(|&family| contest.row(family, own))
        .collect::<Result<_, _>>()?;
    let mut chosen = best(&rows);
    if let Some(family) = rows.get(chosen).filter(|r| has_memory(r.family)).map(|r| r.family) {
        let others: Vec<ModelRow> = candidates
            .orders
            .par_iter()
            .filter(|order| **order != own)
            .map(|&order| contest.row(family, order))
            .collect::<Result<_, _>>()?;
        rows.extend(others);
        let mut by_levels: Vec<usize> =
            (0..rows.len()).filter(|&i| rows[i].family == family).collect();
        by_levels.sort_by_key(|&i| (rows[i].order.levels, rows[i].order.rate_levels));
        let ordered: Vec<ModelRow> = by_levels.iter().map(|&i| rows[i].clone()).collect();
        // nothing to choose by: the order asked for stands
        if ordered.iter().any(|row| row.cross_validation.is_some()) {
            chosen = by_levels[best(&ordered)];
        }
    }
    let Contest { bench, zero_deg, summary, .. } = contest;
    for row in &mut rows {
        if let Ok(fitted) = &mut row.fitted {
            fitted.model = fitted.model.clone().shifted(-zero_deg);
        }
    }
    let ids = records.iter().map(|r| r.id.clone());
    let records = ids.zip(bench.uses().iter().copied()).collect();
    Ok(ModelComparison { rows, chosen, records, zero_deg, summary })
}

fn has_memory(family: Family) -> bool {
    !matches!(
        family,
        Family::Linear | Family::LinearLag | Family::BoucWen | Family::PrandtlIshlinskii
    )
}

/// The row with the smallest cross-validated error, an earlier one if it is nearly as good; without
/// cross-validation the static Preisach model, or what could be fitted at all.
fn best(rows: &[ModelRow]) -> usize {
    let error = |row: &ModelRow| row.fitted.as_ref().ok().and(row.cross_validation);
    let least = rows.iter().filter_map(error).fold(f64::INFINITY, f64::min);
    let near = rows.iter().position(|row| error(row).is_some_and(|e| e <= WITHIN * least));
    let of = |family: Family| move |row: &ModelRow| row.family == family && row.fitted.is_ok();
    near.filter(|_| least.is_finite())
        .or_else(|| rows.iter().position(of(Family::DynamicPreisach)))
        .or_else(|| rows.iter().position(of(Family::StaticPreisach)))
        .or_else(|| rows.iter().position(|row| row.fitted.is_ok()))
        .unwrap_or(0)
}

/// Records made ready for all families.
struct Contest<'a> {
    bench: Bench<'a>,
    settings: &'a Settings,
    zero_deg: f64,
    summary: Identifiability,
    smoothness: f64,
}

impl<'a> Contest<'a> {
    fn new(records: &'a [BenchRecord], settings: &'a Settings) -> Result<Self, PreisachError> {
        let grid = PreisachGrid::new(settings.range_volt, settings.levels.max(1))?;
        let bench = Bench::new(records, settings)?;
        let prepared = bench.prepared(&grid, settings)?;
        let Sorted { slow, fast } = Sorted::of(&prepared)?;
        let summary = bench.summary(&grid, &prepared, settings);
        let zero_deg = match settings.zero {
            FlapZero::AsRecorded => 0.0,
            FlapZero::MajorLoopMean => super::major_loop_mean(&slow),
        };
        // one smoothness for all folds, chosen on the training records
        let measured: Vec<Vec<f64>> = slow.iter().map(|r| r.record.output_deg.clone()).collect();
        let map = static_fit::fit(&grid, &slow, &measured, settings)?;
        let smoothness = validate::smoothness(&grid, &map, &fast, settings).0;
        Ok(Self { bench, settings, zero_deg, summary, smoothness })
    }

    fn row(&self, family: Family, order: Order) -> Result<ModelRow, PreisachError> {
        let Order { levels, rate_levels } = order;
        let settings = Settings { levels, rate_levels, ..self.settings.clone() };
        settings.check()?;
        let grid = PreisachGrid::new(settings.range_volt, levels)?;
        let prepared = self.bench.prepared(&grid, &settings)?;
        let Sorted { slow, fast } = Sorted::of(&prepared)?;
        let fit = |slow: &[&Prepared], fast: &[&Prepared], creep_per_decade: Option<f64>| {
            let training = Training { grid: &grid, slow, fast, settings: &settings };
            let given = Given { smoothness: self.smoothness, creep_per_decade };
            families::fit(family, training, given)
        };
        let fitted = fit(&slow, &fast, None).and_then(|Fitted { mut model, parameters }| {
            model.trained = Some(super::trained_range(&slow, &fast, &prepared));
            let fits = prepared.iter().map(|r| compare::compare(&model, r));
            let fits = fits.collect::<Result<Vec<_>, _>>()?;
            Ok(FittedModel { model, fits, parameters })
        });
        // left out in turn: a fast record, or a slow one where there are no fast ones
        let folds = if fast.len() >= 2 { fast.len() } else { 0 };
        let folds = if fast.is_empty() && slow.len() >= 3 { slow.len() } else { folds };
        let creep = fitted.as_ref().ok().and_then(|f| layered::creep_per_decade(&f.model));
        let left_out = |index: usize| -> Result<f64, PreisachError> {
            let drop = |part: &[&_], is_part: bool| -> Vec<usize> {
                (0..part.len()).filter(|&i| !(is_part && i == index)).collect()
            };
            let (keep_slow, keep_fast) =
                (drop(&slow, fast.is_empty()), drop(&fast, !fast.is_empty()));
            let own_slow: Vec<&Prepared> = keep_slow.iter().map(|&i| slow[i]).collect();
            let own_fast: Vec<&Prepared> = keep_fast.iter().map(|&i| fast[i]).collect();
            let tested = if fast.is_empty() { slow[index] } else { fast[index] };
            compare::training_nrmse(&fit(&own_slow, &own_fast, creep)?.model, tested)
        };
        let cross_validation = (folds > 0 && fitted.is_ok()).then(|| {
            let errors: Vec<f64> = (0..folds)
                .into_par_iter()
                .map(|index| left_out(index).unwrap_or(f64::INFINITY).powi(2))
                .collect();
            (errors.iter().sum::<f64>() / folds as f64).sqrt()
        });
        Ok(ModelRow { family, order, cross_validation, fitted })
    }
}
