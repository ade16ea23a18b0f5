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

/// Six mean loads in both units, torque and power; in hover the power is that of the air pushed down and profile drag.
#[test]
fn mean_loads_and_power_are_in_every_result() {
    let place = Place::new();
    let hover = QUICK_CASE
        .replace("advance_ratio: 0.2", "advance_ratio: 0.0")
        .replace("shaft_tilt_deg: 3.0", "shaft_tilt_deg: 0.0")
        .replace("harmonics: [[3]]", "harmonics: []");
    place.write("case.ron", &hover);
    let result = place.hhc(&["run", "case.ron", "--format", "json"]).json();
    let mean = &result["mean_loads"];
    let omega = 383.0 * std::f64::consts::TAU / 60.0;
    let force = 6.46 * (omega * 4.94_f64).powi(2);
    let off = |a: f64, b: f64| (a / b - 1.0).abs();
    for k in 0..3 {
        let [f, m] = [&mean["hub_force_N"][k], &mean["hub_moment_N_m"][k]].map(number);
        let [f0, m0] = [&mean["hub"][k], &mean["hub"][3 + k]].map(number);
        assert!((f - f0 * force).abs() <= 1e-9 * force, "{mean}");
        assert!((m - m0 * force * 4.94).abs() <= 1e-9 * force, "{mean}");
    }
    let [torque, power] = [&mean["shaft_torque_N_m"], &mean["shaft_power_W"]].map(number);
    assert!(off(torque, -number(&mean["hub_moment_N_m"][2])) < 1e-12, "{mean}");
    assert!(off(power, torque * omega) < 1e-12, "{mean}");
    // C_Q = lambda C_T + sigma c_d (1 - x0^4) / 8
    let trim = &result["trim"];
    let induced = number(&trim["induced_inflow"]) * number(&trim["ct_sigma"]);
    let expected = induced + 0.01 * (1.0 - 0.2_f64.powi(4)) / 8.0;
    let found = number(&mean["cq_sigma"]);
    assert!(off(found, expected) < 0.02, "{found} {expected}");
    let text = place.hhc(&["run", "case.ron", "--details"]).done();
    assert!(text.contains("Mean       FX, FY, FZ") && text.contains("shaft torque"), "{text}");
    // Linear is no ordering for a power
    let linear = hover.replace("torsion: 1)", "torsion: 1), couplings: Linear");
    place.write("linear.ron", &linear);
    let ran = place.hhc(&["run", "linear.ron", "--details"]);
    assert!(
        ran.err.contains("structure.couplings") && ran.err.contains("torque and power of Linear"),
        "{}",
        ran.err
    );
}

/// Flaps that neither lift nor weigh move no load: the baseline is given with a warning, and is that of a run that asks
/// for no control.
#[test]
fn flaps_without_effect_leave_a_baseline_with_a_warning() {
    let place = Place::new();
    let flap = "(start_r: 0.7, end_r: 0.75, mass_fraction: 0,
                 effectiveness: (lift: 0, moment: 0, hinge: 0))";
    let title = "title: \"quick\",";
    let without = QUICK_CASE.replace(title, &format!("{title} flaps: [{flap}],"));
    assert!(without.contains(flap));
    place.write("without.ron", &without);
    let ran = place.hhc(&["run", "without.ron", "--format", "json"]);
    assert!(
        ran.err.contains("no control moves a weighted load")
            && ran.err.contains("The baseline is given without control"),
        "{}",
        ran.err
    );
    let found = ran.json();
    place.write("asked.ron", &without.replace("harmonics: [[3]]", "harmonics: []"));
    let asked = place.hhc(&["run", "asked.ron", "--format", "json"]).json();
    assert_eq!(found["baseline"], asked["baseline"]);
    assert_eq!(found["control"], asked["control"]);
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
    assert!(err.contains("the mass centre farther forward (rotor.mass_centre_r"), "{err}");
    let (err, stable) = run(0.0);
    assert_eq!(stable["stable"], true);
    assert!(!err.contains("unstable"), "{err}");
}

