//! Measured data of a user's own case: what is printed and written, and what is refused.

use crate::place::{Place, QUICK_CASE};
use std::fmt::Write;

/// A case with measured data in a folder beside it.
fn with_measured(measured: &str) -> String {
    QUICK_CASE.trim_end().trim_end_matches(')').to_owned()
        + &format!("    measured: {measured},\n)\n")
}

/// The rows of a table of the command: azimuth in deg and one other column.
fn curve(text: &str, station_r: Option<&str>, column: &str) -> Vec<(f64, f64)> {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let place = |name: &str| header.iter().position(|own| *own == name).unwrap();
    let of_station = |row: &Vec<&str>| station_r.is_none_or(|station| row[0] == station);
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    lines
        .filter(of_station)
        .map(|row| (number(row[place("azimuth_deg")]), number(row[place(column)])))
        .collect()
}

/// A cell of `measured.csv`: measured 4, computed 5, agreement 6.
fn figure(csv: &str, quantity: &str, name: &str, per_rev: &str, column: usize) -> Option<f64> {
    let row = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let row = row.into_iter().find(|r| r[0] == quantity && r[2] == name && r[3] == per_rev);
    row.unwrap()[column].parse().ok()
}

/// A rotor, a flight and files that the program does not know: the measured airload is the computed one of 0.6 R with
/// another mean and a pulse on the advancing side, the tip moves as computed, in a table of several flights.
#[test]
fn a_case_of_the_user_is_compared_with_the_users_files() {
    let place = Place::new();
    place.write(
        "case.ron",
        &QUICK_CASE.replace("control:", "response: (load_stations_r: [0.6]), control:"),
    );
    place.hhc(&["run", "case.ron", "--out", "before"]).done();
    let airload = curve(&place.read("before/airloads.csv"), Some("0.6"), "cn_m2");
    let mut table = "# own measurement\nazimuth_deg,cn_m2\n".to_owned();
    for (psi, value) in &airload {
        let pulse = 0.02 * (-((psi - 55.0) / 1.5).powi(2)).exp();
        let _ = writeln!(table, "{psi},{}", value + 0.01 + pulse);
    }
    place.write("data/section.csv", &table);
    let mut table = "case,azimuth_deg,tip_deflection_percent_r\n".to_owned();
    for (psi, value) in
        curve(&place.read("before/tip.csv"), None, "flap_percent_r").iter().step_by(15)
    {
        let _ = writeln!(table, "first,{psi},{value}\nsecond,{psi},{}", value + 1.0);
    }
    place.write("data/tip.csv", &table);
    place.write(
        "case.ron",
        &with_measured(
            "(airloads: [(station_r: 0.6, file: \"data/section.csv\")], tip: [(file: \"data/tip.csv\", case: \"second\")])",
        ),
    );
    let text = place.hhc(&["run", "case.ron", "--out", "out"]).done();
    for part in ["Measured against computed", "cn_m2 at 0.6 R", "data/tip.csv, second"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let csv = place.read("out/measured.csv");
    let of = |quantity, name, per_rev, column| figure(&csv, quantity, name, per_rev, column);
    let [measured, computed] = [4, 5].map(|column| of("cn_m2", "mean", "0", column).unwrap());
    // the pulse has a mean of its own, 0.02 sqrt(pi) 1.5 / 360
    assert!((measured - computed - 0.010_148).abs() < 2e-6, "{measured} {computed}");
    assert!(of("cn_m2", "correlation", "1-6", 6).unwrap() > 0.999);
    let peak = of("cn_m2", "peak_azimuth_advancing_deg", ">10", 4).unwrap();
    assert!((peak - 55.0).abs() < 1e-9, "{peak}");
    let [with, without] =
        [4, 5].map(|column| of("cn_m2", "peak_to_peak_advancing", ">10", column).unwrap());
    assert!(with > without + 0.015, "{with} {without}");
    // the tip of the second flight stands 1 % of R higher, and moves as computed
    assert!((of("flap_percent_r", "distance", "", 6).unwrap() - 1.0).abs() < 1e-3);
    assert!(of("flap_percent_r", "correlation", "1-6", 6).unwrap() > 0.999_999);
    assert_eq!(of("flap_percent_r", "peak_to_peak_advancing", ">10", 4), None);
    let page = place.read("out/report.html");
    let chart = page.rsplit_once("const charts").unwrap().1;
    assert_eq!(chart.matches("\"name\":\"measured\"").count(), 2, "a figure for each curve");
    assert_eq!(chart.matches("\"name\":\"computed\"").count(), 2);
    // the stored result tells the same
    assert_eq!(place.hhc(&["report", "out"]).done(), text);
    place.hhc(&["run", "case.ron", "--out", "sweep", "--mu", "0.1"]).done();
    assert!(!place.listing().contains(&"sweep/mu_0.1/measured.csv".to_owned()), "another flight");
}

#[test]
fn a_fault_of_a_measured_file_has_its_place_and_remedy() {
    let rows = |step: f64| {
        let rows = (0..24).map(|i| format!("{},{i}", step * f64::from(i)));
        rows.collect::<Vec<_>>().join("\n") + "\n"
    };
    let (tip, in_rad) = (rows(15.0), rows(0.26));
    let good = format!("azimuth_deg,flap_percent_r\n{tip}");
    let harmonics = "per_rev,cn_cos,cn_sin\n0,1,0\n1,1,1\n3,1,1\n";
    let one = |file: &str| format!("(tip: [(file: \"{file}\")])");
    let airload = |station: &str| format!("(airloads: [(station_r: {station}, file: \"m.csv\")])");
    for (measured, text, parts) in [
        (
            one("none.csv"),
            good.clone(),
            ["case.ron:10", "measured.tip[0].file", "names the file none.csv"],
        ),
        (
            one(""),
            good.clone(),
            ["case.ron:10", "measured.tip[0].file", "is empty; give a CSV file"],
        ),
        (
            one("m.csv"),
            good.replace("30,2", "30,x"),
            ["m.csv:4:4", "flap_percent_r", "is not a number"],
        ),
        (
            one("m.csv"),
            good.replace("30,2", "900,2"),
            ["m.csv:4: azimuth_deg", "is 900 deg", "expected -360 to 720"],
        ),
        (
            one("m.csv"),
            good.replace("flap", "flop"),
            ["m.csv:1:13", "flop_percent_r", "did you mean `flap_percent_r`"],
        ),
        (
            one("m.csv"),
            format!("azimuth_deg,flap_percent_r\n{in_rad}"),
            ["m.csv:2: azimuth_deg", "in deg", "whole revolution"],
        ),
        (
            airload("0.8"),
            good.clone(),
            ["m.csv:1:13", "flap_percent_r", "known here: case, azimuth_deg, per_rev, cn_m2"],
        ),
        (
            airload("0.8"),
            harmonics.to_owned(),
            ["m.csv:4: per_rev", "the row of 2/rev is missing", "each once"],
        ),
        (
            airload("0.8"),
            "per_rev\n0\n1\n2\n".to_owned(),
            ["m.csv:1:1", "`cn_m2_cos` or `cm_m2_cos`", "at least one"],
        ),
        (
            airload("0.1"),
            "azimuth_deg,cn\n".to_owned() + &tip,
            ["case.ron:10", "measured.airloads[0].station_r", "expected 0.2 to 1"],
        ),
    ] {
        let place = Place::new();
        place.write("case.ron", &with_measured(&measured));
        place.write("m.csv", &text);
        place.hhc(&["check", "case.ron"]).rejected(&parts);
        place.hhc(&["run", "case.ron", "--out", "out"]).rejected(&parts);
        assert_eq!(place.listing(), ["case.ron", "m.csv"], "nothing is written");
    }
}

#[test]
fn vortices_without_a_wake_are_said_to_be_compared_with_nothing() {
    let place = Place::new();
    place.write("case.ron", &with_measured("(vortex_centres: [(file: \"v.csv\")])"));
    place.write("v.csv", "azimuth_deg,x_m,y_m,z_m\n10,1,1,0\n20,1,2,0\n30,1,2,0\n");
    place.write(
        "w.csv",
        "data_point,azimuth_deg,x_hub_m,y_hub_m,z_hub_m\n7,10,1,1,0\n8,20,1,2,0\n8,30,1,2,0\n",
    );
    place.write("w.ron", &with_measured("(vortex_centres: [(file: \"w.csv\")])"));
    place.hhc(&["check", "w.ron"]).done();
    place.write("w.csv", "azimuth_deg,x_hub_m,y_hub_m\n10,1,1\n20,1,2\n30,1,2\n");
    place.hhc(&["check", "w.ron"]).rejected(&["w.csv:1:1", "`z_hub_m` is missing"]);
    let ran = place.hhc(&["run", "case.ron", "--out", "out"]);
    assert!(ran.err.contains("measured.vortex_centres"), "{}", ran.err);
    ran.done();
}
