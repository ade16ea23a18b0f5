//! The monitor of a named cause: it sees what is there, and C, Python and MATLAB give its numbers.

use crate::common::{
    can_check, folder, largest_difference, read_numbers, run, statics, wanted, write_numbers,
};
use actuator_export::{
    ExportError, Monitor, Seen, Target, Watched, export_monitor, without_stages,
};
use preisach_dyn::{ActuatorModel, Backlash, Delay, LinkageStage, LoadStiffness, SensorStage};
use std::path::Path;

const STEP_S: f64 = 5e-4;

/// The actuator as it was, and with a gap of 6 um.
fn models() -> [ActuatorModel; 2] {
    let mut extended = statics(10);
    extended.linkage.push(LinkageStage::Backlash(Backlash { width_um: 6.0 }));
    [statics(10), extended]
}

fn monitor([base, extended]: &[ActuatorModel; 2]) -> Monitor<'_> {
    Monitor { base, extended, cause: "backlash, 6 um", threshold_deg: 0.02, memory_s: 0.2 }
}

fn volts() -> Vec<f64> {
    wanted(40.0, 65.0, STEP_S)
}

/// What an actuator does, with noise of 5 mdeg that repeats from machine to machine.
fn measured(model: &ActuatorModel) -> Vec<f64> {
    let output = model.simulate(&volts(), STEP_S).unwrap().output_deg;
    let noisy = output.iter().enumerate().map(|(i, deg)| deg + 7e-3 * (7919.0 * i as f64).sin());
    noisy.collect()
}

#[test]
fn it_tells_sound_from_the_cause_and_from_something_else() {
    let models = models();
    let watch = monitor(&models);
    let end = |measured: &[f64]| *watch.watch(&volts(), measured, STEP_S).unwrap().last().unwrap();
    let sound = end(&measured(&models[0]));
    assert_eq!(sound.seen, Seen::Sound);
    assert!(sound.amount.abs() < 0.02, "{sound:?}");
    let found = end(&measured(&models[1]));
    assert_eq!(found.seen, Seen::Cause);
    assert!((found.amount - 1.0).abs() < 0.02 && found.residual_deg > 0.05, "{found:?}");
    assert!(found.left_deg < 0.01, "{found:?}");
    // half of the gap is half of the cause: the play is nearly linear in its width
    let mut half = statics(10);
    half.linkage.push(LinkageStage::Backlash(Backlash { width_um: 3.0 }));
    let half = end(&measured(&half));
    assert!(half.seen == Seen::Cause && (half.amount - 0.5).abs() < 0.1, "{half:?}");
    // a tenth of the stroke is lost to a spring
    let mut other = statics(10);
    let spring = LoadStiffness { stiffness_ratio: 0.1, compliance_um_per_newton: 0.0 };
    other.linkage.push(LinkageStage::LoadStiffness(spring));
    let other = end(&measured(&other));
    assert!(other.seen == Seen::Other && other.left_deg > 0.05, "{other:?}");
}

#[test]
fn the_contrary_of_the_cause_is_something_else() {
    let [closed, open] = models();
    let base = open.simulate(&volts(), STEP_S).unwrap().output_deg;
    let sound = closed.simulate(&volts(), STEP_S).unwrap().output_deg;
    // as much as the gap takes away, added
    let angles: Vec<f64> =
        sound.iter().zip(&base).map(|(sound, base)| 2.0 * sound - base).collect();
    let models = [closed, open];
    let watch = monitor(&models);
    let watched = watch.watch(&volts(), &angles, STEP_S).unwrap();
    let end = watched.last().unwrap();
    assert!((end.amount + 1.0).abs() < 1e-6 && end.left_deg < watch.threshold_deg, "{end:?}");
    assert!(end.residual_deg > watch.threshold_deg && end.seen == Seen::Other, "{end:?}");
}

/// Residual, amount, what is left and what is seen, sample by sample.
fn rows(watched: &[Watched]) -> Vec<f64> {
    let row = |w: &Watched| {
        let seen = match w.seen {
            Seen::Sound => 0.0,
            Seen::Cause => 1.0,
            Seen::Other => 2.0,
        };
        [w.residual_deg, w.amount, w.left_deg, seen]
    };
    watched.iter().flat_map(row).collect()
}

