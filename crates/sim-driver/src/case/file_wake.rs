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

/// Velocity profile of the cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoreChoice {
    /// Vatistas's profile, n = 2.
    Vatistas,
    /// Rosenhead and Moore's cut-off with the curvature between segments: rings travel at Kelvin's speed.
    Corrected,
}

/// The free wake of Bagai and Leishman. Every field has a default.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FreeWakeFile {
    /// Azimuth steps per revolution, a multiple of the number of blades.
    pub azimuths: usize,
    /// Free turns of the rolled-up vortices.
    pub turns: usize,
    /// Turns that repeat the last free one behind it.
    pub far_turns: usize,
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
    /// Core radius of the near wake, radius R.
    pub near_core_r: f64,
    /// Core radius of the youngest trailers over the width of the panel beside them, at most; a large number for no
    /// limit.
    pub panel_share: f64,
    /// Relaxation or march in time.
    pub method: WakeMethodChoice,
    /// What the wakes at different azimuths have in common.
    pub symmetry: SymmetryChoice,
    /// Largest change of the inflow between two updates of the wake, tip speed.
    pub tolerance: f64,
    /// Updates of the wake allowed.
    pub updates: usize,
}

/// A share of a panel that no core reaches.
const NO_LIMIT: f64 = 1e6;

impl Default for FreeWakeFile {
    fn default() -> Self {
        Self {
            azimuths: 24,
            turns: 4,
            far_turns: 2,
            panels: 20,
            near_wake_deg: 360.0,
            near_wake: NearWakeChoice::FollowsTip,
            rolled_up: RolledUpChoice::Tip,
            release: ReleaseChoice::Station,
            control_point: ControlPointChoice::LiftingLine,
            core: CoreChoice::Vatistas,
            core_r: 0.02,
            near_core_r: 0.02,
            panel_share: NO_LIMIT,
            method: WakeMethodChoice::Relaxed,
            symmetry: SymmetryChoice::Periodic,
            tolerance: 2e-4,
            updates: 12,
        }
    }
}
