//! What a diagnosis says of synthetic benches: silence where nothing is hidden, names and parameters where
//! something is. The whole suite is `cargo xtask hidden-effects`; these sets are a few that take seconds.

use std::sync::LazyLock;

use sim_driver::diagnose::{Diagnosis, Findings, FolderStore, Question, Record, Records, diagnose};
use sim_driver::files::{Folder, read_bench};
use truth::hidden::{File, Hidden, Request, Size, measured_set, reference_files};

use validation::{Check, Failure, row, shared};

const SOURCE: &str = "tests/truth, base 4, 40 dB: shares no code with the product";

pub(crate) const ROWS: &[Check] = &[
    row("V-GAP-01", "nothing hidden, two draws of the noise: causes named", "-")
        .against(SOURCE)
        .at_most(0.0, names_of_nothing),
    row("V-GAP-02", "creep of 6 % of the output, the only confident name: error of its rate", "%")
        .against(SOURCE)
        .at_most(5.0, || parameter_error("creep", "rate_per_decade")),
    row("V-GAP-03", "current limit of 6 %, the only confident name: error of its slew rate", "%")
        .against(SOURCE)
        .at_most(5.0, || parameter_error("amplifier-current-limit", "slew_rate")),
    row(
        "V-GAP-04",
        "transport delay of 4 %, the first of the names: error of the delay over \
         half its 95 % interval",
        "-",
    )
    .against(SOURCE)
    .at_most(1.0, delay_error),
    row("V-GAP-05", "quadratic viscous force of 6 %, outside the library: confident names", "-")
        .against(SOURCE)
        .at_most(0.0, || {
            let found = found("outside-quadratic-viscous", 0.06, 3)?;
            Ok(if is_confident(&found) { found.causes.len() as f64 } else { 0.0 })
        }),
];

const BASE: u64 = 4;

/// The reference runs, and a folder for what surrogates leave.
static BENCH: LazyLock<Result<(Vec<Record>, tempfile::TempDir), Failure>> = LazyLock::new(|| {
    let files = reference_files(BASE, 40.0, Size::Small)?;
    Ok((records(&files)?.runs, tempfile::tempdir()?))
});

fn records(content: &[File]) -> Result<Records, Failure> {
    let folder = tempfile::tempdir()?;
    for (name, text) in content {
        std::fs::write(folder.path().join(name), text)?;
    }
    let read = read_bench(&Folder::Disk(folder.path().to_path_buf()));
    Ok(Records::from(&read?))
}

/// The diagnosis of a hidden effect, its answer's parameter of a name, if it has one.
fn diagnosed(
    hidden: &str,
    share: f64,
    seed: u64,
) -> Result<(Diagnosis, truth::hidden::Answer), Failure> {
    let (reference, cache) = shared(&BENCH)?;
    let request = Request {
        hidden: Some(Hidden::parse(hidden)?),
        base: Some(BASE),
        share: Some(share),
        ..Request::new(seed, 40.0)
    };
    let set = measured_set(&request)?;
    let store = FolderStore(cache.path());
    let question =
        Question { reference: reference.clone(), cache: Some(&store), ..Question::default() };
    Ok((diagnose(&records(&set.files)?, &question)?, set.answer))
}

fn found(hidden: &str, share: f64, seed: u64) -> Result<Findings, Failure> {
    Ok(Findings::from(&diagnosed(hidden, share, seed)?.0))
}

fn is_confident(found: &Findings) -> bool {
    found.confidence == model_gap::discovery::Confidence::Confident && !found.causes.is_empty()
}

fn names_of_nothing() -> Result<f64, Failure> {
    let mut names = 0;
    for seed in [1, 2] {
        names += found("null", 0.0, seed)?.causes.len();
    }
    Ok(names as f64)
}

/// Error of a parameter, percent; NaN unless its cause is the only name and a confident one.
fn parameter_error(hidden: &str, name: &str) -> Result<f64, Failure> {
    let (diagnosis, answer) = diagnosed(hidden, 0.06, 3)?;
    let found = Findings::from(&diagnosis);
    if found.causes != [hidden] || !is_confident(&found) {
        return Ok(f64::NAN);
    }
    Ok(error_percent(&found, &answer, name))
}

fn delay_error() -> Result<f64, Failure> {
    let (diagnosis, answer) = diagnosed("transport-delay", 0.04, 3)?;
    let found = Findings::from(&diagnosis);
    if found.causes.first().is_none_or(|first| first != "transport-delay") {
        return Ok(f64::NAN);
    }
    let interval = found.parameters.get("transport-delay").and_then(|all| all.get("delay"));
    let half = interval.map_or(f64::NAN, |d| 0.5 * (d.ci95[1] - d.ci95[0]) / d.value);
    Ok(error_percent(&found, &answer, "delay") / (100.0 * half))
}

fn error_percent(found: &Findings, answer: &truth::hidden::Answer, name: &str) -> f64 {
    let effect = answer.effects.first();
    let truth = effect.and_then(|effect| effect.parameters.get(name)).map(|q| q.value);
    let estimate = effect.and_then(|effect| found.parameters.get(&effect.id)?.get(name));
    match (truth, estimate) {
        (Some(truth), Some(estimate)) => 100.0 * (estimate.value / truth - 1.0).abs(),
        _ => f64::NAN,
    }
}
