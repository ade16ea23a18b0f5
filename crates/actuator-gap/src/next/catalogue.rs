//! The experiments a bench can do, as runs that the base model can be asked about.

use super::excitation::Span;
use crate::record::Record;
use measured_data::{Fitting, Sensor};

/// A run: name, time between samples, input.
pub(super) struct Planned {
    pub(super) id: String,
    pub(super) step_s: f64,
    pub(super) input: Vec<f64>,
    pub(super) sensor: Sensor,
    pub(super) fitting: Fitting,
}

/// What an experiment measures.
pub(super) enum Measured {
    /// The output on further runs.
    Runs(Vec<Planned>),
    /// The difference between the sensor and an ideal one on the runs there are.
    Again(Vec<Planned>),
    /// The output on further runs, by both sensors.
    Twice(Vec<Planned>),
    /// The terminal voltage on the runs there are.
    Amplifier,
    /// The temperature on the runs there are.
    Temperature,
    /// The output on further runs, and the temperature.
    Warm(Vec<Planned>),
}

/// One experiment.
pub(super) struct Experiment {
    /// Name in `findings.json`.
    pub(super) id: &'static str,
    /// What to do, for a reader.
    pub(super) what: &'static str,
    pub(super) measured: Measured,
}

const BAND: (f64, f64) = (1.0, 35.0);
const WIDE: (f64, f64) = (5.0, 181.0);

fn run(id: &str, step_s: f64, input: Vec<f64>) -> Planned {
    let (sensor, fitting) = (Sensor::Bench, Fitting::Plain);
    Planned { id: id.to_owned(), step_s, input, sensor, fitting }
}

fn preloaded(id: &str, step_s: f64, input: Vec<f64>) -> Planned {
    Planned { fitting: Fitting::Preloaded, ..run(id, step_s, input) }
}

/// An experiment of one further run.
fn one(id: &'static str, what: &'static str, step_s: f64, input: Vec<f64>) -> Experiment {
    Experiment { id, what, measured: Measured::Runs(vec![run(id, step_s, input)]) }
}

/// Every experiment that can be worked out, for the measured runs at hand.
pub(super) fn catalogue(span: Span, runs: &[&Record], is_bench: bool) -> Vec<Experiment> {
    let mut catalogue = fast(span);
    catalogue.extend(slow_and_small(span));
    catalogue.extend(other_fittings(span, runs));
    if is_bench {
        catalogue.extend(monitors(span, runs));
    }
    catalogue
}

/// Two multisines that carry all frequencies a bench sensor has to follow.
fn wide_multisines(span: Span) -> Vec<Planned> {
    let wide = |peak| span.multisine(WIDE, 2.0, peak, 2.0, 5e-4);
    vec![run("wide_small", 5e-4, wide(0.14)), run("wide_large", 5e-4, wide(0.35))]
}

/// Experiments that carry high frequencies, or many.
fn fast(span: Span) -> Vec<Experiment> {
    let sines =
        [(0.5, 2.0), (1.0, 2.0), (2.0, 4.0), (5.0, 8.0), (10.0, 12.0), (20.0, 20.0), (40.0, 40.0)];
    vec![
        Experiment {
            id: "multisine-5-181Hz",
            what: "two multisines from 5 to 181 Hz, 0.14 and 0.35 of the half range, 2 s each",
            measured: Measured::Runs(wide_multisines(span)),
        },
        one(
            "amplitude-sweep",
            "10 Hz at 0.1 to 0.95 of the half range",
            1e-3,
            span.bursts(10.0, 0.0, &[0.12, 0.24, 0.47, 0.7, 0.94].map(|a| (a, 6.0)), 1e-3),
        ),
        Experiment {
            id: "frequency-sweep",
            what: "half the half range, sines from 0.5 to 40 Hz",
            measured: Measured::Runs(
                sines
                    .iter()
                    .map(|&(hz, cycles)| {
                        run("sine", 1e-3, span.bursts(hz, 0.0, &[(0.47, cycles)], 1e-3))
                    })
                    .collect(),
            ),
        },
        one(
            "ring-down",
            "small steps read at 2 kHz",
            5e-4,
            span.steps(&[0.24, 0.0, -0.24, 0.0, 0.24, 0.0, -0.24, 0.0], 0.25, 5e-4),
        ),
    ]
}

