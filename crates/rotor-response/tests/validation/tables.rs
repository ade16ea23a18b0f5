//! The rotor with sections by table.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use flap_aero::{AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, NonlinearSections, RotorModel, RotorSolution,
    TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};
use validation::{Check, Failure, row, worst};

use crate::rotor::{paper_rotor, response};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-AERO-33",
        "rotor with a table of the linear law, angles of 0.2 deg: loads off the \
         linear model, of the largest",
        "-",
    )
    .against("the linear model")
    .at_most(1e-5, || table_distance(0.15, 0.02)),
    row(
        "V-AERO-34",
        "the same at mu 0.30, angles of 8 deg over angles of 4 deg: the difference \
         is of second order",
        "-",
    )
    .against("theory: at least 4 less the share of reverse flow")
    .at_least(2.9, || Ok(table_distance(0.3, 1.0)? / table_distance(0.3, 0.5)?)),
];

/// `2 pi alpha` in flow from ahead, `2 pi (alpha -+ pi)` from behind; no drag and no moment.
fn linear_law() -> Result<NonlinearSections, Failure> {
    let angles = vec![-180.0_f64, -90.5, -90.0, 90.0, 90.5, 180.0];
    let lift = |degrees: &f64| {
        let a = degrees.to_radians();
        TAU * if degrees.abs() > 90.2 { a - PI.copysign(a) } else { a }
    };
    let values = angles.iter().map(lift).collect();
    let lift = C81Table::new(vec![0.0], angles.clone(), values)?;
    let zero = C81Table::new(vec![0.0], vec![0.0], vec![0.0])?;
    let airfoil = C81Airfoil { name: "LINEAR".to_owned(), lift, drag: zero.clone(), moment: zero };
    let span = AirfoilSpan::new(vec![(0.0, airfoil)])?;
    Ok(NonlinearSections { airfoils: Some(Arc::new(span)), dynamic_stall: None })
}

/// Largest difference of hub and root loads between a rotor with a table of the linear law and the linear
/// model, over the largest load; all angles and inflows scaled.
fn table_distance(advance_ratio: f64, scale: f64) -> Result<f64, Failure> {
    let twist = Twist::Linear { rate_rad: (-8.0 * scale).to_radians() };
    let blade = BladeProperties::new(BladeSpec {
        twist,
        ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1000.0)
    })?;
    let [theta0_rad, theta1c_rad, theta1s_rad] =
        [8.0, 1.0, -4.0].map(|degrees: f64| (scale * degrees).to_radians());
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: 0.04 * scale, sine: 0.02 * scale });
    let condition = Condition {
        flight: FlightState { advance_ratio, shaft_tilt_rad: 0.08 * scale },
        controls: Controls { theta0_rad, theta1c_rad, theta1s_rad },
        flap_angles_rad: vec![angle; 2],
        bank_rad: 0.0,
    };
    let linear = RotorModel {
        section_model: AttachedFlowModel::Incompressible,
        drag_coefficient: 0.0,
        flaps: TrailingEdgeFlap::paper_case().to_vec(),
        ..paper_rotor(Couplings::Full, 0.2)
    };
    let tabled = RotorModel { nonlinear: linear_law()?, ..linear.clone() };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.01 * scale };
    let loads = |model: RotorModel| -> Result<Vec<f64>, Failure> {
        let found: RotorSolution =
            response(model, &blade, Discretisation::default(), &condition, &inflow)?;
        let hub = (0..=1).flat_map(|n| found.hub.harmonic(4 * n));
        Ok(hub.chain((1..=5).flat_map(|n| found.root.harmonic(n))).collect())
    };
    let (a, b) = (loads(linear)?, loads(tabled)?);
    let size = a.iter().fold(0.0_f64, |size, load| size.max(load.abs()));
    worst("loads", 40, a.iter().zip(&b).map(|(a, b)| Ok((a - b).abs() / size)))
}
