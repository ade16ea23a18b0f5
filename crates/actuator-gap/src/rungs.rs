//! The models of the discovery ladder: from a straight line upwards, each with what the data say it lacks.

use crate::base::BaseModel;
use crate::causes::{self, Design};
use crate::diagnosis::{Diagnosis, Floors, diagnose, search};
use crate::error::DiagnosisError;
use crate::extended::{USUAL_DEG_PER_UM, law_of_file};
use crate::question::{Question, Stage, StructureStore};
use crate::record::{Record, Records};
use crate::sessions::{error_percent, range_of};
use crate::simulator::{BenchSimulator, Setting};
use measured_data::Accuracy;
use model_gap::discovery::{Confidence, Settings, Verdict};
use model_gap::{Findings, GapError, names};
use preisach_dyn::ActuatorModel;

/// Runs whose input is no faster than this, rms rate over rms amplitude, are slow, Hz.
const SLOW_HZ: f64 = 1.5;
/// A model and what the data say it lacks.
pub struct RungModel {
    /// Name of the model.
    pub name: &'static str,
    /// The model.
    pub model: ActuatorModel,
    /// What it lacks; none on the last rung.
    pub asked: Option<Asked>,
    /// Error on the slow runs and on the measured ones, rms over spread, percent.
    pub error_percent: [f64; 2],
}

/// What a rung lacks, and what the cause named gains.
pub struct Asked {
    /// The verdict.
    pub verdict: Verdict,
    /// Names, best first.
    pub lacks: Vec<String>,
    /// How sure they are.
    pub confidence: Confidence,
    /// Held-out error before and after the cause named, rms, output's unit; none where nothing was named, or no run
    /// could be held out.
    pub heldout_rms: Option<[f64; 2]>,
}

/// Straight line, static hysteresis of the slow runs and extended actuator; and the diagnosis that the last is made of.
///
/// # Errors
/// [`DiagnosisError::Misfit`] without slow runs, and as [`diagnose`].
pub fn rung_models(
    measured: &Records,
    reference: &[Record],
    store: Option<&dyn StructureStore>,
    begun: &dyn Fn(Stage),
) -> Result<([RungModel; 3], Diagnosis), DiagnosisError> {
    let too_few = |what: String| GapError::TooShort { what, samples: 0, needed: 1 };
    let all: Vec<&Record> =
        reference.iter().chain(measured.runs.iter().filter(|r| r.is_reference)).collect();
    let slow: Vec<&Record> = all.iter().copied().filter(|r| r.frequency_hz() <= SLOW_HZ).collect();
    if slow.is_empty() {
        return Err(too_few(format!("reference runs no faster than {SLOW_HZ} Hz")).into());
    }
    let targets: Vec<&Record> = measured.runs.iter().filter(|r| !r.is_reference).collect();
    let range = range_of(measured.range, &all, &targets);
    let line = BaseModel::straight(&slow, range);
    let loops = BaseModel::fit(&slow, range, None).ok_or_else(|| too_few("slow runs".into()))?;
    let first = asked_of_line(&line, &slow, measured, range)?;
    let reference = reference.to_vec();
    let question = Question { reference, cache: store, begun: Some(begun), ..Question::default() };
    let found = diagnose(measured, &question)?;
    let findings = Findings::from(&found);
    let second = Asked {
        verdict: findings.verdict,
        lacks: findings.causes.clone(),
        confidence: findings.confidence,
        heldout_rms: findings.gain.map(|gain| [gain.heldout_rms_before, gain.heldout_rms_after]),
    };
    let deg_per_um = measured.deg_per_um.unwrap_or(USUAL_DEG_PER_UM);
    let inputs: Vec<Vec<f64>> = slow.iter().map(|r| r.input.clone()).collect();
    let law = |base| law_of_file(base, &inputs, range, deg_per_um, measured.is_bench);
    let rung = |name, model: ActuatorModel, asked| -> Result<RungModel, DiagnosisError> {
        let error_percent = [error_percent(&model, &slow)?, error_percent(&model, &targets)?];
        Ok(RungModel { name, model, asked, error_percent })
    };
    let rungs = [
        rung("straight line", law(&line)?.0, Some(first))?,
        rung("static hysteresis of the slow runs", law(&loops)?.0, Some(second))?,
        rung("extended actuator", found.extended()?.model, None)?,
    ];
    Ok((rungs, found))
}

/// What a straight line lacks on slow runs.
fn asked_of_line(
    line: &BaseModel,
    slow: &[&Record],
    measured: &Records,
    range: (f64, f64),
) -> Result<Asked, GapError> {
    let library = [causes::LIBRARY.as_slice(), &[causes::HYSTERESIS]].concat();
    // gains and zeros are in the line already
    let accuracy = Accuracy {
        displacement: Accuracy::EXACT.displacement,
        amplifier: Accuracy::EXACT.amplifier,
        monitor: Accuracy::EXACT.monitor,
        ..measured.accuracy
    };
    let design = Design::of(slow, slow, &accuracy, measured.is_bench);
    let candidates = causes::candidates(&library, &design);
    let setting = Setting { base: line, references: Vec::new(), causes: &library, range, accuracy };
    let simulator = BenchSimulator::new(setting, slow.to_vec())?;
    // one cause at a time: a second would mend the form of the first
    let settings = Settings { most_causes: 1, ..Settings::default() };
    let finding =
        search((&simulator, &simulator.traces()), &candidates, &Floors::default(), settings, None)?;
    Ok(Asked {
        verdict: finding.verdict,
        lacks: names(&finding, &candidates),
        confidence: finding.confidence,
        heldout_rms: finding.gain.map(|gain| [gain.rms_before, gain.rms_after]),
    })
}
