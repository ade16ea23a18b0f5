//! Level flight of the paper's elastic rotor from hover to advance ratio 0.35, beside a rigid-blade rotor.
//!
//! ```text
//! cargo run --release -p trim --example level_flight
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::LinearInflow;
use std::sync::Arc;
use trim::{TrimError, TrimSettings, TrimTarget, Vehicle, trim};

/// Advance ratio; theta0, theta1c, theta1s, shaft tilt and bank in degrees of a simpler rotor (one rigid flap
/// mode): `fixtures/reference/rotor/trim_reference_simple.csv`. It differs by up to 1.5 deg, and should.
const RIGID_BLADE: [(f64, [f64; 5]); 4] = [
    (0.05, [7.532, 0.376, -0.688, 0.251, -2.454]),
    (0.15, [6.198, 0.556, -2.012, 1.551, -1.476]),
    (0.25, [7.249, 0.855, -3.660, 4.026, -1.667]),
    (0.35, [10.204, 1.267, -6.222, 7.486, -2.748]),
];

fn main() -> Result<(), TrimError> {
    let blade =
        BladeProperties::new(BladeSpec::table_1()).map_err(rotor_response::ResponseError::from)?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    println!("  mu                 theta0  theta1c  theta1s  shaft tilt    bank, deg   residual");
    for (mu, rigid) in RIGID_BLADE {
        let model = RotorModel::table_1(Couplings::Full);
        let rotor = Rotor::new(model, &blade, Discretisation::default())?;
        let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default())?;
        let found =
            trim(&mut solver, &LinearInflow::Uniform, mu, &target, &TrimSettings::default(), None)?;
        let (controls, attitude) = (found.controls, found.attitude);
        let elastic = [
            controls.theta0_rad,
            controls.theta1c_rad,
            controls.theta1s_rad,
            attitude.shaft_tilt_rad,
            attitude.roll_rad,
        ];
        let row = |angles: [f64; 5]| angles.map(|a| format!("{a:9.3}")).join("");
        println!(
            "{mu:.2} elastic blade {}   {:.1e}",
            row(elastic.map(f64::to_degrees)),
            found.residual
        );
        println!("     rigid blade   {}", row(rigid));
    }
    Ok(())
}
