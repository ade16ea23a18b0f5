//! The suites of points: an independent rotor, blade or section with a hidden effect, diagnosed by the program, scored against
//! the answer.
//!
//! The result of each set is kept below `target/rotor-sets`, `blade-sets` or `section-sets`, in a folder named after the programs
//! that made it: an interrupted suite goes on where it was, a changed program begins anew.

use std::path::Path;

use rayon::prelude::*;
use rotor_truth::asked::Asked;
use rotor_truth::kind::SetKind;
use score::metrics::Metric;
use score::points::{PointCase, metrics, wrong_ones};
use score::report;

use crate::XtaskError;
use crate::diagnosis::{
    Failure, Hhc, Options, SetName, closing, counted, exit_code, kept_or_made, makers, pool,
    read_results, set_up, write_folder,
};
use crate::hidden_effects::Selection;

/// Seeds of a block, and of an effect in it.
const BLOCK: u64 = 10_000;
const EFFECT: u64 = 200;

/// One set.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSet {
    /// What is tested.
    pub kind: SetKind,
    /// Its seed.
    pub seed: u64,
    /// What is hidden.
    pub effect: &'static str,
    /// Noise below the readings, dB.
    pub snr_db: f64,
}

/// The sets of a selection: of every effect, or of the one that is named, so many at each noise.
pub fn sets(kind: SetKind, selection: &Selection) -> Vec<PointSet> {
    let Selection { seeds, first_block, snr_db, only } = selection;
    let effects = kind.effects();
    let effects = effects.iter().enumerate().filter(|own| only.is_empty() || own.1 == only);
    let of_effect = |(number, effect): (usize, &&'static str)| {
        let first = first_block * BLOCK + number as u64 * EFFECT;
        let effect = *effect;
        let at = move |snr_db: &f64| {
            let snr_db = *snr_db;
            (0..*seeds)
                .map(move |k| PointSet { kind, seed: first + k, effect, snr_db })
                .collect::<Vec<_>>()
        };
        snr_db.iter().flat_map(at).collect::<Vec<_>>()
    };
    effects.flat_map(of_effect).collect()
}

/// What the suite found.
#[derive(Debug, Clone, PartialEq)]
pub struct PointReport {
    /// The scored sets, in order of their seeds.
    pub cases: Vec<PointCase>,
    /// The metrics.
    pub metrics: Vec<Metric>,
    /// Sets without findings.
    pub failures: Vec<Failure>,
}

impl PointReport {
    /// The report of scored sets.
    pub fn of(mut cases: Vec<PointCase>, failures: Vec<Failure>) -> Self {
        cases.sort_by_key(|case| case.answer.seed);
        Self { metrics: metrics(&cases), cases, failures }
    }

    /// Tables for the terminal.
    pub fn text(&self) -> String {
        let mut text = makers(self.cases.iter().map(|case| case.made_by.as_str()));
        text.push('\n');
        let sets = self.cases.iter().map(|case| (case.answer.effect.as_str(), &case.findings));
        text += &report::confusion(sets);
        text.push('\n');
        text += &report::metric_table(&self.metrics);
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
    kind: SetKind,
    options: &Options<Selection>,
    progress: impl Fn(&str) + Sync,
) -> Result<PointReport, XtaskError> {
    let (hhc, folder) = set_up(root, options, &format!("{}-sets", kind.name()))?;
    let sets = sets(kind, &options.selection);
    progress(&format!("{} sets, results in {}\n", sets.len(), folder.display()));
    let tell = counted(sets.len(), &progress);
    let one = |set: &PointSet| {
        let PointSet { seed, effect, snr_db, .. } = set;
        let told = format!("{effect} seed {seed} at {snr_db} dB");
        let file = format!("{}_{effect}_seed{seed}_{snr_db}dB", kind.name());
        let telling = (PointCase::line as fn(&PointCase) -> String, &tell);
        kept_or_made(&folder, SetName { told, file }, telling, |place| diagnosed(&hhc, place, set))
    };
    let results = pool(options.threads)?
        .install(|| sets.par_iter().with_max_len(1).map(one).collect::<Result<Vec<_>, _>>())?;
    let mut cases: Vec<PointCase> = read_results(&folder)?;
    let Selection { only, snr_db, .. } = &options.selection;
    cases.retain(|own| own.kind == kind.name());
    cases.retain(|own| only.is_empty() || own.answer.effect == *only);
    cases.retain(|own| snr_db.iter().any(|snr| (snr - own.answer.snr_db).abs() < 1e-9));
    Ok(PointReport::of(cases, results.into_iter().flatten().collect()))
}

fn diagnosed(hhc: &Hhc, place: &Path, set: &PointSet) -> Result<PointCase, XtaskError> {
    let kind = set.kind;
    let made = kind.make(&Asked {
        seed: set.seed,
        snr_db: set.snr_db,
        effect: Some(set.effect.to_owned()),
        size: None,
        points: None,
        base_error: true,
    });
    let refused = |said: String| XtaskError::Refused { program: "rotor-truth".to_owned(), said };
    let made = made.map_err(|error| refused(error.to_string()))?;
    let answer = serde_json::from_value(made.answer).map_err(|error| refused(error.to_string()))?;
    let files =
        [(kind.table_name().to_owned(), made.table_csv), ("case.ron".to_owned(), made.case_ron)];
    write_folder(place, &files)?;
    let (findings, seconds) = hhc.diagnose_points(place, kind.table_name())?;
    let (kind, made_by) = (kind.name().to_owned(), hhc.made_by().to_owned());
    Ok(PointCase { kind, answer, findings, seconds, made_by })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_seeds_of_its_own() {
        for kind in [SetKind::Rotor, SetKind::Blade, SetKind::Section] {
            let of = |only: &str, seeds| {
                let selection = Selection {
                    seeds,
                    first_block: 3,
                    snr_db: vec![40.0, 30.0],
                    only: only.to_owned(),
                };
                sets(kind, &selection)
            };
            let all = of("", 2);
            let effects = kind.effects().len();
            assert_eq!(all.len(), 4 * effects);
            let mut seeds: Vec<u64> = all.iter().map(|own| own.seed).collect();
            seeds.sort_unstable();
            seeds.dedup();
            assert_eq!(seeds.len(), 2 * effects);
            assert!(seeds.iter().all(|seed| (30_000..40_000).contains(seed)));
            assert!(of("null", 3).iter().all(|own| own.effect == "null"));
            assert!(of("masses", 3).is_empty());
        }
    }
}
