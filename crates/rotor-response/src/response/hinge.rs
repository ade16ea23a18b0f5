//! Hinge moments of the flaps over a revolution.

use crate::loads::wrenches::added;
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionLoads;
use crate::structure::blade::ResponseBlade;
use crate::structure::motion::Motion;
use rotor_base::HarmonicSeries;

/// Moments about the hinge of one flap of one blade, over its span, against the azimuth of the blade;
/// `m0 Omega^2 R^3`, positive in the sense of the flap angle (trailing edge down).
///
/// What the actuator holds is the opposite: its moment on the flap is minus the total.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HingeMoment {
    /// Of the air.
    pub aerodynamic: HarmonicSeries,
    /// Of the flap's inertia: acceleration of blade and flap, centrifugal and Coriolis terms.
    pub inertial: HarmonicSeries,
}

impl HingeMoment {
    /// Both together.
    #[must_use]
    pub fn total(&self) -> HarmonicSeries {
        added(&self.aerodynamic, &self.inertial, 1.0)
    }
}

/// Sums a load per length over the span of each flap; `value` by station.
fn over_flaps(
    blade: &ResponseBlade,
    flaps: usize,
    mut value: impl FnMut(usize, usize) -> f64,
) -> Vec<f64> {
    let mut sums = vec![0.0; flaps];
    for (i, flap) in blade.flap_index.iter().enumerate() {
        if let Some(k) = *flap {
            sums[k] += blade.grid.weight()[i] * value(i, k);
        }
    }
    sums
}

impl ResponseSystem<'_> {
    /// Aerodynamic and inertial hinge moment of every flap at one point.
    pub(crate) fn hinge_moments(
        &self,
        point: usize,
        motion: &Motion,
        sections: &[SectionLoads],
    ) -> [Vec<f64>; 2] {
        let (flaps, first) = (self.points[point].flap.len(), self.air.first_station);
        let aerodynamic = over_flaps(self.blade, flaps, |i, _| sections[i - first].hinge);
        let inertial = over_flaps(self.blade, flaps, |i, k| {
            let section = self.flap_section(point, (motion, i), i, k);
            self.blade.flap_inertia[i].map_or(0.0, |flap| flap.body.hinge_moment(&section))
        });
        [aerodynamic, inertial]
    }
}
