//! `hhc identify`: which model is judged and written, and over which samples.

use crate::import::{csv, play};
use crate::place::{Place, write_bench};

/// What happens before a run's window is reported apart: the figures are those of the window.
#[test]
fn a_window_bounds_every_figure() {
    let place = Place::new();
    let rows = play(0.2, 1000);
    // half the output in the first three cycles, a shift of the whole
    let late: Vec<[f64; 3]> =
        rows.iter().map(|&[t, u, y]| [t, u, if t < 6.0 { 0.5 * y } else { y } + 0.25]).collect();
    place.write("d/a.csv", &csv("time_s,field_Oe,moment_emu\n", &rows, [1.0; 3]));
    place.write("d/b.csv", &csv("time_s,field_Oe,moment_emu\n", &late, [1.0; 3]));
    let dataset = |window: &str| {
        format!(
            "(kind: GenericLoop, title: \"t\", runs: [
                (id: \"a\", file: \"a.csv\", role: Reference, use: Train),
                (id: \"b\", file: \"b.csv\", role: Reference, use: HeldOut{window})])"
        )
    };
    let fit = |window: &str| {
        place.write("d/dataset.ron", &dataset(window));
        let args = ["identify", "d", "-o", "m.ron", "--format", "json", "--figures", "f"];
        let json = place.hhc(&args).json();
        let number = |key: &str| json["runs"][1][key].as_f64();
        let judged: Vec<bool> =
            place.read("f/loop_b.csv").lines().skip(1).map(|l| l.ends_with(",1")).collect();
        let keys = ["range_percent", "offset", "amplitude_error_percent"];
        let start_up = number("start_up_percent").zip(number("start_up_rms_percent"));
        (keys.map(|key| number(key).unwrap()), start_up, judged)
    };
    let ([range, offset, amplitude], start_up, judged) = fit(", window_s: (6, 9.99)");
    assert!(range < 1.0 && (offset - 0.25).abs() < 0.01, "{range} {offset}");
    assert!(amplitude.abs() < 1.0, "{amplitude}");
    let (most, rms) = start_up.unwrap();
    assert!(most > 20.0 && rms > 5.0 && rms < 0.9 * most, "{most} {rms}");
    assert_eq!(judged.iter().position(|j| *j), Some(600));
    assert!(judged[600..].iter().all(|j| *j));
    let (whole, start_up, judged) = fit("");
    assert!(whole[0] > 10.0 && whole[2] > 10.0 && start_up.is_none(), "{whole:?} {start_up:?}");
    assert!(judged.iter().all(|j| *j));
}

#[test]
fn the_model_written_is_the_one_judged() {
    let place = Place::new();
    write_bench(&place, "bench");
    let identify = |model: &str| {
        let args = ["identify", "bench", "-o", "a.ron", "--model", model, "--format", "json"];
        (place.hhc(&args).json(), place.read("a.ron"))
    };
    let (best, written) = identify("best");
    assert_eq!(best["picked_by"], "cross-validation");
    let chosen = best["models"].as_array().unwrap().iter().find(|m| m["chosen"] == true).unwrap();
    assert_eq!(chosen["model"], best["model"]);
    assert!(!written.contains("law: Linear("), "{written}");
    let (linear, written) = identify("linear");
    assert_eq!(
        (&linear["picked_by"], &linear["model"]),
        (&"asked-for".into(), &"linear gain".into())
    );
    assert!(written.contains("law: Linear("), "{written}");
    let error = |json: &serde_json::Value| json["runs"][1]["nrmse_percent"].as_f64().unwrap();
    assert!(error(&linear) > 2.0 * error(&best), "{linear} {best}");
    let (dynamic, written) = identify("dynamic-preisach");
    assert!(written.contains("law: DynamicPreisach("), "{written}");
    assert!(dynamic["runs"][0]["nrmse_percent"].as_f64().is_some());
    // stops lead: an actuator that lags cannot be fitted with them
    place
        .hhc(&["identify", "bench", "-o", "b.ron", "--model", "prandtl-stop"])
        .rejected(&["Prandtl-Ishlinskii stops cannot be fitted", "fitted were: linear gain; "]);
    assert!(!place.listing().contains(&"b.ron".to_owned()), "nothing is written");
}

/// One run: blocks in time choose, which is said; the gain that was assumed too.
#[test]
fn what_is_assumed_is_said() {
    let place = Place::new();
    let rows = play(0.2, 1000);
    place.write("d/a.csv", &csv("time_s,command_V,displacement_um\n", &rows, [0.1, 80.0, 200.0]));
    place.write(
        "d/dataset.ron",
        "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"a.csv\", role: Reference)], command_range_V: (-100, 150))",
    );
    let text = place.hhc(&["identify", "d", "-o", "a.ron", "--details"]).done();
    let way = "chosen by blocks in time of the one training run";
    for part in ["ASSUMED: no slow loop to scale by", way, "Left out: blocks in time"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(text.contains("Held-out runs: none"), "{text}");
}
