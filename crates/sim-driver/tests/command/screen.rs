//! What the terminal shows fits one screen, the answer first.

use super::import::{csv, play};
use super::place::Place;
use serde_json::Value;

/// Columns and lines of a screen.
const SCREEN: [usize; 2] = [100, 45];

#[track_caller]
fn fits_a_screen(text: &str) {
    let [width, height] = SCREEN;
    assert!(text.lines().count() <= height, "{} lines\n{text}", text.lines().count());
    for line in text.lines() {
        assert!(line.chars().count() <= width, "{} columns: {line}\n{text}", line.chars().count());
    }
}

/// The paper's study as an earlier program stored it, without what takes room: its figures are told on one screen,
/// the paper's beside.
#[test]
fn the_study_is_one_screen_and_results_of_earlier_programs_are_read() {
    let place = Place::new();
    let stored = include_str!("../data/earlier_result/result.json");
    place.write("paper/result.json", stored);
    let text = place.hhc(&["report", "paper"]).done();
    fits_a_screen(&text);
    let row = |name: &str| {
        let after = text.split_once("3/rev").map(|(_, rest)| rest).unwrap();
        let line = after.lines().find(|line| line.contains(name)).unwrap();
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    // as that program printed them
    assert_eq!(row("ideal")[..8], ["ideal", "56.8", "24", "30", "46", "19", "19", "50"]);
    assert_eq!(row("fed back")[2..9], ["57.1", "24", "29", "47", "20", "20", "51"]);
    assert_eq!(row("paper")[..9], ["paper", "78", "43", "38", "67", "28", "34", "50", "41"]);
    for part in ["70.6 / 70.9", "Residuals  trim 5.0e-10", "paper/report.html", "converged"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let json = place.hhc(&["report", "paper", "--format", "json"]).json();
    let earlier: Value = serde_json::from_str(stored).unwrap();
    for (now, then) in json["control"]
        .as_array()
        .unwrap()
        .iter()
        .zip(earlier["result"]["control"].as_array().unwrap())
    {
        for key in ["j_before", "j_after", "reduction_percent"] {
            assert_eq!(now[key], then[key], "{key}");
        }
        assert_eq!(now["backtracks"], then["halvings"]);
        assert_eq!(now["status"], then["outcome"]);
    }
    let details = place.hhc(&["report", "paper", "--details"]).done();
    for head in ["backtracks", "overshoot %", "contraction", "spectral radius", "status"] {
        assert!(details.contains(head), "no `{head}` in\n{details}");
    }
    place.write("paper/result.json", &stored.replacen("\"theta0_deg\":8", "\"theta0_deg\":9", 1));
    place.hhc(&["report", "paper"]).failed(3, &["result.json", "result_key"]);
}

#[test]
fn an_identification_is_one_screen() {
    let place = Place::new();
    let rows = play(0.2, 1000);
    place.write("d/a.csv", &csv("time_s,command_V,displacement_um\n", &rows, [0.1, 80.0, 200.0]));
    place.write(
        "d/dataset.ron",
        "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"a.csv\", role: Reference)], command_range_V: (-100, 150))",
    );
    let text = place.hhc(&["identify", "d", "-o", "a.ron"]).done();
    fits_a_screen(&text);
    for part in ["ASSUMED: no slow loop to scale by", "Held out   no run", "a.ron"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
}
