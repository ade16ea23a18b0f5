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

pub(crate) mod families;
pub(crate) mod fit;
pub(crate) mod records;

pub use families::comparison::{
    Candidates, FittedModel, ModelComparison, ModelRow, Order, compare_models,
};
pub use families::family::Family;
pub use families::folds::LeftOut;
pub use families::quantities::{Quantity, QuantityUnit, quantities};
pub use fit::compare::RecordFit;
pub use fit::density::{DensitySpread, NoiseSource};
pub use fit::output_error::{Covariance, Estimate};
pub use fit::refine::{Refinement, RefinementOutcome};
pub use fit::stream::StaticAccumulator;
pub use fit::validate::Validation;
pub use records::drive::{Drive, Waveform};
pub use records::findings::{Channel, Finding, Identifiability, Severity};
pub use records::noise::{CycleNoise, RestNoise};
pub use records::record::{BenchRecord, RecordWindows};
pub use records::settings::{FlapZero, RateSmoothness, Settings};
pub use records::split_rule::SplitRule;
pub use records::subject::Subject;
pub use rotor_base::RecordUse;

use crate::{ActuatorLaw, ActuatorModel, PreisachError, PreisachGrid, StaticPreisach};
use fit::output_error::Uncertainty;
use fit::preisach::{RateFit, fit_linear, trained_range};
use fit::refine::Refined;
use fit::roles::Bench;
use fit::training::Training;
use fit::{compare, density, static_fit};
use rotor_base::mean_square;

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
    /// What the noise of these records does to its density; none if that cannot be computed.
    pub density_spread: Option<DensitySpread>,
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
    let training = Training::of(&prepared, grid, settings)?;
    let Training { slow, fast, .. } = &training;
    let mut summary = bench.summary(&training);

    let trained = Some(trained_range(&training, &prepared));
    let wrap = |law| ActuatorModel { trained, ..settings.actuator_of(law) };
    let linear = wrap(ActuatorLaw::Linear(fit_linear(slow)));
    let g0_deg = static_fit::as_measured(&training)?;
    let density_spread = density::spread(&training, &g0_deg);
    let statics = StaticPreisach::new(grid, g0_deg.clone())?;
    let static_only = wrap(ActuatorLaw::StaticPreisach(statics));
    let rate = if fast.is_empty() {
        let errors = slow.iter().map(|r| compare::training_nrmse(&static_only, r));
        let nrmse = mean_square(&errors.collect::<Result<Vec<_>, _>>()?).sqrt();
        RateFit {
            smoothness: 0.0,
            validation: Vec::new(),
            refined: Refined {
                law: static_only.law.clone(),
                refinement: Refinement::left_out(nrmse),
                parameters: Vec::new(),
                covariance: None,
            },
        }
    } else {
        RateFit::new(&training, g0_deg, Uncertainty::Wanted)?
    };
    let Refined { law, refinement, parameters, covariance } = rate.refined;
    let dynamic = wrap(law);

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
    let trains = reports.iter().filter(|report| report.record_use == RecordUse::Train);
    let errors: Vec<f64> = trains.map(|report| report.dynamic.nrmse).collect();
    let unexplained = mean_square(&errors).sqrt();
    if unexplained > MOST_UNEXPLAINED {
        summary.findings.push(Finding::NotDescribed { nrmse_percent: 100.0 * unexplained });
    }
    let rigged = |model: ActuatorModel| bench.rigged(model, &training);
    Ok(Identification {
        dynamic: rigged(dynamic),
        static_only: rigged(static_only),
        density_spread,
        linear: rigged(linear),
        zero_deg: bench.zero_deg(&training),
        records: reports,
        rate_smoothness: rate.smoothness,
        validation: rate.validation,
        refinement,
        parameters,
        covariance,
        summary,
    })
}

/// Share of the spread of the training records beyond which what a model leaves is no misfit of its
/// numbers but of its kind.
pub const MOST_UNEXPLAINED: f64 = 0.5;
