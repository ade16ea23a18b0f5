//! Checks of the response against closed forms and identities.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::{paper_blade, paper_flaps, paper_model};
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, ResponseTolerances,
    ReverseFlow, Rotor, RotorModel, RotorSolution, RotorSolver, TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow, WakeRotor};
use std::sync::Arc;

fn controls_deg(theta0: f64, theta1c: f64, theta1s: f64) -> Controls {
    Controls {
        theta0_rad: theta0.to_radians(),
        theta1c_rad: theta1c.to_radians(),
        theta1s_rad: theta1s.to_radians(),
    }
}

fn forward(controls: Controls) -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.09 },
        controls,
        flap_angles_rad: vec![],
    }
}

fn solve(
    model: RotorModel,
    blade: &BladeProperties,
    discretisation: Discretisation,
    condition: &Condition,
    inflow: &LinearInflow,
) -> RotorSolution {
    let rotor = Rotor::new(model, blade, discretisation).unwrap();
    let mu = condition.flight.advance_ratio;
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default()).unwrap();
    solver.solve(condition, inflow, None).unwrap()
}

/// Pitch at the root once a revolution is cyclic pitch: the same loads, motion and lines of the wake.
#[test]
fn root_pitch_once_a_revolution_is_cyclic_pitch() {
    let rotor = Rotor::new(paper_model(Couplings::Full), &paper_blade(), Discretisation::default())
        .unwrap();
    let solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let cyclic = forward(controls_deg(8.0, 2.0, -5.0));
    let without = Condition { controls: controls_deg(8.0, 0.0, 0.0), ..cyclic.clone() };
    let mut once = HarmonicSeries::zero(1);
    let Controls { theta1c_rad: cosine, theta1s_rad: sine, .. } = cyclic.controls;
    once.set_harmonic(1, Harmonic { cosine, sine });
    let pitched = solver.with_root_pitch(once);
    let panels = WakeRotor::uniform(4, solver.rotor().model().root_cutout, 8).unwrap();
    let of = |solver: &RotorSolver, condition: &Condition| {
        let found = solver.clone().solve(condition, &LinearInflow::Drees, None).unwrap();
        let lines = solver.blade_lines(&found.modal, &condition.controls, &panels, 12);
        (found.hub.harmonic(4), lines.edge_at(3)[8], found.modal[0].harmonic(1).amplitude())
    };
    let (a, b, c) = (of(&solver, &cyclic), of(&pitched, &without), of(&solver, &without));
    let apart = |x: &[f64], y: &[f64]| {
        x.iter().zip(y).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()))
    };
    assert!(apart(&a.0, &b.0) < 1e-10 && apart(&a.0, &c.0) > 1e-6);
    assert!(apart(&a.1, &b.1) < 1e-9 && apart(&a.1, &c.1) > 1e-4);
    assert!((a.2 - b.2).abs() < 1e-9 && (a.2 - c.2).abs() > 1e-3);
}

/// Thrust of a stiff coned blade in hover. The part of the rotation along the blade, `Omega sin bp`,
/// turns its sections nose up and adds to the lift; the centrifugal force adds nothing:
///
/// ```text
/// C_T = (sigma a / 2) cos bp int_{x0}^1 (theta x - lambda + (c/2) bp) x dx
/// ```
#[test]
fn precone_turns_the_centrifugal_force_out_of_the_thrust() {
    let (lambda, theta0_deg) = (0.04, 8.0);
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: controls_deg(theta0_deg, 0.0, 0.0),
        flap_angles_rad: vec![],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: lambda };
    for precone_deg in [0.0_f64, 2.0, 4.0] {
        let bp = precone_deg.to_radians();
        let stiff = BladeProperties::new(BladeSpec {
            precone_rad: bp,
            ..BladeSpec::uniform(1e3, 1e3, 1e3, 1e3)
        })
        .unwrap();
        let model = paper_model(Couplings::Full);
        let moment = |n: i32| (1.0 - model.root_cutout.powi(n + 1)) / f64::from(n + 1);
        let angle =
            theta0_deg.to_radians() * moment(2) + (0.5 * model.chord * bp - lambda) * moment(1);
        let expected = 0.5 * model.solidity() * std::f64::consts::TAU * bp.cos() * angle;
        let got = solve(model, &stiff, Discretisation::default(), &condition, &inflow);
        let ct = got.thrust_coefficient;
        assert!((ct / expected - 1.0).abs() <= 5e-3, "{precone_deg} deg: {ct} against {expected}");
    }
}

fn flapped(amplitude_deg: f64, harmonic: usize) -> RotorSolution {
    let mut angle = HarmonicSeries::zero(5);
    angle.set_harmonic(harmonic, Harmonic::from_amplitude_phase(amplitude_deg.to_radians(), 0.4));
    let condition = Condition {
        flap_angles_rad: vec![HarmonicSeries::zero(1), angle],
        ..forward(controls_deg(8.0, 1.0, -4.5))
    };
    let model = RotorModel { flaps: paper_flaps(), ..paper_model(Couplings::Full) };
    let d = Discretisation::default();
    solve(model, &paper_blade(), d, &condition, &LinearInflow::Drees)
}

/// Near 3/rev the outboard flap moves the 4/rev loads, in proportion to its angle.
#[test]
fn flap_authority_is_nearly_linear() {
    let rest = flapped(0.0, 3).hub.harmonic(4);
    let response = |amplitude: f64| -> Vec<f64> {
        flapped(amplitude, 3)
            .hub
            .harmonic(4)
            .iter()
            .zip(rest)
            .map(|(a, b)| (a - b) / amplitude)
            .collect()
    };
    let (small, large) = (response(0.5), response(4.0));
    let size: f64 = small.iter().map(|v| v * v).sum::<f64>().sqrt();
    let gap: f64 =
        small.iter().zip(&large).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / size;
    assert!(size > 1e-5, "no authority: {size:e}");
    assert!(gap < 0.02, "4 deg differ from 0.5 deg by {gap:e}");
}

