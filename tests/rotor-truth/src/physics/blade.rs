//! What a blade is, in rotor units, and which terms its equations keep.

use serde::{Deserialize, Serialize};

/// Terms of the equations of the blade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Couplings {
    /// Flap, lag and torsion bend apart, without Coriolis and foreshortening.
    Linear,
    /// Moderate deflections, to second order.
    Full,
    /// The same with the terms of third order of an inextensional beam: foreshortening in tension and in the air.
    Third,
}

/// Airloads of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Airloads {
    /// Quasi-steady, without apparent mass.
    QuasiSteady,
    /// Quasi-steady circulation with apparent mass.
    ApparentMass,
    /// The circulation lags by two exponentials, with apparent mass.
    Unsteady(Lags),
}

/// Constants of the two lags of circulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Lags {
    /// R. T. Jones: A .165 .335, b .0455 .3.
    Jones,
    /// Beddoes: A .3 .7, b .14 .53.
    Beddoes,
}

impl Lags {
    /// Shares and rates.
    pub fn constants(self) -> [(f64, f64); 2] {
        match self {
            Self::Jones => [(0.165, 0.0455), (0.335, 0.3)],
            Self::Beddoes => [(0.3, 0.14), (0.7, 0.53)],
        }
    }
}

/// A trailing-edge flap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flap {
    /// Inboard edge, R.
    pub start: f64,
    /// Outboard edge, R.
    pub end: f64,
    /// Flap chord over blade chord.
    pub chord_fraction: f64,
    /// Mass per length over `m0`.
    pub mass_fraction: f64,
    /// Centre of gravity behind the hinge over the flap chord.
    pub cg_fraction: f64,
    /// Factor on its lift.
    pub lift: f64,
    /// Factor on its moment.
    pub moment: f64,
}

/// Trailing-edge separation of the sections: a share of attached flow that follows its static value with a lag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stall {
    /// Incidence at which half the upper side is separated, rad.
    pub angle_rad: f64,
    /// Width of that transition, rad.
    pub width_rad: f64,
    /// Rate of the lag, per semichord.
    pub rate: f64,
    /// Moment coefficient of full separation.
    pub moment: f64,
    /// Drag coefficient of full separation.
    pub drag: f64,
}

/// A blade in rotor units.
#[derive(Debug, Clone, PartialEq)]
pub struct Blade {
    /// Number of blades of the rotor.
    pub blades: usize,
    /// Chord.
    pub chord: f64,
    /// Lock number with a lift slope of `2 pi`.
    pub lock_number: f64,
    /// Flap bending stiffness over `m0 Omega^2 R^4`.
    pub ei_flap: f64,
    /// Lag bending stiffness.
    pub ei_lag: f64,
    /// Torsion stiffness.
    pub gj: f64,
    /// Radii of gyration of the mass about and normal to the chord line, and of the area.
    pub gyration: [f64; 3],
    /// Twist from root to tip, zero at .75.
    pub twist_rad: f64,
    /// Precone, up.
    pub precone_rad: f64,
    /// Root cut-out of the airloads.
    pub cutout: f64,
    /// Damping of every mode over critical.
    pub damping: f64,
    /// Profile drag coefficient.
    pub drag: f64,
    /// Circulatory lift over that of thin-aerofoil theory.
    pub lift_ratio: f64,
    /// Mass centre ahead of the elastic axis.
    pub mass_centre: f64,
    /// Quarter chord ahead of the elastic axis.
    pub aerodynamic_centre: f64,
    /// Spring of the root in pitch over `m0 Omega^2 R^3`; none if it is held.
    pub pitch_spring: Option<f64>,
    /// Lag damper at a station: station and moment-free force over `m0 Omega^2 R^2` by the square of the rate.
    pub lag_damper: Option<(f64, f64)>,
    /// Flaps from root to tip.
    pub flaps: Vec<Flap>,
    /// Terms of the equations.
    pub couplings: Couplings,
    /// Airloads of the sections.
    pub airloads: Airloads,
    /// Mach number of the tip in hover for the Prandtl-Glauert factor; none if incompressible.
    pub tip_mach: Option<f64>,
    /// Whether the flow along the twisted blade makes downwash: a rate of pitch `mu cos psi theta'`.
    pub has_twisted_flow: bool,
    /// Separation.
    pub stall: Option<Stall>,
    /// Modes of flap, lag and torsion.
    pub modes: [usize; 3],
}

impl Default for Blade {
    /// The blade of Table 1 of the paper.
    fn default() -> Self {
        let flap = |start, end| Flap {
            start,
            end,
            chord_fraction: 0.2,
            mass_fraction: 0.1,
            cg_fraction: 0.2,
            lift: 1.0,
            moment: 1.0,
        };
        Self {
            blades: 4,
            chord: 0.055,
            lock_number: 5.2,
            ei_flap: 0.0108,
            ei_lag: 0.0268,
            gj: 0.00615,
            gyration: [0.0132, 0.0247, 0.029],
            twist_rad: -8.0_f64.to_radians(),
            precone_rad: 0.0,
            cutout: 0.2,
            damping: 0.005,
            drag: 0.01,
            lift_ratio: 1.0,
            mass_centre: 0.0,
            aerodynamic_centre: 0.0,
            pitch_spring: None,
            lag_damper: None,
            flaps: vec![flap(0.70, 0.75), flap(0.80, 0.85)],
            couplings: Couplings::Full,
            airloads: Airloads::Unsteady(Lags::Jones),
            tip_mach: None,
            has_twisted_flow: false,
            stall: None,
            modes: [4, 4, 2],
        }
    }
}

impl Blade {
    /// `rho c R / m0`.
    pub fn air_mass(&self) -> f64 {
        self.lock_number / (3.0 * std::f64::consts::TAU)
    }

    /// Solidity.
    pub fn solidity(&self) -> f64 {
        self.blades as f64 * self.chord / std::f64::consts::PI
    }

    /// Thrust over `m0 Omega^2 R^2` of a thrust coefficient.
    pub fn thrust_of(&self, thrust_coefficient: f64) -> f64 {
        thrust_coefficient / self.solidity() * self.blades as f64 * self.air_mass()
    }
}
