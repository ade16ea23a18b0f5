//! The sections of a case: the free wake.

use super::field::{Value, Visitor, choice, section, variant_names};
use rotor_wake::{
    ControlPoint, CoreModel, FarField, NearWakeMotion, ReleasePoint, WakeMethod, WakeSymmetry,
};
use serde::{Deserialize, Serialize};

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

section! {
    /// `circulation: Prescribed(...)`: a circulation given beforehand, on straight blades in the plane of the
    /// hub; for `hhc wake` alone.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct PrescribedCirculation {
        /// How it is spread over the disk. `Constant`: `2 pi C_T / N_b` everywhere. `Elliptic`: along the
        /// lifting span, without rolling moment.
        pub shape: CirculationShape = CirculationShape::Elliptic, Any, "", "";
        /// Thrust coefficient over solidity.
        pub ct_sigma: f64 = 0.07, Within(1e-4, 0.3), "", "0.07 is usual";
        /// Tilt of the shaft, forward positive.
        pub shaft_tilt_deg: f64 = 5.0, Within(-85.0, 85.0), "deg", "5 is usual, forward positive";
        /// `Free`: the wake moves with the velocities it induces. `Undistorted`: helices.
        pub geometry: GeometryChoice = GeometryChoice::Free, Any, "", "";
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

impl Value for CirculationChoice {
    fn choices() -> &'static [&'static str] {
        variant_names::<Self>()
    }

    fn inside<V: Visitor>(&self, visitor: &mut V) -> bool {
        let Self::Prescribed(given) = self else { return false };
        visitor.section("Prescribed", given);
        true
    }
}

choice!(RolledUpChoice, CirculationShape, GeometryChoice);

section! {
    /// `model: FreeWake(...)`: the free wake of Bagai and Leishman.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct FreeWakeValues {
        /// Where the circulation comes from: the trimmed rotor, or given for `hhc wake`.
        pub circulation: CirculationChoice = CirculationChoice::Trimmed, Any, "", "";
        /// Azimuth steps per revolution; left out: 36 or the next multiple of the blades above (40 for 5 and 8
        /// blades, 42 for 7). More than 48 ask for `time_gauss_points` of 12 or 16.
        pub azimuths: Option<usize> = None, Rule("8 to 144, a multiple of the blades"), "", "";
        /// Free turns of the rolled-up vortices.
        pub turns: usize = 4, Count(1, 12), "", "4 are usual in forward flight";
        /// Turns that repeat the last free one behind it; left out: 2, in hover 6.
        pub far_turns: Option<usize> = None, Count(0, 20), "", "2 are usual, 6 in hover";
        /// Spanwise panels of a blade.
        pub panels: usize = 20, Count(6, 60), "", "20 are usual";
        /// Age up to which all trailers are kept.
        pub near_wake_deg: f64 = 360.0, Within(1.0, 1440.0), "deg", "360 is one revolution";
        /// How these trailers travel. `BladePlane`: fixed to the plane of the blade, for short near wakes.
        /// `Convected`: with free stream and mean induced velocity. `FollowsTip`: distorted in proportion to
        /// the station by what the tip vortex has become. `Free`: as the tip vortex, slow; nearest to the
        /// measured tip vortex in hover with 90 deg, `TipRootAndSheet`, `Axial`, `Corrected`.
        pub near_wake: NearWakeMotion = NearWakeMotion::FollowsTip, Any, "", "";
        /// Vortices behind the near wake. `TipRootAndFlaps`: one more at each end of the flaps.
        /// `TipRootAndSheet`: four for the inboard sheet at 0.35, 0.5, 0.65 and 0.78 R; hover needs it.
        pub rolled_up: RolledUpChoice = RolledUpChoice::Tip, Any, "", "";
        /// Where on the trailing edge these leave: at their stations, or at the centroid of what they collect
        /// (Betz).
        pub release: ReleasePoint = ReleasePoint::Station, Any, "", "";
        /// Where on the chord the sections feel the wake; `ThreeQuarterChord` (Weissinger) for blades of few
        /// chords' length.
        pub control_point: ControlPoint = ControlPoint::LiftingLine, Any, "", "";
        /// Velocity profile of the cores: Vatistas, n = 2, or `Corrected`, Rosenhead and Moore's cut-off with
        /// the curvature between segments.
        pub core: CoreModel = CoreModel::Vatistas, Any, "", "";
        /// Core radius of the rolled-up vortices at release.
        pub core_r: f64 = 0.02, Within(1e-3, 0.2), "R", "about a third of the chord is usual";
        /// Core radius, at least, with which rolled-up vortices move each other; 0 for their own, 0.1 where a
        /// wake at low speed does not converge.
        pub mutual_core_r: f64 = 0.05, Within(0.0, 0.2), "R", "0.05 is usual, 0.1 at low speed";
        /// Core radius of the near wake where it passes blades; left out: one chord.
        pub near_core_r: Option<f64> = None, Within(1e-3, 0.2), "R", "leave it out for the chord of the blade";
        /// Core radius of the trailers younger than 30 deg over the width of the panel beside them, at most; a
        /// large number for no limit.
        pub panel_share: f64 = 0.3, Within(0.01, 1e6), "", "0.3 is usual; a large number is no limit";
        /// `Relaxed`: sweeps of pseudo-implicit relaxation. `Marched`: revolutions in time (PC2B), three per
        /// update.
        pub method: WakeMethod = WakeMethod::Relaxed, Any, "", "";
        /// `Periodic`: each azimuth has its own wake. `Axial`: the wake turns with its blades, whose mean over
        /// the azimuth it takes; hover only, refused where blades move by more than 0.01 R.
        pub symmetry: WakeSymmetry = WakeSymmetry::Periodic, Any, "", "";
        /// Precision of the velocities of rolled-up vortices older than a revolution.
        pub far_field: FarField = FarField::Double, Any, "", "";
        /// Velocities of the relaxed wake are computed at every n-th age and interpolated between along the
        /// path of the air; 1 computes all.
        pub velocity_stride: usize = 1, Count(1, 3), "", "1 computes every age";
        /// Largest change of the inflow between two updates of the wake, over the tip speed.
        pub tolerance: f64 = 2e-4, Within(1e-8, 1e-2), "", "2e-4 of the tip speed is usual";
        /// RMS displacement of the wake in the last sweep of an update.
        pub displacement_tolerance_r: f64 = 2e-3, Within(1e-8, 0.5), "R", "0.002 R is usual";
        /// Updates of the wake allowed.
        pub updates: usize = 30, Count(1, 200), "", "30 are usual";
    }
}

/// Turns that repeat the last free one in forward flight, and in hover.
const USUAL_FAR_TURNS: usize = 2;
const HOVER_FAR_TURNS: usize = 6;

/// Azimuth steps per revolution of a wake, where a case asks for none.
const USUAL_AZIMUTHS: usize = 36;

impl FreeWakeValues {
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
