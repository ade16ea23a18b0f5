//! The table of all models, and which of them to use.

use crate::identify::families::by_family;
use crate::identify::families::family::{Family, Fitted, Given};
use crate::identify::families::folds::{self, Fold, Folds, LeftOut};
use crate::identify::fit::linear_mode::LinearMode;
use crate::identify::fit::output_error::Estimate;
use crate::identify::fit::preisach::trained_range;
use crate::identify::fit::roles::Bench;
use crate::identify::fit::training::Training;
use crate::identify::fit::{compare, static_fit, validate};
use crate::identify::records::prepared::Prepared;
use crate::identify::{
    BenchRecord, Identifiability, RecordFit, RecordUse, RestNoise, Settings, Waveform,
};
use crate::{ActuatorModel, PreisachError, PreisachGrid};
use rayon::prelude::*;
use rotor_base::mean_square;
use serde::{Deserialize, Serialize};

/// A simpler family is preferred if its error is at most this much larger.
const WITHIN: f64 = 1.03;

/// What another time at which creep begins must leave of the error to stand in the place of the usual one.
const CLEARLY: f64 = 0.95;

/// Levels of the memory and of the rate maps, smoothness of the density.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// Levels of the memory and of `mu0`.
    pub levels: usize,
    /// Levels of `mu1` and `mu2`; a divisor of `levels`.
    pub rate_levels: usize,
    /// Weight of the smoothness of `mu0`.
    pub static_smoothness: f64,
}

impl Order {
    /// The order of some settings.
    pub fn of(settings: &Settings) -> Self {
        let Settings { levels, rate_levels, static_smoothness, .. } = *settings;
        Self { levels, rate_levels, static_smoothness }
    }

    /// Settings with this order in the place of theirs.
    pub(crate) fn within(self, settings: &Settings) -> Settings {
        let Self { levels, rate_levels, static_smoothness } = self;
        Settings { levels, rate_levels, static_smoothness, ..settings.clone() }
    }
}

/// What a comparison tries.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Candidates {
    /// The families, the simplest first. Where these are all, those with a mode are left out unless training records
    /// show one: neither a gain nor a lag comes near what a mode explains.
    pub families: Vec<Family>,
    /// Orders tried for the family chosen, beside that of the settings; none leaves it at that.
    pub orders: Vec<Order>,
    /// Noise of the outputs that records at rest show beside those compared, deg; none leaves it to what is compared.
    pub rest_noise_deg: Option<f64>,
}

impl Default for Candidates {
    /// All families; for the chosen one 12 and 24 levels, the density smooth and less so.
    fn default() -> Self {
        let order =
            |(levels, static_smoothness)| Order { levels, rate_levels: 4, static_smoothness };
        let orders = [(12, 1e-4), (12, 1e-6), (24, 1e-4), (24, 1e-6)].map(order);
        Self { families: Family::ALL.to_vec(), orders: orders.to_vec(), rest_noise_deg: None }
    }
}

/// How one family did.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelRow {
    /// The family.
    pub family: Family,
    /// Order of its memory, where it has one.
    pub order: Order,
    /// Root mean square of the NRMSE of what was left out of the fit in turn, [`ModelComparison::left_out`]; none if nothing
    /// could be left out.
    pub cross_validation: Option<f64>,
    /// What the noise contributes to it, as a share of the spread; 0 where it is not known. A model that misses nothing has
    /// this error.
    pub noise: f64,
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
    /// One row per family, as asked for.
    pub rows: Vec<ModelRow>,
    /// What was left out of the fits in turn.
    pub left_out: LeftOut,
    /// The row of the family chosen.
    pub chosen: usize,
    /// The chosen family on several grids, by levels; here slow records are left out in turn too, so
    /// that the errors of cross-validation stand apart from those of `rows`.
    pub orders: Vec<ModelRow>,
    /// The row of the order chosen; means nothing if `orders` is empty.
    pub chosen_order: usize,
    /// Ids of the records and their uses, in the order given.
    pub records: Vec<(String, RecordUse)>,
    /// Output of the records that is zero flap angle of the models, deg.
    pub zero_deg: f64,
    /// What the records cannot tell.
    pub summary: Identifiability,
    /// Weight of the smoothness of the rate maps, of all fits.
    pub rate_smoothness: f64,
}

