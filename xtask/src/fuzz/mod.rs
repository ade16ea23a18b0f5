//! Changed inputs for every reader: an error or a value, never a panic.
//!
//! | idea | module |
//! |---|---|
//! | how an input is changed | `mutate` |
//! | bytes, words and numbers of any input | `bytes` |
//! | the parts of an input by its form | `parts` |
//! | packed inputs, changed inside | `container` |
//! | the readers and their valid inputs | `targets` |
//! | valid inputs that no fixture holds | `seeds` |
//!
//! Inputs come in batches. A batch follows from the seed, the reader and its number alone, so a run can be stopped, resumed
//! and spread over threads, and a panic can be had again. Readers share the time evenly.

mod bytes;
mod container;
mod mutate;
mod parts;
mod seeds;
mod targets;

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};

use crate::{XtaskError, files};
use targets::Target;

/// Inputs of a batch.
const BATCH: u64 = 50;
/// Time between two notes of how far a run is, s.
const NOTED_EVERY: Duration = Duration::from_secs(10);
/// A reader that takes longer for an input is said to be slow, s.
pub const SLOW_S: f64 = 1.0;

/// What is asked of a run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Time from its start.
    pub budget: Duration,
    /// Inputs of all readers, those of earlier parts of the run included; it ends when they are reached.
    pub most_inputs: u64,
    /// Seed of the changes.
    pub seed: u64,
    /// Threads.
    pub threads: usize,
    /// File that says how far the run is: it is resumed from there, and noted there.
    pub state: Option<PathBuf>,
}

/// What became of the inputs of a reader.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// The reader.
    pub reader: String,
    /// How many of its valid inputs it takes: if none, the changed ones do not reach far.
    pub takes_valid: usize,
    /// Batches that were begun.
    pub batches: u64,
    /// Inputs that it was given.
    pub inputs: u64,
    /// Inputs that it took.
    pub taken: u64,
    /// Time of the reader for all inputs, s.
    pub time_s: f64,
    /// The same with the time for making the inputs, s: what readers share evenly.
    pub spent_s: f64,
    /// Longest time for one input, s.
    pub slowest_s: f64,
    /// That input, where it is longer than [`SLOW_S`].
    #[serde(skip)]
    pub slow: Option<Vec<u8>>,
    /// The first input at which it panicked: a run that goes on still fails.
    #[serde(default)]
    pub panicked: Option<Vec<u8>>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reader, inputs, taken, spent_s, slowest_s, panicked, .. } = self;
        let per_s = *inputs as f64 / spent_s.max(1e-9);
        let percent = 100.0 * *taken as f64 / (*inputs).max(1) as f64;
        write!(
            f,
            "{reader:<18} {inputs:>9} inputs, {per_s:>7.0} per s and thread, {percent:>4.1} % taken, slowest {slowest_s:.3} s"
        )?;
        if panicked.is_some() { f.write_str(", PANICKED") } else { Ok(()) }
    }
}

/// How far a run is, as it is noted.
#[derive(Debug, Serialize, Deserialize)]
struct State {
    seed: u64,
    tallies: Vec<Tally>,
}

/// What the threads share.
struct Shared {
    tallies: Mutex<Vec<Tally>>,
    noted: Mutex<Instant>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Gives all readers changed inputs for a time, in equal shares of it; a reader that panics has no more turns.
///
/// # Errors
/// [`XtaskError`] if an input to begin with cannot be read, or the folder of the inputs cannot be made.
pub fn fuzz(root: &Path, options: &Options) -> Result<Vec<Tally>, XtaskError> {
    let place = folder()?;
    let targets = targets::targets(root, place.path())?;
    let mut tallies: Vec<Tally> = targets.iter().map(first_tally).collect();
    drop(targets);
    if let Some(path) = options.state.as_ref().filter(|path| path.is_file()) {
        let state: Option<State> = serde_json::from_str(&files::read(path)?).ok();
        for earlier in
            state.filter(|state| state.seed == options.seed).into_iter().flat_map(|s| s.tallies)
        {
            if let Some(own) = tallies.iter_mut().find(|own| own.reader == earlier.reader) {
                *own = Tally { takes_valid: own.takes_valid, ..earlier };
            }
        }
    }
    let begun = Instant::now();
    let shared = Shared { tallies: Mutex::new(tallies), noted: Mutex::new(begun) };
    let work = || -> Result<(), XtaskError> {
        let place = folder()?;
        let targets = targets::targets(root, place.path())?;
        while begun.elapsed() < options.budget {
            let Some((which, batch)) = next_batch(&shared, options.most_inputs) else { break };
            let done = run_batch(&targets[which], options.seed, batch);
            add(&mut lock(&shared.tallies)[which], done);
            note(&shared, options)?;
        }
        Ok(())
    };
    let ends: Vec<Result<(), XtaskError>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..options.threads.max(1)).map(|_| scope.spawn(work)).collect();
        let joined = workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.collect()
    });
    ends.into_iter().collect::<Result<(), XtaskError>>()?;
    *lock(&shared.noted) = begun.checked_sub(NOTED_EVERY).unwrap_or(begun);
    write_note(&shared, options)?;
    let tallies = lock(&shared.tallies).clone();
    Ok(tallies)
}