/// A sweep of advance ratios is the same results as one by one, each in a folder of its own, and a table over them.
#[test]
fn advance_ratios_are_run_one_by_one() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let json =
        place.hhc(&["run", "case.ron", "--mu", "0.1,0.2", "--out", "s", "--format", "json"]).json();
    let rows = json["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    let alone = place.hhc(&["run", "case.ron", "--format", "json"]).json();
    for key in ["theta0_deg", "theta1c_deg", "theta1s_deg"] {
        assert_eq!(rows[1]["result"]["trim"][key], alone["trim"][key], "{key}");
    }
    for (row, mu) in rows.iter().zip(["0.1", "0.2"]) {
        let text = place.read(&format!("s/mu_{mu}/result.json"));
        let stored: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(stored["result"]["trim"], row["result"]["trim"]);
        assert_eq!(stored["case"]["advance_ratio"].to_string(), mu);
    }
    let csv = place.read("s/sweep.csv");
    assert!(csv.lines().count() == 3 && csv.starts_with("case,advance_ratio,failed,theta0_deg,"));
    let text = place.hhc(&["run", "case.ron", "--mu", "0.2,0.1"]).done();
    assert!(text.contains("mu_") || text.contains("0.100"), "{text}");
    place
        .hhc(&["run", "case.ron", "--mu", "0.1,0.6"])
        .rejected(&["--mu", "is 0.6, expected 0 to 0.5"]);
    place.hhc(&["run", "case.ron", "--mu", "0.1,0.1"]).rejected(&["0.1 is given twice"]);
}

/// What is there is not computed again; a folder that is gone, altered or of another case is.
#[test]
fn advance_ratios_go_on_where_they_were() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let run = |mu: &str| place.hhc(&["run", "case.ron", "--mu", mu, "--out", "s"]).done();
    let there = |text: &str, count: usize, of: usize| {
        let said = format!("; {count} of {of} were there");
        assert_eq!(text.contains(&said), count > 0, "{count} of {of}: {text}");
    };
    there(&run("0.1,0.2"), 0, 2);
    let first = place.read("s/mu_0.1/result.json");
    let table = |text: &str| text.split("\nResults in").next().unwrap().to_owned();
    let (more, again) = (run("0.2,0.1,0.15"), run("0.2,0.1,0.15"));
    there(&more, 2, 3);
    there(&again, 3, 3);
    assert_eq!(table(&more), table(&again));
    assert_eq!(place.read("s/sweep.csv").lines().count(), 4);
    for broken in ["", &first[..first.len() / 2], &first.replacen("0.1", "0.2", 1)] {
        place.write("s/mu_0.1/result.json", broken);
        there(&run("0.1,0.2"), 1, 2);
        assert_eq!(place.read("s/mu_0.1/result.json"), first);
    }
    // another case in the same folder, and the first one again
    place.write("case.ron", &QUICK_CASE.replace("ct_sigma: 0.07", "ct_sigma: 0.08"));
    there(&run("0.1,0.2"), 0, 2);
    place.write("case.ron", QUICK_CASE);
    there(&run("0.1"), 0, 1);
    assert_eq!(place.read("s/mu_0.1/result.json"), first);
    // the merged table has a page of its own
    run("0.1,0.15,0.2");
    place.hhc(&["report", "s"]).done();
    assert!(place.read("s/sweep.html").contains("Over one axis"));
    place.hhc(&["report", "s", "--x", "mu"]).rejected(&["mu is no axis (advance_ratio)"]);
    place.hhc(&["report", "s/mu_0.1", "--x", "a"]).rejected(&["has no sweep.json"]);
}

