//! A laboratory's own recordings: what is said of each at once, and what is refused instead of ignored.

use crate::place::{Place, write_bench};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A record of command and displacement, 1000 samples a second: the displacement follows through a play of 12 V.
fn recorded(seconds: f64, command: impl Fn(f64) -> f64, output: impl Fn(f64) -> f64) -> String {
    let mut text = "time_s,command_V,displacement_um\n".to_owned();
    let mut followed = command(0.0);
    let mut time = 0.0;
    for i in 0_u32.. {
        if time >= seconds {
            break;
        }
        let u = command(time);
        followed = followed.clamp(u - 12.0, u + 12.0);
        let y = output(2.3 * (0.6 * u + 0.4 * followed)) + 0.1 * (7919.0 * f64::from(i)).sin();
        writeln!(text, "{time:.3},{u:.5},{y:.5}").unwrap();
        time = 1e-3 * f64::from(i + 1);
    }
    text
}

/// After a rest of 0.3 s, cycles of 1 Hz.
fn sine(t: f64) -> f64 {
    70.0 + 60.0 * (TAU * (t - 0.3).max(0.0)).sin()
}

/// 1 Hz, a rest of 2 s, then 5 Hz at a third of the amplitude.
fn two_runs(t: f64) -> f64 {
    match t {
        t if t < 4.0 => 70.0 + 60.0 * (TAU * t).sin(),
        t if t < 6.0 => 70.0,
        t => 70.0 + 20.0 * (TAU * 5.0 * (t - 6.0)).sin(),
    }
}

#[test]
fn each_run_is_seen_at_a_glance() {
    let place = Place::new();
    place.write("good.csv", &recorded(4.3, sine, |y| y));
    place.write("inverted.csv", &recorded(4.3, sine, |y| -y));
    let ms = recorded(4.3, sine, |y| y);
    let ms: String = ms
        .lines()
        .map(|line| match line.split_once(',') {
            Some((time, rest)) if time != "time_s" => {
                format!("{},{rest}\n", 1e3 * time.parse::<f64>().unwrap())
            }
            _ => format!("{line}\n"),
        })
        .collect();
    place.write("ms.csv", &ms);
    let seen = |name: &str| {
        let ran = place.hhc(&["import", &format!("{name}.csv"), "-o", &format!("{name}_data")]);
        let (err, out) = (ran.err.clone(), ran.done());
        (out.lines().find(|line| line.starts_with("  ")).unwrap().trim().to_owned(), err)
    };
    let (line, err) = seen("good");
    assert!(line.starts_with("sine 1 Hz, 4 cycles, 60 V about 70 V; 2.17 um/V, lag "), "{line}");
    assert!(line.ends_with("; 4.3 s") && line.contains("; rest 0.3"), "{line}");
    assert!(err.is_empty(), "{err}");
    let (line, err) = seen("inverted");
    assert!(line.contains("; -2.17 um/V"), "{line}");
    assert!(err.contains("the output falls as the command rises"), "{err}");
    let (line, _) = seen("ms");
    assert!(line.starts_with("sine 0.001 Hz") && line.ends_with("4300 s"), "{line}");
    let json = place.hhc(&["import", "good.csv", "-o", "j", "--format", "json"]).json();
    assert_eq!(json["glances"][0]["signal"], "sine");
}

#[test]
fn factors_and_offsets_are_applied_and_noted() {
    let place = Place::new();
    let text = recorded(4.3, |t| sine(t) / 15.0, |y| 15.0 * y / 100.0 + 3.0);
    place.write("a.csv", &text);
    let ran = place.hhc(&["import", "a.csv", "-o", "plain"]);
    assert!(
        ran.err.contains("no command exceeds 8.66") && ran.err.contains("--scale"),
        "{}",
        ran.err
    );
    ran.done();
    let err = place.hhc(&["check", "plain"]).err;
    assert!(err.contains("no command exceeds 8.66"), "{err}");
    let scale = ["--scale", "command=15,displacement=100", "--offset", "displacement=-300"];
    let ran = place.hhc(&[&["import", "a.csv", "-o", "b"], &scale[..]].concat());
    assert!(!ran.err.contains("no command"), "{}", ran.err);
    let text = ran.done();
    assert!(text.contains("60 V about 70 V"), "{text}");
    let written = place.read("b/dataset.ron");
    let note = "a.csv, every sample, command x 15, displacement x 100, displacement -300";
    assert!(written.contains(note), "{written}");
    for (args, part) in [
        (&["--scale", "command"][..], "the entry `command` of --scale is not understood"),
        (&["--offset", "force=1"], "the column `force` is missing"),
        (
            &["--convert", "command_V=15"],
            "--convert would have no effect: this is an actuator bench",
        ),
        (
            &["--sampling-hz", "100"],
            "--sampling-hz would have no effect: the file has a time column",
        ),
        (&["--variable", "x"], "--variable would have no effect: this is a text table"),
    ] {
        place.hhc(&[&["import", "a.csv", "-o", "c"], args].concat()).rejected(&[part]);
    }
}

