//! Rotors with aerofoil tables and dynamic stall: their linear limits, their order, their convergence.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use approx::assert_abs_diff_eq;
use common::{paper_blade, paper_flaps, paper_model};
use flap_aero::{AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table, Mach, StallParameters};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, DynamicStall,
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

/// The static curve of Kirchhoff with the constants of the NACA 0012 at Mach 0.3, a flat plate beyond.
fn kirchhoff() -> NonlinearSections {
    let p = StallParameters::naca_0012(Mach::new(0.3).unwrap());
    let angles: Vec<f64> = (-360..=360).map(|i| 0.5 * f64::from(i)).collect();
    let forces = |a: f64| {
        let f = p.separation(a);
        let slope = TAU / (1.0_f64 - 0.09).sqrt();
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
    (inflow, flap_rad): (LinearInflow, f64),
) -> Result<RotorSolution, ResponseError> {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: flap_rad, sine: 0.5 * flap_rad });
    let condition = Condition {
        flight: FlightState { advance_ratio: mu, shaft_tilt_rad: tilt },
        controls,
        flap_angles_rad: vec![angle; model.flaps.len()],
    };
    let rotor = Rotor::new(model, &paper_blade(), discretisation)?;
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

#[test]
fn explore() {
    let d = Discretisation::default();
    for theta in [12.0, 16.0, 20.0] {
        for mu in [0.0, 0.3] {
            let case = (mu, 0.05, controls(theta, 1.0, -0.4 * theta * mu / 0.3));
            for stall in [None, Some(DynamicStall::Naca0012)] {
                for base in [NonlinearSections::default(), kirchhoff()] {
                    let nonlinear = NonlinearSections { dynamic_stall: stall, ..base };
                    let tabled = nonlinear.airfoils.is_some();
                    let model = RotorModel {
                        nonlinear,
                        ..flapped(AttachedFlowModel::HariharanLeishman, Some(0.58))
                    };
                    let t = std::time::Instant::now();
                    match try_solve(model, d, case, (LinearInflow::Drees, 0.03)) {
                        Ok(s) => println!(
                            "{theta} mu {mu} table {tabled} stall {}: ct {:.5} it {} fac {} infl {} res {:.1e} t {:?}",
                            stall.is_some(),
                            s.thrust_coefficient,
                            s.residuals.response_iterations,
                            s.residuals.factorisations,
                            s.residuals.inflow_iterations,
                            s.residuals.periodicity,
                            t.elapsed()
                        ),
                        Err(e) => println!(
                            "{theta} mu {mu} table {tabled} stall {}: {e}",
                            stall.is_some()
                        ),
                    }
                }
            }
        }
    }
}
