//! Trim against published-style sanity values, its own equations and its error paths.
#![expect(clippy::disallowed_methods, reason = "tests read shipped tables")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the measured coefficients are worth seeing")]

use flap_aero::{AirfoilSpan, C81Airfoil};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Compressibility, Controls, Couplings, Discretisation, DynamicStall, NonlinearSections,
    ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::LinearInflow;
use std::sync::Arc;
use trim::{HorizontalTail, TrimError, TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};

fn solver(advance_ratio: f64) -> RotorSolver {
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let model = RotorModel::table_1(Couplings::Full);
    let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
    RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default()).unwrap()
}

fn propulsive(weight_ct_sigma: f64) -> TrimTarget {
    TrimTarget::Propulsive { weight_ct_sigma, vehicle: Vehicle::default() }
}

fn solve(advance_ratio: f64, target: &TrimTarget) -> Result<TrimSolution, TrimError> {
    let settings = TrimSettings::default();
    trim(&mut solver(advance_ratio), &LinearInflow::Uniform, advance_ratio, target, &settings, None)
}

#[test]
fn prescribed_controls_are_left_alone() {
    let controls = Controls { theta0_rad: 0.14, theta1c_rad: 0.01, theta1s_rad: -0.07 };
    let target = TrimTarget::Prescribed { controls, shaft_tilt_rad: 0.05 };
    let t = solve(0.2, &target).unwrap();
    assert_eq!(t.controls, controls);
    assert_eq!(t.iterations, 0);
}

#[test]
fn a_thrust_out_of_reach_is_an_error_with_its_history() {
    let error = solve(0.3, &propulsive(0.45)).unwrap_err();
    assert!(
        matches!(&error, TrimError::OutOfReach { history, .. } | TrimError::NoDescent { history, .. } if !history.is_empty()),
        "{error}"
    );
    assert!(matches!(solve(0.7, &propulsive(0.07)), Err(TrimError::Parameter { .. })));
    assert!(matches!(solve(0.2, &propulsive(-1.0)), Err(TrimError::Parameter { .. })));
}

/// Attached sections give any lift: what no aerofoil gives is no trim.
#[test]
fn a_thrust_beyond_the_lift_of_any_aerofoil_is_an_error_with_its_history() {
    let target =
        TrimTarget::WindTunnel { ct_sigma: 0.27, shaft_tilt_rad: 0.0, hub_moments: [0.0; 2] };
    let error = solve(0.0, &target).unwrap_err();
    assert!(
        matches!(&error, TrimError::BeyondStall { lift_coefficient, history, .. }
            if (lift_coefficient - 1.62).abs() < 1e-12 && history.len() > 1),
        "{error}"
    );
}

/// Controls that ask for such a thrust are no flight either.
#[test]
fn prescribed_controls_beyond_the_lift_of_any_aerofoil_are_an_error() {
    let controls = Controls { theta0_rad: 25.0_f64.to_radians(), ..Controls::default() };
    let error = solve(0.0, &TrimTarget::Prescribed { controls, shaft_tilt_rad: 0.0 }).unwrap_err();
    assert!(
        matches!(&error, TrimError::BeyondStall { lift_coefficient, .. } if *lift_coefficient > 1.5),
        "{error}"
    );
}

/// The hardest working section: on the retreating side, harder with the thrust.
#[test]
fn the_section_that_lifts_hardest_is_on_the_retreating_side() {
    let mut last = 0.0;
    for ct_sigma in [0.07, 0.10, 0.12, 0.14] {
        let mut solver = solver(0.3);
        let (settings, target) = (TrimSettings::default(), propulsive(ct_sigma));
        let found = trim(&mut solver, &LinearInflow::Drees, 0.3, &target, &settings, None);
        let most = solver.largest_section_lift(&found.unwrap().rotor).unwrap();
        println!("{ct_sigma}: {most:?}");
        assert!(most.lift_coefficient > last);
        last = most.lift_coefficient;
        let side = most.azimuth_rad.to_degrees();
        assert!((180.0..360.0).contains(&side), "{side}");
    }
}

/// A lag mode that comes to one per rev at the collective of the trim alone.
#[test]
fn an_undamped_mode_at_a_harmonic_in_flight_is_named() {
    let lag_1 = |ei_lag: f64, modal_damping: f64| {
        let spec = BladeSpec { lag_stiffness: ei_lag.into(), ..BladeSpec::table_1() };
        let blade = BladeProperties::new(spec).unwrap();
        let model = RotorModel { modal_damping, ..RotorModel::table_1(Couplings::Full) };
        let few = Discretisation { modes: [2, 1, 1], ..Discretisation::default() };
        Arc::new(Rotor::new(model, &blade, few).unwrap())
    };
    let level = |rotor: Arc<Rotor>| {
        let mut solver = RotorSolver::new(rotor, 0.2, ResponseTolerances::default()).unwrap();
        let settings = TrimSettings::default();
        trim(&mut solver, &LinearInflow::Drees, 0.2, &propulsive(0.07), &settings, None)
    };
    // in flight: 1.000 per rev; at no collective 1.05
    let ei_lag = 0.078;
    let error = level(lag_1(ei_lag, 0.0)).unwrap_err().to_string();
    assert!(error.contains("lag 1 at 6.30 deg has 1.0004 per rev, near the harmonic 1"), "{error}");
    lag_1(ei_lag, 0.0).refuse_resonance(0.0).unwrap();
    level(lag_1(ei_lag, 0.005)).unwrap();
    // off the harmonic it is trimmed, led there by damping
    level(lag_1(0.084, 0.0)).unwrap();
}

