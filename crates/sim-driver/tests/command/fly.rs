//! `hhc fly`: a short flight with all that can happen, and flights that cannot be.

use crate::place::{Place, QUICK_CASE};
use std::process::Command;

/// 12 s: a ramp, a step of the thrust, a flap that sticks; 2 and 3/rev at once on the ideal actuator.
const FLIGHT: &str = "duration_s: 12, start_advance_ratio: 0.18, end_advance_ratio: 0.20, ramp_at_s: 1, ramp_s: 2,
        knots: 2, thrust_step: (at_s: 5, ratio: 1.1), failed_flap: (flap: 2, at_s: 8, stuck_deg: 0.5),
        noise_percent: 1, harmonics: [2, 3], amplitude_limit_V: 40";

fn flying(flight: &str) -> Place {
    let place = Place::new();
    let section = format!("    flight: ({flight}),\n    control: (");
    place.write("case.ron", &QUICK_CASE.replace("    control: (", &section));
    place
}

/// Rows of the table by their columns' names.
fn rows(csv: &str) -> Vec<std::collections::BTreeMap<&str, &str>> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

const LEVEL: &str =
    "duration_s: 4, start_advance_ratio: 0.2, end_advance_ratio: 0.2, harmonics: [2, 3],
        noise_percent: 0, controllers: [Fixed]";

/// Blades unlike the rest are flown as such: off the blade number, with control and without.
#[test]
fn a_flight_of_dissimilar_blades_feels_them() {
    let place = flying(LEVEL);
    let said = |place: &Place| place.hhc(&["fly", "case.ron"]).done();
    assert!(!said(&place).contains("Blades unlike the rest"));
    let case = place.read("case.ron");
    let unlike = "rotor: (dissimilar_blades: [(blade: 2, mass: 1.02)]),\n    structure:";
    place.write("case.ron", &case.replacen("structure:", unlike, 1));
    assert!(said(&place).contains("Blades unlike the rest: 2."));
    let csv = place.read("out/case/flight.csv");
    for row in rows(&csv) {
        for name in ["once_per_rev_over_j0", "others_over_j0_without_control"] {
            assert!(row[name].parse::<f64>().unwrap() > 1e-4, "{name}: {csv}");
        }
    }
    assert!(place.read("out/case/flight.html").contains("J at 1/rev over J0"));
}

