//! How a trim is coupled with a free wake, and how the coupling ended.

use crate::TrimError;
use rotor_wake::{FarField, FreeWakeSettings, WakeMethod};

/// How a trim is coupled with a free wake.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeTrimSettings {
    /// The wake; its azimuth steps are those of the last stage.
    pub wake: FreeWakeSettings,
    /// Spanwise panels of nearly equal width between cut-out and tip, with ends on those of the flaps: no narrower than the distance of the stations of the
    /// response, or circulation and inflow at the tip do not answer each other.
    pub panels: usize,
    /// Azimuth steps of the coarser stages before.
    pub stages: Vec<usize>,
    /// Largest change of the inflow between two updates of the last stage, tip speed.
    pub inflow_tolerance: f64,
    /// RMS displacement of the wake in the last sweep of an update (marched: in its last revolution) of the last stage,
    /// unit `R`.
    pub displacement_tolerance: f64,
    /// Updates of the geometry allowed in each stage; one that stops gaining ends before.
    pub updates: usize,
    /// Relaxation or march in time.
    pub method: WakeMethod,
    /// Sweeps of the wake per update, three times as many where it still moves, or revolutions of the march.
    pub sweeps: usize,
}

impl Default for WakeTrimSettings {
    fn default() -> Self {
        let far_field = FarField::Single;
        Self {
            wake: FreeWakeSettings { far_field, ..FreeWakeSettings::default() }.with_azimuths(36),
            panels: 20,
            stages: vec![12],
            inflow_tolerance: 2e-4,
            displacement_tolerance: 2e-3,
            updates: 30,
            method: WakeMethod::default(),
            sweeps: 3,
        }
    }
}

/// One update of the geometry and the trim after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WakeUpdate {
    /// Azimuth steps of the stage.
    pub azimuths: usize,
    /// RMS displacement of the last sweep, had it gone all the way, unit `R`.
    pub displacement: f64,
    /// Largest change of the inflow against the update before, over the share of the way that the sweeps went, tip
    /// speed.
    pub inflow_change: f64,
    /// Part of each sweep that was gone.
    pub part: f64,
    /// Collective after it, rad.
    pub theta0_rad: f64,
}

/// How the coupling ended.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum WakeOutcome {
    /// Inflow, geometry and trim agree to the tolerances.
    Settled,
    /// The updates allowed were used up or stopped gaining; the state nearest to the tolerances is kept.
    NotSettled {
        /// Updates of the last grid.
        updates: usize,
        /// Largest change of the inflow in the state kept, tip speed.
        inflow_change: f64,
        /// Change asked for, tip speed.
        tolerance: f64,
        /// RMS displacement of the last sweep before that state, unit `R`.
        displacement: f64,
        /// Displacement asked for, unit `R`.
        displacement_tolerance: f64,
        /// Least and largest collective of the second half of these updates and of the state kept, rad.
        theta0_band_rad: [f64; 2],
    },
    /// They agree, on a mean inflow below a fifth of momentum theory's: the wake does not carry the thrust.
    TooLittleInflow {
        /// Mean inflow over momentum theory's.
        of_momentum: f64,
    },
    /// The wake ran away, or the rotor found no trim in it; the state of the least change before is kept.
    Failed {
        /// Updates of the last grid.
        updates: usize,
        /// Largest change of the inflow in the state kept, tip speed; infinite if it is the start of a grid.
        inflow_change: f64,
        /// Why.
        error: TrimError,
    },
}

impl WakeOutcome {
    /// Whether wake and trim diverged or carry no thrust: what is given is no solution.
    pub fn is_diverged(&self) -> bool {
        matches!(self, Self::Failed { .. } | Self::TooLittleInflow { .. })
    }
}
