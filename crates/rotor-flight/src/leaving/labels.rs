//! Names of arrays and of what their indices run over.

use rotor_case::Case;
use rotor_export::Axis;
use rotor_study::HubLoads;

/// Names of the loads, without their unit.
pub(super) fn load_labels(case: &Case) -> Vec<String> {
    let per_rev = case.rotor.blades;
    let both = |name: &&str| ["cos", "sin"].map(|part| format!("{name}_{per_rev}_per_rev_{part}"));
    HubLoads::NAMES.iter().flat_map(both).collect()
}

/// Names of the controls of so many flaps at a set of harmonics.
pub(super) fn control_labels(flaps: usize, set: &[usize]) -> Vec<String> {
    (1..=flaps)
        .flat_map(|flap| set.iter().map(move |n| (flap, n)))
        .flat_map(|(flap, n)| ["cos", "sin"].map(|part| format!("flap{flap}_{n}_per_rev_{part}_V")))
        .collect()
}

/// How names of arrays of T begin; the harmonics follow, with lines between them.
pub(super) const T_OF: &str = "T_";
/// How names of points begin; the advance ratio follows.
pub(super) const POINT_AT: &str = "mu_";
/// How names of points after a step of the thrust end.
pub(super) const AFTER_STEP: &str = "_after_thrust_step";

/// Nondimensional loads by their labels: forces, then as many moments.
pub(super) fn load_axis(labels: Vec<String>) -> Axis {
    let unit = |k: usize| if k < labels.len() / 2 { "m0 Omega^2 R^2" } else { "m0 Omega^2 R^3" };
    let units = (0..labels.len()).map(|k| unit(k).to_owned()).collect();
    Axis { name: "load".to_owned(), labels, units }
}