/// A flap with an actuator file of its own moves by it; files that are missing or do not fit are refused, by `check` too.
#[test]
fn a_flap_has_an_actuator_file_of_its_own() {
    let own = "flap_actuators: [(flap: 2, path: \"outboard.ron\", notice: Untold)]";
    let place = flying(&format!("{LEVEL}, {own}"));
    for command in ["fly", "check"] {
        let parts = ["flight.flap_actuators[0].path", "outboard.ron"];
        place.hhc(&[command, "case.ron"]).rejected(&parts);
    }
    let file = |range: &str, gain: &str| {
        format!(
            "(kind: Actuator, title: \"half\", model: (law: Linear(gain_deg_per_volt: {gain}, bias_volt: 65), range_volt: {range}, calibration: (deg_per_um: 0.04, zero_um: 0)))"
        )
    };
    place.write("outboard.ron", &file("(0, 100)", "0.05"));
    place.hhc(&["fly", "case.ron"]).rejected(&["actuator.range_V", "(0, 100) V"]);
    place.write("outboard.ron", &file("(-20, 150)", "0.05"));
    place.hhc(&["check", "case.ron"]).done();
    let said = place.hhc(&["fly", "case.ron"]).done();
    for part in ["Flap 2 of every blade: actuator outboard.ron", "does not know it"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let csv = place.read("out/case/flight.csv");
    let last = rows(&csv).pop().unwrap();
    let number = |name: &str| last[name].parse::<f64>().unwrap();
    let gain = |flap: usize| {
        number(&format!("flap{flap}_3_per_rev_deg")) / number(&format!("flap{flap}_3_per_rev_V"))
    };
    println!("{} and {} deg/V", gain(1), gain(2));
    assert!((gain(2) - 0.05).abs() < 1e-3 && (gain(1) - 0.05).abs() > 0.02, "{csv}");
}

#[test]
fn a_flight_is_told_drawn_and_tabled() {
    let place = flying(FLIGHT);
    let said = place.hhc(&["fly", "case.ron"]).done();
    for part in ["mean J/J0", "settles in", "fixed", "scheduled", "adaptive", "Truth: ", "not told"]
    {
        assert_eq!(said.contains(part), part != "not told", "{part}: {said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 100), "{said}");
    let csv = place.read("out/case/flight.csv");
    let rows = rows(&csv);
    // three controllers, each with the cycles of three revolutions that 12 s hold
    assert_eq!(rows.len(), 3 * 26, "{csv}");
    let number = |row: usize, name: &str| -> f64 { rows[row][name].parse().unwrap() };
    for start in [0, 26, 52] {
        assert!((number(start, "j_over_j0") - 1.0).abs() < 1e-6, "{}", rows[start]["j_over_j0"]);
        assert!(number(start + 15, "j_over_j0") < 0.9, "{}", rows[start + 15]["j_over_j0"]);
        let [before, after] = [start + 9, start + 12];
        let load = "fz_4_per_rev_without_control_N";
        assert!(
            (number(after, load) / number(before, load) - 1.0).abs() > 0.02,
            "the step is felt"
        );
        assert!(number(start + 15, "flap2_2_per_rev_deg") > 0.05);
        assert!(number(start + 25, "flap2_2_per_rev_deg") == 0.0, "it is stuck");
        assert!(number(start + 25, "flap1_2_per_rev_deg") > 0.05, "the other one goes on");
        assert!(number(start + 25, "power_W") < number(start + 15, "power_W"));
        assert!(number(start + 15, "flap1_highest_V") > number(start + 15, "flap1_lowest_V") + 1.0);
    }
    let page = place.read("out/case/flight.html");
    assert!(page.contains("<svg") && page.contains("FZ at 4/rev") && !page.contains("<script"));
    let told = place.hhc(&["fly", "case.ron", "--out", "b", "--format", "json"]).json();
    assert_eq!(told["flown"]["flights"][1]["controller"], "scheduled");
    assert_eq!(place.read("b/flight.csv"), csv);
}

/// A flap that stands on one blade: what blades alike cancel is beside J in table, CSV, JSON and page.
#[test]
fn loads_off_the_blade_number_stand_beside_j() {
    let place = flying(
        "duration_s: 4, start_advance_ratio: 0.2, end_advance_ratio: 0.2, harmonics: [2, 3], noise_percent: 0,
        noise_notice: Told, rate_weight: 1e-14, controllers: [Fixed, Adaptive],
        failed_flap: (flap: 1, at_s: 2, stuck_deg: 1, on: OneBlade, notice: Untold)",
    );
    let said = place.hhc(&["fly", "case.ron"]).done();
    for part in ["flap 1 of one blade stuck", "not told", "1/rev", "others", "told to the adaptive"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 100), "{said}");
    let csv = place.read("out/case/flight.csv");
    let rows = rows(&csv);
    let number = |row: usize, name: &str| -> f64 { rows[row][name].parse().unwrap() };
    let last = rows.len() / 2 - 1;
    for name in ["once_per_rev_over_j0", "others_over_j0"] {
        assert!(number(1, name) == 0.0 && number(last, name) > 1e-4, "{name}: {csv}");
    }
    let page = place.read("out/case/flight.html");
    assert!(page.contains("J at 1/rev over J0") && page.contains("J at the other harmonics"));
    let told = place.hhc(&["fly", "case.ron", "--format", "json"]).json();
    let summary = &told["flown"]["flights"][0]["summary"];
    assert!(summary["end_other_ratio"].as_f64().unwrap() > 1e-4, "{summary}");
}

#[test]
fn margins_and_draws_are_tabled_and_drawn() {
    let place = flying(
        "duration_s: 3, start_advance_ratio: 0.18, knots: 2, harmonics: [2, 3], controllers: [Fixed]",
    );
    let said = place.hhc(&["fly", "case.ron", "--margins", "--draws", "4"]).done();
    for part in ["How wrong T may be", "2, 3", "slowest T to", "Draws of the noise", "of 4"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 110), "{said}");
    let csv = place.read("out/case/margins.csv");
    // 2/rev, 3/rev, both, each at two speeds
    assert_eq!(rows(&csv).len(), 6, "{csv}");
    assert!(rows(&csv)[0]["whole_step_radius_at_0.18"].parse::<f64>().unwrap() < 0.1, "{csv}");
    assert_eq!(rows(&place.read("out/case/draws.csv")).len(), 7);
    let page = place.read("out/case/flight.html");
    assert!(page.contains("T of a row flown at a column") && page.contains("95 %"));
    assert!(page.contains("2, 3 per rev: phase error of T"), "the figure of the margins");
    place.hhc(&["fly", "case.ron", "--draws", "0"]).rejected(&["--draws", "1"]);
    // a limit that there is not is a word, not a number that JSON cannot hold
    let told = place.hhc(&["fly", "case.ron", "--margins", "--format", "json"]).json();
    let margins = told["margins"].to_string();
    assert!(margins.contains("\"unbounded\"") && !margins.contains("null"), "{margins}");
    assert!(csv.contains(",unbounded,") && !csv.contains("none"), "{csv}");
    // the rerun asked for no draws: theirs is gone, what is somebody else's stays
    let has = |name: &str| place.listing().iter().any(|own| own == name);
    assert!(has("out/case/margins.csv") && !has("out/case/draws.csv"));
    place.write("out/case/draws.csv", "my,own\n1,2\n");
    place.hhc(&["fly", "case.ron"]).done();
    assert!(!has("out/case/margins.csv"));
    assert_eq!(place.read("out/case/draws.csv"), "my,own\n1,2\n");
}

#[test]
fn failures_are_tabled() {
    let place = flying("duration_s: 2, knots: 2, harmonics: [2, 3], controllers: [Fixed]");
    let said = place.hhc(&["fly", "case.ron", "--failures"]).done();
    for part in ["Failures", "flap stuck at 3 deg", "each blade (told)", "not measured"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 110), "{said}");
    let csv = place.read("out/case/failures.csv");
    let rows = rows(&csv);
    assert_eq!(rows.len(), 6 * 4, "{csv}");
    let at = |row: usize, name: &str| rows[row][name].parse::<f64>().unwrap_or(f64::NAN);
    // blades alike leave nothing off their number; one flap that stands does, and each blade can take it away
    assert!(at(1, "others_over_j0") < 1e-9 && at(1, "once_per_rev_over_j0") < 1e-9, "{csv}");
    assert!(
        at(5, "others_over_j0") > 0.01 && at(7, "others_over_j0") < at(5, "others_over_j0"),
        "{csv}"
    );
    assert!(at(0, "worst_j_over_j0").is_nan() && at(1, "worst_j_over_j0") > 0.0, "{csv}");
    assert!(at(3, "largest_V") > 0.0 && at(3, "largest_V") <= 20.0, "{csv}");
    assert!(place.read("out/case/flight.html").contains("flap stuck at 3 deg"));
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let place = flying(FLIGHT);
    let of = |threads: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hhc"));
        command.args(["fly", "case.ron", "--out", threads]);
        command.env("RAYON_NUM_THREADS", threads).current_dir(place.path());
        assert!(command.output().unwrap().status.success());
        place.read(&format!("{threads}/flight.csv"))
    };
    assert_eq!(of("1"), of("3"));
}

