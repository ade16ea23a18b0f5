//! `hhc export` of a case: T over the knots of a flight as JSON, CSV and MAT, its controllers as C.

use crate::place::{Place, QUICK_CASE};
use std::process::Command;

/// Two knots, a step of the thrust, two harmonics at once.
const FLIGHT: &str = "start_advance_ratio: 0.18, end_advance_ratio: 0.20, knots: 2,
        thrust_step: (at_s: 5, ratio: 1.1), harmonics: [2, 3], amplitude_limit_V: 40";

fn flying(more: &str) -> Place {
    let place = Place::new();
    let section = format!("    flight: ({FLIGHT}, {more}),\n    control: (");
    place.write("case.ron", &QUICK_CASE.replace("    control: (", &section));
    place
}

fn array<'a>(json: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    json["arrays"].as_array().unwrap().iter().find(|array| array["name"] == name).unwrap()
}

fn numbers(row: &serde_json::Value) -> Vec<f64> {
    row.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn t_of_every_set_leaves_with_its_conditions() {
    let place = flying("noise_percent: 2");
    let told = place.hhc(&["export", "case.ron", "--to", "json", "-o", "j"]).done();
    assert!(told.contains("rotor.json"), "{told}");
    let json: serde_json::Value = serde_json::from_str(&place.read("j/rotor.json")).unwrap();
    let conditions = array(&json, "conditions");
    // each knot before the step of the thrust and after it
    assert_eq!(numbers(&conditions["values"][0]), [0.18, 0.20, 0.18, 0.20]);
    let ct_sigma = numbers(&conditions["values"][2]);
    assert!(
        (ct_sigma[0] - 0.07).abs() < 1e-6 && (ct_sigma[3] - 0.077).abs() < 1e-6,
        "{ct_sigma:?}"
    );
    let (both, alone) = (array(&json, "T_2_3"), array(&json, "T_3"));
    assert_eq!(both["axes"][0]["labels"][4], "fz_4_per_rev_cos");
    assert_eq!(both["axes"][1]["labels"][2], "flap1_3_per_rev_cos_V");
    let fz = |t: &serde_json::Value, control: usize| numbers(&t["values"][4][control]);
    assert_eq!(fz(both, 2), fz(alone, 0), "a column belongs to its harmonic");
    assert!(fz(both, 2)[0].abs() > 1e-9 && (fz(both, 2)[0] - fz(both, 2)[1]).abs() > 1e-12);
    // T of the export is what `run` puts behind its voltages, of one speed with the ideal actuator
    let still = QUICK_CASE.replace("advance_ratio: 0.2,", "advance_ratio: 0.18,");
    place.write("still.ron", &still);
    place.hhc(&["run", "still.ron", "--out", "r"]).done();
    let run: serde_json::Value = serde_json::from_str(&place.read("r/result.json")).unwrap();
    let columns = find(&run, "t_per_V").unwrap();
    let column = numbers(&columns[0]);
    let own: Vec<f64> = (0..12).map(|load| numbers(&alone["values"][load][0])[0]).collect();
    let size = column.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
    for (own, run) in own.iter().zip(&column) {
        assert!((own - run).abs() < 1e-4 * size, "{own} {run}");
    }
    // without a flight: one point, no noise
    place.hhc(&["export", "still.ron", "--to", "json", "-o", "s"]).done();
    let still: serde_json::Value = serde_json::from_str(&place.read("s/rotor.json")).unwrap();
    assert_eq!(numbers(&array(&still, "conditions")["values"][0]), [0.18]);
    let covariance = |json, at: usize| numbers(&array(json, "covariance_3")["values"][at])[at];
    assert_eq!(covariance(&still, 0).to_bits(), 0);
    // the noise of 2 % in each of two revolutions, nine measurements of Z0, two of each T
    let baseline = array(&json, "baseline");
    let squares: f64 = (0..12).map(|load| numbers(&baseline["values"][load])[0].powi(2)).sum();
    let variance = 4e-4 * squares / 12.0 / 2.0;
    assert!((covariance(&json, 0) / (variance / 9.0) - 1.0).abs() < 1e-9);
    assert!(covariance(&json, 1) > 0.0);
}

/// The first value of a name anywhere in a document.
fn find<'a>(json: &'a serde_json::Value, name: &str) -> Option<&'a serde_json::Value> {
    let inner: Vec<&serde_json::Value> = match json {
        serde_json::Value::Object(fields) => {
            if let Some(found) = fields.get(name) {
                return Some(found);
            }
            fields.values().collect()
        }
        serde_json::Value::Array(items) => items.iter().collect(),
        _ => vec![],
    };
    inner.into_iter().find_map(|value| find(value, name))
}