/// What a recorder always needs, once in a file.
#[test]
fn a_mapping_stands_for_the_options() {
    let place = Place::new();
    let text = recorded(4.3, |t| sine(t) / 15.0, |y| 15.0 * y / 100.0 + 3.0);
    place.write("a.csv", &text.replacen("time_s,command_V,displacement_um", "t,Mon,Laser", 1));
    let map = "(columns: [
        (name: \"time_s\", from: \"t\"),
        (name: \"command_V\", from: \"Mon\", scale: 15),
        (name: \"displacement_um\", from: \"Laser\", scale: 100, offset: -300),
    ])";
    place.write("map.ron", map);
    let text = place.hhc(&["import", "a.csv", "--mapping", "map.ron", "-o", "b"]).done();
    assert!(text.contains("60 V about 70 V"), "{text}");
    place.write("map.ron", &map.replace("Laser", "Lidar"));
    place.hhc(&["import", "a.csv", "--mapping", "map.ron", "-o", "c"]).rejected(&[
        "map.ron:4:",
        "columns[2].from: is refused: names the column `Lidar`, which a.csv does not have",
    ]);
    place.hhc(&["import", "a.csv", "--mapping", "gone.ron", "-o", "c"]).rejected(&["gone.ron"]);
}

#[test]
fn runs_in_one_file_have_their_own_period() {
    let place = Place::new();
    place.write("two.csv", &recorded(10.0, two_runs, |y| y));
    let ran = place.hhc(&["import", "two.csv", "-o", "one"]);
    assert!(ran.err.contains("several runs in one record"), "{}", ran.err);
    ran.done();
    let args = ["import", "two.csv", "-o", "d", "--split", "--arm-mm", "1.45"];
    let ran = place.hhc(&args);
    assert!(!ran.err.contains("several runs"), "{}", ran.err);
    let text = ran.done();
    assert!(
        text.contains("sine 1 Hz, 4 cycles, 60 V") && text.contains("sine 5 Hz, 20 cycles, 20 V"),
        "{text}"
    );
    // 1 um on a lever of 1.45 mm
    assert!(place.read("d/dataset.ron").contains("flap_deg_per_um: 0.039514"));
    let json = place.hhc(&["identify", "d", "-o", "a.ron", "--format", "json"]).json();
    for (run, hz, amplitude) in [(0, 1.0, 60.0), (1, 5.0, 20.0)] {
        let run = &json["runs"][run];
        assert!((run["frequency_hz"].as_f64().unwrap() / hz - 1.0).abs() < 0.01, "{run}");
        assert!((run["amplitude_V"].as_f64().unwrap() / amplitude - 1.0).abs() < 0.01, "{run}");
    }
    // the time begins again
    let again = recorded(4.0, sine, |y| y);
    let body = again.split_once('\n').unwrap().1.to_owned();
    place.write("again.csv", &format!("{again}{body}"));
    place.hhc(&["import", "again.csv", "-o", "e"]).rejected(&["time_s"]);
    place.hhc(&["import", "again.csv", "-o", "e", "--split"]).done();
    assert!(place.listing().contains(&"e/again_2.csv".to_owned()));
}

/// Runs of one file are judged each in its window, and beside one another, at import and by identify.
#[test]
fn runs_of_one_file_are_held_against_each_other() {
    let place = Place::new();
    // the second run, a third as large, is cut off below the first one's top
    let cut = |t: f64, y: f64| if t > 5.0 { y.min(190.0) } else { y };
    let mut text = String::new();
    for (i, line) in recorded(10.0, two_runs, |y| y).lines().enumerate() {
        let (start, um) = line.rsplit_once(',').unwrap();
        let um = match um.parse::<f64>() {
            Ok(um) if i > 0 => format!("{:.5}", cut(1e-3 * (i - 1) as f64, um)),
            _ => um.to_owned(),
        };
        writeln!(text, "{start},{um}").unwrap();
    }
    place.write("two.csv", &text);
    let err = place.hhc(&["import", "two.csv", "-o", "cut", "--split"]).err;
    assert!(err.contains("record two_2: the output rests at 190.0"), "{err}");
    assert!(!err.contains("record two: the output rests"), "{err}");
    assert!(err.contains("record two_2: its output rests at 190 um, which two passes"), "{err}");
    let err = place.hhc(&["identify", "cut", "-o", "cut.ron", "--model", "linear"]).err;
    assert!(err.contains("record two_2: its output rests at 190 um, which two passes"), "{err}");
    // the sensor was turned round between two records of one file
    let one = recorded(4.0, sine, |y| y);
    let turned = recorded(4.0, sine, |y| -y);
    place.write("turned.csv", &(one + turned.split_once('\n').unwrap().1));
    let err = place.hhc(&["import", "turned.csv", "-o", "turned", "--split"]).err;
    assert!(err.contains("falls as the command rises in turned_2, and rises in turned"), "{err}");
}

#[test]
fn a_gain_that_nothing_gives_is_said() {
    let place = Place::new();
    write_bench(&place, "bench");
    let check = place.hhc(&["check", "bench"]);
    assert!(check.err.contains("flap_deg_per_um: is not given: 0.0"), "{}", check.err);
    let args = ["identify", "bench", "-o", "a.ron", "--model", "bouc-wen"];
    let identified = place.hhc(&args);
    assert!(identified.err.contains("deg/um makes the"), "{}", identified.err);
    identified.done();
    assert!(place.hhc(&["check", "a.ron"]).err.contains("makes the widest slow loop"));
    let text = place.read("bench/dataset.ron");
    let given =
        text.replace("    command_range_V", "    flap_deg_per_um: 0.04,\n    command_range_V");
    place.write("bench/dataset.ron", &given);
    assert!(place.hhc(&["check", "bench"]).err.is_empty());
    assert!(place.hhc(&args).err.is_empty());
}

#[test]
fn identify_replaces_actuator_files_only() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.write("case.ron", "(title: \"mine, by hand\")");
    let to = |name: &'static str| ["identify", "bench", "-o", name, "--model", "linear"];
    place
        .hhc(&to("case.ron"))
        .rejected(&["case.ron exists already and is no file of kind Actuator", "--force"]);
    assert_eq!(place.read("case.ron"), "(title: \"mine, by hand\")");
    place.hhc(&to("a.ron")).done();
    place.hhc(&to("a.ron")).done();
    place.hhc(&[&to("case.ron")[..], &["--force"]].concat()).done();
    assert!(place.read("case.ron").contains("kind: Actuator"));
    // without -o: the name of the folder, where nothing else is
    let unnamed = ["identify", "bench", "--model", "linear"];
    place.hhc(&unnamed).done();
    assert!(place.read("bench.ron").contains("kind: Actuator"));
    place.hhc(&unnamed).done();
    place.write("bench.html", "mine");
    place
        .hhc(&unnamed)
        .rejected(&["bench.html exists already and is no file of kind page of hhc", "--force"]);
    place.write("bench.ron", "(title: \"mine, by hand\")");
    place.hhc(&unnamed).rejected(&["bench.ron exists already and is no file of kind Actuator"]);
    assert_eq!(place.read("bench.ron"), "(title: \"mine, by hand\")");
}

