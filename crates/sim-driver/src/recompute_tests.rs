//! A result as a run writes it, tampered with in every place.

use super::*;
use crate::case::{
    ActuatorChoice, ControlActuator, EffortChoice, LoadScaleChoice, PAPER_CASE, StrokeChoice,
    TrimFile, WindTunnelTrimFile, read_case, shipped_case,
};
use crate::files::{Folder, Source, ron_text};
use crate::progress::Progress;
use crate::run::run_case;
use crate::study::{RobustnessCell, Sensitivity, SensitivityRecord};
use rayon::prelude::*;
use std::sync::OnceLock;

/// A small rotor under ideal control within limits, with rows of the other tables beside.
fn example() -> &'static StoredResult<RunResult> {
    static STORED: OnceLock<StoredResult<RunResult>> = OnceLock::new();
    STORED.get_or_init(|| {
        let mut file = shipped_case(PAPER_CASE).unwrap().file;
        file.actuator.model = ActuatorChoice::Ideal;
        file.trim = TrimFile::WindTunnel(WindTunnelTrimFile::default());
        file.structure.elements = 4;
        file.structure.modes.flap = 2;
        file.structure.modes.lag = 1;
        file.structure.modes.torsion = 1;
        file.control.harmonics = vec![vec![3]];
        file.control.actuators = vec![ControlActuator::Ideal];
        file.control.stroke_limit = StrokeChoice::Given { amplitude_deg: 1.0 };
        file.control.effort = EffortChoice::Limits;
        file.control.load_scale = LoadScaleChoice::Baseline;
        let text = ron_text(&file).unwrap();
        let source = Source { name: "example.ron".to_owned(), text };
        let loaded = read_case(&source, &Folder::Shipped(String::new())).unwrap();
        let mut result = run_case(&loaded, &Progress::hidden()).unwrap().result;
        let baseline = result.baseline.hub_nb_per_rev;
        let after = result.control[0].hub_nb_per_rev;
        let named = |id: &str, record| Sensitivity {
            id: id.to_owned(),
            compared_with: "case".to_owned(),
            record,
            ..Sensitivity::default()
        };
        let record = |hub| Some(SensitivityRecord { baseline, hub_nb_per_rev: vec![hub] });
        result.sensitivity =
            vec![named("case", record(after)), named("wake-free", record(baseline))];
        result.robustness =
            vec![RobustnessCell { end: after, best: after, ..RobustnessCell::default() }];
        let setting = Setting::of_case(&loaded.case, &baseline);
        StoredResult::new(&loaded.file, vec![], result.refigured(&setting)).unwrap()
    })
}

fn tampered(change: impl Fn(&mut Value)) -> Result<Recomputed, SimError> {
    let mut value = serde_json::to_value(example()).unwrap();
    change(&mut value);
    recomputed(serde_json::from_value(value).unwrap(), "result.json")
}

#[test]
fn a_result_as_written_is_reproduced_to_the_bit() {
    let found = tampered(|_| ()).unwrap();
    assert_eq!(found.reductions, 1 + 2 + 2);
    assert!(found.numbers > 300, "{}", found.numbers);
    assert!(found.largest_difference.abs() < 1e-15);
    assert_eq!(&found.stored, example());
}

#[test]
fn every_kind_of_figure_that_is_changed_is_named() {
    let line = "/result/control/0";
    let figures = [
        "j_before",
        "j_after",
        "reduction_percent",
        "actuation_power_W",
        "load_weights/3",
        "kkt_residual",
        "t_norm_per_V",
        "steps",
        "largest_mean_flap_deg",
        "flaps/0/flap_amplitude_deg",
        "flaps/1/flap_phase_deg",
        "flaps/1/lead_over_inboard_deg",
        "flaps/0/mean_flap_deg",
        "flaps/0/bias_V",
        "flaps/0/peak_hinge_moment_N_m",
        "flaps/1/actuation_power_W",
        "flaps/1/net_actuation_power_W",
        "flaps/0/voltage_amplitude_V",
        "flaps/0/lag_deg",
        "history/1/j_loads",
    ]
    .map(|field| format!("{line}/{field}"));
    let tables = [
        "/result/mean_loads/shaft_power_W",
        "/result/mean_loads/cq_sigma",
        "/result/mean_loads/hub_force_N/2",
        "/result/sensitivity/0/reduction_percent/0",
        "/result/sensitivity/1/largest_change",
        "/result/robustness/0/reduction_percent",
        "/result/robustness/0/best_percent",
    ];
    for pointer in figures.iter().map(String::as_str).chain(tables) {
        let found = tampered(|value| {
            let place = value.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}"));
            *place = match place.as_u64() {
                Some(count) => (count + 1).into(),
                None => (1.001 * place.as_f64().unwrap() + 1e-6).into(),
            };
        });
        let Err(SimError::NotReproduced { file, field, .. }) = found else {
            panic!("{pointer}: {found:?}")
        };
        let last = pointer.rsplit('/').find(|part| part.parse::<usize>().is_err()).unwrap();
        assert!(file == "result.json" && field.contains(last), "{pointer}: {field}");
    }
}

