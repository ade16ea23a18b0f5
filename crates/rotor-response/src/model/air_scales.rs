//! What turns section coefficients into loads, station by station.

use crate::{Camber, RotorModel};

/// What turns coefficients into loads at a station: `rho c R/m0` times the cosine of the sweep, chord `c/R`, profile drag
/// coefficient, aerodynamic centre ahead of the elastic axis over R, tangent of the sweep, aft positive, incidence of zero lift
/// (rad) and moment coefficient there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AirScales {
    pub(crate) density_chord: f64,
    pub(crate) chord: f64,
    pub(crate) drag: f64,
    pub(crate) centre: f64,
    pub(crate) sweep: f64,
    pub(crate) zero_lift: f64,
    pub(crate) camber_moment: f64,
}

impl AirScales {
    /// Those of a station, radius R.
    pub(crate) fn at(model: &RotorModel, station: f64) -> Self {
        let chord = model.chord_at(station);
        let sweep = model.planform.sweep_tangent(station);
        let tabled = model.nonlinear.airfoils.is_some();
        let Camber { zero_lift_rad, moment } =
            if tabled { Camber::default() } else { model.camber };
        Self {
            density_chord: model.density_chord() * (chord / model.chord) * sweep_cosine(sweep),
            chord,
            drag: model.drag_coefficient,
            centre: model.offsets.aerodynamic_centre - model.planform.set_back_at(station),
            sweep,
            zero_lift: zero_lift_rad,
            camber_moment: moment,
        }
    }
}

/// Cosine of a sweep angle from its tangent.
pub(crate) fn sweep_cosine(tangent: f64) -> f64 {
    tangent.hypot(1.0).recip()
}
