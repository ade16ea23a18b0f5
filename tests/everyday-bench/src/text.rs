//! Records and descriptions as text.

use std::fmt::Write as _;

use crate::draw::Draw;
use crate::runs::{RANGE_VOLT, Run};
use crate::simulate::Trace;

/// A file of a folder: name and content.
pub type File = (String, String);

/// A quantity that is recorded besides command and displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// `amplifier_V`.
    Amplifier,
    /// `temperature_C`.
    Temperature,
    /// `load_N`.
    Load,
}

/// Temperature of the rest, degrees Celsius.
const AMBIENT_CELSIUS: f64 = 22.0;

impl Column {
    fn name(self) -> &'static str {
        match self {
            Self::Amplifier => "amplifier_V",
            Self::Temperature => "temperature_C",
            Self::Load => "load_N",
        }
    }

    /// Standard deviation of its noise: V, K, N.
    fn noise(self) -> f64 {
        match self {
            Self::Amplifier => 0.02,
            Self::Temperature => 0.05,
            Self::Load => 0.2,
        }
    }

    fn value(self, trace: &Trace, i: usize) -> f64 {
        match self {
            Self::Amplifier => trace.monitor_volt[i],
            Self::Temperature => AMBIENT_CELSIUS + trace.rise_kelvin[i],
            Self::Load => trace.load_newton[i],
        }
    }
}

/// A record with white noise of the displacement (um) drawn by `keys`: a header with units, then one line a sample.
pub(crate) fn csv(
    rate_hz: u32,
    trace: &Trace,
    columns: &[Column],
    noise_um: f64,
    keys: &[u64],
) -> String {
    let mut draw = Draw::new("noise", keys);
    let mut text = String::with_capacity(40 * trace.command_volt.len());
    text += "time_s,command_V,displacement_um";
    for column in columns {
        text.push(',');
        text += column.name();
    }
    text.push('\n');
    for (i, (volt, um)) in trace.command_volt.iter().zip(&trace.displacement_um).enumerate() {
        let time_s = i as f64 / f64::from(rate_hz);
        let um = um + noise_um * draw.normal();
        // Adding zero turns a negative zero into a positive one; a String takes every write.
        let _ = write!(text, "{time_s:.5},{:.4},{:.4}", volt + 0.0, um + 0.0);
        for column in columns {
            let value = column.value(trace, i) + column.noise() * draw.normal();
            let _ = write!(text, ",{value:.3}");
        }
        text.push('\n');
    }
    text
}

/// `dataset.ron` of a folder; `role` is `Reference` or `Measured`.
pub(crate) fn dataset(title: &str, role: &str, runs: &[Run]) -> File {
    let mut text = format!(
        "#![enable(implicit_some)]\n(\n    kind: ActuatorBench,\n    title: \"{title}\",\n    runs: [\n"
    );
    for run in runs {
        let _ = writeln!(text, "        (id: \"{0}\", file: \"{0}.csv\", role: {role}),", run.id);
    }
    let (low, high) = RANGE_VOLT;
    let _ = writeln!(
        text,
        "    ],\n    flap_deg_per_um: 0.04,\n    command_range_V: ({low}, {high}),\n)"
    );
    ("dataset.ron".to_owned(), text)
}
