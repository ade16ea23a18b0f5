//! The sections of a case: the free wake.

use super::field::{is_default, section, values};
use rotor_wake::{
    Body, ControlPoint, CoreModel, FarField, NearWakeMotion, ReleasePoint, WakeMethod, WakeSymmetry,
};
use serde::{Deserialize, Serialize};

/// Choices of a free wake that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum WakePreset {
    /// Four free turns, a near wake of one revolution that follows the tip vortex.
    #[default]
    ForwardFlight,
    /// A wake alike at every azimuth, with a near wake of 90 deg that moves freely, the inboard sheet as vortices, and
    /// cores with the curvature between segments.
    Hover,
    /// As in forward flight with two turns, steps of 15 deg and velocities at every second age.
    Fast,
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

values!(
    WakePreset,
    RolledUpChoice,
    CirculationShape,
    GeometryChoice,
    CirculationChoice { Prescribed }
);

section! {
    /// `body: (...)`: a fuselage or the housing of a test stand, fixed to the hub, as a prolate spheroid in the stream of
    /// the flight. It changes the velocity at the blades and along the free wake; the wake does not change the flow round
    /// it.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct BodyValues {
        /// Length; 0 is no body.
        pub length_r: f64 = 0.0, Within(0.0, 4.0), "R", "0 is no body";
        /// Largest diameter.
        pub diameter_r: f64 = 0.3, Within(0.01, 2.0), "R", "less than the length";
        /// Its axis below the hub, at its middle.
        pub below_hub_r: f64 = 0.4, Within(-2.0, 2.0), "R", "below the hub is positive";
        /// Its middle behind the hub.
        pub aft_of_hub_r: f64 = 0.0, Within(-4.0, 4.0), "R", "aft is positive";
        /// Its axis against the plane normal to the shaft, nose up positive.
        pub nose_up_deg: f64 = 0.0, Within(-45.0, 45.0), "deg", "nose up is positive";
    }
}

