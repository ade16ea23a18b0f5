//! `hhc import`: what is recognised, written, refused; and what becomes of it.

use crate::place::Place;
use std::fmt::Write;

/// A triangle through a play of half-width `r`: hysteresis of a known kind. Columns time, input, output.
pub(crate) fn play(r: f64, samples: usize) -> Vec<[f64; 3]> {
    let mut w = 0.0;
    (0..samples)
        .map(|i| {
            let phase = (i % 200) as f64 / 100.0;
            let u = if phase <= 1.0 { 2.0 * phase - 1.0 } else { 3.0 - 2.0 * phase };
            w = f64::clamp(w, u - r, u + r);
            [i as f64 * 0.01, u, w]
        })
        .collect()
}

pub(crate) fn csv(header: &str, rows: &[[f64; 3]], scale: [f64; 3]) -> String {
    let mut text = header.to_owned();
    for row in rows {
        let [t, u, y] = [0, 1, 2].map(|i| row[i] * scale[i]);
        let _ = writeln!(text, "{t:.6},{u:.6},{y:.6}");
    }
    text
}

const ACTUATOR: &str = "time_s,command_V,displacement_um\n";

#[test]
fn a_bench_in_other_units() {
    let place = Place::new();
    let rows = play(0.2, 1000);
    place.write("run a.csv", &csv("time_ms,command_mV,displacement_mm\n", &rows, [1e3, 8e4, 0.2]));
    let text = place.hhc(&["import", "run a.csv", "-o", "bench", "--range", "-100,150"]).done();
    assert!(text.contains("data set of kind ActuatorBench"), "{text}");
    assert!(text.contains("command_V") && text.contains("1000 samples, step 0.01 s"), "{text}");
    assert_eq!(place.listing(), ["bench/dataset.ron", "bench/run_a.csv", "run a.csv"]);
    let written = place.read("bench/run_a.csv");
    assert!(written.starts_with(ACTUATOR), "{written}");
    // 80 V and 200 um at most
    assert!(written.contains("\n1,80,160\n"), "{}", &written[..2500]);
    let json = place.hhc(&["check", "bench", "--format", "json"]).json();
    assert_eq!(json["kind"], "bench");
    place
        .hhc(&["import", "run a.csv", "-o", "bench"])
        .rejected(&["bench exists already and is not overwritten"]);
}

/// Which column was taken for the command is said. A voltage that is no command by its name is not taken for one; the option that is
/// printed takes it.
#[test]
fn whose_column_the_command_is() {
    let place = Place::new();
    let rows = play(0.2, 1000);
    place.write("u.csv", &csv("time_ms,u_mV,weg_um\n", &rows, [1e3, 8e4, 50.0]));
    let told = place.hhc(&["import", "u.csv", "-o", "u"]).done();
    assert!(told.contains("command is the column `u_mV`"), "{told}");
    assert!(told.contains("displacement is the column `weg_um`"), "{told}");
    for name in ["sensor", "amplifier"] {
        let header = format!("time_ms,{name}_mV,weg_um\n");
        place.write("v.csv", &csv(&header, &rows, [1e3, 8e4, 50.0]));
        let told = place.hhc(&["import", "v.csv", "-o", name]).done();
        assert!(told.contains("data set of kind GenericLoop"), "{told}");
        let option = "--columns time_ms=#1,command_mV=#2,displacement_um=#3";
        let line =
            format!("`{name}_mV` is not taken for the command, by its name; if it is: {option}");
        assert!(told.contains(&line), "{told}");
        let (option, columns) = option.split_once(' ').unwrap();
        let bench = format!("{name}_bench");
        let told = place.hhc(&["import", "v.csv", "-o", &bench, option, columns]).done();
        assert!(told.contains("data set of kind ActuatorBench"), "{told}");
        // whoever asks for a loop knows what it is
        let out = format!("{name}_loop");
        let asked = ["import", "v.csv", "-o", &out, "--kind", "generic-loop"];
        assert!(!place.hhc(&asked).done().contains("is not taken"));
    }
}