impl ModelComparison {
    /// The model to use; none if no family could be fitted.
    pub fn model(&self) -> Option<&ActuatorModel> {
        Some(&self.best()?.fitted.as_ref().ok()?.model)
    }

    /// The row to use: family and order.
    pub fn best(&self) -> Option<&ModelRow> {
        self.orders.get(self.chosen_order).or_else(|| self.rows.get(self.chosen))
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
        Some((mean_square(&of_use).sqrt(), of_use.iter().copied().fold(0.0, f64::max)))
    }
}

/// Fits every family to the same training records and chooses by cross-validation over experiments.
///
/// All fast training records of one frequency are left out of the fit in turn and simulated, then all
/// of one amplitude: conditions, because the model will be used at others than the bench ran. Where no
/// record is fast, each slow one is left out in turn. Of a single training record it is blocks in time: the model is run
/// through the whole record and scored on the block. The family with the smallest error is chosen, a simpler one if it is
/// within 3 %, both after the noise is taken off that repeated cycles, records at rest or, of a single record, differences of
/// neighbours show; then the order of the memory with the smallest error: there smoothness keeps large grids in check.
/// Held-out records are never looked at for choosing: they only stand in the table. `done` is called after each row.
///
/// # Errors
/// As [`crate::identify::identify`] for the records; a family that cannot be fitted has its error in its row.
pub fn compare_models(
    records: &[BenchRecord],
    settings: &Settings,
    candidates: &Candidates,
    done: &(dyn Fn() + Sync),
) -> Result<ModelComparison, PreisachError> {
    let bench = Bench::new(records, settings)?;
    let contest = Contest::new(&bench, settings, candidates)?;
    let own = Order::of(settings);
    let (rows, trials): (Vec<ModelRow>, Vec<Option<Trial>>) = contest
        .families
        .par_iter()
        .map(|&family| contest.row(family, own, Folds::Conditions, None).inspect(|_| done()))
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .unzip();
    let chosen = best(&rows, WITHIN);
    let (mut orders, mut chosen_order) = (Vec::new(), 0);
    // the simpler families have no memory of levels
    let family =
        rows.get(chosen).filter(|row| row.family >= Family::StaticPreisach).map(|row| row.family);
    if let (Some(family), false) = (family, candidates.orders.is_empty()) {
        let mut tried = candidates.orders.clone();
        tried.push(own);
        // the simplest first: few levels, smooth
        tried.sort_by(|a, b| {
            let levels = (a.levels, a.rate_levels).cmp(&(b.levels, b.rate_levels));
            levels.then(b.static_smoothness.total_cmp(&a.static_smoothness))
        });
        tried.dedup();
        orders = tried
            .par_iter()
            .map(|&order| {
                let known = trials[chosen].as_ref();
                Ok(contest.row(family, order, Folds::All, known).inspect(|_| done())?.0)
            })
            .collect::<Result<Vec<_>, PreisachError>>()?;
        // nothing to choose by: the order asked for stands
        let by_error = orders.iter().any(|row| row.cross_validation.is_some());
        let asked_for = tried.iter().position(|order| *order == own);
        chosen_order = if by_error { best(&orders, 1.0) } else { asked_for.unwrap_or(0) };
    }
    let Contest { zero_deg, summary, left_out, smoothness: rate_smoothness, .. } = contest;
    let ids = records.iter().map(|r| r.id.clone());
    let records = ids.zip(bench.uses().iter().copied()).collect();
    Ok(ModelComparison {
        rows,
        left_out,
        chosen,
        orders,
        chosen_order,
        records,
        zero_deg,
        summary,
        rate_smoothness,
    })
}

