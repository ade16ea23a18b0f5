//! Hub loads of a rotor each of whose blades moves its flaps in its own way.

use crate::FlightError;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{ResponseError, SixLoads, hub_loads};
use rotor_study::case::Case;
use rotor_study::{HUB_OUTPUTS, TrimmedRotor, scaled, weighted};

/// Amplitude of the motions that a slope is read from, both ways, deg.
const STEP_DEG: f64 = 0.5;
/// Highest harmonic of a motion of one flap alone that the hub feels, that of the linearised rotor.
const HIGHEST_MOVED: usize = 10;

/// Motions of the flaps of all blades, deg: blade by blade, the first at the azimuth of the rotor, then flap by flap.
pub(crate) type Motions = Vec<Vec<HarmonicSeries>>;

/// A trimmed rotor, blade by blade; controls, attitude and inflow stay those of the trim.
pub(crate) struct BladeByBlade<'a> {
    rotor: &'a TrimmedRotor,
    blades: usize,
    /// Harmonics of the flaps, per rev.
    harmonics: Vec<usize>,
    /// Hub loads by blade, flap, harmonic of the flap, cosine and sine: of every order, per deg.
    slopes: Vec<Vec<Vec<[Vec<f64>; 2]>>>,
}

impl<'a> BladeByBlade<'a> {
    /// # Errors
    /// Those of the response.
    pub(crate) fn new(rotor: &'a TrimmedRotor, harmonics: &[usize]) -> Result<Self, ResponseError> {
        let (blades, flaps) = (rotor.rotor().model().blades, rotor.rotor().model().flaps.len());
        let asked: Vec<_> = (0..flaps)
            .flat_map(|k| harmonics.iter().flat_map(move |&n| [(k, n, 0), (k, n, 1)]))
            .collect();
        let found = asked
            .into_par_iter()
            .map(|motion| root_slope(rotor, motion))
            .collect::<Result<Vec<SixLoads>, ResponseError>>()?;
        let at = |blade: usize| {
            let own = |one: &SixLoads| placed(one, blade, blades);
            let pairs: Vec<[Vec<f64>; 2]> =
                found.chunks_exact(2).map(|pair| [own(&pair[0]), own(&pair[1])]).collect();
            pairs.chunks_exact(harmonics.len()).map(<[_]>::to_vec).collect()
        };
        let slopes = (0..blades).map(at).collect();
        Ok(Self { rotor, blades, harmonics: harmonics.to_vec(), slopes })
    }

    pub(crate) fn blades(&self) -> usize {
        self.blades
    }

    pub(crate) fn flaps(&self) -> usize {
        self.slopes[0].len()
    }

    pub(crate) fn harmonics(&self) -> &[usize] {
        &self.harmonics
    }

    /// The loads of every order that a harmonic of one flap of one blade makes, cosine and sine, per deg.
    pub(crate) fn slope(&self, blade: usize, flap: usize, harmonic: usize) -> &[Vec<f64>; 2] {
        &self.slopes[blade][flap][harmonic]
    }

    /// Hub loads at 1 to twice the blade number less one per rev, twelve each, nondimensional: every blade answers for
    /// itself, nothing is linear.
    ///
    /// # Errors
    /// Those of the response.
    pub(crate) fn loads(&self, motions_deg: &Motions) -> Result<Vec<f64>, ResponseError> {
        let first = |blade: usize| motions_deg.iter().position(|own| *own == motions_deg[blade]);
        let kinds: Vec<usize> = (0..self.blades).filter(|&b| first(b) == Some(b)).collect();
        let of_kind = |&blade: &usize| {
            let angles = motions_deg[blade].iter().map(|own| scaled(own, 1f64.to_radians()));
            self.rotor.blade_root_loads(angles.collect())
        };
        let found = kinds.par_iter().map(of_kind).collect::<Result<Vec<_>, ResponseError>>()?;
        let all: Vec<SixLoads> = (0..self.blades)
            .filter_map(|b| kinds.iter().position(|&kind| Some(kind) == first(b)))
            .map(|kind| found[kind].clone())
            .collect();
        Ok(orders(&hub_loads(&all, highest(self.blades)), self.blades))
    }
}