#[test]
fn flights_that_cannot_be_are_refused() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let before = place.listing();
    place.hhc(&["fly", "case.ron"]).rejected(&["case.ron", "has no flight", "add `flight: ()`"]);
    assert_eq!(place.listing(), before, "nothing is written");
    for (flight, parts) in [
        ("duration_s: 0", ["flight.duration_s", "is 0 s, expected 1 to 3600 s"]),
        ("start_advance_ratio: 0.7", ["flight.start_advance_ratio", "expected 0 to 0.5"]),
        ("ramp_s: -1", ["flight.ramp_s", "expected 0 to 3600 s"]),
        ("knots: 1", ["flight.knots", "expected 2 to 100"]),
        ("harmonics: []", ["flight.harmonics", "give at least one harmonic"]),
        ("harmonics: [2, 2]", ["flight.harmonics[1]", "once"]),
        ("harmonics: [11]", ["flight.harmonics[0]", "expected 1 to 10"]),
        ("controllers: []", ["flight.controllers", "[Fixed, Scheduled, Adaptive]"]),
        ("controllers: [Fixed, Fixed]", ["flight.controllers", "each controller once"]),
        ("controllers: [Wild]", ["flight.controllers", "Wild"]),
        ("thrust_step: (at_s: 70)", ["flight.thrust_step.at_s", "flight.duration_s"]),
        ("thrust_step: (ratio: 9)", ["flight.thrust_step.ratio", "expected 0.5 to 1.5"]),
        ("failed_flap: (flap: 3)", ["flight.failed_flap.flap", "expected 1 to 2"]),
        ("failed_flap: (flap: 0)", ["flight.failed_flap.flap", "expected 1 to 2"]),
        ("failed_flap: (at_s: -1)", ["flight.failed_flap.at_s", "expected 0 to 60 s"]),
        (
            "failed_flap: (stuck_deg: 90)",
            ["flight.failed_flap.stuck_deg", "expected -20 to 20 deg"],
        ),
        ("noise_percent: -3", ["flight.noise_percent", "expected 0 to 100"]),
        ("window_rev: 0", ["flight.window_rev", "expected 1 to 100"]),
        ("gain: 2", ["flight.gain", "expected 0.001 to 1"]),
        ("amplitude_limit_V: 0", ["flight.amplitude_limit_V", "positive"]),
        ("rate_limit_V: NaN", ["flight.rate_limit_V", "positive"]),
        ("z0_walk_percent: 0", ["flight.z0_walk_percent", "expected 0.01 to 100"]),
        ("rate_weight: -1", ["flight.rate_weight", "expected 0 to"]),
        ("noise_notice: Loud", ["flight.noise_notice", "Loud"]),
        ("dither_deg: 40", ["flight.dither_deg", "expected 0 to 20 deg"]),
        ("flap_survival_percent: 0", ["flight.flap_survival_percent", "expected 1 to 100 %"]),
        ("failed_flap: (kept_percent: 101)", ["flight.failed_flap.kept_percent", "0 to 100 %"]),
        ("failed_flap: (on: Two)", ["flight.failed_flap.on", "Two"]),
        (
            "flap_actuators: [(flap: 3, path: \"a.ron\")]",
            ["flight.flap_actuators[0].flap", "expected 1 to 2"],
        ),
        (
            "flap_actuators: [(blade: 9, path: \"a.ron\")]",
            ["flight.flap_actuators[0].blade", "expected 1 to 4"],
        ),
        ("flap_actuators: [(flap: 1)]", ["flight.flap_actuators[0].path", "is empty"]),
        (
            "flap_actuators: [(path: \"a.ron\"), (path: \"b.ron\")]",
            ["flight.flap_actuators[1]", "give each once"],
        ),
    ] {
        flying(flight).hhc(&["fly", "case.ron"]).rejected(&parts);
    }
    let place = flying("thrust_step: ()");
    let text = place.read("case.ron");
    let trim = "trim: WindTunnel(ct_sigma: 0.07, shaft_tilt_deg: 3.0)";
    assert!(text.contains(trim), "{text}");
    place.write("case.ron", &text.replace(trim, "trim: Prescribed(theta0_deg: 4)"));
    place.hhc(&["fly", "case.ron"]).rejected(&["flight.thrust_step", "leave thrust_step out"]);
    place.write("case.ron", "(flaps: [], control: (harmonics: []), flight: ())");
    place.hhc(&["fly", "case.ron"]).rejected(&["case.ron", "give flaps"]);
}
