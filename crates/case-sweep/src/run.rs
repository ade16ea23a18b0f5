//! Running what is missing, on all threads.

use crate::store::{Outcome, State, Store, StoredCase, case_key};
use crate::{Found, NoNumbers, Plan, PlannedCase, ReadCase, Runner, Shard, SweepError};
use serde::Serialize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a run did.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Ran {
    /// Cases of the part.
    pub cases: usize,
    /// Cases whose results were there.
    pub skipped: usize,
    /// Cases computed, failed ones included.
    pub computed: usize,
    /// Failed cases, computed or there: key and reason.
    pub failed: Vec<(String, String)>,
    /// Keys of results that were cut off or altered, and were computed again.
    pub damaged: Vec<String>,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Done {
    /// Cases computed.
    pub computed: usize,
    /// Cases to compute.
    pub of: usize,
}

/// How fast a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// How far it is.
    pub done: Done,
    /// Time since it began, s.
    pub elapsed_s: f64,
}

impl std::fmt::Display for Pace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Done { computed, of } = self.done;
        let per_s = computed as f64 / self.elapsed_s.max(1e-3);
        let left_s = (of - computed.min(of)) as f64 / per_s.max(1e-9);
        let left = match left_s {
            s if s < 90.0 => format!("{s:.0} s"),
            s if s < 5400.0 => format!("{:.0} min", s / 60.0),
            s => format!("{:.1} h", s / 3600.0),
        };
        write!(f, "{computed} of {of} cases, {:.3} per minute, about {left} left", 60.0 * per_s)
    }
}

/// What becomes of cases that failed before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failed {
    /// They are left: the same case fails the same way.
    Left,
    /// They are computed again, as after a fault of the program was mended.
    Again,
}

/// Runs the cases of a part that have no whole result yet. `done` is told of every case, from one thread at a time.
///
/// A case runs on one thread; fewer cases than threads share the threads out. No result depends on it.
///
/// # Errors
/// A result that cannot be written, a case that was stopped, and one whose files changed meanwhile. Failed cases are results.
pub fn run<R: Runner>(
    plan: &Plan,
    (shard, before): (Shard, Failed),
    store: &Store,
    runner: &R,
    done: &(dyn Fn(Done) + Sync),
) -> Result<Ran, SweepError> {
    let part = shard.part(plan.distinct(), |case| &case.key);
    let mut ran = Ran { cases: part.len(), ..Ran::default() };
    let mut open: Vec<&PlannedCase> = Vec::new();
    for case in part {
        match store.get(&case.key) {
            (State::Found, _) => ran.skipped += 1,
            (State::Failed, stored) if before == Failed::Left => {
                ran.skipped += 1;
                ran.failed.extend(stored.and_then(|stored| reason(&case.key, &stored.outcome)));
            }
            (state, _) => {
                ran.damaged.extend((state == State::Damaged).then(|| case.key.clone()));
                open.push(case);
            }
        }
    }
    let threads = rayon::current_num_threads();
    let workers = threads.min(open.len()).max(1);
    let (next, computed) = (AtomicUsize::new(0), Mutex::new(0_usize));
    let failed = Mutex::new(Vec::new());
    let work = |own: usize| -> Result<(), SweepError> {
        // threads of its own: a case that waits for its parts takes up no other case meanwhile
        let pool = rayon::ThreadPoolBuilder::new().num_threads(own).build();
        loop {
            let Some(case) = open.get(next.fetch_add(1, Ordering::Relaxed)) else { return Ok(()) };
            let one = || run_case(plan, case, runner);
            let ran = match &pool {
                Ok(pool) => pool.install(one),
                Err(_) => one(),
            };
            let put = ran.and_then(|stored| store.put(&stored).map(|()| stored));
            // the others end after their case
            let stored = put.inspect_err(|_| next.store(open.len(), Ordering::Relaxed))?;
            lock(&failed).extend(reason(&case.key, &stored.outcome));
            let mut computed = lock(&computed);
            *computed += 1;
            done(Done { computed: *computed, of: open.len() });
        }
    };
    let ends: Vec<Result<(), SweepError>> = std::thread::scope(|scope| {
        let share = |worker: usize| threads / workers + usize::from(worker < threads % workers);
        let work = &work;
        let workers: Vec<_> =
            (0..workers).map(|worker| scope.spawn(move || work(share(worker)))).collect();
        workers.into_iter().map(|worker| worker.join().unwrap_or(Err(SweepError::Ended))).collect()
    });
    ends.into_iter().collect::<Result<(), SweepError>>()?;
    ran.computed = *lock(&computed);
    ran.failed.append(&mut lock(&failed));
    ran.failed.sort();
    Ok(ran)
}

