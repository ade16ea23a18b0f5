//! Trim and free wake together: that it settles, and where it stops if it does not.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Couplings, Discretisation, ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{
    CoreModel, FarTrailers, FreeWakeSettings, InducedInflow, WakeError, WakeMethod, WakeSymmetry,
};
use std::sync::Arc;
use trim::{
    TrimError, TrimSettings, TrimTarget, WakeOutcome, WakeTrim, WakeTrimSettings, trim_in_free_wake,
};

/// A rotor of few modes and time elements.
fn small(advance_ratio: f64) -> RotorSolver {
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let model = RotorModel::table_1(Couplings::Full);
    let few = Discretisation { modes: [2, 1, 1], time_elements: 4, ..Discretisation::default() };
    let rotor = Rotor::new(model, &blade, few).unwrap();
    RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default()).unwrap()
}

fn coupled(
    advance_ratio: f64,
    settings: &WakeTrimSettings,
    ct_sigma: f64,
) -> Result<WakeTrim, TrimError> {
    let target = TrimTarget::WindTunnel { ct_sigma, shaft_tilt_rad: advance_ratio * 0.3 };
    let trim_settings = TrimSettings::default();
    let solver = &mut small(advance_ratio);
    trim_in_free_wake(solver, settings, advance_ratio, &target, &trim_settings)
}

fn few_steps(turns: usize) -> WakeTrimSettings {
    let wake = FreeWakeSettings { azimuths: 12, turns, ..FreeWakeSettings::default() };
    WakeTrimSettings { wake, panels: 10, ..WakeTrimSettings::default() }
}

fn is_finite(wake: &WakeTrim) -> bool {
    let filaments = wake.wake.vortices();
    wake.trim.rotor.inflow.parameters().iter().all(|x| x.is_finite())
        && filaments.iter().all(|f| f.points.iter().flatten().flatten().all(|x| x.is_finite()))
}

/// At low speed the coupling settles; stopped early it says so, with the band of the collective, and keeps the update of
/// the least change.
#[test]
fn a_wake_at_low_speed_settles_or_says_where_it_stopped() {
    let settings = few_steps(3);
    let settled = coupled(0.15, &settings, 0.07).unwrap();
    assert_eq!(settled.outcome, WakeOutcome::Settled);
    assert!(settled.updates.last().unwrap().inflow_change <= settings.inflow_tolerance);
    let early = WakeTrimSettings { updates: 2, ..settings };
    let stopped = coupled(0.15, &early, 0.07).unwrap();
    let WakeOutcome::NotSettled {
        updates,
        inflow_change,
        tolerance,
        displacement,
        displacement_tolerance,
        theta0_band_rad: [low, high],
    } = stopped.outcome.clone()
    else {
        unreachable!("{:?}", stopped.outcome)
    };
    let normalised_residual =
        |change: f64, moved: f64| f64::max(change / tolerance, moved / displacement_tolerance);
    let each = stopped.updates.iter().map(|u| normalised_residual(u.inflow_change, u.displacement));
    let kept = normalised_residual(inflow_change, displacement);
    assert_eq!(kept.to_bits(), each.fold(f64::INFINITY, f64::min).to_bits());
    assert!(updates == 2 && kept > 1.0 && is_finite(&stopped));
    let angle = stopped.trim.controls.theta0_rad;
    assert!(low - 1e-4 <= angle && angle <= high + 1e-4, "{low} {angle} {high}");
}

/// A wake that still moves has not settled, however little the inflow changes.
#[test]
fn a_wake_that_moves_has_not_settled() {
    let still = coupled(0.25, &few_steps(2), 0.07).unwrap();
    assert_eq!(still.outcome, WakeOutcome::Settled);
    let last = *still.updates.last().unwrap();
    assert!(last.displacement <= few_steps(2).displacement_tolerance, "{last:?}");
    let exact = WakeTrimSettings { displacement_tolerance: 1e-12, updates: 3, ..few_steps(2) };
    let moving = coupled(0.25, &exact, 0.07).unwrap();
    let WakeOutcome::NotSettled { inflow_change, tolerance, displacement, .. } = moving.outcome
    else {
        unreachable!("{:?}", moving.outcome)
    };
    assert!(inflow_change <= tolerance && displacement > 1e-12, "{inflow_change} {displacement}");
}

