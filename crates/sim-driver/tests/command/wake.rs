//! `hhc wake`: a case trimmed in its free wake.

use crate::place::{Place, QUICK_CASE, SMALL_WAKE};
use std::process::Command;

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
    assert!(
        vtk.contains("SCALARS circulation double 1") && vtk.contains("SCALARS core_r double 1")
    );
    let geometry = place.read("wake/wake_geometry.csv");
    let head = "kind,filament,release_r,azimuth_deg,age_deg,x_r,y_r,z_r,circulation,core_r";
    assert!(geometry.starts_with(head) && !geometry.contains("NaN"), "{geometry}");
    // nine trailers of a revolution at every azimuth, then the rolled-up vortices for the turn that is left
    let count = |kind: &str| geometry.lines().filter(|line| line.starts_with(kind)).count();
    assert_eq!([count("near,"), count("rolled_up,")], [9 * 12 * 13, 6 * 12 * 13]);
    let convergence = place.read("wake/convergence.csv");
    assert!(convergence.starts_with("azimuths,displacement_r,inflow_change,part,theta0_deg\n"));
}

/// One row of the geometry file.
fn row(line: &str) -> Vec<f64> {
    line.split(',').skip(1).map(|field| field.parse().unwrap()).collect()
}

/// The wake alone: helices of given circulation, whose mean inflow over Glauert's is 1.21 at mu 0.30 (72 steps, tip vortex of
/// strength `2 pi C_T / N_b` from blades that reach the centre).
#[test]
fn a_wake_of_prescribed_circulation_is_looked_at_alone() {
    let place = Place::new();
    let wake =
        "FreeWake(circulation: Prescribed(shape: Constant, geometry: Undistorted, ct_sigma: 0.07,
        shaft_tilt_deg: 5.0), azimuths: 72, turns: 3, far_turns: 0, near_wake_deg: 5.0, panels: 40,
        near_core_r: 0.02, core_r: 0.02, panel_share: 1e6)";
    let inflow = format!("(model: {wake}), rotor: (root_cutout_r: 0.0)");
    place.write("case.ron", &QUICK_CASE.replace("(model: Uniform)", &inflow));
    let args = ["wake", "case.ron", "--mu", "0.3", "--out", "wake", "--format", "json"];
    let result = place.hhc(&args).json();
    let ratio = result["mean_over_glauert"].as_f64().unwrap();
    assert!((ratio / 1.21 - 1.0).abs() < 0.02, "{ratio}");
    assert!(result["controls_deg"].is_null() && result["settled"].as_bool().unwrap());
    // solidity 0.07: C_T of 0.0049
    let solidity = 4.0 * 0.055 / std::f64::consts::PI;
    let strength = std::f64::consts::TAU * 0.07 * solidity / 4.0;
    let geometry = place.read("wake/wake_geometry.csv");
    let old = geometry.lines().filter(|line| line.starts_with("rolled_up,"));
    for fields in old.map(row) {
        let (circulation, core) = (fields[7], fields[8]);
        assert!((circulation / strength - 1.0).abs() < 1e-5, "{fields:?}");
        assert!((0.02..0.03).contains(&core), "{fields:?}");
    }
    // a rotor is not trimmed with a circulation that is not its own
    let refused = place.hhc(&["run", "case.ron", "--out", "run"]);
    assert_ne!(refused.code, 0);
    assert!(
        refused.err.contains("inflow.model.circulation: is refused: a rotor is trimmed with"),
        "{}",
        refused.err
    );
    // left free and smooth, it moves until it rests
    let free = "FreeWake(circulation: Prescribed(), azimuths: 12, turns: 2, panels: 8)";
    place.write("free.ron", &QUICK_CASE.replace("(model: Uniform)", &format!("(model: {free})")));
    let text = place.hhc(&["wake", "free.ron", "--mu", "0.3"]).done();
    assert!(text.contains("circulation prescribed, settled"), "{text}");
}

#[test]
fn a_run_in_a_wake_that_has_not_settled_says_so() {
    let place = Place::new();
    let wake = SMALL_WAKE.replace("tolerance: 0.002", "tolerance: 1e-8, updates: 1");
    let case = QUICK_CASE.replace("(model: Uniform)", &format!("(model: {wake})"));
    place.write("case.ron", &case);
    let run = place.hhc(&["run", "case.ron", "--out", "run", "--details"]);
    for part in ["the free wake has not settled in 1 updates", "theta0 between", "Remedy:"] {
        assert!(run.err.contains(part), "no `{part}` in\n{}", run.err);
    }
    assert!(place.read("run/result.json").contains("the free wake has not settled"));
    assert_eq!(run.code, 0, "{}", run.err);
}