#[test]
fn generic_loops_several_files_and_json() {
    let place = Place::new();
    for (name, r) in [("wide.csv", 0.3), ("narrow.csv", 0.1)] {
        place.write(
            name,
            &csv("time_s,displacement_in,force_kip\n", &play(r, 500), [1.0, 0.5, 2.0]),
        );
    }
    let args = [
        "import",
        "wide.csv",
        "narrow.csv",
        "-o",
        "damper",
        "--title",
        "a play",
        "--format",
        "json",
    ];
    let json = place.hhc(&args).json();
    assert_eq!(json["kind"], "GenericLoop");
    assert_eq!(json["runs"][1]["columns"][0]["column"], "displacement_in");
    assert_eq!(json["runs"][1]["columns"][0]["largest"], 0.5);
    assert_eq!(json["runs"][0]["block"], 1);
    let twice =
        place.hhc(&["import", "wide.csv", "wide.csv", "-o", "twice", "--format", "json"]).json();
    assert_eq!(
        (&twice["runs"][0]["id"], &twice["runs"][1]["id"]),
        (&"wide".into(), &"wide_2".into())
    );
    let json = place.hhc(&["check", "damper", "--format", "json"]).json();
    assert_eq!(json["kind"], "generic_loop");
    let summary = json["summary"].as_str().unwrap();
    assert!(summary.contains("displacement_in to force_kip, 2 runs, 1000 samples, input -0.5 to 0.5 (from the smallest"), "{summary}");
    // no case can use it as its actuator
    place.write("case.ron", "(actuator: (model: Bench(dataset: \"damper\")))");
    place
        .hhc(&["check", "case.ron"])
        .rejected(&["damper/dataset.ron:", "kind: is GenericLoop, expected ActuatorBench"]);
}

#[test]
fn long_records_are_averaged_and_say_so() {
    let place = Place::new();
    place.write("a.csv", &csv(ACTUATOR, &play(0.2, 4000), [1.0, 80.0, 200.0]));
    let text = place.hhc(&["import", "a.csv", "-o", "less", "--max-samples", "1000"]).done();
    assert!(
        text.contains("4000 samples read, 500 written: means of 8 samples, step 0.08 s"),
        "{text}"
    );
    let text = place.hhc(&["import", "a.csv", "-o", "rate", "--reduce-to-hz", "25"]).done();
    assert!(
        text.contains("4000 samples read, 1000 written: means of 4 samples, step 0.04 s"),
        "{text}"
    );
    assert!(place.read("rate/dataset.ron").contains("a.csv, means of 4 samples"));
    place.hhc(&["check", "rate"]).done();
}

#[test]
fn standard_input_quiet_completions_and_pages() {
    let place = Place::new();
    place.write("a.csv", &csv(ACTUATOR, &play(0.2, 400), [1.0, 8.0, 20.0]));
    // commands below 12 V: a warning
    let loud = place.hhc(&["import", "a.csv", "-o", "loud"]);
    assert!(loud.err.contains("warning"), "{}", loud.err);
    let quiet = place.hhc(&["import", "a.csv", "-o", "quiet", "--quiet"]);
    assert!(quiet.err.is_empty() && quiet.out.contains("400 samples"), "{}", quiet.err);
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_hhc"))
        .args(["import", "-", "-o", "piped"])
        .current_dir(place.path())
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdin.take().unwrap();
    std::io::Write::write_all(&mut pipe, place.read("a.csv").as_bytes()).unwrap();
    drop(pipe);
    let ran = child.wait_with_output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    assert_eq!(place.read("piped/run.csv"), place.read("loud/a.csv"));
    let text = place.hhc(&["completions", "bash"]).done();
    assert!(text.contains("_hhc()") && text.contains("--sampling-hz"), "{text}");
    let page = place.hhc(&["man", "import"]).done();
    assert!(page.contains(".TH") && page.contains("deg\\-per\\-um"), "{page}");
    place.hhc(&["man", "imports"]).rejected(&["there is no command `imports`", "hhc help"]);
}

