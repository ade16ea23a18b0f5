//! Identification of an actuator from bench records.
//!
//! ```text
//! records -> period and steady cycles from the command -> split by experiment
//!   mu0        quasi-static records: constrained least squares on the plays
//!   mu1, mu2   steady cycles at the trained frequencies: constrained least squares
//!   again      mu0 once more with the rate terms taken off, and so on
//!   refine     output error: simulate the records, Levenberg-Marquardt on a few numbers
//! ```
//! Equation error alone is biased, and the quasi-static records contain dynamics too: hence the
//! last two steps. Refinement must lower the error of the training records or it is dropped.

mod compare;
mod comparison;
mod drive;
mod families;
mod findings;
mod flat_top;
mod fourier;
mod layered;
mod noise;
mod output_error;
mod passage;
mod plausibility;
mod prepared;
pub(crate) mod program;
mod rate_fit;
mod record;
mod refine;
mod repetition;
mod roles;
mod settings;
mod spikes;
mod split_rule;
pub(crate) mod static_fit;
mod stop_fit;
mod stream;
mod subject;
mod validate;

pub use compare::RecordFit;
pub use comparison::{Candidates, FittedModel, ModelComparison, ModelRow, Order, compare_models};
pub use drive::{Drive, Waveform};
pub use families::Family;
pub use findings::{Finding, Identifiability, Severity};
pub use noise::CycleNoise;
pub use output_error::{Covariance, Estimate};
pub use program::QpStatus;
pub use record::{BenchRecord, RecordUse, RecordWindows};
pub use refine::{Refinement, RefinementOutcome};
pub use settings::{FlapZero, RateSmoothness, Settings};
pub use split_rule::SplitRule;
pub use stream::StaticAccumulator;
pub use subject::Subject;
pub use validate::Validation;

use crate::{
    ActuatorLaw, ActuatorModel, DynamicPreisach, LinearGain, PlayMap, PlayMemory, PreisachError,
    PreisachGrid, StartState, StaticPreisach, TrainedRange,
};
use output_error::Uncertainty;
use prepared::Prepared;
use roles::{Bench, Sorted};

/// What the identification says about one record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordReport {
    /// The record.
    pub id: String,
    /// Trained or held out.
    pub record_use: RecordUse,
    /// Its command.
    pub drive: Drive,
    /// Scatter of its repeated cycles; none for transients and where only one cycle is steady.
    pub noise: Option<CycleNoise>,
    /// The linear gain against it.
    pub linear: RecordFit,
    /// The static Preisach model against it.
    pub static_only: RecordFit,
    /// The dynamic Preisach model against it.
    pub dynamic: RecordFit,
}

/// An identified actuator, its baselines, and how they fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The dynamic Preisach model; the static one where the records say nothing about rate, which
    /// the summary then states.
    pub dynamic: ActuatorModel,
    /// Baseline: the static Preisach model fitted to the same quasi-static records.
    pub static_only: ActuatorModel,
    /// Baseline: the linear gain fitted to the same quasi-static records.
    pub linear: ActuatorModel,
    /// Output of the records that is zero flap angle of the models, deg: a model reproduces
    /// `output_deg - zero_deg`.
    pub zero_deg: f64,
    /// Per record, in the order given.
    pub records: Vec<RecordReport>,
    /// Weight of the smoothness of the rate maps that was used.
    pub rate_smoothness: f64,
    /// What its choice rests on; empty if it was given.
    pub validation: Vec<Validation>,
    /// What the refinement did.
    pub refinement: Refinement,
    /// The refined parameters, as corrections to the model of the fits before it, with their standard
    /// deviations; empty for a static model.
    pub parameters: Vec<Estimate>,
    /// Their covariance; none for a static model or where a parameter has no influence.
    pub covariance: Option<Covariance>,
    /// What the records cannot tell.
    pub summary: Identifiability,
}

impl Identification {
    /// The reports of the records of one use.
    pub fn records_of(&self, record_use: RecordUse) -> impl Iterator<Item = &RecordReport> {
        self.records.iter().filter(move |report| report.record_use == record_use)
    }
}

