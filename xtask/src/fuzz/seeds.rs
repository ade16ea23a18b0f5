//! Valid inputs that no fixture holds.

use std::fmt::Write as _;

use serde_json::json;

/// A case of two flaps with a T of its own, and the field in it that names the file.
pub(super) const T_CASE: &str = "(actuator: (model: Ideal), \
     control: (t_file: \"t.json\", harmonics: [[3]], actuators: [Ideal]))";
pub(super) const T_FILE: &str = "t.json";

/// Points, controls and loads of a T.
const POINTS: [&str; 2] = ["mu_0.2000", "mu_0.3000"];
const CONTROLS: [&str; 4] = [
    "flap1_3_per_rev_cos_V",
    "flap1_3_per_rev_sin_V",
    "flap2_3_per_rev_cos_V",
    "flap2_3_per_rev_sin_V",
];
const LOADS: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// Labels and units of the loads of a T.
fn loads() -> impl Iterator<Item = (String, &'static str)> {
    LOADS.iter().enumerate().flat_map(|(k, load)| {
        let unit = if k < 3 { "m0 Omega^2 R^2" } else { "m0 Omega^2 R^3" };
        ["cos", "sin"].map(|part| (format!("{load}_4_per_rev_{part}"), unit))
    })
}

/// A T at two advance ratios as JSON and as CSV.
pub(super) fn t_files() -> Vec<Vec<u8>> {
    let mut csv = format!("point,load,unit,{}\n", CONTROLS.join(","));
    for point in POINTS {
        for (k, (load, unit)) in loads().enumerate() {
            let _ = writeln!(csv, "{point},{load},{unit},1e-4,{k}e-5,-2e-4,0.5");
        }
    }
    let (labels, units): (Vec<String>, Vec<&str>) = loads().unzip();
    let rows = vec![vec![[1e-4, 2e-4]; CONTROLS.len()]; labels.len()];
    let axis = |name: &str, labels: &[&str], unit: &str| json!({"name": name, "labels": labels, "units": vec![unit; labels.len()]});
    let load = json!({"name": "load", "labels": labels, "units": units});
    let points = axis("point", &POINTS, "");
    let condition = axis("condition", &["advance_ratio", "thrust_share"], "");
    let arrays = json!([
        {"name": "T_3", "meaning": "m", "axes": [load, axis("control", &CONTROLS, "V"), points], "values": rows},
        {"name": "conditions", "axes": [condition, points], "values": [[0.2, 0.3], [0.0, 0.0]]},
    ]);
    vec![json!({ "arrays": arrays }).to_string().into_bytes(), csv.into_bytes()]
}

/// An actuator with plays, and records for it: voltage with what was measured, and a motion that is wanted.
pub(super) const PLAYS: &str = "(kind: Actuator, title: \"plays\", model: (law: PrandtlIshlinskii(range_volt: (-20, 150), \
     gain_deg_per_volt: 0.05, plays: [(threshold_volt: 10, weight_deg_per_volt: 0.02)]), range_volt: (-20, 150), \
     calibration: (deg_per_um: 0.04, zero_um: 0)))";

/// A record of a slow cycle: `columns` behind the time are a voltage, or an angle of a hundredth of it.
pub(super) fn record(columns: &[(&str, f64)]) -> Vec<u8> {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut text = format!("time_s,{}\n", names.join(","));
    for k in 0..24 {
        let phase = std::f64::consts::TAU * f64::from(k) / 12.0;
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, amplitude)| format!("{:.4}", amplitude * (1.0 + phase.sin())))
            .collect();
        let _ = writeln!(text, "{:.3},{}", 0.01 * f64::from(k), cells.join(","));
    }
    text.into_bytes()
}
