//! Hinge moments of the flaps over a revolution, and how they change with the flap motion.

use crate::air::SectionLoads;
use crate::blade::ResponseBlade;
use crate::motion::Motion;
use crate::system::{ResponseSystem, Revolution};
use rotor_base::{HarmonicSeries, uniform_azimuths_rad};

/// Step of the differences in the flap angle's inertia, rad and per rad: the moment is nearly linear.
const DIFFERENCE_STEP: f64 = 1e-3;
/// Step of the differences in the air's answer to the flap angle and its rates.
const AIR_STEP: f64 = 1e-4;

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
        let (a, b) = (&self.aerodynamic, &self.inertial);
        let mut total = HarmonicSeries { mean: a.mean + b.mean, ..a.clone() };
        for n in 1..=a.harmonics.len().max(b.harmonics.len()) {
            let (x, y) = (a.harmonic(n), b.harmonic(n));
            let sum = rotor_base::Harmonic { cosine: x.cosine + y.cosine, sine: x.sine + y.sine };
            total.set_harmonic(n, sum);
        }
        total
    }
}

/// Change of the hinge moment of one flap with its own motion, the blade's motion held and the lags of
/// the air settled.
///
/// ```text
/// dH = angle delta + rate delta' + acceleration delta''        ' by azimuth, delta in rad
/// ```
/// `m0 Omega^2 R^3` each. What a Newton step on the flap motion needs; the blade's own answer, wake lags
/// and the other flap are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HingeSlopes {
    /// With the flap angle, rad.
    pub angle: HarmonicSeries,
    /// With its azimuth derivative.
    pub rate: HarmonicSeries,
    /// With its second azimuth derivative.
    pub acceleration: HarmonicSeries,
}

impl HingeSlopes {
    /// The change of the hinge moment for a flap motion (rad), harmonics to `count`.
    pub fn change(&self, motion_rad: &HarmonicSeries, count: usize) -> HarmonicSeries {
        let highest = |s: &HarmonicSeries| s.harmonics.len();
        let samples = highest(motion_rad) + highest(&self.angle) + count + 1;
        let values: Vec<f64> = uniform_azimuths_rad(samples)
            .into_iter()
            .map(|azimuth| {
                let [value, rate, acceleration] = motion_rad.value_and_rates(azimuth);
                self.angle.value(azimuth) * value
                    + self.rate.value(azimuth) * rate
                    + self.acceleration.value(azimuth) * acceleration
            })
            .collect();
        let weights = vec![1.0 / samples as f64; samples];
        HarmonicSeries::project(&uniform_azimuths_rad(samples), &weights, &values, count)
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
        let (flaps, first) = (self.points[point].flap.len(), self.air.first_station());
        let aerodynamic = over_flaps(self.blade, flaps, |i, _| sections[i - first].hinge);
        let inertial = over_flaps(self.blade, flaps, |i, k| {
            let section = self.flap_section(point, motion, (i, k));
            self.blade.flap_inertia[k].body.hinge_moment(&section)
        });
        [aerodynamic, inertial]
    }

    /// Change of every flap's hinge moment with its angle, rate and acceleration at one point,
    /// `[derivative][flap]`.
    pub(crate) fn hinge_slopes(&self, point: usize, revolution: &Revolution) -> [Vec<f64>; 3] {
        let motion = &revolution.motions[point];
        let (flaps, first) = (self.points[point].flap.len(), self.air.first_station());
        let still = self.settled_sections(point, &revolution.flows[point]);
        std::array::from_fn(|which| {
            let moved = self.flows_with_flaps(point, motion, |k| {
                let mut delta = self.points[point].flap[k];
                delta[which] += AIR_STEP;
                delta
            });
            let moved = self.settled_sections(point, &moved);
            over_flaps(self.blade, flaps, |i, k| {
                let body = &self.blade.flap_inertia[k].body;
                let section = self.flap_section(point, motion, (i, k));
                let stepped = |step: f64| {
                    let mut section = section;
                    section.delta[which] += step;
                    body.hinge_moment(&section)
                };
                let difference = stepped(DIFFERENCE_STEP) - stepped(-DIFFERENCE_STEP);
                (moved[i - first].hinge - still[i - first].hinge) / AIR_STEP
                    + difference / (2.0 * DIFFERENCE_STEP)
            })
        })
    }
}