const FORC: &str = "MicroMag 2900/3900 Data File (Series 0015)\nUnits of measure: cgs\n\"wires\"\nHCal = 1000\nNCrv = 3\nNData = 12\n\n";

#[test]
fn reversal_curves() {
    let place = Place::new();
    let mut text = FORC.to_owned();
    for curve in 0..3 {
        writeln!(text, "1000,{:e}\n", 1e-3 + 1e-6 * f64::from(curve)).unwrap();
        for i in 0..3 {
            writeln!(text, "{},{:e}", 100 * (2 - curve + i), 1e-4 * f64::from(i)).unwrap();
        }
        text.push('\n');
    }
    place.write("sample", &(text.clone() + "MicroMag 2900/3900 Data File ends\n"));
    let printed = place.hhc(&["import", "sample", "-o", "curves"]).done();
    assert!(printed.contains("MicroMag FORC file, 3 drift calibrations"), "{printed}");
    assert!(printed.contains("3 curves, 9 points"), "{printed}");
    let json = place.hhc(&["check", "curves", "--format", "json"]).json();
    assert_eq!(json["kind"], "reversal_curves");
    assert_eq!(json["summary"], "wires: field_Oe to moment_emu, 3 curves");
    assert!(
        place
            .read("curves/sample.csv")
            .starts_with("curve,field_Oe,moment_emu\n1,200,0\n1,300,0.0001\n")
    );
    assert_eq!(place.read("curves/sample_calibration.csv").lines().count(), 4);
    place.write("cut", &text);
    place.hhc(&["import", "cut"]).rejected(&["cut:", "truncated"]);
    // a curve number that runs back
    let bad = place.read("curves/sample.csv").replacen("\n2,", "\n0,", 1);
    place.write("curves/sample.csv", &bad);
    place
        .hhc(&["check", "curves"])
        .rejected(&["sample.csv:5:1: curve: is refused: 0 is no curve number"]);
}

/// Imports a bench and expects refusal; nothing may be written.
#[track_caller]
fn refused(header: &str, rows: &[[f64; 3]], scale: [f64; 3], parts: &[&str]) {
    let place = Place::new();
    place.write("a.csv", &csv(header, rows, scale));
    place.hhc(&["import", "a.csv", "-o", "bench"]).rejected(parts);
    assert_eq!(place.listing(), ["a.csv"], "nothing is written");
    // the same record in a data folder is refused in the same words
    place.write("bench/a.csv", &csv(header, rows, scale));
    place.write(
        "bench/dataset.ron",
        "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"a.csv\", role: Reference)], command_range_V: (-100, 150))",
    );
    place.hhc(&["check", "bench"]).rejected(parts);
    let before = place.listing();
    place.hhc(&["identify", "bench", "-o", "a.ron"]).rejected(parts);
    assert_eq!(place.listing(), before, "nothing is written");
}

#[test]
fn a_constant_input_or_output() {
    let rows = play(0.2, 500);
    refused(
        ACTUATOR,
        &rows,
        [1.0, 80.0, 0.0],
        &["a.csv:2:1: displacement_um: every sample is 0 um", "constant output"],
    );
}

#[test]
fn one_sample() {
    refused(
        ACTUATOR,
        &play(0.2, 1),
        [1.0, 80.0, 200.0],
        &["a.csv: has 1 rows of numbers, expected at least 3; the record may be cut off"],
    );
}

