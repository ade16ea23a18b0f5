//! The text files beside the records: `dataset.ron` and the README with its table.

use std::fmt::Write as _;

use crate::bench::{BenchData, BenchRun, steady_window};
use crate::command::Command;
use crate::error::TruthError;
use crate::lag::LagStudy;
use crate::measure::{half_peak_to_peak, loop_width, phasor, wrap_deg};
use crate::record::INTERNAL_RATE_HZ;

/// The run whose best lag is tried on all others.
pub const LAG_REFERENCE_ID: &str = "sine_10hz_85v";

/// All files of the data set: name and content.
///
/// # Errors
/// As [`crate::record::Run::pass_through`].
pub fn files(data: &BenchData) -> Result<Vec<(String, String)>, TruthError> {
    let mut files: Vec<(String, String)> = data
        .runs
        .iter()
        .map(|bench| (format!("{}.csv", bench.run.id), bench.measured.to_csv()))
        .collect();
    files.push(("dataset.ron".to_owned(), dataset_ron(data)));
    files.push(("README.md".to_owned(), readme(data, &achieved_table(data)?)));
    Ok(files)
}

/// The description of the data set that programs read.
pub fn dataset_ron(data: &BenchData) -> String {
    let mut text = String::from("#![enable(implicit_some)]\n(\n    kind: ActuatorBench,\n");
    text += "    title: \"Synthetic bench of an APA500L-like amplified piezo actuator (generated, \
             not measured)\",\n    runs: [\n";
    for BenchRun { run, .. } in &data.runs {
        let _ = writeln!(
            text,
            "        (id: \"{0}\", file: \"{0}.csv\", role: Reference, note: \"{1}\", start_s: 0.0),",
            run.id, run.note
        );
    }
    let _ = writeln!(text, "    ],\n    flap_deg_per_um: {:.9},", data.flap_deg_per_um);
    let (low, high) = (data.actuator.low_volt, data.actuator.high_volt);
    let _ = writeln!(text, "    command_range_V: ({low}, {high}),\n)");
    text
}

/// The table of what each run achieved.
///
/// # Errors
/// As [`crate::record::Run::pass_through`].
pub fn achieved_table(data: &BenchData) -> Result<String, TruthError> {
    let mut studies = Vec::new();
    for bench in &data.runs {
        studies.push(LagStudy::new(&data.actuator, bench)?);
    }
    let reference = data.runs.iter().position(|bench| bench.run.id == LAG_REFERENCE_ID);
    let reference_lag_s = reference.map_or(f64::NAN, |index| studies[index].best_lag_s());
    let mut text = format!(
        "| run | half peak to peak, deg | fundamental, deg | lag, deg | loop width, % | no lag, % | \
         lag {:.2} ms, % | own lag, % |\n|---|---|---|---|---|---|---|---|\n",
        1000.0 * reference_lag_s
    );
    for (bench, study) in data.runs.iter().zip(&studies) {
        let own_lag_s = study.best_lag_s();
        let _ = writeln!(
            text,
            "| {} | {} | {:.1} | {:.1} | {:.1} ({:.1} ms) |",
            bench.run.id,
            motion_columns(data, bench),
            100.0 * study.nrmse_without_lag(),
            100.0 * study.nrmse_with_lag(reference_lag_s),
            100.0 * study.nrmse_with_lag(own_lag_s),
            1000.0 * own_lag_s
        );
    }
    Ok(text)
}

