//! What the figures were measured on.

use std::path::Path;
use std::process::Command;
use std::thread::available_parallelism;

use crate::diagnosis::{commit, said};
use crate::files;

/// Programs running on average up to which a machine is idle: the compiler of the benches has just ended.
const IDLE_LOAD: f64 = 2.0;

/// The facts of a run, as the page tells them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Its cores, as far as this program may use them.
    pub cores: usize,
    /// Programs that were running or waiting on average in the minute before, if the system tells.
    pub load: String,
    /// The compiler.
    pub compiler: String,
    /// Day, year first.
    pub day: String,
    /// The tree.
    pub commit: String,
}

impl Machine {
    /// This machine today.
    pub(super) fn here(root: &Path) -> Self {
        let unknown = || "unknown".to_owned();
        let system = |path: &str| files::read(Path::new(path)).unwrap_or_default();
        let load = system("/proc/loadavg");
        let load = load.split_whitespace().next().map_or_else(unknown, str::to_owned);
        Self {
            processor: processor_in(&system("/proc/cpuinfo")).unwrap_or_else(unknown),
            cores: available_parallelism().map_or(1, usize::from),
            load,
            compiler: said(Command::new("rustc").arg("--version")).unwrap_or_else(unknown),
            day: said(Command::new("date").args(["-u", "+%F"])).unwrap_or_else(unknown),
            commit: commit(root),
        }
    }

    /// Whether other programs were using it.
    pub(super) fn is_busy(&self) -> bool {
        self.load.parse().is_ok_and(|load: f64| load > IDLE_LOAD)
    }
}

/// Name of the processor in a text of `/proc/cpuinfo`, with family and model where they stand there: names of virtual
/// machines leave out the generation.
fn processor_in(cpuinfo: &str) -> Option<String> {
    let field = |name: &str| {
        let mut fields = cpuinfo.lines().filter_map(|line| line.split_once(':'));
        fields.find(|(key, _)| key.trim() == name).map(|(_, value)| value.trim())
    };
    let name = field("model name")?;
    Some(match (field("cpu family"), field("model")) {
        (Some(family), Some(model)) => format!("{name} (family {family}, model {model})"),
        _ => name.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_where_the_system_knows_it() {
        let known =
            "processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\nflags\t: fma\nmodel name\t: b\n";
        assert_eq!(processor_in(known).as_deref(), Some("Some CPU @ 2 GHz"));
        let generation = "cpu family\t: 25\nmodel\t\t: 17\nmodel name\t: Some CPU\n";
        assert_eq!(processor_in(generation).as_deref(), Some("Some CPU (family 25, model 17)"));
        assert_eq!(processor_in("processor\t: 0\n"), None);
    }
}
