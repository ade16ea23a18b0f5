//! The commands that need no long computation: what they print, write and return.

use crate::place::{Place, QUICK_CASE, write_bench};
use serde_json::Value;

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|i| value[i].as_f64().unwrap_or(f64::NAN))
}

#[track_caller]
fn close(found: f64, expected: f64, relative: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(
        error <= relative,
        "{found} instead of {expected}: {error:.1e} off, allowed {relative:e}"
    );
}

/// Rotating frequencies of the paper's blade: exact values of a clamped, untwisted blade at zero
/// pitch; 20 elements and an axially stiff blade, gyroscopic terms off.
#[test]
fn modes_of_the_table_1_blade() {
    let place = Place::new();
    place.write("case.ron", "(rotor: (ea: 1e6, twist_deg: 0), structure: (elements: 20))");
    let args = ["modes", "case.ron", "--no-gyroscopic", "--format", "json", "--speeds", "0,0.5,1"];
    let json = place.hhc(&args).json();
    close(json["rotor_speed_rad_s"].as_f64().unwrap(), 40.107_666, 1e-7);
    let modes = json["modes"].as_array().unwrap();
    let expected = [
        ("flap", 1.125_789_21),
        ("flap", 3.421_609_80),
        ("flap", 7.667_070_82),
        ("flap", 13.915_885_0),
        ("lag", 0.701_362_786),
        ("lag", 4.299_964_31),
        ("lag", 10.899_359_4),
        ("lag", 20.656_413_3),
        ("torsion", 4.588_073),
        ("torsion", 13.521_86),
    ];
    assert_eq!(modes.len(), expected.len());
    for (mode, (kind, per_rev)) in modes.iter().zip(expected) {
        assert_eq!(mode["kind"], kind);
        close(mode["per_rev"].as_f64().unwrap(), per_rev, 6e-5);
        close(mode["hz"].as_f64().unwrap(), per_rev * 383.0 / 60.0, 6e-5);
    }
    let fan = json["fan"].as_array().unwrap();
    assert_eq!(fan.len(), 3);
    assert!(fan[0]["modes"][0]["per_rev"].is_null(), "no per rev at rest");
    // non-rotating first flap frequency 0.3654 per nominal rev
    close(fan[0]["modes"][0]["hz"].as_f64().unwrap(), 0.3654 * 383.0 / 60.0, 2e-4);
    assert_eq!(fan[2]["modes"], json["modes"]);
}

#[test]
fn modes_without_a_case_are_the_papers() {
    let place = Place::new();
    let text = place.hhc(&["modes"]).done();
    assert!(text.contains("flap 1") && text.contains("torsion 2"), "{text}");
    assert!(text.starts_with("Rotor speed 40.1"), "{text}");
    let with = place.hhc(&["modes", "--format", "json"]).json();
    let without = place.hhc(&["modes", "--no-gyroscopic", "--format", "json"]).json();
    let lag = |json: &Value| json["modes"][4]["per_rev"].as_f64().unwrap();
    assert!((lag(&with) - lag(&without)).abs() > 1e-4, "the Coriolis terms act on the lag mode");
    let pitched = place.hhc(&["modes", "--pitch-deg", "15", "--format", "json"]).json();
    assert!((lag(&pitched) - lag(&with)).abs() > 1e-3, "pitch couples flap and lag");
}

/// Rotation turns the washed-out blade nose up; the fan plot is a table of every mode at every speed.
#[test]
fn modes_are_about_the_deflected_blade_and_the_fan_plot_is_a_table() {
    let place = Place::new();
    let args = ["modes", "--pitch-deg", "8", "--fan", "fan.csv", "--format", "json"];
    let json = place.hhc(&args).json();
    let twist = json["steady_tip"]["twist_deg"].as_f64().unwrap();
    // tension on the twist against the propeller moment of 8 deg
    assert!((0.0..0.2).contains(&twist), "{twist}");
    let flat = place.hhc(&["modes", "--undeformed", "--format", "json"]).json();
    assert!(flat["steady_tip"].is_null());
    let fan = place.read("fan.csv");
    let rows: Vec<Vec<&str>> = fan.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 13 * 10);
    assert_eq!(rows[0][..4], ["rotor_speed_rad_s", "mode", "frequency_hz", "per_rev"]);
    // nominal speed is the eleventh: the modes of the command itself
    let row = rows.iter().skip(1 + 10 * 10).find(|row| row[1] == "torsion 1").unwrap();
    let torsion = &json["modes"][8];
    close(row[2].parse().unwrap(), torsion["hz"].as_f64().unwrap(), 1e-8);
    let shares: f64 = row[4..].iter().map(|share| share.parse::<f64>().unwrap()).sum();
    close(shares, 1.0, 1e-5);
}

