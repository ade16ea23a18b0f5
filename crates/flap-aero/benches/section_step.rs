//! Cost of one section over one time step, and of its coefficients.
//!
//! Budget: 60 ns per section and step, flap included, for every model, with the decay factors made
//! beforehand: in a periodic flow they are the same every revolution. A step that makes its own
//! factors is measured beside it. The line `ratio to budget` under each sets the two side by side.
#![expect(clippy::print_stdout, reason = "the ratio to the budget is the bench's result")]
#![expect(clippy::unwrap_used, reason = "a bench whose inputs are refused cannot go on")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

use criterion::{Criterion, criterion_group, criterion_main};
use flap_aero::{
    AttachedFlowModel, FlapChord, FreeStream, Mach, MarchingSection, SectionCoefficients,
    SectionInputs, SectionState, StepFactors, section_loads,
};
use std::hint::black_box;
use std::time::Instant;

/// The budget of one step, ns.
const BUDGET_NS: f64 = 60.0;

fn section(model: AttachedFlowModel) -> SectionCoefficients {
    let mach = match model {
        AttachedFlowModel::Incompressible => Mach::ZERO,
        _ => Mach::new(0.5).unwrap(),
    };
    model.coefficients(mach, FlapChord::new(0.2).unwrap()).unwrap()
}

/// Time of a call in ns, the best of many short batches: other work on the machine interrupts some of
/// them, not all.
fn best_of(batches: u32, calls: u32, call: &mut impl FnMut()) -> f64 {
    (0..batches)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..calls {
                call();
            }
            start.elapsed().as_nanos() as f64 / f64::from(calls)
        })
        .fold(f64::INFINITY, f64::min)
}

fn against_budget(name: &str, mut call: impl FnMut()) {
    let best = best_of(5_000, 1_000, &mut call);
    println!("{name}: {best:.1} ns, ratio to budget {:.2}", best / BUDGET_NS);
}

fn steps(criterion: &mut Criterion) {
    let inputs = SectionInputs { modes: [0.05, 0.01, -0.03, 0.02], rates: [0.01, 0.0, 0.02, 0.0] };
    for model in AttachedFlowModel::ALL {
        let section = MarchingSection::new(&section(model));
        let name = model.name();

        let mut state = SectionState::at_rest(&section);
        let mut varying = || {
            black_box(state.step(&section, black_box(&inputs), black_box(0.37)).unwrap());
        };
        criterion.bench_function(&format!("step {name}"), |b| b.iter(&mut varying));
        against_budget(&format!("step {name}"), varying);

        let factors = StepFactors::new(&section, 0.37).unwrap();
        let mut state = SectionState::at_rest(&section);
        let mut constant = || {
            black_box(state.step_with(&section, black_box(&inputs), &factors).unwrap());
        };
        criterion.bench_function(&format!("step of constant length {name}"), |b| {
            b.iter(&mut constant);
        });
        against_budget(&format!("step of constant length {name}"), constant);
    }
}

fn others(criterion: &mut Criterion) {
    let flap = FlapChord::new(0.2).unwrap();
    for model in AttachedFlowModel::ALL {
        let mach = match model {
            AttachedFlowModel::Incompressible => Mach::ZERO,
            _ => Mach::new(0.5).unwrap(),
        };
        criterion.bench_function(&format!("coefficients {}", model.name()), |b| {
            b.iter(|| model.coefficients(black_box(mach), black_box(flap)).unwrap());
        });
    }
    let section = section(AttachedFlowModel::HariharanLeishman);
    let stream = FreeStream { density: 1.2, semichord: 0.25, speed: 170.0 };
    let lags = vec![0.1; section.lags.len()];
    criterion.bench_function("loads in a varying stream", |b| {
        b.iter(|| {
            section_loads(&section, &stream, black_box(&[1.0; 4]), &[0.0; 4], &lags).unwrap()
        });
    });
}

/// Sections along a blade.
const SECTIONS: usize = 20;

/// Calibrated sections side by side: every array runs over the sections, so that a vector instruction
/// works on several of them. An experiment, kept here to be repeated: see the README.
struct Batch {
    /// Lag by lag: the input it follows, its decay, its mean decay and its weights.
    lags: Vec<(usize, [[f64; SECTIONS]; 5])>,
    direct: [[[f64; SECTIONS]; 4]; 3],
    states: Vec<[f64; SECTIONS]>,
    inputs: [[f64; SECTIONS]; 4],
}

