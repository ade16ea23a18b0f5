//! The choices of a free wake.

use crate::error::ensure;
use crate::{Body, CoreModel, WakeError};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_6;

/// How the trailers of the near wake travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum NearWakeMotion {
    /// Fixed to the plane of the blade, on the arcs its stations have swept: for near wakes of up to
    /// about 30 deg.
    BladePlane,
    /// With the free stream and the mean induced velocity of momentum theory.
    Convected,
    /// As `Convected`, distorted by what the free motion has done to the tip vortex of the same age, in
    /// proportion to the station: the whole of it at the tip, nothing at the centre.
    #[default]
    FollowsTip,
    /// Free, as the tip vortex is.
    Free,
}

/// Who accounts for the vorticity shed when the circulation of a section changes in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum ShedVorticity {
    /// The section model (indicial functions): the wake holds trailers alone.
    #[default]
    InSections,
    /// The near wake, as spanwise segments between the trailers: for quasi-steady sections.
    InWake,
}

/// Where on the chord the sections feel the induced velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ControlPoint {
    /// On the lifting line, at the quarter chord: Prandtl's line, for slender blades.
    #[default]
    LiftingLine,
    /// Half a chord behind it, less what a straight infinite line of the circulation there would induce,
    /// which is in the section's own lift-curve slope: Weissinger's L-method. The lift of a blade six chords
    /// long is some 5 % less than with the line's own point. Needs blades with a trailing edge
    /// (`BladeLines::with_trailing_edge`); without one it is the
    /// lifting line.
    ///
    /// Source: J. Weissinger, NACA TM 1120 (1947).
    ThreeQuarterChord,
}

/// Which filaments go on after the near wake.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum FarTrailers {
    /// One rolled-up tip vortex with the strength of the outboard peak of circulation.
    #[default]
    Tip,
    /// Tip vortex and a root vortex of the opposite strength.
    TipAndRoot,
    /// Tip vortex, root vortex and further vortices released at these stations (unit `R`, ends of
    /// trailing-edge flaps for example), each with what is trailed nearest to it inboard of the peak.
    Stations(Vec<f64>),
}

/// Where on the trailing edge a rolled-up vortex is released.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ReleasePoint {
    /// At its station: the tip vortex at the tip.
    #[default]
    Station,
    /// At the centroid of the vorticity it collects, which rolling up conserves. A tip vortex leaves some
    /// 4 % of the radius inboard of the tip.
    ///
    /// Source: A. Betz, Z. angew. Math. Mech. 12 (1932) 164, NACA TM 713.
    Centroid,
}

/// What the wakes at different azimuths have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum WakeSymmetry {
    /// Each azimuth has its own, the same every revolution.
    #[default]
    Periodic,
    /// The wake turns with the blades as it is: a rotor in axial flight without cyclic pitch. The pairing of
    /// neighbouring turns, which grows from differences between azimuths, is left out.
    Axial,
}

/// How the geometry is carried on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum WakeMethod {
    /// Sweeps of pseudo-implicit relaxation of a wake that is the same every revolution: a count is of sweeps.
    #[default]
    Relaxed,
    /// Marched in time by PC2B ([`WakeMarch`](super::WakeMarch)), every blade on its own from the periodic wake: a count is of
    /// revolutions.
    Marched,
}

/// Precision of the velocities that old rolled-up vortices induce on the wake itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum FarField {
    /// Double.
    #[default]
    Double,
    /// Single for the vortices older than a revolution: their sums run faster, and the velocities differ by some 1e-6 of the
    /// tip speed at most. What the blades feel stays double.
    Single,
}

