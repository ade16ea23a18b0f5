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
    // a result whose key is none, rows without a table and loops without records are refused behind their readers
    let refused: Vec<&str> = tallies.iter().filter(|t| !t.takes_valid).map(|t| t.reader).collect();
    assert_eq!(refused, ["sweep file", "stored case", "loops"]);
}
