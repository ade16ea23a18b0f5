//! Trim and free wake together: that it settles, and where it stops if it does not.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the measured differences are worth seeing")]

use flap_aero::{AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, NonlinearSections,
    ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{
    CoreModel, FarTrailers, FreeWakeSettings, InducedInflow, WakeError, WakeMethod, WakeSymmetry,
};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use trim::{
    TrimError, TrimSettings, TrimTarget, WakeOutcome, WakeTrim, WakeTrimSettings,
    linearised_in_wake, trim_in_free_wake, trim_in_free_wake_near, wake_difference,
};

/// A rotor of few modes and time elements.
fn small(advance_ratio: f64) -> RotorSolver {
    few_modes(RotorModel::table_1(Couplings::Full), advance_ratio)
}

fn few_modes(model: RotorModel, advance_ratio: f64) -> RotorSolver {
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let few = Discretisation { modes: [2, 1, 1], time_elements: 4, ..Discretisation::default() };
    let rotor = Rotor::new(model, &blade, few).unwrap();
    RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default()).unwrap()
}

fn coupled(
    advance_ratio: f64,
    settings: &WakeTrimSettings,
    ct_sigma: f64,
) -> Result<WakeTrim, TrimError> {
    let target = TrimTarget::WindTunnel {
        ct_sigma,
        shaft_tilt_rad: advance_ratio * 0.3,
        hub_moments: [0.0; 2],
    };
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

/// Sections that feel a wake at more azimuths than its geometry has come nearer to the wake that is fine throughout; at those of
/// the geometry nothing changes.
#[test]
fn sections_feel_a_wake_at_more_azimuths_than_its_geometry_has() {
    let with = |azimuths: usize, section_azimuths: Option<usize>| {
        let settings = few_steps(2);
        let wake = settings.wake.with_azimuths(azimuths);
        coupled(0.25, &WakeTrimSettings { wake, section_azimuths, ..settings }, 0.07)
    };
    let coarse = with(12, None).unwrap();
    let same = with(12, Some(12)).unwrap();
    let bits = |of: &WakeTrim| of.trim.rotor.hub.mean().map(f64::to_bits);
    assert_eq!(bits(&same), bits(&coarse));
    let both = with(12, Some(36)).unwrap();
    let fine = with(36, None).unwrap();
    assert_eq!((both.outcome.clone(), both.moving.azimuths()), (WakeOutcome::Settled, 36));
    assert_eq!((both.wake.settings().azimuths, both.moving_of_the_wake().azimuths()), (12, 12));
    let loads = |of: &WakeTrim| of.trim.rotor.hub.harmonic(4);
    let off = |of: &WakeTrim| {
        let pairs = loads(of).into_iter().zip(loads(&fine));
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    println!("4/rev loads off by {:.2e}, with fine sections {:.2e}", off(&coarse), off(&both));
    assert!(off(&both) < 0.5 * off(&coarse), "{} {}", off(&both), off(&coarse));
    for refused in [Some(20), Some(6), Some(372)] {
        let error = with(12, refused).unwrap_err().to_string();
        assert!(error.contains("section_azimuths"), "{error}");
    }
}

/// `2 pi alpha` from ahead, `2 pi (alpha -+ pi)` from behind, in a table without drag and moment.
fn linear_law() -> NonlinearSections {
    let angles_deg: Vec<f64> = vec![-180.0, -90.5, -90.0, 90.0, 90.5, 180.0];
    let lift = |a: f64| TAU * if a.abs() > 0.501 * PI { a - PI.copysign(a) } else { a };
    let table = |f: &dyn Fn(f64) -> f64| {
        let values = angles_deg.iter().map(|a| f(a.to_radians())).collect();
        C81Table::new(vec![0.0], angles_deg.clone(), values).unwrap()
    };
    let name = "LINEAR".into();
    let airfoil =
        C81Airfoil { name, lift: table(&lift), drag: table(&|_| 0.0), moment: table(&|_| 0.0) };
    let span = AirfoilSpan::new(vec![(0.0, airfoil)]).unwrap();
    NonlinearSections { airfoils: Some(Arc::new(span)), dynamic_stall: None }
}

/// The circulation of sections from tables reaches the wake: with the linear law in a table, wake and loads are those of
/// the linear model, angles being small. What is left falls with the square of the angles.
#[test]
fn sections_from_a_table_carry_the_wake_of_the_linear_law() {
    let mu = 0.15;
    let coupled = |nonlinear, scale: f64| {
        let model = RotorModel {
            nonlinear,
            drag_coefficient: 0.0,
            section_model: AttachedFlowModel::Incompressible,
            compressibility: Compressibility::None,
            ..RotorModel::table_1(Couplings::Full)
        };
        let twist = Twist::Linear { rate_rad: -0.14 * scale };
        let blade = BladeProperties::new(BladeSpec { twist, ..BladeSpec::table_1() }).unwrap();
        let few =
            Discretisation { modes: [2, 1, 1], time_elements: 4, ..Discretisation::default() };
        let rotor = Arc::new(Rotor::new(model, &blade, few).unwrap());
        // beside such small loads
        let tolerances = ResponseTolerances {
            periodicity: 1e-14,
            inflow: 1e-13,
            ..ResponseTolerances::default()
        };
        let mut solver = RotorSolver::new(rotor, mu, tolerances).unwrap();
        let [theta0_rad, theta1c_rad, theta1s_rad] = [0.15, 0.02, -0.06].map(|angle| scale * angle);
        let controls = Controls { theta0_rad, theta1c_rad, theta1s_rad };
        let target = TrimTarget::Prescribed { controls, shaft_tilt_rad: 0.08 * scale };
        let settings = few_steps(2);
        trim_in_free_wake(&mut solver, &settings, mu, &target, &TrimSettings::default()).unwrap()
    };
    let apart = |scale: f64| {
        let pair = [NonlinearSections::default(), linear_law()].map(|law| coupled(law, scale));
        let of = |values: &dyn Fn(&WakeTrim) -> Vec<f64>| {
            let [a, b] = pair.each_ref().map(values);
            let size = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
        };
        // of the velocity in the plane, which is smaller, the geometry leaves more unsettled than the law
        let inflow = of(&|wake| match &wake.trim.rotor.inflow {
            InducedInflow::Map(map) => map.values().to_vec(),
            other => other.parameters(),
        });
        [inflow, of(&|wake| wake.trim.rotor.hub.harmonic(4).to_vec())]
    };
    let [small, large] = [3e-3, 1.2e-2].map(apart);
    for (what, (a, b)) in ["inflow", "loads at 4/rev"].into_iter().zip(small.iter().zip(large)) {
        println!("{what} apart by {a:.1e}, at four times the angles by {b:.1e}");
    }
    assert!(small.iter().all(|apart| *apart < 1e-6), "{small:?}");
    for (small, large) in small.iter().zip(large) {
        assert!((0.5..2.0).contains(&(large / small / 16.0)), "{small:e} {large:e}");
    }
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
    for ct_sigma in [0.09, 0.105, 0.12, 0.13, 0.14, 0.15] {
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

/// From a trim nearby the same trim is found as from nothing.
#[test]
fn a_trim_nearby_leads_to_the_same_trim() {
    let settings = few_steps(3);
    let near = coupled(0.25, &settings, 0.066).unwrap();
    let whole = coupled(0.25, &settings, 0.07).unwrap();
    let target = TrimTarget::WindTunnel {
        ct_sigma: 0.07,
        shaft_tilt_rad: 0.25 * 0.3,
        hub_moments: [0.0; 2],
    };
    let solver = &mut small(0.25);
    let led = trim_in_free_wake_near(solver, &settings, &near, &target, &TrimSettings::default())
        .unwrap();
    assert_eq!(led.outcome, WakeOutcome::Settled);
    let apart = (led.trim.controls.theta0_rad - whole.trim.controls.theta0_rad).abs();
    println!("{apart:.1e} rad, {} updates for {}", led.updates.len(), whole.updates.len());
    assert!(apart < 0.01_f64.to_radians(), "{apart}");
}

fn distance<'a>(pairs: impl Iterator<Item = (&'a [f64; 12], &'a [f64; 12])>) -> f64 {
    let mut sums = [0.0, 0.0];
    for (x, y) in pairs.flat_map(|(a, b)| a.iter().zip(b)) {
        sums[0] += (x - y).powi(2);
        sums[1] += y * y;
    }
    f64::sqrt(sums[0] / sums[1])
}

/// The rotor linearised with the whole answer of its wake against differences of converged responses, each in a wake of
/// its own; with the geometry of the wake held it is out of the same bound.
#[test]
fn the_linearised_rotor_holds_what_its_wake_answers() {
    let (mu, step_deg, settings) = (0.25, 0.25, few_steps(3));
    let mut solver = few_modes(RotorModel::paper_case(), mu);
    let target =
        TrimTarget::WindTunnel { ct_sigma: 0.07, shaft_tilt_rad: mu * 0.3, hub_moments: [0.0; 2] };
    let trimmed =
        trim_in_free_wake(&mut solver, &settings, mu, &target, &TrimSettings::default()).unwrap();
    let flaps = solver.rotor().model().flaps.len();
    let moved = |n: usize, angle_rad: f64| {
        let mut motion = vec![HarmonicSeries::zero(n); flaps];
        motion[flaps - 1].set_harmonic(n, Harmonic { cosine: angle_rad, sine: 0.0 });
        motion
    };
    let condition = |flap_angles_rad| Condition {
        flight: trimmed.trim.flight,
        bank_rad: trimmed.trim.attitude.roll_rad,
        controls: trimmed.trim.controls,
        flap_angles_rad,
    };
    let per_deg = 1.0_f64.to_radians();
    let directions: Vec<_> = (2..=5).map(|n| moved(n, per_deg)).collect();
    let rest = condition(moved(0, 0.0));
    let found =
        linearised_in_wake(&trimmed, &solver, &settings, &rest, &directions, step_deg).unwrap();
    let differences: Vec<[f64; 12]> = (2..=5)
        .map(|n| {
            let [plus, minus] =
                [1.0, -1.0].map(|side| condition(moved(n, side * step_deg * per_deg)));
            let both = wake_difference(&trimmed, &solver, &settings, [&plus, &minus]).unwrap();
            both.last().map(|z| z / (2.0 * step_deg))
        })
        .collect();
    let of = |columns: &[[f64; 12]]| {
        let each = columns.iter().zip(&differences);
        each.map(|pair| distance(std::iter::once(pair))).fold(0.0, f64::max)
    };
    let (whole, held) = (of(&found.hub), of(&found.held));
    println!("largest distance at 2 to 5/rev: {whole:.4}, geometry held {held:.4}");
    assert!(whole <= 0.02, "{whole}");
    assert!(held > 0.04, "{held}");
}
