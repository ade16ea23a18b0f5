//! Kills at random moments: what was finished stays, nothing is half there, and the next run ends as if nothing had happened.

use std::path::Path;
use std::time::{Duration, Instant};

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::place::{Files, Place, strange};
use crate::XtaskError;

/// Cases of the sweep that is killed.
const CASES: usize = 24;
/// Attempts for one kill: a run may end before it.
const ATTEMPTS: usize = 20;

/// What is killed, how often, and what was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Killed {
    /// What was run.
    pub what: String,
    /// Kills that met a running program.
    pub kills: usize,
    /// Time of an undisturbed run, s.
    pub undisturbed_s: f64,
    /// Files found whole after the kills, all together.
    pub whole_files: usize,
    /// Files that were being written at a kill and stay under a name of their own.
    pub unfinished: usize,
    /// What must not be.
    pub faults: Vec<String>,
}

impl std::fmt::Display for Killed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, kills, undisturbed_s, whole_files, unfinished, faults } = self;
        write!(
            f,
            "{what}: {kills} kills within {undisturbed_s:.2} s; {whole_files} files whole after them, {unfinished} left under a \
             temporary name, {} faults",
            faults.len()
        )
    }
}

/// A program that is killed.
struct Victim<'a> {
    place: &'a Place,
    arguments: &'a [&'a str],
    /// The files of an undisturbed run.
    whole: Files,
    found: Killed,
}

impl Victim<'_> {
    /// Runs it from the start, kills it at a random moment and looks at `out`. Files that were there before must still be,
    /// and every file must be one of an undisturbed run.
    fn kill(&mut self, random: &mut ChaCha8Rng) -> Result<(), XtaskError> {
        for _ in 0..ATTEMPTS {
            let unfinished = self.place.unfinished("out");
            let mut child = self.place.spawn(self.arguments)?;
            let moment_s = self.found.undisturbed_s * random.random_range(0.0..1.0);
            std::thread::sleep(Duration::from_secs_f64(moment_s));
            let before = self.place.files("out");
            let failed = |source| XtaskError::Start { program: "a kill".to_owned(), source };
            if child.try_wait().map_err(failed)?.is_some() {
                // all is computed: a run that goes on would end at once
                crate::files::remove_folder(&self.place.path().join("out"))?;
                continue;
            }
            child.kill().map_err(failed)?;
            child.wait().map_err(failed)?;
            let now = self.place.files("out");
            let mut fault = |said: String| {
                self.found
                    .faults
                    .push(format!("{} after {moment_s:.3} s: {said}", self.found.what));
            };
            for name in before.keys().filter(|name| !now.contains_key(*name)) {
                fault(format!("{name} was there and is lost"));
            }
            for name in strange(&now, &self.whole) {
                fault(format!("{name} is not that of an undisturbed run"));
            }
            self.found.kills += 1;
            self.found.whole_files += now.len();
            self.found.unfinished += self.place.unfinished("out").saturating_sub(unfinished);
            return Ok(());
        }
        self.found.faults.push(format!("{}: no kill met the program running", self.found.what));
        Ok(())
    }

    /// Compares all that is there with an undisturbed run, after a run to the end.
    fn ends_as_undisturbed(&mut self) {
        let now = self.place.files("out");
        for name in strange(&now, &self.whole).into_iter().chain(strange(&self.whole, &now)) {
            let what = &self.found.what;
            self.found
                .faults
                .push(format!("{what} run again: {name} differs from an undisturbed run"));
        }
    }
}

/// An undisturbed run to `out`, its time and its files; `out` is gone afterwards.
fn undisturbed(place: &Place, runs: &[&[&str]]) -> Result<(f64, Files), XtaskError> {
    let begun = Instant::now();
    let mut first_s = 0.0;
    for (number, arguments) in runs.iter().enumerate() {
        place.said(arguments)?;
        if number == 0 {
            first_s = begun.elapsed().as_secs_f64();
        }
    }
    let whole = place.files("out");
    crate::files::remove_folder(&place.path().join("out"))?;
    Ok((first_s, whole))
}