#[test]
fn a_record_at_rest_is_data() {
    let place = Place::new();
    write_bench(&place, "bench");
    let hum = |time: f64| 0.3 * (TAU * 50.0 * time).sin();
    let mut rest = "time_s,command_V,displacement_um\n".to_owned();
    for i in 0..4000 {
        let time = 1e-3 * f64::from(i);
        writeln!(rest, "{time:.3},65,{:.5}", hum(time) + 0.1 * (7919.0 * f64::from(i)).sin())
            .unwrap();
    }
    place.write("bench/rest.csv", &rest);
    let text = place.read("bench/dataset.ron");
    let more = "runs: [\n        (id: \"rest\", file: \"rest.csv\", role: Reference),";
    place.write("bench/dataset.ron", &text.replace("runs: [", more));
    let args = ["identify", "bench", "-o", "a.ron", "--format", "json"];
    let json = place.hhc(&args).json();
    let told = json["findings"].as_array().unwrap().iter().map(|line| line["message"].to_string());
    let told: Vec<String> = told.filter(|text| text.contains("record rest is at rest")).collect();
    assert!(told.len() == 1 && told[0].contains("at 50 Hz"), "{json}");
    let ids: Vec<&str> =
        json["runs"].as_array().unwrap().iter().map(|run| run["id"].as_str().unwrap()).collect();
    assert_eq!(ids, ["slow", "one_large", "one_small", "five"]);
    // a wrong column: the command stands still while the output moves
    let slow = place.read("bench/slow.csv");
    let still: String = slow
        .lines()
        .enumerate()
        .map(|(i, line)| {
            let cells: Vec<&str> = line.split(',').collect();
            if i == 0 { format!("{line}\n") } else { format!("{},65,{}\n", cells[0], cells[2]) }
        })
        .collect();
    place.write("bench/rest.csv", &still);
    place.hhc(&args).rejected(&[
        "rest.csv:2:1: command_V: every sample is 65 V, while the output moves through",
    ]);
}

