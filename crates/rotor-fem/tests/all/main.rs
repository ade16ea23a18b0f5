//! The blade and periodic orbits against exact theory and reference tables.

mod blade_frequencies;
mod blade_matrices;
mod blades;
mod common;
mod flap_equation;
mod floquet;
mod free_motion;
mod linear;
mod linear_response;
mod moderate_modes;
mod moderate_motion;
mod moderate_statics;
mod periodic_orbit;
