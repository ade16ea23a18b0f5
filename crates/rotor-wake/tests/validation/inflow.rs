//! Momentum theory and Drees's gradients.

use rotor_wake::{FlightState, drees_factors, momentum_inflow};
use validation::{Check, Failure, row, worst};

/// Residual of the momentum equation, `lambda_i - C_T / (2 sqrt(mu^2 + lambda^2))`.
fn momentum_residual(flight: &FlightState, thrust_coefficient: f64, induced_inflow: f64) -> f64 {
    let lambda = flight.normal_inflow() + induced_inflow;
    induced_inflow - thrust_coefficient / (2.0 * flight.advance_ratio.hypot(lambda))
}

pub(crate) const ROWS: &[Check] = &[
    row("V-WAKE-01", "induced inflow in hover at C_T 0.0049", "Omega R")
        .against("momentum theory, sqrt(C_T / 2)")
        .near(0.049_497_474_7, 1e-9, || Ok(momentum_inflow(&flight(0.0, 0.0), THRUST)?)),
    row("V-WAKE-02", "induced inflow at mu 0.30, shaft tilt 5 deg, C_T 0.0049", "Omega R")
        .against("fixed-point iteration of Glauert's equation, apart from the program")
        .near(0.008_113_622_59, 1e-9, || Ok(momentum_inflow(&flight(0.30, 5.0), THRUST)?)),
    row(
        "V-WAKE-03",
        "residual of Glauert's equation, mu 0 to 0.5, tilt -5 to 15 deg: largest, \
         over the inflow",
        "-",
    )
    .against("the equation itself")
    .at_most(1e-13, glauert_residual),
    row(
        "V-WAKE-04",
        "Drees's longitudinal factor against the form that is printed: largest \
         difference",
        "-",
    )
    .against("Drees, J. Helicopter Assoc. of Great Britain 3 (1949)")
    .at_most(1e-12, drees_forms),
];

const THRUST: f64 = 0.0049;

fn flight(advance_ratio: f64, tilt_deg: f64) -> FlightState {
    FlightState { advance_ratio, shaft_tilt_rad: tilt_deg.to_radians() }
}

fn glauert_residual() -> Result<f64, Failure> {
    let mut residuals = Vec::new();
    for i in 0..=10 {
        for tilt_deg in [-5.0, 0.0, 5.0, 15.0] {
            let state = flight(0.05 * f64::from(i), tilt_deg);
            let inflow = momentum_inflow(&state, THRUST)?;
            residuals.push(Ok((momentum_residual(&state, THRUST, inflow) / inflow).abs()));
        }
    }
    worst("flight states", 44, residuals)
}

/// The program uses a form that does not divide by zero in hover; here is the printed one.
fn drees_forms() -> Result<f64, Failure> {
    let cases = [(0.05, 0.05), (0.10, 0.03), (0.20, 0.02), (0.30, 0.034), (0.35, 0.001)];
    let differences = cases.into_iter().map(|(mu, lambda): (f64, f64)| {
        let chi = mu.atan2(lambda);
        let printed = 4.0 / 3.0 * (1.0 - chi.cos() - 1.8 * mu * mu) / chi.sin();
        Ok((drees_factors(mu, lambda)[0] - printed).abs())
    });
    worst("flight states", 5, differences)
}
