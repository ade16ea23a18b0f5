//! The rotor in detail: stability of every result, advance ratios, blades unlike each other.

use crate::place::{Place, QUICK_CASE};
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn amplitude(value: &Value) -> f64 {
    number(&value[0]).hypot(number(&value[1]))
}

#[test]
fn every_result_says_whether_the_blade_is_stable() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let json = place.hhc(&["run", "case.ron", "--format", "json"]).json();
    let stability = &json["stability"];
    assert_eq!(stability["stable"], true);
    assert_eq!(stability["motions"].as_array().unwrap().len(), 4);
    let least = &stability["least_damped"];
    assert!(number(&least["damping_ratio"]) > 0.0 && number(&least["frequency_per_rev"]) > 0.0);
    assert!(amplitude(&least["multiplier"]) < 1.0, "{least}");
    let text = place.hhc(&["run", "case.ron"]).done();
    assert!(text.contains("Stability  stable, least damped"), "{text}");
}

/// A blade soft in torsion with its mass behind the elastic axis diverges in pitch; the same with its mass on
/// the axis does not.
#[test]
fn an_unstable_blade_is_warned_of() {
    let place = Place::new();
    let run = |mass_centre_r: f64| {
        let text = format!(
            "(title: \"soft\", advance_ratio: 0.1, flaps: [],
             rotor: (mass_centre_r: {mass_centre_r}, gj: 0.0005, modal_damping: 0),
             structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1), couplings: Moderate),
             aerodynamics: (model: QuasiSteady, compressibility: None),
             inflow: (model: Prescribed(lambda_i: 0.02)), trim: Prescribed(theta0_deg: 3),
             actuator: (model: Ideal), control: (harmonics: [], actuators: [Ideal]))"
        );
        place.write("soft.ron", &text);
        let ran = place.hhc(&["run", "soft.ron", "--format", "json"]);
        (ran.err.clone(), ran.json()["stability"].clone())
    };
    let (err, unstable) = run(-0.012);
    assert_eq!(unstable["stable"], false);
    assert!(number(&unstable["least_damped"]["damping_ratio"]) < 0.0, "{unstable}");
    assert!(err.contains("warning: the trimmed blade is unstable"), "{err}");
    let (err, stable) = run(0.0);
    assert_eq!(stable["stable"], true);
    assert!(!err.contains("unstable"), "{err}");
}

/// A sweep is the same trims as one by one, each in a folder of its own, and a table over them.
#[test]
fn advance_ratios_are_run_one_from_the_other() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let json =
        place.hhc(&["run", "case.ron", "--mu", "0.1,0.2", "--out", "s", "--format", "json"]).json();
    let rows = json["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    let alone = place.hhc(&["run", "case.ron", "--format", "json"]).json();
    for key in ["theta0_deg", "theta1c_deg", "theta1s_deg"] {
        let (swept, alone) = (number(&rows[1]["result"]["trim"][key]), number(&alone["trim"][key]));
        assert!((swept - alone).abs() < 1e-6, "{key}: {swept} {alone}");
    }
    for (row, mu) in rows.iter().zip(["0.1", "0.2"]) {
        let text = place.read(&format!("s/mu_{mu}/result.json"));
        let stored: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(stored["result"], row["result"]);
        assert_eq!(stored["case"]["advance_ratio"].to_string(), mu);
    }
    assert_eq!(place.read("s/sweep.csv").lines().count(), 3);
    let text = place.hhc(&["run", "case.ron", "--mu", "0.2,0.1"]).done();
    assert!(text.contains("mu_") || text.contains("0.100"), "{text}");
    place
        .hhc(&["run", "case.ron", "--mu", "0.1,0.6"])
        .rejected(&["--mu", "is 0.6, expected 0 to 0.5"]);
    place.hhc(&["run", "case.ron", "--mu", "0.1,0.1"]).rejected(&["0.1 is given twice"]);
}

/// Blades that are called unlike and are not change nothing; a heavy one shakes the hub once per revolution.
#[test]
fn unlike_blades_shake_the_hub_at_every_harmonic() {
    let place = Place::new();
    let with = |unlike: &str| {
        let rotor = format!("(\n    rotor: (unlike_blades: [{unlike}]),");
        place.write("case.ron", &QUICK_CASE.replacen('(', &rotor, 1));
        place.hhc(&["run", "case.ron", "--format", "json"]).json()
    };
    let same = with("(blade: 2)");
    let rest = &same["unlike_blades"][0];
    assert_eq!(rest["flaps"], "rest");
    for load in ["fx", "fy", "fz", "mx", "my", "mz"] {
        for k in 0..2 {
            let baseline = number(&same["baseline"]["hub_4_per_rev"][load][k]);
            let apart = number(&rest["per_rev"][3][load][k]) - baseline;
            assert!(apart.abs() < 1e-12, "{load}: {apart:e}");
            assert!(number(&rest["per_rev"][0][load][k]).abs() < 1e-12, "{load}");
        }
    }
    let heavy = with("(blade: 3, mass: 1.01, flap_motion: 0.5)");
    let lines = heavy["unlike_blades"].as_array().unwrap();
    assert_eq!(lines.len(), 2, "at rest and under control");
    // the centrifugal force of 1 % of a blade, Delta m / 2, and what its motion adds
    let once = amplitude(&lines[0]["per_rev"][0]["fx"]);
    assert!((once / 0.005 - 1.0).abs() < 0.1, "{once}");
    assert!(amplitude(&lines[1]["per_rev"][1]["fz"]) > 1e-8);
}

/// Gravity: the trim's weight is the helicopter's, so the thrust stays; the blades droop.
#[test]
fn gravity_and_root_are_fields_of_the_case() {
    let place = Place::new();
    let run = |rotor: &str| {
        let text = format!("(\n    rotor: ({rotor}),");
        place.write("case.ron", &QUICK_CASE.replacen('(', &text, 1));
        place.hhc(&["run", "case.ron", "--format", "json"]).json()
    };
    let (off, on) = (run(""), run("gravity: On"));
    let [a, b] = [&off, &on].map(|json| number(&json["trim"]["ct_sigma"]));
    assert!((a - b).abs() < 1e-8, "{a} {b}");
    assert_ne!(off["baseline"], on["baseline"]);
    let hinged = run("root_offset_r: 0.04, root: (flap: Free, lag: Spring(stiffness: 0.02))");
    let json = |args: &[&str]| place.hhc(args).json();
    let modes = json(&["modes", "case.ron", "--format", "json"]);
    // a hinge at 4 % of the radius: nu^2 = 1 + 1.5 e / (1 - e)
    let flap = number(&modes["modes"][0]["per_rev"]);
    assert!((flap - (1.0_f64 + 1.5 * 0.04 / 0.96).sqrt()).abs() < 5e-3, "{flap}");
    assert_eq!(hinged["stability"]["stable"], true);
}