section! {
    /// `model: FreeWake(...)`: the free wake of Bagai and Leishman. A preset makes the choices that belong together; a field
    /// that is given comes before it. Those that move the result most stand first.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct FreeWakeValues {
        /// Choices that belong together: `ForwardFlight`, `Hover`, or `Fast` for a first look.
        pub preset: WakePreset = WakePreset::ForwardFlight, Any, "", "";
        /// Where the circulation comes from: the trimmed rotor, or given for `hhc wake`.
        pub circulation: CirculationChoice = CirculationChoice::Trimmed, Any, "", "";
        /// Age up to which all trailers are kept; by the preset 360, in hover 90.
        pub near_wake_deg: Option<f64> = None, Within(1.0, 1440.0), "deg", "360 is one revolution";
        /// Core radius of the near wake where it passes blades; left out: one chord.
        pub near_core_r: Option<f64> = None, Within(1e-3, 0.2), "R", "leave it out for the chord of the blade";
        /// Vortices behind the near wake; by the preset `Tip`, in hover `TipRootAndSheet`: four for the inboard sheet
        /// at 0.35, 0.5, 0.65 and 0.78 R. `TipRootAndFlaps`: one more at each end of the flaps.
        pub rolled_up: Option<RolledUpChoice> = None, Any, "", "";
        /// Spanwise panels of a blade.
        pub panels: usize = 20, Count(6, 60), "", "20 are usual";
        /// Azimuth steps per revolution; by the preset 36, 24 if fast, or the next multiple of the blades above. More
        /// than 48 ask for `time_gauss_points` of 12 or 16.
        pub azimuths: Option<usize> = None, Rule("8 to 144, a multiple of the blades"), "", "";
        /// Azimuths at which the sections feel the wake, its geometry interpolated to them; left out: `azimuths`. 180 for
        /// passages of vortices, with 16 `time_elements` of 15 `time_gauss_points`.
        #[serde(skip_serializing_if = "is_default")]
        pub section_azimuths: Option<usize> = None, Rule("a multiple of `azimuths`, at most 360"), "", "";
        /// Free turns of the rolled-up vortices; by the preset 4, 2 if fast.
        pub turns: Option<usize> = None, Count(1, 12), "", "4 are usual in forward flight";
        /// Core radius, at least, with which rolled-up vortices move each other; 0 for their own, 0.1 where a
        /// wake at low speed does not converge.
        pub mutual_core_r: f64 = 0.05, Within(0.0, 0.2), "R", "0.05 is usual, 0.1 at low speed";
        /// How the trailers of the near wake travel; by the preset `FollowsTip`, in hover `Free`. `BladePlane`: fixed
        /// to the plane of the blade. `Convected`: with free stream and mean induced velocity. `FollowsTip`: distorted
        /// in proportion to the station by what the tip vortex has become. `Free`: as the tip vortex, slow.
        pub near_wake: Option<NearWakeMotion> = None, Any, "", "";
        /// `Periodic`: each azimuth has its own wake. `Axial`, by the preset in hover alone: the wake turns with its
        /// blades; refused where blades move by more than 0.01 R.
        pub symmetry: Option<WakeSymmetry> = None, Any, "", "";
        /// Velocity profile of the cores; by the preset `Vatistas`, n = 2, in hover `Corrected`, Rosenhead and Moore's
        /// cut-off with the curvature between segments.
        pub core: Option<CoreModel> = None, Any, "", "";
        /// Core radius of the rolled-up vortices at release.
        pub core_r: f64 = 0.02, Within(1e-3, 0.2), "R", "about a third of the chord is usual";
        /// Core radius of the trailers younger than 30 deg over the width of the panel beside them, at most; a
        /// large number for no limit.
        pub panel_share: f64 = 0.3, Within(0.01, 1e6), "", "0.3 is usual; a large number is no limit";
        /// Turns that repeat the last free one behind it; left out: 2, in hover 6.
        pub far_turns: Option<usize> = None, Count(0, 20), "", "2 are usual, 6 in hover";
        /// Where on the trailing edge rolled-up vortices leave: at their stations, or at the centroid of what they
        /// collect (Betz).
        pub release: ReleasePoint = ReleasePoint::Station, Any, "", "";
        /// Where on the chord the sections feel the wake; `ThreeQuarterChord` (Weissinger) for blades of few
        /// chords' length.
        pub control_point: ControlPoint = ControlPoint::LiftingLine, Any, "", "";
        /// `Relaxed`: sweeps of pseudo-implicit relaxation. `Marched`: revolutions in time (PC2B), three per
        /// update.
        pub method: WakeMethod = WakeMethod::Relaxed, Any, "", "";
        /// Precision of the velocities that rolled-up vortices older than a revolution induce on the wake; by the preset
        /// `Single`, `Double` in hover.
        pub far_field: Option<FarField> = None, Any, "", "";
        /// Velocities of the relaxed wake are computed at every n-th age and interpolated between along the
        /// path of the air; by the preset 1, 2 if fast.
        pub velocity_stride: Option<usize> = None, Count(1, 3), "", "1 computes every age";
        /// Fuselage below the rotor; none by default.
        #[serde(skip_serializing_if = "is_default")]
        pub body: BodyValues = BodyValues::default(), Any, "", "";
        /// Largest change of the inflow between two updates of the wake, over the tip speed.
        pub tolerance: f64 = 2e-4, Within(1e-8, 1e-2), "", "2e-4 of the tip speed is usual";
        /// RMS displacement of the wake in the last sweep of an update.
        pub displacement_tolerance_r: f64 = 2e-3, Within(1e-8, 0.5), "R", "0.002 R is usual";
        /// Updates of the wake allowed.
        pub updates: usize = 30, Count(1, 200), "", "30 are usual";
    }
}

