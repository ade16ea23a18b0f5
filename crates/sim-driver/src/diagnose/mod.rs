//! `hhc diagnose`: what a simulation of a bench gets wrong, why, and what it is worth to know.

mod base;
mod causes;
mod findings;
mod plays;
mod record;
mod simulator;
mod surrogate;

pub use findings::Findings;
pub use record::{Record, Records};

use crate::SimError;
use crate::problem::Place;
use base::BaseModel;
use causes::{BenchCause, Design};
use model_gap::Candidate;
use model_gap::discovery::{Discovery, Finding, Settings, Signal};
use simulator::BenchSimulator;

/// A diagnosis with everything it rests on.
#[derive(Debug)]
pub struct Diagnosis {
    /// What was found.
    pub finding: Finding,
    /// The candidates, in the order of the library.
    pub candidates: Vec<Candidate>,
    /// Unit of the output.
    pub output_unit: String,
    /// What to measure next.
    pub next_experiment: String,
    /// Error of the base model on reference runs left out of its fit, over the spread of the output.
    pub floor: f64,
}

impl Diagnosis {
    /// Causes that these data could not have shown at usual strength.
    pub fn not_observable(&self) -> Vec<String> {
        self.candidates
            .iter()
            .zip(&self.finding.screen)
            .filter(|(candidate, screened)| {
                candidate.blocked.is_some() || screened.weak_signal < screened.threshold
            })
            .map(|(candidate, _)| candidate.cause.id.to_owned())
            .collect()
    }
}

/// Diagnoses measured runs against the base model of the reference runs.
///
/// # Errors
/// [`SimError::Misfit`] where the numerics fail; runs too short are refused.
pub fn diagnose(measured: &Records, reference: &[Record]) -> Result<Diagnosis, SimError> {
    let place = || Place::file(format!("{}/dataset.ron", measured.folder));
    let fail = |source| SimError::Misfit { place: place(), source };
    let library: Vec<Box<dyn BenchCause>> = causes::library();
    let runs: Vec<&Record> = measured.runs.iter().filter(|r| !r.is_reference).collect();
    let own: Vec<&Record> = measured.runs.iter().filter(|r| r.is_reference).collect();
    let mut references: Vec<&Record> = reference.iter().collect();
    references.extend(own);
    let has_reference = !references.is_empty();
    let fitted = if has_reference { &references } else { &runs };
    let range = range_of(measured.range, fitted, &runs);
    let base = BaseModel::fit(fitted, range, None).ok_or_else(|| {
        fail(model_gap::GapError::TooShort { what: "runs of the base model".into(), samples: 0, needed: 2 })
    })?;
    let design = Design::of(&runs, measured.is_bench, has_reference);
    let candidates = causes::candidates(&library, &design);
    let simulator = BenchSimulator::new(&base, runs.clone(), &library, range).map_err(fail)?;
    let traces = simulator.traces();
    let structures: Vec<Signal> = surrogate::structures(&base, fitted, &runs, range)
        .iter()
        .map(|s| simulator.on_traces(s))
        .collect();
    let generic = generic(&simulator, base.spread);
    let settings = Settings { has_reference, ..Settings::default() };
    let discovery = Discovery {
        traces: &traces,
        simulator: &simulator,
        candidates: &candidates,
        generic: &generic,
        structures: &structures,
        settings,
    };
    let finding = discovery.find().map_err(fail)?;
    Ok(Diagnosis {
        finding,
        candidates: candidates.clone(),
        output_unit: measured.output_unit.clone(),
        next_experiment: String::new(),
        floor: base.floor,
    })
}

/// The range of the base model: that of the data set, widened to every input that occurs.
fn range_of(given: (f64, f64), a: &[&Record], b: &[&Record]) -> (f64, f64) {
    a.iter()
        .chain(b)
        .flat_map(|r| r.input.iter())
        .fold(given, |(low, high), &u| (low.min(u), high.max(u)))
}

/// The directions without a name on all traces.
fn generic(simulator: &BenchSimulator<'_>, spread: f64) -> Vec<Signal> {
    let per_run: Vec<Vec<Vec<f64>>> = (0..simulator.runs.len())
        .map(|number| {
            let (input, _, plain) = simulator.plain(number);
            surrogate::generic(input, plain, spread, simulator.runs[number].step_s)
        })
        .collect();
    let count = per_run.first().map_or(0, Vec::len);
    (0..count)
        .map(|k| {
            let outputs: Vec<Vec<f64>> = per_run.iter().map(|run| run[k].clone()).collect();
            simulator.on_traces(&outputs)
        })
        .collect()
}
