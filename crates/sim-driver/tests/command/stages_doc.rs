//! The actuator file of the book that has every stage.

use crate::place::Place;

const PAGE: &str = include_str!("../../../../docs/src/case-format.md");

/// The fenced block behind a mark of the page.
fn example(mark: &str) -> &'static str {
    let (_, behind) = PAGE.split_once(mark).unwrap();
    let (_, block) = behind.split_once("```text\n").unwrap();
    block.split_once("```").unwrap().0
}

#[test]
fn the_example_of_every_stage_is_a_sound_actuator() {
    let text = example("<!-- every stage -->");
    for stage in [
        "Lag",
        "CurrentLimit",
        "Saturation",
        "Delay",
        "DielectricHeating",
        "Depolarisation",
        "LogCreep",
        "KelvinVoigt",
        "Relaxation",
        "Accommodation",
        "Resonance",
        "Backlash",
        "CoulombFriction",
        "LoadStiffness",
        "Filter",
        "Nonlinearity",
        "Quantisation",
        "MainsHum",
    ] {
        assert!(text.contains(&format!(" {stage}(")), "{stage}");
    }
    let place = Place::new();
    place.write("every.ron", text);
    let ran = place.hhc(&["check", "every.ron"]);
    assert!(!ran.err.contains("warning"), "{}", ran.err);
    let out = ran.done();
    assert!(!out.contains("warning"), "{out}");
}
