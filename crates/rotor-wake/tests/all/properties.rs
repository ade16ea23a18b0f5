//! Properties of the inflow models over the whole envelope.

use proptest::prelude::*;
use rotor_wake::{
    FlightState, InducedInflow, InflowModel, LinearInflow, RotorLoading, WakeError, momentum_inflow,
};

/// Residual of the momentum equation, `lambda_i - C_T / (2 sqrt(mu^2 + lambda^2))`.
fn momentum_residual(flight: &FlightState, thrust_coefficient: f64, induced_inflow: f64) -> f64 {
    let lambda = flight.normal_inflow() + induced_inflow;
    induced_inflow - thrust_coefficient / (2.0 * flight.advance_ratio.hypot(lambda))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn momentum_balance_closes(
        advance_ratio in 0.0..0.5_f64,
        shaft_tilt_rad in -1.5..1.5_f64,
        thrust_coefficient in 1e-5..0.02_f64,
    ) {
        let flight = FlightState { advance_ratio, shaft_tilt_rad };
        match momentum_inflow(&flight, thrust_coefficient) {
            Ok(induced) => {
                let residual = momentum_residual(&flight, thrust_coefficient, induced);
                prop_assert!(residual.abs() < 1e-13, "{residual:e}");
                prop_assert!(induced > 0.0);
            }
            Err(WakeError::VortexRingState { normal_inflow, .. }) => {
                prop_assert!(normal_inflow < 0.0);
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn inflow_is_continuous_down_to_hover(
        direction in -0.5..1.5_f64,
        thrust_coefficient in 1e-3..0.02_f64,
    ) {
        let loading = RotorLoading::from_thrust_coefficient(thrust_coefficient);
        let hover = (0.5 * thrust_coefficient).sqrt();
        let mut last = f64::INFINITY;
        for advance_ratio in [1e-3, 1e-5, 1e-7, 0.0] {
            let flight = FlightState { advance_ratio, shaft_tilt_rad: direction };
            for model in [LinearInflow::Uniform, LinearInflow::Drees] {
                let inflow = model.induced(&flight, &loading).unwrap();
                let InducedInflow::Linear { mean, cosine, sine } = inflow else { unreachable!() };
                let distance = (mean - hover).abs() + cosine.abs() + sine.abs();
                // |d lambda_i / d normal| = 1/2 and the gradients are of the order of mu
                let bound = advance_ratio * (2.0 + direction.tan().abs()) + 1e-15;
                prop_assert!(distance <= bound, "{advance_ratio}: {distance:e}");
                last = distance;
            }
        }
        prop_assert!(last <= 1e-15);
    }

    #[test]
    fn more_thrust_more_inflow(
        advance_ratio in 0.0..0.5_f64,
        shaft_tilt_rad in 0.0..1.2_f64,
        thrust_coefficient in 1e-4..0.02_f64,
    ) {
        let flight = FlightState { advance_ratio, shaft_tilt_rad };
        let less = momentum_inflow(&flight, thrust_coefficient).unwrap();
        let more = momentum_inflow(&flight, 1.01 * thrust_coefficient).unwrap();
        prop_assert!(more > less);
    }
}

#[test]
fn fast_forward_flight_approaches_the_wing_formula() {
    // lambda_i -> C_T / (2 mu): the departure falls as (lambda/mu)^2 / 2
    for advance_ratio in [0.1, 0.2, 0.4] {
        let flight = FlightState { advance_ratio, shaft_tilt_rad: 0.0 };
        let induced = momentum_inflow(&flight, 0.0049).unwrap();
        let wing = 0.0049 / (2.0 * advance_ratio);
        let departure = 1.0 - induced / wing;
        let expected = 0.5 * (induced / advance_ratio).powi(2);
        assert!((departure / expected - 1.0).abs() < 0.05, "{departure} {expected}");
    }
}