/// Kills a sweep of small cases: each run goes on where the last one was killed, and begins anew once all is computed.
fn of_sweep(program: &Path, kills: usize, random: &mut ChaCha8Rng) -> Result<Killed, XtaskError> {
    let place = Place::new(program)?;
    place.write(
        "sweep.ron",
        &format!("(base: \"case.ron\", axes: [(field: \"rotor.gj\", from: 0.005, to: 0.007, count: {CASES})])"),
    )?;
    let run = ["sweep", "run", "sweep.ron", "--out", "out"];
    let merge = ["sweep", "merge", "sweep.ron", "--out", "out"];
    let (undisturbed_s, whole) = undisturbed(&place, &[&run, &merge])?;
    let found =
        Killed { what: format!("sweep of {CASES} cases"), undisturbed_s, ..Killed::default() };
    let mut victim = Victim { place: &place, arguments: &run, whole, found };
    for number in 0..kills {
        // a moment of a fresh run every third time, else one of a run that goes on
        if number % 3 == 0 {
            crate::files::remove_folder(&place.path().join("out"))?;
        }
        victim.kill(random)?;
        let there = place.files("out").len();
        // what is there is not computed again, and nothing else is left out
        if number % 3 == 2 || number + 1 == kills {
            let said =
                place.said(&["sweep", "run", "sweep.ron", "--out", "out", "--format", "json"])?;
            let ran: serde_json::Value = serde_json::from_str(&said)
                .map_err(|error| XtaskError::Study(format!("{error} in {said}")))?;
            let count = |key: &str| ran[key].as_u64().and_then(|count| usize::try_from(count).ok());
            let expected = [Some(there), Some(CASES - there.min(CASES))];
            if [count("skipped"), count("computed")] != expected {
                victim
                    .found
                    .faults
                    .push(format!("{there} results were there, the next run says {said}"));
            }
            place.said(&merge)?;
            victim.ends_as_undisturbed();
            crate::files::remove_folder(&place.path().join("out"))?;
        }
    }
    Ok(victim.found)
}

/// Kills a command that writes a folder; after every `rerun`th kill it runs to its end.
fn of_command(
    program: &Path,
    (what, arguments): (&str, &[&str]),
    (kills, rerun): (usize, usize),
    random: &mut ChaCha8Rng,
) -> Result<Killed, XtaskError> {
    let place = Place::new(program)?;
    let (undisturbed_s, whole) = undisturbed(&place, &[arguments])?;
    let (_, again) = undisturbed(&place, &[arguments])?;
    let mut found = Killed { what: what.to_owned(), undisturbed_s, ..Killed::default() };
    for name in strange(&again, &whole) {
        found.faults.push(format!("{what}: {name} differs between two undisturbed runs"));
    }
    let mut victim = Victim { place: &place, arguments, whole, found };
    for number in 0..kills {
        victim.kill(random)?;
        if (number + 1) % rerun == 0 || number + 1 == kills {
            place.said(arguments)?;
            victim.ends_as_undisturbed();
            crate::files::remove_folder(&place.path().join("out"))?;
        }
    }
    Ok(victim.found)
}

/// Kills a sweep and a study `kills` times each, and the paper's study a tenth as often.
///
/// # Errors
/// [`XtaskError`] if the program cannot be run or an undisturbed run fails.
pub fn kill(program: &Path, kills: usize, seed: u64) -> Result<Vec<Killed>, XtaskError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let study = ["run", "case.ron", "--mu", "0.1,0.15,0.2,0.25,0.3", "--out", "out"];
    let paper = ["--out", "out"];
    let mut of_many = [
        of_sweep(program, kills, &mut random)?,
        of_command(program, ("study of 5 advance ratios", &study), (kills, 5), &mut random)?,
    ];
    for killed in &mut of_many {
        // many cases, of which a kill loses the one in progress: the others were there
        if killed.whole_files == 0 {
            killed.faults.push(format!("{}: no kill left a result", killed.what));
        }
    }
    let [sweep, study] = of_many;
    Ok(vec![
        sweep,
        study,
        of_command(program, ("the paper's study", &paper), (kills.div_ceil(10), 5), &mut random)?,
    ])
}