/// A history with a measurement that is none, and what Rust makes of it.
fn history(folder: &Path, target: Target) -> Vec<f64> {
    let models = models();
    // short enough that the cause is forgotten when its contrary ends
    let watch = Monitor { memory_s: 0.05, ..monitor(&models) };
    let volts = volts();
    let mut angles = measured(&models[1]);
    angles[100] = f64::NAN;
    // then the contrary of the cause
    let [sound, gap] = [0, 1].map(|i| models[i].simulate(&volts, STEP_S).unwrap().output_deg);
    let half = angles.len() / 2;
    for i in half..angles.len() {
        angles[i] = 2.0 * sound[i] - gap[i];
    }
    for (file, text) in export_monitor(&watch, "watch", STEP_S, target).unwrap() {
        assert!(!text.contains("{{"), "{file}");
        std::fs::write(folder.join(file), text).unwrap();
    }
    write_numbers(&folder.join("volts"), &volts);
    write_numbers(&folder.join("angles"), &angles);
    let watched = watch.watch(&volts, &angles, STEP_S).unwrap();
    let is_contrary =
        |w: &Watched| w.amount < 0.0 && w.left_deg <= watch.threshold_deg && w.seen == Seen::Other;
    assert!(watched.iter().any(is_contrary), "{:?}", watched.last());
    rows(&watched)
}

#[test]
fn c_gives_the_numbers_of_rust() {
    let folder = folder("monitor_c");
    let expected = history(&folder, Target::C);
    let program = r#"
#include <stdio.h>
#include "watch.h"

static double u[200000], y[200000];

static size_t numbers(const char *path, double *values)
{
    FILE *in = fopen(path, "rb");
    const size_t n = fread(values, sizeof values[0], 200000, in);
    fclose(in);
    return n;
}

int main(void)
{
    const size_t n = numbers("volts", u);
    FILE *out = fopen("out", "wb");
    watch_state m;
    size_t i;
    if (numbers("angles", y) != n) return 1;
    watch_start(&m, u[0]);
    for (i = 1; i < n; ++i) {
        double row[4];
        row[3] = watch_step(&m, u[i], y[i]);
        row[0] = m.residual_deg;
        row[1] = m.amount;
        row[2] = m.left_deg;
        fwrite(row, sizeof row[0], 4, out);
    }
    return fclose(out);
}
"#;
    std::fs::write(folder.join("program.c"), program).unwrap();
    let sources = ["program.c", "watch.c", "watch_base.c", "watch_extended.c", "-lm"];
    let strict = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic"];
    let mut arguments = [&strict[..], &["-ffp-contract=off", "-o", "program"]].concat();
    arguments.extend(sources);
    run(&folder, "cc", &arguments);
    run(&folder, "./program", &[]);
    let off = largest_difference(&read_numbers(&folder.join("out")), &expected);
    println!("C against Rust: {off:.1e}");
    assert!(off <= 1e-12, "{off}");
}

#[test]
fn numpy_gives_the_numbers_of_rust() {
    if !can_check("numpy") {
        return;
    }
    let folder = folder("monitor_python");
    let expected = history(&folder, Target::Python);
    let script = "import numpy, watch\n\
        u, y = (numpy.fromfile(name) for name in ('volts', 'angles'))\n\
        watch.Monitor(u[0]).watch(u[1:], y[1:]).tofile('out')\n";
    std::fs::write(folder.join("script.py"), script).unwrap();
    run(&folder, "python3", &["script.py"]);
    let off = largest_difference(&read_numbers(&folder.join("out")), &expected);
    println!("NumPy against Rust: {off:.1e}");
    assert!(off <= 1e-12, "{off}");
}

