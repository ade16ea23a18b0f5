//! What an evaluation of a revolution leaves, and the arrays it uses again.

use crate::sections::air::{SectionFlow, SectionLoads};
use crate::sections::flight_air::AirScratch;
use crate::structure::equations::{AppliedLoad, ForceRows};
use crate::structure::motion::{Foreshortening, ModalRows, Motion};
use rotor_base::{LANES, Lanes};

/// Air loads over a revolution.
#[derive(Debug, Clone)]
pub(crate) struct Revolution {
    pub(super) first_station: usize,
    pub(super) points: usize,
    /// By station of the whole blade, then by block of points; nothing where the blade does not lift.
    pub(super) sections: Vec<SectionLoads<Lanes>>,
}

impl Revolution {
    /// Aerodynamic loads of all lifting stations at one point.
    pub(crate) fn at(&self, point: usize) -> impl Iterator<Item = SectionLoads> {
        let stations = self.sections.chunks_exact(self.points.div_ceil(LANES));
        stations.skip(self.first_station).map(move |of| of[point / LANES].lane(point % LANES))
    }

    pub(crate) fn points(&self) -> usize {
        self.points
    }
}

/// Reusable arrays of the evaluation of a revolution.
#[derive(Debug, Default)]
pub(crate) struct Work {
    pub(super) rows: ModalRows,
    pub(super) foreshortening: Foreshortening,
    /// Loads of a revolution that is no longer wanted.
    pub(super) sections: Vec<SectionLoads<Lanes>>,
    pub(super) together: Vec<StationWork>,
}

/// Those of some stations.
#[derive(Debug, Default)]
pub(super) struct StationWork {
    pub(super) motion: Motion,
    pub(super) flows: Vec<SectionFlow<Lanes>>,
    pub(super) air: AirScratch,
    pub(super) forces: ForceRows,
    /// Their share of the residual, mode by mode.
    pub(super) residual: Vec<f64>,
    /// What the moderately deflected blade carries at them, by station, then by block of points.
    pub(super) applied: Vec<AppliedLoad>,
}
