//! Budgets on one core: the modes of a ten-element blade 40 ms with Coriolis terms, 2 ms uncoupled;
//! one time-element solve of ten degrees of freedom 20 ms, with a kept factorisation 1 ms; one nonlinear
//! 15-dof element, residual with its three tangents, 0.02 ms; the static state of ten of them 50 ms; the
//! modal residual of ten modes at 60 stations 0.05 ms, at eight azimuths side by side 0.1 ms.
//!
//! The trim solves for the orbit hundreds of times and for the modes once. Each bench ends with a line
//! that sets the mean of a short run against its budget.
#![allow(missing_docs, reason = "criterion's macros write undocumented items")]
#![expect(clippy::print_stdout, reason = "a bench reports its figures")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, DVector};
use rotor_base::{Lanes, Number};
use rotor_fem::{
    BladeModel, BladeProperties, BladeSpec, FemError, GyroscopicTerms, ModalBasis, ModalBlade,
    ModalMotion, ModalShape, ModeCount, ModeKind, ModerateBlade, ModerateModel, NodalMotion, Orbit,
    PeriodicSettings, PeriodicSolver, PitchMotion, SectionShape, StaticSettings, TimeElements,
    UncoupledMode, modes, uncoupled_modes,
};

#[path = "../tests/all/linear/mod.rs"]
mod linear;

use linear::{LinearCoefficients, LinearPeriodic};

/// Runs a bench and prints the share of its budget that it used.
fn measure(c: &mut Criterion, name: &str, budget_ms: f64, mut run: impl FnMut()) {
    let mut mean_ms = 0.0;
    c.bench_function(name, |b| {
        b.iter_custom(|count| {
            #[expect(clippy::disallowed_methods, reason = "a bench is about the clock")]
            let start = std::time::Instant::now();
            for _ in 0..count {
                run();
            }
            let spent = start.elapsed();
            mean_ms = 1e3 * spent.as_secs_f64() / count as f64;
            spent
        });
    });
    println!("{name}: {mean_ms:.3} ms, {:.2} of the budget of {budget_ms} ms", mean_ms / budget_ms);
}

/// Ten coupled oscillators at the paper rotor's frequencies with 1/rev coefficients.
fn ten_modes() -> LinearPeriodic<impl Fn(f64) -> LinearCoefficients + Sync> {
    let frequencies = [1.126, 3.422, 7.667, 13.92, 0.701, 4.300, 10.90, 20.66, 4.588, 13.52];
    LinearPeriodic::new(DMatrix::identity(10, 10), move |psi: f64| {
        let square = DVector::from_iterator(10, frequencies.iter().map(|w| w * w));
        let mut stiffness = DMatrix::from_diagonal(&square);
        let mut damping = DMatrix::identity(10, 10) * 0.3;
        for i in 0..9 {
            stiffness[(i, i + 1)] += 0.1 * psi.cos();
            damping[(i + 1, i)] += 0.1 * psi.sin();
        }
        LinearCoefficients { damping, stiffness, load: DVector::from_element(10, psi.sin().exp()) }
    })
}

fn blade_modes(c: &mut Criterion) -> Result<(), FemError> {
    let spec = BladeSpec { pitch_rad: 0.14, ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 200.0) };
    let blade = BladeProperties::new(spec)?;
    let count = ModeCount::default();
    measure(c, "coupled modes, 10 elements, Coriolis terms", 50.0, || {
        let found = BladeModel::new(blade.clone(), 10)
            .and_then(|model| modes(&model, GyroscopicTerms::Included, count));
        black_box(found.is_ok());
    });
    measure(c, "uncoupled modes, 10 elements", 2.0, || {
        black_box(uncoupled_modes(&blade, 10, count, ModalBasis::Natural).is_ok());
    });
    Ok(())
}

