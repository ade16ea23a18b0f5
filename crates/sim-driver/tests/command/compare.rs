//! Two results side by side.

use crate::place::{Place, QUICK_CASE};

/// A place with the quick case run into the folder `a`.
fn with_a() -> Place {
    let place = Place::new();
    place.write("a.ron", QUICK_CASE);
    place.hhc(&["run", "a.ron", "--out", "a"]).done();
    place
}

/// A cell of `compare.csv`: A 2, its phase 3, B 4, its phase 5, difference 6, vector 7, counted behind the name.
fn cell(csv: &str, name: &str, per_rev: &str, column: usize) -> f64 {
    let rows = csv.lines().filter_map(|line| line.strip_prefix(&format!("\"{name}\",")));
    let mut rows = rows.map(|rest| rest.split(',').collect::<Vec<_>>());
    rows.find(|row| row[1] == per_rev).unwrap()[column].parse().unwrap()
}

#[test]
fn a_result_differs_from_itself_by_nothing() {
    let place = with_a();
    let text = place.hhc(&["compare", "a", "a/result.json", "--out", "both"]).done();
    assert!(text.contains("What differs in the cases. Nothing."), "{text}");
    let csv = place.read("both/compare.csv");
    // trim, thrust, power and J twice; means of 15 curves; six loads; ten harmonics of each curve
    assert_eq!(csv.lines().count() - 1, 9 + 2 + 15 + 6 + 150);
    for line in csv.lines().skip(1) {
        let (_, cells) = line.rsplit_once('"').unwrap();
        let cells: Vec<&str> = cells.split(',').collect();
        for difference in [cells[7], cells[8]].iter().filter(|cell| !cell.is_empty()) {
            assert!(difference.parse::<f64>().unwrap().abs() == 0.0, "{line}");
        }
    }
    assert!(cell(&csv, "FZ", "4", 2) > 0.0);
    let page = place.read("both/compare.html");
    let charts = page.rsplit_once("const charts").unwrap().1;
    // forces, moments, four airloads at each of three stations, three motions of the tip
    assert_eq!(charts.matches("\"name\":\"A\"").count(), 2 + 4 * 3 + 3);
    assert_eq!(charts.matches("\"name\":\"B\"").count(), 2 + 4 * 3 + 3);
}

/// More thrust: its field is named, and the mean vertical force grows as it.
#[test]
fn one_changed_field_is_named_and_its_loads_change() {
    let place = with_a();
    place.write("b.ron", &QUICK_CASE.replace("ct_sigma: 0.07", "ct_sigma: 0.08"));
    let text = place.hhc(&["compare", "a", "b.ron", "--out", "both"]).done();
    let listed = text.split_once("field").unwrap().1.split_once("\n\n").unwrap().0;
    let rows: Vec<Vec<&str>> =
        listed.lines().skip(1).map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(rows, [["trim.ct_sigma", "0.07", "0.08"]], "{text}");
    let csv = place.read("both/compare.csv");
    let force = |column| cell(&csv, "mean vertical force", "", column);
    assert!((force(4) / force(2) - 8.0 / 7.0).abs() < 1e-6, "{} {}", force(2), force(4));
    assert!((force(6) - (force(4) - force(2))).abs() < 1e-9 * force(2));
    // the vector of the difference by the two harmonics themselves
    let parts = |column| {
        let (size, phase) = (cell(&csv, "FZ", "4", column), cell(&csv, "FZ", "4", column + 1));
        let phase = f64::to_radians(phase);
        [size * phase.cos(), size * phase.sin()]
    };
    let (a, b) = (parts(2), parts(4));
    let vector = (b[0] - a[0]).hypot(b[1] - a[1]);
    assert!((cell(&csv, "FZ", "4", 7) / vector - 1.0).abs() < 1e-9 && vector > 0.0);
    // airloads where the lift is: more of them
    assert!(cell(&csv, "mean of cn_m2 at 0.75 R", "0", 6) > 0.0);
    let details = place.hhc(&["compare", "a", "b.ron", "--details"]).done();
    assert!(details.contains("elastic_twist_deg at tip"), "{details}");
    let json = place.hhc(&["compare", "a", "b.ron", "--format", "json"]).json();
    assert_eq!(json["fields"][0]["field"], "trim.ct_sigma");
}

#[test]
fn what_cannot_be_compared_is_named() {
    let place = with_a();
    place.write(
        "five.ron",
        &QUICK_CASE.replace("advance_ratio", "rotor: (blades: 5), advance_ratio"),
    );
    let parts = ["five.ron: case.rotor.blades: is 5, that of a is 4", "compare rotors of the same"];
    place.hhc(&["compare", "a", "five.ron", "--out", "both"]).rejected(&parts);
    place.write("empty/note.txt", "");
    place
        .hhc(&["compare", "a", "empty"])
        .rejected(&["empty: holds no result.json", "hhc run CASE"]);
    place.hhc(&["compare", "none.ron", "a"]).rejected(&["none.ron: cannot be read"]);
    // a result of before holds no airloads: the rest is compared
    place.write("old/result.json", include_str!("../data/earlier_result/result.json"));
    let text = place.hhc(&["compare", "a", "old"]).done();
    assert!(text.contains("note: B (old) holds no airloads"), "{text}");
    assert!(!place.listing().iter().any(|name| name.starts_with("both")), "nothing is written");
    // a field that one has and the other leaves out, and a control of one alone
    let other = QUICK_CASE.replace("harmonics: [[3]]", "harmonics: [[2]], step_tolerance: 1e-3");
    place.write("other.ron", &other.replace("(elements", "(basis: Completed, elements"));
    let json = place.hhc(&["compare", "a", "other.ron", "--format", "json"]).json();
    let fields = json["fields"].as_array().unwrap();
    let basis = fields.iter().find(|change| change["field"] == "structure.basis").unwrap();
    assert_eq!([&basis["a"], &basis["b"]], ["left out", "Completed"]);
    let notes = json["notes"].as_array().unwrap();
    assert!(notes.iter().any(|note| note == "J, flaps at 3/rev, ideal: in A alone"), "{notes:?}");
    assert!(notes.iter().any(|note| note == "J, flaps at 2/rev, ideal: in B alone"), "{notes:?}");
}
