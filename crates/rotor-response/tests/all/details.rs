//! Weight of the blades, loss of lift at the tip, mass off the axis, blades unlike each other: closed forms
//! of stiff blades.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::{paper_blade, paper_model, paper_spec};
use rotor_fem::{BladeProperties, BladeSpec, Distribution, Joint, RootSupport, TorsionTerms};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, OtherBlade, Planform, ResponseTolerances,
    Rotor, RotorModel, RotorSolution, RotorSolver, SectionOffsets, dissimilar_hub_loads,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

const INFLOW: LinearInflow = LinearInflow::Prescribed { induced_inflow: 0.02 };

fn stiff() -> BladeSpec {
    BladeSpec::uniform(1e3, 1e3, 1e3, 1e6)
}

fn spring(stiffness: f64) -> Joint {
    Joint::Spring { stiffness }
}

fn hover(theta0_rad: f64) -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls { theta0_rad, ..Controls::default() },
        flap_angles_rad: vec![],
    }
}

fn solver(model: RotorModel, spec: BladeSpec, modes: [usize; 3], mu: f64) -> RotorSolver {
    let blade = BladeProperties::new(spec).unwrap();
    let d = Discretisation { modes, ..Discretisation::default() };
    let rotor = Arc::new(Rotor::new(model, &blade, d).unwrap());
    RotorSolver::new(rotor, mu, ResponseTolerances::default()).unwrap()
}

fn solve(model: RotorModel, spec: BladeSpec, condition: &Condition) -> RotorSolution {
    let mu = condition.flight.advance_ratio;
    solver(model, spec, [1, 1, 1], mu).solve(condition, &INFLOW, None).unwrap()
}

#[track_caller]
fn near(got: f64, expected: f64, allowed: f64) {
    assert!((got - expected).abs() <= allowed, "{got} against {expected}, allowed {allowed:e}");
}

/// A stiff blade on springs at the rotor centre, in vacuum, shaft tilted and banked:
///
/// ```text
/// flap  beta = -(3/2) g_n / nu_b^2,   nu_b^2 = 1 + 3 k_b
/// lag   zeta = (3/2) (g_x sin psi - g_y cos psi) / (nu_z^2 - 1),   nu_z^2 = 3 k_z
/// ```
/// with `(g_x, g_y, g_n) = g (sin a cos f, -sin f, cos a cos f)`.
#[test]
fn a_blade_droops_under_its_weight() {
    let (g, tilt, bank) = (0.001_23, 0.2_f64, -0.1_f64);
    let (kb, kz) = (0.08, 0.9);
    let root = RootSupport { flap: spring(kb), lag: spring(kz), ..RootSupport::CLAMPED };
    let condition = Condition {
        bank_rad: bank,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: tilt },
        ..hover(0.0)
    };
    let up = [tilt.sin() * bank.cos(), -bank.sin(), tilt.cos() * bank.cos()];
    for (couplings, allowed) in [
        (Couplings::Linear, 2e-5),
        (Couplings::Full, 2e-3),
        (Couplings::Moderate(TorsionTerms::default()), 4e-3),
    ] {
        let model = RotorModel {
            lock_number: 1e-9,
            modal_damping: 0.0,
            gravity: g,
            ..paper_model(couplings)
        };
        let stiff = BladeSpec::uniform(1e5, 1e5, 1e5, 1e8);
        let unit = model.thrust_coefficient(1.0);
        let found = solve(model, BladeSpec { root, ..stiff }, &condition);
        let flap = -1.5 * g * up[2] / (1.0 + 3.0 * kb);
        let lag = 1.5 * g / (3.0 * kz - 1.0);
        near(found.modal[0].mean, flap, allowed * flap.abs());
        let first = found.modal[1].harmonic(1);
        near(first.sine, lag * up[0], allowed * lag);
        near(first.cosine, -lag * up[1], allowed * lag);
        // the hub carries the weight, whatever the blades do; the thrust is none of it
        let mean = found.hub.mean();
        for (k, part) in up.iter().enumerate() {
            near(mean[k], -4.0 * g * part, 1e-8);
        }
        near(found.thrust_coefficient / unit, 0.0, 1e-9);
    }
}

/// A stiff blade on a free lag hinge at `(e, y_t)` points away from the rotor centre, `zeta = y_t / e`, and
/// puts no moment on the shaft; on a spring it stands between that and its rest:
///
/// ```text
/// zeta = y_t S / (k + e S),   S = (1 - e)^2 / 2
/// ```
/// A centrifugal force points away from the shaft: it has no moment about it, spring or not.
#[test]
fn a_lag_hinge_turns_toward_the_torque_offset() {
    let (e, torque) = (0.06, 0.004);
    for (couplings, allowed) in [(Couplings::Linear, 1e-5), (Couplings::Full, 3e-3)] {
        for stiffness in [0.0, 0.02] {
            let lag = if stiffness == 0.0 { Joint::Free } else { spring(stiffness) };
            let model = RotorModel {
                lock_number: 1e-9,
                modal_damping: 0.0,
                offsets: SectionOffsets { torque, ..SectionOffsets::default() },
                ..paper_model(couplings)
            };
            let blade = BladeSpec {
                root: RootSupport { lag, ..RootSupport::CLAMPED },
                root_offset: e,
                ..BladeSpec::uniform(1e5, 1e5, 1e5, 1e8)
            };
            let found = solve(model, blade, &hover(0.0));
            let first_moment = 0.5 * (1.0 - e) * (1.0 - e);
            let angle = torque * first_moment / (stiffness + e * first_moment);
            let tip = found.modal[1].mean;
            near(tip / (1.0 - e), angle, allowed * angle);
            // the shaft feels the spring and the force on the hinge: none together, the rest is radial
            let torque_on_hub = found.root.mean()[5];
            near(torque_on_hub, 0.0, 2e-3 * torque * first_moment);
        }
    }
}

