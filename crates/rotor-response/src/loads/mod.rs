//! From loads along the blade to loads on the hub, moments inside the blade and power.

pub(crate) mod power;
pub(crate) mod section_moments;
pub(crate) mod wrenches;
