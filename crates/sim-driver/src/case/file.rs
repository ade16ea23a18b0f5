//! The case file as users write it: rotor, structure, aerodynamics, inflow, numerics.
//!
//! Every field has a default, the paper's value where the paper gives one, so that a short case is a
//! variation of the paper's. Field names carry their unit; a name without unit is a pure number or a
//! stiffness in the paper's nondimensional form, as its line says.

use super::{
    ActuatorFile, BladeTablesFile, ControlFile, FreeWakeFile, GravityChoice, RootFile, TrimFile,
    UnlikeBladeFile,
};
use serde::{Deserialize, Serialize};

/// A whole case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CaseFile {
    /// One line about the case.
    pub title: String,
    /// Advance ratio `mu = V cos(alpha_s) / (Omega R)`, 0 to 0.5.
    pub advance_ratio: f64,
    /// The rotor.
    pub rotor: RotorFile,
    /// Trailing-edge flaps from root to tip.
    pub flaps: Vec<FlapFile>,
    /// Structural model of the blade.
    pub structure: StructureFile,
    /// Section aerodynamics.
    pub aerodynamics: AerodynamicsFile,
    /// Inflow.
    pub inflow: InflowFile,
    /// What the rotor is trimmed to.
    pub trim: TrimFile,
    /// Actuator of the flaps.
    pub actuator: ActuatorFile,
    /// Higher harmonic control.
    pub control: ControlFile,
    /// Discretisation of the periodic response.
    pub response: ResponseFile,
    /// Tolerances of the solvers.
    pub tolerances: TolerancesFile,
}

impl Default for CaseFile {
    fn default() -> Self {
        Self {
            title: "Untitled case: whatever the file leaves out is the paper rotor's".to_owned(),
            advance_ratio: 0.30,
            rotor: RotorFile::default(),
            flaps: vec![
                FlapFile { start_r: 0.70, end_r: 0.75, ..FlapFile::default() },
                FlapFile { start_r: 0.80, end_r: 0.85, ..FlapFile::default() },
            ],
            structure: StructureFile::default(),
            aerodynamics: AerodynamicsFile::default(),
            inflow: InflowFile::default(),
            trim: TrimFile::default(),
            actuator: ActuatorFile::default(),
            control: ControlFile::default(),
            response: ResponseFile::default(),
            tolerances: TolerancesFile::default(),
        }
    }
}

/// The rotor. Stiffness in `m0 Omega^2 R^4` (`ea` in `m0 Omega^2 R^2`), radii of gyration in R.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RotorFile {
    /// Number of blades.
    pub blades: usize,
    /// Radius, m.
    pub radius_m: f64,
    /// Rotor speed, revolutions per minute.
    pub omega_rpm: f64,
    /// Mass per length of the blade, kg/m; flaps included unless they say `AddedToBlade`.
    pub mass_kg_m: f64,
    /// Blade chord, radius R.
    pub chord_r: f64,
    /// Lock number `rho a c R^4 / I_b`, `a = 2 pi`, `I_b = m0 R^3 / 3`; it sets the air density.
    pub lock_number: f64,
    /// Flap bending stiffness `EI_y / (m0 Omega^2 R^4)`.
    pub ei_flap: f64,
    /// Lag bending stiffness `EI_z / (m0 Omega^2 R^4)`.
    pub ei_lag: f64,
    /// Torsion stiffness `GJ / (m0 Omega^2 R^4)`.
    pub gj: f64,
    /// Axial stiffness `EA / (m0 Omega^2 R^2)`.
    pub ea: f64,
    /// Mass radius of gyration about the chord line, radius R.
    pub km1_r: f64,
    /// Mass radius of gyration about the normal to the chord, radius R.
    pub km2_r: f64,
    /// Area radius of gyration, radius R.
    pub ka_r: f64,
    /// Linear twist from root to tip, deg, zero at 0.75 R.
    pub twist_deg: f64,
    /// Precone, deg, up positive.
    pub precone_deg: f64,
    /// Aerodynamic root cut-out, radius R.
    pub root_cutout_r: f64,
    /// Damping of every mode over critical.
    pub modal_damping: f64,
    /// Radial station of the blade's root, radius R: nothing moves or weighs inboard.
    #[serde(skip_serializing_if = "is_default")]
    pub root_offset_r: f64,
    /// How the root is held.
    #[serde(skip_serializing_if = "is_default")]
    pub root: RootFile,
    /// Mass centre ahead of the elastic axis, radius R; `couplings: Moderate` alone knows it.
    #[serde(skip_serializing_if = "is_default")]
    pub mass_centre_r: f64,
    /// Tension centre ahead of the elastic axis, radius R; `couplings: Moderate` alone knows it.
    #[serde(skip_serializing_if = "is_default")]
    pub tension_centre_r: f64,
    /// Aerodynamic centre, the quarter chord, ahead of the elastic axis, radius R.
    #[serde(skip_serializing_if = "is_default")]
    pub aerodynamic_centre_r: f64,
    /// Axis of the blade ahead of the rotor centre, radius R; `couplings: Moderate` does not know it.
    #[serde(skip_serializing_if = "is_default")]
    pub torque_offset_r: f64,
    /// Weight of the blades.
    #[serde(skip_serializing_if = "is_default")]
    pub gravity: GravityChoice,
    /// Values along the span in place of uniform ones.
    #[serde(skip_serializing_if = "is_default")]
    pub tables: BladeTablesFile,
    /// Blades unlike the rest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unlike_blades: Vec<UnlikeBladeFile>,
}