/// The fit of a family to all training records, and the errors of the folds left out.
#[derive(Debug, Clone)]
struct Trial {
    whole: Fitted,
    errors: Vec<f64>,
}

impl Trial {
    /// Root mean square error of what was left out; none where nothing was.
    fn error(&self) -> Option<f64> {
        let mean = self.errors.iter().sum::<f64>() / self.errors.len() as f64;
        (!self.errors.is_empty()).then(|| mean.sqrt())
    }
}

/// The row with the smallest cross-validated error, an earlier one if it is at most `within` times it, both without
/// noise; without cross-validation the static Preisach model, or what could be fitted at all.
fn best(rows: &[ModelRow], within: f64) -> usize {
    let error = |row: &ModelRow| row.fitted.as_ref().ok().and(row.cross_validation);
    let least = rows.iter().filter_map(error).fold(f64::INFINITY, f64::min);
    // the squares of misfit and noise add; where noise is all there is, the smallest error stands
    let excess = |row: &ModelRow, error: f64| error * error - row.noise.min(least).powi(2);
    let is_near = |row: &ModelRow, e| excess(row, e) <= within * within * excess(row, least);
    let near = rows.iter().position(|row| error(row).is_some_and(|e| is_near(row, e)));
    let of = |family: Family| move |row: &ModelRow| row.family == family && row.fitted.is_ok();
    near.filter(|_| least.is_finite())
        .or_else(|| rows.iter().position(of(Family::DynamicPreisach)))
        .or_else(|| rows.iter().position(of(Family::StaticPreisach)))
        .or_else(|| rows.iter().position(|row| row.fitted.is_ok()))
        .unwrap_or(0)
}

/// Records made ready for all families.
struct Contest<'a> {
    bench: &'a Bench<'a>,
    /// With the memory that the settings ask for.
    prepared: Vec<Prepared<'a>>,
    settings: &'a Settings,
    zero_deg: f64,
    summary: Identifiability,
    smoothness: f64,
    families: Vec<Family>,
    mode: Option<LinearMode>,
    /// What is left out of the fits of families.
    left_out: LeftOut,
    /// Noise that records at rest show, deg.
    rest_noise_deg: Option<f64>,
}

impl<'a> Contest<'a> {
    fn new(
        bench: &'a Bench<'a>,
        settings: &'a Settings,
        candidates: &Candidates,
    ) -> Result<Self, PreisachError> {
        let grid = PreisachGrid::new(settings.range_volt, settings.levels.max(1))?;
        let prepared = bench.prepared(&grid, settings)?;
        let training = Training::of(&prepared, grid, settings)?;
        let (summary, zero_deg) = (bench.summary(&training), bench.zero_deg(&training));
        // one smoothness for all folds, chosen on the training records
        let map = static_fit::as_measured(&training)?;
        let smoothness = validate::smoothness(&training, &map).0;
        let mut families = candidates.families.clone();
        let wanted = families.iter().any(|family| family.has_mode());
        let mode = wanted.then(|| LinearMode::of(&training)).transpose()?;
        // among all families those that no record asks for; named ones are wanted as they stand
        if families == Family::ALL && !mode.is_some_and(|found| found.is_shown) {
            families.retain(|family| !family.has_mode());
        }
        let left_out = LeftOut::of(&folds::of(&training, Folds::Conditions));
        let rests = prepared.iter().filter(|r| r.drive.waveform == Waveform::Constant);
        let rests: Vec<f64> = rests.map(|r| RestNoise::of_record(r.record).rms_deg()).collect();
        let own = (!rests.is_empty()).then(|| mean_square(&rests).sqrt());
        Ok(Self {
            bench,
            prepared,
            settings,
            zero_deg,
            summary,
            smoothness,
            families,
            mode,
            left_out,
            rest_noise_deg: candidates.rest_noise_deg.or(own),
        })
    }