/// An advance ratio that fails is named and stays failed, and the others are found.
#[test]
fn a_sweep_that_fails_names_its_advance_ratio_and_keeps_the_others() {
    let place = Place::new();
    let tables = "compressibility: None, airfoils: [(station_r: 0.2, table: \"shipped:naca0012_synthetic.c81\")]";
    let case = QUICK_CASE
        .replace("compressibility: None", tables)
        .replace("ct_sigma: 0.07", "ct_sigma: 0.14")
        .replace("harmonics: [[3]]", "harmonics: []");
    place.write("case.ron", &case);
    let args = ["run", "case.ron", "--mu", "0.5,0.1", "--out", "s"];
    let parts = ["advance ratio 0.5: case.ron", "Remedy", "the result at 0.1 is stored"];
    let said = place.hhc(&args).failed(1, &parts);
    let rows = place.read("s/sweep.csv");
    assert!(rows.lines().nth(1).unwrap().contains("Remedy"), "{rows}");
    assert_eq!(rows.lines().count(), 3);
    assert!(place.listing().iter().any(|name| name == "s/mu_0.1/result.json"));
    assert!(!place.listing().iter().any(|name| name.starts_with("s/mu_0.5")));
    // it fails the same way from what is stored
    let again = place.hhc(&args);
    assert!(again.out.contains("2 of 2 were there"), "{}", again.out);
    assert_eq!(again.failed(1, &parts), said);
    place.hhc(&["run", "case.ron", "--mu", "0.5", "--out", "t"]).failed(1, &["advance ratio 0.5"]);
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
            let baseline = number(&same["baseline"]["hub_nb_per_rev"][load][k]);
            let apart = number(&rest["per_rev"][3][load][k]) - baseline;
            assert!(apart.abs() < 1e-12, "{load}: {apart:e}");
            assert!(number(&rest["per_rev"][0][load][k]).abs() < 1e-12, "{load}");
        }
    }
    let heavy = with("(blade: 3, mass: 1.01, flap_motion: 0.5)");
    let lines = heavy["unlike_blades"].as_array().unwrap();
    // the mean loads are those of the blades that fly, unlike ones among them
    assert_eq!(heavy["mean_loads"]["hub"], lines[0]["mean"]);
    assert_ne!(heavy["mean_loads"]["hub"], same["mean_loads"]["hub"]);
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

/// Loads along the blade are in the table, the result and a file of their own: at the stations of the case, or at
/// the usual ones.
#[test]
fn loads_along_the_blade_are_given() {
    let place = Place::new();
    let with = |stations: &str| {
        let response = format!("(\n    response: ({stations}time_elements: 6),");
        place.write("case.ron", &QUICK_CASE.replacen('(', &response, 1));
        place.hhc(&["run", "case.ron", "--out", "o", "--format", "json"]).json()
    };
    let usual = with("");
    let stations = |json: &Value| -> Vec<f64> {
        json["blade_loads"].as_array().unwrap().iter().map(|l| number(&l["station_r"])).collect()
    };
    assert_eq!(stations(&usual), [0.0, 0.25, 0.5, 0.75]);
    let json = with("load_stations_r: [0.4, 1], ");
    assert_eq!(stations(&json), [0.4, 1.0]);
    let [inner, tip] = [&json["blade_loads"][0], &json["blade_loads"][1]];
    // m0 Omega^2 R^2 (1 - s^2) / 2, less what bending takes off
    let tension = number(&inner["axial_force_N"]["mean"]);
    let unit = 6.46 * (383.0 * std::f64::consts::TAU / 60.0_f64).powi(2) * 4.94 * 4.94;
    assert!((tension / unit / 0.42 - 1.0).abs() < 0.02, "{tension}");
    for method in ["force_summation", "deflected_statics", "curvature"] {
        assert!(number(&inner["flap_moment_N_m"][method]["peak_to_peak"]) > 1.0, "{method}");
        let at_tip = number(&tip["torsion_N_m"][method]["peak_to_peak"]);
        assert!(method == "curvature" || at_tip == 0.0, "{method}: {at_tip}");
    }
    let text = place.read("o/blade_loads.csv");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header[..3], ["azimuth_deg", "station_r", "axial_force_N"]);
    assert!(header.contains(&"flap_moment_curvature_N_m") && header.len() == 14, "{header:?}");
    assert!(lines.clone().all(|line| line.split(',').count() == 14));
    assert_eq!(lines.count(), 2 * 6 * 8);
    let text = place.hhc(&["run", "case.ron", "--details"]).done();
    assert!(text.contains("0.400 R torsion"), "{text}");
}

