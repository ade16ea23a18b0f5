//! scratch
mod c {}
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::*;
use rotor_wake::*;
use std::sync::Arc;
use std::time::Instant;
use trim::*;
#[test]
fn coupled() {
    let blade = BladeProperties::new(BladeSpec {
        twist: Twist::Linear { rate_rad: (-8.0_f64).to_radians() },
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    })
    .unwrap();
    let flap = |start, end| TrailingEdgeFlap {
        start,
        end,
        chord_fraction: 0.2,
        mass_fraction: 0.1,
        cg_fraction: 0.2,
        effectiveness: FlapEffectiveness::IDEAL,
    };
    let model = RotorModel {
        blades: 4,
        chord: 0.055,
        lock_number: 5.2,
        drag_coefficient: 0.01,
        root_cutout: 0.2,
        modal_damping: 0.005,
        couplings: Couplings::Full,
        section_model: AttachedFlowModel::HariharanLeishman,
        compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
        reverse_flow: ReverseFlow::default(),
        flaps: vec![flap(0.70, 0.75), flap(0.80, 0.85)],
    };
    let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
    let mu = std::env::var("MU").ok().and_then(|s| s.parse().ok()).unwrap_or(0.3);
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default()).unwrap();
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    let ts = TrimSettings::default();
    let t0 = Instant::now();
    let d = trim(&mut solver, &LinearInflow::Drees, mu, &target, &ts, None).unwrap();
    eprintln!(
        "drees {:.2}s it {} inflow its {} 4/rev {:?}",
        t0.elapsed().as_secs_f64(),
        d.iterations,
        d.rotor.residuals.inflow_iterations,
        d.rotor.hub.harmonic(4).map(|x| (x * 1e6).round())
    );
    let p = trim(&mut solver, &PittPeters, mu, &target, &ts, None).unwrap();
    eprintln!(
        "pitt {:.2}s it {} inflow its {} 4/rev {:?}",
        t0.elapsed().as_secs_f64(),
        p.iterations,
        p.rotor.residuals.inflow_iterations,
        p.rotor.hub.harmonic(4).map(|x| (x * 1e6).round())
    );
    let t0 = Instant::now();
    let s = WakeTrimSettings::default();
    let w = trim_in_free_wake(&mut solver, &s, mu, &target, &ts).unwrap();
    eprintln!(
        "free {:.2}s {:?} inflow its {} resid {:.1e}\n{:#?}",
        t0.elapsed().as_secs_f64(),
        w.outcome,
        w.trim.rotor.residuals.inflow_iterations,
        w.trim.residual,
        w.updates.iter().map(|u| format!("{u:?}")).collect::<Vec<_>>()
    );
    eprintln!(
        "controls {:?} vs {:?}; closest {:?}",
        w.trim.controls, d.controls, w.closest_passage
    );
    eprintln!(
        "4/rev {:?} vs {:?}",
        w.trim.rotor.hub.harmonic(4).map(|x| (x * 1e6).round()),
        d.rotor.hub.harmonic(4).map(|x| (x * 1e6).round())
    );
    eprintln!(
        "mean inflow {} glauert {}",
        w.trim.rotor.inflow.mean(),
        momentum_inflow(&w.trim.flight, w.trim.rotor.thrust_coefficient).unwrap()
    );
}
