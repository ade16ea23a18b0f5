//! Records and descriptions as text.

use std::fmt::Write as _;

use super::design::{Fitting, Monitor, Monitors, Plan};
use super::draw::{Draw, Purpose};
use super::simulate::Exact;

/// A file of a folder: name and content.
pub type File = (String, String);

/// What is written of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Columns<'a> {
    pub(super) run: &'a Exact,
    pub(super) monitors: Monitors,
    /// Standard deviation of the noise of the displacement, um.
    pub(super) noise_um: f64,
    /// Keys of the noise.
    pub(super) keys: &'a [u64],
}

/// Share of the variance of the noise that is coloured, and its correlation time, s.
const COLOURED: (f64, f64) = (0.15, 0.02);

/// Noise of the monitors: V, K, N.
const MONITOR_NOISE: [f64; 3] = [0.02, 0.05, 0.2];

/// Temperature of the rest, degrees Celsius.
const AMBIENT_CELSIUS: f64 = 22.0;

/// Sensor noise: white with a coloured part, `count` samples of deviation `noise_um`.
pub(super) fn noise(keys: &[u64], noise_um: f64, rate_hz: u32, count: usize) -> Vec<f64> {
    let mut draw = Draw::new(Purpose::Noise, keys);
    let decay = (-1.0 / (COLOURED.1 * f64::from(rate_hz))).exp();
    let fresh = (1.0 - decay * decay).sqrt();
    let (white, coloured) = ((1.0 - COLOURED.0).sqrt(), COLOURED.0.sqrt());
    let mut slow = draw.normal();
    (0..count)
        .map(|_| {
            let value = noise_um * (white * draw.normal() + coloured * slow);
            slow = decay * slow + fresh * draw.normal();
            value
        })
        .collect()
}

/// A record: a header with units, then one line a sample.
pub(super) fn csv(rate_hz: u32, columns: &Columns<'_>) -> String {
    let Columns { run, monitors, noise_um, keys } = columns;
    let count = run.displacement_um.len();
    let noise = noise(keys, *noise_um, rate_hz, count);
    let mut draw = Draw::new(Purpose::Monitor, keys);
    let mut text = String::with_capacity(48 * count);
    text += "time_s,command_V,displacement_um";
    let extra = [
        (monitors.amplifier, "amplifier_V", &run.amplifier_volt, 0.0),
        (monitors.temperature, "temperature_C", &run.rise_kelvin, AMBIENT_CELSIUS),
        (monitors.load, "load_N", &run.load_newton, 0.0),
    ];
    let recorded = |monitor: Monitor| monitor == Monitor::Recorded;
    for (monitor, name, ..) in extra {
        if recorded(monitor) {
            text.push(',');
            text += name;
        }
    }
    text.push('\n');
    for i in 0..count {
        let time_s = i as f64 / f64::from(rate_hz);
        let y = run.displacement_um[i] + noise[i];
        // Adding zero turns a negative zero into a positive one; a String takes every write.
        let _ = write!(text, "{time_s:.5},{:.4},{:.4}", run.command_volt[i] + 0.0, y + 0.0);
        for ((monitor, _, values, offset), deviation) in extra.iter().zip(MONITOR_NOISE) {
            if recorded(*monitor) {
                let _ = write!(text, ",{:.3}", values[i] + offset + deviation * draw.normal());
            }
        }
        text.push('\n');
    }
    text
}

/// `dataset.ron` of a folder.
pub(super) fn dataset(title: &str, role: &str, plans: &[Plan], range_volt: (f64, f64)) -> File {
    let mut text = format!(
        "#![enable(implicit_some)]\n(\n    kind: ActuatorBench,\n    title: \"{title}\",\n    runs: [\n"
    );
    for plan in plans {
        let how = match plan.fitting {
            Fitting::Laser => ", sensor: Ideal",
            Fitting::Preload => ", fitting: Preloaded",
            Fitting::Plain | Fitting::Spring(_) => "",
        };
        let _ =
            writeln!(text, "        (id: \"{0}\", file: \"{0}.csv\", role: {role}{how}),", plan.id);
    }
    let (low, high) = range_volt;
    let _ = writeln!(
        text,
        "    ],\n    flap_deg_per_um: 0.04,\n    command_range_V: ({low}, {high}),\n)"
    );
    ("dataset.ron".to_owned(), text)
}
