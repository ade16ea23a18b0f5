//! The rotors of the references.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(dead_code, reason = "each test file uses a part of it")]

use rotor_wake::{
    AttachedPolar, BladeElementRotor, ControlPoint, CoreModel, CoreSettings, FarTrailers,
    FlightState, FreeWakeSettings, RigidMotion, SectionPolar, ShedVorticity, WakeRotor,
    WakeSymmetry,
};
use std::f64::consts::{PI, TAU};

/// Polar of `fixtures/reference/wake`.
pub(crate) struct ReferencePolar;

impl SectionPolar for ReferencePolar {
    fn lift_drag(&self, alpha_rad: f64, _mach: f64) -> [f64; 2] {
        let a = (alpha_rad + PI).rem_euclid(TAU) - PI;
        let f = 1.0 / (1.0 + ((a.to_degrees().abs() - 14.0) / 1.5).exp());
        let attached = [TAU * a.sin(), 0.008 + 0.1 * a * a];
        let separated = [1.1 * (2.0 * a).sin(), 0.02 + 1.8 * a.sin().powi(2)];
        [0, 1].map(|k| f * attached[k] + (1.0 - f) * separated[k])
    }
}

/// Newton per unit of thrust coefficient of the rotor of `fixtures/reference/wake`.
pub(crate) fn reference_thrust_newton() -> f64 {
    let (radius, omega) = (4.94_f64, 383.0 * TAU / 60.0);
    1.225 * PI * radius.powi(2) * (omega * radius).powi(2)
}

pub(crate) fn reference_flight() -> FlightState {
    let tilt = 5.0_f64.to_radians();
    let tip_speed = 383.0 * TAU / 60.0 * 4.94;
    FlightState { advance_ratio: 59.44 * tilt.cos() / tip_speed, shaft_tilt_rad: tilt }
}

pub(crate) fn reference_rotor(panels: usize) -> BladeElementRotor<'static> {
    BladeElementRotor {
        rotor: WakeRotor::uniform(4, 0.2, panels).unwrap(),
        chord: 0.2717 / 4.94,
        twist_rad: (-8.0_f64).to_radians(),
        tip_mach: 0.0,
        motion: RigidMotion {
            pitch_rad: [8.0, 2.0, -4.5].map(f64::to_radians),
            flap_rad: [0.0; 3],
        },
        polar: &ReferencePolar,
    }
}

/// The wake of the reference: cores of 0.3764 m, shed vorticity in the wake.
pub(crate) fn reference_settings(near_wake_deg: f64) -> FreeWakeSettings {
    let core = 0.3764 / 4.94;
    FreeWakeSettings {
        turns: 3,
        far_turns: 1,
        near_wake_rad: near_wake_deg.to_radians(),
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

const POLAR: AttachedPolar = AttachedPolar { zero_lift_drag: 0.008, drag_growth: 0.1 };

/// The model rotor of F. X. Caradonna and C. Tung, NASA TM 81232 (1981): two untwisted blades of NACA 0012, tip
/// Mach number 0.439.
pub(crate) fn caradonna_tung(pitch_deg: f64) -> BladeElementRotor<'static> {
    BladeElementRotor {
        rotor: WakeRotor::cosine(2, 0.19, 20).unwrap(),
        chord: 0.1905 / 1.143,
        twist_rad: 0.0,
        tip_mach: 0.439,
        motion: RigidMotion { pitch_rad: [pitch_deg.to_radians(), 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &POLAR,
    }
}

/// Four slender blades with twist.
pub(crate) fn landgrebe_rotor() -> BladeElementRotor<'static> {
    BladeElementRotor {
        rotor: WakeRotor::cosine(4, 0.19, 20).unwrap(),
        chord: 0.055,
        twist_rad: (-8.0_f64).to_radians(),
        tip_mach: 0.6,
        motion: RigidMotion { pitch_rad: [8.5_f64.to_radians(), 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &POLAR,
    }
}

/// An isolated rotor in hover: sections feel the wake at Weissinger's points; what is trailed rolls up within a
/// quarter of a revolution, the sheet inboard of the tip vortex into vortices where it was trailed.
pub(crate) fn hover_settings(model: CoreModel) -> FreeWakeSettings {
    FreeWakeSettings {
        turns: 3,
        far_turns: 6,
        near_wake_rad: 0.25 * TAU,
        far: FarTrailers::Stations(vec![0.35, 0.5, 0.65, 0.78]),
        control_point: ControlPoint::ThreeQuarterChord,
        symmetry: WakeSymmetry::Axial,
        core: CoreSettings {
            model,
            radius: 0.03,
            panel_share: 0.3,
            viscosity: 8.7e-8,
            ..CoreSettings::default()
        },
        ..FreeWakeSettings::default()
    }
}

/// Mean, and amplitude and phase (deg) of harmonic `n`, of uniform samples over a revolution.
pub(crate) fn harmonic(samples: &[f64], n: usize) -> [f64; 3] {
    let count = samples.len() as f64;
    let (mut c, mut s) = (0.0, 0.0);
    for (i, value) in samples.iter().enumerate() {
        let angle = TAU * (n * i) as f64 / count;
        c += 2.0 * value * angle.cos() / count;
        s += 2.0 * value * angle.sin() / count;
    }
    [samples.iter().sum::<f64>() / count, c.hypot(s), s.atan2(c).to_degrees()]
}
