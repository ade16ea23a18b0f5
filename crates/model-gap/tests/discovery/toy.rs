//! A system whose answers are known: four sines, and what may act on them.

use model_gap::discovery::{Discovery, Finding, Settings, Signal, Simulator, Trace, TraceRole};
use model_gap::{Candidate, Effect, GapError, Parameter, Spectrum};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

pub(crate) const SAMPLES: usize = 400;
pub(crate) const EXPERIMENTS: usize = 4;
pub(crate) const NOISE: f64 = 0.02;

/// A sine of another frequency and amplitude in every experiment, and what may act on it.
pub(crate) struct Toy;

pub(crate) fn input(experiment: usize, i: usize) -> f64 {
    let cycles = [2.0, 5.0, 9.0, 14.0][experiment];
    let amplitude = [1.0, 0.6, 1.4, 1.0][experiment];
    amplitude * (TAU * cycles * i as f64 / SAMPLES as f64).sin()
}

/// What a cause adds: 0 cubic, 1 lag, 2 the cubic once more under another name, 3 a fifth power, which is
/// nearly a cubic.
pub(crate) fn added(kind: usize, value: f64, experiment: usize, i: usize) -> f64 {
    let u = input(experiment, i);
    let before = input(experiment, i.saturating_sub(1));
    match kind {
        0 | 2 => value * u.powi(3),
        1 => value * (u - before) * 10.0,
        _ => value * u.powi(5),
    }
}

impl Simulator for Toy {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        Ok((0..EXPERIMENTS)
            .map(|e| {
                (0..SAMPLES)
                    .map(|i| {
                        let own: f64 =
                            effects.iter().map(|x| added(x.candidate, x.values[0], e, i)).sum();
                        input(e, i) + own
                    })
                    .collect()
            })
            .collect())
    }
}

pub(crate) fn candidate(id: &'static str) -> Candidate {
    let size = Parameter { name: "size", unit: "1", low: -2.0, high: 2.0, ..Parameter::default() };
    Candidate {
        id,
        parameters: vec![Parameter { is_amount: true, ..size }],
        form_error: 0.05,
        starts: vec![vec![0.05], vec![-0.05]],
        ..Candidate::default()
    }
}

pub(crate) fn noise(seed: &mut u64) -> f64 {
    // sum of twelve uniform numbers less six: variance 1
    (0..12)
        .map(|_| {
            *seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 11) as f64 / (1_u64 << 53) as f64
        })
        .sum::<f64>()
        - 6.0
}

/// Traces of the toy with something added; the base may move its gain by one per cent.
pub(crate) fn traces(truth: impl Fn(usize, usize) -> f64, seed: u64) -> Vec<Trace> {
    let mut state = seed;
    (0..EXPERIMENTS)
        .map(|e| Trace {
            experiment: e,
            step_s: 1e-2,
            measured: (0..SAMPLES)
                .map(|i| input(e, i) + truth(e, i) + NOISE * noise(&mut state))
                .collect(),
            sigma: NOISE,
            spectrum: Spectrum::default(),
            noise: NOISE,
            nuisance: DMatrix::from_fn(SAMPLES, 1, |i, _| 0.01 * input(e, i)),
            block: 40,
            role: TraceRole::Output,
        })
        .collect()
}

/// What is found beside surrogates that leave these structures.
pub(crate) fn find_beside(
    traces: &[Trace],
    candidates: &[Candidate],
    structures: &[Signal],
) -> Finding {
    Discovery { structures, ..Discovery::new(traces, &Toy, candidates) }.find().unwrap()
}

pub(crate) fn find(traces: &[Trace], candidates: &[Candidate]) -> Finding {
    let generic: Vec<Signal> = [4, 5]
        .map(|power| {
            (0..EXPERIMENTS)
                .map(|e| (0..SAMPLES).map(|i| input(e, i).powi(power)).collect())
                .collect()
        })
        .into_iter()
        .collect();
    let settings = Settings { resamplings: 200, ..Settings::default() };
    let discovery =
        Discovery { generic: &generic, settings, ..Discovery::new(traces, &Toy, candidates) };
    discovery.find().unwrap()
}

/// The toy with a meter beside every output, which reads a ramp of the size of a lag or of a fifth power.
pub(crate) struct Metered;

pub(crate) fn ramp(i: usize) -> f64 {
    i as f64 / SAMPLES as f64
}

impl Simulator for Metered {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        let mut all = Toy.predict(effects)?;
        let shown = effects.iter().filter(|x| [1, 3].contains(&x.candidate));
        let size: f64 = shown.map(|x| x.values[0]).sum();
        all.extend((0..EXPERIMENTS).map(|_| (0..SAMPLES).map(|i| size * ramp(i)).collect()));
        Ok(all)
    }
}

/// Traces of the toy with something added, and meters that read a ramp of a size; the meters weigh as if so many
/// times as noisy as they are.
pub(crate) fn traces_beside_meters(
    truth: impl Fn(usize, usize) -> f64,
    ramp_read: f64,
    role: TraceRole,
    doubt: f64,
) -> Vec<Trace> {
    let mut traces = traces(truth, 11);
    let mut state = 3;
    for e in 0..EXPERIMENTS {
        let reads = |i| ramp_read * ramp(i) + NOISE * noise(&mut state);
        let measured = (0..SAMPLES).map(reads).collect();
        let nuisance = DMatrix::zeros(SAMPLES, 1);
        let sigma = doubt * NOISE;
        traces.push(Trace { measured, nuisance, role, sigma, ..traces[e].clone() });
    }
    traces
}

/// What a simulator finds, with no directions and surrogates.
pub(crate) fn find_by(
    simulator: &impl Simulator,
    traces: &[Trace],
    candidates: &[Candidate],
) -> Finding {
    let settings = Settings { resamplings: 200, ..Settings::default() };
    Discovery { settings, ..Discovery::new(traces, simulator, candidates) }.find().unwrap()
}

/// What is found where the meters read a ramp of a size, and a lag of another acts on the outputs.
pub(crate) fn found_beside_meters(
    ramp_read: f64,
    lag: f64,
    role: TraceRole,
    doubt: f64,
) -> Finding {
    let traces = traces_beside_meters(|e, i| added(1, lag, e, i), ramp_read, role, doubt);
    find_by(&Metered, &traces, &[candidate("cubic"), candidate("lag")])
}
