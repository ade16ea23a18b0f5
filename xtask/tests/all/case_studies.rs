//! The pages of the case studies hold what the program says.

use xtask::case_studies::{Options, run};
use xtask::workspace;

/// Sections and a blade: seconds. `cargo xtask case-studies --check` compares the rotors too.
#[test]
fn pages_and_figures_of_sections_and_blades_are_current() {
    for name in ["oscillating-flap", "rotating-strip", "dynamic-stall"] {
        let options = Options { name: Some(name.to_owned()), check: true, ..Options::default() };
        let stale = run(&workspace::root(), &options, |_| {}).unwrap();
        assert!(stale.is_empty(), "run `cargo xtask case-studies {name}`: {stale:?}");
    }
}

#[test]
fn a_name_that_is_no_study_is_refused() {
    let options = Options { name: Some("flap".to_owned()), ..Options::default() };
    let refused = run(&workspace::root(), &options, |_| {}).unwrap_err();
    assert!(refused.to_string().contains("oscillating-flap"), "{refused}");
}