#[test]
fn millivolts_that_call_themselves_volts() {
    let rows = play(0.2, 500);
    refused(
        ACTUATOR,
        &rows,
        [1.0, 80_000.0, 200.0],
        &[
            "command_V: reaches -80000 V, ",
            "times the largest of the range",
            "would fit as mV: name the column `command_mV`",
            "multiply it by 0.001",
        ],
    );
    // in kilovolts nothing is outside the range: a warning
    let place = Place::new();
    place.write("a.csv", &csv(ACTUATOR, &rows, [1.0, 0.08, 200.0]));
    let ran = place.hhc(&["import", "a.csv", "-o", "bench"]);
    assert!(
        ran.err.contains(
            "warning: a.csv: command_V: no command uses more than 0.09 % of command_range_V"
        ),
        "{}",
        ran.err
    );
    ran.done();
}

#[test]
fn swapped_columns() {
    let rows = play(0.2, 500);
    let lead = [
        "command_V: the displacement leads the command by",
        "command and displacement are swapped",
    ];
    let swapped = csv("time_s,displacement_um,command_V\n", &rows, [1.0, 80.0, 80.0]);
    let place = Place::new();
    place.write("a.csv", &swapped);
    place.hhc(&["import", "a.csv", "-o", "bench"]).rejected(&lead);
    assert_eq!(place.listing(), ["a.csv"]);
    // as a generic loop it is nobody's business
    place.hhc(&["import", "a.csv", "-o", "loop", "--kind", "generic-loop"]).done();
    refused(
        "command_V,time_s,displacement_um\n",
        &rows,
        [1.0, 80.0, 80.0],
        &[
            "time_s: does not increase, but `command_V` increases in equal steps: the two columns are swapped",
        ],
    );
}

#[test]
fn a_clipped_record_is_a_warning() {
    let place = Place::new();
    let clipped: Vec<[f64; 3]> =
        play(0.05, 1000).into_iter().map(|[t, u, y]| [t, u, y.clamp(-0.8, 0.8)]).collect();
    place.write("a.csv", &csv(ACTUATOR, &clipped, [1.0, 80.0, 200.0]));
    let ran = place.hhc(&["import", "a.csv", "-o", "bench"]);
    for end in ["largest 160 um", "smallest -160 um"] {
        assert!(
            ran.err.contains(&format!("displacement_um: the output stays at its {end} for")),
            "{}",
            ran.err
        );
    }
    ran.done();
    let json = place.hhc(&["check", "bench", "--format", "json"]).json();
    // two of clipping, one of the gain that is not given
    assert_eq!(json["warnings"].as_array().unwrap().len(), 3, "{json}");
}

#[test]
fn jitter_is_resampled_and_gaps_are_refused() {
    let place = Place::new();
    let shaken = |part: f64| -> Vec<[f64; 3]> {
        let rows = play(0.2, 499).into_iter().enumerate();
        rows.map(|(i, [t, u, y])| [t + if i % 3 == 1 { 0.01 * part } else { 0.0 }, u, y]).collect()
    };
    place.write("a.csv", &csv(ACTUATOR, &shaken(0.1), [1.0, 80.0, 200.0]));
    let ran = place.hhc(&["import", "a.csv", "-o", "bench"]);
    assert!(ran.err.contains("warning: a.csv: time_s: the time steps differ by up to 10 %; resampled to 0.01 s by straight lines"), "{}", ran.err);
    ran.done();
    place.hhc(&["check", "bench"]).done();
    // the same in a data folder: the same warning
    place.write("bench/a.csv", &csv(ACTUATOR, &shaken(0.1), [1.0, 80.0, 200.0]));
    let json = place.hhc(&["check", "bench", "--format", "json"]).json();
    assert!(json["warnings"][0].as_str().unwrap().contains("resampled to 0.01 s"), "{json}");
    refused(
        ACTUATOR,
        &shaken(0.5),
        [1.0, 80.0, 200.0],
        &["a.csv:", "time_s: the time step is", "expected uniform sampling"],
    );
}