/// What figures are computed from cannot be changed alone either.
#[test]
fn a_raw_number_that_is_changed_shows_in_its_figures() {
    let raw = [
        ("/result/control/0/hub_nb_per_rev/fz/0", "j_loads"),
        ("/result/baseline/hub_nb_per_rev/mx/1", "j_loads"),
        ("/result/control/0/record/flaps/0/flap_deg/5", "actuation_power_W"),
        ("/result/control/0/record/flaps/1/voltage_V/0", "flaps[1]"),
        ("/result/control/0/record/flaps/1/aerodynamic_moment/5", "actuation_power_W"),
        ("/result/control/0/record/t_per_V/1/2", "kkt_residual"),
        ("/result/control/0/record/optimum/hessian/0/0", "hessian"),
        ("/result/control/0/history/1/loads/4", "loads"),
        ("/result/sensitivity/1/record/baseline/fz/1", "sensitivity"),
        ("/result/robustness/0/end/fx/0", "robustness"),
        ("/result/mean_loads/hub/5", "mean_loads"),
    ];
    for (pointer, figure) in raw {
        let found = tampered(|value| {
            let place = value.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}"));
            *place = (1.01 * place.as_f64().unwrap() + 1e-7).into();
        });
        let Err(SimError::NotReproduced { field, .. }) = found else {
            panic!("{pointer}: {found:?}")
        };
        assert!(field.contains(figure), "{pointer}: {field}");
    }
}

#[test]
fn weights_scaled_together_with_the_costs_do_not_pass() {
    let found = tampered(|value| {
        let line = &mut value["result"]["control"][0];
        for k in 0..6 {
            line["load_weights"][k] = (2.0 * line["load_weights"][k].as_f64().unwrap()).into();
        }
        for name in ["j_before", "j_after"] {
            line[name] = (2.0 * line[name].as_f64().unwrap()).into();
        }
    });
    assert!(matches!(found, Err(SimError::NotReproduced { .. })), "{found:?}");
    // nor does another definition of the weights in the case
    let found = tampered(|value| value["case"]["control"]["load_scale"] = "Nondimensional".into());
    let Err(SimError::NotReproduced { field, .. }) = found else { panic!("{found:?}") };
    assert!(field.contains("key"), "{field}");
}

#[test]
fn a_changed_cell_of_a_table_is_named() {
    let table = "set,flap,deg\n3,0,1.5\n3,1,2.5\n";
    assert!(compared_table(table, table, "a.csv").is_ok());
    let found = compared_table("set,flap,deg\n3,0,1.5\n3,1,2.6\n", table, "a.csv");
    let text = found.unwrap_err().to_string();
    assert!(text.contains("a.csv: line 3 deg is 2.6") && text.contains("gives 2.5"), "{text}");
    assert!(compared_table("set,flap,deg\n3,0,1.5\n", table, "a.csv").is_err());
    // a comma in a name parts no cells
    let named = "assumption,a,b\n\"wake, near\",1,2\n";
    let found = compared_table("assumption,a,b\n\"wake, near\",9,2\n", named, "a.csv");
    let text = found.unwrap_err().to_string();
    assert!(text.contains("line 2 a is 9"), "{text}");
}