/// The blade in the coordinates of its uncoupled modes.
fn modal_blade(model: &ModerateModel) -> Result<ModalBlade, FemError> {
    let (count, basis) = (ModeCount::default(), ModalBasis::Natural);
    let set = uncoupled_modes(model.blade().properties(), model.elements(), count, basis)?;
    let section = |mode: &UncoupledMode, x: f64| {
        let (shape, still) = (mode.shape(x)?, SectionShape::default());
        Ok::<_, FemError>(match mode.kind {
            ModeKind::Flap => SectionShape { flap: shape, ..still },
            ModeKind::Lag => SectionShape { lag: shape, ..still },
            _ => SectionShape { twist: [shape[0], shape[1]], ..still },
        })
    };
    let stations = ModalBlade::stations_of(model.edges(), 6)?;
    let shape = |mode: &UncoupledMode| {
        let root = section(mode, model.edges()[0])?;
        let sections = stations.iter().map(|x| section(mode, *x)).collect::<Result<_, _>>()?;
        Ok::<_, FemError>(ModalShape { root, sections })
    };
    let shapes = set.modes().iter().map(shape).collect::<Result<_, _>>()?;
    ModalBlade::new(model.blade(), model.edges(), 6, shapes)
}

/// One element, so that the figure is the element's.
fn nonlinear_blade(c: &mut Criterion) -> Result<(), FemError> {
    let spec = BladeSpec { pitch_rad: 0.14, ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 200.0) };
    let blade = ModerateBlade::new(spec.into())?;
    let one = ModerateModel::new(blade.clone(), 1)?;
    let load = one.tip_load([0.0, 0.0, 0.01], 0.0);
    let bent = NodalMotion::steady(one.static_state(&load, &StaticSettings::default())?.dof);
    let pitch = one.own_pitch();
    measure(c, "nonlinear element, residual", 0.01, || {
        black_box(one.force(black_box(&bent), pitch));
    });
    measure(c, "nonlinear element, residual and tangents", 0.02, || {
        black_box(one.tangents(black_box(&bent), pitch));
    });
    let ten = ModerateModel::new(blade, 10)?;
    let load = ten.distributed_load(|x| [0.0, 0.0, 0.03 * x * x, 0.0]);
    let settings = StaticSettings::default();
    measure(c, "static state, 10 elements", 50.0, || {
        black_box(ten.static_state(&load, &settings).is_ok());
    });
    let modal = modal_blade(&ten)?;
    let [value, rate, acceleration] = [0.01, 0.02, 0.03].map(|a| vec![a; modal.modes()]);
    let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
    measure(c, "modal residual, 10 modes, 60 stations", 0.05, || {
        black_box(modal.force(black_box(motion), pitch));
    });
    let side_by_side = |of: &[f64]| of.iter().map(|q| Lanes::of(*q)).collect::<Vec<_>>();
    let [value, rate, acceleration] = [&value, &rate, &acceleration].map(|of| side_by_side(of));
    let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
    let PitchMotion { angle_rad, rate, acceleration } = pitch;
    let pitch = PitchMotion {
        angle_rad: Lanes::of(angle_rad),
        rate: Lanes::of(rate),
        acceleration: Lanes::of(acceleration),
    };
    let loads = vec![[Lanes::of(0.01); 4]; modal.stations().len()];
    measure(c, "the same under loads at eight azimuths side by side", 0.1, || {
        black_box(modal.unbalanced_side_by_side(black_box(motion), pitch, &loads));
    });
    Ok(())
}

fn orbits(c: &mut Criterion) -> Result<(), FemError> {
    let time = TimeElements::default();
    let system = ten_modes();
    let zero = Orbit::zero(&time, 10);
    let new = PeriodicSolver::new(time, PeriodicSettings::default())?;
    let mut solver = new.clone();
    measure(c, "time elements, 10 dof, new factorisation", 20.0, || {
        solver = new.clone();
        black_box(solver.solve(&system, &zero).is_ok());
    });
    measure(c, "time elements, 10 dof, kept factorisation", 1.0, || {
        black_box(solver.solve(&system, &zero).is_ok());
    });
    Ok(())
}

fn benches(c: &mut Criterion) {
    for outcome in [blade_modes(c), nonlinear_blade(c), orbits(c)] {
        if let Err(error) = outcome {
            println!("bench not run: {error}");
        }
    }
}

criterion_group!(solvers, benches);
criterion_main!(solvers);