#[test]
fn formats_that_are_not_read() {
    let place = Place::new();
    place.write("new.mat", &format!("{:<512}\u{89}", "MATLAB 7.3 MAT-file, Platform: GLNXA64"));
    place.hhc(&["import", "new.mat"]).rejected(&["new.mat: is an HDF5 file", "'-v7'"]);
    place.write("old.mat", "\0\0\0\0\u{5}\0\0\0\u{1}\0\0\0\0\0\0\0\u{2}\0\0\0u\0________________________________________");
    place.hhc(&["import", "old.mat"]).rejected(&["old.mat: `u` is no matrix of several columns"]);
    place.write("page.html", "<html>");
    place.hhc(&["import", "page.html"]).rejected(&["is a page or XML, no table", "as CSV"]);
    place.hhc(&["import", "gone.csv"]).rejected(&["gone.csv: cannot be read"]);
    place.write("a.csv", "0,1,2\n1,2,3\n2,3,4\n");
    place
        .hhc(&["import", "a.csv"])
        .rejected(&["a.csv:1:1: the 3 columns have no names; name them: --columns time_s,command_V,displacement_um"]);
    place.write("b.csv", "time_s,a_V,b_V,c_V\n0,1,2,3\n1,2,3,4\n2,3,4,4\n");
    place
        .hhc(&["import", "b.csv"])
        .rejected(&["a_V, b_V, c_V leave open which is the input", "--input NAME --response NAME"]);
    place.hhc(&["import", "a.csv", "--reduce-to-hz", "-1"]).rejected(&["--reduce-to-hz: is -1 Hz"]);
    place.hhc(&["import", "a.csv", "--range", "5"]).rejected(&["expected LOW,HIGH"]);
    assert_eq!(place.listing(), ["a.csv", "b.csv", "new.mat", "old.mat", "page.html"]);
}

/// A cell of text, a short row: the row is reported, and nothing is said about the time across the hole.
#[test]
fn holes_are_reported_once() {
    let rows = play(0.2, 500);
    let text = csv(ACTUATOR, &rows, [1.0, 80.0, 200.0]);
    let broken = |line: usize, new: &str| {
        let mut lines: Vec<&str> = text.lines().collect();
        lines[line - 1] = new;
        lines.join("\n") + "\n"
    };
    for (new, part) in [
        ("2.98,abc,0.5", "a.csv:300:6: command_V: `abc` is not a number"),
        ("abc,1,0.5", "a.csv:300:1: time_s: `abc` is not a number"),
        ("2.98,1", "a.csv:300:1: the row has 2 fields, the header has 3"),
    ] {
        let place = Place::new();
        place.write("a.csv", &broken(300, new));
        let said = place.hhc(&["import", "a.csv"]).rejected(&[part]);
        assert_eq!(said.trim().lines().count(), 1, "{said}");
        place.write("d/a.csv", &broken(300, new));
        place.write(
            "d/dataset.ron",
            "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"a.csv\", role: Reference)])",
        );
        let said =
            place.hhc(&["check", "d"]).rejected(&[&part[5..][part[5..].find(' ').unwrap()..]]);
        assert_eq!(said.trim().lines().count(), 1, "{said}");
    }
}

#[test]
fn names_and_separators_that_are_not_clear() {
    let place = Place::new();
    place.write("a.csv", "time_s,command_V,command_V,displacement_um\n0,1,1,2\n1,2,2,3\n2,3,3,5\n");
    place.hhc(&["import", "a.csv"]).rejected(&["2 columns are called `command`", "--columns"]);
    let columns = "time_s=#1,command_V=#3,displacement_um=#4";
    place.hhc(&["import", "a.csv", "--columns", columns]).done();
    let comma = "time_s;command_V;displacement_um\n0,0;1,0;2,0\n0,1;2,0;3,0\n0,2;3,0;5,0\n";
    place.write("b.csv", comma);
    let text = place.hhc(&["import", "b.csv", "-o", "comma"]).done();
    assert!(text.contains("text table, semicolons, decimal commas"), "{text}");
    place.write("c.csv", &comma.replace(',', "."));
    place.hhc(&["import", "c.csv"]).done();
    place.write("d/a.csv", &comma.replace(',', "."));
    place.write(
        "d/dataset.ron",
        "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"a.csv\", role: Reference)])",
    );
    place
        .hhc(&["check", "d"])
        .rejected(&["separated by semicolons, expected commas", "hhc import"]);
}

