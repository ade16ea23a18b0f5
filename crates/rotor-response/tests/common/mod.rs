//! The rotor of the paper's Table 1 for tests.
#![allow(dead_code, reason = "each test file uses a part of it")]

use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, FlapMass, NonlinearSections,
    ResponseTolerances, ReverseFlow, Rotor, RotorModel, RotorSolver, SectionOffsets,
    TrailingEdgeFlap,
};
use rotor_wake::FlightState;
use std::sync::Arc;

/// Table 1 with the documented defaults where the paper is silent.
pub(crate) fn paper_spec() -> BladeSpec {
    BladeSpec {
        twist: Twist::Linear { rate_rad: (-8.0_f64).to_radians() },
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    }
}

/// The blade of [`paper_spec`].
pub(crate) fn paper_blade() -> BladeProperties {
    BladeProperties::new(paper_spec()).unwrap()
}

/// Incompressible quasi-steady rotor without flaps.
pub(crate) fn paper_model(couplings: Couplings) -> RotorModel {
    RotorModel {
        tip_loss: 1.0,
        gravity: 0.0,
        offsets: SectionOffsets::default(),
        blades: 4,
        chord: 0.055,
        lock_number: 5.2,
        drag_coefficient: 0.01,
        root_cutout: 0.2,
        modal_damping: 0.005,
        couplings,
        section_model: AttachedFlowModel::QuasiSteady,
        compressibility: Compressibility::None,
        reverse_flow: ReverseFlow::default(),
        flaps: vec![],
        nonlinear: NonlinearSections::default(),
    }
}

/// The two flaps of the paper case.
pub(crate) fn paper_flaps() -> Vec<TrailingEdgeFlap> {
    [(0.70, 0.75), (0.80, 0.85)]
        .map(|(start, end)| TrailingEdgeFlap {
            start,
            end,
            chord_fraction: 0.2,
            mass_fraction: 0.1,
            cg_fraction: 0.2,
            gyration_fraction: None,
            mass: FlapMass::PartOfBlade,
            effectiveness: FlapEffectiveness::IDEAL,
        })
        .to_vec()
}

/// The paper's rotor with flaps and unsteady sections at an advance ratio of 0.30.
pub(crate) fn solver() -> RotorSolver {
    let model = RotorModel {
        section_model: AttachedFlowModel::HariharanLeishman,
        compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
        flaps: paper_flaps(),
        ..paper_model(Couplings::Full)
    };
    let rotor = Rotor::new(model, &paper_blade(), Discretisation::default()).unwrap();
    RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap()
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