/// Every advance ratio trims from the first guess, and in few iterations: a guess far from trim once
/// sent some of them wandering.
#[test]
fn every_advance_ratio_trims_from_the_first_guess() {
    for k in 0..=10 {
        let mu = 0.05 * f64::from(k);
        let t = solve(mu, &propulsive(0.07)).unwrap();
        assert!(t.iterations <= 12, "mu {mu}: {:?}", t.residual_history);
        assert!(t.residual <= 1e-9);
    }
}

/// A tail that pushes down lifts the nose: the hub must carry less nose-up moment, so the shaft tilts less
/// and the cyclic changes; without area nothing changes.
#[test]
fn a_horizontal_tail_takes_over_pitch_moment() {
    let of = |area: f64| {
        let horizontal_tail = HorizontalTail { area, incidence_rad: -0.03, ..HorizontalTail::NONE };
        let vehicle = Vehicle { horizontal_tail, ..Vehicle::default() };
        solve(0.3, &TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle }).unwrap()
    };
    let (bare, tailed) = (of(0.0), of(0.01));
    let plain = solve(0.3, &propulsive(0.07)).unwrap();
    assert_eq!(bare.controls, plain.controls, "a tail without area is no tail");
    let (before, after) = (bare.rotor.hub.mean(), tailed.rotor.hub.mean());
    // the hub's pitching moment about the centre of gravity balances the tail's
    let dynamic = 0.5 * 5.2 / (3.0 * std::f64::consts::TAU) / 0.055 * std::f64::consts::PI;
    let tilt = tailed.attitude.shaft_tilt_rad;
    let lift = dynamic * (0.3 / tilt.cos()).powi(2) * 0.01 * 4.0 * (-0.03 - tilt);
    assert!(lift < 0.0);
    let hub_moment = after[4] + 0.2 * after[0];
    assert!((hub_moment - 1.2 * lift * tilt.cos()).abs() < 1e-8, "{hub_moment} against {lift}");
    assert!(after[2] > before[2], "the rotor carries the tail's download");
}

#[test]
fn a_bad_tail_is_named() {
    let horizontal_tail = HorizontalTail { area: -0.1, ..HorizontalTail::NONE };
    let vehicle = Vehicle { horizontal_tail, ..Vehicle::default() };
    let error = solve(0.3, &TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle }).unwrap_err();
    assert!(error.to_string().contains("horizontal_tail.area"), "{error}");
}

/// A rotor over the shipped table with dynamic stall.
fn stalling(advance_ratio: f64) -> RotorSolver {
    let path =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/airfoils/naca0012_synthetic.c81");
    let airfoil = C81Airfoil::read(&std::fs::read_to_string(path).unwrap()).unwrap();
    let airfoils = Some(Arc::new(AirfoilSpan::new(vec![(0.2, airfoil)]).unwrap()));
    let model = RotorModel {
        nonlinear: NonlinearSections {
            airfoils,
            dynamic_stall: Some(DynamicStall::Of(flap_aero::StallAirfoil::Naca0012)),
        },
        compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
        ..RotorModel::paper_case()
    };
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
    RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default()).unwrap()
}

fn stalled_trim(ct_sigma: f64) -> Result<TrimSolution, TrimError> {
    let target = TrimTarget::WindTunnel {
        ct_sigma,
        shaft_tilt_rad: 5.0_f64.to_radians(),
        hub_moments: [0.0; 2],
    };
    trim(&mut stalling(0.25), &LinearInflow::Drees, 0.25, &target, &TrimSettings::default(), None)
}

/// Near the largest thrust vortices leave over much of the retreating side, and the motion is still periodic to the
/// tolerance of any other; beyond it the search says so.
#[test]
fn dynamic_stall_is_trimmed_up_to_its_edge() {
    let found = stalled_trim(0.12).unwrap();
    assert!(found.residual <= 1e-9 && found.rotor.residuals.periodicity <= 1e-11);
    let Err(TrimError::Stalled { reached, history, .. }) = stalled_trim(0.2) else {
        panic!("twice the lift of the sections was trimmed");
    };
    assert!((0.1..0.19).contains(&reached) && !history.is_empty(), "{reached} {history:?}");
}

/// A rotor in a tunnel is trimmed to the hub moments asked for, at the same thrust; the cyclic pitch moves in proportion.
#[test]
fn a_tunnel_trim_meets_given_hub_moments() {
    let found = |hub_moments: [f64; 2]| {
        let target = TrimTarget::WindTunnel { ct_sigma: 0.07, shaft_tilt_rad: 0.05, hub_moments };
        solve(0.2, &target).unwrap()
    };
    let asked = [1e-3, -1.5e-3];
    let (none, given, turned) = (found([0.0; 2]), found(asked), found(asked.map(|m| -m)));
    let weight = none.rotor.hub.mean()[2];
    for (solution, wanted) in [(&none, [0.0; 2]), (&given, asked), (&turned, asked.map(|m| -m))] {
        let mean = solution.rotor.hub.mean();
        assert!((mean[2] - weight).abs() < 2e-9 * weight, "{mean:?}");
        for (found, wanted) in mean[3..5].iter().zip(wanted) {
            assert!((found - wanted).abs() < 2e-9 * weight, "{found} {wanted}");
        }
    }
    let cyclic = |s: &TrimSolution| [s.controls.theta1c_rad, s.controls.theta1s_rad];
    for k in 0..2 {
        let [rest, plus, minus] = [&none, &given, &turned].map(|s| cyclic(s)[k]);
        assert!((plus - rest).abs() > 1e-3, "{plus} {rest}");
        // linear but for the coupled inflow
        assert!((plus + minus - 2.0 * rest).abs() < 0.02 * (plus - rest).abs(), "{plus} {minus}");
    }
}