/// Identifies an actuator from bench records.
///
/// Where the training records say nothing about rate (one frequency, no periodic run beyond the slow
/// ones) the dynamic model returned is the static one, and [`Identification::summary`] says why.
///
/// Assumes: every record starts at rest at its first voltage; equally spaced samples.
///
/// # Errors
/// Refused settings or records; [`PreisachError::UnitMismatch`] or [`PreisachError::SwappedColumns`]
/// for columns that cannot be what they are called; [`PreisachError::NoTrainingRecord`] if no record
/// moves; [`PreisachError::QuadraticProgram`] if a fit is not solved; [`PreisachError::Diverged`] if
/// a Literal model runs away on a record.
pub fn identify(
    records: &[BenchRecord],
    settings: &Settings,
) -> Result<Identification, PreisachError> {
    let grid = PreisachGrid::new(settings.range_volt, settings.levels.max(1))?;
    let bench = Bench::new(records, settings)?;
    let prepared = bench.prepared(&grid, settings)?;
    let Sorted { slow, fast } = Sorted::of(&prepared)?;
    let mut summary = bench.summary(&grid, &prepared, settings);

    let trained = Some(trained_range(&slow, &fast, &prepared));
    let wrap = |law| ActuatorModel { trained, ..settings.actuator_of(law) };
    let linear = wrap(ActuatorLaw::Linear(fit_linear(&slow)));
    let measured: Vec<Vec<f64>> = slow.iter().map(|r| r.record.output_deg.clone()).collect();
    let g0_deg = static_fit::fit(&grid, &slow, &measured, settings)?;
    let statics = StaticPreisach::new(grid, g0_deg.clone())?;
    let static_only = wrap(ActuatorLaw::StaticPreisach(statics));
    let rate = if fast.is_empty() {
        let errors = slow.iter().map(|r| Ok(compare::training_nrmse(&static_only, r)?.powi(2)));
        let squares = errors.sum::<Result<f64, PreisachError>>()?;
        RateFit {
            law: static_only.law.clone(),
            smoothness: 0.0,
            validation: Vec::new(),
            refinement: Refinement::left_out((squares / slow.len() as f64).sqrt()),
            parameters: Vec::new(),
            covariance: None,
        }
    } else {
        RateFit::new(&grid, g0_deg, &slow, &fast, settings, Uncertainty::Wanted)?
    };
    let dynamic = wrap(rate.law);

    let reports = prepared
        .iter()
        .map(|r| {
            Ok(RecordReport {
                id: r.record.id.clone(),
                record_use: r.record_use,
                drive: r.drive.clone(),
                noise: r.noise,
                linear: compare::compare(&linear, r)?,
                static_only: compare::compare(&static_only, r)?,
                dynamic: compare::compare(&dynamic, r)?,
            })
        })
        .collect::<Result<Vec<_>, PreisachError>>()?;
    let unexplained = unexplained(&reports);
    if unexplained > MOST_UNEXPLAINED {
        summary.findings.push(Finding::NotDescribed { nrmse_percent: 100.0 * unexplained });
    }
    let zero_deg = match settings.zero {
        FlapZero::AsRecorded => 0.0,
        FlapZero::MajorLoopMean => major_loop_mean(&slow),
    };
    Ok(Identification {
        dynamic: dynamic.shifted(-zero_deg),
        static_only: static_only.shifted(-zero_deg),
        linear: linear.shifted(-zero_deg),
        zero_deg,
        records: reports,
        rate_smoothness: rate.smoothness,
        validation: rate.validation,
        refinement: rate.refinement,
        parameters: rate.parameters,
        covariance: rate.covariance,
        summary,
    })
}

/// Share of the spread of the training records beyond which what a model leaves is no misfit of its
/// numbers but of its kind.
pub const MOST_UNEXPLAINED: f64 = 0.5;

/// Root mean square of the NRMSE of the training records.
fn unexplained(reports: &[RecordReport]) -> f64 {
    let trained: Vec<f64> = reports
        .iter()
        .filter(|r| r.record_use == RecordUse::Train)
        .map(|r| r.dynamic.nrmse.powi(2))
        .collect();
    (trained.iter().sum::<f64>() / trained.len().max(1) as f64).sqrt()
}

/// A dynamic Preisach law with what its fit rests on.
struct RateFit {
    law: ActuatorLaw,
    smoothness: f64,
    validation: Vec<Validation>,
    refinement: Refinement,
    parameters: Vec<Estimate>,
    covariance: Option<Covariance>,
}

impl RateFit {
    /// The rounds of `mu0` and `mu1, mu2` and the refinement, from a first static map.
    fn new(
        grid: &PreisachGrid,
        mut g0_deg: PlayMap,
        slow: &[&Prepared],
        fast: &[&Prepared],
        settings: &Settings,
        uncertainty: Uncertainty,
    ) -> Result<Self, PreisachError> {
        let (mut smoothness, mut validation) = validate::smoothness(grid, &g0_deg, fast, settings);
        let mut model = rate_fit::fit(grid, &g0_deg, fast, smoothness, settings)?
            .model(grid, &g0_deg, settings)?;
        for round in 1..settings.rounds {
            let targets: Vec<Vec<f64>> =
                slow.iter().map(|r| without_rate_terms(&model, r.record)).collect();
            g0_deg = static_fit::fit(grid, slow, &targets, settings)?;
            if round == 1 {
                // again, now that the static map no longer holds the dynamics of the slow records
                (smoothness, validation) = validate::smoothness(grid, &g0_deg, fast, settings);
            }
            let maps = rate_fit::fit(grid, &g0_deg, fast, smoothness, settings)?;
            model = maps.model(grid, &g0_deg, settings)?;
        }
        let all: Vec<&Prepared> = slow.iter().chain(fast).copied().collect();
        let refine::Refined { model, refinement, parameters, covariance } =
            refine::refine(&model, &all, settings, uncertainty)?;
        let law = ActuatorLaw::DynamicPreisach(model);
        Ok(Self { law, smoothness, validation, refinement, parameters, covariance })
    }
}

