//! What a rotor is made of: parameters, flaps, spanwise stations.

pub(crate) mod air_scales;
pub(crate) mod flap;
pub(crate) mod flap_inertia;
pub(crate) mod flap_mass;
pub(crate) mod rotor_model;
pub(crate) mod section_settings;
pub(crate) mod span;