/// Rests alone go in; that no model can come of them is said where one is asked for.
#[test]
fn rests_alone_go_in_and_identify_nothing() {
    let place = Place::new();
    let noise = |i: u32| 120.0 + 0.3 * (7919.0 * f64::from(i)).sin();
    let row = |i: u32, volt: f64| format!("{:.3},{volt},{:.5}\n", 1e-3 * f64::from(i), noise(i));
    let rest = |volt: f64| -> String {
        let rows = (0..2000).map(|i| row(i, volt));
        std::iter::once("time_s,command_V,displacement_um\n".to_owned()).chain(rows).collect()
    };
    place.write("low.csv", &rest(65.0));
    place.write("high.csv", &rest(400.0));
    let ran = place.hhc(&["import", "low.csv", "high.csv", "-o", "rests"]);
    let said = "low.csv:2:1: command_V: every sample is 65 V, as in every other record";
    assert!(ran.err.contains(said), "{}", ran.err);
    let text = ran.done();
    assert!(text.contains("at rest 65 V; noise 0.2") && text.contains("at rest 400 V"), "{text}");
    let check = place.hhc(&["check", "rests"]);
    assert!(check.err.contains("as in every other record"), "{}", check.err);
    check.done();
    let before = place.listing();
    let missing =
        ["runs", "the input rests in every record (low, high)", "a slow sine or triangle"];
    place.hhc(&["identify", "rests", "-o", "a.ron"]).rejected(&missing);
    assert_eq!(place.listing(), before);
    // the same of any two channels
    let plain = rest(65.0).replacen("command_V,displacement_um", "current_A,force_N", 1);
    place.write("force.csv", &plain);
    place.hhc(&["import", "force.csv", "-o", "loops"]).done();
    place.hhc(&["check", "loops"]).done();
    place.hhc(&["identify", "loops", "-o", "b.ron"]).rejected(&missing[2..]);
    // beside records that move
    place.hhc(&["diagnose", "a.ron", "--data", "rests", "-o", "out"]).rejected(&["a.ron"]);
}

/// A bench by hand whose range is that of another actuator: what to write is said, and works at the first try.
#[test]
fn an_actuator_of_another_range_is_told_its_range() {
    let place = Place::new();
    let written = |name: &str, text: &str, volts: f64| {
        let rows = text.lines().skip(1).map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{},{:.3},{}\n", cells[0], volts * cells[1], cells[2])
        });
        let head = std::iter::once("time_s,command_V,displacement_um\n".to_owned());
        place.write(&format!("bench/{name}"), &head.chain(rows).collect::<String>());
    };
    let dataset = |range: &str| {
        let text = format!(
            "(kind: ActuatorBench, title: \"t\", runs: [(id: \"small\", file: \"small.csv\", role: Reference), (id: \"large\", file: \"large.csv\", role: Reference)]{range})"
        );
        place.write("bench/dataset.ron", &text);
    };
    // 100 to 1300 V, and 28 times that of a common stack
    for (volts, range, given) in [(10.0, "(100, 1300)", ""), (40.0, "(400, 5200)", "")] {
        written("small.csv", &recorded(2.0, |t| 70.0 + 5.0 * (TAU * t).sin(), |y| y), volts);
        written("large.csv", &recorded(4.0, |t| 70.0 + 60.0 * (TAU * t).sin(), |y| y), volts);
        dataset(given);
        let err = place.hhc(&["check", "bench"]).rejected(&[
            "bench/small.csv:2:1: command_V: the command ",
            "which stands for the one that dataset.ron does not give",
            &format!("the records need `command_range_V: {range}` or more in dataset.ron"),
            "Beyond it: small, large",
        ]);
        assert!(!err.contains("mV") && err.lines().count() < 4, "{err}");
        dataset(&format!(", command_range_V: {range}"));
        place.hhc(&["check", "bench"]).done();
    }
}

