//! Bad input: each kind gives exit code 2, a message with file, line and remedy, and leaves nothing
//! half-written.

use crate::place::{Place, QUICK_CASE, write_bench};

/// Changes one line of a bench and expects `hhc check` and `hhc identify` to refuse it.
#[track_caller]
fn spoiled(file: &str, from: &str, to: &str, parts: &[&str]) {
    let place = Place::new();
    write_bench(&place, "bench");
    let path = format!("bench/{file}");
    let text = place.read(&path);
    assert!(text.contains(from), "{from} is not in {path}");
    place.write(&path, &text.replacen(from, to, 1));
    refused(&place, parts);
}

#[track_caller]
fn refused(place: &Place, parts: &[&str]) {
    place.hhc(&["check", "bench"]).rejected(parts);
    place.hhc(&["check", "bench/dataset.ron"]).rejected(parts);
    let before = place.listing();
    place.hhc(&["identify", "bench", "-o", "actuator.ron"]).rejected(parts);
    assert_eq!(place.listing(), before, "nothing is written");
}

#[test]
fn a_missing_column() {
    spoiled(
        "slow.csv",
        "time_s,command_V,displacement_um",
        "time_s,command_V,load_N",
        &[
            "bench/slow.csv:1:1: the column `displacement_um` is missing, the header has time_s, command_V, load_N; add the column",
        ],
    );
}

#[test]
fn a_wrong_unit() {
    spoiled(
        "five.csv",
        "command_V",
        "command_mV",
        &[
            "bench/five.csv:1:8: command_mV: the unit is mV, expected V; multiply the column by 0.001 and name it `command_V`",
        ],
    );
    spoiled(
        "five.csv",
        "displacement_um",
        "displacement [mm]",
        &["the unit is mm, expected um; multiply the column by 1000"],
    );
    spoiled("five.csv", "command_V", "command", &["the column `command` has no unit"]);
}

#[test]
fn a_sample_that_is_not_a_number() {
    spoiled(
        "one_small.csv",
        "0.0050,",
        "0.0050,NaN,1\n0.0050,",
        &["bench/one_small.csv:3:8: command_V: the value is NaN, expected a finite number"],
    );
    spoiled(
        "one_small.csv",
        "0.0050,",
        "0.0050,x",
        &["bench/one_small.csv:3:8: command_V: `x", "is not a number"],
    );
}

#[test]
fn a_truncated_record() {
    let place = Place::new();
    write_bench(&place, "bench");
    let text = place.read("bench/five.csv");
    for cut in [3, 12, 20] {
        place.write("bench/five.csv", &text[..text.len() - cut]);
        let lines = text.lines().count();
        refused(
            &place,
            &[&format!("bench/five.csv:{lines}:1: the last line is cut off"), "truncated"],
        );
    }
}

#[test]
fn time_that_runs_back_or_jumps() {
    spoiled(
        "slow.csv",
        "\n0.0400,",
        "\n0.0100,",
        &["bench/slow.csv:4:1: time_s: time 0.01 s follows 0.02 s, expected increasing time"],
    );
    spoiled(
        "slow.csv",
        "\n0.0400,",
        "\n0.0310,",
        &["bench/slow.csv:4:1: time_s: the time step is 0.01", "expected uniform sampling"],
    );
}

#[test]
fn a_command_outside_the_actuators_range() {
    spoiled(
        "dataset.ron",
        "(-20, 150)",
        "(-20, 140)",
        &[
            "bench/slow.csv:",
            "command_V: the command ",
            "lies outside command_range_V (-20, 140) of dataset.ron",
            "the records need `command_range_V: (-20, 150)` or more",
            "Beyond it: slow, one_large, five;",
        ],
    );
}