impl Default for RotorFile {
    fn default() -> Self {
        Self {
            blades: 4,
            radius_m: 4.94,
            omega_rpm: 383.0,
            mass_kg_m: 6.46,
            chord_r: 0.055,
            lock_number: 5.20,
            ei_flap: 0.0108,
            ei_lag: 0.0268,
            gj: 0.00615,
            ea: 1000.0,
            km1_r: 0.0132,
            km2_r: 0.0247,
            ka_r: 0.029,
            twist_deg: -8.0,
            precone_deg: 0.0,
            root_cutout_r: 0.20,
            modal_damping: 0.005,
            root_offset_r: 0.0,
            root: RootFile::default(),
            mass_centre_r: 0.0,
            tension_centre_r: 0.0,
            aerodynamic_centre_r: 0.0,
            torque_offset_r: 0.0,
            gravity: GravityChoice::Off,
            tables: BladeTablesFile::default(),
            unlike_blades: vec![],
        }
    }
}

/// A trailing-edge flap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlapFile {
    /// Inboard edge, radius R.
    pub start_r: f64,
    /// Outboard edge, radius R.
    pub end_r: f64,
    /// Flap chord over blade chord.
    #[serde(default = "a_fifth")]
    pub chord_fraction: f64,
    /// Flap mass per length over `mass_kg_m`.
    #[serde(default = "a_tenth")]
    pub mass_fraction: f64,
    /// Centre of gravity behind the hinge over the flap chord.
    #[serde(default = "a_fifth")]
    pub cg_fraction: f64,
    /// Radius of gyration about the hinge over the flap chord; left out, a uniform thin rod about the
    /// centre of gravity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gyration_fraction: Option<f64>,
    /// Whether `mass_kg_m` contains the flap.
    #[serde(default, skip_serializing_if = "FlapMassChoice::is_part")]
    pub mass: FlapMassChoice,
    /// How much of thin-aerofoil theory's flap it is.
    #[serde(default, skip_serializing_if = "EffectivenessFile::is_ideal")]
    pub effectiveness: EffectivenessFile,
}

/// Whether the mass of the blade contains that of a flap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FlapMassChoice {
    /// It does: the flap at rest is blade.
    #[default]
    PartOfBlade,
    /// It does not: the blade is heavier by the flap.
    AddedToBlade,
}

impl FlapMassChoice {
    /// Whether it is the default: not written then.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
    fn is_part(&self) -> bool {
        *self == Self::PartOfBlade
    }
}

/// Factors on the loads a flap makes; 1 is theory's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EffectivenessFile {
    /// On the lift.
    pub lift: f64,
    /// On the moment about the quarter chord.
    pub moment: f64,
    /// On the hinge moment.
    pub hinge: f64,
}

impl Default for EffectivenessFile {
    fn default() -> Self {
        Self { lift: 1.0, moment: 1.0, hinge: 1.0 }
    }
}

