//! The discovery ladder: from a linear actuator upwards, every step taken because data ask for it.
//!
//! | rung | model | data that ask for the next |
//! |---|---|---|
//! | 0 | a straight line | slow runs: what a line lacks is named among hysteresis and every cause of the library |
//! | 1 | static hysteresis of the slow runs | all reference runs with their creep and relaxation, then the faster measured ones: a diagnosis |
//! | 2 | the extended actuator | |

use super::base::{BaseModel, variance};
use super::causes::{self, Design, StaticHysteresis};
use super::extended::{LawOfFile, USUAL_DEG_PER_UM};
use super::simulator::BenchSimulator;
use super::{
    Diagnosis, Findings, Question, Record, Records, diagnose, directions, range_of, surrogate,
};
use crate::SimError;
use crate::actuator::CaseActuators;
use crate::case::{ControlActuator, LoadedCase};
use crate::output::{Printable, Sheet, table};
use crate::problem::Place;
use crate::progress::Progress;
use crate::run::run_trimmed;
use crate::study::TrimmedRotor;
use model_gap::GapError;
use model_gap::discovery::{Confidence, Discovery, Settings, Verdict};
use preisach_dyn::{ActuatorModel, PeriodicSettings};
use rotor_base::{Harmonic, HarmonicSeries};
use serde::Serialize;
use std::path::Path;

/// Runs whose input is no faster than this, rms rate over rms amplitude, are slow, Hz.
const SLOW_HZ: f64 = 1.5;
/// The harmonic whose phase is shown.
const HARMONIC: usize = 3;
/// Amplitude of the command that shows it, over the range of the commands.
const SHOWN: f64 = 0.35;

/// One rung.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rung {
    /// The model.
    pub model: String,
    /// What the data say it lacks: the verdict and the names, best first; none on the last rung.
    pub verdict: Option<Verdict>,
    /// Names.
    pub lacks: Vec<String>,
    /// How sure they are.
    pub confidence: Option<Confidence>,
    /// Held-out error of the data that ask for the next rung, rms, before and after the cause named.
    pub heldout_rms: Option<[f64; 2]>,
    /// Unit of the errors.
    pub unit: String,
    /// Error on the slow runs and on the measured ones, rms over spread, percent.
    pub error_percent: [f64; 2],
    /// Amplitude of the 3/rev flap motion over that of the command, deg/V, and its lag behind it, deg.
    pub flap_3_per_rev: [f64; 2],
    /// Vibration `J` before and after 3/rev control with this actuator.
    pub cost: [f64; 2],
}

/// The ladder.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ladder {
    /// Title of the data.
    pub title: String,
    /// Rungs from the bottom.
    pub rungs: Vec<Rung>,
}

/// What a cause named on a rung, and what it gained.
struct Asked {
    verdict: Verdict,
    lacks: Vec<String>,
    confidence: Confidence,
    heldout_rms: [f64; 2],
}

