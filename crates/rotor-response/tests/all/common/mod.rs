//! The rotor of the paper's Table 1 for tests.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel,
    RotorSolver, TrailingEdgeFlap,
};
use rotor_wake::FlightState;
use std::sync::Arc;

/// Table 1 with the documented defaults where the paper is silent.
pub(crate) fn paper_spec() -> BladeSpec {
    BladeSpec::table_1()
}

/// The blade of [`paper_spec`].
pub(crate) fn paper_blade() -> BladeProperties {
    BladeProperties::new(paper_spec()).unwrap()
}

/// Incompressible quasi-steady rotor without flaps.
pub(crate) fn paper_model(couplings: Couplings) -> RotorModel {
    RotorModel::table_1(couplings)
}

/// The two flaps of the paper case.
pub(crate) fn paper_flaps() -> Vec<TrailingEdgeFlap> {
    TrailingEdgeFlap::paper_case().to_vec()
}

/// The paper's rotor with flaps and unsteady sections at an advance ratio of 0.30.
pub(crate) fn solver() -> RotorSolver {
    let rotor = Rotor::new(RotorModel::paper_case(), &paper_blade(), Discretisation::default());
    RotorSolver::new(Arc::new(rotor.unwrap()), 0.3, ResponseTolerances::default()).unwrap()
}

/// Near trim in level flight at that advance ratio, flaps at rest.
pub(crate) fn condition() -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
        controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
        flap_angles_rad: vec![HarmonicSeries::zero(0); 2],
    }
}
