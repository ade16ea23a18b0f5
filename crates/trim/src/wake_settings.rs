//! How a trim is coupled with a free wake, and how the coupling ended.

use crate::TrimError;
use rotor_wake::{FarField, FreeWakeSettings, WakeMethod, WakeSymmetry};

/// Azimuths at which sections may feel the wake, at most: steps of a degree.
const MOST_SECTION_AZIMUTHS: usize = 360;

/// How a trim is coupled with a free wake.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeTrimSettings {
    /// The wake; its azimuth steps are those of the last stage.
    pub wake: FreeWakeSettings,
    /// Spanwise panels of nearly equal width between cut-out and tip, with ends on those of the flaps: no narrower than the distance of the stations of the
    /// response, or circulation and inflow at the tip do not answer each other.
    pub panels: usize,
    /// Azimuths at which the sections feel the wake in the last stage, a multiple of its azimuth steps: the geometry is
    /// interpolated between these along azimuth and age. None: those of the geometry.
    pub section_azimuths: Option<usize>,
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
            section_azimuths: None,
            stages: vec![12],
            inflow_tolerance: 2e-4,
            displacement_tolerance: 2e-3,
            updates: 30,
            method: WakeMethod::default(),
            sweeps: 3,
        }
    }
}

impl WakeTrimSettings {
    /// Azimuths at which the sections feel the wake of a stage.
    pub(crate) fn sections_of(&self, azimuths: usize) -> usize {
        let last = azimuths == self.wake.azimuths;
        self.section_azimuths.filter(|_| last).unwrap_or(azimuths)
    }

    /// Checks that the sections' azimuths are a multiple of those of the wake, and the wake no axial one.
    pub(crate) fn validate_sections(&self) -> Result<(), TrimError> {
        let Some(count) = self.section_azimuths else { return Ok(()) };
        let (field, value) = ("section_azimuths", count as f64);
        let of_the_wake = self.wake.azimuths;
        let is_multiple = (of_the_wake..=MOST_SECTION_AZIMUTHS).contains(&count)
            && count.is_multiple_of(of_the_wake);
        let is_alike = count == of_the_wake || self.wake.symmetry == WakeSymmetry::Periodic;
        let expected = if is_alike {
            "a multiple of the azimuth steps of the wake, at most 360"
        } else {
            "those of the wake: an axial one turns with its blades"
        };
        if is_multiple && is_alike {
            return Ok(());
        }
        Err(TrimError::Parameter { field, value, expected })
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
