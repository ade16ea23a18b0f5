//! Rotors of the references that the free wake is compared with.

use crate::{AttachedPolar, BladeElementRotor, RigidMotion, SectionPolar};
use nalgebra::{DVector, MatrixXx2};
use rotor_wake::{
    CoreSettings, FarTrailers, FlightState, FreeWakeSettings, ShedVorticity, WakeError, WakeRotor,
};
use std::f64::consts::{PI, TAU};

const HOVER_POLAR: AttachedPolar = AttachedPolar { zero_lift_drag: 0.008, drag_growth: 0.1 };

/// Pitch (deg) and measured thrust coefficient of Caradonna and Tung's rotor at a tip Mach number of 0.439.
///
/// Source: F. X. Caradonna, C. Tung, NASA TM 81232 (1981), as quoted since (0.00474 at 8 deg in one transcription).
pub const CARADONNA_TUNG_THRUST: [(f64, f64); 3] =
    [(5.0, 0.002_13), (8.0, 0.004_59), (12.0, 0.007_96)];

/// The hovering model rotor of Caradonna and Tung: two untwisted blades of NACA 0012, six chords long, tip Mach
/// number 0.439, at a pitch in rad.
///
/// # Errors
/// As [`WakeRotor::cosine`].
pub fn caradonna_tung(pitch_rad: f64) -> Result<BladeElementRotor<'static>, WakeError> {
    Ok(BladeElementRotor {
        rotor: WakeRotor::cosine(2, 0.19, 20)?,
        chord: 0.1905 / 1.143,
        twist_rad: 0.0,
        tip_mach: 0.439,
        motion: RigidMotion { pitch_rad: [pitch_rad, 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &HOVER_POLAR,
    })
}

/// Four slender hovering blades with -8 deg of twist, of the kind that Landgrebe's fit of tip vortices is for:
/// chord 0.055 R, tip Mach number 0.6, pitch 8.5 deg.
///
/// # Errors
/// As [`WakeRotor::cosine`].
pub fn slender() -> Result<BladeElementRotor<'static>, WakeError> {
    Ok(BladeElementRotor {
        rotor: WakeRotor::cosine(4, 0.19, 20)?,
        chord: 0.055,
        twist_rad: (-8.0_f64).to_radians(),
        tip_mach: 0.6,
        motion: RigidMotion { pitch_rad: [8.5_f64.to_radians(), 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &HOVER_POLAR,
    })
}

/// Tip vortex of a hovering rotor: contraction and descent by age.
///
/// ```text
/// r = 0.78 + 0.22 exp(-(0.145 + 27 C_T) zeta)
/// z = k1 zeta up to the first passage under a blade, then k2:
/// k1 = -0.25 (C_T / sigma + 0.001 theta_tw),    k2 = -(1.41 + 0.0141 theta_tw) sqrt(C_T / 2)      theta_tw in deg
/// ```
/// Source: A. J. Landgrebe, J. Am. Helicopter Soc. 17 (1972).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landgrebe {
    /// Thrust coefficient.
    pub thrust_coefficient: f64,
    /// Solidity.
    pub solidity: f64,
    /// Linear twist, rad, negative with the nose down outboard.
    pub twist_rad: f64,
}

impl Landgrebe {
    /// Of a rotor at a thrust coefficient.
    pub fn of(rotor: &BladeElementRotor<'_>, thrust_coefficient: f64) -> Self {
        let solidity = rotor.rotor.blades() as f64 * rotor.chord / PI;
        Self { thrust_coefficient, solidity, twist_rad: rotor.twist_rad }
    }

    /// Radius at an age (rad), unit `R`.
    pub fn radius(&self, age_rad: f64) -> f64 {
        0.78 + 0.22 * (-(0.145 + 27.0 * self.thrust_coefficient) * age_rad).exp()
    }

    /// Heights (unit `R`) at ages in steps (rad) from the release on, by least squares in this form: `[k1, k2]`, per rad. None
    /// if all are on one side of the first passage.
    pub fn fitted(heights: &[f64], step_rad: f64, passage_rad: f64) -> Option<[f64; 2]> {
        let ages = |k: usize| {
            let age = k as f64 * step_rad;
            [age.min(passage_rad), (age - passage_rad).max(0.0)]
        };
        let columns = MatrixXx2::from_fn(heights.len(), |k, column| ages(k)[column]);
        let normal = columns.tr_mul(&columns).try_inverse()?;
        let slopes = normal * columns.tr_mul(&DVector::from_column_slice(heights));
        Some([slopes[0], slopes[1]])
    }

    /// Height per rad of age before the first passage, unit `R`; negative.
    pub fn k1(&self) -> f64 {
        let twist_deg = self.twist_rad.to_degrees();
        -0.25 * (self.thrust_coefficient / self.solidity + 0.001 * twist_deg)
    }

    /// Height per rad of age behind it, unit `R`; negative.
    pub fn k2(&self) -> f64 {
        -(1.41 + 0.0141 * self.twist_rad.to_degrees()) * (0.5 * self.thrust_coefficient).sqrt()
    }
}

/// Steady polar of the OLAF reference: attached below 14 deg, flat plate above, a logistic blend between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OlafPolar;

impl SectionPolar for OlafPolar {
    fn lift_drag(&self, alpha_rad: f64, _mach: f64) -> [f64; 2] {
        let a = (alpha_rad + PI).rem_euclid(TAU) - PI;
        let f = 1.0 / (1.0 + ((a.to_degrees().abs() - 14.0) / 1.5).exp());
        let attached = [TAU * a.sin(), 0.008 + 0.1 * a * a];
        let separated = [1.1 * (2.0 * a).sin(), 0.02 + 1.8 * a.sin().powi(2)];
        [0, 1].map(|k| f * attached[k] + (1.0 - f) * separated[k])
    }
}

const OLAF_RADIUS_M: f64 = 4.94;
const OLAF_TIP_SPEED_M_S: f64 = 383.0 * TAU / 60.0 * OLAF_RADIUS_M;

/// The rotor of `fixtures/reference/wake`, computed by OpenFAST's wake OLAF: four rigid blades without flapping, pitch
/// 8 + 2 cos psi - 4.5 sin psi deg, panels of equal width.
///
/// # Errors
/// As [`WakeRotor::uniform`].
pub fn olaf(panels: usize) -> Result<BladeElementRotor<'static>, WakeError> {
    Ok(BladeElementRotor {
        rotor: WakeRotor::uniform(4, 0.2, panels)?,
        chord: 0.2717 / OLAF_RADIUS_M,
        twist_rad: (-8.0_f64).to_radians(),
        tip_mach: 0.0,
        motion: RigidMotion {
            pitch_rad: [8.0, 2.0, -4.5].map(f64::to_radians),
            flap_rad: [0.0; 3],
        },
        polar: &OlafPolar,
    })
}

/// Its flight: 59.44 m/s, the shaft 5 deg forward.
pub fn olaf_flight() -> FlightState {
    let tilt = 5.0_f64.to_radians();
    FlightState { advance_ratio: 59.44 * tilt.cos() / OLAF_TIP_SPEED_M_S, shaft_tilt_rad: tilt }
}

/// Its wake: cores of 0.3764 m, shed vorticity in the wake, a near wake of this age.
pub fn olaf_settings(near_wake_rad: f64) -> FreeWakeSettings {
    let core = 0.3764 / OLAF_RADIUS_M;
    FreeWakeSettings {
        turns: 3,
        far_turns: 1,
        near_wake_rad,
        core: CoreSettings {
            radius: core,
            near_radius: core,
            panel_share: f64::INFINITY,
            viscosity: 0.0,
            ..CoreSettings::default()
        },
        shed: ShedVorticity::InWake,
        far: FarTrailers::TipAndRoot,
        ..FreeWakeSettings::default()
    }
}

/// Its thrust per unit of thrust coefficient, N.
pub fn olaf_thrust_newton() -> f64 {
    1.225 * PI * OLAF_RADIUS_M.powi(2) * OLAF_TIP_SPEED_M_S.powi(2)
}
