//! `hhc predict` and `hhc invert`.

use crate::place::{Place, write_bench};
use std::fmt::Write;
use std::process::Command;

/// A motion that does not repeat, within reach of the bench.
fn motion(column: &str, scale: f64) -> String {
    let rows = (0..400).map(|k| {
        let t = 0.002 * f64::from(k);
        let value = scale * (t / 0.1).min(1.0) * ((40.0 * t).sin() + 0.4 * (93.0 * t).sin());
        format!("{t},{value}\n")
    });
    std::iter::once(format!("time_s,{column}\n")).chain(rows).collect()
}

#[test]
fn the_voltage_of_a_wanted_motion_moves_the_actuator_so() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "a.ron"]).done();
    place.write("wanted.csv", &motion("displacement_um", 20.0));
    let args = ["invert", "a.ron", "--wanted", "wanted.csv", "-o", "volts.csv", "--format", "json"];
    let found = place.hhc(&args).json();
    assert_eq!(found["at_limit"], 0);
    let percent = found["error"]["nrmse_percent"].as_f64().unwrap();
    assert!(percent < 0.1, "{percent}");
    // forward again, on its own: beside what is wanted, under its name
    let head = "time_s,command_V,displacement_um,wanted_displacement_um";
    let volts = place.read("volts.csv");
    assert!(volts.starts_with(head), "{volts:.80}");
    let rows = volts.lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        format!("{},{},{}\n", cells[0], cells[1], cells[3])
    });
    let again: String =
        std::iter::once("time_s,command_V,displacement_um\n".to_owned()).chain(rows).collect();
    place.write("again.csv", &again);
    let predicted =
        place.hhc(&["predict", "a.ron", "--input", "again.csv", "--format", "json"]).json();
    let forward = predicted["error"]["nrmse_percent"].as_f64().unwrap();
    assert!((forward - percent).abs() < 1e-6, "{forward} {percent}");
    // a voltage in proportion to the motion would not do
    let flat: String = motion("command_V", 8.0);
    place.write("flat.csv", &flat);
    let flat = place.hhc(&["predict", "a.ron", "--input", "flat.csv", "-o", "flat_out.csv"]).done();
    assert!(!flat.contains("Error"), "{flat}");
    assert!(place.read("flat_out.csv").starts_with("time_s,command_V,displacement_um\n"));
}

/// The same record as other recorders write it: other units, separators and decimals, no time, a monitor output.
#[test]
fn a_record_may_be_written_as_any_recorder_does() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "a.ron"]).done();
    let (mut plain, mut other, mut untimed) = (
        "time_s,command_V,displacement_um\n".to_owned(),
        "Zeit [ms];Spannung [mV];Weg [mm]\n".to_owned(),
        "monitor_V,displacement_um\n".to_owned(),
    );
    for k in 0..400 {
        let t = 0.002 * f64::from(k);
        let volt = 60.0 + 30.0 * ((40.0 * t).sin() + 0.4 * (93.0 * t).sin());
        let um = 2.0 * volt;
        writeln!(plain, "{t:.3},{volt:.3},{um:.3}").unwrap();
        let row = format!("{:.0};{:.0};{:.6}", 1e3 * t, 1e3 * volt, 1e-3 * um);
        writeln!(other, "{}", row.replace('.', ",")).unwrap();
        writeln!(untimed, "{:.6},{um:.3}", volt / 15.0).unwrap();
    }
    place.write("plain.csv", &plain);
    place.write("other.txt", &other);
    place.write("untimed.csv", &untimed);
    let error = |args: &[&str]| {
        let told =
            place.hhc(&[&["predict", "a.ron", "--format", "json", "--input"], args].concat());
        told.json()["error"]["nrmse_percent"].as_f64().unwrap()
    };
    let expected = error(&["plain.csv"]);
    assert!(expected > 1.0, "{expected}");
    let columns = "command_V=monitor_V,displacement_um=displacement_um";
    let said =
        ["untimed.csv", "--columns", columns, "--scale", "command=15", "--sampling-hz", "500"];
    for args in [&["other.txt"][..], &said] {
        let found = error(args);
        assert!((found - expected).abs() < 1e-3 * expected, "{args:?}: {found} {expected}");
    }
    // whose column the command is
    let told = place.hhc(&["predict", "a.ron", "--input", "other.txt"]).done();
    assert!(told.contains("command_V, read from the column `spannung_mV`"), "{told}");
    assert!(told.contains("displacement_um, read from the column `weg_mm`"), "{told}");
    let told = place.hhc(&["predict", "a.ron", "--input", "plain.csv"]).done();
    assert!(!told.contains("read from"), "{told}");
    let none = ["predict", "a.ron", "--input", "untimed.csv", "--sampling-hz", "0"];
    place.hhc(&none).rejected(&["--sampling-hz", "0 Hz, expected a positive"]);
}