/// 4/rev hub loads of the clamped rotor at mu .3, from a mesh to one twice as fine along the span and
/// in time, over their norm.
fn refinement(reverse_flow: ReverseFlow, root_cutout: f64) -> f64 {
    let [coarse, fine] = [1, 2].map(|factor| {
        let d = Discretisation::default();
        let d = Discretisation {
            span_points_per_piece: factor * d.span_points_per_piece,
            time_elements: factor * d.time_elements,
            ..d
        };
        let model = RotorModel { reverse_flow, root_cutout, ..paper_model(Couplings::Full) };
        let condition = forward(controls_deg(8.0, 1.0, -4.5));
        solve(model, &paper_blade(), d, &condition, &LinearInflow::Uniform).hub.harmonic(4)
    });
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
    norm(&mut coarse.iter().zip(&fine).map(|(a, b)| a - b)) / norm(&mut fine.iter().copied())
}

/// The default mesh resolves the reverse-flow region, because the circulation passes through zero
/// there; with the jump of the small-angle form it does not, unless nothing lifts there.
#[test]
fn the_default_mesh_resolves_the_reverse_flow_region() {
    let gradual = refinement(ReverseFlow::Gradual, 0.2);
    assert!(gradual <= 0.003, "{gradual}");
    let abrupt = refinement(ReverseFlow::Abrupt, 0.2);
    assert!(abrupt > 2.0 * gradual, "{abrupt}");
    let outboard = refinement(ReverseFlow::Abrupt, 0.35);
    assert!(outboard <= 0.001, "{outboard}");
    println!("gradual {gradual:.2e}, abrupt {abrupt:.2e}, cut-out .35 {outboard:.2e}");
}

/// The calibrated sections in flight: lag states from the fast pressure waves of the inner blade to
/// the slow wake, periodic, at every local Mach number.
#[test]
fn calibrated_sections_fly() {
    let solve_flaps =
        |section_model: AttachedFlowModel, effectiveness: FlapEffectiveness, elements: usize| {
            let mut angle = HarmonicSeries::zero(5);
            angle.set_harmonic(3, Harmonic::from_amplitude_phase(0.03, 0.4));
            let condition = Condition {
                flap_angles_rad: vec![HarmonicSeries::zero(1), angle],
                ..forward(controls_deg(8.0, 1.0, -4.5))
            };
            let model = RotorModel {
                flaps: paper_flaps()
                    .into_iter()
                    .map(|flap| TrailingEdgeFlap { effectiveness, ..flap })
                    .collect(),
                section_model,
                compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
                ..paper_model(Couplings::Full)
            };
            let d = Discretisation { time_elements: elements, ..Discretisation::default() };
            solve(model, &paper_blade(), d, &condition, &LinearInflow::Drees).hub
        };
    let solve_with = |model, elements| solve_flaps(model, FlapEffectiveness::IDEAL, elements);
    let solve_effective = |effectiveness, elements| {
        solve_flaps(AttachedFlowModel::Calibrated, effectiveness, elements)
    };
    let elements = Discretisation::default().time_elements;
    let calibrated = solve_with(AttachedFlowModel::Calibrated, elements);
    let size = |v: &[f64; 12]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let gap = |a: &[f64; 12], b: &[f64; 12]| size(&std::array::from_fn(|i| a[i] - b[i])) / size(a);
    // the time elements converge
    let [fine, finer] = [3, 4].map(|n| solve_with(AttachedFlowModel::Calibrated, n * elements));
    let resolved = gap(&finer.harmonic(4), &fine.harmonic(4));
    let default = gap(&finer.harmonic(4), &calibrated.harmonic(4));
    // a flap of half the effect moves the loads about half as far
    let weak = FlapEffectiveness::new(0.5, 0.5, 0.5).unwrap();
    let parts = [FlapEffectiveness::new(0.0, 0.0, 0.0).unwrap(), weak].map(|effectiveness| {
        gap(&calibrated.harmonic(4), &solve_effective(effectiveness, elements).harmonic(4))
    });
    assert!((parts[1] / parts[0] - 0.5).abs() < 0.02, "{parts:?}");
    // the slope-matched form decays too fast: it is near, and it is not the same
    let matched = solve_with(AttachedFlowModel::HariharanLeishman, elements);
    let apart = gap(&calibrated.harmonic(4), &matched.harmonic(4));
    let [mean, other] = [&calibrated, &matched].map(|hub| hub.mean()[2]);
    let mean = (other / mean - 1.0).abs();
    println!("default time elements {default:.2e}");
    println!(
        "4/rev: finer time elements {resolved:.2e}, slope-matched form {apart:.3}, mean {mean:.2e}"
    );
    assert!(resolved < 5e-3 && default < 0.01, "{resolved} {default}");
    assert!((0.003..0.5).contains(&apart), "{apart}");
    assert!(mean < 0.02, "{mean}");
}

#[test]
fn bad_models_are_refused_with_the_field() {
    let message = |model: RotorModel| {
        Rotor::new(model, &paper_blade(), Discretisation::default()).unwrap_err().to_string()
    };
    let base = || paper_model(Couplings::Full);
    assert!(message(RotorModel { chord: -0.1, ..base() }).contains("chord"));
    assert!(message(RotorModel { lock_number: f64::NAN, ..base() }).contains("lock_number"));
    let mut flaps = paper_flaps();
    flaps[1].end = 1.2;
    assert!(message(RotorModel { flaps, ..base() }).contains("flap 1"));
}