/// Lift ahead of the elastic axis twists a stiff blade on a pitch spring:
///
/// ```text
/// k phi = e_d L,   L = (1/2) rho c a int x^2 (theta + phi) - x lambda dx
/// ```
#[test]
fn lift_ahead_of_the_elastic_axis_turns_the_blade_nose_up() {
    let (stiffness, theta, lambda) = (0.01, 0.1, 0.02);
    for centre in [0.002, -0.004] {
        let model = RotorModel {
            offsets: SectionOffsets { aerodynamic_centre: centre, ..SectionOffsets::default() },
            ..paper_model(Couplings::Linear)
        };
        let blade = BladeSpec {
            root: RootSupport { feather: spring(stiffness), ..RootSupport::CLAMPED },
            thickness_gyration_radius: 0.02.into(),
            chord_gyration_radius: 0.02.into(),
            area_gyration_radius: 0.0.into(),
            ..BladeSpec::uniform(1e5, 1e5, 1e5, 1e8)
        };
        let moment = |n: i32| (1.0 - model.root_cutout.powi(n + 1)) / f64::from(n + 1);
        let lift = std::f64::consts::PI * model.density_chord();
        let expected = centre * lift * (theta * moment(2) - lambda * moment(1))
            / (stiffness - centre * lift * moment(2));
        let found = solve(model, blade, &hover(theta));
        near(found.modal[2].mean, expected, 1e-3 * expected.abs());
    }
}

/// A clamped elastic blade sags by its weight in every coupling alike: the hub load is the weight, and the
/// moment at the root is what the closed form of a stiff blade bounds.
#[test]
fn weight_of_the_elastic_blade_is_on_the_hub() {
    let model = RotorModel {
        lock_number: 1e-9,
        gravity: 0.001_23,
        ..paper_model(Couplings::Moderate(TorsionTerms::default()))
    };
    let found = solve(model, paper_spec(), &hover(0.1));
    near(found.hub.mean()[2], -4.0 * 0.001_23, 1e-9);
    assert!(found.modal[0].mean < -1e-4, "{}", found.modal[0].mean);
}

/// Thrust of a stiff untwisted blade in hover that loses its lift outboard of B, at a given inflow; the
/// profile drag stays:
///
/// ```text
/// C_T = (sigma a / 2) (theta (B^3 - x0^3) / 3 - lambda (B^2 - x0^2) / 2)
/// C_Q = (sigma a / 2) lambda C_T' + sigma c_d (1 - x0^4) / 8
/// ```
#[test]
fn the_tip_loses_its_lift_and_keeps_its_drag() {
    let (theta, lambda) = (0.15, 0.02);
    for tip_loss in [1.0_f64, 0.97, 0.9] {
        for couplings in [Couplings::Linear, Couplings::Full] {
            let model = RotorModel { tip_loss, ..paper_model(couplings) };
            let x0 = model.root_cutout;
            let moment = |n: i32, to: f64| (to.powi(n) - x0.powi(n)) / f64::from(n);
            let half = 0.5 * model.solidity() * std::f64::consts::TAU;
            let ct = half * (theta * moment(3, tip_loss) - lambda * moment(2, tip_loss));
            let induced =
                half * lambda * (theta * moment(3, tip_loss) - lambda * moment(2, tip_loss));
            let cq = induced + 0.5 * model.solidity() * model.drag_coefficient * moment(4, 1.0);
            let unit = model.thrust_coefficient(1.0);
            let found = solve(model, stiff(), &hover(theta));
            near(found.thrust_coefficient / ct, 1.0, 2e-4);
            near(-unit * found.hub.mean()[5] / cq, 1.0, 2e-3);
        }
    }
}