/// Takes the loads of every cycle and its advance ratio, prints the next control.
const PROGRAM: &str = r#"
#include <stdio.h>
#include "PILOT.h"

int main(void)
{
    PILOT_state s;
    double z[13];
    int k;
    PILOT_start(&s);
    for (;;) {
        for (k = 0; k < 13; ++k) {
            if (scanf("%lf", &z[k]) != 1) return k;
        }
        if (PILOT_cycle(&s, z, z[12]) != 1) return 20;
        for (k = 0; k < 8; ++k) printf("%.17g ", s.control_volt[k]);
    }
}
"#;

/// Without noise the loads that a flight tells are those its controllers measure: the C code gives the voltages of `hhc fly`.
#[test]
fn controllers_of_a_flight_leave_as_c_and_fly_it() {
    let place = flying("noise_percent: 0, ramp_at_s: 1, ramp_s: 6, duration_s: 30");
    let told = place.hhc(&["export", "case.ron", "--to", "c", "--name", "pilot", "-o", "c"]).done();
    let flown = place.hhc(&["fly", "case.ron", "--format", "json"]).json();
    for (index, controller) in ["fixed", "scheduled", "adaptive"].into_iter().enumerate() {
        let name = format!("pilot_{controller}");
        assert!(told.contains(&format!("{name}.c")), "{told}");
        place.write("c/program.c", &PROGRAM.replace("PILOT", &name));
        let strict = ["-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"];
        let mut compiler = Command::new("cc");
        compiler.args(strict).args(["-pedantic", "-o", &name, "program.c", &format!("{name}.c")]);
        let compiled = compiler.arg("-lm").current_dir(place.path().join("c")).output().unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        let points = flown["flown"]["flights"][index]["points"].as_array().unwrap();
        let line = |point: &serde_json::Value| {
            let loads = numbers(&point["loads"]).into_iter().chain(point["advance_ratio"].as_f64());
            loads.map(|value| format!("{value:?}")).collect::<Vec<String>>().join(" ") + "\n"
        };
        place.write("c/in", &points.iter().map(line).collect::<String>());
        let text = Command::new("sh")
            .args(["-c", &format!("./{name} < in")])
            .current_dir(place.path().join("c"))
            .output()
            .unwrap();
        let text = String::from_utf8(text.stdout).unwrap();
        let volts: Vec<f64> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
        assert_eq!(volts.len(), 8 * points.len());
        let (mut off, mut largest) = (0.0_f64, 0.0_f64);
        for (found, point) in volts.chunks(8).zip(&points[1..]) {
            for (found, volt) in found.iter().zip(numbers(&point["control_volt"])) {
                (off, largest) = (off.max((found - volt).abs()), largest.max(volt.abs()));
            }
        }
        assert!(largest > 5.0 && off < 1e-12 * 40.0, "{controller}: {off} of {largest}");
    }
    let header = place.read("c/pilot_scheduled.h");
    assert!(header.contains("2 are measured") && header.contains("FX (N)"), "{header}");
}

#[test]
fn the_rotor_leaves_as_state_space() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let args = ["export", "case.ron", "--to", "json", "--what", "state-space", "-o", "s"];
    assert_eq!(place.hhc(&args).err, "");
    let json: serde_json::Value = serde_json::from_str(&place.read("s/rotor.json")).unwrap();
    let a = array(&json, "A");
    assert_eq!(a["axes"][0]["labels"][4], "flap1_rate");
    // the derivative of a coordinate is its rate
    assert_eq!(numbers(&a["values"][0][4])[7].to_bits(), 1.0_f64.to_bits());
    let together = array(&json, "A_multiblade");
    assert_eq!(together["values"].as_array().unwrap().len(), 4 * 8);
    assert_eq!(array(&json, "B_multiblade")["axes"][1]["labels"][6], "cos1_flap1_angle");
    // lags of the sections are not among its states: that is said
    let lagging = "model: HariharanLeishman, compressibility: LocalMach";
    let lagging = QUICK_CASE.replace("model: QuasiSteady, compressibility: None", lagging);
    place.write("lags.ron", &lagging);
    let args = ["export", "lags.ron", "--to", "json", "--what", "state-space", "-o", "l"];
    let said = place.hhc(&args).err;
    assert!(said.contains("lags.ron:5:") && said.contains("quasi-steady"), "{said}");
}

