//! `hhc wake`: a case trimmed in its free wake.

use crate::place::{Place, QUICK_CASE};

/// A small wake: steps of 30 deg, two turns, eight panels.
const SMALL_WAKE: &str =
    "FreeWake(azimuths: 12, turns: 2, panels: 8, core_r: 0.05, near_core_r: 0.05, tolerance: 0.002,
        rolled_up: TipRootAndSheet, control_point: ThreeQuarterChord)";

fn small_case() -> String {
    QUICK_CASE.replace("(model: Uniform)", &format!("(model: {SMALL_WAKE})"))
}

#[test]
fn the_wake_of_a_case_is_shown_and_written() {
    let place = Place::new();
    place.write("case.ron", &small_case());
    let text = place.hhc(&["wake", "case.ron", "--mu", "0.25", "--out", "wake"]).done();
    for part in ["Free wake at mu 0.250", "of Glauert's; near wake 360 deg", "displacement R"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let vtk = place.read("wake/wake.vtk");
    assert!(vtk.starts_with("# vtk DataFile Version 3.0\n") && !vtk.contains("NaN"), "{vtk}");
    // blades, near wake and six rolled-up vortices of four blades
    assert!(vtk.contains(&format!("LINES {} ", 4 * (1 + 9 + 6))), "{vtk}");
    let map = place.read("wake/inflow_map.csv");
    assert_eq!(map.lines().count(), 1 + 12 * 8, "{map}");
    let geometry = place.read("wake/wake_geometry.csv");
    assert!(geometry.lines().count() > 1 && !geometry.contains("NaN"), "{geometry}");
}

#[test]
fn an_advance_ratio_no_rotor_has_is_refused() {
    let place = Place::new();
    place.write("case.ron", &small_case());
    for mu in ["0.7", "NaN", "inf"] {
        let parts = ["--mu: is", "expected 0 to 0.5", "0 is hover"];
        place.hhc(&["wake", "case.ron", "--mu", mu]).rejected(&parts);
    }
}
