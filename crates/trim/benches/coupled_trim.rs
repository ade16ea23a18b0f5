//! One coupled trim of the paper's rotor: level flight at an advance ratio of 0.30, Drees's inflow, default
//! discretisation, from nothing, on one core.
//!
//! Budget: 0.5 s.

use criterion::{Criterion, criterion_group, criterion_main};
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Compressibility, Couplings, Discretisation, FlapMass, NonlinearSections, ResponseTolerances,
    ReverseFlow, Rotor, RotorModel, RotorSolver, SectionOffsets, TrailingEdgeFlap,
};
use rotor_wake::LinearInflow;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trim::{TrimError, TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};

const BUDGET_S: f64 = 0.5;
const MU: f64 = 0.3;

fn rotor() -> Result<Arc<Rotor>, TrimError> {
    let spec = BladeSpec {
        twist: Twist::Linear { rate_rad: (-8.0_f64).to_radians() },
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    };
    let blade = BladeProperties::new(spec).map_err(rotor_response::ResponseError::from)?;
    let flap = |start, end| TrailingEdgeFlap {
        start,
        end,
        chord_fraction: 0.2,
        mass_fraction: 0.1,
        cg_fraction: 0.2,
        gyration_fraction: None,
        mass: FlapMass::PartOfBlade,
        effectiveness: FlapEffectiveness::IDEAL,
    };
    let model = RotorModel {
        blades: 4,
        chord: 0.055,
        lock_number: 5.2,
        drag_coefficient: 0.01,
        root_cutout: 0.2,
        tip_loss: 1.0,
        gravity: 0.0,
        offsets: SectionOffsets::default(),
        modal_damping: 0.005,
        couplings: Couplings::Full,
        section_model: AttachedFlowModel::HariharanLeishman,
        compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
        reverse_flow: ReverseFlow::default(),
        flaps: vec![flap(0.70, 0.75), flap(0.80, 0.85)],
        nonlinear: NonlinearSections::default(),
    };
    Ok(Arc::new(Rotor::new(model, &blade, Discretisation::default())?))
}

/// The section aerodynamics of the flight condition and the trim.
fn coupled_trim(rotor: &Arc<Rotor>) -> Result<TrimSolution, TrimError> {
    let mut solver = RotorSolver::new(Arc::clone(rotor), MU, ResponseTolerances::default())?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    trim(&mut solver, &LinearInflow::Drees, MU, &target, &TrimSettings::default(), None)
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn bench(criterion: &mut Criterion) {
    let Ok(one_core) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    let Ok(rotor) = rotor() else { return };
    let mut run = || black_box(one_core.install(|| coupled_trim(&rotor)));
    if let Err(error) = run() {
        println!("no trim: {error}");
        return;
    }
    let (started, count) = (Instant::now(), 5);
    for _ in 0..count {
        let _ = run();
    }
    let each = started.elapsed().as_secs_f64() / f64::from(count);
    println!("coupled trim: {:.0} ms, {:.2} of the budget", 1e3 * each, each / BUDGET_S);
    criterion.bench_function("coupled_trim", |b| b.iter(&mut run));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(5));
    targets = bench
}
criterion_main!(benches);
