//! The sections of a case: the rotor, its blades and their flaps.

use super::field::{is_default, section, values};
use rotor_fem::{Joint, RootSupport};
use rotor_response::FlapMass;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// Largest bending and torsion stiffness, over `m0 Omega^2 R^4`: beyond it the frequencies of a blade leave no
/// digits for those of the others.
const RIGID: f64 = 1e6;
/// Largest axial stiffness, over `m0 Omega^2 R^2`.
const RIGID_ALONG: f64 = 1e9;
/// Largest radius (m), speed (rpm), mass (kg/m) and radius of gyration (R): beyond that of anything that turns.
const LARGEST: f64 = 1e6;

section! {
    /// The rotor. Stiffness and lengths are over the rotor's own units: `m0` is `mass_kg_m`, `Omega` the rotor
    /// speed, `R` the radius.
    #[serde(deny_unknown_fields, default)]
    pub struct RotorValues {
        /// Number of blades.
        pub blades: usize = 4, Count(1, 16), "", "the paper's rotor has 4";
        /// Radius.
        pub radius_m: f64 = 4.94, UpTo(LARGEST), "m", "the paper's rotor has 4.94 m";
        /// Rotor speed.
        pub omega_rpm: f64 = 383.0, UpTo(LARGEST), "rpm", "the paper's rotor turns at 383 rpm";
        /// Mass per length `m0` of the blade; flaps included unless they say `AddedToBlade`.
        pub mass_kg_m: f64 = 6.46, UpTo(LARGEST), "kg/m", "the paper's blade has 6.46 kg/m";
        /// Blade chord. With `tables.chord_r` it is no more than the chord of `lock_number`.
        pub chord_r: f64 = 0.055, Within(1e-3, 0.5), "R", "the paper's blade has 0.055 R";
        /// Lock number `rho a c R^4 / I_b` with `a = 2 pi`, `I_b = m0 R^3 / 3`; it sets the air density,
        /// which is never given as well.
        pub lock_number: f64 = 5.20, Within(1e-2, 50.0), "", "the paper's rotor has 5.20";
        /// Flap bending stiffness `EI_y`.
        pub ei_flap: f64 = 0.0108, UpTo(RIGID), "m0 Omega^2 R^4",
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.0108)";
        /// Lag bending stiffness `EI_z`.
        pub ei_lag: f64 = 0.0268, UpTo(RIGID), "m0 Omega^2 R^4",
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.0268)";
        /// Torsion stiffness `GJ`.
        pub gj: f64 = 0.00615, UpTo(RIGID), "m0 Omega^2 R^4",
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.00615)";
        /// Axial stiffness `EA`.
        pub ea: f64 = 1000.0, UpTo(RIGID_ALONG), "m0 Omega^2 R^2",
            "a stiffness is positive and over m0 Omega^2 R^2, not in N (1000 is usual)";
        /// Mass radius of gyration about the chord line.
        pub km1_r: f64 = 0.0132, UpTo(LARGEST), "R", "a radius of gyration is positive (0.0132 R is usual)";
        /// Mass radius of gyration about the normal to the chord through the elastic axis, so at least
        /// `mass_centre_r`.
        pub km2_r: f64 = 0.0247, UpTo(LARGEST), "R", "a radius of gyration is positive (0.0247 R is usual)";
        /// Area radius of gyration about the elastic axis.
        pub ka_r: f64 = 0.029, Within(0.0, 0.5), "R", "0.029 R is usual";
        /// Linear twist from root to tip, zero at 0.75 R.
        pub twist_deg: f64 = -8.0, Within(-45.0, 45.0), "deg", "nose-down twist is negative";
        /// Precone, up positive.
        pub precone_deg: f64 = 0.0, Within(-10.0, 10.0), "deg", "up is positive";
        /// Aerodynamic root cut-out: no airloads inboard.
        pub root_cutout_r: f64 = 0.20, Within(0.0, 0.9), "R", "0.2 R is usual";
        /// Damping of every mode over critical. With 0 a coupled lag mode within 0.01 per rev of a whole
        /// number is refused, at no collective and at that of the trim.
        pub modal_damping: f64 = 0.005, Within(0.0, 0.5), "", "give a fraction: 0.005 is 0.5 %";
        /// Viscous damper of the lag rotation at the root, moment per rate; the lag joint turns, `Free` or `Spring`.
        #[serde(skip_serializing_if = "is_default")]
        pub lag_damper: f64 = 0.0, Within(0.0, 10.0), "m0 Omega R^3",
            "a damper is not negative and over m0 Omega R^3, not in N m s (0.01 damps a hinged lag mode by some 5 %)";
        /// Station of the blade's root, where hinges are; nothing moves or weighs inboard.
        #[serde(skip_serializing_if = "is_default")]
        pub root_offset_r: f64 = 0.0, Within(0.0, 0.5), "R", "0 is the rotor centre; nothing moves inboard of it";
        /// How the root is held: flap and lag hinge, pitch bearing, each `Locked`, `Free` or
        /// `Spring(stiffness: 0.05)` (moment per rad over `m0 Omega^2 R^3`). The spring of `pitch` is pitch
        /// link with control system, 0.001 or stiffer. A free lag hinge needs a `root_offset_r`.
        #[serde(skip_serializing_if = "is_default")]
        pub root: RootSupport = RootSupport::default(), Any, "", "";
        /// Arm of the pitch link about the pitch axis: what it holds is the torsion at the root over this. Left out, the
        /// torsion is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub pitch_link_arm_r: Option<f64> = None, Within(1e-4, 0.2), "R", "0.02 R is usual; leave it out where it is not known";
        /// Mass centre ahead of the elastic axis; `couplings: Moderate` only.
        #[serde(skip_serializing_if = "is_default")]
        pub mass_centre_r: f64 = 0.0, Within(-0.05, 0.05), "R",
            "ahead of the elastic axis is positive; a tenth of the chord is much";
        /// Tension centre ahead of the elastic axis; `couplings: Moderate` only.
        #[serde(skip_serializing_if = "is_default")]
        pub tension_centre_r: f64 = 0.0, Within(-0.05, 0.05), "R",
            "ahead of the elastic axis is positive; a tenth of the chord is much";
        /// Aerodynamic centre, the quarter chord, ahead of the elastic axis.
        #[serde(skip_serializing_if = "is_default")]
        pub aerodynamic_centre_r: f64 = 0.0, Rule("-0.75 to 0.25 chords"), "R", "";
        /// Axis of the blade ahead of the rotor centre, toward the leading edge; not with
        /// `couplings: Moderate`.
        #[serde(skip_serializing_if = "is_default")]
        pub torque_offset_r: f64 = 0.0, Within(-0.1, 0.1), "R",
            "toward the leading edge is positive; a tenth of the radius is much";
        /// Weight of the blades, 9.80665 m/s^2, in loads and trim; the trim's weight is that of the whole
        /// helicopter.
        #[serde(skip_serializing_if = "is_default")]
        pub gravity: GravityChoice = GravityChoice::Off, Any, "", "";
        /// Values along the span in place of uniform ones.
        #[serde(skip_serializing_if = "is_default")]
        pub tables: BladeTables = BladeTables::default(), Any, "", "";
        /// Higher harmonics of pitch at the root of every blade, beside the controls of the trim; each blade has them at
        /// its own azimuth.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub root_pitch: Vec<PitchHarmonic> = vec![], Any, "", "";
        /// What makes them. A swashplate gives harmonics of one less, the same and one more than the number of
        /// blades; actuators of each blade give any.
        #[serde(skip_serializing_if = "is_default")]
        pub root_pitch_by: RootPitchBy = RootPitchBy::EachBlade, Any, "", "";
        /// Blades that differ from the others. The result then has the hub loads at every harmonic, with
        /// controls, attitude and inflow of the rotor with all blades alike.
        #[serde(skip_serializing_if = "Vec::is_empty", alias = "unlike_blades")]
        pub dissimilar_blades: Vec<DissimilarBlade> = vec![], Any, "", "";
    }
}

