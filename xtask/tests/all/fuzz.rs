//! Ten seconds of mutated inputs; `cargo xtask fuzz` has more time.

use std::time::Duration;

use xtask::fuzz::fuzz;
use xtask::workspace;

#[test]
fn no_reader_panics() {
    let tallies = fuzz(&workspace::root(), Duration::from_secs(10), 1).unwrap();
    for tally in &tallies {
        let shown =
            tally.panicked.as_ref().map(|input| String::from_utf8_lossy(input).into_owned());
        assert_eq!(shown, None, "{tally}");
        assert!(tally.inputs >= 50, "{tally}");
    }
    // changes that make every input useless would find nothing
    let taken = tallies.iter().filter(|tally| tally.taken > 0).count();
    assert!(taken >= 9, "{tallies:?}");
}
