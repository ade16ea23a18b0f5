//! Coupled trim of a rigid flapping blade against an independent program.
//!
//! The reference has one rigid flap mode held by a spring, lift slope 5.73, drag .01 + .2 alpha^2 and no
//! pitch-rate lift. Ours has the pitch-rate lift of the quasi-steady section, proportional to the chord: the
//! same solidity on 16 blades of a quarter of the chord leaves a quarter of it, and both together none.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use flap_aero::{AirfoilSpan, C81Airfoil, C81Table};
use rotor_fem::{BladeProperties, BladeSpec, Joint, RootSupport, Twist};
use rotor_response::{
    Couplings, Discretisation, NonlinearSections, ResponseTolerances, Rotor, RotorModel,
    RotorSolver,
};
use rotor_wake::LinearInflow;
use trim::{TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};
use validation::{Failure, Table, worst};

const LIFT_SLOPE: f64 = 5.73;
/// Errors over 2 % or 0.1 deg. The advance ratio taken for the flight speed would leave 0.94.
pub(crate) const BOUND: f64 = 0.5;
const NU: f64 = 1.125_789_21;

/// Incidence counted from the nearer edge of the section, rad.
fn wrapped(alpha: f64) -> f64 {
    if alpha.abs() > 0.5 * PI { alpha - PI.copysign(alpha) } else { alpha }
}

fn airfoil() -> Result<C81Airfoil, Failure> {
    let edge = [-90.01, -89.99, 89.99, 90.01];
    let mut angles: Vec<f64> = (-90..=90).map(|i| 2.0 * f64::from(i)).collect();
    angles.retain(|a| (a.abs() - 90.0).abs() > 0.5);
    angles.extend(edge);
    angles.sort_by(f64::total_cmp);
    let fill = |f: &dyn Fn(f64) -> f64| {
        let values = angles.iter().map(|a| f(wrapped(a.to_radians()))).collect();
        C81Table::new(vec![0.0], angles.clone(), values)
    };
    Ok(C81Airfoil {
        name: "REFERENCE".into(),
        lift: fill(&|a| LIFT_SLOPE * a)?,
        drag: fill(&|a| 0.01 + 0.2 * a * a)?,
        moment: fill(&|_| 0.0)?,
    })
}

/// The rotor of the reference with its blades split `split` ways, trimmed at a flight speed over the tip speed: the
/// advance ratio of the program is the component of it in the plane of the disk, by its own tilt.
fn trimmed_at_speed(speed: f64, split: usize) -> Result<TrimSolution, Failure> {
    let level = trimmed(speed, split)?;
    trimmed(speed * level.attitude.shaft_tilt_rad.cos(), split)
}

/// The same at an advance ratio.
fn trimmed(mu: f64, split: usize) -> Result<TrimSolution, Failure> {
    let blade = BladeProperties::new(BladeSpec {
        twist: Twist::Linear { rate_rad: (-8.0_f64).to_radians() },
        root: RootSupport {
            flap: Joint::Spring { stiffness: (NU * NU - 1.0) / 3.0 },
            ..RootSupport::CLAMPED
        },
        ..BladeSpec::uniform(1e3, 1e3, 1e3, 1e6)
    })?;
    let span = AirfoilSpan::new(vec![(0.0, airfoil()?)])?;
    let model = RotorModel {
        blades: 4 * split,
        planform: rotor_response::Planform::default(),
        chord: 0.07 * PI / (4.0 * split as f64),
        // the reference's Lock number is with its own lift slope, ours with 2 pi
        lock_number: 5.2 * TAU / LIFT_SLOPE,
        modal_damping: 0.0,
        lag_damper: 0.0,
        nonlinear: NonlinearSections { airfoils: Some(Arc::new(span)), dynamic_stall: None },
        ..RotorModel::table_1(Couplings::Linear)
    };
    let discretisation = Discretisation { modes: [1, 0, 0], ..Discretisation::default() };
    let rotor = Rotor::new(model, &blade, discretisation)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default())?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    Ok(trim(&mut solver, &LinearInflow::Uniform, mu, &target, &TrimSettings::default(), None)?)
}

fn angles_deg(t: &TrimSolution) -> [f64; 5] {
    [
        t.controls.theta0_rad,
        t.controls.theta1c_rad,
        t.controls.theta1s_rad,
        t.attitude.shaft_tilt_rad,
        t.attitude.roll_rad,
    ]
    .map(f64::to_degrees)
}

/// Largest error of an angle over what is allowed.
pub(crate) fn largest_error() -> Result<f64, Failure> {
    let table = Table::read("rotor/trim_reference_simple.csv")?;
    let columns =
        ["theta75_deg", "theta1c_deg", "theta1s_deg", "alpha_s_deg(fwd+)", "phi_s_deg(right+)"];
    let mut errors = Vec::new();
    for row in table.rows() {
        let speed = row.number("mu")?;
        if speed < 0.09 {
            continue;
        }
        let whole = angles_deg(&trimmed_at_speed(speed, 1)?);
        let quarter = angles_deg(&trimmed_at_speed(speed, 4)?);
        for (k, column) in columns.into_iter().enumerate() {
            let wanted = row.number(column)?;
            let got = quarter[k] - (whole[k] - quarter[k]) / 3.0;
            errors.push(Ok((got - wanted).abs() / (0.02 * wanted.abs()).max(0.1)));
        }
    }
    worst("trimmed angles", 30, errors)
}
