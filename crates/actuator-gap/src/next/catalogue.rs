//! The experiments a bench can do, as runs that the base model can be asked about.

use super::excitation::Span;
use crate::record::{Record, frequency_hz};
use crate::simulator::{ChannelKind, is_same_input};
use measured_data::Fitting;

/// One experiment.
pub(super) struct Experiment {
    /// Name in `findings.json`.
    pub(super) id: &'static str,
    /// What to do, for a reader.
    pub(super) what: &'static str,
    /// Runs to be done, without their outputs; none where the runs at hand only get a further column.
    pub(super) runs: Vec<Record>,
    /// What it costs on a usual bench, minutes: a cable is less than a run, a run less than another fitting or sensor.
    pub(super) minutes: f64,
    /// What is measured on them. A comparison asks for each run to be read by an ideal sensor too.
    pub(super) shown: &'static [ChannelKind],
}

/// Minutes that a run takes before it begins, that another fitting takes, and that a second sensor does.
const PREPARED: f64 = 3.0;
const FITTED: f64 = 60.0;
const SECOND_SENSOR: f64 = 120.0;

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
    let seconds: f64 = runs.iter().map(|run| run.step_s * run.input.len() as f64).sum();
    Experiment { id, what, runs, minutes: PREPARED + seconds / 60.0, shown: &[ChannelKind::Output] }
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
        catalogue.extend(monitors(span));
    }
    let range = (span.middle - span.half, span.middle + span.half);
    catalogue.retain(|own| !is_measured(own, runs, range));
    catalogue
}

/// Whether the measured runs hold an experiment already.
fn is_measured(experiment: &Experiment, runs: &[&Record], range: (f64, f64)) -> bool {
    match experiment.id {
        "multisine-5-181Hz" => runs.iter().any(|run| is_wide(run)),
        "zero-input-record" => runs.iter().any(|run| rests(run)),
        "preload" => runs.iter().any(|run| run.is_preloaded()),
        "repeat-reference" => experiment
            .runs
            .iter()
            .all(|reference| runs.iter().any(|run| is_same_input(run, reference, range))),
        "laser-cross-check" => runs.iter().any(|run| run.has_ideal_sensor()),
        "amplifier-monitor" => runs.iter().any(|run| run.amplifier.is_some()),
        "temperature-monitor" => runs.iter().any(|run| run.temperature.is_some()),
        _ => false,
    }
}

/// Frequency from which a run carries what the multisines of 5 to 181 Hz would, Hz: they move as a sine of
/// 106 Hz does.
const WIDE_HZ: f64 = 50.0;

/// Whether a run carries high frequencies all along: each quarter of it, because the edges of a single step
/// are fast too.
pub(super) fn is_wide(run: &Record) -> bool {
    let input = run.judged_input();
    let quarter = (input.len() / 4).max(1);
    input.chunks_exact(quarter).all(|part| frequency_hz(part, run.step_s) > WIDE_HZ)
}

/// Whether the input of a run stands still but for a tenth of it.
fn rests(run: &Record) -> bool {
    let input = run.judged_input();
    let moving = input.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 0.0).count();
    10 * moving < input.len()
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
        Experiment {
            minutes: FITTED,
            ..experiment(
                "preload",
                "a triangle and a multisine with the lever preloaded: play goes, friction stays",
                vec![
                    preloaded(
                        "preload_triangle",
                        2e-3,
                        span.triangles(1.0, &[1.0, 0.7, 0.35], 2e-3),
                    ),
                    preloaded("preload_band", 1e-3, span.multisine(BAND, 0.5, 0.7, 3.0, 1e-3)),
                ],
            )
        },
        Experiment {
            id: "multisine-5-181Hz+laser-cross-check",
            what: "two multisines from 5 to 181 Hz, 0.14 and 0.35 of the half range, 2 s each, read by \
                   the sensor and by a second, ideal one",
            runs: wide_multisines(span),
            minutes: SECOND_SENSOR,
            shown: &[ChannelKind::Output, ChannelKind::Comparison],
        },
    ];
    let again =
        |r: &&Record| Record { fitting: r.fitting, ..run(&r.id, r.step_s, r.input.clone()) };
    catalogue.push(Experiment {
        id: "laser-cross-check",
        what: "the same runs read by a second, ideal displacement sensor",
        runs: runs.iter().map(again).collect(),
        minutes: SECOND_SENSOR,
        shown: &[ChannelKind::Comparison],
    });
    catalogue
}

/// Further columns, and what needs them.
fn monitors(span: Span) -> Vec<Experiment> {
    let bursts = [(0.35, 40.0), (0.94, 1200.0), (0.35, 800.0)];
    let beside =
        |id, what, shown| Experiment { id, what, runs: Vec::new(), minutes: PREPARED, shown };
    vec![
        Experiment {
            id: "cold-hot-cold",
            what: "a small sine, a minute of full drive, the small sine again; temperature recorded",
            runs: vec![run("hot", 5e-3, span.bursts(20.0, 0.0, &bursts, 5e-3))],
            minutes: 3.0 * PREPARED,
            shown: &[ChannelKind::Output, ChannelKind::Temperature],
        },
        beside(
            "amplifier-monitor",
            "the terminal voltage beside every run",
            &[ChannelKind::Amplifier],
        ),
        beside(
            "temperature-monitor",
            "the temperature beside every run",
            &[ChannelKind::Temperature],
        ),
    ]
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
