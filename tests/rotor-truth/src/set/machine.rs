//! The rotor that is measured, in SI units, and how it departs from the one the engineer believes in.

use super::drive::Actuator;
use super::path::Path;
use crate::physics::blade::Blade;
use crate::physics::inflow::InflowKind;
use std::f64::consts::{PI, TAU};

/// Radius, m.
pub const RADIUS_M: f64 = 4.94;
/// Rotor speed that the stiffnesses are over, rpm.
pub const NOMINAL_RPM: f64 = 383.0;
/// Mass per length, kg/m.
pub const MASS_KG_M: f64 = 6.46;
/// Speed of sound, m/s.
pub const SOUND_M_S: f64 = 340.3;

/// Downwash beside that of the rotor, over the tip speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Upwash {
    /// Walls of a tunnel curve the streamlines: `-s C_T/(2 mu) x cos psi`, up behind the rotor.
    Walls(f64),
    /// A fuselage near the hub: `s mu (x/a) cos psi exp(-(x/a)^2)`, up ahead of it.
    Fuselage(f64),
}

/// A blade that differs from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OddBlade {
    /// Its number from 1.
    pub blade: usize,
    /// Mass per length over that of the others; stiffness alike.
    pub mass_ratio: f64,
    /// Further pitch, rad.
    pub pitch_rad: f64,
    /// How late its flaps are, rad of azimuth.
    pub flaps_late_rad: f64,
}

/// A rotor with its drives and instruments.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// The blade, over nominal speed and mass.
    pub blade: Blade,
    /// Mass per length over the nominal one; the blade's other properties are those of SI units.
    pub mass_ratio: f64,
    /// Spread of the inflow.
    pub inflow: InflowKind,
    /// Further downwash.
    pub upwash: Option<Upwash>,
    /// A blade that differs.
    pub odd: Option<OddBlade>,
    /// Drive of the flaps.
    pub actuator: Actuator,
    /// From loads to readings.
    pub path: Path,
    /// True rotor speed over the stated one.
    pub speed: f64,
    /// True density over the stated one.
    pub density: f64,
    /// Force of an imbalance of the shaft at nominal speed, N, and its azimuth, rad.
    pub imbalance: (f64, f64),
}

/// Units of forces, moments and power at a rotor speed.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    /// Rotor speed, rad/s.
    pub omega_rad_s: f64,
    /// `m0 Omega^2 R^2`, N.
    pub force_newton: f64,
}

impl Scales {
    /// `m0 Omega^2 R^3`, N m.
    pub fn moment_newton_metre(&self) -> f64 {
        self.force_newton * RADIUS_M
    }
}

impl Machine {
    /// The rotor the engineer believes in.
    pub fn believed(blade: Blade) -> Self {
        Self {
            blade,
            mass_ratio: 1.0,
            inflow: InflowKind::Drees,
            upwash: None,
            odd: None,
            actuator: Actuator::default(),
            path: Path::default(),
            speed: 1.0,
            density: 1.0,
            imbalance: (0.0, 0.0),
        }
    }

    /// Units at a stated rotor speed.
    pub fn scales(&self, stated_rpm: f64) -> Scales {
        let omega_rad_s = stated_rpm * self.speed * TAU / 60.0;
        let mass = MASS_KG_M * self.mass_ratio;
        Scales { omega_rad_s, force_newton: mass * (omega_rad_s * RADIUS_M).powi(2) }
    }

    /// The blade in rotor units at a stated rotor speed; `heavier` is a mass over that of the machine's blades.
    pub fn blade_at(&self, stated_rpm: f64, heavier: f64) -> Blade {
        let mass = self.mass_ratio * heavier;
        let slower = NOMINAL_RPM / (stated_rpm * self.speed);
        let stiffer = slower * slower / mass;
        let mut own = self.blade.clone();
        own.ei_flap *= stiffer;
        own.ei_lag *= stiffer;
        own.gj *= stiffer;
        own.pitch_spring = own.pitch_spring.map(|spring| spring * stiffer);
        // a force by the square of a velocity: over the mass alone
        own.lag_damper = own.lag_damper.map(|(x, constant)| (x, constant / mass));
        own.lock_number *= self.density / mass;
        if own.tip_mach.is_some() {
            own.tip_mach = Some(stated_rpm * self.speed * TAU / 60.0 * RADIUS_M / SOUND_M_S);
        }
        own
    }

    /// Nominal density, kg/m^3.
    pub fn nominal_density(blade: &Blade) -> f64 {
        blade.lock_number * MASS_KG_M / (3.0 * TAU * blade.chord * RADIUS_M * RADIUS_M)
    }

    /// Solidity, for reports.
    pub fn solidity(&self) -> f64 {
        self.blade.blades as f64 * self.blade.chord / PI
    }
}