/// Output of a record with `d G1 + d^2 G2` taken off, `d` from the simulated model: smooth, and
/// good enough for a term that is small in slow records.
fn without_rate_terms(model: &DynamicPreisach, record: &BenchRecord) -> Vec<f64> {
    let mut memory = PlayMemory::new(model.grid(), record.voltage_volt[0], StartState::Rest);
    let mut history = crate::OutputHistory::at_rest(model.maps(&memory)[0]);
    let mut counts = crate::StepCounts::default();
    record
        .voltage_volt
        .iter()
        .zip(&record.output_deg)
        .map(|(&u, &measured)| {
            let output = model.step(&mut memory, &mut history, &mut counts, u, record.time_step_s);
            // the simulated output is G0 + d G1 + d^2 G2 by construction
            measured - (output - model.maps(&memory)[0])
        })
        .collect()
}

/// Least squares line through the quasi-static records, each weighing alike.
fn fit_linear(slow: &[&Prepared]) -> LinearGain {
    let [mut w, mut u1, mut u2, mut y1, mut uy] = [0.0; 5];
    for Prepared { record, .. } in slow {
        let weight = 1.0 / record.output_deg.len() as f64;
        for (&u, &y) in record.voltage_volt.iter().zip(&record.output_deg) {
            w += weight;
            u1 += weight * u;
            u2 += weight * u * u;
            y1 += weight * y;
            uy += weight * u * y;
        }
    }
    let gain = (w * uy - u1 * y1) / (w * u2 - u1 * u1);
    LinearGain { gain_deg_per_volt: gain, bias_volt: (u1 - y1 / gain) / w }
}

/// Mean over the steady cycles of the periodic quasi-static record with the largest amplitude; over
/// all of the widest record if none is periodic.
fn major_loop_mean(slow: &[&Prepared]) -> f64 {
    let by_amplitude =
        |a: &&&Prepared, b: &&&Prepared| a.drive.amplitude_volt.total_cmp(&b.drive.amplitude_volt);
    let periodic = slow.iter().filter(|r| r.cycles.is_some()).max_by(by_amplitude);
    match periodic.or_else(|| slow.iter().max_by(by_amplitude)) {
        Some(Prepared { cycles: Some(cycles), .. }) => cycles.series.mean,
        Some(Prepared { record: BenchRecord { output_deg, .. }, .. }) => {
            output_deg.iter().sum::<f64>() / output_deg.len() as f64
        }
        None => 0.0,
    }
}

fn trained_range(slow: &[&Prepared], fast: &[&Prepared], all: &[Prepared]) -> TrainedRange {
    let trained = || slow.iter().chain(fast).map(|r| &r.drive);
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    TrainedRange {
        least_amplitude_volt: least(&mut trained().map(|d| d.amplitude_volt)),
        largest_amplitude_volt: largest(&mut trained().map(|d| d.amplitude_volt)),
        lowest_hz: least(&mut trained().map(Drive::strongest_hz)),
        highest_hz: largest(&mut trained().map(Drive::strongest_hz)),
        bench_highest_hz: largest(&mut all.iter().map(|r| r.drive.strongest_hz())),
    }
}

/// The bench gain that makes a displacement record reach `half_stroke_deg` either way.
///
/// ```text
/// deg_per_um = half_stroke_deg / ((max x - min x) / 2)
/// ```
/// Source: Viswamurthy and Ganguli: the gain makes the quasi-static response +-10 deg and is kept.
///
/// # Errors
/// [`PreisachError::NotPositive`] if the displacement never changes or is not finite.
pub fn half_stroke_gain_deg_per_um(
    displacement_um: &[f64],
    half_stroke_deg: f64,
) -> Result<f64, PreisachError> {
    let (low, high) = displacement_um
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    let half_um = 0.5 * (high - low);
    crate::actuator::check_positive("half stroke (um)", half_um)?;
    Ok(half_stroke_deg / half_um)
}