#[test]
fn all_problems_of_a_data_folder_in_one_report() {
    let place = Place::new();
    write_bench(&place, "bench");
    let dataset = place
        .read("bench/dataset.ron")
        .replace("title: \"a test's own bench\"", "titel: \"x\", title: \"\", flap_deg_per_um: -1")
        .replace("file: \"one_small.csv\"", "file: \"one_smal.csv\"")
        .replace("id: \"five\"", "id: \"slow\"")
        .replace("role: Reference),\n    ]", "role: Refrence),\n    ]");
    place.write("bench/dataset.ron", &dataset);
    let slow = place.read("bench/slow.csv").replacen("\n0.0400,", "\n0.0100,", 1);
    place.write("bench/slow.csv", &slow);
    let text = place
        .hhc(&["check", "bench"])
        .rejected(&["dataset.ron:3:5: titel: unknown key `titel`, did you mean `title`?"]);
    assert!(
        text.contains(
            "dataset.ron:8:40: runs[3].role: unknown choice `Refrence`, did you mean `Reference`?"
        ),
        "{text}"
    );
    // the unknown role leaves a run without one: the records wait until that is mended
    place.write(
        "bench/dataset.ron",
        &dataset.replace("Refrence", "Reference").replace("titel: \"x\", ", ""),
    );
    let text = place.hhc(&["check", "bench"]).rejected(&[
        "dataset.ron:3:5: title: is empty",
        "dataset.ron:3:16: flap_deg_per_um: is -1 deg/um, expected a positive finite number",
        "names the file one_smal.csv, which is not in bench",
        "dataset.ron:8:10: runs[3].id: `slow` is used already on line 5",
        "slow.csv:4:1: time_s: time 0.01 s follows",
        "5 problems",
    ]);
    assert_eq!(text.lines().count(), 6, "{text}");
}

#[test]
fn data_folders_that_are_none() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    place.hhc(&["identify", ".", "-o", "a.ron"]).rejected(&[
        "dataset.ron: cannot be read",
        "a data folder is described by its dataset.ron",
    ]);
    place.hhc(&["identify", "nowhere", "-o", "a.ron"]).rejected(&["cannot be read"]);
    write_bench(&place, "bench");
    let dataset = place.read("bench/dataset.ron");
    let absolute = place.path().join("case.ron").display().to_string();
    for name in ["../case.ron", "sub/../../case.ron", &absolute] {
        place.write("bench/dataset.ron", &dataset.replace("slow.csv", name));
        let words = ["runs[0].file", "is not a plain file name inside the data folder"];
        place.hhc(&["check", "bench"]).rejected(&words);
    }
    // so is a link, to a file or to a folder
    #[cfg(unix)]
    for (link, name) in [("../case.ron", "link.csv"), ("..", "up/case.ron")] {
        let at = place.path().join("bench").join(name.split('/').next().unwrap());
        std::os::unix::fs::symlink(link, at).unwrap();
        place.write("bench/dataset.ron", &dataset.replace("slow.csv", name));
        place.hhc(&["check", "bench"]).rejected(&[
            "runs[0].file",
            "a link that leads out",
            "copy the file",
        ]);
    }
}

/// A case with one wrong value: `check` and `run` refuse it in the same words.
#[track_caller]
fn bad_case(text: &str, parts: &[&str]) {
    let place = Place::new();
    place.write("case.ron", text);
    place.hhc(&["check", "case.ron"]).rejected(parts);
    place.hhc(&["run", "case.ron"]).rejected(parts);
    place.hhc(&["modes", "case.ron"]).rejected(parts);
    assert_eq!(place.listing(), ["case.ron"], "nothing is written");
}

#[test]
fn an_unknown_key() {
    bad_case(
        "(\n  rotor: (\n    radius: 5.0,\n  ),\n)",
        &[
            "case.ron:3:5: rotor.radius: unknown key `radius`, did you mean `radius_m`?; known here: blades, radius_m",
        ],
    );
}

#[test]
fn a_negative_stiffness() {
    bad_case(
        "(\n  rotor: (\n    ei_lag: -0.0268,\n  ),\n)",
        &[
            "case.ron:3:5: rotor.ei_lag: is -0.0268 m0 Omega^2 R^4, expected a positive finite number; a stiffness is positive",
        ],
    );
}