/// A wake that diverges is stored and shown as the last good state, not controlled, and fails the command;
/// in a descent where wakes break down that is said. One update already shows it: more would be chaos, other on every machine.
#[test]
fn a_wake_that_parts_from_its_rotor_is_no_solution() {
    let place = Place::new();
    let case = "(advance_ratio: 0.03, flaps: [(start_r: 0.7, end_r: 0.8)],
        structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
        aerodynamics: (model: QuasiSteady, compressibility: None),
        inflow: (model: FreeWake(azimuths: 12, turns: 3, panels: 10, core_r: 0.01, near_core_r: 0.01,
            mutual_core_r: 0, updates: 1)),
        trim: WindTunnel(ct_sigma: 0.15, shaft_tilt_deg: -30),
        actuator: (model: Ideal), control: (harmonics: [[4]], actuators: [Ideal]))";
    place.write("case.ron", case);
    let ran = place.hhc(&["run", "case.ron", "--out", "run"]);
    assert_eq!(ran.code, 1, "{}", ran.out);
    assert!(ran.err.contains("vortex-ring state"), "{}", ran.err);
    assert!(ran.out.contains("Wake       DIVERGED"), "{}", ran.out);
    assert!(!ran.out.contains("Reduction of hub vibration"), "{}", ran.out);
    assert!(ran.err.contains("inflow.model: wake and trim found no solution"), "{}", ran.err);
    assert!(!ran.err.contains("inf of the tip speed"), "{}", ran.err);
    let stored = place.read("run/result.json");
    let stored: serde_json::Value = serde_json::from_str(&stored).unwrap();
    assert_eq!(stored["result"]["wake"], "diverged");
    assert!(stored["result"]["control"].as_array().unwrap().is_empty());
    place.hhc(&["report", "run"]).done();
    let looked_at = place.hhc(&["wake", "case.ron"]);
    assert_eq!(looked_at.code, 1);
    // among other advance ratios it is marked, and the others are found
    let swept = place.hhc(&["run", "case.ron", "--mu", "0.03,0.25", "--out", "s"]);
    assert_eq!(swept.code, 1);
    assert!(
        swept.out.contains("0.030**") && swept.out.contains("** wake and trim are no solution")
    );
    assert!(swept.err.contains("advance ratio 0.03: case.ron"), "{}", swept.err);
    let csv = place.read("s/sweep.csv");
    let failed: Vec<bool> = csv.lines().map(|line| line.contains("found no solution")).collect();
    assert!(csv.contains(",wake,") && failed == [false, true, false], "{csv}");
    assert!(!csv.contains("diverged"), "{csv}");
    assert!(looked_at.out.contains("mu 0.030: diverged"), "{}", looked_at.out);
}

/// Down a steep slope the wake leaves upward, where the linear model of the start knows no answer.
#[test]
fn a_windmill_brake_descent_is_trimmed() {
    let place = Place::new();
    let trim = "advance_ratio: 0.05, trim: Prescribed(theta0_deg: -2, shaft_tilt_deg: -45)";
    let wake = "inflow: (model: FreeWake(azimuths: 12, turns: 3, panels: 8))";
    place.write("case.ron", &format!("({trim}, {wake})"));
    let text = place.hhc(&["wake", "case.ron"]).done();
    assert!(text.contains("Free wake at mu 0.050"), "{text}");
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

/// A rotor with hardly any thrust: lift of both senses along the span, which momentum theory does not have. With a
/// thrust that wants an inflow such a wake is no solution.
#[test]
fn an_inflow_that_does_not_go_with_the_thrust_is_told() {
    let place = Place::new();
    let case = |advance_ratio: f64, theta0: f64| {
        format!(
            "(advance_ratio: {advance_ratio}, structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
            aerodynamics: (model: QuasiSteady, compressibility: None),
            inflow: (model: FreeWake(azimuths: 24)), trim: Prescribed(theta0_deg: {theta0},
            theta1c_deg: 0, theta1s_deg: 0, shaft_tilt_deg: 0), actuator: (model: Ideal))"
        )
    };
    let warned = "of momentum theory's for this thrust";
    let refused = "carries hardly any of the thrust";
    for (advance_ratio, theta0, code, told) in
        [(0.1, 0.3, 0, Some(warned)), (0.0, 0.0, 1, Some(refused)), (0.0, 9.0, 0, None)]
    {
        place.write("case.ron", &case(advance_ratio, theta0));
        let ran = place.hhc(&["wake", "case.ron"]);
        assert_eq!(ran.code, code, "{}", ran.err);
        for words in [warned, refused] {
            assert_eq!(ran.err.contains(words), told == Some(words), "{}", ran.err);
        }
    }
    // a given circulation in the same descent as a trimmed one
    place.write(
        "case.ron",
        "(advance_ratio: 0.05, inflow: (model: FreeWake(azimuths: 12, updates: 3, circulation:
            Prescribed(shape: Elliptic, ct_sigma: 0.07, shaft_tilt_deg: -45, geometry: Free))))",
    );
    let ran = place.hhc(&["wake", "case.ron"]);
    assert!(ran.err.contains("in the vortex-ring state"), "{}", ran.err);
}