/// What can be, but hardly is meant, is said with its place.
#[test]
fn doubtful_values_are_warned_of() {
    let place = Place::new();
    for (text, parts) in [
        ("(rotor: (km1_r: 0.03, km2_r: 0.02))", ["rotor.km1_r", "are the two exchanged"]),
        ("(rotor: (ei_flap: 1e-9))", ["rotor.ei_flap", "a hundredth of the softest blade's"]),
        (
            "(rotor: (tables: (gj: [(0, 0.006), (0.5, 1e-9), (1, 0.006)])))",
            ["rotor.tables.gj[1]", "1e-9 m0 Omega^2 R^4"],
        ),
        (
            "(trim: WindTunnel(ct_sigma: 0.22, shaft_tilt_deg: 5))",
            ["trim.ct_sigma", "mean lift coefficient of 1.16"],
        ),
        (
            "(rotor: (modal_damping: 1e-7, ei_lag: 0.078), trim: Prescribed(theta0_deg: 6.3),
              structure: (modes: (flap: 2, lag: 1, torsion: 1)))",
            [
                "rotor.modal_damping",
                "lag 1 in still air, pitch 6.30 deg, has 1.0075 per rev, near the harmonic 1",
            ],
        ),
    ] {
        place.write("case.ron", text);
        let checked = place.hhc(&["check", "case.ron"]);
        for part in parts {
            let said = checked.err.to_lowercase();
            assert!(said.contains(&part.to_lowercase()), "{text}: {}", checked.err);
        }
        checked.done();
    }
    place.write("case.ron", "(title: \"plain\")");
    let plain = place.hhc(&["check", "case.ron"]);
    assert!(!plain.err.contains("warning"), "{}", plain.err);
}

/// A short case with the ideal actuator needs no list of actuators; thrust beyond stall and next to no damping
/// are warned of in flight too.
#[test]
fn a_short_case_with_the_ideal_actuator_runs() {
    let place = Place::new();
    let rest = "structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
         aerodynamics: (model: QuasiSteady, compressibility: None)";
    place.write(
        "case.ron",
        &format!(
            "(actuator: (model: Ideal), control: (harmonics: []), advance_ratio: 0.2,
            rotor: (modal_damping: 1e-7, ei_lag: 0.078), {rest})"
        ),
    );
    let ran = place.hhc(&["run", "case.ron", "--out", "o", "--format", "json"]);
    assert!(
        ran.err.contains("rotor.modal_damping: lag 1 about the mean deflection in flight"),
        "{}",
        ran.err
    );
    let json = ran.json();
    assert!(json["control"].as_array().unwrap().is_empty());
    let stored: Value = serde_json::from_str(&place.read("o/result.json")).unwrap();
    assert_eq!(stored["case"]["control"]["actuators"].as_array().unwrap().len(), 1);
    place.write(
        "case.ron",
        &format!(
            "(actuator: (model: Ideal), flaps: [], control: (harmonics: []), advance_ratio: 0.2,
            trim: Prescribed(theta0_deg: 16, theta1s_deg: -4), {rest})"
        ),
    );
    let ran = place.hhc(&["run", "case.ron", "--format", "json"]);
    assert!(ran.err.contains("trim.theta0_deg: C_T/sigma"), "{}", ran.err);
    ran.json();
}

/// Each unlike blade has its stability and its loads; an unstable one is named.
#[test]
fn every_unlike_blade_has_its_stability_and_loads() {
    let place = Place::new();
    let text = "(title: \"unlike\", advance_ratio: 0.1, flaps: [],
         rotor: (mass_centre_r: -0.012, gj: 0.0009, modal_damping: 0, unlike_blades: [(blade: 3, gj: 0.5)]),
         structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1), couplings: Moderate),
         aerodynamics: (model: QuasiSteady, compressibility: None),
         inflow: (model: Prescribed(lambda_i: 0.02)), trim: Prescribed(theta0_deg: 3),
         actuator: (model: Ideal), control: (harmonics: [], actuators: [Ideal]))";
    place.write("unlike.ron", text);
    let ran = place.hhc(&["run", "unlike.ron", "--format", "json"]);
    let err = ran.err.clone();
    let json = ran.json();
    let each = json["each_unlike_blade"].as_array().unwrap();
    assert_eq!((each.len(), &each[0]["blade"]), (1, &Value::from(3)));
    assert_eq!(each[0]["stability"]["stable"], false);
    let torsion = |loads: &Value| number(&loads[0]["torsion_N_m"]["force_summation"]["mean"]);
    let (alike, unlike) = (torsion(&json["blade_loads"]), torsion(&each[0]["blade_loads"]));
    assert!((alike - unlike).abs() > 1e-3 * alike.abs(), "{alike} {unlike}");
    assert!(err.contains("blade 3, unlike the rest, is unstable"), "{err}");
    let text = place.hhc(&["run", "unlike.ron", "--details"]).done();
    assert!(text.contains("Moments of each like blade"), "{text}");
    assert!(text.contains("Moments of blade 3, dissimilar"), "{text}");
}

