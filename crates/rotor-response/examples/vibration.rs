//! Hub vibration of the paper's rotor in forward flight, and how a flap at 3/rev changes it.
//!
//! Four identical blades: the hub is shaken at 4/rev and at no harmonic below.
//!
//! ```text
//! cargo run --release -p rotor-response --example vibration
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Discretisation, ResponseError, ResponseTolerances, Rotor, RotorModel,
    RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

const MU: f64 = 0.30;

fn main() -> Result<(), ResponseError> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default())?;
    let mut solver = RotorSolver::new(Arc::new(rotor), MU, ResponseTolerances::default())?;
    // near the trim of level flight at C_T/sigma 0.07 with Drees's inflow
    let controls = Controls { theta0_rad: 0.137, theta1c_rad: 0.025, theta1s_rad: -0.078 };
    let flight = FlightState { advance_ratio: MU, shaft_tilt_rad: 0.096 };

    println!("amplitude of the 4/rev hub loads, 1e-4 of m0 Omega^2 R^2 and R^3");
    println!("inboard flap at 3/rev      FX      FY      FZ      MX      MY      MZ   residual");
    for (amplitude_deg, phase_deg) in
        [(0.0_f64, 0.0_f64), (2.0, 0.0), (2.0, 90.0), (2.0, 180.0), (2.0, 270.0)]
    {
        let mut inboard = HarmonicSeries::zero(3);
        inboard.set_harmonic(
            3,
            Harmonic::from_amplitude_phase(amplitude_deg.to_radians(), phase_deg.to_radians()),
        );
        let flap_angles_rad = vec![inboard, HarmonicSeries::zero(3)];
        let condition = Condition { bank_rad: 0.0, flight, controls, flap_angles_rad };
        let solution = solver.solve(&condition, &LinearInflow::Drees, None)?;
        print!("{amplitude_deg} deg, phase {phase_deg:3} deg ");
        for pair in solution.hub.harmonic(4).chunks_exact(2) {
            print!("{:8.3}", 1e4 * pair[0].hypot(pair[1]));
        }
        println!("   {:8.1e}", solution.residuals.periodicity);
    }
    Ok(())
}
