//! The rotor of the paper's Table 1 for tests.
#![allow(dead_code, reason = "each test file uses a part of it")]

use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_fem::{BladeProperties, BladeSpec, Twist};
use rotor_response::{
    Compressibility, Couplings, NonlinearSections, ReverseFlow, RotorModel, TrailingEdgeFlap,
};

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
            effectiveness: FlapEffectiveness::IDEAL,
        })
        .to_vec()
}