/// The reductions are of blades alike; what those of the case leave of them stands beside the table.
#[test]
fn the_screen_tells_what_dissimilar_blades_leave() {
    let place = Place::new();
    let unlike = "rotor: (dissimilar_blades: [(blade: 3, flap_motion: 0.0)]),\n    structure:";
    place.write("alike.ron", QUICK_CASE);
    place.write("unlike.ron", &QUICK_CASE.replacen("structure:", unlike, 1));
    let screen = |case: &str| {
        let text = place.hhc(&["run", case, "--out", "out"]).done();
        text.split_whitespace().collect::<Vec<&str>>().join(" ")
    };
    let told = "With the dissimilar blades of the case J falls by, percent";
    assert!(!screen("alike.ron").contains(told));
    let text = screen("unlike.ron");
    let json = place.hhc(&["report", "out", "--format", "json"]).json();
    let own = number(&json["unlike_blades"][1]["cost_ratio"]);
    let falls = format!("{:.1} (", 100.0 * (1.0 - own));
    assert!(text.contains(told) && text.contains(&falls), "{falls} {text}");
    assert!(
        (own - number(&json["control"][0]["j_after"]) / number(&json["control"][0]["j_before"]))
            .abs()
            > 0.01
    );
}

/// What a run doubts or refuses, each with its field.
#[test]
fn doubts_and_refusals_name_their_field() {
    let place = Place::new();
    let run = |name: &str, parts: &str| {
        let text = format!("(control: (harmonics: []), actuator: (model: Ideal), {parts})");
        place.write(name, &text);
        place.hhc(&["run", name]).err
    };
    let near = run("near.ron", "trim: Propulsive(ct_sigma: 0.12)");
    assert!(near.contains("aerodynamics: the section at") && near.contains("azimuth"), "{near}");
    let beyond = run("beyond.ron", "advance_ratio: 0, trim: Prescribed(theta0_deg: 25)");
    assert!(beyond.contains("trim.theta0_deg") && beyond.contains("stall near 1.5"), "{beyond}");
    let stretch = run("stretch.ron", "rotor: (ea: 50)");
    assert!(stretch.contains("rotor.ea: Linear and Full know no stretch"), "{stretch}");
    let link = "structure: (couplings: Moderate), rotor: (root: (pitch: Spring(stiffness: 0.001)))";
    let soft = run("soft.ron", link);
    assert!(soft.contains("rotor.root.pitch.stiffness: a pitch spring of 0.001"), "{soft}");
    let central = "rotor: (root: (flap: Free)), trim: WindTunnel(ct_sigma: 0.07)";
    let tunnel = run("tunnel.ron", central);
    assert!(tunnel.contains("trim: a free flap hinge at the rotor centre"), "{tunnel}");
    let check = |cg_below_hub_r: f64| {
        let flown = format!(
            "(rotor: (root: (flap: Free)), trim: Propulsive(cg_below_hub_r: {cg_below_hub_r}))"
        );
        place.write("level.ron", &flown);
        let ran = place.hhc(&["check", "level.ron"]);
        [ran.out, ran.err].concat()
    };
    let level = check(0.001);
    assert!(level.contains("trim.cg_below_hub_r: a free flap hinge at the rotor"), "{level}");
    assert!(!check(0.2).contains("a free flap hinge"));
}