/// A small rotor in every part of a study: four actuators, T about the control, limits.
fn study() -> &'static (StoredResult<RunResult>, StudyReport) {
    static STORED: OnceLock<(StoredResult<RunResult>, StudyReport)> = OnceLock::new();
    STORED.get_or_init(|| {
        let mut file = shipped_case(PAPER_CASE).unwrap().file;
        file.trim = TrimFile::WindTunnel(WindTunnelTrimFile::default());
        file.structure.elements = 4;
        file.structure.modes.flap = 2;
        file.structure.modes.lag = 1;
        file.structure.modes.torsion = 1;
        file.control.harmonics = vec![vec![3]];
        file.control.actuators = vec![
            ControlActuator::Ideal,
            ControlActuator::Ignored,
            ControlActuator::Hysteretic,
            ControlActuator::Inverse,
        ];
        let text = ron_text(&file).unwrap();
        let source = Source { name: "study.ron".to_owned(), text };
        let loaded = read_case(&source, &Folder::Shipped(crate::files::SHIPPED_CASES.to_owned()));
        let loaded = loaded.unwrap();
        let outcome = run_case(&loaded, &Progress::hidden()).unwrap();
        let mut page = crate::study::page_part(&loaded, &outcome).unwrap();
        // one loop of the bench and a few samples stand for all
        page.loops.truncate(1);
        for chart in &mut page.loops {
            for samples in [
                &mut chart.voltage_volt,
                &mut chart.measured_deg,
                &mut chart.simulated_deg,
                &mut chart.static_deg,
            ] {
                samples.truncate(10);
            }
        }
        let inputs = outcome.actuators.inputs.clone();
        let mut stored = StoredResult::new(&loaded.file, inputs, outcome.result).unwrap();
        stored.page_key = Some(page.key().unwrap());
        let shown = study_report(&stored, page);
        (stored, shown)
    })
}

/// Every number in a tree, by its place.
fn numbers_of(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at.to_owned()),
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                numbers_of(item, &format!("{at}/{k}"), found);
            }
        }
        Value::Object(fields) => {
            for (name, item) in fields {
                numbers_of(item, &format!("{at}/{name}"), found);
            }
        }
        _ => {}
    }
}

/// The same tree with one number changed.
fn with_one_changed(value: &Value, pointer: &str) -> Value {
    let mut changed = value.clone();
    let place = changed.pointer_mut(pointer).unwrap();
    *place = match (place.as_u64(), place.as_f64()) {
        (Some(count), _) => (count + 1).into(),
        (None, Some(number)) => (1.001 * number + 1e-6).into(),
        _ => panic!("no number at {pointer}"),
    };
    changed
}

/// Numbers of a tree that can be changed one by one without the check noticing.
fn unnoticed(value: &Value, passes: impl Fn(Value) -> bool + Sync) -> (usize, Vec<String>) {
    let mut all = Vec::new();
    numbers_of(value, "", &mut all);
    let free = all.par_iter().filter(|pointer| passes(with_one_changed(value, pointer)));
    (all.len(), free.cloned().collect())
}

/// Change any number of what a report shows, and it is refused.
#[test]
fn every_number_that_a_report_shows_is_checked() {
    let (stored, shown) = study();
    assert!(reproduced(shown, stored.clone()).is_ok());
    let key = stored.page_key.as_ref().unwrap();
    let follows = serde_json::to_value(study_report(stored, PagePart::of(shown))).unwrap();
    let passes = |value: Value| {
        let Ok(shown) = serde_json::from_value::<StudyReport>(value.clone()) else { return false };
        // what `reproduced` does after the result itself, which is not changed here: with the page as keyed, the
        // report is the one that follows
        PagePart::of(&shown).key().unwrap() == *key
            && compared_fields(&value, &follows, ("a", "report")).is_ok()
    };
    let (count, free) = unnoticed(&serde_json::to_value(shown).unwrap(), passes);
    println!("{count} numbers");
    assert!(count > 1000 && free.is_empty(), "{free:?}");
}

/// Change any number of a stored result, and it is refused.
#[test]
fn every_number_of_a_result_is_checked() {
    let (stored, _) = study();
    let passes = |value: Value| {
        let Ok(stored) = serde_json::from_value::<StoredResult<RunResult>>(value) else {
            return false;
        };
        recomputed(stored, "a").is_ok()
    };
    let (count, free) = unnoticed(&serde_json::to_value(stored).unwrap(), passes);
    println!("{count} numbers");
    assert!(count > 1000 && free.is_empty(), "{free:?}");
}