/// The viscous core of the filaments.
///
/// ```text
/// r_c^2 = r_c0^2 + 4 alpha nu (1 + a_1 |Gamma| / nu) zeta / Omega,      alpha = 1.25643
/// ```
/// Source: Squire, Aeronaut. Q. 16 (1965); Bhagwat and Leishman, AHS Forum 58 (2002), for `a_1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreSettings {
    /// Velocity profile.
    pub model: CoreModel,
    /// Core radius `r_c0` of the rolled-up vortices at release, unit `R`.
    pub radius: f64,
    /// Core radius, at least, with which rolled-up vortices move each other, unit `R`; 0 for their own cores. What the
    /// blades feel keeps its own core. Vortices with cores much thinner than `0.05 R` pair without end at advance ratios
    /// of 0.1 to 0.25, whatever the grid, and the sweeps do not settle.
    pub mutual_radius: f64,
    /// Core radius of near-wake trailers, shed and bound vortices, unit `R`: about a chord. The lift of a section answers
    /// the downwash averaged over its chord, so that a lifting line that meets a vortex of less overrates it.
    pub near_radius: f64,
    /// Core radius of the trailers younger than [`sheet_rad`](Self::sheet_rad), which no other blade meets, over the width of
    /// the panel beside them, at most: a core wider than the panels would take the downwash away that a blade makes at itself.
    pub panel_share: f64,
    /// Age up to which the trailers are the sheet of their own blade, rad: no more than the blade spacing.
    pub sheet_rad: f64,
    /// Kinematic viscosity `nu / (Omega R^2)`; 0 for no growth.
    pub viscosity: f64,
    /// Squire's coefficient `a_1` of turbulent growth.
    pub squire: f64,
}

impl Default for CoreSettings {
    fn default() -> Self {
        Self {
            model: CoreModel::Vatistas,
            radius: 0.02,
            mutual_radius: 0.05,
            near_radius: 0.05,
            panel_share: 0.3,
            sheet_rad: FRAC_PI_6,
            viscosity: 1.5e-8,
            squire: 2e-4,
        }
    }
}

/// Choices of a free wake: grid, near wake, cores, iteration.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWakeSettings {
    /// Azimuth steps per revolution, a multiple of the number of blades; age steps are the same.
    pub azimuths: usize,
    /// Free turns of the rolled-up vortices.
    pub turns: usize,
    /// Turns that repeat the last free one behind it.
    pub far_turns: usize,
    /// Age up to which the full span of trailers is kept, rad.
    pub near_wake_rad: f64,
    /// How the near wake travels.
    pub near_wake_motion: NearWakeMotion,
    /// Who accounts for shed vorticity.
    pub shed: ShedVorticity,
    /// Filaments behind the near wake.
    pub far: FarTrailers,
    /// Where on the trailing edge these are released.
    pub release: ReleasePoint,
    /// Where the sections feel the induced velocity.
    pub control_point: ControlPoint,
    /// Vortex cores.
    pub core: CoreSettings,
    /// What the wakes at different azimuths have in common.
    pub symmetry: WakeSymmetry,
    /// Precision of the velocities by old vortices.
    pub far_field: FarField,
    /// Induced velocities are computed at every `velocity_stride`-th age and interpolated between
    /// along the path of the air; 1 computes all.
    pub velocity_stride: usize,
    /// Weight of the corrector's velocities against the predictor's, 0 to 1.
    pub relaxation: f64,
    /// A body that the stream flows round; none for an isolated rotor.
    pub body: Option<Body>,
}

impl Default for FreeWakeSettings {
    fn default() -> Self {
        Self {
            azimuths: 24,
            turns: 4,
            far_turns: 2,
            near_wake_rad: std::f64::consts::TAU,
            near_wake_motion: NearWakeMotion::default(),
            shed: ShedVorticity::default(),
            far: FarTrailers::default(),
            release: ReleasePoint::default(),
            control_point: ControlPoint::default(),
            core: CoreSettings::default(),
            symmetry: WakeSymmetry::default(),
            far_field: FarField::default(),
            velocity_stride: 1,
            relaxation: 0.5,
            body: None,
        }
    }
}

impl FreeWakeSettings {
    /// An isolated rotor in hover without cyclic pitch: the wake turns with it, sections feel it at Weissinger's
    /// points, and what is trailed rolls up within a quarter of a revolution, the sheet inboard of the tip vortex into
    /// vortices where it was trailed.
    pub fn hover(model: CoreModel) -> Self {
        Self {
            turns: 3,
            far_turns: 6,
            near_wake_rad: 0.25 * std::f64::consts::TAU,
            far: FarTrailers::Stations(vec![0.35, 0.5, 0.65, 0.78]),
            control_point: ControlPoint::ThreeQuarterChord,
            symmetry: WakeSymmetry::Axial,
            core: CoreSettings {
                model,
                radius: 0.03,
                mutual_radius: 0.0,
                near_radius: 0.02,
                sheet_rad: FRAC_PI_6 / 2.0,
                viscosity: 8.7e-8,
                ..CoreSettings::default()
            },
            ..Self::default()
        }
    }

