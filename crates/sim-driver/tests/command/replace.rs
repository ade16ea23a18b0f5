//! No command replaces a file that `hhc` did not write, unless it is told to.

use crate::place::{Place, QUICK_CASE, SMALL_WAKE, write_bench};

const MINE: &str = "mine, by hand\n";

/// Runs a command twice: what it wrote is known as its own. Then every file in the way is mine.
pub(crate) fn replaces_its_own_alone(place: &Place, args: &[&str], written: &str) {
    keeps_mine(place, args, written);
    let first = place.listing().into_iter().find(|name| name.starts_with(written)).unwrap();
    place.write(&first, MINE);
    place.hhc(&[args, &["--force"]].concat()).done();
    assert_ne!(place.read(&first), MINE);
}

fn keeps_mine(place: &Place, args: &[&str], written: &str) {
    place.hhc(args).done();
    place.hhc(args).done();
    // of the azimuths of a revolution one stands for all
    let is_asked = |name: &String| !name.contains("azimuth_") || name.contains("azimuth_003");
    let files =
        place.listing().into_iter().filter(|name| name.starts_with(written) && is_asked(name));
    let files: Vec<String> = files.collect();
    assert!(!files.is_empty(), "{written}: {:?}", place.listing());
    for name in &files {
        let own = place.read(name);
        place.write(name, MINE);
        place.hhc(args).rejected(&[name, "exists already and is no file of kind", "--force"]);
        assert_eq!(place.read(name), MINE, "{name}");
        place.write(name, &own);
    }
}

#[test]
fn tables_replace_their_own_alone() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    for (args, written) in [
        (&["modes", "case.ron", "--fan", "fan.csv"][..], "fan.csv"),
        (&["section", "--reduced-frequency", "0.1", "-o", "h.csv"], "h.csv"),
        (&["section", "--response", "step", "-o", "s.csv"], "s.csv"),
        (&["section", "--response", "polar", "-o", "p.csv"], "p.csv"),
    ] {
        replaces_its_own_alone(&place, args, written);
    }
}

/// Without a measurement beside it the table of a prediction looks like a record: only the very same is replaced.
#[test]
fn a_record_is_no_prediction() {
    let place = Place::new();
    write_bench(&place, "bench");
    let identify = ["identify", "bench", "-o", "a.ron", "--model", "linear", "--only", "linear"];
    replaces_its_own_alone(
        &place,
        &[&identify[..], &["--figures", "fig"]].concat(),
        "fig/residual_spectrum",
    );
    replaces_its_own_alone(&place, &identify, "a.");
    // a run with the name of a figure is data: not even --force takes it
    let run = place.read("bench/one_small.csv");
    place.write("bench/residual_spectrum.csv", &run);
    let into_data = [&identify[..], &["--figures", "bench", "--force"]].concat();
    place
        .hhc(&into_data)
        .rejected(&["bench/residual_spectrum.csv", "exists already, in the folder of the data"]);
    assert_eq!(place.read("bench/residual_spectrum.csv"), run);
    std::fs::remove_file(place.path().join("bench/residual_spectrum.csv")).unwrap();
    let record = place.read("bench/one_small.csv");
    let predict = ["predict", "a.ron", "--input", "bench/one_small.csv", "-o", "out.csv"];
    replaces_its_own_alone(&place, &predict, "out.csv");
    let invert = ["invert", "a.ron", "--wanted", "bench/one_small.csv", "-o", "volts.csv"];
    replaces_its_own_alone(&place, &invert, "volts.csv");
    let commands: String = record
        .lines()
        .map(|line| line.rsplit_once(',').map_or(String::new(), |(start, _)| format!("{start}\n")))
        .collect();
    place.write("u.csv", &commands);
    let args = ["predict", "a.ron", "--input", "u.csv", "-o", "bench/slow.csv"];
    let slow = place.read("bench/slow.csv");
    place.hhc(&args).rejected(&["bench/slow.csv exists already and is no file of kind table"]);
    assert_eq!(place.read("bench/slow.csv"), slow);
    replaces_its_own_alone(
        &place,
        &["predict", "a.ron", "--input", "u.csv", "-o", "p.csv"],
        "p.csv",
    );
}

#[test]
fn results_replace_their_own_alone() {
    let place = Place::new();
    let case = |control: &str| QUICK_CASE.replace("    control: (", control);
    let flight = "flight: (duration_s: 3, start_advance_ratio: 0.2, end_advance_ratio: 0.2,
        harmonics: [3], controllers: [Fixed]),\n    control: (";
    place.write("case.ron", &case(flight));
    place.write("free.ron", &QUICK_CASE.replace("Uniform", SMALL_WAKE));
    place.write(
        "many.ron",
        "(base: \"case.ron\", axes: [(field: \"advance_ratio\", values: [0.15, 0.2])])",
    );
    for (args, written) in [
        (&["run", "case.ron", "--out", "run"][..], "run/"),
        (&["report", "run"], "run/report.html"),
        (&["run", "case.ron", "--mu", "0.2", "--out", "mu"], "mu/sweep"),
        (&["fly", "case.ron", "--out", "fly", "--margins", "--draws", "2"], "fly/"),
        (&["compare", "run", "run", "--out", "both"], "both/"),
        (&["wake", "free.ron", "--out", "wake"], "wake/"),
    ] {
        replaces_its_own_alone(&place, args, written);
    }
    // a whole result is not computed again, with --force neither
    keeps_mine(&place, &["run", "case.ron", "--mu", "0.2", "--out", "mu"], "mu/mu_0.2/");
    place.hhc(&["sweep", "run", "many.ron", "--out", "many"]).done();
    replaces_its_own_alone(&place, &["sweep", "merge", "many.ron", "--out", "many"], "many/sweep.");
    replaces_its_own_alone(
        &place,
        &["sweep", "report", "many.ron", "--out", "many"],
        "many/sweep.html",
    );
    // a table of mine with the name of one that this run has not stays
    place.write("run/measured.csv", "quantity,mine\n1,2\n");
    place.hhc(&["run", "case.ron", "--out", "run", "--force"]).done();
    assert_eq!(place.read("run/measured.csv"), "quantity,mine\n1,2\n");
}
