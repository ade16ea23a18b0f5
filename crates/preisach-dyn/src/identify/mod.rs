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
mod fourier;
mod program;
mod rate_fit;
mod record;
mod refine;
mod static_fit;

pub use compare::RecordFit;
pub use program::QpStatus;
pub use record::{BenchRecord, Drive, RecordUse, SplitRule, Waveform};
pub use refine::{Refinement, RefinementOutcome};

use crate::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, LinearGain,
    PlayMap, PlayMemory, PreisachError, PreisachGrid, RateForm, StartState, StaticPreisach,
    TimeOrder, TrainedRange, VoltageRange,
};
use serde::{Deserialize, Serialize};

/// Which output is called zero flap angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FlapZero {
    /// The mean output over the steady cycles of the largest quasi-static record: the flap is
    /// rigged with the actuator cycling slowly about its bias.
    #[default]
    MajorLoopMean,
    /// The zero of the records.
    AsRecorded,
}

/// Settings of an identification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Voltages the actuator may see, V.
    pub range_volt: VoltageRange,
    /// Equivalent flap angle per displacement, deg/um: the gain the records were made with.
    pub deg_per_um: f64,
    /// Levels of the memory and of `mu0`.
    pub levels: usize,
    /// Levels of `mu1` and `mu2`; a divisor of `levels`.
    pub rate_levels: usize,
    /// Weight of the smoothness of `mu0`, relative to the squared error of a fit.
    pub static_smoothness: f64,
    /// Weight of the smoothness of `mu1` and `mu2`, likewise.
    pub rate_smoothness: f64,
    /// Smallest relaxation time, s.
    pub least_relaxation_s: f64,
    /// No reachable state may fold below this times the fastest trained output rate.
    pub rate_margin: f64,
    /// Form of the dynamic model.
    pub form: RateForm,
    /// Order of the time integration.
    pub time_order: TimeOrder,
    /// Rounds of `mu0` and `mu1, mu2` after one another.
    pub rounds: usize,
    /// Harmonics of the steady cycles.
    pub harmonics: usize,
    /// Steps the refinement may try for each of its parameters; 0 leaves it out.
    pub refinement_patience: usize,
    /// Which records train, where they do not say it themselves.
    pub split: SplitRule,
    /// Which output is zero flap angle.
    pub zero: FlapZero,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            range_volt: VoltageRange::amplified_stack(),
            deg_per_um: 1.0,
            levels: 24,
            rate_levels: 8,
            static_smoothness: 1e-4,
            rate_smoothness: 1e-5,
            least_relaxation_s: 1e-4,
            rate_margin: 1.5,
            form: RateForm::WellPosed,
            time_order: TimeOrder::Second,
            rounds: 3,
            harmonics: 20,
            refinement_patience: 1,
            split: SplitRule::default(),
            zero: FlapZero::MajorLoopMean,
        }
    }
}

impl Settings {
    fn check(&self) -> Result<(), PreisachError> {
        for (quantity, value) in [
            ("deg_per_um", self.deg_per_um),
            ("static_smoothness", self.static_smoothness),
            ("rate_smoothness", self.rate_smoothness),
            ("least_relaxation_s", self.least_relaxation_s),
            ("rate_margin", self.rate_margin),
        ] {
            crate::actuator::check_positive(quantity, value)?;
        }
        for (quantity, value, least) in [
            ("levels", self.levels, 2),
            ("rate_levels", self.rate_levels, 1),
            ("rounds", self.rounds, 1),
            ("harmonics", self.harmonics, 3),
        ] {
            if value < least {
                return Err(PreisachError::TooFew { quantity, value, least });
            }
        }
        if self.levels % self.rate_levels != 0 {
            return Err(PreisachError::LevelsDoNotDivide {
                rate_levels: self.rate_levels,
                levels: self.levels,
            });
        }
        Ok(())
    }
}

