//! `hhc sweep`: from the file to one table, in parts, killed, without space.

use crate::place::{Place, QUICK_CASE};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Two axes of two values; in one case the flap ends before it begins.
const SWEEP: &str = "(base: \"case.ron\", axes: [
    (field: \"rotor.gj\", values: [0.005, 0.007]),
    (field: \"flaps[1].start_r\", values: [0.8, 0.83]),
    (field: \"flaps[1].end_r\", values: [0.82, 0.85]),
])
";

fn swept(text: &str) -> Place {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    place.write("sweep.ron", text);
    place
}

/// Values of `RAYON_NUM_THREADS`, of shards: the same bytes; the columns say what they are in which unit.
#[test]
fn any_parts_merge_to_the_same_bytes() {
    let place = swept(SWEEP);
    let said = place.hhc(&["sweep", "plan", "sweep.ron"]).done();
    assert!(said.contains("8 cases, 8 of them different; in 2 the values do not go"), "{said}");
    let said = place.hhc(&["sweep", "run", "sweep.ron", "--out", "a"]).done();
    assert!(said.contains("8 cases: 0 were there, 8 computed; 2 failed"), "{said}");
    assert!(said.contains("flaps[1].end_r"), "the reason is told: {said}");
    let merged =
        place.hhc(&["sweep", "merge", "sweep.ron", "--out", "a", "--format", "json"]).json();
    assert_eq!(merged["cases"].as_array().map(Vec::len), Some(8));
    for (shard, threads) in [("2/3", "1"), ("3/3", "2"), ("1/3", "4")] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hhc"));
        command.args(["sweep", "run", "sweep.ron", "--out", "b", "--shard", shard]);
        command.env("RAYON_NUM_THREADS", threads).current_dir(place.path());
        assert!(command.output().unwrap().status.success());
    }
    place.hhc(&["sweep", "merge", "sweep.ron", "--out", "b"]).done();
    for file in ["sweep.csv", "sweep.json"] {
        assert_eq!(place.read(&format!("a/{file}")), place.read(&format!("b/{file}")), "{file}");
    }
    let csv = place.read("a/sweep.csv");
    let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    for name in [
        "rotor.gj [m0 Omega^2 R^4]",
        "flaps[1].start_r",
        "theta0_deg",
        "fz_mean_N",
        "mz_mean_N_m",
        "trim_residual",
        "shaft_power_W",
        "fz_nb_per_rev_N",
        "mx_nb_per_rev_N_m",
        "ideal_3_per_rev_reduction_percent",
        "ideal_3_per_rev_actuation_power_W",
        "ideal_3_per_rev_outboard_flap_amplitude_deg",
    ] {
        assert!(header.contains(&name), "{name} in {header:?}");
    }
    place.hhc(&["sweep", "report", "sweep.ron", "--out", "a", "--at", "rotor.gj=0.007"]).done();
    let page = place.read("a/sweep.html");
    for part in [
        "3 cases with numbers, 5 others of the 8",
        "parcoords",
        "Failed cases",
        "ideal_3_per_rev_outboard_flap_amplitude_deg",
        "fz_nb_per_rev_N",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let args = ["sweep", "report", "sweep.ron", "--out", "a", "--of", "j"];
    place.hhc(&args).rejected(&["j is no axis (rotor.gj, "]);
    // a grid has a carpet; the merged table alone does for the page
    place.hhc(&["report", "a", "--at", "flaps[1].start_r=0.8", "--of", "fz_mean_N"]).done();
    let page = place.read("a/sweep.html");
    let carpet = "Lines of one rotor.gj [m0 Omega^2 R^4] and of one flaps[1].end_r";
    assert!(page.contains(carpet) && page.contains("contour"));
    // a number of the table is that of the case on its own
    place.write("one.ron", &QUICK_CASE.replace(
        "inflow:",
        "rotor: (gj: 0.007), flaps: [(start_r: 0.7, end_r: 0.75), (start_r: 0.83, end_r: 0.85)], inflow:",
    ));
    let one = place.hhc(&["run", "one.ron", "--format", "json"]).json();
    let table: serde_json::Value = serde_json::from_str(&place.read("a/sweep.json")).unwrap();
    let last = &table["cases"][7];
    assert_eq!(last["values"]["rotor.gj"], 0.007);
    assert_eq!(last["found"]["theta0_deg"], one["trim"]["theta0_deg"]);
    let reduction = &one["control"][0]["reduction_percent"];
    assert_eq!(&last["found"]["ideal_3_per_rev_reduction_percent"], reduction);
}

/// A result has the same bytes wherever its folder lies and however the path was typed, though what it warns of names a file.
#[test]
fn a_result_does_not_know_how_its_path_was_typed() {
    let place =
        swept("(base: \"case.ron\", axes: [(field: \"rotor.gj\", values: [0.005, 0.007])])");
    place.write(
        "act.ron",
        "(kind: Actuator, title: \"by hand\", gain: Some(Assumed), model: (
            law: Linear(gain_deg_per_volt: 0.118, bias_volt: 65), range_volt: (-20, 150),
            calibration: (deg_per_um: 1, zero_um: 0)))",
    );
    place
        .write("case.ron", &QUICK_CASE.replace("model: Ideal)", "model: File(path: \"act.ron\"))"));
    let typed = place.path().join("sweep.ron");
    for (file, out) in [("sweep.ron", "here"), (typed.to_str().unwrap(), "there")] {
        place.hhc(&["sweep", "run", file, "--out", out]).done();
        place.hhc(&["sweep", "merge", file, "--out", out]).done();
    }
    let [here, there] = ["here", "there"].map(|out| place.read(&format!("{out}/sweep.json")));
    assert!(here.contains("\"act.ron:3:"), "nothing warns of the file: {here}");
    assert_eq!(here, there);
}