#[test]
fn an_actuator_goes_out_into_other_languages() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "a.ron", "--model", "dynamic-preisach"]).done();
    for (to, names) in [
        ("c", &["flap.c", "flap.h"][..]),
        ("python", &["flap.py"]),
        ("matlab", &["flap.m"]),
        ("json", &["flap.json"]),
    ] {
        let out = format!("out_{to}");
        let args = ["export", "a.ron", "--to", to, "--name", "flap", "--sampling-hz", "1000"];
        let told = place.hhc(&[&args[..], &["-o", &out]].concat()).done();
        for name in names {
            assert!(told.contains(name), "{told}");
            assert!(place.read(&format!("{out}/{name}")).len() > 500, "{name}");
        }
        // what was measured and where: C by the compiler of this computer, of others the original
        let cost = told.lines().find(|line| line.starts_with("Cost of the ")).unwrap();
        let is_compiled = to == "c" && Command::new("cc").arg("--version").output().is_ok();
        let of =
            if is_compiled { "Cost of the C, by cc -O2" } else { "Cost of the actuator in Rust" };
        assert!(cost.starts_with(of) && cost.contains(" ns a sample forward"), "{told}");
        assert_eq!(cost.contains("ns inverse"), is_compiled, "{told}");
        let files = place.listing().into_iter().filter(|name| name.starts_with(&out)).count();
        assert_eq!(files, names.len(), "{:?}", place.listing());
    }
    // without -o: named by file and form, in the working folder
    place.hhc(&["export", "bench/../a.ron", "--to", "json"]).done();
    assert!(place.read("a_json/flap_actuator.json").len() > 500);
    place.hhc(&["export", "a.ron", "--to", "json"]).rejected(&["a_json exists already"]);
    place.hhc(&["export", "a.ron", "--to", "c", "-o", "out_c"]).rejected(&["out_c"]);
    let bad = ["export", "a.ron", "--to", "c", "--name", "2 flaps", "-o", "b"];
    place.hhc(&bad).rejected(&["a.ron", "2 flaps"]);
    let bad = ["export", "a.ron", "--to", "c", "--sampling-hz", "0", "-o", "b"];
    place.hhc(&bad).rejected(&["--sampling-hz: is 0 Hz, expected a positive"]);
}

#[test]
fn records_that_do_not_serve_are_refused_at_their_place() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "a.ron"]).done();
    place.write("far.csv", &motion("displacement_um", 2000.0));
    let far = place.hhc(&["invert", "a.ron", "--wanted", "far.csv"]).done();
    assert!(far.contains("the motion is out of reach"), "{far}");
    let rejected = |name: &str, text: &str, told: &[&str]| {
        place.write(name, text);
        place.hhc(&["predict", "a.ron", "--input", name]).rejected(told);
    };
    rejected(
        "uneven.csv",
        "time_s,command_V\n0,1\n1,2\n3,1\n",
        &["uneven.csv:4:1: time_s", "expected uniform sampling"],
    );
    rejected("one.csv", "time_s,command_V\n0,1\n", &["one.csv: has 1 rows", "at least 3"]);
    let none = [
        "none.csv:1:1: the column `drive` has no known unit",
        "--columns 'time_s=#1,command_V=drive'",
    ];
    rejected("none.csv", "time_s,drive\n0,1\n1,2\n2,3\n", &none);
    // the option that is printed helps at once
    place
        .hhc(&["predict", "a.ron", "--input", "none.csv", "--columns", "time_s=#1,command_V=drive"])
        .done();
    rejected(
        "force.csv",
        "time_s,load_N\n0,1\n1,2\n2,3\n",
        &["force.csv", "`command_V` is missing", "load_N"],
    );
    rejected(
        "high.csv",
        "time_s,command_V\n0,1\n1,2e5\n2,1\n",
        &["high.csv", "200000", "--scale command=FACTOR"],
    );
    // a factor is given to the column by its own name
    rejected("millivolt.csv", "time_s,u_V\n0,1e3\n1,9e4\n2,1e3\n", &["--scale u=FACTOR"]);
    let scaled = ["predict", "a.ron", "--input", "millivolt.csv", "--scale", "u=1e-3"];
    place.hhc(&scaled).done();
    // a voltage that is no command by its name
    for name in ["sensor", "amplifier"] {
        let text = format!("time_s,{name}_V,displacement_um\n0,1,2\n1,2,4\n2,1,2\n");
        let label = format!("{name}_V");
        rejected("other.csv", &text, &["`command_V` is missing", &label, "--columns"]);
        let columns = format!("time_s=#1,command_V={label}");
        place.hhc(&["predict", "a.ron", "--input", "other.csv", "--columns", &columns]).done();
    }
    place
        .hhc(&["predict", "a.ron", "--input", "high.csv", "-o", "high.csv"])
        .rejected(&["is a file this command reads"]);
}