/// A record made ready: its drive, its averaged cycles, the play states at every sample.
pub(crate) struct Prepared {
    id: String,
    time_step_s: f64,
    voltage_volt: Vec<f64>,
    output_deg: Vec<f64>,
    spread_deg: f64,
    drive: Drive,
    record_use: RecordUse,
    cycles: Option<fourier::FourierFit>,
    levels: usize,
    /// Play states, one row of `levels` per sample; empty for held-out records.
    states: Vec<f64>,
}

impl Prepared {
    fn new(
        record: &BenchRecord,
        drive: Drive,
        record_use: RecordUse,
        grid: &PreisachGrid,
        settings: &Settings,
    ) -> Result<Self, PreisachError> {
        let count = drive.harmonics_within(record.time_step_s, settings.harmonics);
        let cycles = if drive.is_periodic() {
            let cycles_per_sample = drive.base_hz * record.time_step_s;
            Some(fourier::fit(&record.output_deg, drive.steady.clone(), cycles_per_sample, count)?)
        } else {
            None
        };
        let mut states = Vec::new();
        if record_use == RecordUse::Train {
            let mut memory = PlayMemory::new(grid, record.voltage_volt[0], StartState::Rest);
            states.reserve(grid.levels() * record.voltage_volt.len());
            for &u in &record.voltage_volt {
                memory.apply(grid, u);
                states.extend_from_slice(memory.cells());
            }
        }
        Ok(Self {
            id: record.id.clone(),
            time_step_s: record.time_step_s,
            voltage_volt: record.voltage_volt.clone(),
            output_deg: record.output_deg.clone(),
            spread_deg: record::spread(&record.output_deg),
            drive,
            record_use,
            cycles,
            levels: grid.levels(),
            states,
        })
    }

    /// Play states at a sample.
    fn cells(&self, index: usize) -> &[f64] {
        &self.states[index * self.levels..(index + 1) * self.levels]
    }
}

/// What the identification says about one record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordReport {
    /// The record.
    pub id: String,
    /// Trained or held out.
    pub record_use: RecordUse,
    /// Its command.
    pub drive: Drive,
    /// Standard deviation of what does not repeat from cycle to cycle, deg; none for transients.
    pub noise_deg: Option<f64>,
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
    /// The dynamic Preisach model.
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
    /// What the refinement did.
    pub refinement: Refinement,
}

impl Identification {
    /// The reports of the records of one use.
    pub fn records_of(&self, record_use: RecordUse) -> impl Iterator<Item = &RecordReport> {
        self.records.iter().filter(move |report| report.record_use == record_use)
    }
}