#[test]
fn what_is_wrong_is_told_before_anything_runs() {
    for (axes, parts) in [
        (
            "(field: \"rotor.gk\", values: [1])",
            vec!["sweep.ron:2:", "axes[0].field", "did you mean `gj`?"],
        ),
        (
            "(field: \"rotor.gj\", values: [0.005, -1])",
            vec!["axes[0].values[1]", "-1 for rotor.gj", "positive"],
        ),
        (
            "(field: \"advance_ratio\", values: [0.9])",
            vec!["axes[0].values[0]", "expected 0 to 0.5"],
        ),
        ("(field: \"inflow.model\", values: [Dress])", vec!["unknown choice `Dress`", "Drees"]),
        ("(field: \"rotor.gj\", from: 1, to: 2)", vec!["axes[0].count", "give count: 5"]),
    ] {
        let place = swept(&format!("(base: \"case.ron\", axes: [\n{axes}])"));
        for action in ["plan", "run", "status", "merge"] {
            place.hhc(&["sweep", action, "sweep.ron"]).rejected(&parts);
        }
        assert_eq!(place.listing(), ["case.ron", "sweep.ron"], "nothing is written");
    }
    let place = swept(SWEEP);
    place.hhc(&["sweep", "run", "sweep.ron", "--shard", "9/8"]).rejected(&["1/n to n/n"]);
    place.write("lost.ron", &SWEEP.replace("case.ron", "lost_case.ron"));
    place.hhc(&["sweep", "plan", "lost.ron"]).rejected(&["lost.ron:1:", "base", "lost_case.ron"]);
    place.hhc(&["sweep", "merge", "sweep.ron"]).failed(3, &["cases without a result: 8"]);
}

/// Comments and order leave the keys alone; a file that the case names is part of them.
#[test]
fn keys_follow_the_files_that_a_case_names() {
    let place = swept("(base: \"case.ron\", axes: [(field: \"rotor.gj\", values: [0.006])])");
    let key = || {
        let plan = place.hhc(&["sweep", "plan", "sweep.ron", "--format", "json"]).json();
        plan["cases"][0]["key"].as_str().unwrap().to_owned()
    };
    let base = key();
    place.write(
        "case.ron",
        &QUICK_CASE.replace("advance_ratio: 0.2,", "// slow\nadvance_ratio: 0.20,"),
    );
    assert_eq!(key(), base);
    let table = include_str!("../../../../fixtures/airfoils/naca0012_synthetic.c81");
    place.write("foil.c81", table);
    let foil = "aerodynamics: (airfoils: [(station_r: 0.5, table: \"foil.c81\")], ";
    place.write("case.ron", &QUICK_CASE.replace("aerodynamics: (", foil));
    let with_table = key();
    assert_ne!(with_table, base);
    place.write("foil.c81", &table.replacen('\n', " \n", 1));
    assert_ne!(key(), with_table);
}