/// The actuator of a loop of any two channels takes its own input, and no command of a bench.
#[test]
fn a_loop_takes_no_command_for_its_input() {
    let place = Place::new();
    let row = |k: u32| {
        let (t, angle) = (0.01 * f64::from(k), 0.02 * f64::from(k));
        format!("{t},{},{}\n", 3.0 * angle.sin(), 0.2 * (angle - 0.1).sin())
    };
    let rows: String = (0..1200).map(row).collect();
    place.write("loops/a.csv", &format!("time_s,current_A,force_N\n{rows}"));
    place.write(
        "loops/dataset.ron",
        r#"(kind: GenericLoop, title: "t", runs: [(id: "a", file: "a.csv", role: Reference)])"#,
    );
    place.hhc(&["identify", "loops", "-o", "a.ron", "--only", "prandtl-plays"]).done();
    place.write("volts.csv", "time_s,command_V,displacement_um\n0,1,2\n1,2,4\n2,1,2\n");
    place.write("own.csv", "time_s,current_mA\n0,1000\n1,2000\n2,1000\n");
    let told = place.hhc(&["predict", "a.ron", "--input", "own.csv"]).done();
    assert!(told.contains("current_A, read from the column `current_mA`: 1 to 2"), "{told}");
    let told = ["`current_A` is missing", "command_V, displacement_um"];
    place.hhc(&["predict", "a.ron", "--input", "volts.csv"]).rejected(&told);
}

/// What an import would say of a record stands beside a prediction: another zero, a spike, an output that falls.
#[test]
fn a_suspect_record_is_told_beside_its_prediction() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.hhc(&["identify", "bench", "-o", "a.ron"]).done();
    place.write("u.csv", &motion("command_V", 8.0));
    place.hhc(&["predict", "a.ron", "--input", "u.csv", "-o", "own.csv"]).done();
    let own = place.read("own.csv");
    let predicted = |um: &dyn Fn(usize, f64) -> f64| {
        let row = |(k, line): (usize, &str)| {
            let (head, last) = line.rsplit_once(',').unwrap();
            last.parse().map_or(format!("{line}\n"), |own| format!("{head},{}\n", um(k, own)))
        };
        place.write("again.csv", &own.lines().enumerate().map(row).collect::<String>());
        place.hhc(&["predict", "a.ron", "--input", "again.csv"]).done()
    };
    let whole = predicted(&|_, um| um);
    assert!(!whole.contains("Offset") && !whole.contains("Suspect"), "{whole}");
    let moved = predicted(&|_, um| um + 30_000.0);
    assert!(moved.contains("Offset") && moved.contains("another zero"), "{moved}");
    let spoilt = predicted(&|k, um| if k == 200 { um + 500.0 } else { um });
    assert!(spoilt.contains("Suspect") && spoilt.contains("spike"), "{spoilt}");
    let falling = predicted(&|_, um| -um);
    assert!(falling.contains("Suspect") && falling.contains("falls"), "{falling}");
}