/// The columns from peak to loop width, read off the steady part without noise.
fn motion_columns(data: &BenchData, bench: &BenchRun) -> String {
    let gain = data.flap_deg_per_um;
    let u = steady_window(&bench.run, &bench.exact.command_volt);
    let y = steady_window(&bench.run, &bench.exact.displacement_um);
    let half_peak_deg = gain * half_peak_to_peak(y);
    let component = |frequency_hz: f64| {
        let cycles_per_sample = frequency_hz / f64::from(bench.run.sample_rate_hz);
        let (input, output) = (phasor(u, cycles_per_sample), phasor(y, cycles_per_sample));
        (gain * output.amplitude, wrap_deg(input.phase_deg - output.phase_deg))
    };
    match &bench.run.command {
        Command::Sine { frequency_hz, .. } => {
            let (amplitude_deg, lag_deg) = component(*frequency_hz);
            let width_percent = 100.0 * loop_width(u, y);
            format!("{half_peak_deg:.3} | {amplitude_deg:.3} | {lag_deg:.1} | {width_percent:.1}")
        }
        Command::Mix { revolution_hz, tones, .. } => {
            let (mut amplitudes, mut lags) = (Vec::new(), Vec::new());
            for tone in tones {
                let (amplitude_deg, lag_deg) = component(f64::from(tone.per_rev) * revolution_hz);
                amplitudes.push(format!("{amplitude_deg:.3}"));
                lags.push(format!("{lag_deg:.1}"));
            }
            format!("{half_peak_deg:.3} | {} | {} | -", amplitudes.join(", "), lags.join(", "))
        }
        Command::Ramps { .. } => format!("{half_peak_deg:.3} | - | - | -"),
    }
}

/// The README of the data set.
pub fn readme(data: &BenchData, achieved_table: &str) -> String {
    let a = &data.actuator;
    let (h, r, c, l) = (&a.hysteresis, &a.relaxation, &a.creep, &a.lvdt);
    let list = |pairs: Vec<(f64, f64)>, unit: &str| -> String {
        pairs.iter().map(|(w, x)| format!("{w} at {x} {unit}")).collect::<Vec<_>>().join(", ")
    };
    let walls = list(h.populations.iter().map(|p| (p.weight, p.pinning_volt)).collect(), "V");
    let times = r.channels.iter().map(|ch| (ch.weight, 1000.0 * ch.time_constant_s));
    let times = list(times.collect(), "ms");
    let creep_times: Vec<String> =
        c.retardation_times_s().iter().map(|time_s| format!("{time_s:.3}")).collect();
    let parameters = [
        (
            "permitted voltage, bias",
            format!("{}..{} V, {} V", a.low_volt, a.high_volt, a.bias_volt),
        ),
        ("intrinsic gain d", format!("{} um/V", h.intrinsic_um_per_volt)),
        ("polarisation stroke S", format!("{} um", h.polarisation_stroke_um)),
        ("reversible share c", format!("{}", h.reversible_share)),
        (
            "Langevin centre u_c, width a",
            format!("{} V, {} V", h.langevin_centre_volt, h.langevin_width_volt),
        ),
        ("pinning k_j (share w_j)", walls),
        ("pinning imprint b", format!("{}", h.pinning_imprint)),
        ("relaxation times tau_i0 (share)", times),
        (
            "their dependence on extension p, on deviation q",
            format!(
                "{}, {} per {} um",
                r.position_sensitivity, r.deviation_sensitivity, r.reference_um
            ),
        ),
        (
            "creep per decade, share c_i of each element",
            format!(
                "{:.2} %, {:.2} %",
                100.0 * c.growth_per_decade,
                100.0 * c.element_compliance()
            ),
        ),
        ("creep times", format!("{} s", creep_times.join(", "))),
        (
            "LVDT noise (standard deviation), range",
            format!("{} um, +-{} um", l.noise_um, l.range_um),
        ),
        ("LVDT resolution", format!("{} bits, {:.7} um", l.bits, l.resolution_um())),
        ("rate of integration", format!("{INTERNAL_RATE_HZ} Hz")),
        ("seed of the noise", format!("{}", data.seed)),
        ("flap_deg_per_um", format!("{:.9}", data.flap_deg_per_um)),
    ];
    let mut parameter_table = String::from("| parameter | value |\n|---|---|\n");
    for (name, value) in parameters {
        let _ = writeln!(parameter_table, "| {name} | {value} |");
    }
    include_str!("readme_template.md")
        .replace("{seed}", &data.seed.to_string())
        .replace("{parameters}", parameter_table.trim_end())
        .replace("{table}", achieved_table.trim_end())
}