/// Climbs as far as the data ask for. `reference` shows the actuator as it is, `measured` what is to be
/// explained; the case tells what a rung is worth to a rotor.
///
/// # Errors
/// [`SimError::Misfit`] without slow runs and as [`diagnose`]; everything a run of the case can fail by.
pub fn climb(
    measured: &Records,
    reference: &[Record],
    loaded: &LoadedCase,
    cache: Option<&Path>,
) -> Result<(Ladder, Diagnosis), SimError> {
    let place = || Place::file(format!("{}/dataset.ron", measured.folder));
    let misfit = |source| SimError::Misfit { place: place(), source };
    let failed = |source| SimError::Actuator { place: place(), source };
    let all: Vec<&Record> =
        reference.iter().chain(measured.runs.iter().filter(|r| r.is_reference)).collect();
    let slow: Vec<&Record> = all.iter().copied().filter(|r| r.frequency_hz() <= SLOW_HZ).collect();
    if slow.is_empty() {
        let what = format!("reference runs no faster than {SLOW_HZ} Hz");
        return Err(misfit(GapError::TooShort { what, samples: 0, needed: 1 }));
    }
    let targets: Vec<&Record> = measured.runs.iter().filter(|r| !r.is_reference).collect();
    let range = range_of(measured.range, &all, &targets);
    let line = BaseModel::straight(&slow, range);
    let loops = BaseModel::fit(&slow, range, None).ok_or_else(|| {
        misfit(GapError::TooShort { what: "slow runs".into(), samples: 0, needed: 1 })
    })?;
    let first = asked_of_line(&line, &slow, measured, range).map_err(misfit)?;
    let question = Question { reference: reference.to_vec(), cache, ..Question::default() };
    let found = diagnose(measured, &question)?;
    let findings = Findings::from(&found);
    let second = Asked {
        verdict: findings.verdict,
        lacks: findings.causes.clone(),
        confidence: findings.confidence,
        heldout_rms: [findings.gain.heldout_rms_before, findings.gain.heldout_rms_after],
    };
    let deg_per_um = measured.deg_per_um.unwrap_or(USUAL_DEG_PER_UM);
    let law = LawOfFile { range, deg_per_um, is_bench: measured.is_bench };
    let inputs: Vec<Vec<f64>> = slow.iter().map(|r| r.input.clone()).collect();
    let models = [
        ("straight line", law.of(&line, &inputs).map_err(failed)?.0),
        ("static hysteresis of the slow runs", law.of(&loops, &inputs).map_err(failed)?.0),
        ("extended actuator", found.extended()?.model),
    ];
    let trimmed = TrimmedRotor::new(loaded, None)?;
    let mut rungs = Vec::new();
    for ((name, model), asked) in models.into_iter().zip([Some(first), Some(second), None]) {
        let error = |runs: &[&Record]| error_percent(&model, runs).map_err(failed);
        let error_percent = [error(&slow)?, error(&targets)?];
        rungs.push(Rung {
            model: name.to_owned(),
            verdict: asked.as_ref().map(|a| a.verdict),
            confidence: asked.as_ref().map(|a| a.confidence),
            heldout_rms: asked.as_ref().map(|a| a.heldout_rms),
            lacks: asked.map(|a| a.lacks).unwrap_or_default(),
            unit: measured.output_unit.clone(),
            error_percent,
            flap_3_per_rev: flap(&model, loaded).map_err(failed)?,
            cost: cost(model, loaded, &trimmed)?,
        });
    }
    Ok((Ladder { title: measured.title.clone(), rungs }, found))
}

/// What a straight line lacks on slow runs.
fn asked_of_line(
    line: &BaseModel,
    slow: &[&Record],
    measured: &Records,
    range: (f64, f64),
) -> Result<Asked, GapError> {
    let mut library = causes::library();
    library.push(Box::new(StaticHysteresis));
    let design = Design::of(slow, measured.is_bench, true);
    let candidates = causes::candidates(&library, &design);
    let simulator = BenchSimulator::new(line, slow.to_vec(), &library, range)?;
    let traces = simulator.traces();
    let generic = directions(&simulator, |input, plain, step_s| {
        surrogate::generic(input, plain, line.spread, step_s)
    });
    // one cause at a time: a second would mend the form of the first
    let settings = Settings { most_causes: 1, ..Settings::default() };
    let discovery = Discovery {
        traces: &traces,
        simulator: &simulator,
        candidates: &candidates,
        generic: &generic,
        trends: &[],
        structures: &[],
        settings,
    };
    let finding = discovery.find()?;
    let id = |candidate: usize| candidates[candidate].cause.id.to_owned();
    let lacks = finding
        .causes
        .iter()
        .flat_map(|f| {
            std::iter::once(f.candidate).chain(f.alternatives.iter().map(|a| a.candidate))
        })
        .map(id)
        .collect();
    Ok(Asked {
        verdict: finding.verdict,
        lacks,
        confidence: finding.confidence,
        heldout_rms: [finding.gain.rms_before, finding.gain.rms_after],
    })
}