/// A case that has a free wake keeps it where one is asked for.
#[test]
fn asking_for_the_free_wake_keeps_that_of_the_case() {
    let place = Place::new();
    place.write(
        "case.ron",
        "(advance_ratio: 0.25, structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
        aerodynamics: (model: QuasiSteady, compressibility: None),
        inflow: (model: FreeWake(azimuths: 12, turns: 2, panels: 10)), actuator: (model: Ideal),
        control: (harmonics: [[4]], actuators: [Ideal]))",
    );
    let mut trims = [
        &["run", "case.ron", "--out", "a"][..],
        &["run", "case.ron", "--wake", "free", "--out", "b"],
    ]
    .map(|args| {
        let ran = place.hhc(args);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let stored = place.read(&format!("{}/result.json", args[args.len() - 1]));
        let stored: serde_json::Value = serde_json::from_str(&stored).unwrap();
        stored["result"]["trim"].clone()
    })
    .into_iter();
    assert_eq!(trims.next(), trims.next());
}

/// Lags of the sections, free wake, T, hysteresis of the flaps and control: the results the same, byte for byte.
#[test]
fn the_number_of_threads_changes_no_byte() {
    let place = Place::new();
    let case = "(structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
        inflow: (model: FreeWake(azimuths: 12, turns: 2, panels: 8, updates: 2)),
        control: (harmonics: [[4]], actuators: [Hysteretic]))";
    place.write("case.ron", case);
    let [one, two, four] = ["1", "2", "4"].map(|threads| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hhc"));
        command.args(["run", "case.ron", "--out", threads]);
        command.env("RAYON_NUM_THREADS", threads).current_dir(place.path());
        assert!(command.output().unwrap().status.success());
        ["result.json", "vortices.csv", "airloads.csv"]
            .map(|file| place.read(&format!("{threads}/{file}")))
    });
    assert_eq!(one, two);
    assert_eq!(one, four);
}

/// A march ends near the periodic wake where there is one, and writes every revolution.
#[test]
fn a_rotor_and_its_wake_are_marched_in_time() {
    let place = Place::new();
    place.write("case.ron", &small_case());
    let args = ["wake", "case.ron", "--mu", "0.25", "--in-time=10", "--settling", "2"];
    let text = place.hhc(&[&args[..], &["--out", "wake"]].concat()).done();
    for part in ["in time at mu 0.250", "10 of 12 revolutions", "12 of the wake, 288 of the blades"]
    {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let rows = place.read("wake/in_time.csv");
    let head = "revolution,measured,theta0_deg,theta1c_deg,theta1s_deg,mean_inflow,fx_mean,";
    assert!(rows.starts_with(head) && !rows.contains("NaN"), "{rows}");
    let count =
        |measured: &str| rows.lines().filter(|r| r.split(',').nth(1) == Some(measured)).count();
    assert_eq!([count("0"), count("1")], [2, 10], "{rows}");
    let found = place.hhc(&[&args[..], &["--format", "json"]].concat()).json();
    let inflow = &found["inflow"][0];
    let [mean, periodic] = ["mean", "periodic"].map(|key| inflow[key].as_f64().unwrap());
    assert!((mean / periodic - 1.0).abs() < 0.05, "{inflow}");
}

#[test]
fn what_is_not_marched_is_refused() {
    let place = Place::new();
    for (wake, part) in [
        ("FreeWake(circulation: Prescribed())", "prescribed circulation"),
        ("FreeWake(symmetry: Axial)", "inflow.model.symmetry"),
    ] {
        let inflow = format!("(model: {wake})");
        let case = QUICK_CASE.replace("(model: Uniform)", &inflow);
        place.write("case.ron", &case.replace("advance_ratio: 0.2", "advance_ratio: 0.0"));
        place.hhc(&["wake", "case.ron", "--in-time"]).rejected(&[part]);
    }
    place.write("case.ron", &small_case());
    place.hhc(&["wake", "case.ron", "--in-time=3"]).rejected(&["--in-time", "10 to"]);
    let stalling = small_case().replace("QuasiSteady,", "QuasiSteady, dynamic_stall: Naca0012,");
    place.write("case.ron", &stalling);
    let refused = place.hhc(&["wake", "case.ron", "--in-time"]);
    refused.rejected(&["dynamic_stall", "not marched"]);
}