/// What a check doubts or refuses of blade, flight and wake, each with its field and what else may have been meant.
#[test]
fn values_of_another_unit_and_blades_near_divergence_are_doubted() {
    let place = Place::new();
    let said = |parts: &str| {
        place.write("doubt.ron", &format!("({parts})"));
        let ran = place.hhc(&["check", "doubt.ron"]);
        [ran.out, ran.err].concat()
    };
    for (parts, expected) in [
        ("rotor: (ei_flap: 5)", "rotor.ei_flap: the stiffness 5e0 m0 Omega^2 R^4 is more than 2"),
        ("rotor: (ei_flap: 2e6)", "over m0 Omega^2 R^4, not in N m^2 (paper: 0.0108)"),
        (
            "rotor: (tables: (mass: [(0, 7), (1, 5.92)]))",
            "rotor.tables.mass: the mean of the table is 6.460 of mass_kg_m",
        ),
        ("rotor: (chord_r: 0.27)", "rotor.chord_r: the chord is 0.27 R, a blade's is 0.03 to 0.12"),
        (
            "rotor: (tables: (km2_r: [(0, 0.122), (1, 0.122)]))",
            "rotor.tables.km2_r: the radius of gyration 0.122 R is more than the chord",
        ),
        (
            "rotor: (gj: 0.0012, aerodynamic_centre_r: 0.006)",
            "rotor.aerodynamic_centre_r: the lift, 0.006 R ahead of the elastic axis, takes 0.8",
        ),
        (
            "rotor: (gj: 0.0008, aerodynamic_centre_r: 0.006)",
            "more than all: it diverges in torsion",
        ),
        (
            "rotor: (mass_centre_r: 0.03), structure: (couplings: Moderate)",
            "rotor.mass_centre_r: is refused: 0.03 R is farther from the elastic axis than rotor.km2_r, 0.0247 R",
        ),
        (
            "rotor: (mass_centre_r: -0.01, tables: (km2_r: [(0, 0.02), (1, 0.008)])), structure: (couplings: Moderate)",
            "rotor.mass_centre_r: is refused: -0.01 R is farther from the elastic axis than rotor.tables.km2_r, 0.008 R",
        ),
        ("rotor: (omega_rpm: 0.001)", "rotor.omega_rpm: is refused: the tip moves at"),
        (
            "advance_ratio: 0.5, trim: Propulsive(drag_area: 0.05)",
            "trim.drag_area: the drag at this advance ratio is 1.2",
        ),
        (
            "inflow: (model: FreeWake(near_wake: BladePlane))",
            "inflow.model.near_wake: a near wake of 360 deg held in the plane of its blade",
        ),
        (
            "advance_ratio: 0.2, inflow: (model: FreeWake(near_wake_deg: 60))",
            "inflow.model.near_wake_deg: a near wake of 60 deg is rolled up before the next blade",
        ),
        (
            "inflow: (model: FreeWake(azimuths: 72))",
            "inflow.model.azimuths: 72 steps per revolution are more than three quarters of the 64 points",
        ),
    ] {
        let text = said(parts);
        assert!(text.contains(expected), "{parts}: {text}");
    }
    for fine in [
        "",
        "flaps: [(start_r: 0.7, end_r: 0.8, mass: AddedToBlade)], rotor: (tables: (mass: [(0, 1.2), (1, 0.8)]))",
    ] {
        assert!(!said(fine).contains("warning"), "{fine}");
    }
    // modes are of a blade that is doubted as much
    place.write("stiff.ron", "(rotor: (ei_flap: 66800))");
    assert!(place.hhc(&["modes", "stiff.ron"]).err.is_empty());
    let modes = place.hhc(&["modes", "stiff.ron"]).done();
    assert!(modes.contains("rotor.ei_flap: the stiffness 6.68e4"), "{modes}");
}

/// Modes about the deflected blade keep the terms of torsion that the case keeps: without tension on the built-in twist
/// the paper's blade is not untwisted.
#[test]
fn modes_know_the_torsion_terms_of_the_case() {
    let place = Place::new();
    let twist = |structure: &str| {
        place.write("torsion.ron", &format!("(structure: (couplings: Moderate{structure}))"));
        let json = place.hhc(&["modes", "torsion.ron", "--format", "json"]).json();
        number(&json["steady_tip"]["twist_deg"])
    };
    let (included, neglected) = (twist(""), twist(", untwist: Neglected"));
    assert!(included > 0.25, "{included}");
    assert!(neglected < 0.0 && neglected > -0.05, "{neglected}");
}

/// A folder that cannot be written to is found before anything is computed, and a run that fails says whose results are
/// in its folder.
#[test]
fn places_of_results_are_looked_at_first() {
    let place = Place::new();
    place.write("file", "");
    for args in [["run", "case.ron"], ["wake", "case.ron"]] {
        place.write("case.ron", QUICK_CASE);
        let ran = place.hhc(&[args[0], args[1], "--out", "file/below"]);
        assert_eq!(ran.code, 2);
        assert!(ran.err.contains("file/below cannot be written"), "{}", ran.err);
    }
    place.hhc(&["run", "case.ron", "--out", "o"]).done();
    let lost = QUICK_CASE.replace("ct_sigma: 0.07", "ct_sigma: 0.4");
    assert_ne!(lost, QUICK_CASE);
    place.write("case.ron", &lost);
    let ran = place.hhc(&["run", "case.ron", "--out", "o"]);
    assert_ne!(ran.code, 0);
    assert!(ran.err.contains("note: the results in o are of an earlier run"), "{}", ran.err);
}