#[test]
fn windows_and_keys_of_a_data_set() {
    let place = Place::new();
    place.write("d/a.csv", &csv("time_s,field_Oe,moment_emu\n", &play(0.2, 500), [1.0; 3]));
    let dataset = |runs: &str, more: &str| {
        format!("(kind: GenericLoop, title: \"t\",\nruns: [\n{runs}\n],\n{more}\n)")
    };
    let run = |id: &str, more: &str| {
        format!("(id: \"{id}\", file: \"a.csv\", role: Reference, {more}),\n")
    };
    let two =
        run("a", "window_s: (0, 2), use: Train") + &run("b", "window_s: (2, 4), use: HeldOut");
    place.write("d/dataset.ron", &dataset(&two, ""));
    place.hhc(&["check", "d"]).done();
    let same = run("a", "window_s: (0, 2)") + &run("b", "window_s: (0, 2)");
    place.write("d/dataset.ron", &dataset(&same, ""));
    place.hhc(&["check", "d"]).rejected(&["runs[1].file: `a.csv` is used already"]);
    for window in ["(4, 2)", "(0, 0.1)", "(4, 9)"] {
        place.write("d/dataset.ron", &dataset(&run("a", &format!("window_s: {window}")), ""));
        place
            .hhc(&["check", "d"])
            .rejected(&["runs[0].window_s: the window (", "which runs from 0 to 4.99 s"]);
    }
    place.write(
        "d/dataset.ron",
        &dataset(&run("a", "calibration: \"b.csv\""), "command_range_V: (0, 1)"),
    );
    place.hhc(&["check", "d"]).rejected(&[
        "runs[0].calibration: belongs to kind ReversalCurves, the data set is GenericLoop",
        "command_range_V: belongs to kind ActuatorBench",
    ]);
    place.write("d/dataset.ron", &dataset(&run("a", ""), "input_range: (-0.5, 0.5)"));
    place
        .hhc(&["check", "d"])
        .rejected(&["a.csv:2:1: field_Oe: is -1 Oe, expected -0.5 to 0.5 Oe"]);
    // units that the header does not give stand in dataset.ron
    place.write("d/a.csv", &csv("time_s,H,M\n", &play(0.2, 500), [1.0; 3]));
    place.write("d/dataset.ron", &dataset(&run("a", ""), ""));
    place.hhc(&["check", "d"]).rejected(&["a.csv:1:8: the column `H` has no known unit"]);
    let units = "input: (column: \"H\", unit: \"Oe\"), output: (column: \"M\", unit: \"emu\")";
    place.write("d/dataset.ron", &dataset(&run("a", ""), units));
    let text = place.hhc(&["check", "d"]).done();
    assert!(text.contains("h_Oe to m_emu"), "{text}");
}

#[test]
fn a_case_whose_data_are_not_there() {
    let place = Place::new();
    place.write("case.ron", "(\n  actuator: (model: Bench(dataset: \"nowhere\")),\n)");
    place.hhc(&["check", "case.ron"]).rejected(&[
        "case.ron:2:14: actuator.model: names the file dataset.ron, which is not in nowhere",
    ]);
    place.write("case.ron", "(\n  actuator: (model: File(path: \"gone.ron\")),\n)");
    place
        .hhc(&["check", "case.ron"])
        .rejected(&["case.ron:2:14: actuator.model: names the file gone.ron, which is not in"]);
}

