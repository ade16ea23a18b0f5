//! The memory of the unsteady sections in the Newton matrix: what it is, and what it is needed for.

#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use crate::common;

use rotor_fem::{BladeProperties, BladeSpec, Joint, RootSupport};
use rotor_response::{
    Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolution, RotorSolver,
    SectionOffsets,
};
use rotor_wake::LinearInflow;
use std::sync::Arc;

fn solved(centre: f64, pitch_spring: Option<f64>) -> RotorSolution {
    let root = pitch_spring.map_or(RootSupport::CLAMPED, |stiffness| RootSupport {
        feather: Joint::Spring { stiffness },
        ..RootSupport::CLAMPED
    });
    let blade = BladeProperties::new(BladeSpec { root, ..common::paper_spec() }).unwrap();
    let model = RotorModel {
        offsets: SectionOffsets { aerodynamic_centre: centre, ..SectionOffsets::default() },
        ..RotorModel::paper_case()
    };
    let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let condition = common::condition();
    // a start nearby: the question is the last part of the way
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.012 };
    solver.solve(&condition, &inflow, None).unwrap()
}

/// With the lift ahead of the axis of a blade on a soft pitch link the lagged part of the lift drives the
/// torsion it follows. A Newton matrix that takes the lags as settled does not contract there.
#[test]
fn a_soft_pitch_link_with_the_lift_ahead_of_the_axis_converges() {
    for (centre, spring, most) in
        [(0.0, None, 12), (0.0, Some(0.05), 15), (0.0025, Some(0.05), 20), (0.003, Some(0.05), 20)]
    {
        let found = solved(centre, spring);
        let r = found.residuals;
        println!(
            "centre {centre} R ahead, pitch spring {spring:?}: {} iterations, {} matrices, residual {:.1e}",
            r.response_iterations, r.factorisations, r.periodicity
        );
        assert!(r.periodicity <= ResponseTolerances::default().periodicity);
        assert!(r.response_iterations <= most, "{}", r.response_iterations);
    }
}
