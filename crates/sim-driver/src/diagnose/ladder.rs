//! The discovery ladder: from a linear actuator upwards, every step taken because data ask for it.
//!
//! | rung | model | data that ask for the next |
//! |---|---|---|
//! | 0 | a straight line | slow runs: what a line lacks is named among hysteresis and every cause of the library |
//! | 1 | static hysteresis of the slow runs | all reference runs with their creep and relaxation, then the faster measured ones: a diagnosis |
//! | 2 | the extended actuator | |

use super::cache::FolderStore;
use super::{Record, Records, Stage, at};
use crate::SimError;
use crate::actuator::CaseActuators;
use crate::case::{ControlActuator, LoadedCase};
use crate::output::{Printable, Sheet, table_of};
use crate::progress::Progress;
use crate::run::run_trimmed;
use actuator_gap::{Diagnosis, RungModel, StructureStore, rung_models};
use model_gap::discovery::{Confidence, Verdict};
use preisach_dyn::{ActuatorModel, PeriodicSettings};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::TrimmedRotor;
use serde::Serialize;
use std::path::Path;

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

/// What a climb begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Climb {
    /// A stage of the diagnosis that the last rung is made of.
    Diagnosis(Stage),
    /// What a rung is worth to the rotor, counted from 0.
    Rung(usize),
}

/// Climbs as far as the data ask for. `reference` shows the actuator as it is, `measured` what is to be
/// explained; the case tells what a rung is worth to a rotor.
///
/// # Errors
/// [`BenchError::Diagnosis`](bench_study::BenchError::Diagnosis) without slow runs and as [`super::diagnose`]; everything a run of the case can fail by.
pub fn climb(
    measured: &Records,
    reference: &[Record],
    loaded: &LoadedCase,
    cache: Option<&Path>,
    begun: &dyn Fn(Climb),
) -> Result<(Ladder, Diagnosis), SimError> {
    let store = cache.map(FolderStore);
    let store = store.as_ref().map(|store| store as &dyn StructureStore);
    let (models, found) =
        rung_models(measured, reference, store, &|stage| begun(Climb::Diagnosis(stage)))
            .map_err(|e| at(&measured.folder, e))?;
    let trimmed = TrimmedRotor::new(&loaded.case, None).map_err(|error| loaded.located(error))?;
    let mut rungs = Vec::new();
    for RungModel { name, model, asked, error_percent } in models {
        begun(Climb::Rung(rungs.len()));
        rungs.push(Rung {
            model: name.to_owned(),
            verdict: asked.as_ref().map(|a| a.verdict),
            confidence: asked.as_ref().map(|a| a.confidence),
            heldout_rms: asked.as_ref().and_then(|a| a.heldout_rms),
            lacks: asked.map(|a| a.lacks).unwrap_or_default(),
            unit: measured.output_unit.clone(),
            error_percent,
            flap_3_per_rev: flap(&model, loaded).map_err(|e| at(&measured.folder, e))?,
            cost: cost(model, loaded, &trimmed)?,
        });
    }
    Ok((Ladder { title: measured.title.clone(), rungs }, found))
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
    let actuators = CaseActuators { real: Some(model.clone()), ..CaseActuators::new(model) };
    let outcome = run_trimmed(&own, actuators, trimmed.clone(), &Progress::new(1))?;
    Ok(outcome
        .figures()
        .control
        .first()
        .map_or([f64::NAN; 2], |line| [line.j_before, line.j_after]))
}

impl Printable for Ladder {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("Discovery ladder: {}", self.title));
        sheet.block(&table_of(
            &self.rungs,
            &[
                ("model", &|r| r.model.clone()),
                ("slow runs, error %", &|r| format!("{:.2}", r.error_percent[0])),
                ("measured runs, error %", &|r| format!("{:.2}", r.error_percent[1])),
                ("3/rev deg/V", &|r| format!("{:.4}", r.flap_3_per_rev[0])),
                ("lag deg", &|r| format!("{:.1}", r.flap_3_per_rev[1])),
                ("J", &|r| format!("{:.4e}", r.cost[1])),
                ("J less by %", &|r| format!("{:.1}", 100.0 * (1.0 - r.cost[1] / r.cost[0]))),
            ],
        ));
        for rung in &self.rungs {
            if let (Some(verdict), Some([before, after])) = (rung.verdict, rung.heldout_rms) {
                let lacks = match rung.lacks.as_slice() {
                    [] => "nothing".to_owned(),
                    names => names.join(", "),
                };
                sheet.line(format_args!(
                    "A {} lacks: {lacks} ({}); held-out error {before:.3} -> {after:.3} {}",
                    rung.model,
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