#[test]
fn tables_and_mat_hold_the_same_and_what_cannot_be_is_refused() {
    let place = flying("noise_percent: 2");
    place.hhc(&["export", "case.ron", "--to", "csv", "-o", "t"]).done();
    let table = place.read("t/rotor_T_2_3.csv");
    assert!(table.starts_with("point,load,unit,flap1_2_per_rev_cos_V,"), "{table:.80}");
    assert_eq!(table.lines().count(), 1 + 12 * 4);
    place.hhc(&["export", "case.ron", "--to", "mat", "-o", "m"]).done();
    assert!(place.listing().iter().any(|name| name == "m/rotor.mat"));
    let before = place.listing();
    let rejected = |args: &[&str], parts: &[&str]| {
        place.hhc(&[&["export", "case.ron", "--to"][..], args].concat()).rejected(parts);
    };
    rejected(&["mat", "-o", "m"], &["m"]);
    rejected(&["python", "-o", "p"], &["case.ron", "json, csv or mat"]);
    rejected(&["c", "--what", "t", "-o", "p"], &["case.ron", "leave it out"]);
    rejected(&["c", "--name", "2 pilots", "-o", "p"], &["case.ron", "2 pilots"]);
    assert_eq!(place.listing(), before, "nothing is written");
    place.write("still.ron", QUICK_CASE);
    place.hhc(&["export", "still.ron", "--to", "c", "-o", "p"]).rejected(&["add `flight: ()`"]);
    place.write("high.ron", &QUICK_CASE.replace("harmonics: [[3]]", "harmonics: [[11]]"));
    place.hhc(&["export", "high.ron", "--to", "csv", "-o", "p"]).rejected(&["11", "1 to 10"]);
}

/// T leaves as JSON and as CSV and comes back: the flight is the same byte for byte; what is not of the case is refused.
#[test]
fn t_handed_back_flies_the_same_flight() {
    let place = flying("noise_percent: 2, duration_s: 12");
    place.hhc(&["export", "case.ron", "--to", "json", "-o", "j"]).done();
    place.hhc(&["export", "case.ron", "--to", "csv", "-o", "c"]).done();
    place.hhc(&["fly", "case.ron", "--out", "own"]).done();
    let case = place.read("case.ron");
    let with = |name: &str, file: &str| {
        let control = format!("    control: (t_file: \"{file}\", ");
        place.write(name, &case.replace("    control: (", &control));
    };
    for (name, file) in [("json", "j/rotor.json"), ("csv", "c/rotor_T_2_3.csv")] {
        with("handed.ron", file);
        place.hhc(&["fly", "handed.ron", "--out", name]).done();
        let flown = place.read(&format!("{name}/flight.csv"));
        assert!(flown == place.read("own/flight.csv"), "{file}");
    }
    // what T was found with otherwise than the case has it is said, and T is flown all the same
    let handed = case.replace("    control: (", "    control: (t_file: \"j/rotor.json\", ");
    let warned = |name: &str, text: &str| {
        place.write(name, text);
        place.hhc(&["fly", name, "--format", "json"]).json()["warnings"].to_string()
    };
    let same = warned("same.ron", &handed);
    assert!(!same.contains("handed in was found"), "{same}");
    let other = handed.replace("amplitude_limit_V: 40", "amplitude_limit_V: 30");
    let other = other.replace("inflow: (model: Uniform)", "inflow: (model: Drees)");
    let other = warned("other.ron", &other);
    for part in ["`amplitude_limit_V` 40, the case has 30", "Inflow: Uniform", "Inflow: Drees"] {
        assert!(other.contains(part), "{part}: {other}");
    }
    // a set that the file does not hold, at the field of the case
    with("handed.ron", "c/rotor_T_2_3.csv");
    let missing = ["handed.ron", "control.t_file", "T of 2+3 per rev, not of 3 per rev"];
    place.hhc(&["run", "handed.ron", "--out", "r"]).failed(2, &missing);
    // no T, no table, no number, another unit: each in words, with its place
    with("handed.ron", "c/rotor_baseline.csv");
    place
        .hhc(&["check", "handed.ron"])
        .rejected(&["rotor_baseline.csv:1", "then a column for each control"]);
    with("handed.ron", "nowhere.json");
    place.hhc(&["check", "handed.ron"]).rejected(&["handed.ron", "control.t_file", "nowhere.json"]);
    let table = place.read("c/rotor_T_2_3.csv");
    for (name, from, to, said) in [
        ("unit.csv", "m0 Omega^2 R^2", "N", "is in `N`, expected `m0 Omega^2 R^2`"),
        ("order.csv", "fx_4_per_rev_cos", "fx_4_per_rev_sine", "the case has `fx_4_per_rev_cos`"),
        ("word.csv", ",m0 Omega^2 R^3,", ",m0 Omega^2 R^3,x", "is no number"),
        ("flap.csv", "flap2_3_per_rev_sin_V", "flap3_3_per_rev_sin_V", "control 8 is `flap3_3"),
    ] {
        place.write(name, &table.replace(from, to));
        with("handed.ron", name);
        place.hhc(&["check", "handed.ron"]).rejected(&[name, said]);
    }
    let whole = place.read("j/rotor.json");
    place.write("broken.json", &whole[..whole.len() / 2]);
    with("handed.ron", "broken.json");
    let said = "expected the JSON of `hhc export --what t`";
    place.hhc(&["check", "handed.ron"]).rejected(&["broken.json:", said]);
}

