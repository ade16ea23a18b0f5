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

/// Time of a call, the best of many short batches: other work on the machine interrupts some of them,
/// not all. Printed against the budget.
fn against_budget(name: &str, mut call: impl FnMut()) {
    const CALLS: u32 = 1_000;
    const BATCHES: u32 = 5_000;
    let best = (0..BATCHES)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..CALLS {
                call();
            }
            start.elapsed().as_nanos() as f64 / f64::from(CALLS)
        })
        .fold(f64::INFINITY, f64::min);
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

criterion_group!(benches, steps, others);
criterion_main!(benches);