impl EffectivenessFile {
    /// Whether it is theory's: not written then.
    fn is_ideal(&self) -> bool {
        *self == Self::default()
    }
}

fn a_fifth() -> f64 {
    0.20
}

fn a_tenth() -> f64 {
    0.10
}

impl Default for FlapFile {
    fn default() -> Self {
        Self {
            start_r: 0.70,
            end_r: 0.75,
            chord_fraction: a_fifth(),
            mass_fraction: a_tenth(),
            cg_fraction: a_fifth(),
            gyration_fraction: None,
            mass: FlapMassChoice::PartOfBlade,
            effectiveness: EffectivenessFile::default(),
        }
    }
}

/// Which nonlinear terms the blade equations carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CouplingsChoice {
    /// Small deflections, flap and lag apart.
    Linear,
    /// Coriolis, foreshortening, propeller moment and pitch-flap-lag coupling.
    Full,
    /// Exact modal equations of the moderately deflected blade.
    Moderate,
}

/// Whether tension turns a twisted blade back; `couplings: Moderate` alone knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum UntwistChoice {
    /// The moment `N k_A^2 th_x` acts.
    #[default]
    Included,
    /// Tension stiffens the elastic twist only.
    Neglected,
}

/// What the twist of the blade is; `couplings: Moderate` alone knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TwistAngleChoice {
    /// The section's pitch, which bending in two planes changes too: `kappa_x = phi_x + w_x v_xx`.
    #[default]
    Rotation,
    /// Elastic twist alone: `kappa_x = phi_x`.
    Elastic,
}

/// The shapes behind the modes of the response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum BasisChoice {
    /// Natural modes.
    #[default]
    Natural,
    /// The last mode of every family gives way to the static answer of all modes left out.
    Completed,
}

/// Structural model of the blade.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StructureFile {
    /// Beam elements.
    pub elements: usize,
    /// Modes kept in the response.
    pub modes: ModesFile,
    /// The shapes behind the modes.
    #[serde(skip_serializing_if = "is_default")]
    pub basis: BasisChoice,
    /// Terms of the equations.
    pub couplings: CouplingsChoice,
    /// Tension on the built-in twist.
    #[serde(skip_serializing_if = "is_default")]
    pub untwist: UntwistChoice,
    /// The twist angle.
    #[serde(skip_serializing_if = "is_default")]
    pub twist_angle: TwistAngleChoice,
}

impl Default for StructureFile {
    fn default() -> Self {
        Self {
            elements: 10,
            modes: ModesFile::default(),
            basis: BasisChoice::Natural,
            couplings: CouplingsChoice::Full,
            untwist: UntwistChoice::Included,
            twist_angle: TwistAngleChoice::Rotation,
        }
    }
}

/// Number of modes of each kind; by default a flap mode more than the paper's 4, 4, 2, with which the
/// vibratory yawing moment has not converged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModesFile {
    /// Flap modes.
    pub flap: usize,
    /// Lag modes.
    pub lag: usize,
    /// Torsion modes.
    pub torsion: usize,
}

impl Default for ModesFile {
    fn default() -> Self {
        Self { flap: 5, lag: 4, torsion: 2 }
    }
}

/// Section models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SectionModelChoice {
    /// No lag, no apparent mass.
    QuasiSteady,
    /// Theodorsen's theory, Mach 0 only.
    Incompressible,
    /// Compressible indicial functions of the Hariharan-Leishman form (a reconstruction).
    HariharanLeishman,
    /// Compressible, fitted to exact linear theory; flap chords 0.1 to 0.4.
    Calibrated,
}

/// How the Mach number enters the sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CompressibilityChoice {
    /// Mach 0 everywhere.
    None,
    /// Local Mach number; a Prandtl-Glauert factor in the quasi-steady model.
    LocalMach,
}

/// Circulation of a section where its tangential speed changes sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ReverseFlowChoice {
    /// It passes through zero as the flow turns normal to the chord.
    Gradual,
    /// It jumps, as in small-angle theory.
    Abrupt,
}

/// An aerofoil table along the span.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirfoilFile {
    /// Station, radius R: between two stations both tables are blended linearly.
    pub station_r: f64,
    /// C81 file, relative to the case file.
    pub table: String,
}