/// Even with the key made again, a figure of the control that is changed does not pass: it follows from what else is
/// stored. Only what is itself measured or solved for, and no figure follows from, is left to the key.
#[test]
fn no_figure_of_the_control_rests_on_the_key_alone() {
    let (stored, _) = study();
    let measured = [
        // the flight, the residuals and the loads of the blade, none of them a figure of the control
        "/trim/",
        "/residuals/",
        "/blade_loads/",
        "/stability/",
        // states on the way, whose loads and controls are what the costs and steps beside them are computed from
        "/mean_flap_deg/",
        "/loads/",
        "/control_V/",
        "/history/",
        // raw numbers behind several figures, changed where none of these is rounded to them
        "/record/",
        "/hub_nb_per_rev/",
    ];
    let passes = |value: Value| {
        let Ok(result) = serde_json::from_value::<RunResult>(value) else { return false };
        let setting = Setting::of_file(&stored.case, &result.baseline.hub_nb_per_rev).unwrap();
        compared_fields(&result, &result.refigured(&setting), ("a", "result")).is_ok()
    };
    let (_, free) = unnoticed(&serde_json::to_value(&stored.result).unwrap(), passes);
    let figures: Vec<&String> =
        free.iter().filter(|at| !measured.iter().any(|part| at.contains(part))).collect();
    assert!(figures.is_empty(), "{figures:?}");
    // and of the raw numbers those of T, of the control and of the certificate are bound to each other
    let bound =
        ["record/control_V", "optimum/hessian", "optimum/linear", "optimum/scale_V", "end/asked_V"];
    let loose: Vec<&String> = free
        .iter()
        .filter(|at| at.contains("/record/") && bound.iter().any(|part| at.contains(part)))
        .collect();
    assert!(loose.is_empty(), "{loose:?}");
    // of the history its figures, its start and its end are
    let ends = ["j_loads", "j_control", "asked_V", "halvings", "history/0/"];
    let loose: Vec<&String> = free
        .iter()
        .filter(|at| at.contains("/history/") && ends.iter().any(|part| at.contains(part)))
        .filter(|at| !at.contains("history/0/loads") && !at.contains("history/0/mean_flap"))
        .collect();
    assert!(loose.is_empty(), "{loose:?}");
}

/// Names are figures too.
#[test]
fn a_name_that_is_changed_is_refused() {
    let (stored, _) = study();
    for (pointer, name) in [
        ("/result/control/2/outcome", "stalled"),
        ("/result/control/2/controller", "local"),
        ("/result/control/2/actuator", "ideal"),
        ("/result/control/0/outcome", "taken-over"),
        ("/program", "hhc 9"),
    ] {
        let mut value = serde_json::to_value(stored).unwrap();
        let place = value.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}"));
        assert_ne!(place.as_str().unwrap(), name);
        *place = name.into();
        let found = recomputed(serde_json::from_value(value).unwrap(), "a");
        // another version canonises in its own way; the shown report names the program as well
        assert!(found.is_err() || pointer == "/program", "{pointer}");
    }
    let mut value = serde_json::to_value(stored).unwrap();
    value["result"]["control"][0]["within_reach"] = false.into();
    assert!(recomputed(serde_json::from_value(value).unwrap(), "a").is_err());
    let mut value = serde_json::to_value(stored).unwrap();
    value["result"]["control"].as_array_mut().unwrap().pop();
    assert!(recomputed(serde_json::from_value(value).unwrap(), "a").is_err());
}

/// In hover there is nothing to reduce: no percentage of rounding, and no remedy for it.
#[test]
fn a_rotor_without_vibration_has_no_percentages() {
    let stored = example();
    let mut result = stored.result.clone();
    let still = crate::results::HubLoads::from_parts([4e-8; 12]);
    result.baseline.hub_nb_per_rev = still;
    result.control[0].hub_nb_per_rev = crate::results::HubLoads::from_parts([5e-8; 12]);
    let setting = Setting::of_file(&stored.case, &still).unwrap();
    // weights over the baseline are not made of rounding either
    assert!(setting.load_weights().iter().all(|weight| *weight <= 1.0));
    let result = result.refigured(&setting);
    assert_eq!(result.control[0].reduction_percent.to_bits(), 0.0_f64.to_bits());
    assert!(result.warnings.iter().any(|text| text.contains("nothing to reduce")));
    let text = crate::output::Printable::text(&result);
    assert!(text.contains("no vibration without control"), "{text}");
    let row = text.lines().find(|line| line.contains("ideal")).unwrap();
    assert!(row.matches(" - ").count() >= 8, "{row}");
}

/// The report says of each harmonic which assumption moves it most, rows being compared by their ids.
#[test]
fn the_assumption_that_moves_most_is_named() {
    let row = |id: &str, to: &str, reductions: &[f64]| Sensitivity {
        id: id.to_owned(),
        assumption: format!("text of {id}"),
        compared_with: to.to_owned(),
        reduction_percent: reductions.to_vec(),
        ..Sensitivity::default()
    };
    let rows = [
        row("case", "case", &[20.0, 60.0]),
        row("twist", "case", &[25.0, 59.0]),
        row("wake-free", "case", &[10.0, 61.0]),
        // 20 points off the free wake, 10 off the case
        row("wake-near", "wake-free", &[30.0, 66.0]),
    ];
    let most = crate::study::most_moved(&rows);
    let named: Vec<(&str, f64)> = most.iter().map(|(row, by)| (row.id.as_str(), *by)).collect();
    assert_eq!(named, [("wake-near", 20.0), ("wake-near", 5.0)]);
}