/// A ceramic driven through its coercive field: the strain is even in the voltage, and no model here is.
#[test]
fn a_butterfly_is_called_so() {
    let place = Place::new();
    let mut text = "t / ms,U / V,s / mm\n".to_owned();
    for i in 0..4000 {
        let (sin, cos) = (TAU * 1e-3 * f64::from(i)).sin_cos();
        let volt = 1500.0 * sin;
        // the polarisation switches at +-600 V, on the way up and on the way down
        let polarisation = ((volt - 600.0_f64.copysign(cos)) / 150.0).tanh();
        let strain = polarisation.powi(2) + 4e-4 * volt * polarisation;
        writeln!(text, "{i},{volt:.3},{:.7}", 0.02 * strain).unwrap();
    }
    place.write("butterfly.csv", &text);
    let ran = place.hhc(&["import", "butterfly.csv"]);
    let said = "record butterfly: the output runs through two cycles in each cycle of the input";
    assert!(ran.err.contains(said), "{}", ran.err);
    let text = ran.done();
    assert!(text.contains("sine 1 Hz, 4 cycles, 1500 V"), "{text}");
    place.hhc(&["identify", "butterfly"]).failed(
        2,
        &["a butterfly", "No model here holds one", "one wing of it", "set command_range_V"],
    );
}

/// Quotients of the standards as headers, symbols of quantities that are those of units too.
#[test]
fn headers_of_the_standards_are_read() {
    let place = Place::new();
    let body = recorded(4.0, sine, |y| y);
    let body = body.split_once('\n').unwrap().1;
    place.write("din.csv", &format!("t / s,U / V,s / um\n{body}"));
    place.hhc(&["import", "din.csv", "-o", "din"]).done();
    let head = "time_s,command_V,displacement_um\n";
    assert!(place.read("din/din.csv").starts_with(head), "{}", place.read("din/din.csv"));
    // what is not known is asked for in a way that works as it stands
    place.write("odd.csv", &format!("t / s,U / V,Weg\n{body}"));
    let err = place.hhc(&["import", "odd.csv", "-o", "odd"]).rejected(&["`Weg` has no known unit"]);
    let (_, remedy) = err.split_once("--columns '").unwrap();
    let (remedy, _) = remedy.split_once('\'').unwrap();
    assert_eq!(remedy, "t_s=#1,command_V=#2,displacement_um=Weg");
    place.hhc(&["import", "odd.csv", "-o", "odd", "--columns", remedy]).done();
    assert_eq!(place.read("odd/odd.csv"), place.read("din/din.csv"));
}

/// A laser reads the same motion from a tenth of a metre away.
#[test]
fn an_offset_of_the_sensor_changes_no_result() {
    let place = Place::new();
    write_bench(&place, "bench");
    let args =
        ["identify", "bench", "-o", "a.ron", "--model", "static-preisach", "--format", "json"];
    let errors = |json: serde_json::Value| -> Vec<f64> {
        json["runs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|r| r["nrmse_percent"].as_f64().unwrap())
            .collect()
    };
    let near = errors(place.hhc(&args).json());
    for id in ["slow", "one_large", "one_small", "five"] {
        let name = format!("bench/{id}.csv");
        let text = place.read(&name);
        let away: String = text
            .lines()
            .enumerate()
            .map(|(i, line)| match line.rsplit_once(',') {
                Some((start, um)) if i > 0 => {
                    format!("{start},{:.5}\n", um.parse::<f64>().unwrap() + 1e5)
                }
                _ => format!("{line}\n"),
            })
            .collect();
        place.write(&name, &away);
    }
    let away = errors(place.hhc(&args).json());
    for (a, b) in near.iter().zip(&away) {
        assert!((a - b).abs() < 2e-3 * a, "{near:?} {away:?}");
    }
}