/// Exact coefficients of a flapped section, reduced frequency 0.1 (Theodorsen, E = 0.2).
#[test]
fn section_against_exact_theory() {
    let place = Place::new();
    let ask = |model: &str, k: &str, motion: &str| {
        let args = [
            "section",
            "--model",
            model,
            "--mach",
            "0",
            "--reduced-frequency",
            k,
            "--flap-chord",
            "0.2",
            "--motion",
            motion,
            "--format",
            "json",
        ];
        place.hhc(&args).json()
    };
    let json = ask("incompressible", "0.1", "flap");
    let [re, im] = pair(&json["cm"]);
    close(re, -0.639_666, 2e-6);
    close(im, -0.039_431, 2e-5);
    let [re, im] = pair(&json["cn"]);
    let error = (re - 2.889_330).hypot(im + 0.472_757) / 2.889_330_f64.hypot(0.472_757);
    assert!(error < 0.025, "{error}");
    assert!(error > 1e-6, "two lags cannot be exact");
    // steady flap and steady plunge
    for model in ["quasi-steady", "incompressible"] {
        let json = ask(model, "0", "flap");
        close(pair(&json["cn"])[0], 3.454_59, 1e-6);
        close(pair(&json["ch"])[0], -0.036_915, 2e-5);
        close(pair(&ask(model, "0", "plunge")["cn"])[0], std::f64::consts::TAU, 1e-12);
    }
    let text = place.hhc(&["section", "--reduced-frequency", "0.1", "--mach", "0.5"]).done();
    assert!(text.contains("Cn") && text.contains("Ch"), "{text}");
}

#[test]
fn init_check_and_the_refusal_to_overwrite() {
    let place = Place::new();
    place.hhc(&["init"]).done();
    let text = place.read("case.ron");
    assert!(text.matches("//").count() > 40, "every field is commented");
    let checked = place.hhc(&["check", "case.ron", "--format", "json"]).json();
    assert_eq!(checked["kind"], "case");
    place.hhc(&["init"]).rejected(&["case.ron exists already and is not overwritten"]);
    assert_eq!(place.read("case.ron"), text);
    place.hhc(&["init", "deep/other.ron"]).done();
    place.hhc(&["check", "deep/other.ron"]).done();
}

#[test]
fn identify_writes_an_actuator_that_checks_and_can_be_started_from() {
    let place = Place::new();
    write_bench(&place, "bench");
    let json =
        place.hhc(&["identify", "bench", "-o", "out/actuator.ron", "--format", "json"]).json();
    let runs = json["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 4);
    let side =
        |id: &str| runs.iter().find(|r| r["id"] == id).unwrap()["use"].as_str().unwrap().to_owned();
    assert_eq!(
        (side("slow"), side("one_large"), side("five")),
        ("trained".into(), "trained".into(), "held_out".into())
    );
    for run in runs {
        assert!(run["nrmse_percent"].as_f64().unwrap() < 10.0, "{run}");
    }
    // no gain in the data set: the slow loop is made +-10 deg
    close(json["deg_per_um"].as_f64().unwrap(), 10.0 / 200.0, 0.01);
    let checked = place.hhc(&["check", "out/actuator.ron", "--format", "json"]).json();
    assert_eq!(checked["kind"], "actuator");
    let again = ["identify", "bench", "-o", "again.ron", "--start", "out/actuator.ron"];
    let text = place.hhc(&again).done();
    assert!(text.contains("Trained runs") && text.contains("Held-out runs"), "{text}");
    assert_eq!(place.read("again.ron"), place.read("out/actuator.ron"));
    let checked = place.hhc(&["check", "bench", "--format", "json"]).json();
    assert_eq!(checked["kind"], "bench");
}

#[test]
fn run_prints_and_stores_the_same_result() {
    let place = Place::new();
    place.write("cases/quick.ron", QUICK_CASE);
    let json = place.hhc(&["run", "cases/quick.ron", "--format", "json"]).json();
    for key in ["theta0_deg", "theta1c_deg", "theta1s_deg", "alpha_s_deg", "phi_s_deg"] {
        assert!(json["trim"][key].is_f64(), "{key}");
    }
    close(json["trim"]["alpha_s_deg"].as_f64().unwrap(), 3.0, 1e-12);
    for key in ["trim", "periodicity", "inflow"] {
        let residual = json["residuals"][key].as_f64().unwrap();
        assert!((0.0..=1e-8).contains(&residual), "{key} {residual:e}");
    }
    let hub = &json["baseline"]["hub_4_per_rev"];
    for load in ["fx", "fy", "fz", "mx", "my", "mz"] {
        let [c, s] = pair(&hub[load]);
        assert!(c.hypot(s) > 0.0, "{load}");
    }
    let stored: Value = serde_json::from_str(&place.read("out/quick/result.json")).unwrap();
    assert_eq!(stored["result"], json);
    assert_eq!(stored["key"].as_str().unwrap().len(), 64);
    assert_eq!(stored["case"]["rotor"]["blades"], 4);
    assert!(stored["program"].as_str().unwrap().starts_with("hhc "));

    // uniform is this case's inflow anyway; Drees is not
    let same = place.hhc(&["run", "cases/quick.ron", "--inflow", "uniform", "--format", "json"]);
    assert_eq!(same.json(), json);
    let args =
        ["run", "cases/quick.ron", "--inflow", "drees", "--out", "drees", "--format", "json"];
    let drees = place.hhc(&args).json();
    assert_ne!(drees["trim"], json["trim"]);
    let other: Value = serde_json::from_str(&place.read("drees/result.json")).unwrap();
    assert_ne!(other["key"], stored["key"], "the override is part of the case");
    let text = place.hhc(&["run", "cases/quick.ron"]).done();
    assert!(text.contains("Residuals  trim"), "{text}");
}

#[test]
fn help_and_usage() {
    let place = Place::new();
    let text = place.hhc(&["--help"]).done();
    for word in ["run", "identify", "modes", "section", "check", "init", "report", "Exit codes"] {
        assert!(text.contains(word), "{word} in {text}");
    }
    assert!(place.hhc(&["--version"]).done().starts_with("hhc "));
    place.hhc(&["fly"]).rejected(&["fly"]);
    place.hhc(&["report", "."]).rejected(&["study.json: cannot be read"]);
}