/// In hover the wake that turns with its blades settles, carries more inflow than momentum theory asks, and is the same
/// at every azimuth.
#[test]
fn an_axial_wake_settles_in_hover() {
    let mut wake = FreeWakeSettings::hover(CoreModel::Vatistas);
    wake.core.mutual_radius = 0.05;
    let settings =
        WakeTrimSettings { wake, panels: 10, stages: Vec::new(), ..WakeTrimSettings::default() };
    let hover = coupled(0.0, &settings, 0.07).unwrap();
    assert_eq!(hover.outcome, WakeOutcome::Settled);
    let inflow = &hover.trim.rotor.inflow;
    let ideal = (0.5 * hover.trim.rotor.thrust_coefficient).sqrt();
    assert!((1.0..1.4).contains(&(inflow.mean() / ideal)), "{} {ideal}", inflow.mean());
    let InducedInflow::Map(map) = inflow else { unreachable!() };
    for i in 1..map.azimuths() {
        let pairs = map.row(i).iter().zip(map.row(0));
        assert!(pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) < 1e-6);
    }
    // a propulsive trim flies with cyclic pitch, the wake of a rotor that flies does not turn with it
    let refused = coupled(0.1, &settings, 0.07).unwrap_err();
    assert!(refused.to_string().contains("advance_ratio"), "{refused}");
}

/// Marched in time, the coupling ends; in forward flight it comes to the relaxed trim.
#[test]
fn a_marched_wake_ends_near_the_relaxed_one() {
    let relaxed = WakeTrimSettings { stages: Vec::new(), ..few_steps(2) };
    let marched = WakeTrimSettings {
        method: WakeMethod::Marched,
        sweeps: 2,
        inflow_tolerance: 1e-3,
        ..relaxed.clone()
    };
    let [relaxed, marched] = [relaxed, marched].map(|s| coupled(0.25, &s, 0.07).unwrap());
    assert_eq!(relaxed.outcome, WakeOutcome::Settled);
    assert_eq!(marched.outcome, WakeOutcome::Settled);
    let apart = (relaxed.trim.controls.theta0_rad - marched.trim.controls.theta0_rad).abs();
    assert!(apart < 0.3_f64.to_radians(), "{apart}");
    let hover = WakeTrimSettings {
        method: WakeMethod::Marched,
        sweeps: 1,
        updates: 6,
        ..WakeTrimSettings { stages: Vec::new(), ..few_steps(2) }
    };
    let hover = coupled(0.0, &hover, 0.07).unwrap();
    assert!(!hover.updates.is_empty() && is_finite(&hover));
    assert_ne!(hover.outcome, WakeOutcome::Settled);
}

/// Many thin vortices that meet the blades in hover drive inflow and circulation apart, or keep on wandering: which of
/// both hangs on the last digits, so that several thrusts are tried. Every one ends, says how and keeps numbers.
#[test]
fn a_coupling_that_runs_away_keeps_its_last_good_state() {
    let mut settings = few_steps(2);
    settings.wake.symmetry = WakeSymmetry::Axial;
    settings.wake.far = FarTrailers::Stations(vec![0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.92]);
    settings.wake.near_wake_rad = 0.25 * std::f64::consts::TAU;
    (settings.wake.core.radius, settings.wake.core.mutual_radius) = (5e-4, 0.0);
    (settings.wake.core.near_radius, settings.wake.core.panel_share) = (1e-3, f64::INFINITY);
    let mut runaways = 0;
    for ct_sigma in [0.10, 0.11, 0.12, 0.13] {
        let lost = coupled(0.0, &settings, ct_sigma).unwrap();
        assert!(is_finite(&lost));
        match &lost.outcome {
            WakeOutcome::Failed {
                error:
                    TrimError::Response(ResponseError::Wake(WakeError::InflowRunsAway {
                        change,
                        largest,
                        ..
                    })),
                ..
            } => {
                assert!(change > largest);
                runaways += 1;
            }
            WakeOutcome::Failed { error, .. } => assert!(!error.to_string().is_empty()),
            WakeOutcome::NotSettled { inflow_change, tolerance, .. } => {
                assert!(inflow_change > tolerance);
            }
            other => unreachable!("{other:?}"),
        }
    }
    assert!(runaways > 0);
}
