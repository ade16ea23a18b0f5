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
        let baseline = result.baseline.hub_4_per_rev;
        let after = result.control[0].hub_4_per_rev;
        let record = |hub| Some(SensitivityRecord { baseline, hub_4_per_rev: vec![hub] });
        result.sensitivity = vec![
            Sensitivity { record: record(after), ..Sensitivity::default() },
            Sensitivity { record: record(baseline), ..Sensitivity::default() },
        ];
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
        ("/result/control/0/hub_4_per_rev/fz/0", "j_after"),
        ("/result/baseline/hub_4_per_rev/mx/1", "j_loads"),
        ("/result/control/0/record/flaps/0/flap_deg/5", "actuation_power_W"),
        ("/result/control/0/record/flaps/1/voltage_V/0", "flaps[1]"),
        ("/result/control/0/record/flaps/1/aerodynamic_moment/5", "actuation_power_W"),
        ("/result/control/0/record/t_per_V/1/2", "t_norm"),
        ("/result/control/0/record/optimum/hessian/0/0", "kkt_residual"),
        ("/result/control/0/history/1/loads/4", "j_loads"),
        ("/result/sensitivity/1/record/baseline/fz/1", "sensitivity"),
        ("/result/robustness/0/end/fx/0", "robustness"),
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
