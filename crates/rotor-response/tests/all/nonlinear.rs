//! Rotors with aerofoil tables and dynamic stall: their linear limits, their order, their convergence.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use approx::assert_abs_diff_eq;
use common::{paper_blade, paper_flaps, paper_model, paper_spec};
use flap_aero::{AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table, Mach, StallParameters};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Camber, Compressibility, Condition, Controls, Couplings, Discretisation, DynamicStall,
    NonlinearSections, ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolution,
    RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A table of three functions of incidence (rad) and Mach number.
fn table(
    angles_deg: &[f64],
    machs: &[f64],
    [lift, drag, moment]: [&dyn Fn(f64, f64) -> f64; 3],
) -> C81Airfoil {
    let fill = |f: &dyn Fn(f64, f64) -> f64| {
        let values = angles_deg.iter().flat_map(|a| machs.iter().map(|m| f(a.to_radians(), *m)));
        C81Table::new(machs.to_vec(), angles_deg.to_vec(), values.collect()).unwrap()
    };
    C81Airfoil { name: "FORMULA".into(), lift: fill(lift), drag: fill(drag), moment: fill(moment) }
}

fn airfoils(airfoil: C81Airfoil) -> NonlinearSections {
    let span = AirfoilSpan::new(vec![(0.0, airfoil)]).unwrap();
    NonlinearSections { airfoils: Some(Arc::new(span)), dynamic_stall: None }
}

/// The law of the linear model: `2 pi alpha / beta` from ahead, `2 pi (alpha -+ pi) / beta` from behind.
fn linear_law(drag: f64) -> NonlinearSections {
    let machs: Vec<f64> = (0..=92).map(|i| 0.01 * f64::from(i)).collect();
    let slope = |m: f64| TAU / (1.0 - m * m).sqrt();
    let lift =
        |a: f64, m: f64| slope(m) * if a.abs() > 0.501 * PI { a - PI.copysign(a) } else { a };
    let angles = [-180.0, -90.5, -90.0, 90.0, 90.5, 180.0];
    airfoils(table(&angles, &machs, [&lift, &|_, _| drag, &|_, _| 0.0]))
}

/// The static curve of Kirchhoff with the slope of Mach 0 and the constants of the NACA 0012, a flat plate
/// beyond.
fn kirchhoff() -> NonlinearSections {
    let p = StallParameters::naca_0012(Mach::new(0.3).unwrap());
    let angles: Vec<f64> = (-360..=360).map(|i| 0.5 * f64::from(i)).collect();
    let forces = |a: f64| {
        let f = p.separation(a);
        let slope = TAU;
        let near = (1.0 - ((a.abs() - 0.4) / 0.3).clamp(0.0, 1.0)).powi(2);
        let normal = slope * a * StallParameters::kirchhoff(f);
        let chord = p.eta * slope * a * a * f.sqrt();
        [near * normal + (1.0 - near) * 1.9 * a.sin(), near * chord]
    };
    let lift = |a: f64, _: f64| forces(a)[0] * a.cos() + forces(a)[1] * a.sin();
    let drag = |a: f64, _: f64| 0.01 + forces(a)[0] * a.sin() - forces(a)[1] * a.cos();
    airfoils(table(&angles, &[0.0], [&lift, &drag, &|_, _| 0.0]))
}

fn controls(theta0: f64, theta1c: f64, theta1s: f64) -> Controls {
    let [theta0_rad, theta1c_rad, theta1s_rad] = [theta0, theta1c, theta1s].map(f64::to_radians);
    Controls { theta0_rad, theta1c_rad, theta1s_rad }
}

/// Solves, with flaps moving at 3 per rev if the model has any.
fn try_solve(
    model: RotorModel,
    discretisation: Discretisation,
    (mu, tilt, controls): (f64, f64, Controls),
    air: (LinearInflow, f64),
) -> Result<RotorSolution, ResponseError> {
    solve_blade(&paper_blade(), model, discretisation, (mu, tilt, controls), air)
}