/// What a preset chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WakeChoices {
    /// Azimuth steps per revolution, before they are made a multiple of the blades.
    pub azimuths: usize,
    /// Free turns.
    pub turns: usize,
    /// Age up to which all trailers are kept, deg.
    pub near_wake_deg: f64,
    /// How the near wake travels.
    pub near_wake: NearWakeMotion,
    /// Vortices behind it.
    pub rolled_up: RolledUpChoice,
    /// Profile of the cores.
    pub core: CoreModel,
    /// Whether the wake is alike at every azimuth.
    pub symmetry: WakeSymmetry,
    /// Precision of the far field.
    pub far_field: FarField,
    /// Every how many ages velocities are computed.
    pub velocity_stride: usize,
}

impl WakePreset {
    /// Its choices.
    pub fn choices(self) -> WakeChoices {
        let flight = WakeChoices {
            azimuths: 36,
            turns: 4,
            near_wake_deg: 360.0,
            near_wake: NearWakeMotion::FollowsTip,
            rolled_up: RolledUpChoice::Tip,
            core: CoreModel::Vatistas,
            symmetry: WakeSymmetry::Periodic,
            far_field: FarField::Single,
            velocity_stride: 1,
        };
        match self {
            Self::ForwardFlight => flight,
            Self::Hover => WakeChoices {
                near_wake_deg: 90.0,
                near_wake: NearWakeMotion::Free,
                rolled_up: RolledUpChoice::TipRootAndSheet,
                core: CoreModel::RosenheadMoore,
                symmetry: WakeSymmetry::Axial,
                // nothing in a hovering wake damps what rounding leaves
                far_field: FarField::Double,
                ..flight
            },
            Self::Fast => WakeChoices { azimuths: 24, turns: 2, velocity_stride: 2, ..flight },
        }
    }
}

/// Turns that repeat the last free one in forward flight, and in hover.
const USUAL_FAR_TURNS: usize = 2;
const HOVER_FAR_TURNS: usize = 6;

impl BodyValues {
    /// The body; none without length.
    pub fn body(&self) -> Option<Body> {
        (self.length_r > 0.0).then(|| Body {
            half_length: 0.5 * self.length_r,
            radius: 0.5 * self.diameter_r,
            middle: [self.aft_of_hub_r, 0.0, -self.below_hub_r],
            nose_up_rad: self.nose_up_deg.to_radians(),
        })
    }
}

impl FreeWakeValues {
    /// The choices of the preset, but for those that are given.
    pub fn choices(&self) -> WakeChoices {
        let preset = self.preset.choices();
        WakeChoices {
            azimuths: self.azimuths.unwrap_or(preset.azimuths),
            turns: self.turns.unwrap_or(preset.turns),
            near_wake_deg: self.near_wake_deg.unwrap_or(preset.near_wake_deg),
            near_wake: self.near_wake.unwrap_or(preset.near_wake),
            rolled_up: self.rolled_up.unwrap_or(preset.rolled_up),
            core: self.core.unwrap_or(preset.core),
            symmetry: self.symmetry.unwrap_or(preset.symmetry),
            far_field: self.far_field.unwrap_or(preset.far_field),
            velocity_stride: self.velocity_stride.unwrap_or(preset.velocity_stride),
        }
    }

    /// Azimuth steps per revolution for a number of blades: those asked for, or those of the preset, or a few more where
    /// these are no multiple of the blades (40 for five and eight blades, 42 for seven).
    pub fn azimuths_for(&self, blades: usize) -> usize {
        let usual = || self.preset.choices().azimuths.next_multiple_of(blades.max(1));
        self.azimuths.unwrap_or_else(usual)
    }

    /// Turns that repeat the last free one: those asked for, or 2, or 6 in hover, where the wake stays below the disk.
    pub fn far_turns_at(&self, advance_ratio: f64) -> usize {
        let usual = if advance_ratio == 0.0 { HOVER_FAR_TURNS } else { USUAL_FAR_TURNS };
        self.far_turns.unwrap_or(usual)
    }
}
