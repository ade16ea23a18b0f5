//! Rigid rotors of the literature in their own free wake, with what was measured or computed for them.
//!
//! Tests and validation of `rotor-wake` fly them; the product has rotors of its own, with blades that bend.

mod blade_element;
mod hover;
mod rotors;

pub use blade_element::{
    AttachedPolar, BladeElementRotor, BladeElementSolution, CouplingSettings, RigidMotion,
    SectionPolar, StillWake,
};
pub use hover::contraction_drift;
pub use rotors::{
    CARADONNA_TUNG_THRUST, Landgrebe, OlafPolar, caradonna_tung, olaf, olaf_flight, olaf_settings,
    olaf_thrust_newton, slender,
};
