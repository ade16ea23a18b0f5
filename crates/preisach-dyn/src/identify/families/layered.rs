//! Fits of Preisach laws with linear stages behind them.

use crate::identify::BenchRecord;
use crate::identify::families::family::{Family, Fitted, Given, Search, share};
use crate::identify::fit::output_error::{Minimum, Pull, Slopes};
use crate::identify::fit::preisach::RateFit;
use crate::identify::fit::refine::{Refined, SHAPE, reshaped};
use crate::identify::fit::training::Training;
use crate::identify::fit::{compare, static_fit};
use crate::identify::records::prepared::Prepared;
use crate::{
    Accommodation, ActuatorLaw, ActuatorModel, Calibration, LinkageStage, LogCreep, PlayMap,
    PreisachError, Relaxation, RelaxationElement, StaticPreisach,
};
use actuator_stages::{StageStep, Step};
use nalgebra::DVector;
use rayon::prelude::*;

/// Rates of creep per decade that are tried.
const CREEP_RATES: [f64; 5] = [0.005, 0.01, 0.015, 0.02, 0.03];
/// Rates that are tried near a known one, over it.
const RATIOS_NEAR_BY: [f64; 3] = [0.7, 1.0, 1.3];
/// Rounds of static map and stages.
const ROUNDS: usize = 5;
/// Least and largest creep per decade of a fit.
const LEAST_CREEP: f64 = 1e-4;
const MOST_CREEP: f64 = 0.06;

/// A record with a linear stage behind the law taken off its output.
///
/// The output of a linear stage is `a + b u` of its input `u` at the sample, with `a` and `b` known
/// from the past: solved for `u` sample by sample. Only for stages that answer at once (`b` near 1);
/// a lag would raise the noise.
fn without_stage(record: &BenchRecord, stage: &StageStep) -> BenchRecord {
    let mut record = record.clone();
    let Some(&first) = record.output_deg.first() else {
        return record;
    };
    let mut memory = stage.start(first).0;
    for output in record.output_deg.iter_mut().skip(1) {
        let at = |input: f64| stage.advance(&mut memory.clone(), input);
        let (zero, one) = (at(0.0), at(1.0));
        let input = (*output - zero) / (one - zero);
        stage.advance(&mut memory, input);
        *output = input;
    }
    record
}

/// Static or dynamic Preisach before creep: the rate of creep that fits the training records best, the law
/// fitted to the records with that creep taken off. The time it begins is given.
pub(crate) fn creep(
    family: Family,
    training: &Training<'_>,
    given: Given<'_>,
) -> Result<Fitted, PreisachError> {
    let (grid, settings, all) = (training.grid, training.settings, training.all());
    let unit = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    let fit_with = |creep: LogCreep| -> Result<(f64, Fitted), PreisachError> {
        let creep = LinkageStage::LogCreep(creep);
        let strip =
            |r: &&Prepared| without_stage(r.record, &creep.prepared(r.record.time_step_s, &unit));
        let stripped: Vec<BenchRecord> = all.iter().map(strip).collect();
        let prepare = |(r, record)| {
            let r: &&Prepared = r;
            let drive = r.drive.clone();
            let own = Prepared::new(record, drive, r.record_use, r.is_slow, &grid, settings);
            own.map(|own| own.without(r.left_out.clone()))
        };
        let own = all.iter().zip(&stripped).map(prepare).collect::<Result<Vec<_>, _>>()?;
        let own = Training::of(&own, grid, settings)?;
        let map = static_fit::as_measured(&own)?;
        let (law, parameters) = if family.needs_rate() {
            let fit = RateFit::new(&own, map, given.uncertainty())?;
            let Refined { law, parameters, .. } = fit.refined;
            (law, parameters)
        } else {
            let law = StaticPreisach::new(grid, map)?;
            (ActuatorLaw::StaticPreisach(law), Vec::new())
        };
        let mut model = settings.actuator_of(law);
        model.linkage.push(creep);
        let squares = all.iter().map(|r| Ok(compare::training_nrmse(&model, r)?.powi(2)));
        Ok((squares.sum::<Result<f64, PreisachError>>()?, Fitted { model, parameters }))
    };
    if let Some(known) = given.whole.and_then(Fitted::log_creep) {
        return Ok(fit_with(known)?.1);
    }
    let (from_s, rates) = match given.creep {
        Some(known) => (known.from_s, RATIOS_NEAR_BY.map(|r| r * known.rate_per_decade).to_vec()),
        None => (given.creep_from_s, CREEP_RATES.to_vec()),
    };
    let fit_at = |rate: f64| fit_with(LogCreep { from_s, ..LogCreep::new(rate) });
    let tried: Vec<_> = rates.par_iter().map(|&rate| fit_at(rate)).collect();
    let mut tried = tried.into_iter().collect::<Result<Vec<_>, _>>()?;
    let squares: Vec<f64> = tried.iter().map(|own| own.0).collect();
    // what is left is nearly a parabola of the rate
    if let Some(rate) = lowest(&rates, &squares) {
        tried.push(fit_at(rate)?);
    }
    let best = tried.into_iter().reduce(|best, next| if next.0 < best.0 { next } else { best });
    best.map(|(_, fitted)| fitted).ok_or(PreisachError::NotFitted { family: family.name() })
}

