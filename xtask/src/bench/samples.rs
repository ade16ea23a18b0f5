//! The benches of the crates: run by cargo, and what criterion has kept of them.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::{XtaskError, files};

/// What a bench took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Least time of a call, s: other work on the machine interrupts some calls, not all.
    pub call_s: f64,
    /// Elements that a call works on; 1 where the bench names none.
    pub elements: f64,
}

impl Sample {
    /// Time of one element, s.
    pub fn element_s(&self) -> f64 {
        self.call_s / self.elements
    }
}

/// What benches took, by id.
pub type Samples = BTreeMap<String, Sample>;

/// How long criterion measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Patience {
    /// Half a second for every bench.
    Usual,
    /// A tenth of that.
    Quick,
}

impl Patience {
    fn arguments(self) -> [&'static str; 6] {
        let [warm_up, measurement] = match self {
            Self::Usual => ["0.2", "0.5"],
            Self::Quick => ["0.02", "0.05"],
        };
        ["--warm-up-time", warm_up, "--measurement-time", measurement, "--sample-size", "10"]
    }
}

/// `cargo bench` of some targets, of the whole workspace: of single packages cargo would choose fewer features for some
/// dependencies and build them once more.
fn cargo_bench(root: &Path, targets: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["bench", "--locked", "--profile", "release", "--workspace"]).current_dir(root);
    for target in targets {
        command.args(["--bench", target]);
    }
    command
}

fn succeed(command: &mut Command) -> Result<(), XtaskError> {
    let program = "cargo bench".to_owned();
    let status = command
        .stdout(Stdio::null())
        .status()
        .map_err(|source| XtaskError::Start { program: program.clone(), source })?;
    if status.success() {
        return Ok(());
    }
    Err(XtaskError::Refused { program, said: format!("{status}") })
}

/// Builds bench targets.
pub(super) fn build(root: &Path, targets: &[&str]) -> Result<(), XtaskError> {
    if targets.is_empty() { Ok(()) } else { succeed(cargo_bench(root, targets).arg("--no-run")) }
}

/// Runs benches of a target, those with one of some ids and those of groups of that name whose members are numbers; what
/// they took is kept below `folder`.
pub(super) fn run(
    root: &Path,
    folder: &Path,
    (target, ids): (&str, &[&str]),
    patience: Patience,
) -> Result<(), XtaskError> {
    let wanted = format!("^({})(/[0-9]+)?$", ids.join("|"));
    let mut command = cargo_bench(root, &[target]);
    command.args(["--quiet", "--", "--quiet", "--noplot"]).args(patience.arguments()).arg(wanted);
    succeed(command.env("CRITERION_HOME", folder))
}

/// What a bench is, as criterion keeps it.
#[derive(Deserialize)]
struct Identity {
    full_id: String,
    #[serde(default)]
    throughput: Option<BTreeMap<String, u64>>,
}

/// The samples of a bench, as criterion keeps them: calls, and their time in ns.
#[derive(Deserialize)]
struct Times {
    iters: Vec<f64>,
    times: Vec<f64>,
}

/// All benches kept below a folder.
///
/// # Errors
/// [`XtaskError::Read`] and [`XtaskError::Speed`] for files that are not there or not understood.
pub fn read(folder: &Path) -> Result<Samples, XtaskError> {
    let mut samples = Samples::new();
    for path in files::in_folder(folder)?.iter().filter(|path| path.is_dir()) {
        if path.ends_with("new") {
            let (id, sample) = one(path)?;
            samples.insert(id, sample);
        } else {
            samples.extend(read(path)?);
        }
    }
    Ok(samples)
}

fn one(folder: &Path) -> Result<(String, Sample), XtaskError> {
    let identity: Identity = parsed(&folder.join("benchmark.json"))?;
    let times: Times = parsed(&folder.join("sample.json"))?;
    let each = times.times.iter().zip(&times.iters).map(|(ns, calls)| 1e-9 * ns / calls);
    let call_s = each.fold(f64::INFINITY, f64::min);
    if !(call_s.is_finite() && call_s > 0.0) {
        let said = "criterion has kept no time of it".to_owned();
        return Err(XtaskError::Speed { what: identity.full_id, said });
    }
    let count = identity.throughput.and_then(|all| all.get("Elements").copied());
    Ok((identity.full_id, Sample { call_s, elements: count.unwrap_or(1) as f64 }))
}

fn parsed<T: DeserializeOwned>(path: &Path) -> Result<T, XtaskError> {
    serde_json::from_str(&files::read(path)?).map_err(|source| XtaskError::Speed {
        what: path.display().to_string(),
        said: source.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(folder: &Path, at: &str, id: &str, throughput: &str, sample: &str) {
        let identity = format!(r#"{{"group_id":"g","full_id":"{id}","throughput":{throughput}}}"#);
        files::write_atomically(&folder.join(at).join("new/benchmark.json"), &identity).unwrap();
        files::write_atomically(&folder.join(at).join("new/sample.json"), sample).unwrap();
    }

    #[test]
    fn the_least_time_of_a_call_is_read_with_its_elements() {
        let folder = tempfile::tempdir().unwrap();
        let usual = r#"{"sampling_mode":"Linear","iters":[1,2,4],"times":[900,1000,2400]}"#;
        kept(folder.path(), "one", "one", "null", usual);
        kept(folder.path(), "group/2", "group/2", r#"{"Elements":50}"#, usual);
        let samples = read(folder.path()).unwrap();
        assert_eq!(samples.keys().collect::<Vec<_>>(), ["group/2", "one"]);
        assert!((samples["one"].element_s() / 500e-9 - 1.0).abs() < 1e-12);
        assert!((samples["group/2"].element_s() / 10e-9 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_bench_without_a_time_is_refused_by_its_name() {
        for sample in [r#"{"iters":[],"times":[]}"#, r#"{"iters":[0],"times":[0]}"#, "{}"] {
            let folder = tempfile::tempdir().unwrap();
            kept(folder.path(), "slow", "slow", "null", sample);
            let said = read(folder.path()).unwrap_err().to_string();
            assert!(said.contains("slow"), "{said}");
        }
        assert!(read(Path::new("no such folder")).unwrap().is_empty());
    }
}
