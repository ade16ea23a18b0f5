//! The suite of everyday errors: one actuator a set, identified and diagnosed from nothing, scored against its answer.
//!
//! The result of each set is kept below `target/everyday-errors`, in a folder named after the programs that made
//! it: an interrupted suite goes on where it was, a changed program begins anew. The report is on all results of the
//! folder that the selection admits.

use std::path::Path;

use everyday_bench::family::Family;
use everyday_bench::hidden::{Deal, Hidden};
use everyday_bench::set::{Request, set};
use rayon::prelude::*;
use score::everyday::{EverydayCase, metrics, wrong_ones};
use score::metrics::Metric;
use score::report;

use crate::XtaskError;
use crate::diagnosis::{
    Failure, Hhc, Options, SetName, closing, counted, exit_code, kept_or_made, makers, pool,
    read_results, set_up, write_folder,
};

/// A choice of sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Number of sets.
    pub sets: u64,
    /// The first of their seeds; the others follow it.
    pub first_seed: u64,
    /// Families, in turn.
    pub families: Vec<Family>,
    /// What the seeds are dealt.
    pub deal: Deal,
}

impl Selection {
    /// What is asked of the generator, set by set.
    pub fn requests(&self) -> Vec<Request> {
        let families = self.families.iter().cycle();
        let seeds = self.first_seed..self.first_seed.saturating_add(self.sets);
        seeds.zip(families).map(|(seed, family)| Request::new(*family, seed, self.deal)).collect()
    }

    /// Whether a stored set belongs to it, whatever its seed.
    pub fn admits(&self, case: &EverydayCase) -> bool {
        let answer = &case.answer;
        let dealt = || Hidden::of_seed(answer.seed, self.deal).id() == answer.hidden;
        self.families.contains(&answer.family) && (self.deal == Deal::All || dealt())
    }
}

/// What the suite found.
#[derive(Debug, Clone, PartialEq)]
pub struct EverydayReport {
    /// The scored sets, in order of seed and family.
    pub cases: Vec<EverydayCase>,
    /// The metrics.
    pub metrics: Vec<Metric>,
    /// Sets without findings.
    pub failures: Vec<Failure>,
}

impl EverydayReport {
    /// The report of scored sets.
    pub fn of(mut cases: Vec<EverydayCase>, failures: Vec<Failure>) -> Self {
        cases.sort_by_key(|case| (case.answer.seed, case.answer.family));
        Self { metrics: metrics(&cases), cases, failures }
    }

    /// Tables for the terminal.
    pub fn text(&self) -> String {
        let mut text = makers(self.cases.iter().map(|case| case.made_by.as_str()));
        let sets = self.cases.iter().map(|case| (case.answer.hidden.as_str(), &case.findings));
        text.push('\n');
        text += &report::confusion(sets);
        text.push('\n');
        text += &report::metric_table(&self.metrics);
        text += "One actuator a set: sets are independent, the bounds are exact (Clopper and Pearson).\n\n";
        text += &wrong_ones(&self.cases);
        text += &closing(self.cases.len(), &self.failures, &self.metrics);
        text
    }

    /// 0, or 3 where a bar is missed or a set failed.
    pub fn exit_code(&self) -> u8 {
        exit_code(&self.failures, &self.metrics)
    }
}

/// Runs the suite, telling its progress line by line.
///
/// # Errors
/// [`XtaskError`] where files cannot be written, programs not be started, or results kept earlier not be read.
pub fn run(
    root: &Path,
    options: &Options<Selection>,
    progress: impl Fn(&str) + Sync,
) -> Result<EverydayReport, XtaskError> {
    let (hhc, folder) = set_up(root, options, "everyday-errors")?;
    let requests = options.selection.requests();
    let total = requests.len();
    progress(&format!("{total} sets, results in {}\n", folder.display()));
    let tell = counted(total, &progress);
    let one = |request: &Request| {
        let (family, seed) = (request.family.id(), request.seed);
        let told = format!("{family} seed {seed}");
        let file = format!("{family}_seed{seed}_{}", request.hidden.id());
        let telling = (EverydayCase::line as fn(&EverydayCase) -> String, &tell);
        kept_or_made(&folder, SetName { told, file }, telling, |bench| {
            diagnosed(&hhc, bench, request)
        })
    };
    let results = pool(options.threads)?
        .install(|| requests.par_iter().with_max_len(1).map(one).collect::<Result<Vec<_>, _>>())?;
    let mut cases: Vec<EverydayCase> = read_results(&folder)?;
    cases.retain(|case| options.selection.admits(case));
    Ok(EverydayReport::of(cases, results.into_iter().flatten().collect()))
}

fn diagnosed(hhc: &Hhc, bench: &Path, request: &Request) -> Result<EverydayCase, XtaskError> {
    let set = set(request);
    write_folder(&bench.join("reference"), &set.reference)?;
    write_folder(&bench.join("measured"), &set.measured)?;
    let identify_seconds = hhc.identify(bench)?;
    let (findings, seconds) = hhc.diagnose(bench, &[])?;
    let (answer, made_by) = (set.answer, hhc.made_by().to_owned());
    Ok(EverydayCase { answer, findings, seconds, identify_seconds, made_by })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_take_turns_and_kinds_are_those_dealt() {
        let families = vec![Family::Relays, Family::Duhem];
        let own = Selection { sets: 46, first_seed: 23, families, deal: Deal::Everyday };
        let requests = own.requests();
        assert_eq!(requests.len(), 46);
        assert_eq!(requests.iter().filter(|r| r.family == Family::Duhem).count(), 23);
        assert!(requests.iter().all(|r| r.hidden.id() != "null" && r.snr_db > 39.0));
        let nulls = Selection { deal: Deal::Nulls, ..own };
        assert!(nulls.requests().iter().all(|request| request.hidden.id() == "null"));
    }
}