#[test]
fn a_blade_that_is_none() {
    bad_case(
        "(rotor: (gj: 0))",
        &["rotor.gj: is 0 m0 Omega^2 R^4, expected a positive finite number"],
    );
    bad_case(
        "(rotor: (tables: (ei_flap: [(0, 0.02), (0.6, 0.01), (0.3, 0.01), (1, 0.01)])))",
        &["rotor.tables.ei_flap[2]: is 0.3 R, expected 0.6 to 1 R; list the stations from root"],
    );
    bad_case(
        "(rotor: (tables: (mass: [(0.2, 1), (1, 1)])))",
        &["rotor.tables.mass: is refused: the table reaches from 0.2 R to 1 R", "at both ends"],
    );
    bad_case(
        "(\n  rotor: (tables: (\n    gj: [],\n    mass: [(1, 1)],\n  )),\n)",
        &[
            "case.ron:3:5: rotor.tables.gj: is refused: the table has no value",
            "or leave the table out",
            "case.ron:4:5: rotor.tables.mass: is refused: the table reaches from 1 R to 1 R",
        ],
    );
    bad_case(
        "(rotor: (tables: (ka_r: [(0, -0.01), (1, 0.02)], twist_deg: [(0, NaN), (1, 0)])))",
        &["ka_r[0]: is -0.01 R, expected 0 to 1 R", "twist_deg[0]: is NaN deg, expected -90 to 90"],
    );
    bad_case(
        "(flaps: [(start_r: 0.9, end_r: 1.05)])",
        &["flaps[0].end_r: the flap spans 0.9 R to 1.05 R", "<= 1 R"],
    );
}

#[test]
fn an_undamped_mode_at_a_harmonic() {
    let place = Place::new();
    let text =
        "(rotor: (modal_damping: 0, ei_lag: 1e5, root: (lag: Spring(stiffness: 0.33333333))))";
    place.write("case.ron", text);
    let near = "lag 1 at 0.00 deg has 0.9982 per rev, near the harmonic 1 of the loads";
    for args in [["check", "case.ron"], ["run", "case.ron"]] {
        place.hhc(&args).rejected(&["rotor.modal_damping", near, "no damping", "Remedy"]);
    }
    // its frequencies can be looked at all the same
    let modes = place.hhc(&["modes", "case.ron"]).done();
    assert!(modes.contains("lag 1"), "{modes}");
}

#[test]
fn an_advance_ratio_outside_the_models() {
    bad_case(
        "(\n  advance_ratio: 0.55,\n)",
        &["case.ron:2:3: advance_ratio: is 0.55, expected 0 to 0.5"],
    );
    bad_case("(advance_ratio: -0.01)", &["advance_ratio: is -0.01, expected 0 to 0.5"]);
    bad_case("(advance_ratio: NaN)", &["advance_ratio: is NaN, expected 0 to 0.5"]);
}

#[test]
fn a_voltage_outside_the_actuators_range() {
    bad_case(
        "(\n  control: (\n    bias_V: 65,\n    amplitude_V: 100,\n  ),\n)",
        &[
            "case.ron:4:5: control.amplitude_V: the voltage 65 V +- 100 V leaves the actuator's range -20 V to 150 V; lower control.amplitude_V to 85 V",
        ],
    );
}

#[test]
fn a_range_beyond_the_records() {
    let place = Place::new();
    let text = "(\n  title: \"wide\",\n  actuator: (\n    range_V: (-200, 300),\n  ),\n  control: (bias_V: 50, amplitude_V: 200),\n)";
    place.write("case.ron", text);
    place.hhc(&["run", "case.ron"]).rejected(&[
        "case.ron:4:5: actuator.range_V: (-200, 300) V reaches beyond the (-20, 150) V",
        "narrow the range",
    ]);
    assert_eq!(place.listing(), ["case.ron"], "nothing is written");
}

#[test]
fn broken_ron() {
    bad_case(
        "(\n  advance_ratio: 0.3\n  rotor: (),\n)",
        &["case.ron:3:3: is not valid RON: expected comma"],
    );
    bad_case("(\n  rotor: (blades: 4,\n", &["case.ron:", "is not valid RON"]);
}