/// What one flap of one blade does to the hub, about the trim: loads of every order, linear in its motion. Controls, attitude
/// and inflow stay those of the trim.
#[derive(Debug, Clone)]
pub(crate) struct OneBlade {
    /// Mean, then cosine and sine of each harmonic: loads per deg.
    columns: Vec<Vec<f64>>,
}

impl OneBlade {
    /// # Errors
    /// Those of the response.
    pub(crate) fn new(rotor: &TrimmedRotor, flap: usize) -> Result<Self, ResponseError> {
        let blades = rotor.rotor().model().blades;
        let harmonics = (1..=HIGHEST_MOVED).flat_map(|n| [(flap, n, 0), (flap, n, 1)]);
        let motions: Vec<_> = std::iter::once((flap, 0, 0)).chain(harmonics).collect();
        let column = |motion| root_slope(rotor, motion).map(|one| placed(&one, 0, blades));
        let columns = motions.into_par_iter().map(column).collect::<Result<_, ResponseError>>()?;
        Ok(Self { columns })
    }

    /// Adds a part of the loads of a motion, deg, to those of every order.
    pub(crate) fn add(&self, motion_deg: &HarmonicSeries, part: f64, loads: &mut [f64]) {
        let pairs = (1..=HIGHEST_MOVED).map(|n| motion_deg.harmonic(n));
        let parts = pairs.flat_map(|pair| [pair.cosine, pair.sine]);
        let of_mean = std::iter::once(motion_deg.mean);
        for (size, column) in of_mean.chain(parts).zip(&self.columns) {
            for (load, slope) in loads.iter_mut().zip(column) {
                *load += part * size * slope;
            }
        }
    }
}

/// Refuses a case whose loads end below the orders that a failure of one blade makes.
///
/// # Errors
/// [`FlightError::OutOfRange`].
pub(crate) fn check_orders(case: &Case) -> Result<(), FlightError> {
    let value = case.response.load_harmonics;
    if value < highest(case.rotor.blades) {
        return Err(FlightError::OutOfRange {
            what: "`response.load_harmonics` (per rev)",
            value: value as f64,
            expected: "twice the number of blades less one or more, for the loads that failures make",
        });
    }
    Ok(())
}

/// Highest order looked at: twice the blade number less one.
pub(crate) fn highest(blades: usize) -> usize {
    2 * blades - 1
}

/// Where the loads of an order stand.
pub(crate) fn of_order(order: usize) -> std::ops::Range<usize> {
    (order - 1) * HUB_OUTPUTS..order * HUB_OUTPUTS
}

/// Root loads of one blade per deg of a motion of one of its flaps: flap, harmonic (0 is the mean), cosine (0) or sine (1).
fn root_slope(
    rotor: &TrimmedRotor,
    (flap, harmonic, part): (usize, usize, usize),
) -> Result<SixLoads, ResponseError> {
    let mut unit = HarmonicSeries::zero(harmonic);
    if harmonic == 0 {
        unit.mean = 1.0;
    } else {
        let (cosine, sine) = [(1.0, 0.0), (0.0, 1.0)][part];
        unit.set_harmonic(harmonic, Harmonic { cosine, sine });
    }
    let [up, down] = [STEP_DEG, -STEP_DEG].map(|deg| {
        let mut still = vec![HarmonicSeries::zero(0); rotor.rotor().model().flaps.len()];
        still[flap] = scaled(&unit, deg.to_radians());
        rotor.blade_root_loads(still)
    });
    let (up, down) = (up?, down?);
    let factor = 1.0 / (2.0 * STEP_DEG);
    Ok(each(|k| weighted(&up.components[k], &down.components[k], factor)))
}

/// Hub loads of every order for root loads of one blade, the others without.
fn placed(one: &SixLoads, blade: usize, blades: usize) -> Vec<f64> {
    let mut all = vec![each(|_| HarmonicSeries::zero(0)); blades];
    all[blade] = one.clone();
    orders(&hub_loads(&all, highest(blades)), blades)
}

/// Twelve loads of every order.
fn orders(hub: &SixLoads, blades: usize) -> Vec<f64> {
    (1..=highest(blades)).flat_map(|n| hub.harmonic(n)).collect()
}

fn each(of: impl Fn(usize) -> HarmonicSeries) -> SixLoads {
    SixLoads { components: std::array::from_fn(of) }
}