    /// The same with slender blades, whose sheet rolls up by itself in the quarter of a revolution before the next blade
    /// passes: trailers and vortices move freely, each with the mutual cores of the default, and sections feel the wake on
    /// the lifting line.
    pub fn hover_rolling_up(model: CoreModel) -> Self {
        let hover = Self::hover(model);
        let mutual_radius = CoreSettings::default().mutual_radius;
        Self {
            azimuths: 36,
            near_wake_motion: NearWakeMotion::Free,
            control_point: ControlPoint::LiftingLine,
            core: CoreSettings { mutual_radius, ..hover.core },
            ..hover
        }
    }

    /// Azimuth step, rad.
    pub fn step_rad(&self) -> f64 {
        std::f64::consts::TAU / self.azimuths as f64
    }

    /// Age steps of the near wake: at least one.
    pub fn near_steps(&self) -> usize {
        self.steps_up_to(self.near_wake_rad)
    }

    /// Youngest age steps of the near wake, the sheet of the blade's own. The next blade is farther,
    /// and what is older the own blade feels as from far.
    pub fn sheet_steps(&self) -> usize {
        self.steps_up_to(self.core.sheet_rad)
    }

    /// Age steps of an age, rounded, at least one and no more than there are.
    fn steps_up_to(&self, age_rad: f64) -> usize {
        let (step, most) = (self.step_rad(), self.far_steps());
        let below = |k: &usize| (*k as f64 + 0.5) * step < age_rad;
        (1..most).take_while(below).count() + 1
    }

    /// Age steps of the rolled-up vortices.
    pub fn far_steps(&self) -> usize {
        self.turns * self.azimuths
    }

    /// The same choices on another grid.
    #[must_use]
    pub fn with_azimuths(&self, azimuths: usize) -> Self {
        Self { azimuths, ..self.clone() }
    }

    /// Checks the ranges for a number of blades.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] with the first value out of range.
    pub fn validate(&self, blades: usize) -> Result<(), WakeError> {
        let count = |value: usize| value as f64;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let is_grid =
            (8..=720).contains(&self.azimuths) && self.azimuths.is_multiple_of(blades.max(1));
        let expected = "8 to 720 and a multiple of the number of blades";
        ensure(is_grid, "azimuths", count(self.azimuths), expected)?;
        ensure((1..=20).contains(&self.turns), "turns", count(self.turns), "1 to 20")?;
        ensure(self.far_turns <= 20, "far_turns", count(self.far_turns), "0 to 20")?;
        let near = self.near_wake_rad;
        ensure(positive(near), "near_wake_rad", near, "more than 0")?;
        let core = &self.core;
        for (quantity, radius) in
            [("core radius", core.radius), ("core near_radius", core.near_radius)]
        {
            let fits = positive(radius) && radius <= 0.5;
            ensure(fits, quantity, radius, "more than 0 and at most 0.5 R")?;
        }
        let mutual = core.mutual_radius;
        ensure((0.0..=0.5).contains(&mutual), "core mutual_radius", mutual, "0 to 0.5 R")?;
        let share = core.panel_share;
        ensure(share > 0.0, "core panel_share", share, "more than 0")?;
        for (quantity, value) in [("core viscosity", core.viscosity), ("core squire", core.squire)]
        {
            ensure(value.is_finite() && value >= 0.0, quantity, value, "0 or more")?;
        }
        let (stride, expected) = (self.velocity_stride, "1 to a quarter of the azimuth steps");
        let is_stride = (1..=self.azimuths / 4).contains(&stride);
        ensure(is_stride, "velocity_stride", count(stride), expected)?;
        if let Some(body) = &self.body {
            body.validate()?;
        }
        let is_part = self.relaxation > 0.0 && self.relaxation <= 1.0;
        ensure(is_part, "relaxation", self.relaxation, "more than 0 and at most 1")
    }
}