/// A folder for the inputs of files: in memory where there is such a place.
fn folder() -> Result<tempfile::TempDir, XtaskError> {
    let memory = Path::new("/dev/shm");
    let made = tempfile::tempdir_in(memory).or_else(|_| tempfile::tempdir());
    made.map_err(|source| XtaskError::Write { path: "fuzz".into(), source })
}

fn first_tally(target: &Target) -> Tally {
    let takes_valid = target.valid.iter().filter(|input| (target.read)(input)).count();
    Tally { reader: target.reader.to_owned(), takes_valid, ..Tally::default() }
}

/// The reader that has had the least time, and the number of its next batch.
fn next_batch(shared: &Shared, most_inputs: u64) -> Option<(usize, u64)> {
    let mut tallies = lock(&shared.tallies);
    let begun: u64 = tallies.iter().map(|own| own.batches * BATCH).sum();
    if begun >= most_inputs {
        return None;
    }
    // batches that others are at count by the mean time of one
    let share = |own: &Tally| {
        let done = (own.inputs / BATCH).max(1);
        own.spent_s * own.batches as f64 / done as f64 + 1e-6 * own.batches as f64
    };
    let open = tallies.iter().enumerate().filter(|(_, own)| own.panicked.is_none());
    let which = open.min_by(|a, b| share(a.1).total_cmp(&share(b.1)))?.0;
    let own = &mut tallies[which];
    own.batches += 1;
    Some((which, own.batches - 1))
}

/// One batch of a reader. Some inputs begin from one that the reader took: changes pile up.
fn run_batch(target: &Target, seed: u64, batch: u64) -> Tally {
    let name = blake3::hash(format!("{seed} {} {batch}", target.reader).as_bytes());
    let mut random = ChaCha8Rng::from_seed(*name.as_bytes());
    let begun = Instant::now();
    let mut tally = Tally::default();
    let mut last: Option<Vec<u8>> = None;
    for _ in 0..BATCH {
        let from = last.as_ref().filter(|_| random.random_range(0..3_u32) == 0);
        let input = mutate::mutated(target.form, &target.valid, from, &mut random);
        let started = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| (target.read)(&input)));
        let took_s = started.elapsed().as_secs_f64();
        tally.inputs += 1;
        tally.time_s += took_s;
        if took_s > tally.slowest_s {
            tally.slowest_s = took_s;
            tally.slow = (took_s > SLOW_S).then(|| input.clone());
        }
        match read {
            Ok(true) => {
                tally.taken += 1;
                last = Some(input);
            }
            Ok(false) => {}
            Err(_) => {
                tally.panicked = Some(input);
                break;
            }
        }
    }
    tally.spent_s = begun.elapsed().as_secs_f64();
    tally
}

/// Gives a reader one input: whether it was taken, and the time, s. None where there is no such reader.
///
/// # Errors
/// [`XtaskError`] as of [`fuzz`].
pub fn replay(root: &Path, reader: &str, input: &[u8]) -> Result<Option<(bool, f64)>, XtaskError> {
    let place = folder()?;
    let targets = targets::targets(root, place.path())?;
    let target = targets.iter().find(|target| target.reader == reader);
    Ok(target.map(|target| {
        let begun = Instant::now();
        ((target.read)(input), begun.elapsed().as_secs_f64())
    }))
}

fn add(own: &mut Tally, done: Tally) {
    own.inputs += done.inputs;
    own.taken += done.taken;
    own.time_s += done.time_s;
    own.spent_s += done.spent_s;
    if done.slowest_s > own.slowest_s {
        (own.slowest_s, own.slow) = (done.slowest_s, done.slow);
    }
    own.panicked = own.panicked.take().or(done.panicked);
}

/// Notes how far the run is, now and then.
fn note(shared: &Shared, options: &Options) -> Result<(), XtaskError> {
    let mut noted = lock(&shared.noted);
    if noted.elapsed() < NOTED_EVERY {
        return Ok(());
    }
    *noted = Instant::now();
    write_note(shared, options)
}

fn write_note(shared: &Shared, options: &Options) -> Result<(), XtaskError> {
    let Some(path) = &options.state else { return Ok(()) };
    let state = State { seed: options.seed, tallies: lock(&shared.tallies).clone() };
    let text = serde_json::to_string_pretty(&state)
        .map_err(|error| XtaskError::Study(error.to_string()))?;
    files::write_atomically(path, &text)
}
