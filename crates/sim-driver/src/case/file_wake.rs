//! The free wake in the case file.

use serde::{Deserialize, Serialize};

/// How the trailers of the near wake travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NearWakeChoice {
    /// Fixed to the plane of the blade: for short near wakes.
    BladePlane,
    /// With the free stream and the mean induced velocity.
    Convected,
    /// As convected, distorted in proportion to the station by what has become of the tip vortex.
    FollowsTip,
    /// Free, as the tip vortex is: slow.
    Free,
}

/// Which rolled-up vortices go on behind the near wake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RolledUpChoice {
    /// The tip vortex.
    Tip,
    /// Tip and root vortex.
    TipAndRoot,
    /// Tip and root vortex and one at each end of the trailing-edge flaps.
    TipRootAndFlaps,
    /// Tip and root vortex and, for the sheet between them, four where it is trailed: at 0.35, 0.5, 0.65 and
    /// 0.78 R. Hover needs it.
    TipRootAndSheet,
}

/// Where on the trailing edge the rolled-up vortices leave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReleaseChoice {
    /// At their stations: the tip vortex at the tip.
    Station,
    /// At the centroid of what they collect (Betz).
    Centroid,
}

/// Where on the chord the sections feel the wake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ControlPointChoice {
    /// On the lifting line at the quarter chord.
    LiftingLine,
    /// At three quarters of the chord (Weissinger): for blades of few chords' length.
    ThreeQuarterChord,
}

/// How the wake is carried on between two trims.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WakeMethodChoice {
    /// Sweeps of pseudo-implicit relaxation: the same every revolution.
    Relaxed,
    /// Revolutions marched in time (PC2B), every blade on its own.
    Marched,
}

/// What the wakes at different azimuths have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SymmetryChoice {
    /// Each azimuth has its own.
    Periodic,
    /// The wake turns with its blades: hover without cyclic pitch.
    Axial,
}

/// Precision of the velocities that old vortices induce on the wake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FarFieldChoice {
    /// Double.
    Double,
    /// Single for rolled-up vortices older than a revolution; what the blades feel stays double.
    Single,
}

/// Velocity profile of the cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoreChoice {
    /// Vatistas's profile, n = 2.
    Vatistas,
    /// Rosenhead and Moore's cut-off with the curvature between segments: rings travel at Kelvin's speed.
    Corrected,
}

/// Circulation of a wake that is looked at alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CirculationShape {
    /// The same everywhere, `2 pi C_T / N_b`.
    Constant,
    /// Elliptic along the lifting span, less on the advancing side so that there is no rolling moment, of the thrust asked
    /// for.
    Elliptic,
}

/// What a wake of prescribed circulation does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum GeometryChoice {
    /// Moves with the velocities it induces.
    Free,
    /// Helices, carried by the free stream and Glauert's mean inflow.
    Undistorted,
}

/// A circulation given beforehand, on straight blades in the plane of the hub.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrescribedCirculation {
    /// How it is spread over the disk.
    pub shape: CirculationShape,
    /// Thrust coefficient over solidity.
    pub ct_sigma: f64,
    /// Tilt of the shaft, forward positive, deg.
    pub shaft_tilt_deg: f64,
    /// Whether the wake moves.
    pub geometry: GeometryChoice,
}

impl Default for PrescribedCirculation {
    fn default() -> Self {
        Self {
            shape: CirculationShape::Elliptic,
            ct_sigma: 0.07,
            shaft_tilt_deg: 5.0,
            geometry: GeometryChoice::Free,
        }
    }
}

/// Where the circulation of the blades comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum CirculationChoice {
    /// From the rotor, trimmed in its wake.
    Trimmed,
    /// Given: for `hhc wake` alone.
    Prescribed(PrescribedCirculation),
}