impl Batch {
    fn new(sections: &[SectionCoefficients], step: f64) -> Self {
        let over = |f: &dyn Fn(&SectionCoefficients) -> f64| -> [f64; SECTIONS] {
            std::array::from_fn(|s| f(&sections[s]))
        };
        let lags: Vec<_> = (0..sections[0].lags.len())
            .map(|l| {
                let follows = sections[0].lags[l].input.iter().position(|w| *w != 0.0);
                let gone = over(&|c| -(-c.lags[l].pole * step).exp_m1());
                let mean = over(&|c| -(-c.lags[l].pole * step).exp_m1() / (c.lags[l].pole * step));
                let weight = |o: usize| over(&|c| c.lags[l].output[o]);
                (follows.unwrap(), [gone, mean, weight(0), weight(1), weight(2)])
            })
            .collect();
        let direct = std::array::from_fn(|o| std::array::from_fn(|m| over(&|c| c.direct[o][m])));
        Self {
            states: vec![[0.0; SECTIONS]; lags.len()],
            lags,
            direct,
            inputs: [[0.0; SECTIONS]; 4],
        }
    }

    fn step(&mut self, inputs: &[[f64; SECTIONS]; 4]) -> [[f64; SECTIONS]; 3] {
        let mut out = [[0.0; SECTIONS]; 3];
        for (sum, direct) in out.iter_mut().zip(&self.direct) {
            for (weights, input) in direct.iter().zip(inputs) {
                for s in 0..SECTIONS {
                    sum[s] += weights[s] * input[s];
                }
            }
        }
        for ((follows, [gone, mean, weights @ ..]), state) in self.lags.iter().zip(&mut self.states)
        {
            let (old, new) = (&self.inputs[*follows], &inputs[*follows]);
            for s in 0..SECTIONS {
                let behind = state[s] - old[s];
                state[s] = new[s] - (new[s] - old[s]) * mean[s] + (behind - behind * gone[s]);
            }
            for (sum, weight) in out.iter_mut().zip(weights) {
                for s in 0..SECTIONS {
                    sum[s] += weight[s] * state[s];
                }
            }
        }
        self.inputs = *inputs;
        out
    }
}

/// A blade's sections one after the other, and side by side.
fn along_a_blade(criterion: &mut Criterion) {
    let flap = FlapChord::new(0.2).unwrap();
    let sections: Vec<SectionCoefficients> = (0..SECTIONS)
        .map(|s| {
            let mach = Mach::new(0.2 + 0.025 * s as f64).unwrap();
            AttachedFlowModel::Calibrated.coefficients(mach, flap).unwrap()
        })
        .collect();
    let modes = |s: usize| [0.05 + 0.001 * s as f64, 0.01, -0.03, 0.02];
    let marching: Vec<_> = sections.iter().map(MarchingSection::new).collect();
    let factors: Vec<_> = marching.iter().map(|m| StepFactors::new(m, 0.37).unwrap()).collect();
    let mut states: Vec<_> = marching.iter().map(SectionState::at_rest).collect();
    let mut batch = Batch::new(&sections, 0.37);
    let inputs: [[f64; SECTIONS]; 4] =
        std::array::from_fn(|m| std::array::from_fn(|s| modes(s)[m]));
    for _ in 0..3 {
        let together = batch.step(&inputs);
        for s in 0..SECTIONS {
            let at = SectionInputs { modes: modes(s), rates: [0.0; 4] };
            let alone = states[s].step_with(&marching[s], &at, &factors[s]).unwrap();
            for (a, b) in alone.iter().zip(&together) {
                assert!((a - b[s]).abs() < 1e-12, "the two are not the same sections");
            }
        }
    }
    let mut one_by_one = || {
        for s in 0..SECTIONS {
            let at = SectionInputs { modes: modes(s), rates: [0.0; 4] };
            black_box(states[s].step_with(&marching[s], black_box(&at), &factors[s]).unwrap());
        }
    };
    let scalar = per_section("20 sections one by one", &mut one_by_one);
    criterion.bench_function("20 sections one by one", |b| b.iter(&mut one_by_one));
    let mut side_by_side = || {
        black_box(batch.step(black_box(&inputs)));
    };
    let vector = per_section("20 sections side by side", &mut side_by_side);
    criterion.bench_function("20 sections side by side", |b| b.iter(&mut side_by_side));
    println!("one by one over side by side: {:.2}", scalar / vector);
}

/// Time per section of a call over all of them, ns.
fn per_section(name: &str, mut call: impl FnMut()) -> f64 {
    let best = best_of(2_000, 100, &mut call) / SECTIONS as f64;
    println!("{name}: {best:.1} ns per section, ratio to budget {:.2}", best / BUDGET_NS);
    best
}

criterion_group!(benches, steps, along_a_blade, others);
criterion_main!(benches);