    /// A row of the table, and what a row with more folds can go on from; `known`: what one with fewer left, or of another
    /// order, which tells the time that creep begins.
    ///
    /// Of several such times the one with the smallest error of what is left out stands.
    fn row(
        &self,
        family: Family,
        order: Order,
        which: Folds,
        known: Option<&Trial>,
    ) -> Result<(ModelRow, Option<Trial>), PreisachError> {
        let settings = order.within(self.settings);
        settings.check()?;
        let grid = PreisachGrid::new(settings.range_volt, order.levels)?;
        let is_own = order == Order::of(self.settings);
        let anew = (!is_own).then(|| self.bench.prepared(&grid, &settings)).transpose()?;
        let prepared = anew.as_ref().unwrap_or(&self.prepared);
        let training = Training::of(prepared, grid, &settings)?;
        let folds = folds::of(&training, which);
        let begun = known.and_then(|known| known.whole.log_creep()).map(|creep| [creep.from_s]);
        let begins = begun.as_ref().map_or(family.creep_begins_s(), |begun| begun.as_slice());
        let known = known.filter(|_| is_own);
        let trials = begins.par_iter().map(|&s| self.trial(family, &training, &folds, s, known));
        let trials: Vec<Result<Trial, PreisachError>> = trials.collect();
        let error = |trial: &Result<Trial, PreisachError>| {
            trial.as_ref().ok().and_then(Trial::error).unwrap_or(f64::INFINITY)
        };
        // the usual time stands where nothing is left out or another one is not clearly better
        let is_better = |b: &_, a: &_| error(b) < CLEARLY * error(a);
        let best = trials.into_iter().reduce(|a, b| if is_better(&b, &a) { b } else { a });
        let trial = best.unwrap_or(Err(PreisachError::NotFitted { family: family.name() }));
        let noise = folds::noise(&training, &folds, self.rest_noise_deg);
        let cross_validation = trial.as_ref().ok().and_then(Trial::error);
        let fit = |trial: &Trial| {
            let Fitted { mut model, parameters } = trial.whole.clone();
            model.trained = Some(trained_range(&training, prepared));
            let fits = prepared.iter().map(|r| compare::compare(&model, r));
            let fits = fits.collect::<Result<Vec<_>, _>>()?;
            let model = self.bench.rigged(model, &training);
            Ok(FittedModel { model, fits, parameters })
        };
        let fitted = trial.as_ref().map_err(Clone::clone).and_then(fit);
        Ok((ModelRow { family, order, cross_validation, noise, fitted }, trial.ok()))
    }

    /// A family fitted to all training records and to all but each fold, creep begun at a time.
    fn trial(
        &self,
        family: Family,
        training: &Training<'_>,
        folds: &[Fold],
        creep_from_s: f64,
        known: Option<&Trial>,
    ) -> Result<Trial, PreisachError> {
        let (smoothness, mode) = (self.smoothness, self.mode.as_ref());
        let fit = |training: &Training, whole: Option<&Fitted>| {
            let given = Given { smoothness, mode, whole, creep: None, creep_from_s };
            by_family::fit(family, training, given)
        };
        let whole = known.map_or_else(|| fit(training, None), |known| Ok(known.whole.clone()))?;
        let left_out =
            |fold: &Fold| fold.square_error(training, |rest| Ok(fit(rest, Some(&whole))?.model));
        let mut errors = known.map_or_else(Vec::new, |known| known.errors.clone());
        // the folds of conditions come first
        let rest = folds.get(errors.len()..).unwrap_or_default().par_iter();
        let rest = rest.map(|fold| left_out(fold).unwrap_or(f64::INFINITY));
        errors.extend(rest.collect::<Vec<f64>>());
        Ok(Trial { whole, errors })
    }
}