/// Identifies an actuator from bench records.
///
/// Assumes: every record starts at rest at its first voltage; equally spaced samples.
///
/// # Errors
/// Refused settings or records; [`PreisachError::NoTrainingRecord`] if no quasi-static or no faster
/// periodic record trains; [`PreisachError::QuadraticProgram`] if a fit is not solved;
/// [`PreisachError::Diverged`] if a Literal model runs away on a record.
pub fn identify(
    records: &[BenchRecord],
    settings: &Settings,
) -> Result<Identification, PreisachError> {
    settings.check()?;
    for record in records {
        record.check(settings.range_volt)?;
    }
    let grid = PreisachGrid::new(settings.range_volt, settings.levels)?;
    let drives: Vec<Drive> = records.iter().map(BenchRecord::drive).collect();
    let uses = settings.split.uses(records, &drives);
    let prepared = records
        .iter()
        .zip(drives.iter().zip(&uses))
        .map(|(record, (drive, &record_use))| {
            Prepared::new(record, drive.clone(), record_use, &grid, settings)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let trained = || prepared.iter().filter(|r| r.record_use == RecordUse::Train);
    let slow: Vec<&Prepared> =
        trained().filter(|r| settings.split.is_quasi_static(&r.drive)).collect();
    let fast: Vec<&Prepared> = trained()
        .filter(|r| !settings.split.is_quasi_static(&r.drive) && r.cycles.is_some())
        .collect();
    if slow.is_empty() {
        return Err(PreisachError::NoTrainingRecord {
            part: "the static density mu0",
            remedy: "record a slow major loop and reversal curves, or raise quasi_static_hz",
        });
    }
    if fast.is_empty() {
        return Err(PreisachError::NoTrainingRecord {
            part: "the rate densities mu1 and mu2",
            remedy: "record periodic runs at trained_hz (1 and 10 Hz), or mark runs for training",
        });
    }

    let wrap = |law| ActuatorModel {
        law,
        range_volt: settings.range_volt,
        calibration: Calibration { deg_per_um: settings.deg_per_um, zero_um: 0.0 },
        trained: Some(trained_range(&slow, &fast, &prepared)),
    };
    let linear = wrap(ActuatorLaw::Linear(fit_linear(&slow)));
    let measured: Vec<Vec<f64>> = slow.iter().map(|r| r.output_deg.clone()).collect();
    let g0_only = static_fit::fit(&grid, &slow, &measured, settings)?;
    let static_only =
        wrap(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, g0_only.clone())?));

    let mut g0_deg = g0_only;
    let mut parameters;
    let mut round = 0;
    loop {
        let rate = rate_fit::fit(&grid, &g0_deg, &fast, settings)?;
        let factor = settings.levels / settings.rate_levels;
        parameters = DynamicParameters {
            grid,
            g0_deg: g0_deg.clone(),
            g1_s: rate.g1_s.refined(factor),
            g2_s2_per_deg: rate.g2_s2_per_deg.refined(factor),
            form: settings.form,
            unfolded_rate_deg_s: rate.unfolded_rate_deg_s,
            time_order: settings.time_order,
        };
        round += 1;
        if round >= settings.rounds {
            break;
        }
        let model = DynamicPreisach::new(parameters.clone())?;
        let targets: Vec<Vec<f64>> =
            slow.iter().map(|r| without_rate_terms(&model, r)).collect();
        g0_deg = static_fit::fit(&grid, &slow, &targets, settings)?;
    }
    let all: Vec<&Prepared> = trained().collect();
    let (model, refinement) = refine::refine(DynamicPreisach::new(parameters)?, &all, settings)?;
    let dynamic = wrap(ActuatorLaw::DynamicPreisach(model));

    let reports = prepared
        .iter()
        .map(|r| {
            Ok(RecordReport {
                id: r.id.clone(),
                record_use: r.record_use,
                drive: r.drive.clone(),
                noise_deg: r.cycles.as_ref().map(|c| c.noise),
                linear: compare::compare(&linear, r)?,
                static_only: compare::compare(&static_only, r)?,
                dynamic: compare::compare(&dynamic, r)?,
            })
        })
        .collect::<Result<Vec<_>, PreisachError>>()?;
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
        refinement,
    })
}

/// Output of a record with `d G1 + d^2 G2` taken off, `d` from the simulated model: smooth, and
/// good enough for a term that is small in slow records.
fn without_rate_terms(model: &DynamicPreisach, record: &Prepared) -> Vec<f64> {
    let mut memory =
        PlayMemory::new(model.grid(), record.voltage_volt[0], StartState::Rest);
    let mut history = crate::OutputHistory::at_rest(model.maps(&memory)[0]);
    let mut counts = crate::StepCounts::default();
    record
        .voltage_volt
        .iter()
        .zip(&record.output_deg)
        .map(|(&u, &measured)| {
            let output =
                model.step(&mut memory, &mut history, &mut counts, u, record.time_step_s);
            // the simulated output is G0 + d G1 + d^2 G2 by construction
            measured - (output - model.maps(&memory)[0])
        })
        .collect()
}

/// Least squares line through the quasi-static records, each weighing alike.
fn fit_linear(slow: &[&Prepared]) -> LinearGain {
    let [mut w, mut u1, mut u2, mut y1, mut uy] = [0.0; 5];
    for record in slow {
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
        Some(record) => record.output_deg.iter().sum::<f64>() / record.output_deg.len() as f64,
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