const WORN: &str = "(kind: Actuator, title: \"worn\", model: (
    law: Linear(gain_deg_per_volt: 0.12, bias_volt: 65),
    range_volt: (-20, 150),
    calibration: (deg_per_um: 0.04, zero_um: 0),
    linkage: [Backlash(width_um: 6)],
))";

#[test]
fn a_named_cause_leaves_as_its_monitor() {
    let place = Place::new();
    place.write("worn.ron", WORN);
    let with = |more: &[&str]| {
        place.hhc(&[&["export", "worn.ron", "--monitor", "Backlash", "-o", "w"], more].concat())
    };
    let told = with(&["--to", "json", "--threshold-deg", "0.02"]).done();
    assert!(told.contains("flap_monitor.json written to w"), "{told}");
    let json: serde_json::Value = serde_json::from_str(&place.read("w/flap_monitor.json")).unwrap();
    assert_eq!((&json["cause"], &json["threshold_deg"]), (&"Backlash".into(), &0.02.into()));
    assert_eq!(json["extended"]["linkage"][0]["kind"], "Backlash");
    std::fs::remove_dir_all(place.path().join("w")).unwrap();
    with(&["--to", "c"]).rejected(&["--threshold-deg"]);
    let told = with(&["--to", "matlab", "--threshold-deg", "0.02"]).done();
    let files = "flap_monitor_base.m, flap_monitor_extended.m, flap_monitor.m written to w";
    assert!(told.contains(files), "{told}");
    std::fs::remove_dir_all(place.path().join("w")).unwrap();
    with(&["--to", "c", "--threshold-deg", "-1"])
        .rejected(&["the threshold is -1, expected a positive"]);
    let long = ["--to", "c", "--threshold-deg", "1", "--memory-s", "1e17"];
    with(&long).rejected(&["the memory of the monitor is 100000000000000000 s, expected at most"]);
    let alone = ["export", "worn.ron", "--to", "c", "-o", "w", "--memory-s", "2"];
    place.hhc(&alone).rejected(&["--monitor"]);
    let rest = ["-o", "w", "--threshold-deg", "1", "--monitor", "Delay"];
    let delayed = |of: [&str; 4]| place.hhc(&[&of[..], &rest].concat());
    delayed(["export", "worn.ron", "--to", "c"])
        .rejected(&["there is no stage `Delay` among those of the actuator: Backlash"]);
    place.write("case.ron", QUICK_CASE);
    delayed(["export", "case.ron", "--to", "json"])
        .rejected(&["`--monitor` watches an actuator and this is a case"]);
    assert_eq!(place.listing(), ["case.ron", "worn.ron"], "nothing is written");
}