/// The rate of creep at the lowest point of the parabola through the best one tried and its neighbours; none of fewer than
/// three, or where they lie on no such parabola.
fn lowest(rates: &[f64], squares: &[f64]) -> Option<f64> {
    let best = (0..squares.len()).min_by(|&a, &b| squares[a].total_cmp(&squares[b]))?;
    let first = best.saturating_sub(1).min(rates.len().checked_sub(3)?);
    let (r, s) = (&rates[first..first + 3], &squares[first..first + 3]);
    let slopes = [(s[1] - s[0]) / (r[1] - r[0]), (s[2] - s[1]) / (r[2] - r[1])];
    let bend = (slopes[1] - slopes[0]) / (r[2] - r[0]);
    (bend > 0.0).then(|| (0.5 * (r[0] + r[1] - slopes[0] / bend)).clamp(LEAST_CREEP, MOST_CREEP))
}

/// Parameters of the stages of [`relaxation`].
const STAGES: usize = 5;

/// Static Preisach before accommodation, one relaxation time, a share that follows at once, and creep. A
/// second time is left out: runs at two frequencies do not carry it beyond them.
///
/// ```text
/// y = creep[ (1 - f) x + f A ],   T dx/dt + x = A,   A = accommodation[G_0],   0 < f < 0.3
/// ```
/// Rounds of two steps: output error over the stages, twelve numbers in all, with the change of the
/// density held to the exponential of a quadratic form; then the density anew from the slow records with
/// what the stages add taken off.
pub(crate) fn relaxation(
    training: &Training<'_>,
    given: Given<'_>,
) -> Result<Fitted, PreisachError> {
    let (settings, all) = (training.settings, training.all());
    let mut map = match given.whole {
        Some(whole) => remapped(training, &whole.model)?,
        None => static_fit::as_measured(training)?,
    };
    let everywhere =
        [(0.02, -6.0), (0.02, -1.5), (0.004, -3.0)].map(|(time_s, at_once): (f64, f64)| {
            let mut x = vec![time_s.ln(), at_once, -2.0, 0.25, -1.0];
            x.resize(STAGES + SHAPE, 0.0);
            DVector::from_vec(x)
        });
    let rounds = if given.whole.is_some() { 2 } else { ROUNDS };
    let mut starts = given.starts(&everywhere);
    let stroke_um = (map.largest().0 - map.constant) / settings.deg_per_um.abs();
    let built = |held: &PlayMap, x: &DVector<f64>| {
        let law =
            StaticPreisach::new(training.grid, reshaped(held, &x.as_slice()[STAGES..])).ok()?;
        let model = settings.actuator_of(ActuatorLaw::StaticPreisach(law));
        Some(with_stages(model, x, stroke_um))
    };
    let family = Family::StaticPreisachRelaxation;
    let mut best: Option<(Minimum, PlayMap, [Pull; STAGES])> = None;
    let mut misfit = USUAL_NRMSE;
    for round in 1..=rounds {
        let build = |x: &DVector<f64>| built(&map, x);
        // the first round only finds where to go on from, a fold what it misses
        let is_rough = given.whole.is_some() || round == 1;
        let slopes = if is_rough { Slopes::Thinned } else { Slopes::Exact };
        let pulls = pulls(misfit);
        let search =
            Search { family, build: &build, records: &all, names: &NAMES, pulls: &pulls, slopes };
        let minimum = search.minimum(&starts)?;
        misfit = misfit.min(minimum.nrmse);
        // the next map asks for nearly the same change
        starts = vec![minimum.x.clone()];
        let held = map.clone();
        if round < rounds {
            map = remapped(training, &minimum.model)?;
        }
        if best.as_ref().is_none_or(|(least, ..)| minimum.nrmse < least.nrmse) {
            best = Some((minimum, held, pulls));
        }
    }
    let (minimum, held, pulls) = best.ok_or(PreisachError::NotFitted { family: family.name() })?;
    let build = |x: &DVector<f64>| built(&held, x);
    let slopes = Slopes::Exact;
    let search =
        Search { family, build: &build, records: &all, names: &NAMES, pulls: &pulls, slopes };
    Ok(search.fitted(minimum, given.uncertainty()))
}

