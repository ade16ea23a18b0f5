//! Names of the effects.

use crate::error::RotorTruthError;

/// An effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Its name in the answer.
    pub name: &'static str,
    /// Whether the flaps have to move to show it.
    pub needs_drive: bool,
    /// Whether the list of the product has it.
    pub is_known: bool,
}

const fn known(name: &'static str, needs_drive: bool) -> Entry {
    Entry { name, needs_drive, is_known: true }
}

const fn outside(name: &'static str, needs_drive: bool) -> Entry {
    Entry { name, needs_drive, is_known: false }
}

/// Nothing hidden.
pub const NULL: &str = "null";

/// Every effect.
pub const CATALOGUE: [Entry; 32] = [
    known(NULL, false),
    known("actuator-hysteresis", true),
    known("actuator-gain", true),
    known("flap-effectiveness", true),
    known("stiffness-flap", false),
    known("stiffness-lag", false),
    known("stiffness-torsion", false),
    known("pitch-link", false),
    known("mass", false),
    known("cg-offset", false),
    known("aerodynamic-centre", false),
    known("structural-damping", false),
    known("blade-dissimilarity", false),
    known("pitch-reference", false),
    known("twist", false),
    known("lift-slope", false),
    known("drag", false),
    known("inflow", false),
    known("dynamic-stall", false),
    known("compressibility", false),
    known("hub-impedance", false),
    known("sensor-gain", false),
    known("azimuth-offset", false),
    known("channel-delay", false),
    known("rotor-speed", false),
    known("air-density", false),
    outside("wall-upwash", false),
    outside("lag-damper", false),
    outside("flap-freeplay", true),
    outside("shaft-imbalance", false),
    outside("fuselage-upwash", false),
    outside("flap-phase-error", true),
];

/// The effect of a name.
///
/// # Errors
/// [`RotorTruthError::UnknownName`].
pub fn entry(name: &str) -> Result<Entry, RotorTruthError> {
    CATALOGUE.into_iter().find(|own| own.name == name).ok_or_else(|| {
        let known = CATALOGUE.map(|own| own.name).join(", ");
        RotorTruthError::UnknownName { what: "effect", found: name.to_owned(), known }
    })
}