/// Dynamic stall of the sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DynamicStallChoice {
    /// None: without a table the flow stays attached, with one the stall is static.
    #[default]
    Off,
    /// Leishman and Beddoes with their constants of the NACA 0012.
    Naca0012,
}

/// Whether a factor changes nothing: not written then.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
#[expect(clippy::float_cmp, reason = "one as it is written")]
fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}

/// Whether a choice is the default: not written then.
fn is_default<T: Default + PartialEq>(choice: &T) -> bool {
    *choice == T::default()
}

/// Section aerodynamics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AerodynamicsFile {
    /// Section model.
    pub model: SectionModelChoice,
    /// Mach number.
    pub compressibility: CompressibilityChoice,
    /// Circulation at the edge of the reverse-flow region.
    pub reverse_flow: ReverseFlowChoice,
    /// Profile drag coefficient, where there is no table.
    pub drag_coefficient: f64,
    /// Speed of sound, m/s.
    pub speed_of_sound_m_s: f64,
    /// Aerofoil tables from root to tip; none for the linear law.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub airfoils: Vec<AirfoilFile>,
    /// Dynamic stall.
    #[serde(skip_serializing_if = "is_default")]
    pub dynamic_stall: DynamicStallChoice,
    /// Tip loss factor B, radius R: outboard of it a section drags but does not lift.
    #[serde(skip_serializing_if = "is_one")]
    pub tip_loss: f64,
}

impl Default for AerodynamicsFile {
    fn default() -> Self {
        Self {
            model: SectionModelChoice::HariharanLeishman,
            compressibility: CompressibilityChoice::LocalMach,
            reverse_flow: ReverseFlowChoice::Gradual,
            drag_coefficient: 0.01,
            speed_of_sound_m_s: 340.3,
            airfoils: vec![],
            dynamic_stall: DynamicStallChoice::Off,
            tip_loss: 1.0,
        }
    }
}

/// Inflow models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum InflowChoice {
    /// Glauert's momentum theory, uniform.
    Uniform,
    /// Momentum theory with Drees's gradients.
    Drees,
    /// A given uniform induced inflow.
    Prescribed {
        /// `lambda_i`, tip speed, positive down.
        lambda_i: f64,
    },
    /// Pitt and Peters: mean and gradients follow thrust and its first harmonics.
    PittPeters,
    /// The free wake of the rolled-up vortices, settled together with the trim.
    FreeWake(FreeWakeFile),
}

/// Inflow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InflowFile {
    /// Inflow model.
    pub model: InflowChoice,
}

impl Default for InflowFile {
    fn default() -> Self {
        Self { model: InflowChoice::Drees }
    }
}

/// Discretisation of the periodic response.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseFile {
    /// Elements in time over one revolution.
    pub time_elements: usize,
    /// Polynomial order of the time elements.
    pub time_order: usize,
    /// Gauss points per time element.
    pub time_gauss_points: usize,
    /// Gauss points in each spanwise piece between element ends, cut-out and flap edges.
    pub span_points_per_piece: usize,
    /// Highest harmonic of the loads kept in results.
    pub load_harmonics: usize,
    /// Stations at which the loads of the blade are given, radius R; left out: root, 0.25, 0.5 and 0.75.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_stations_r: Option<Vec<f64>>,
}

impl Default for ResponseFile {
    fn default() -> Self {
        Self {
            time_elements: 8,
            time_order: 5,
            time_gauss_points: 8,
            span_points_per_piece: 4,
            load_harmonics: 12,
            load_stations_r: None,
        }
    }
}

/// Tolerances of the solvers. Pure numbers in rotor units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TolerancesFile {
    /// Largest trim residual over the weight.
    pub trim: f64,
    /// Newton iterations of the trim.
    pub trim_iterations: usize,
    /// Largest weak residual of the periodic orbit.
    pub periodicity: f64,
    /// Largest mismatch of the inflow, tip speed.
    pub inflow: f64,
    /// Inflow iterations.
    pub inflow_iterations: usize,
}

impl Default for TolerancesFile {
    fn default() -> Self {
        Self {
            trim: 1e-9,
            trim_iterations: 40,
            periodicity: 1e-11,
            inflow: 1e-10,
            inflow_iterations: 60,
        }
    }
}
