//! A program in C that times the step functions of an export.

use crate::constant::number;
use crate::library::filled;
use preisach_dyn::ActuatorModel;

/// Shares of the range by which the timed command reaches: its three tones together stay within.
const REACH: f64 = 0.07;
/// Samples of the timed command.
const SAMPLES: u32 = 4000;

/// The source of a program that times the C of [`export`](crate::export()) of that name and time step: compiled with
/// it and run, it prints two numbers, ns per sample of the forward and of the inverse step, and a third without a meaning.
pub fn timing_program(model: &ActuatorModel, name: &str, time_step_s: f64) -> String {
    let [middle, reach] = middle_and_reach(model);
    let values = [
        ("name", name),
        ("time_step_s", &number(time_step_s)),
        ("middle_volt", &number(middle)),
        ("reach_volt", &number(reach)),
    ];
    filled(include_str!("../templates/c/timing.c"), &values)
}

/// The command that is timed, V: tones of 10, 15 and 20 Hz about the middle of the range.
pub fn timed_command(model: &ActuatorModel, time_step_s: f64) -> Vec<f64> {
    let [middle, reach] = middle_and_reach(model);
    let tones = |t: f64| (62.8 * t).cos() + (94.2 * t).sin() + 0.75 * (125.7 * t).cos();
    (0..SAMPLES).map(|i| middle + reach * tones(time_step_s * f64::from(i))).collect()
}

fn middle_and_reach(model: &ActuatorModel) -> [f64; 2] {
    let range = model.range_volt;
    [0.5 * (range.lowest_volt() + range.highest_volt()), REACH * range.span_volt()]
}