/// Largest share that settles with the way.
const MOST_LATE: f64 = 0.5;
/// Largest share that follows at once.
const MOST_AT_ONCE: f64 = 0.3;

/// What is known of the stages beforehand, and how well: 1 or 2 % at once, 1.4 % of creep per decade, 6 %
/// of accommodation over a third of the stroke. Nothing of the relaxation time.
const KNOWN: [(f64, f64); STAGES] =
    [(0.0, f64::INFINITY), (-3.0, 1.0), (-1.2, 1.0), (0.25, 0.15), (-1.0, 1.0)];
/// Misfit expected before there is one.
const USUAL_NRMSE: f64 = 0.015;
/// Independent residuals that a set of records is worth, roughly.
const INDEPENDENT: f64 = 200.0;

/// Pulls that weigh what is known against records that leave a misfit: `nrmse / (sqrt(n) sigma)`.
fn pulls(nrmse: f64) -> [Pull; STAGES] {
    KNOWN.map(|(at, deviation)| {
        let weight = nrmse / (INDEPENDENT.sqrt() * deviation);
        Pull { at, weight, deviation }
    })
}

const NAMES: [&str; STAGES + SHAPE] = [
    "ln relaxation time, s",
    "share at once, logit",
    "creep per decade, logit",
    "root of the share of the accommodation",
    "ln travel of the accommodation over the stroke",
    "offset, deg",
    "ln mu0",
    "ln mu0 per centre",
    "ln mu0 per half-width",
    "ln mu0 per centre^2",
    "ln mu0 per centre x half-width",
    "ln mu0 per half-width^2",
];

fn with_stages(mut model: ActuatorModel, x: &DVector<f64>, stroke_um: f64) -> ActuatorModel {
    model.linkage.push(LinkageStage::Accommodation(Accommodation {
        share: (x[3] * x[3]).min(MOST_LATE),
        travel_um: stroke_um * x[4].exp(),
    }));
    let at_once = MOST_AT_ONCE * share(x[1]);
    let elements = vec![RelaxationElement { share: 1.0 - at_once, time_constant_s: x[0].exp() }];
    model.linkage.push(LinkageStage::Relaxation(Relaxation { elements }));
    model.linkage.push(LinkageStage::LogCreep(LogCreep::new(MOST_CREEP * share(x[2]))));
    model
}

/// The static map of the slow records with what the stages add to the law's output taken off.
pub(crate) fn remapped(
    training: &Training<'_>,
    model: &ActuatorModel,
) -> Result<PlayMap, PreisachError> {
    let bare = ActuatorModel { linkage: Vec::new(), ..model.clone() };
    let targets = training
        .slow
        .iter()
        .map(|r| {
            let record = r.record;
            let law = bare.simulate(&record.voltage_volt, record.time_step_s)?.output_deg;
            let mut whole = law.clone();
            for stage in &model.linkage {
                stage.prepared(record.time_step_s, &model.calibration).pass(&mut whole);
            }
            let triples = record.output_deg.iter().zip(whole.iter().zip(&law));
            Ok(triples.map(|(y, (a, b))| y - (a - b)).collect())
        })
        .collect::<Result<Vec<Vec<f64>>, PreisachError>>()?;
    static_fit::fit(training, &targets)
}
