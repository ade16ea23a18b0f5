//! Manners of the command: one word for an error, one run, nothing written unasked, standard input, the units of the data.
#![expect(clippy::disallowed_methods, reason = "a file is piped into the program")]

use crate::place::{Place, write_bench};
use std::fmt::Write;
use std::process::{Command, Stdio};

#[test]
fn families_to_fit_can_be_named() {
    let place = Place::new();
    write_bench(&place, "bench");
    let only = |names: &str| {
        place.hhc(&["identify", "bench", "-o", "a.ron", "--format", "json", "--only", names])
    };
    let json = only("static-preisach,bouc-wen").json();
    let models = json["models"].as_array().unwrap();
    let names: Vec<&str> = models.iter().map(|own| own["model"].as_str().unwrap()).collect();
    // the simplest first, however they are named
    assert_eq!(names, ["Bouc-Wen", "static Preisach"]);
    assert!(names.contains(&json["model"].as_str().unwrap()), "{}", json["model"]);
    only("spline").rejected(&["bouc-wen", "static-preisach-relaxation"]);
    only("best").rejected(&["bouc-wen"]);
    let args = ["identify", "bench", "-o", "b.ron", "--only", "bouc-wen", "--model", "linear"];
    place.hhc(&args).rejected(&["error: --only", "leaves out the model to judge, linear gain"]);
}

#[test]
fn one_run_is_a_run_and_its_command_may_come_from_a_pipe() {
    let place = Place::new();
    write_bench(&place, "bench");
    let head = "kind: ActuatorBench, title: \"t\", command_range_V: (-20, 150)";
    // the window ends where the sample after the last one would be
    let run = "(id: \"slow\", file: \"slow.csv\", role: Reference, window_s: (0, 20.02))";
    place.write("bench/dataset.ron", &format!("({head}, runs: [{run}])"));
    let told = place.hhc(&["check", "bench"]).done();
    assert!(told.contains("t: 1 run, 1001 samples"), "{told}");
    let told = place.hhc(&["identify", "bench", "-o", "a.ron", "--only", "static-preisach"]).done();
    assert!(told.contains("1 run, NRMSE") && !told.contains("1 runs"), "{told}");
    assert!(place.hhc(&["check", "a.ron"]).done().contains(", 1 run)"));
    let late = run.replace("20.02", "20.05");
    place.write("bench/dataset.ron", &format!("({head}, runs: [{late}])"));
    place.hhc(&["check", "bench"]).rejected(&["error: bench/dataset.ron", "the window (0, 20.05)"]);
    let from_file = place.hhc(&["predict", "a.ron", "--input", "bench/slow.csv"]).done();
    let record = std::fs::File::open(place.path().join("bench/slow.csv")).unwrap();
    let piped = Command::new(env!("CARGO_BIN_EXE_hhc"))
        .args(["predict", "a.ron", "--input", "-"])
        .current_dir(place.path())
        .stdin(Stdio::from(record))
        .output()
        .unwrap();
    let piped = String::from_utf8(piped.stdout).unwrap();
    assert_eq!(piped, from_file.replace("bench/slow.csv", "standard input"));
}

#[test]
fn what_is_clipped_is_told_in_the_unit_of_the_data_and_runs_are_sorted() {
    let place = Place::new();
    let mut runs = String::new();
    for (id, hz, most) in [("fast", 5.0, 1e3), ("a_slow", 0.5, 120.0), ("b_slow", 0.5, 1e3)] {
        let mut text = "time_s,command_V,displacement_um\n".to_owned();
        for i in 0..3000_u32 {
            let t = 0.002 * f64::from(i);
            let turned = (std::f64::consts::TAU * hz * t).sin();
            let u = 65.0 + if id == "b_slow" { 30.0 } else { 70.0 } * turned;
            writeln!(text, "{t:.3},{u:.4},{:.4}", f64::min(2.5 * (u - 65.0), most)).unwrap();
        }
        place.write(&format!("bench/{id}.csv"), &text);
        writeln!(runs, "(id: \"{id}\", file: \"{id}.csv\", role: Reference),").unwrap();
    }
    let head =
        "kind: ActuatorBench, title: \"t\", command_range_V: (-20, 150), flap_deg_per_um: 0.04";
    place.write("bench/dataset.ron", &format!("({head}, runs: [{runs}])"));
    let args = ["identify", "bench", "-o", "a.ron", "--only", "bouc-wen", "--details"];
    let told = place.hhc(&args).done();
    assert!(told.contains("record a_slow: the output rests at 120.0000 um for"), "{told}");
    // sorted by frequency and amplitude, whatever the order of the data
    let place_of = |id: &str| told.find(&format!("\n {id} ")).unwrap();
    assert!(place_of("b_slow") < place_of("a_slow") && place_of("a_slow") < place_of("fast"));
    assert!(told.contains("MATLAB's fit is 100 % less that"), "{told}");
}
