//! Ten seconds of changed inputs; `cargo xtask fuzz` has more time.

use std::time::Duration;

use xtask::fuzz::{Options, Tally, fuzz};
use xtask::workspace;

fn asked(seconds: u64, most_inputs: u64, threads: usize) -> Options {
    Options { budget: Duration::from_secs(seconds), most_inputs, seed: 1, threads, state: None }
}

#[test]
fn no_reader_panics() {
    let tallies = fuzz(&workspace::root(), &asked(10, u64::MAX, 2)).unwrap();
    for tally in &tallies {
        let shown =
            tally.panicked.as_ref().map(|input| String::from_utf8_lossy(input).into_owned());
        assert_eq!(shown, None, "{tally}");
        assert!(tally.inputs >= 50, "{tally}");
    }
    // formats that are refused with a remedy
    let refused = |tally: &&Tally| tally.takes_valid == 0;
    let refused: Vec<&str> =
        tallies.iter().filter(refused).map(|tally| tally.reader.as_str()).collect();
    assert_eq!(refused, ["import others"]);
}

/// The batches follow from the seed: any number of threads, and parts that are resumed, see the same inputs.
#[test]
fn a_run_can_be_resumed_and_shared() {
    let place = tempfile::tempdir().unwrap();
    let state = Some(place.path().join("state.json"));
    let counts = |tallies: &[Tally]| -> u64 { tallies.iter().map(|own| own.inputs).sum() };
    let root = workspace::root();
    let first = fuzz(&root, &Options { state: state.clone(), ..asked(600, 1500, 1) }).unwrap();
    assert!((1500..1600).contains(&counts(&first)), "{}", counts(&first));
    let both = fuzz(&root, &Options { state: state.clone(), ..asked(600, 3000, 2) }).unwrap();
    assert!((3000..3100).contains(&counts(&both)), "{}", counts(&both));
    for (first, both) in first.iter().zip(&both) {
        assert!(both.batches >= first.batches && both.taken >= first.taken, "{both}");
    }
    // another seed is another run
    let other = fuzz(&root, &Options { state, seed: 2, ..asked(600, 200, 1) }).unwrap();
    assert!(counts(&other) < 300, "{}", counts(&other));
}