/// RMS error over the spread of the output, zero displacement left free, percent.
fn error_percent(
    model: &ActuatorModel,
    runs: &[&Record],
) -> Result<f64, preisach_dyn::PreisachError> {
    let (mut left, mut all) = (0.0, 0.0);
    for run in runs {
        let drive = preisach_dyn::Drive::new(&run.input, run.step_s);
        let simulated = model.simulate_bench(&drive)?;
        let off: Vec<f64> = simulated
            .measured_deg
            .iter()
            .zip(&run.output)
            .map(|(deg, y)| y - model.calibration.displacement_um(*deg))
            .collect();
        left += variance(&off) * off.len() as f64;
        all += variance(&run.output) * off.len() as f64;
    }
    Ok(100.0 * (left / all.max(1e-300)).sqrt())
}

/// Gain (deg/V) and lag (deg) of the 3/rev flap motion.
fn flap(
    model: &ActuatorModel,
    loaded: &LoadedCase,
) -> Result<[f64; 2], preisach_dyn::PreisachError> {
    let range = model.range_volt;
    let amplitude = SHOWN * range.span_volt();
    let mut command = HarmonicSeries::zero(HARMONIC);
    command.mean = range.middle_volt();
    command.set_harmonic(HARMONIC, Harmonic::from_amplitude_phase(amplitude, 0.0));
    let rev_hz = loaded.case.actuator.bench_rev_hz;
    let response = model.periodic_response(&command, rev_hz, &PeriodicSettings::default())?;
    let motion = response.flap_deg.harmonic(HARMONIC);
    Ok([motion.amplitude() / amplitude, motion.phase_deg()])
}

/// Vibration before and after 3/rev control with an actuator.
fn cost(
    model: ActuatorModel,
    loaded: &LoadedCase,
    trimmed: &TrimmedRotor,
) -> Result<[f64; 2], SimError> {
    let mut own = loaded.clone();
    own.case.control.harmonics = vec![vec![HARMONIC]];
    own.case.control.actuators = vec![ControlActuator::Hysteretic];
    let actuators = CaseActuators {
        ideal: model.clone(),
        real: Some(model),
        data_title: String::new(),
        fits: Vec::new(),
        bench: None,
        inputs: Vec::new(),
        warnings: Vec::new(),
    };
    let outcome = run_trimmed(&own, actuators, trimmed.clone(), &Progress::new(1))?;
    Ok(outcome.result.control.first().map_or([f64::NAN; 2], |line| [line.j_before, line.j_after]))
}

impl Printable for Ladder {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("Discovery ladder: {}", self.title));
        let rows = self.rungs.iter().map(|r| {
            vec![
                r.model.clone(),
                format!("{:.2}", r.error_percent[0]),
                format!("{:.2}", r.error_percent[1]),
                format!("{:.4}", r.flap_3_per_rev[0]),
                format!("{:.1}", r.flap_3_per_rev[1]),
                format!("{:.4e}", r.cost[1]),
                format!("{:.1}", 100.0 * (1.0 - r.cost[1] / r.cost[0])),
            ]
        });
        let head = [
            "model",
            "slow runs, error %",
            "measured runs, error %",
            "3/rev deg/V",
            "lag deg",
            "J",
            "J less by %",
        ];
        sheet.block(&table(&head, rows));
        for rung in &self.rungs {
            if let (Some(verdict), Some([before, after])) = (rung.verdict, rung.heldout_rms) {
                sheet.line(format_args!(
                    "A {} lacks: {} ({}); held-out error {before:.3} -> {after:.3} {}",
                    rung.model,
                    if rung.lacks.is_empty() {
                        "nothing".to_owned()
                    } else {
                        rung.lacks.join(", ")
                    },
                    words(verdict),
                    rung.unit
                ));
            }
        }
        sheet.finish()
    }
}

fn words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingMissing => "nothing missing",
        Verdict::Named => "named",
        Verdict::NamedStructureRemains => "named, structure remains",
        Verdict::Ambiguous => "one of these",
        Verdict::Unknown => "something without a name",
        Verdict::NotObservable => "not observable",
    }
}
