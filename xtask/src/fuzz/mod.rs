//! Mutated bytes for every reader: an error or a value, never a panic.
//!
//! | idea | module |
//! |---|---|
//! | how an input is changed | `mutate` |
//! | the readers and their valid inputs | `targets` |

mod mutate;
mod targets;

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::XtaskError;

/// Inputs of a reader before the next one has its turn.
const BATCH: usize = 50;

/// What became of the inputs of a reader.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// The reader.
    pub reader: &'static str,
    /// Whether it takes its valid inputs: else the changed ones would not reach far.
    pub takes_valid: bool,
    /// Inputs that it was given.
    pub inputs: u64,
    /// Inputs that it took.
    pub taken: u64,
    /// Longest time for one input, s.
    pub slowest_s: f64,
    /// The first input at which it panicked.
    pub panicked: Option<Vec<u8>>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reader, inputs, taken, slowest_s, panicked, .. } = self;
        write!(f, "{reader:<14} {inputs:>9} inputs, {taken:>8} taken, slowest {slowest_s:.3} s")?;
        if panicked.is_some() { f.write_str(", PANICKED") } else { Ok(()) }
    }
}

/// Gives all readers mutated inputs in turn for a time; a reader that panics has no more turns.
///
/// # Errors
/// [`XtaskError`] if an input to begin with cannot be read, or the folder of the inputs cannot be made.
#[expect(clippy::disallowed_methods, reason = "the budget is a time")]
pub fn fuzz(root: &Path, budget: Duration, seed: u64) -> Result<Vec<Tally>, XtaskError> {
    let place =
        tempfile::tempdir().map_err(|source| XtaskError::Write { path: "fuzz".into(), source })?;
    let targets = targets::targets(root, place.path())?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let tally = |target: &targets::Target| Tally {
        reader: target.reader,
        takes_valid: target.valid.iter().all(|input| (target.read)(input)),
        ..Tally::default()
    };
    let mut tallies: Vec<Tally> = targets.iter().map(tally).collect();
    let begun = Instant::now();
    while begun.elapsed() < budget {
        for (target, tally) in
            targets.iter().zip(&mut tallies).filter(|(_, t)| t.panicked.is_none())
        {
            for _ in 0..BATCH {
                let input = mutate::mutated(&target.valid, &mut random);
                let started = Instant::now();
                let read = catch_unwind(AssertUnwindSafe(|| (target.read)(&input)));
                tally.slowest_s = tally.slowest_s.max(started.elapsed().as_secs_f64());
                tally.inputs += 1;
                if let Ok(taken) = read {
                    tally.taken += u64::from(taken);
                } else {
                    tally.panicked = Some(input);
                    break;
                }
            }
        }
    }
    Ok(tallies)
}
