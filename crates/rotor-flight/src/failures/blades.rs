//! Hub loads of a rotor each of whose blades moves its flaps in its own way.

use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{ResponseError, SixLoads, hub_loads};
use rotor_study::{HUB_OUTPUTS, TrimmedRotor, scaled, weighted};

/// Amplitude of the motions that a slope is read from, both ways, deg.
const STEP_DEG: f64 = 0.5;

/// Motions of the flaps of all blades, deg: blade by blade, the first at the azimuth of the rotor, then flap by flap.
pub(super) type Motions = Vec<Vec<HarmonicSeries>>;

/// A trimmed rotor, blade by blade; controls, attitude and inflow stay those of the trim.
pub(super) struct BladeByBlade<'a> {
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
    pub(super) fn new(rotor: &'a TrimmedRotor, harmonics: &[usize]) -> Result<Self, ResponseError> {
        let (blades, flaps) = (rotor.rotor().model().blades, rotor.rotor().model().flaps.len());
        let slope = |(flap, harmonic, part): (usize, usize, usize)| {
            let [up, down] = [STEP_DEG, -STEP_DEG].map(|deg| {
                let mut still = vec![HarmonicSeries::zero(0); flaps];
                let rad = deg.to_radians();
                let own = [(rad, 0.0), (0.0, rad)][part];
                let mut moved = HarmonicSeries::zero(harmonic);
                moved.set_harmonic(harmonic, Harmonic { cosine: own.0, sine: own.1 });
                still[flap] = moved;
                rotor.blade_root_loads(still)
            });
            let (up, down) = (up?, down?);
            let factor = 1.0 / (2.0 * STEP_DEG);
            Ok(each(|k| weighted(&up.components[k], &down.components[k], factor)))
        };
        let asked: Vec<_> = (0..flaps)
            .flat_map(|k| harmonics.iter().flat_map(move |&n| [(k, n, 0), (k, n, 1)]))
            .collect();
        let found =
            asked.into_par_iter().map(slope).collect::<Result<Vec<SixLoads>, ResponseError>>()?;
        let at = |blade: usize| {
            let placed = |one: &SixLoads| {
                let mut all = vec![each(|_| HarmonicSeries::zero(0)); blades];
                all[blade] = one.clone();
                orders(&hub_loads(&all, highest(blades)), blades)
            };
            let pairs: Vec<[Vec<f64>; 2]> =
                found.chunks_exact(2).map(|pair| [placed(&pair[0]), placed(&pair[1])]).collect();
            pairs.chunks_exact(harmonics.len()).map(<[_]>::to_vec).collect()
        };
        let slopes = (0..blades).map(at).collect();
        Ok(Self { rotor, blades, harmonics: harmonics.to_vec(), slopes })
    }

    pub(super) fn blades(&self) -> usize {
        self.blades
    }

    pub(super) fn flaps(&self) -> usize {
        self.slopes[0].len()
    }

    pub(super) fn harmonics(&self) -> &[usize] {
        &self.harmonics
    }

    /// The loads of every order that a harmonic of one flap of one blade makes, cosine and sine, per deg.
    pub(super) fn slope(&self, blade: usize, flap: usize, harmonic: usize) -> &[Vec<f64>; 2] {
        &self.slopes[blade][flap][harmonic]
    }

    /// Hub loads at 1 to twice the blade number less one per rev, twelve each, nondimensional: every blade answers for
    /// itself, nothing is linear.
    ///
    /// # Errors
    /// Those of the response.
    pub(super) fn loads(&self, motions_deg: &Motions) -> Result<Vec<f64>, ResponseError> {
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

/// Highest order looked at: twice the blade number less one.
pub(super) fn highest(blades: usize) -> usize {
    2 * blades - 1
}

/// Twelve loads of every order.
fn orders(hub: &SixLoads, blades: usize) -> Vec<f64> {
    (1..=highest(blades)).flat_map(|n| hub.harmonic(n)).collect()
}

/// Where the loads of an order stand.
pub(super) fn of_order(order: usize) -> std::ops::Range<usize> {
    (order - 1) * HUB_OUTPUTS..order * HUB_OUTPUTS
}

fn each(of: impl Fn(usize) -> HarmonicSeries) -> SixLoads {
    SixLoads { components: std::array::from_fn(of) }
}