/// A tunnel trim meets the hub moments that its case gives in N m, and says so in the mean loads.
#[test]
fn a_tunnel_trim_to_given_hub_moments() {
    let place = Place::new();
    let given = "shaft_tilt_deg: 3.0, hub_mx_n_m: 150, hub_my_n_m: -250";
    let case = QUICK_CASE.replace("shaft_tilt_deg: 3.0", given);
    assert_ne!(case, QUICK_CASE);
    place.write("given.ron", &case);
    let json = place.hhc(&["run", "given.ron", "--format", "json"]).json();
    let moments = &json["mean_loads"]["hub_moment_N_m"];
    let [mx, my] = [0, 1].map(|k| moments[k].as_f64().unwrap());
    assert!((mx - 150.0).abs() < 1e-2 && (my + 250.0).abs() < 1e-2, "{moments}");
}

/// The tables of airloads and of the tip have their fixed columns, a row a degree and station, and the numbers of the run:
/// the mean twist of the tip is nose down, and the section at 0.75 R carries the lift of the rotor.
#[test]
fn airloads_and_tip_motion_are_tables() {
    let place = Place::new();
    place.write("quick.ron", QUICK_CASE);
    place.hhc(&["run", "quick.ron", "--out", "out"]).done();
    let text = place.read("out/airloads.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("station_r,azimuth_deg,cn_m2,cm_m2,cc_m2,cn,mach"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    // 0.25, 0.5 and 0.75 R lift, the root does not
    assert_eq!(rows.len(), 3 * 360);
    let outer: Vec<&Vec<f64>> = rows.iter().filter(|row| (row[0] - 0.75).abs() < 1e-12).collect();
    let advancing = outer.iter().find(|row| (row[1] - 90.0).abs() < 1e-9).unwrap();
    let retreating = outer.iter().find(|row| (row[1] - 270.0).abs() < 1e-9).unwrap();
    let tip_mach = (advancing[6] + retreating[6]) / 1.5;
    assert!((advancing[6] - retreating[6] - 0.4 * tip_mach).abs() < 0.01 * tip_mach);
    assert!((advancing[2] / (advancing[6] * advancing[6]) - advancing[5]).abs() < 1e-12);
    let mean = outer.iter().map(|row| row[2]).sum::<f64>() / 360.0;
    // C_T/sigma 0.07 is a mean C_l of 0.42: over the square of 0.75 of the tip Mach number about half of that
    assert!((0.15..0.35).contains(&(mean / (tip_mach * tip_mach))), "{mean} {tip_mach}");

    let text = place.read("out/tip.csv");
    let mut lines = text.lines();
    let header = "azimuth_deg,flap_percent_r,lag_percent_r,elastic_twist_deg";
    assert_eq!(lines.next(), Some(header));
    assert_eq!(lines.count(), 360);
}

#[test]
fn flaps_and_root_pitch_side_by_side() {
    let place = Place::new();
    place.write("case.ron", "(control: (harmonics: [[3]]))");
    let text = place.hhc(&["root-pitch", "case.ron"]).done();
    assert!(text.starts_with("3/rev: J falls by"), "{text}");
    for part in ["amplitude at 3/rev, deg", "no control", "torsion at the root, half p-p, N m"] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let json = place.hhc(&["root-pitch", "case.ron", "--format", "json"]).json();
    let set = &json["sets"][0];
    let j = |state: &str| set[state]["j_z"].as_f64().unwrap();
    let fall = j("no_control") - j("root_pitch");
    assert!((j("flaps") - j("root_pitch")).abs() < 2e-5 * fall, "{set}");
    assert_eq!(set["flaps"]["motions"].as_array().unwrap().len(), 2);
    place.write(
        "swashplate.ron",
        "(rotor: (root_pitch_by: Swashplate), control: (harmonics: [[2]]))",
    );
    place
        .hhc(&["root-pitch", "swashplate.ron"])
        .rejected(&["control.harmonics", "gives 3 to 5 per rev"]);
}
