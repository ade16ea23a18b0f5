//! Diagnoses the sets of a group.

use std::path::{Path, PathBuf};

use score::case::Case;
use score::findings::{Findings, Gain, Verdict};
use truth::hidden::{Answer, Request, Size, is_experiment, measured_set, reference_files};

use super::Group;
use crate::diagnosis::{Failure, Hhc, Oracle, keep_result, read_result, write_folder};
use crate::{XtaskError, files};

/// Runs the sets of a group that were not done before and keeps their results; those without findings.
pub(super) fn run_group(
    hhc: &Hhc,
    folder: &Path,
    group: &Group,
    tell: &(impl Fn(&str) + Sync),
) -> Result<Vec<Failure>, XtaskError> {
    let name = format!("base{}_{}db", group.base, group.snr_db);
    let mut bench = Bench {
        hhc,
        folder: folder.join("bench").join(&name),
        prepared: false,
        follow_ups_left: FOLLOW_UPS,
    };
    let mut failures = Vec::new();
    for seed in &group.seeds {
        let set = format!("seed {seed}, {} dB, base {}", group.snr_db, group.base);
        let kept = folder.join(format!("{name}_seed{seed}.json"));
        let request = Request::new(*seed, group.snr_db);
        if kept.exists() {
            let case: Case = read_result(&kept)?;
            bench.follow_ups_left -= u32::from(case.follow_up.is_some()).min(bench.follow_ups_left);
            tell(&format!("{set}: done before"));
            continue;
        }
        match bench.case(&request, group) {
            Ok(case) => {
                keep_result(&kept, &case)?;
                let hidden = &case.answer.hidden;
                let answer = case.findings.causes.join(", ");
                let verdict = case.findings.verdict;
                tell(&format!("{set}: {hidden} -> {verdict:?} {answer} ({:.1} s)", case.seconds));
            }
            Err(XtaskError::Refused { said, .. }) => {
                tell(&format!("{set}: {said}"));
                failures.push(Failure { set, said });
            }
            Err(other) => return Err(other),
        }
    }
    files::remove_folder(&bench.folder)?;
    Ok(failures)
}

/// The folder in which a group is diagnosed.
struct Bench<'a> {
    hhc: &'a Hhc,
    folder: PathBuf,
    prepared: bool,
    follow_ups_left: u32,
}

/// Proposed experiments that are done in a group: each is a design of its own, whose first diagnosis is slow.
const FOLLOW_UPS: u32 = 3;

/// Every so many seeds the gain is found again with other noise.
const REPLICATED: u64 = 6;

/// Further draws of the noise there.
const REPLICATES: u64 = 4;

impl Bench<'_> {
    /// Reference folder and actuator; a first diagnosis, of `request`, whose time it returns.
    fn prepare(&self, request: &Request, group: &Group) -> Result<f64, XtaskError> {
        let reference = reference_files(group.base, group.snr_db, Size::Small)?;
        write_folder(&self.folder.join("reference"), &reference)?;
        self.hhc.identify(&self.folder)?;
        self.measure(request)?;
        Ok(self.hhc.diagnose(&self.folder, &[])?.1)
    }

    fn measure(&self, request: &Request) -> Result<Answer, XtaskError> {
        let set = measured_set(request)?;
        write_folder(&self.folder.join("measured"), &set.files)?;
        Ok(set.answer)
    }

    fn case(&mut self, request: &Request, group: &Group) -> Result<Case, XtaskError> {
        let first_seconds = if self.prepared { None } else { Some(self.prepare(request, group)?) };
        self.prepared = true;
        let answer = self.measure(request)?;
        let (findings, seconds) = self.hhc.diagnose(&self.folder, &[])?;
        let (oracle, follow_up, replicates) = (None, None, Vec::new());
        let made_by = self.hhc.made_by().to_owned();
        let mut case = Case {
            answer,
            findings,
            seconds,
            first_seconds,
            oracle,
            follow_up,
            replicates,
            made_by,
        };
        case.oracle = self.oracle_gain(&case)?;
        case.replicates = self.replicate_gains(request, &case)?;
        case.follow_up = self.follow_up(request, &case)?;
        Ok(case)
    }

    fn oracle_gain(&self, case: &Case) -> Result<Option<Gain>, XtaskError> {
        let causes = case.causes();
        let named = !case.findings.names().is_empty();
        if causes.is_empty() || !named || self.hhc.oracle() == Oracle::Absent {
            return Ok(None);
        }
        Ok(self.hhc.diagnose(&self.folder, &causes)?.0.gain)
    }

    fn replicate_gains(&self, request: &Request, case: &Case) -> Result<Vec<Gain>, XtaskError> {
        let wanted = case.single().is_some() && request.seed.is_multiple_of(REPLICATED);
        if !wanted || case.findings.names().is_empty() {
            return Ok(Vec::new());
        }
        let mut gains = Vec::new();
        for replicate in 1..=REPLICATES {
            self.measure(&Request { replicate, ..request.clone() })?;
            gains.extend(self.hhc.diagnose(&self.folder, &[])?.0.gain);
        }
        Ok(gains)
    }

    /// The proposed experiment, done where the verdict is ambiguous.
    fn follow_up(
        &mut self,
        request: &Request,
        case: &Case,
    ) -> Result<Option<Findings>, XtaskError> {
        let proposed = &case.findings.next_experiment;
        let known = is_experiment(proposed);
        let open = case.findings.verdict == Verdict::Ambiguous && case.single().is_some();
        if !(known && open && self.follow_ups_left > 0) {
            return Ok(None);
        }
        self.follow_ups_left -= 1;
        self.measure(&Request { experiment: Some(proposed.clone()), ..request.clone() })?;
        Ok(Some(self.hhc.diagnose(&self.folder, &[])?.0))
    }
}