/// The measured files in `fixtures/measured`.
pub(crate) fn measured(path: &str) -> String {
    format!("{}/../../fixtures/measured/{path}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_measured_reversal_curves() {
    let place = Place::new();
    let json = place
        .hhc(&["import", &measured("forc/hchb_forc"), "-o", "forc", "--format", "json"])
        .json();
    assert_eq!(json["kind"], "ReversalCurves");
    assert_eq!(json["title"], "Delaware FeCo D 20nm wires OOP FORC");
    assert_eq!(json["runs"][0]["curves"], 152);
    assert_eq!(json["runs"][0]["samples_read"], 30_628);
    assert_eq!(json["runs"][0]["samples_written"], 30_476);
    let text = place.hhc(&["check", "forc"]).done();
    assert!(text.contains("field_Oe to moment_emu, 152 curves"), "{text}");
    assert_eq!(place.read("forc/hchb_forc_calibration.csv").lines().count(), 153);
}

#[test]
fn the_measured_friction_damper() {
    let place = Place::new();
    let json = place.hhc(&["check", &measured("friction_damper"), "--format", "json"]).json();
    assert_eq!(json["kind"], "generic_loop");
    let summary = json["summary"].as_str().unwrap();
    assert!(summary.contains("displacement_in to friction_force_kip, 6 runs"), "{summary}");
    assert_eq!(json["warnings"].as_array().unwrap().len(), 0, "{json}");
}

/// Trained at 0.25 Hz, judged at 0.5 and 1 Hz: the table says what leads and what cannot, in inches and
/// kips, at the frequencies of the steady parts.
#[test]
fn the_measured_friction_damper_is_a_stop_and_no_play() {
    let place = Place::new();
    let args = ["identify", &measured("friction_damper"), "-o", "damper.ron"];
    let json = place.hhc(&[&args[..], &["--format", "json"]].concat()).json();
    for run in json["runs"].as_array().unwrap() {
        let id = run["id"].as_str().unwrap();
        let hz: f64 = id.split('_').nth(1).unwrap().trim_end_matches("Hz").parse().unwrap();
        let found = run["frequency_hz"].as_f64().unwrap();
        assert!((found / hz - 1.0).abs() < 0.01, "{id}: {found} Hz");
        assert_eq!(run["use"], if hz < 0.3 { "Train" } else { "HeldOut" });
    }
    // a force that rests at the friction until the motion turns is neither cut nor spoilt
    for line in json["findings"].as_array().unwrap() {
        let kind = line["finding"].to_string();
        assert!(!kind.contains("Clipped") && !kind.contains("Spikes"), "{line}");
        // the stops that are written describe the data; the static model beside them does not
        assert!(!kind.contains("NotDescribed"), "{line}");
    }
    let models = json["models"].as_array().unwrap();
    let held_out = |name: &str| {
        let line = models.iter().find(|m| m["model"] == name).unwrap();
        (line["chosen"].as_bool().unwrap(), line["held_out_percent"].as_f64().unwrap())
    };
    let (stops, fixed) = (held_out("Prandtl-Ishlinskii stops"), held_out("static Preisach"));
    assert!(stops.0 && !fixed.0, "{models:?}");
    assert!(stops.1 < 50.0 && fixed.1 > 80.0, "{stops:?} {fixed:?}");
    let text = place.hhc(&[&args[..], &["--details"]].concat()).done();
    assert!(text.contains("friction does"), "{text}");
    assert!(text.contains("Model written to damper.ron"), "{text}");
    // the path of the data may be called anything
    for line in text.lines().filter(|line| !line.starts_with("Data ")) {
        for foreign in ["volt", " V ", "Actuator", "actuator", "flap"] {
            assert!(!line.contains(foreign), "{foreign}: {line}");
        }
    }
    let model = place.read("damper.ron");
    assert!(model.contains("// Model of displacement_in to friction_force_kip"), "{model}");
    assert!(model.contains("PrandtlStop("), "{model}");
    place.hhc(&["check", "damper.ron"]).done();
}

/// A structure written by another program: `SciPy`, compressed, little-endian.
#[test]
fn a_mat_file_of_another_program() {
    let place = Place::new();
    let file = measured("../mat/bench_struct.mat");
    let columns = "time_ms=t,command_V=u,displacement_um=x";
    let args = ["import", &file, "--variable", "bench.run(2)", "--columns", columns, "-o", "d"];
    let text = place.hhc(&args).done();
    assert!(text.contains("MAT file, bench.run(2): t, u, x of 400 samples"), "{text}");
    assert!(text.contains("400 samples, step 0.001 s"), "{text}");
    place.hhc(&["check", "d"]).done();
    place.hhc(&["import", &file, "-o", "e"]).rejected(&[
        "`bench` is a structure without vectors of one length; the file has: bench.run(1).t 400x1",
    ]);
}

/// A generic loop goes the whole way: identified in its own units, figures' data beside it.
#[test]
fn a_generic_loop_is_identified_in_its_own_units() {
    let place = Place::new();
    crate::place::write_bench(&place, "bench");
    for id in ["slow", "one_large", "one_small", "five"] {
        let text = place.read(&format!("bench/{id}.csv"));
        let text = text.replacen("command_V,displacement_um", "field_Oe,moment_emu", 1);
        place.write(&format!("loops/{id}.csv"), &text);
    }
    let dataset = place.read("bench/dataset.ron");
    let dataset = dataset
        .replace("ActuatorBench", "GenericLoop")
        .replace("    command_range_V: (-20, 150),\n", "");
    place.write("loops/dataset.ron", &dataset);
    let args = ["identify", "loops", "-o", "model.ron", "--figures", "figures", "--format", "json"];
    let json = place.hhc(&args).json();
    assert_eq!(json["channels"]["output"], "moment_emu");
    assert_eq!(json["range_rule"], "from the smallest to the largest input of all runs");
    assert_eq!(json["zero_deg"], 0.0, "zero output stays where it was recorded");
    for run in json["runs"].as_array().unwrap() {
        assert!(run["nrmse_percent"].as_f64().unwrap() < 10.0, "{run}");
    }
    let text = place.hhc(&[&args[..4], &["--details"]].concat()).done();
    assert!(text.contains("Model  field_Oe to moment_emu, field_Oe -15 to 145 (from"), "{text}");
    let figures = place.listing().into_iter().filter(|f| f.starts_with("figures/"));
    let expected = [
        "density",
        "loop_five",
        "loop_one_large",
        "loop_one_small",
        "loop_slow",
        "residual_spectrum",
        "static_density",
    ];
    assert!(figures.eq(expected.map(|f| format!("figures/{f}.csv"))));
    let table = place.read("figures/loop_five.csv");
    let mut lines = table.lines();
    assert_eq!(
        lines.next().unwrap(),
        "time_s,field_Oe,measured_moment_emu,simulated_moment_emu,residual_emu,judged"
    );
    for line in lines {
        let v: Vec<f64> = line.split(',').map(|f| f.parse().unwrap()).collect();
        assert!((v[2] - v[3] - v[4]).abs() < 1e-3 * v[4].abs() + 1e-6, "{line}");
    }
    assert!(
        place
            .read("figures/density.csv")
            .starts_with("half_width_field_Oe,centre_field_Oe,rise_emu,density\n")
    );
    // it is a model, but no actuator
    place.hhc(&["check", "model.ron"]).done();
    place.write("case.ron", "(actuator: (model: File(path: \"model.ron\")))");
    place
        .hhc(&["run", "case.ron"])
        .rejected(&["a model from field_Oe to moment_emu: a case needs an actuator"]);
}