const SCRIPT: &str = "
u = fread(fopen('volts', 'rb'), Inf, 'double')';
y = fread(fopen('angles', 'rb'), Inf, 'double')';
monitor = watch(u(1));
rows = monitor.watch_all(u(2:end), y(2:end));
fwrite(fopen('out', 'wb'), rows', 'double');
";

#[test]
fn octave_gives_the_numbers_of_rust() {
    if !can_check("octave") {
        return;
    }
    let folder = folder("monitor_matlab");
    let expected = history(&folder, Target::Matlab);
    std::fs::write(folder.join("script.m"), SCRIPT).unwrap();
    run(&folder, "octave-cli", &["--no-gui", "--quiet", "--norc", "script.m"]);
    // what is left is the root of a difference: its square has the digits
    let squared = |rows: Vec<f64>| -> Vec<f64> {
        let square = |(k, value): (usize, f64)| if k % 4 == 2 { value * value } else { value };
        rows.into_iter().enumerate().map(square).collect()
    };
    let got = squared(read_numbers(&folder.join("out")));
    let expected = squared(expected);
    // before the gap acts the amount is a quotient of roundings
    let begun = 4 * 100;
    let first = largest_difference(&got[..begun], &expected[..begun]);
    let off = largest_difference(&got[begun..], &expected[begun..]);
    println!("MATLAB code in Octave against Rust: {off:.1e}, {first:.1e} before the gap acts");
    assert!(first <= 1e-6, "{first}");
    assert!(off <= 1e-12, "{off}");
}

#[test]
fn a_monitor_is_filled_in_every_language() {
    let models = models();
    for target in [Target::C, Target::Python, Target::Matlab] {
        let files = export_monitor(&monitor(&models), "watch", STEP_S, target).unwrap();
        for (file, text) in files.iter().filter(|(file, _)| file.starts_with("watch.")) {
            for word in ["{{", "}}", "\t", " \n", "\n\n\n\n"] {
                assert!(!text.contains(word), "{file}: {word:?}");
            }
            let longest = text.lines().map(str::len).max().unwrap();
            assert!(target != Target::Matlab || longest <= 120, "{file}: {longest}");
            assert!(text.contains("backlash, 6 um") || file == "watch.c", "{file}");
        }
    }
}

#[test]
fn json_holds_both_actuators_and_the_threshold() {
    let models = models();
    let watch = monitor(&models);
    let files = export_monitor(&watch, "watch", STEP_S, Target::Json).unwrap();
    let json: serde_json::Value = serde_json::from_str(&files[0].1).unwrap();
    assert_eq!((files.len(), files[0].0.as_str()), (1, "watch.json"));
    assert_eq!(json["threshold_deg"].as_f64().unwrap().to_bits(), 0.02_f64.to_bits());
    let kept = (-STEP_S / 0.2).exp();
    assert_eq!(json["kept"].as_f64().unwrap().to_bits(), kept.to_bits());
    assert_eq!(json["cause"], "backlash, 6 um");
    assert_eq!(json["base"]["linkage"].as_array().unwrap().len(), 0);
    assert_eq!(json["extended"]["linkage"][0]["kind"], "Backlash");
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let models = models();
    let of = |change: &dyn Fn(&mut Monitor<'_>), target| {
        let mut watch = monitor(&models);
        change(&mut watch);
        export_monitor(&watch, "watch", STEP_S, target).unwrap_err()
    };
    let none = of(&|watch| watch.extended = watch.base, Target::C);
    assert_eq!(none, ExportError::NoCause);
    assert_eq!(without_stages(&models[1], &["Backlash"]).unwrap(), models[0]);
    let text = without_stages(&models[1], &["Delay"]).unwrap_err().to_string();
    assert!(text.contains("no stage `Delay` among those of the actuator: Backlash"), "{text}");
    let text = of(&|watch| watch.threshold_deg = 0.0, Target::C).to_string();
    assert!(text.contains("the threshold"), "{text}");
    let text = of(&|watch| watch.memory_s = 1e18, Target::Json).to_string();
    assert!(text.contains("is 1000000000000000000 s, expected at most 500000000 s"), "{text}");
    let mut seen_through = models[1].clone();
    seen_through.sensor.push(SensorStage::Delay(Delay { delay_s: 1e-3 }));
    let watch = Monitor { extended: &seen_through, ..monitor(&models) };
    let text = export_monitor(&watch, "watch", STEP_S, Target::Json).unwrap_err().to_string();
    assert!(
        text.contains("stages of a sensor (Delay)") && text.contains("take `sensor` out"),
        "{text}"
    );
}