#[test]
fn a_trim_out_of_reach() {
    let place = Place::new();
    place.write("case.ron", &QUICK_CASE.replace("ct_sigma: 0.07", "ct_sigma: 0.45"));
    place.hhc(&["check", "case.ron"]).done();
    place.hhc(&["run", "case.ron"]).rejected(&[
        "case.ron:7:22: trim.ct_sigma: trim is out of reach",
        "Remedy: lower the thrust",
    ]);
    assert_eq!(place.listing(), ["case.ron"], "nothing is written");
}

#[test]
fn numerics_that_fail_exit_with_1() {
    let place = Place::new();
    let text = QUICK_CASE.replace(
        "title: \"quick\",",
        "title: \"quick\", tolerances: (trim_iterations: 1, trim: 1e-12),",
    );
    place.write("case.ron", &text);
    let ran = place.hhc(&["run", "case.ron"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("trim stopped after 1 iteration"), "{}", ran.err);
    assert!(ran.err.contains("residual"), "{}", ran.err);
    assert_eq!(place.listing(), ["case.ron"]);
}

#[test]
fn files_that_are_none() {
    let place = Place::new();
    place.hhc(&["run", "missing.ron"]).rejected(&["missing.ron: cannot be read", "check the path"]);
    place.write("table.csv", "time_s,command_V\n1,2\n");
    place.hhc(&["check", "table.csv"]).rejected(&["neither a case, a dataset.ron nor an actuator"]);
    place.write("out", "a file where a folder should be");
    place.write("case.ron", QUICK_CASE);
    place.hhc(&["run", "case.ron"]).rejected(&["cannot be written", "check the folder"]);
}

#[test]
fn an_actuator_file_that_was_tampered_with() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "actuator.ron"]).done();
    place.hhc(&["check", "actuator.ron"]).done();
    let text = place.read("actuator.ron");
    place.write("actuator.ron", &text.replacen("zero_um: ", "zero_um: NaN, x: ", 1));
    place.hhc(&["check", "actuator.ron"]).rejected(&["model.calibration.x: unknown key `x`"]);
    place.write("actuator.ron", &text.replacen("zero_um: ", "zero_um: inf, // ", 1));
    place.hhc(&["check", "actuator.ron"]).rejected(&[
        "model.calibration.zero_um: is refused: zero_um is inf, expected a finite number",
    ]);
    place.write("actuator.ron", &text.replacen("(-20.0, 150.0)", "(150.0, -20.0)", 1));
    place.hhc(&["check", "actuator.ron"]).rejected(&["actuator.ron:", "is empty or not finite"]);
    place.write("actuator.ron", &text[..text.len() / 2]);
    place.hhc(&["check", "actuator.ron"]).rejected(&["actuator.ron:"]);
    place.write("case.ron", "(actuator: (model: File(path: \"gone.ron\")))");
    place.hhc(&["run", "case.ron"]).rejected(&["gone.ron: cannot be read"]);
}