/// Experiments that last, rest, or move little.
fn slow_and_small(span: Span) -> Vec<Experiment> {
    let small = [0.012, 0.012, 0.024, 0.024, 0.06, 0.06, 0.12, 0.12];
    vec![
        one(
            "hold-steps-100s",
            "three steps held for 33 s each",
            0.02,
            span.steps(&[0.65, -0.53, 0.0], 33.0, 0.02),
        ),
        one(
            "small-motion",
            "triangles of 1 to 12 % of the half range",
            2e-3,
            span.triangles(2.0, &small, 2e-3),
        ),
        one(
            "bias-sweep",
            "small triangles about seven places of the range",
            2e-3,
            span.path(&sweep(), 2e-3),
        ),
        one(
            "zero-input-record",
            "8 s at a constant input, then a pulse of a quarter of the half range for 0.1 s",
            1e-3,
            // the pulse shows that the columns are the right ones: a record that never moves is refused
            span.path(
                &[(0.0, 0.0), (8.0, 0.0), (8.005, 0.24), (8.1, 0.24), (8.105, 0.0), (8.2, 0.0)],
                1e-3,
            ),
        ),
    ]
}

/// Experiments with something else on the bench.
fn other_fittings(span: Span, runs: &[&Record]) -> Vec<Experiment> {
    let mut catalogue = vec![
        Experiment {
            id: "preload",
            what: "a triangle and a multisine with the lever preloaded: play goes, friction stays",
            measured: Measured::Runs(vec![
                preloaded("preload_triangle", 2e-3, span.triangles(1.0, &[1.0, 0.7, 0.35], 2e-3)),
                preloaded("preload_band", 1e-3, span.multisine(BAND, 0.5, 0.7, 3.0, 1e-3)),
            ]),
        },
        Experiment {
            id: "multisine-5-181Hz+laser-cross-check",
            what: "two multisines from 5 to 181 Hz, 0.14 and 0.35 of the half range, 2 s each, read by \
                   the sensor and by a second, ideal one",
            measured: Measured::Twice(wide_multisines(span)),
        },
    ];
    if !runs.iter().any(|r| r.has_ideal_sensor()) {
        let again =
            |r: &&Record| Planned { fitting: r.fitting, ..run(&r.id, r.step_s, r.input.clone()) };
        catalogue.push(Experiment {
            id: "laser-cross-check",
            what: "the same runs read by a second, ideal displacement sensor",
            measured: Measured::Again(runs.iter().map(again).collect()),
        });
    }
    catalogue
}

/// Further columns, and what needs them.
fn monitors(span: Span, runs: &[&Record]) -> Vec<Experiment> {
    let mut catalogue = vec![Experiment {
        id: "cold-hot-cold",
        what: "a small sine, a minute of full drive, the small sine again; temperature recorded",
        measured: Measured::Warm(vec![run(
            "hot",
            5e-3,
            span.bursts(20.0, 0.0, &[(0.35, 40.0), (0.94, 1200.0), (0.35, 800.0)], 5e-3),
        )]),
    }];
    if runs.iter().all(|r| r.amplifier.is_none()) {
        catalogue.push(Experiment {
            id: "amplifier-monitor",
            what: "the terminal voltage beside every run",
            measured: Measured::Amplifier,
        });
    }
    if runs.iter().all(|r| r.temperature.is_none()) {
        catalogue.push(Experiment {
            id: "temperature-monitor",
            what: "the temperature beside every run",
            measured: Measured::Temperature,
        });
    }
    catalogue
}

/// Ramps through places of the range with a small triangle at each, at 1.2 half ranges per second.
fn sweep() -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0), (0.1, 0.0)];
    let (mut time, mut from) = (0.1, 0.0_f64);
    for bias in [0.0, -0.8, -0.4, 0.0, 0.4, 0.8, -0.88, 0.0] {
        for place in [bias, bias + 0.12, bias - 0.12, bias + 0.12, bias] {
            time += ((place - from).abs() / 1.2).max(1e-3);
            points.push((time, place));
            from = place;
        }
    }
    points
}
