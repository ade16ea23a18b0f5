//! What is computed about a converged rotor: sensitivities, stability, loads inside the blade.

pub(crate) mod airloads;
pub(crate) mod changes;
pub(crate) mod coupled_modes;
pub(crate) mod dissimilar;
pub(crate) mod divergence;
pub(crate) mod linearised;
pub(crate) mod rigid;
pub(crate) mod section_lift;
pub(crate) mod settling;
pub(crate) mod stability;
pub(crate) mod state_space;
pub(crate) mod station_loads;