/// The free wake of Bagai and Leishman. Every field has a default.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FreeWakeFile {
    /// Where the circulation comes from.
    pub circulation: CirculationChoice,
    /// Azimuth steps per revolution, a multiple of the number of blades; none for 36 or the next multiple above.
    pub azimuths: Option<usize>,
    /// Free turns of the rolled-up vortices.
    pub turns: usize,
    /// Turns that repeat the last free one behind it; none for 2, in hover 6.
    pub far_turns: Option<usize>,
    /// Spanwise panels of a blade.
    pub panels: usize,
    /// Age up to which all trailers are kept, deg.
    pub near_wake_deg: f64,
    /// How these trailers travel.
    pub near_wake: NearWakeChoice,
    /// Vortices behind the near wake.
    pub rolled_up: RolledUpChoice,
    /// Where on the trailing edge these leave.
    pub release: ReleaseChoice,
    /// Where on the chord the sections feel the wake.
    pub control_point: ControlPointChoice,
    /// Velocity profile of the cores.
    pub core: CoreChoice,
    /// Core radius of the rolled-up vortices at release, radius R.
    pub core_r: f64,
    /// Core radius, at least, with which rolled-up vortices move each other, radius R; 0 for their own.
    pub mutual_core_r: f64,
    /// Core radius of the near wake, radius R; none for one chord of the blade.
    pub near_core_r: Option<f64>,
    /// Core radius of the trailers younger than 30 deg over the width of the panel beside them, at most; a large number
    /// for no limit.
    pub panel_share: f64,
    /// Relaxation or march in time.
    pub method: WakeMethodChoice,
    /// What the wakes at different azimuths have in common.
    pub symmetry: SymmetryChoice,
    /// Precision of the velocities that old vortices induce on the wake.
    pub far_field: FarFieldChoice,
    /// Velocities of the relaxed wake are computed at every so-manyth age and interpolated between; 1 for all.
    pub velocity_stride: usize,
    /// Largest change of the inflow between two updates of the wake, tip speed.
    pub tolerance: f64,
    /// RMS displacement of the wake in the last sweep of an update, radius R.
    pub displacement_tolerance_r: f64,
    /// Updates of the wake allowed.
    pub updates: usize,
}

impl Default for FreeWakeFile {
    fn default() -> Self {
        Self {
            circulation: CirculationChoice::Trimmed,
            azimuths: None,
            turns: 4,
            far_turns: None,
            panels: 20,
            near_wake_deg: 360.0,
            near_wake: NearWakeChoice::FollowsTip,
            rolled_up: RolledUpChoice::Tip,
            release: ReleaseChoice::Station,
            control_point: ControlPointChoice::LiftingLine,
            core: CoreChoice::Vatistas,
            core_r: 0.02,
            mutual_core_r: 0.05,
            near_core_r: None,
            panel_share: 0.3,
            method: WakeMethodChoice::Relaxed,
            symmetry: SymmetryChoice::Periodic,
            far_field: FarFieldChoice::Double,
            velocity_stride: 1,
            tolerance: 2e-4,
            displacement_tolerance_r: 2e-3,
            updates: 30,
        }
    }
}

/// Turns that repeat the last free one in forward flight, and in hover.
const USUAL_FAR_TURNS: usize = 2;
const HOVER_FAR_TURNS: usize = 6;

/// Azimuth steps per revolution of a wake, where a case asks for none.
const USUAL_AZIMUTHS: usize = 36;

impl FreeWakeFile {
    /// Azimuth steps per revolution for a number of blades: those asked for, or steps of 10 deg, or a little less where
    /// 36 is no multiple of the blades (40 for five and eight blades, 42 for seven).
    pub fn azimuths_for(&self, blades: usize) -> usize {
        self.azimuths.unwrap_or_else(|| USUAL_AZIMUTHS.next_multiple_of(blades.max(1)))
    }

    /// Turns that repeat the last free one: those asked for, or 2, or 6 in hover, where the wake stays below the disk.
    pub fn far_turns_at(&self, advance_ratio: f64) -> usize {
        let usual = if advance_ratio == 0.0 { HOVER_FAR_TURNS } else { USUAL_FAR_TURNS };
        self.far_turns.unwrap_or(usual)
    }
}
