//! The blade in detail, as users write it: root, gravity, tables along the span, blades unlike the rest.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// How one rotation of the blade's root is held.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum JointChoice {
    /// Held fast.
    #[default]
    Locked,
    /// Free to turn.
    Free,
    /// Free against a spring.
    Spring {
        /// Moment per rad over `m0 Omega^2 R^3`.
        stiffness: f64,
    },
}

/// How the root of the blade is held, at `root_offset_r`; all locked is the clamped blade.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RootFile {
    /// Flap hinge.
    pub flap: JointChoice,
    /// Lag hinge.
    pub lag: JointChoice,
    /// Pitch bearing; its spring is pitch link and control system.
    pub pitch: JointChoice,
}

/// Whether the blades weigh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum GravityChoice {
    /// They do not.
    #[default]
    Off,
    /// 9.80665 m/s^2, down.
    On,
}

/// Values along the span in place of the uniform ones: `(station_r, value)` from root to tip, straight
/// lines between. A table that is left out is the uniform value; one that is given holds values.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BladeTablesFile {
    /// Mass per length over `mass_kg_m`.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub mass: Vec<(f64, f64)>,
    /// `EI_y / (m0 Omega^2 R^4)`.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub ei_flap: Vec<(f64, f64)>,
    /// `EI_z / (m0 Omega^2 R^4)`.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub ei_lag: Vec<(f64, f64)>,
    /// `GJ / (m0 Omega^2 R^4)`.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub gj: Vec<(f64, f64)>,
    /// `EA / (m0 Omega^2 R^2)`.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub ea: Vec<(f64, f64)>,
    /// Mass radius of gyration about the chord line, R.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub km1_r: Vec<(f64, f64)>,
    /// Mass radius of gyration about the normal to the chord, R.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub km2_r: Vec<(f64, f64)>,
    /// Area radius of gyration, R.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub ka_r: Vec<(f64, f64)>,
    /// Twist, deg; it then says itself where it is zero.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
    pub twist_deg: Vec<(f64, f64)>,
}

/// A table as it is given: one without a value would pass for one that is left out.
fn not_empty<'de, D: Deserializer<'de>>(given: D) -> Result<Vec<(f64, f64)>, D::Error> {
    let table = Vec::<(f64, f64)>::deserialize(given)?;
    if table.is_empty() {
        let message = "the table has no value: list (station_r, value) from the root to 1 R, or leave the table out for the uniform value";
        return Err(D::Error::custom(message));
    }
    Ok(table)
}

/// A table with its name, and whether its values must be positive.
pub(super) type NamedTable<'a> = (&'static str, &'a [(f64, f64)], bool);

impl BladeTablesFile {
    /// Every table.
    pub(super) fn named(&self) -> [NamedTable<'_>; 9] {
        [
            ("mass", &self.mass, true),
            ("ei_flap", &self.ei_flap, true),
            ("ei_lag", &self.ei_lag, true),
            ("gj", &self.gj, true),
            ("ea", &self.ea, true),
            ("km1_r", &self.km1_r, true),
            ("km2_r", &self.km2_r, true),
            ("ka_r", &self.ka_r, false),
            ("twist_deg", &self.twist_deg, false),
        ]
    }
}

/// A blade unlike the rest; factors on what the others have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnlikeBladeFile {
    /// Its number: blade k flies `(k - 1) 360 deg / blades` ahead of blade 1, whose azimuth is the rotor's.
    pub blade: usize,
    /// On the mass per length.
    #[serde(default = "one")]
    pub mass: f64,
    /// On the flap bending stiffness.
    #[serde(default = "one")]
    pub ei_flap: f64,
    /// On the lag bending stiffness.
    #[serde(default = "one")]
    pub ei_lag: f64,
    /// On the torsion stiffness.
    #[serde(default = "one")]
    pub gj: f64,
    /// On the motion of its flaps.
    #[serde(default = "one")]
    pub flap_motion: f64,
}

fn one() -> f64 {
    1.0
}