fn solve_blade(
    blade: &BladeProperties,
    model: RotorModel,
    discretisation: Discretisation,
    (mu, tilt, controls): (f64, f64, Controls),
    (inflow, flap_rad): (LinearInflow, f64),
) -> Result<RotorSolution, ResponseError> {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: flap_rad, sine: 0.5 * flap_rad });
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: mu, shaft_tilt_rad: tilt },
        controls,
        flap_angles_rad: vec![angle; model.flaps.len()],
    };
    let rotor = Rotor::new(model, blade, discretisation)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default())?;
    solver.solve(&condition, &inflow, None)
}

fn loads(solution: &RotorSolution) -> Vec<f64> {
    let hub = (0..=1).flat_map(|n| solution.hub.harmonic(4 * n));
    let root = (1..=5).flat_map(|n| solution.root.harmonic(n));
    hub.chain(root).chain([solution.thrust_coefficient]).collect()
}

/// Largest difference of the loads over their largest.
fn distance(a: &RotorSolution, b: &RotorSolution) -> f64 {
    let (a, b) = (loads(a), loads(b));
    let size = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

fn flapped(section_model: AttachedFlowModel, tip_mach: Option<f64>) -> RotorModel {
    RotorModel {
        section_model,
        compressibility: tip_mach
            .map_or(Compressibility::None, |tip_mach| Compressibility::LocalMach { tip_mach }),
        flaps: paper_flaps(),
        ..paper_model(Couplings::Full)
    }
}

/// Half the beam elements and modes: enough for identities and comparisons.
fn coarse() -> Discretisation {
    Discretisation {
        blade_elements: 5,
        modes: [2, 1, 1],
        span_points_per_piece: 3,
        load_harmonics: 8,
        ..Discretisation::default()
    }
}

/// Small angles aside the table of the linear law is the linear model: the distance falls with the
/// square of the angles. Without drag, whose part normal to the disk the linear model leaves out.
#[test]
fn the_linear_law_in_a_table_is_the_linear_model() {
    let d = Discretisation::default();
    let distance = |section, tip_mach, (mu, scale): (f64, f64)| {
        let flight = (mu, 0.08 * scale, controls(8.0 * scale, scale, -4.0 * scale));
        let air = (LinearInflow::Prescribed { induced_inflow: 0.01 * scale }, 0.04 * scale);
        let linear = RotorModel { drag_coefficient: 0.0, ..flapped(section, tip_mach) };
        let tabled = RotorModel { nonlinear: linear_law(0.0), ..linear.clone() };
        let twist = Twist::Linear { rate_rad: (-8.0 * scale).to_radians() };
        let blade = BladeProperties::new(BladeSpec { twist, ..paper_spec() }).unwrap();
        let [a, b] = [linear, tabled].map(|m| solve_blade(&blade, m, d, flight, air).unwrap());
        distance(&a, &b)
    };
    for (section, tip_mach) in
        [(AttachedFlowModel::Incompressible, None), (AttachedFlowModel::Calibrated, Some(0.58))]
    {
        let [full, half, small] =
            [(0.3, 1.0), (0.3, 0.5), (0.15, 0.02)].map(|c| distance(section, tip_mach, c));
        println!("{section:?}: {full:.2e}, half the angles {half:.2e}, a fiftieth {small:.2e}");
        assert!(full < 1.5e-2, "{section:?} {full:e}");
        assert!(half < 0.35 * full, "{section:?}: not second order, {full:e} {half:e}");
        // without reverse flow, whose edge is of first order in the angles: nothing is left at Mach 0,
        // else the table's interpolation in Mach number
        assert!(small < if tip_mach.is_none() { 1e-5 } else { 5e-5 }, "{section:?} {small:e}");
    }
}

/// Camber is what it is in a table: lift counts from the incidence of zero lift, a moment is left there. The distance falls with
/// the square of the angles, and without the camber it is one of first order. Quasi-steady sections, for tables have no lag of what camber adds as
/// the stream pulsates.
#[test]
fn the_camber_of_a_linear_section_is_that_of_a_table() {
    let machs: Vec<f64> = (0..=92).map(|i| 0.01 * f64::from(i)).collect();
    let distance = |scale: f64, known: f64| {
        let camber = Camber { zero_lift_rad: -0.02 * scale, moment: -0.015 * scale };
        let slope = |m: f64| TAU / (1.0 - m * m).sqrt();
        let lift = |a: f64, m: f64| {
            let near =
                if a.abs() > 0.501 * PI { a - PI.copysign(a) } else { a - camber.zero_lift_rad };
            slope(m) * near
        };
        let angles = [-180.0, -90.5, -90.0, 90.0, 90.5, 180.0];
        let nonlinear =
            airfoils(table(&angles, &machs, [&lift, &|_, _| 0.0, &|_, _| camber.moment]));
        let part =
            Camber { zero_lift_rad: known * camber.zero_lift_rad, moment: known * camber.moment };
        let linear = RotorModel {
            drag_coefficient: 0.0,
            camber: part,
            ..flapped(AttachedFlowModel::QuasiSteady, Some(0.58))
        };
        let tabled = RotorModel { nonlinear, ..linear.clone() };
        let twist = Twist::Linear { rate_rad: (-8.0 * scale).to_radians() };
        let blade = BladeProperties::new(BladeSpec { twist, ..paper_spec() }).unwrap();
        let flight = (0.15, 0.04 * scale, controls(5.0 * scale, scale, -2.0 * scale));
        let air = (LinearInflow::Prescribed { induced_inflow: 0.01 * scale }, 0.04 * scale);
        let d = Discretisation::default();
        let [a, b] = [linear, tabled].map(|m| solve_blade(&blade, m, d, flight, air).unwrap());
        distance(&a, &b)
    };
    let [full, half, small] = [1.0, 0.5, 0.02].map(|scale| distance(scale, 1.0));
    let without = distance(0.02, 0.0);
    println!(
        "{full:.2e}, half the angles {half:.2e}, a fiftieth {small:.2e}, left out {without:.2e}"
    );
    assert!(full < 1.5e-2 && half < 0.35 * full && small < 1e-4, "{full:e} {half:e} {small:e}");
    assert!(without > 0.05, "{without:e}");
}

/// Out of reach, dynamic stall changes nothing, over the linear model and over a table.
#[test]
fn stall_out_of_reach_is_no_stall() {
    let mach = Mach::new(0.3).unwrap();
    let never = StallParameters {
        alpha1_rad: 100.0,
        k0: 0.0,
        eta: 1.0,
        cn1: 1e9,
        ..StallParameters::naca_0012(mach)
    };
    let flight = (0.3, 0.08, controls(8.0, 1.0, -4.0));
    for base in [NonlinearSections::default(), kirchhoff()] {
        let solve = |dynamic_stall| {
            let nonlinear = NonlinearSections { dynamic_stall, ..base.clone() };
            let model = RotorModel {
                nonlinear,
                ..flapped(AttachedFlowModel::HariharanLeishman, Some(0.58))
            };
            let air = (LinearInflow::Prescribed { induced_inflow: 0.01 }, 0.03);
            try_solve(model, coarse(), flight, air).unwrap()
        };
        let [off, on] = [None, Some(DynamicStall::Constant(never))].map(solve);
        let apart = distance(&off, &on);
        println!("table {}: {apart:e}", base.airfoils.is_some());
        assert!(apart < 1e-12, "{apart:e}");
    }
}

/// In hover, where sections stall for good, a table makes less thrust than the linear law, the more the
/// higher the pitch; and hardly less below stall.
#[test]
fn a_stalled_table_lifts_less_in_hover() {
    let thrust = |nonlinear, theta| {
        let model = RotorModel { nonlinear, ..flapped(AttachedFlowModel::Incompressible, None) };
        let flight = (0.0, 0.0, controls(theta, 0.0, 0.0));
        try_solve(model, coarse(), flight, (LinearInflow::Uniform, 0.0)).unwrap().thrust_coefficient
    };
    let lost = [6.0, 14.0, 22.0]
        .map(|theta| 1.0 - thrust(kirchhoff(), theta) / thrust(linear_law(0.01), theta));
    println!("share of the thrust lost at 6, 14, 22 deg: {lost:.4?}");
    assert!((0.0..0.02).contains(&lost[0]), "{lost:?}");
    assert!(lost[0] < lost[1] && lost[1] < lost[2] && lost[2] > 0.05, "{lost:?}");
}

/// The retreating blade of a loaded rotor stalls in every revolution: the response is periodic, and
/// its loads converge with the azimuth mesh.
#[test]
fn dynamic_stall_is_periodic_in_the_rotor() {
    let flight = (0.3, 0.06, controls(12.0, 1.0, -5.0));
    let solve = |dynamic_stall, time_elements| {
        let nonlinear = NonlinearSections { dynamic_stall, ..kirchhoff() };
        let model = RotorModel { nonlinear, ..flapped(AttachedFlowModel::Incompressible, None) };
        let d = Discretisation { time_elements, ..coarse() };
        let air = (LinearInflow::Prescribed { induced_inflow: 0.01 }, 0.0);
        try_solve(model, d, flight, air).unwrap()
    };
    let stall = Some(DynamicStall::Of(flap_aero::StallAirfoil::Naca0012));
    let [coarse, fine, finest] = [8, 16, 32].map(|elements| solve(stall, elements));
    let without = distance(&solve(None, 16), &fine);
    let steps = [distance(&coarse, &finest), distance(&fine, &finest)];
    println!(
        "residual {:.1e}; from 32 time elements: 8 {:.2e}, 16 {:.2e}; stall makes {without:.2e}",
        coarse.residuals.periodicity, steps[0], steps[1]
    );
    for solution in [&coarse, &fine, &finest] {
        assert!(solution.residuals.periodicity <= 1e-11);
    }
    assert!(without > 3e-3, "{without:e}");
    assert!(steps[1] < 0.6 * steps[0] && steps[1] < 0.5 * without, "{steps:?}");
}

/// A vortex that outlasts the revolutions it is given has no periodic stall: an error, not a number.
#[test]
fn stall_that_does_not_repeat_is_an_error() {
    let lasting = StallParameters {
        tvl: 1e5,
        tv: 1e5,
        ..StallParameters::naca_0012(Mach::new(0.3).unwrap())
    };
    let nonlinear =
        NonlinearSections { airfoils: None, dynamic_stall: Some(DynamicStall::Constant(lasting)) };
    let model = RotorModel { nonlinear, ..flapped(AttachedFlowModel::Incompressible, None) };
    let flight = (0.3, 0.06, controls(16.0, 1.0, -6.0));
    let air = (LinearInflow::Prescribed { induced_inflow: 0.01 }, 0.0);
    let error = try_solve(model, coarse(), flight, air).unwrap_err();
    println!("{error}");
    assert!(matches!(error, ResponseError::StallNotPeriodic { change, .. } if change > 1e-13));
}

/// Two tables along the span: the loads lie between those of each alone, and a table twice is one.
#[test]
fn tables_are_blended_along_the_span() {
    let drag =
        |cd: f64| table(&[-180.0, 180.0], &[0.0], [&|a, _| 6.0 * a, &move |_, _| cd, &|_, _| 0.0]);
    let torque = |stations: Vec<(f64, C81Airfoil)>| {
        let airfoils = Some(Arc::new(AirfoilSpan::new(stations).unwrap()));
        let nonlinear = NonlinearSections { airfoils, dynamic_stall: None };
        let model = RotorModel { nonlinear, ..paper_model(Couplings::Linear) };
        let air = (LinearInflow::Prescribed { induced_inflow: 0.0 }, 0.0);
        let still = (0.0, 0.0, Controls::default());
        try_solve(model, coarse(), still, air).unwrap().root.components[5].mean
    };
    let one = torque(vec![(0.0, drag(0.01))]);
    let same = torque(vec![(0.0, drag(0.01)), (1.0, drag(0.01))]);
    assert_abs_diff_eq!(one, same, epsilon = 1e-12 * one.abs());
    let both = torque(vec![(0.0, drag(0.01)), (1.0, drag(0.03))]);
    let all = torque(vec![(0.0, drag(0.03))]);
    // cd = 0.01 + 0.02 x, torque per length x^3, from the cut-out
    let moment = |n: i32| (1.0 - 0.2_f64.powi(n)) / f64::from(n);
    let share = (moment(5) / moment(4) - 0.0) * (all - one) + one;
    println!("torques {one:.4e} {both:.4e} {all:.4e}, blended {share:.4e}");
    assert_abs_diff_eq!(both, share, epsilon = 0.02 * (all - one).abs());
}