/// What a case computes follows from its actuator; an axis of actuators is not bound to what follows from that of the base.
#[test]
fn an_axis_of_actuators_brings_what_follows_from_them() {
    let keys = |case: &str, axis: &str| -> Vec<String> {
        let place = swept(&format!("(base: \"case.ron\", axes: [{axis}])"));
        place.write("case.ron", case);
        let plan = place.hhc(&["sweep", "plan", "sweep.ron", "--format", "json"]).json();
        let cases = plan["cases"].as_array().unwrap().clone();
        assert!(cases.iter().all(|case| case["refused"].is_null()), "{cases:?}");
        cases.iter().map(|case| case["key"].as_str().unwrap().to_owned()).collect()
    };
    let bench = "Bench(dataset: \"shipped:apa500l_synthetic\")";
    let of = |model: &str| {
        let case = QUICK_CASE.replace(", actuators: [Ideal]", "");
        case.replace("model: Ideal", &format!("model: {model}"))
    };
    let axis = format!("(field: \"actuator.model\", values: [Ideal, {bench}])");
    let one = "(field: \"advance_ratio\", values: [0.2])";
    let alone = [keys(&of("Ideal"), one), keys(&of(bench), one)].concat();
    assert_ne!(alone[0], alone[1]);
    for base in ["Ideal", bench] {
        assert_eq!(keys(&of(base), &axis), alone, "{base}");
    }
}

/// Whatever the moment of a kill, whole results stay, and the next run computes what is missing and no more.
#[cfg(unix)]
#[test]
fn a_killed_sweep_loses_the_case_in_progress() {
    let values: Vec<String> = (0..24).map(|i| format!("{}", 0.005 + 1e-4 * f64::from(i))).collect();
    let text = format!(
        "(base: \"case.ron\", axes: [(field: \"rotor.gj\", values: [{}])])",
        values.join(", ")
    );
    let place = swept(&text);
    place.hhc(&["sweep", "run", "sweep.ron", "--out", "whole"]).done();
    place.hhc(&["sweep", "merge", "sweep.ron", "--out", "whole"]).done();
    let found = || {
        let status =
            place.hhc(&["sweep", "status", "sweep.ron", "--out", "out", "--format", "json"]).json();
        assert_eq!(status["damaged"].as_array().unwrap().len(), 0, "{status}");
        assert_eq!(status["foreign"].as_array().unwrap().len(), 0, "{status}");
        status["found"].as_u64().unwrap()
    };
    let mut before = 0;
    for kill in 0..6_u64 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hhc"));
        command.args(["sweep", "run", "sweep.ron", "--out", "out"]).stdout(Stdio::null());
        let mut child =
            command.env("RAYON_NUM_THREADS", "1").current_dir(place.path()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(40 + 83 * kill % 300));
        child.kill().unwrap();
        child.wait().unwrap();
        let now = found();
        assert!(now >= before, "{now} results after a kill, {before} before it");
        before = now;
    }
    let said = place.hhc(&["sweep", "run", "sweep.ron", "--out", "out", "--format", "json"]).json();
    assert_eq!(said["skipped"].as_u64().unwrap(), before, "{said}");
    assert_eq!(said["computed"].as_u64().unwrap(), 24 - before, "{said}");
    place.hhc(&["sweep", "merge", "sweep.ron", "--out", "out"]).done();
    assert_eq!(place.read("out/sweep.csv"), place.read("whole/sweep.csv"));
}

/// No space for a file, and a place where no file can be: an error that says so, and no result that is half there.
#[cfg(target_os = "linux")]
#[test]
fn without_space_or_permission_nothing_is_half_written() {
    let place = swept(SWEEP);
    let mut command = Command::new("sh");
    // the limit of file size stands for a full disk: a write fails in its middle
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" sweep run sweep.ron --out out";
    command.args(["-c", script, env!("CARGO_BIN_EXE_hhc")]).current_dir(place.path());
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("cannot be written") && said.contains("the space left"), "{said}");
    let files: Vec<String> =
        place.listing().into_iter().filter(|name| name.starts_with("out")).collect();
    assert!(files.is_empty(), "{files:?}");
    place
        .hhc(&["sweep", "run", "sweep.ron", "--out", "/proc/sweep"])
        .rejected(&["cannot be written"]);
}