#[test]
fn section_questions_outside_the_models() {
    let place = Place::new();
    let ask = |more: &[&str]| {
        let mut args = vec!["section", "--reduced-frequency", "0.1"];
        args.extend(more);
        place.hhc(&args)
    };
    ask(&["--model", "incompressible", "--mach", "0.3"])
        .rejected(&["the incompressible model holds at Mach 0 only, got Mach 0.3"]);
    ask(&["--mach", "1.2"]).rejected(&["Mach number 1.2"]);
    ask(&["--mach", "-0.1"]).rejected(&["Mach number -0.1"]);
    ask(&["--mach", "NaN"]).rejected(&["Mach number NaN"]);
    ask(&["--flap-chord", "1.5"]).rejected(&["flap chord ratio 1.5"]);
    place
        .hhc(&["section", "--reduced-frequency", "-1"])
        .rejected(&["reduced frequency is -1: expected 0 to 1000"]);
    ask(&["--model", "xfoil"]).rejected(&["invalid value 'xfoil'", "hariharan-leishman"]);
    place.hhc(&["section"]).rejected(&["--reduced-frequency"]);
    place.hhc(&["section", "--response", "loop"]).rejected(&["--reduced-frequency"]);
    ask(&["--model", "calibrated", "--flap-chord", "0.05"])
        .rejected(&["flap chord ratio 0.05", "0.1 to 0.4"]);
    let respond = |response: &str, more: &[&str]| {
        place.hhc(&[&["section", "--response", response], more].concat())
    };
    respond("step", &["--distance", "0"]).rejected(&["distance, semichords is 0"]);
    respond("ramp", &["--rise", "-1"]).rejected(&["rise, semichords is -1"]);
    // numbers beyond all sense are refused too, not answered with NaN
    place.hhc(&["section", "--reduced-frequency", "1e300"]).rejected(&["expected 0 to 1000"]);
    respond("step", &["--distance", "1e308"]).rejected(&["above 0, to 1e6"]);
    respond("ramp", &["--rise", "1e-300"]).rejected(&["0 (a step), or 1e-6 to 1e6"]);
    ask(&["--response", "loop", "--mean-deg", "1e6"]).rejected(&["mean, deg is", "-180 to 180"]);
    respond("polar", &["--amplitude-deg", "1e9"]).rejected(&["first incidence, deg"]);
    respond("polar", &["--amplitude-deg", "-3"]).rejected(&["range of incidences"]);
    respond("polar", &["--amplitude-deg", "NaN"]).rejected(&["--amplitude-deg: is refused", "NaN"]);
    respond("step", &["--points", "0"]).rejected(&["number of points is 0"]);
    ask(&["--response", "loop", "--points", "2"]).rejected(&["number of points of a cycle is 2"]);
    // what a response would not heed
    for (response, option) in [
        ("step", ["--reduced-frequency", "0.1"]),
        ("step", ["--rise", "1"]),
        ("ramp", ["--mean-deg", "1"]),
        ("step", ["--amplitude-deg", "1"]),
        ("polar", ["--motion", "pitch"]),
        ("polar", ["--distance", "9"]),
        ("polar", ["--effectiveness", "0.8,1,1"]),
    ] {
        let refused = format!("{}: is refused: it is used with", option[0]);
        respond(response, &option).rejected(&[&refused]);
    }
    ask(&["--points", "9"]).rejected(&["--points: is refused"]);
    ask(&["--effectiveness", "0.8,1"]).rejected(&["flap effectiveness factors is 2"]);
    ask(&["--effectiveness", "0.8,1,7"]).rejected(&["flap effectiveness in hinge moment is 7"]);
    ask(&["--stall", "naca0012"]).rejected(&["--stall: is refused", "loop or polar only"]);
    ask(&["--table", "a.c81"]).rejected(&["--table: is refused", "polar only"]);
}

#[test]
fn aerofoil_tables_of_a_case() {
    let place = Place::new();
    place.write("broken.c81", "PLATE\n1 2 3\n");
    place.write(
        "case.ron",
        "(aerodynamics: (\nairfoils: [\n(station_r: 0.5, table: \"gone.c81\"),\n(station_r: 0.2, table: \"broken.c81\"),\n], dynamic_stall: Naca12))",
    );
    for command in ["check", "run"] {
        place.hhc(&[command, "case.ron"]).rejected(&[
            "case.ron:3:",
            "aerodynamics.airfoils[0].table: names the file gone.c81",
            "aerodynamics.airfoils[1].station_r: is 0.2 R, expected 0.5 to 1 R",
            "broken.c81:1:31: is refused: expected a first line",
            "unknown choice `Naca12`, did you mean `Naca0012`?",
        ]);
    }
}

#[test]
fn a_specimen_given_twice() {
    let place = Place::new();
    write_bench(&place, "bench");
    let own = ["diagnose", "a.ron", "--data", "bench", "--data", "bench", "-o", "out"];
    place.hhc(&own).rejected(&["--data: is refused: one folder was given twice"]);
}