/// A panic of another thread spoils no count.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn reason(key: &str, outcome: &Outcome) -> Option<(String, String)> {
    match outcome {
        Outcome::Failed { reason } => Some((key.to_owned(), reason.clone())),
        Outcome::Found { .. } => None,
    }
}

/// Runs a case. Its files must be those of its key before and after: a result under a key of other files would be a wrong one.
fn run_case<R: Runner>(
    plan: &Plan,
    planned: &PlannedCase,
    runner: &R,
) -> Result<StoredCase, SweepError> {
    let version = runner.version().to_owned();
    let text = plan.text(&planned.values, runner).unwrap_or_default();
    if let Some(reason) = planned.refused.clone() {
        let outcome = Outcome::Failed { reason };
        return Ok(StoredCase { version, inputs: vec![], case: text, outcome });
    }
    let read = || -> Result<ReadCase<R::Case>, SweepError> {
        let changed = |said| SweepError::Changed { case: planned.key[..12].to_owned(), said };
        let read = runner.read(&text).map_err(|problems| changed(format!(": {problems}")))?;
        let is_planned = case_key(&version, &read.canonical, &read.inputs) == planned.key;
        is_planned.then_some(read).ok_or_else(|| changed(String::new()))
    };
    let ReadCase { canonical, inputs, case } = read()?;
    let found = catch_unwind(AssertUnwindSafe(|| runner.run(case)));
    // names of files as the case says them: a result does not depend on where its folder lies and how a path was typed
    let folder = runner.folder();
    let as_in_case = |said: String| without_folder(&said, &folder);
    let outcome = match found {
        Ok(Ok(Found { columns, warnings })) => {
            let warnings = warnings.into_iter().map(as_in_case).collect();
            Outcome::Found { columns, warnings }
        }
        Ok(Err(NoNumbers::Failed(reason))) => Outcome::Failed { reason: as_in_case(reason) },
        Ok(Err(NoNumbers::Stopped(error))) => return Err(error.into()),
        Err(_) => Outcome::Failed {
            reason: "a bug of the program stopped the case; please report it, and run with --retry-failed once it is mended".to_owned(),
        },
    };
    read()?;
    Ok(StoredCase { version, inputs, case: canonical, outcome })
}

/// A text whose names of files do not begin with a folder any more.
fn without_folder(text: &str, folder: &str) -> String {
    let (mut out, mut kept_from) = (String::new(), 0);
    for (at, _) in text.match_indices(folder).filter(|_| !folder.is_empty()) {
        // within a path it is another folder
        let before = text[..at].chars().next_back();
        if at >= kept_from && before.is_none_or(|c| c.is_whitespace() || "('\"`".contains(c)) {
            out.push_str(&text[kept_from..at]);
            kept_from = at + folder.len();
        }
    }
    out + &text[kept_from..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_as_its_case_names_it() {
        for (text, folder, expected) in [
            ("/a/b/act.ron:2:1: gain (/a/b/c/d.csv)", "/a/b/", "act.ron:2:1: gain (c/d.csv)"),
            ("./act.ron beside ../b/act.ron", "./", "act.ron beside ../b/act.ron"),
            ("x/a/b/c and /a/b/c", "/a/b/", "x/a/b/c and c"),
            ("act.ron", "", "act.ron"),
        ] {
            assert_eq!(without_folder(text, folder), expected);
        }
    }

    #[test]
    fn the_pace_says_rate_and_time_left() {
        let pace = |computed, elapsed_s| Pace { done: Done { computed, of: 1000 }, elapsed_s };
        assert_eq!(
            pace(100, 60.0).to_string(),
            "100 of 1000 cases, 100.000 per minute, about 9 min left"
        );
        assert!(pace(1000, 60.0).to_string().ends_with("about 0 s left"));
        assert!(pace(1, 60.0).to_string().ends_with("about 16.6 h left"));
    }
}
