//! What is there of a sweep.

use crate::Plan;
use crate::store::{Outcome, RESULTS, State, Store};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What is there of a sweep.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Status {
    /// Cases of different keys.
    pub cases: usize,
    /// Results with numbers.
    pub found: usize,
    /// Keys of results with a reason instead, and the reason.
    pub failed: BTreeMap<String, String>,
    /// Keys of results that are cut off or altered.
    pub damaged: Vec<String>,
    /// Keys without a result.
    pub missing: Vec<String>,
    /// Files among the results that are of no case of the sweep.
    pub foreign: Vec<String>,
}

/// What is there of a plan.
pub fn status(store: &Store, plan: &Plan) -> Status {
    let mut status = Status { foreign: foreign(store, plan), ..Status::default() };
    for case in plan.distinct() {
        status.cases += 1;
        let key = case.key.clone();
        match store.get(&case.key) {
            (State::Found, _) => status.found += 1,
            (State::Damaged, _) => status.damaged.push(key),
            (State::Missing, _) => status.missing.push(key),
            (State::Failed, stored) => {
                if let Some(Outcome::Failed { reason }) = stored.map(|stored| stored.outcome) {
                    status.failed.insert(key, reason);
                }
            }
        }
    }
    status
}

/// Files among the results that are of no case of the plan; what a killed run was writing begins with a dot and is none.
fn foreign(store: &Store, plan: &Plan) -> Vec<String> {
    let root = store.folder.join(RESULTS);
    let keys: BTreeSet<PathBuf> = plan.cases.iter().map(|case| store.path(&case.key)).collect();
    let inside = |folder: &Path| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let shown = entries.filter(|e| !e.file_name().to_string_lossy().starts_with('.'));
        shown.map(|entry| entry.path()).collect::<Vec<_>>()
    };
    let parts = inside(&root);
    let files =
        parts.iter().flat_map(|part| if part.is_dir() { inside(part) } else { vec![part.clone()] });
    let foreign = files.filter(|file| !keys.contains(file));
    let mut names: Vec<String> = foreign.map(|file| file.display().to_string()).collect();
    names.sort();
    names
}
