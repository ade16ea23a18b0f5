//! One periodic response of the paper rotor with moving flaps.
//!
//! Budget: 50 ms from a nearby orbit at the default discretisation on one core, so that a T matrix of
//! twelve columns costs less than a second.

use criterion::{Criterion, criterion_group, criterion_main};
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, FlapMass, NonlinearSections,
    ResponseError, ResponseTolerances, ReverseFlow, Rotor, RotorModel, RotorSolver, SectionOffsets,
    TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

const BUDGET_S: f64 = 0.05;

fn solver(section_model: AttachedFlowModel) -> Result<RotorSolver, ResponseError> {
    let blade = BladeProperties::new(BladeSpec {
        twist: Twist::Linear { rate_rad: (-8.0_f64).to_radians() },
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    })?;
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
        tip_loss: 1.0,
        gravity: 0.0,
        offsets: SectionOffsets::default(),
        blades: 4,
        chord: 0.055,
        lock_number: 5.2,
        drag_coefficient: 0.01,
        root_cutout: 0.2,
        modal_damping: 0.005,
        couplings: Couplings::Full,
        section_model,
        compressibility: match section_model {
            AttachedFlowModel::Incompressible => Compressibility::None,
            _ => Compressibility::LocalMach { tip_mach: 0.582 },
        },
        reverse_flow: ReverseFlow::default(),
        flaps: vec![flap(0.70, 0.75), flap(0.80, 0.85)],
        nonlinear: NonlinearSections::default(),
    };
    let rotor = Rotor::new(model, &blade, Discretisation::default())?;
    RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default())
}

fn condition(amplitude_rad: f64) -> Condition {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: amplitude_rad, sine: 0.0 });
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
        controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
        flap_angles_rad: vec![angle.clone(), angle],
    }
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn response(criterion: &mut Criterion) {
    for model in [
        AttachedFlowModel::QuasiSteady,
        AttachedFlowModel::Incompressible,
        AttachedFlowModel::HariharanLeishman,
        AttachedFlowModel::Calibrated,
    ] {
        let built = solver(model).and_then(|mut s| {
            let rest = s.solve(&condition(0.0), &LinearInflow::Drees, None)?;
            Ok((s, rest))
        });
        let Ok((mut solver, rest)) = built else { continue };
        let moved = condition(0.05);
        let mut run = || black_box(solver.solve(&moved, &LinearInflow::Drees, Some(&rest)));
        let (started, count) = (Instant::now(), 10);
        for _ in 0..count {
            let _ = run();
        }
        let each = started.elapsed().as_secs_f64() / f64::from(count);
        println!("{model:?}: {:.1} ms, {:.2} of the budget", 1e3 * each, each / BUDGET_S);
        criterion.bench_function(&format!("response/{model:?}"), |b| b.iter(&mut run));
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(3));
    targets = response
}
criterion_main!(benches);
