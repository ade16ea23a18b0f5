//! What control costs, from outside: tables, files, report, and what is said where the case does not give it.

use crate::place::{Place, QUICK_CASE};

#[test]
fn costs_are_told_tabled_and_drawn() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let told = place.hhc(&["run", "case.ron", "--out", "o", "--details"]).done();
    for part in [
        "What control costs: flaps and their actuators",
        "What control costs: loads at the root of the blade",
        "What a fall of J costs: actuation power",
        "What a fall of J costs: torsion at the root",
        "No capacitance given",
    ] {
        assert!(told.contains(part), "no `{part}` in\n{told}");
    }
    let costs = place.read("o/costs.csv");
    assert!(costs.starts_with("per_rev,actuator,of,quantity,unit,without_control,with_control\n"));
    assert!(costs.contains("3,ideal,root torsion,half_peak_to_peak,N m,"), "{costs}");
    assert!(!costs.contains("apparent"), "{costs}");
    let fronts = place.read("o/fronts.csv");
    let ratios: Vec<f64> = fronts
        .lines()
        .filter(|line| line.starts_with("3,actuation power,"))
        .map(|line| line.split(',').nth(3).unwrap().parse().unwrap())
        .collect();
    assert!(ratios.len() > 8 && (ratios[0] - 1.0).abs() < 1e-15, "{ratios:?}");
    // the first point is no control; from there J falls
    assert!(ratios[1..].windows(2).all(|pair| pair[1] < pair[0]), "{ratios:?}");
    let page = place.read("o/report.html");
    assert!(page.contains("What a fall of J costs") && page.contains("J against actuation power"));
    // made again from the stored numbers: the same bytes
    let before = [costs, fronts, page];
    place.hhc(&["report", "o"]).done();
    let after = ["o/costs.csv", "o/fronts.csv", "o/report.html"].map(|name| place.read(name));
    assert!(before == after);
    // with a capacitance there is power, of an actuator without a loop no loss
    let given = "actuator: (model: Ideal, capacitance_uF: 2.5)";
    place.write("given.ron", &QUICK_CASE.replace("actuator: (model: Ideal)", given));
    let told = place.hhc(&["run", "given.ron", "--out", "g", "--details"]).done();
    assert!(told.contains("apparent VA") && !told.contains("No capacitance given"), "{told}");
    let costs = place.read("g/costs.csv");
    assert!(costs.contains("apparent_power,VA,") && !costs.contains("hysteresis_loss"), "{costs}");
}

/// A bias that is held is that of the result, and what makes no sense beside it is refused at its line.
#[test]
fn a_held_bias_is_in_the_result() {
    let place = Place::new();
    let held = "control: (bias: Fixed(60), amplitude_V: 70,";
    place.write("case.ron", &QUICK_CASE.replace("control: (", held));
    let json = place.hhc(&["run", "case.ron", "--out", "o", "--format", "json"]).json();
    let bias = json["control"][0]["flaps"][0]["bias_V"].as_f64().unwrap();
    assert!((bias - 60.0).abs() < 1e-12, "{bias}");
    let twice = "control: (bias: Fixed(60), bias_V: 50, amplitude_V: 70,";
    place.write("twice.ron", &QUICK_CASE.replace("control: (", twice));
    place.hhc(&["check", "twice.ron"]).rejected(&["twice.ron:9", "bias_V", "is of no use beside"]);
}
