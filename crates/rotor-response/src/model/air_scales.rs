//! What turns section coefficients into loads, station by station.

use crate::RotorModel;

/// What turns coefficients into loads at a station: `rho c R/m0`, chord `c/R`, profile drag coefficient,
/// aerodynamic centre ahead of the elastic axis over R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AirScales {
    pub(crate) density_chord: f64,
    pub(crate) chord: f64,
    pub(crate) drag: f64,
    pub(crate) centre: f64,
}

impl AirScales {
    /// Those of a station, radius R.
    pub(crate) fn at(model: &RotorModel, station: f64) -> Self {
        let chord = model.chord_at(station);
        Self {
            density_chord: model.density_chord() * (chord / model.chord),
            chord,
            drag: model.drag_coefficient,
            centre: model.offsets.aerodynamic_centre,
        }
    }
}