/// A property of the blade times a factor, given uniform or as a table.
pub fn times(uniform: &mut f64, table: &mut [(f64, f64)], factor: f64) {
    *uniform *= factor;
    for (_, value) in table {
        *value *= factor;
    }
}

impl RotorValues {
    /// Multiplies every stiffness, those of joints included: what another rotor speed or mass does to values that are over
    /// both.
    pub fn stiffen(&mut self, factor: f64) {
        let t = &mut self.tables;
        times(&mut self.gj, &mut t.gj, factor);
        times(&mut self.ei_flap, &mut t.ei_flap, factor);
        times(&mut self.ei_lag, &mut t.ei_lag, factor);
        times(&mut self.ea, &mut t.ea, factor);
        for joint in [&mut self.root.flap, &mut self.root.lag, &mut self.root.feather] {
            if let Joint::Spring { stiffness } = joint {
                *stiffness *= factor;
            }
        }
    }
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

values!(GravityChoice);

section! {
    /// Values along the span in place of the uniform ones: `mass: [(0, 1.5), (0.2, 1), (1, 0.9)]`, a list of
    /// `(station_r, value)` from `root_offset_r`, or further inboard, to 1, straight lines between. A table that
    /// is left out is the uniform value.
    #[serde(deny_unknown_fields, default)]
    pub struct BladeTables {
        /// Chord: of air loads, flaps, wake and solidity, which is thrust-weighted, `3 N_b / pi int_0^1 c x^2 dx`.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub chord_r: Vec<(f64, f64)> = vec![], Within(1e-3, 0.5), "R",
            "a blade's chord is 0.03 to 0.12 R";
        /// How far the sections, with their mass and aerodynamic centres, lie behind the straight elastic axis. Its
        /// slope is the tangent of the sweep angle: `[(0, 0), (0.92, 0), (1, 0.029)]` sweeps the tip by 20 deg.
        /// `couplings: Moderate`, linear sections and no flap there; `km2_r` at least as large.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub set_back_r: Vec<(f64, f64)> = vec![], Within(-0.2, 0.2), "R",
            "aft positive; a tip swept by 20 deg from 0.92 R ends at 0.029 R";
        /// Mass per length over `mass_kg_m`.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub mass: Vec<(f64, f64)> = vec![], UpTo(RIGID), "m0", "a mass is positive";
        /// Flap bending stiffness.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub ei_flap: Vec<(f64, f64)> = vec![], UpTo(RIGID), "m0 Omega^2 R^4", "a stiffness is positive";
        /// Lag bending stiffness.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub ei_lag: Vec<(f64, f64)> = vec![], UpTo(RIGID), "m0 Omega^2 R^4", "a stiffness is positive";
        /// Torsion stiffness.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub gj: Vec<(f64, f64)> = vec![], UpTo(RIGID), "m0 Omega^2 R^4", "a stiffness is positive";
        /// Axial stiffness.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub ea: Vec<(f64, f64)> = vec![], UpTo(RIGID_ALONG), "m0 Omega^2 R^2",
            "a stiffness is positive";
        /// Mass radius of gyration about the chord line.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub km1_r: Vec<(f64, f64)> = vec![], UpTo(RIGID), "R", "a radius of gyration is positive";
        /// Mass radius of gyration about the normal to the chord.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub km2_r: Vec<(f64, f64)> = vec![], UpTo(RIGID), "R", "a radius of gyration is positive";
        /// Area radius of gyration.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub ka_r: Vec<(f64, f64)> = vec![], Within(0.0, 1.0), "R",
            "a radius is not negative; 0.029 R is usual";
        /// Twist; the table says itself where it is zero.
        #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "not_empty")]
        pub twist_deg: Vec<(f64, f64)> = vec![], Within(-90.0, 90.0), "deg",
            "a helicopter's blade turns by 8 to 16 deg from root to tip";
    }
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

section! {
    /// A blade that differs from the others: factors on what they have.
    #[derive(Copy)]
    #[serde(deny_unknown_fields)]
    pub struct DissimilarBlade {
        /// Its number: blade k flies `(k - 1) 360 deg / blades` ahead of blade 1, whose azimuth is the
        /// rotor's.
        pub blade: usize = 1, Rule("1 to the number of blades, each once; required"), "", "";
        /// On the mass per length.
        #[serde(default = "one")]
        pub mass: f64 = 1.0, Within(0.5, 2.0), "", "a factor on what the other blades have: 1.02 is 2 % more";
        /// On the flap bending stiffness.
        #[serde(default = "one")]
        pub ei_flap: f64 = 1.0, Within(0.5, 2.0), "", "a factor on what the other blades have: 1.02 is 2 % more";
        /// On the lag bending stiffness.
        #[serde(default = "one")]
        pub ei_lag: f64 = 1.0, Within(0.5, 2.0), "", "a factor on what the other blades have: 1.02 is 2 % more";
        /// On the torsion stiffness.
        #[serde(default = "one")]
        pub gj: f64 = 1.0, Within(0.5, 2.0), "", "a factor on what the other blades have: 1.02 is 2 % more";
        /// Pitch beyond that of the others, such as a pitch link of another length.
        #[serde(default, skip_serializing_if = "is_default")]
        pub pitch_deg: f64 = 0.0, Within(-2.0, 2.0), "deg", "a pitch link is set to 0.1 deg or better";
        /// On the motion of its flaps.
        #[serde(default = "one")]
        pub flap_motion: f64 = 1.0, Within(-2.0, 2.0), "", "1 moves its flaps like the others', 0 not at all";
    }
}

section! {
    /// A harmonic of pitch at the root: `amplitude_deg cos(harmonic psi - phase_deg)`, nose up positive, `psi` the
    /// azimuth of the blade.
    #[derive(Copy)]
    #[serde(deny_unknown_fields)]
    pub struct PitchHarmonic {
        /// Its number.
        pub harmonic: usize = 3, Count(2, 12), "1/rev", "the first is cyclic pitch, which the trim sets";
        /// Its amplitude.
        pub amplitude_deg: f64 = 0.0, Within(0.0, 10.0), "deg", "higher harmonic control is of 1 or 2 deg";
        /// Its phase.
        pub phase_deg: f64 = 0.0, Within(-360.0, 360.0), "deg", "a positive phase is later";
    }
}

/// What gives a blade its higher harmonics of pitch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RootPitchBy {
    /// An actuator of its own.
    #[default]
    EachBlade,
    /// The swashplate.
    Swashplate,
}

values!(RootPitchBy);

fn one() -> f64 {
    1.0
}

section! {
    /// A trailing-edge flap.
    #[serde(deny_unknown_fields)]
    pub struct FlapValues {
        /// Inboard edge.
        pub start_r: f64 = 0.70, Rule("outboard of cut-out, root and the flap before; required"), "R", "";
        /// Outboard edge.
        pub end_r: f64 = 0.75, Rule("`start_r` to 1; required"), "R", "";
        /// Flap chord over blade chord.
        #[serde(default = "a_fifth")]
        pub chord_fraction: f64 = 0.20, Within(0.05, 0.5), "", "the paper's flap has 0.20 chord";
        /// Flap mass per length over `mass_kg_m`.
        #[serde(default = "a_tenth")]
        pub mass_fraction: f64 = 0.10, Within(0.0, 1.0), "", "the flap's mass is part of the blade's";
        /// Centre of gravity behind the hinge over the flap chord.
        #[serde(default = "a_fifth")]
        pub cg_fraction: f64 = 0.20, Within(-1.0, 1.0), "", "behind the hinge is positive, 1 is the trailing edge";
        /// Radius of gyration about the hinge over the flap chord; left out: a uniform thin rod about its
        /// centre of gravity.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub gyration_fraction: Option<f64> = None, Rule("`cg_fraction` to 1"), "", "";
        /// Whether `mass_kg_m` and `tables.mass` contain the flap. Added, it weighs on the elastic axis, and
        /// its distance from there makes loads of its own.
        #[serde(default, skip_serializing_if = "is_default")]
        pub mass: FlapMass = FlapMass::PartOfBlade, Any, "", "";
        /// Factors on the loads that the flap makes.
        #[serde(default, skip_serializing_if = "is_default")]
        pub effectiveness: EffectivenessValues = EffectivenessValues::default(), Any, "", "";
    }
}

section! {
    /// Factors on the loads a flap makes; 1 is thin-aerofoil theory.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct EffectivenessValues {
        /// On the lift.
        pub lift: f64 = 1.0, Within(0.0, 2.0), "", "1 is thin-aerofoil theory; a real flap makes about 0.8 of its lift";
        /// On the moment about the quarter chord.
        pub moment: f64 = 1.0, Within(0.0, 2.0), "", "1 is thin-aerofoil theory; a real flap makes about 0.8 of its lift";
        /// On the hinge moment.
        pub hinge: f64 = 1.0, Within(0.0, 2.0), "", "1 is thin-aerofoil theory; a real flap makes about 0.8 of its lift";
    }
}

fn a_fifth() -> f64 {
    0.20
}

fn a_tenth() -> f64 {
    0.10
}
