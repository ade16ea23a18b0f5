//! Blades that are not alike in flight, against the nonlinear rotor blade by blade.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

#[path = "../common/mod.rs"]
mod common;
mod one_blade;
mod unlike;

use rotor_case::{AttachedFlowModel, Case};
use rotor_study::HUB_OUTPUTS;

const ADVANCE_RATIO: f64 = 0.3;
const BLADES: usize = 4;

fn case() -> Case {
    let mut case = Case { advance_ratio: ADVANCE_RATIO, ..Case::default() };
    case.structure.elements = 4;
    case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
    case
}

fn of_order(order: usize) -> std::ops::Range<usize> {
    (order - 1) * HUB_OUTPUTS..order * HUB_OUTPUTS
}

fn size(loads: &[f64]) -> f64 {
    loads.iter().map(|z| z * z).sum::<f64>().sqrt()
}
