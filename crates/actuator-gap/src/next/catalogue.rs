//! The experiments a bench can do, as runs that the base model can be asked about.

use super::excitation::Span;
use crate::record::Record;
use crate::simulator::ChannelKind;
use measured_data::Fitting;

/// One experiment.
pub(super) struct Experiment {
    /// Name in `findings.json`.
    pub(super) id: &'static str,
    /// What to do, for a reader.
    pub(super) what: &'static str,
    /// Runs to be done, without their outputs; none where the runs at hand only get a further column.
    pub(super) runs: Vec<Record>,
    /// What is measured on them. A comparison asks for each run to be read by an ideal sensor too.
    pub(super) shown: &'static [ChannelKind],
}

const BAND: (f64, f64) = (1.0, 35.0);
const WIDE: (f64, f64) = (5.0, 181.0);

fn run(id: &str, step_s: f64, input: Vec<f64>) -> Record {
    Record::new(id, step_s, input, Vec::new())
}

fn preloaded(id: &str, step_s: f64, input: Vec<f64>) -> Record {
    Record { fitting: Fitting::Preloaded, ..run(id, step_s, input) }
}

/// An experiment that measures the output on runs.
fn experiment(id: &'static str, what: &'static str, runs: Vec<Record>) -> Experiment {
    Experiment { id, what, runs, shown: &[ChannelKind::Output] }
}

/// The same of one further run.
fn one(id: &'static str, what: &'static str, step_s: f64, input: Vec<f64>) -> Experiment {
    experiment(id, what, vec![run(id, step_s, input)])
}

/// Every experiment that can be worked out, for the measured runs at hand.
pub(super) fn catalogue(
    span: Span,
    runs: &[&Record],
    references: &[&Record],
    is_bench: bool,
) -> Vec<Experiment> {
    let mut catalogue = fast(span);
    if !references.is_empty() {
        let again = |r: &&Record| {
            let (sensor, fitting) = (r.sensor, r.fitting);
            Record { sensor, fitting, ..run(&r.id, r.step_s, r.input.clone()) }
        };
        catalogue.push(experiment(
            "repeat-reference",
            "the reference runs again, today, with the same commands: what changed shows without any model",
            references.iter().map(again).collect(),
        ));
    }
    catalogue.extend(slow_and_small(span));
    catalogue.extend(other_fittings(span, runs));
    if is_bench {
        catalogue.extend(monitors(span, runs));
    }
    catalogue
}

/// Two multisines that carry all frequencies a bench sensor has to follow.
fn wide_multisines(span: Span) -> Vec<Record> {
    let wide = |peak| span.multisine(WIDE, 2.0, peak, 2.0, 5e-4);
    vec![run("wide_small", 5e-4, wide(0.14)), run("wide_large", 5e-4, wide(0.35))]
}

/// Experiments that carry high frequencies, or many.
fn fast(span: Span) -> Vec<Experiment> {
    let sines =
        [(0.5, 2.0), (1.0, 2.0), (2.0, 4.0), (5.0, 8.0), (10.0, 12.0), (20.0, 20.0), (40.0, 40.0)];
    let sine = |(hz, cycles)| run("sine", 1e-3, span.bursts(hz, 0.0, &[(0.47, cycles)], 1e-3));
    vec![
        experiment(
            "multisine-5-181Hz",
            "two multisines from 5 to 181 Hz, 0.14 and 0.35 of the half range, 2 s each",
            wide_multisines(span),
        ),
        one(
            "amplitude-sweep",
            "10 Hz at 0.1 to 0.95 of the half range",
            1e-3,
            span.bursts(10.0, 0.0, &[0.12, 0.24, 0.47, 0.7, 0.94].map(|a| (a, 6.0)), 1e-3),
        ),
        experiment(
            "frequency-sweep",
            "half the half range, sines from 0.5 to 40 Hz",
            sines.map(sine).into(),
        ),
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
        experiment(
            "preload",
            "a triangle and a multisine with the lever preloaded: play goes, friction stays",
            vec![
                preloaded("preload_triangle", 2e-3, span.triangles(1.0, &[1.0, 0.7, 0.35], 2e-3)),
                preloaded("preload_band", 1e-3, span.multisine(BAND, 0.5, 0.7, 3.0, 1e-3)),
            ],
        ),
        Experiment {
            id: "multisine-5-181Hz+laser-cross-check",
            what: "two multisines from 5 to 181 Hz, 0.14 and 0.35 of the half range, 2 s each, read by \
                   the sensor and by a second, ideal one",
            runs: wide_multisines(span),
            shown: &[ChannelKind::Output, ChannelKind::Comparison],
        },
    ];
    if !runs.iter().any(|r| r.has_ideal_sensor()) {
        let again =
            |r: &&Record| Record { fitting: r.fitting, ..run(&r.id, r.step_s, r.input.clone()) };
        catalogue.push(Experiment {
            id: "laser-cross-check",
            what: "the same runs read by a second, ideal displacement sensor",
            runs: runs.iter().map(again).collect(),
            shown: &[ChannelKind::Comparison],
        });
    }
    catalogue
}

/// Further columns, and what needs them.
fn monitors(span: Span, runs: &[&Record]) -> Vec<Experiment> {
    let bursts = [(0.35, 40.0), (0.94, 1200.0), (0.35, 800.0)];
    let mut catalogue = vec![Experiment {
        id: "cold-hot-cold",
        what: "a small sine, a minute of full drive, the small sine again; temperature recorded",
        runs: vec![run("hot", 5e-3, span.bursts(20.0, 0.0, &bursts, 5e-3))],
        shown: &[ChannelKind::Output, ChannelKind::Temperature],
    }];
    if runs.iter().all(|r| r.amplifier.is_none()) {
        catalogue.push(Experiment {
            id: "amplifier-monitor",
            what: "the terminal voltage beside every run",
            runs: Vec::new(),
            shown: &[ChannelKind::Amplifier],
        });
    }
    if runs.iter().all(|r| r.temperature.is_none()) {
        catalogue.push(Experiment {
            id: "temperature-monitor",
            what: "the temperature beside every run",
            runs: Vec::new(),
            shown: &[ChannelKind::Temperature],
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