/// Mass ahead of the axis of a stiff coned blade is thrown down by rotation, and twists the pitch link:
///
/// ```text
/// phi = -(e_g bp / 2) / (k + k_m2^2 - k_m1^2)
/// ```
#[test]
fn mass_ahead_of_the_axis_twists_the_coned_blade() {
    let (cone, link) = (0.05, 0.03);
    let root = RootSupport { feather: spring(link), ..RootSupport::CLAMPED };
    let twist = |mass_centre: f64| {
        let model = RotorModel {
            lock_number: 1e-9,
            offsets: SectionOffsets { mass_centre, ..SectionOffsets::default() },
            ..paper_model(Couplings::Moderate(TorsionTerms::default()))
        };
        let spec = BladeSpec { root, precone_rad: cone, ..stiff() };
        solve(model, spec, &hover(0.0)).modal[2].mean
    };
    for offset in [0.004, -0.008] {
        let radii = 0.0247_f64.powi(2) - 0.0132_f64.powi(2);
        let expected = -0.5 * offset * cone / (link + radii);
        near(twist(offset), expected, 5e-3 * expected.abs());
    }
    near(twist(0.0), 0.0, 1e-9);
    let refused = RotorModel {
        offsets: SectionOffsets { mass_centre: 0.004, ..SectionOffsets::default() },
        ..paper_model(Couplings::Full)
    };
    let text = refused.validate().unwrap_err().to_string();
    assert!(text.contains("offsets.mass_centre") && text.contains("Moderate"), "{text}");
}

/// A stiff blade that weighs more pulls the hub round: `Delta F = Delta m R / 2` at 1/rev, in the plane.
#[test]
fn a_heavy_blade_shakes_the_hub_once_per_revolution() {
    let model = || RotorModel { lock_number: 1e-9, ..paper_model(Couplings::Full) };
    let condition = hover(0.0);
    let mut alike = solver(model(), stiff(), [1, 1, 1], 0.0);
    let about = alike.solve(&condition, &INFLOW, None).unwrap();
    for (position, more) in [(2, 0.02), (1, -0.01)] {
        let heavy = BladeSpec { mass: (1.0 + more).into(), ..stiff() };
        let mut others = [OtherBlade {
            position,
            solver: solver(model(), heavy, [1, 1, 1], 0.0),
            condition: condition.clone(),
        }];
        let hub = dissimilar_hub_loads(&mut alike, (&condition, &about), &mut others).unwrap();
        let (sin, cos) = (0.5 * std::f64::consts::PI * position as f64).sin_cos();
        let h = hub.harmonic(1);
        // the pull at azimuth psi + position 90 deg
        for (got, expected) in h.iter().zip([cos, -sin, sin, cos]) {
            near(*got, 0.5 * more * expected, 1e-6);
        }
        assert!(h[4..].iter().all(|load| load.abs() < 1e-9), "{h:?}");
    }
    let beyond = OtherBlade { position: 4, solver: alike.clone(), condition: condition.clone() };
    assert!(dissimilar_hub_loads(&mut alike, (&condition, &about), &mut [beyond]).is_err());
}

/// In flight an unlike blade lets every harmonic through; blades that are alike after all do not.
#[test]
fn unlike_blades_pass_every_harmonic() {
    let condition = Condition {
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.09 },
        controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.017, theta1s_rad: -0.08 },
        ..hover(0.0)
    };
    let model = || paper_model(Couplings::Full);
    let make = |spec: BladeSpec| solver(model(), spec, [4, 4, 2], 0.3);
    let mut alike = make(paper_spec());
    let about = alike.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let mut hub = |spec: BladeSpec| {
        let mut others =
            [OtherBlade { position: 2, solver: make(spec), condition: condition.clone() }];
        dissimilar_hub_loads(&mut alike, (&condition, &about), &mut others).unwrap()
    };
    let same = hub(paper_spec());
    for n in 0..=12 {
        let pairs = same.harmonic(n).into_iter().zip(about.hub.harmonic(n));
        let apart = pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(apart <= 1e-12, "{n}/rev: {apart:e}");
    }
    for (a, b) in same.mean().iter().zip(about.hub.mean()) {
        near(*a, b, 1e-12);
    }
    for unlike in [
        BladeSpec { mass: 1.01.into(), ..paper_spec() },
        BladeSpec { flap_stiffness: (0.0108 * 1.05).into(), ..paper_spec() },
    ] {
        let hub = hub(unlike);
        for n in [1, 2, 3, 5, 6, 7] {
            let largest = hub.harmonic(n).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            assert!(largest > 1e-9, "{n}/rev: {largest:e}");
        }
    }
    assert!(paper_blade().spec() == &paper_spec());
}

/// A table that says everywhere what the reference chord says changes no bit.
#[test]
fn a_chord_table_of_the_reference_chord_is_no_change() {
    let of = |chord: Option<Distribution>| {
        let model =
            RotorModel { planform: Planform { chord, set_back: None }, ..RotorModel::paper_case() };
        let rotor = Rotor::new(model, &paper_blade(), Discretisation::default()).unwrap();
        let solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default());
        solver.unwrap().solve(&common::condition(), &INFLOW, None).unwrap()
    };
    let chord = RotorModel::paper_case().chord;
    let table = Distribution::PiecewiseLinear { stations: vec![0.0, 1.0], values: vec![chord; 2] };
    let (with, without) = (of(Some(table)), of(None));
    assert_eq!(with.hub, without.hub);
    assert_eq!(with.hinge, without.hinge);
    assert_eq!(with.thrust_coefficient.to_bits(), without.thrust_coefficient.to_bits());
}
