//! Hub loads of a rotor each of whose blades moves its flaps in its own way.

use crate::FlightError;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::Case;
use rotor_response::{ResponseError, SixLoads, hub_loads};
use rotor_study::{HUB_OUTPUTS, TrimmedRotor, UnlikeSolver, scaled, weighted};

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
            .map(|motion| root_slope(rotor, &|angles| rotor.blade_root_loads(angles), motion))
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

/// Loads of every order per deg of each motion of each flap: mean, then cosine and sine of each harmonic; no motions of a flap
/// that moves as those of the other blades do.
type Columns = Vec<Vec<Vec<f64>>>;

/// A blade that moves its flaps otherwise than the others, or is unlike them, about the trim: loads of every order, linear in
/// its motions. Controls, attitude and inflow stay those of the trim.
#[derive(Debug, Clone)]
pub(crate) struct OwnBlade {
    /// Its loads with flaps at rest less those of a blade like the others.
    rest: Vec<f64>,
    /// What a blade like the others does in its place.
    like: Columns,
    /// What it does itself; none for the same.
    own: Option<Columns>,
}

/// A blade and the flaps of it, from 0, that move otherwise than those of the others; of a blade unlike them all.
pub(crate) struct AskedBlade {
    pub(crate) blade: usize,
    pub(crate) flaps: Vec<usize>,
    /// Place in the list of the case of a blade unlike the rest.
    pub(crate) unlike: Option<usize>,
}

impl OwnBlade {
    /// All that are asked for.
    ///
    /// # Errors
    /// Those of the response.
    pub(crate) fn all(
        rotor: &TrimmedRotor,
        unlike: &[UnlikeSolver],
        asked: &[AskedBlade],
    ) -> Result<Vec<Self>, ResponseError> {
        let blades = rotor.rotor().model().blades;
        let flaps: Vec<usize> = asked.iter().flat_map(|one| one.flaps.iter().copied()).collect();
        let of_like = |angles| rotor.blade_root_loads(angles);
        let like = root_columns(rotor, &flaps, &of_like)?;
        let still = || vec![HarmonicSeries::zero(0); rotor.rotor().model().flaps.len()];
        let each = asked.iter().map(|AskedBlade { blade, flaps, unlike: own }| {
            let hub = |one: &SixLoads| placed(one, *blade, blades);
            let hub_of = |columns: &[Vec<SixLoads>]| -> Columns {
                let of = |(flap, own): (usize, &Vec<SixLoads>)| {
                    let own = own.iter().filter(|_| flaps.contains(&flap));
                    own.map(hub).collect()
                };
                columns.iter().enumerate().map(of).collect()
            };
            let Some(own) = own.map(|place| &unlike[place]) else {
                let rest = vec![0.0; highest(blades) * HUB_OUTPUTS];
                return Ok(Self { rest, like: hub_of(&like), own: None });
            };
            let of_own = |angles| rotor.unlike_root_loads(own, angles);
            let rest = hub(&of_own(still())?).into_iter().zip(hub(&of_like(still())?));
            let columns = root_columns(rotor, flaps, &of_own)?;
            Ok(Self {
                rest: rest.map(|(own, like)| own - like).collect(),
                like: hub_of(&like),
                own: Some(hub_of(&columns)),
            })
        });
        each.collect()
    }

    /// Adds a part of the loads that this blade makes with its own motions, deg, less those that a blade like the others would
    /// make with theirs, to those of every order. Flaps that a list leaves out are at rest.
    pub(crate) fn add(
        &self,
        own_deg: &[HarmonicSeries],
        like_deg: &[HarmonicSeries],
        part: f64,
        loads: &mut [f64],
    ) {
        add_scaled(&self.rest, part, loads);
        for (flap, like) in self.like.iter().enumerate() {
            let (own_deg, like_deg) = (own_deg.get(flap), like_deg.get(flap));
            let own = self.own.as_ref().map_or(like, |columns| &columns[flap]);
            for (place, (own, like)) in own.iter().zip(like).enumerate() {
                let of =
                    |motion: Option<&HarmonicSeries>| motion.map_or(0.0, |m| coefficient(m, place));
                if self.own.is_none() {
                    add_scaled(like, part * (of(own_deg) - of(like_deg)), loads);
                } else {
                    add_scaled(own, part * of(own_deg), loads);
                    add_scaled(like, -part * of(like_deg), loads);
                }
            }
        }
    }
}

fn add_scaled(column: &[f64], factor: f64, loads: &mut [f64]) {
    for (load, slope) in loads.iter_mut().zip(column) {
        *load += factor * slope;
    }
}

/// Mean, or cosine or sine of a harmonic of a motion, in the order of columns.
fn coefficient(motion: &HarmonicSeries, place: usize) -> f64 {
    let pair = motion.harmonic(place.div_ceil(2));
    match place {
        0 => motion.mean,
        _ if place % 2 == 1 => pair.cosine,
        _ => pair.sine,
    }
}

/// Root loads of one blade for given motions of its flaps, rad.
type RootLoads<'a> = dyn Fn(Vec<HarmonicSeries>) -> Result<SixLoads, ResponseError> + Sync + 'a;

/// Root loads of one blade per deg of every motion of some flaps; none of the others.
fn root_columns(
    rotor: &TrimmedRotor,
    flaps: &[usize],
    loads: &RootLoads<'_>,
) -> Result<Vec<Vec<SixLoads>>, ResponseError> {
    let of_flap = |flap: usize| {
        let harmonics = (1..=HIGHEST_MOVED).flat_map(|n| [(flap, n, 0), (flap, n, 1)]);
        let motions = std::iter::once((flap, 0, 0)).chain(harmonics);
        let motions: Vec<_> = motions.filter(|_| flaps.contains(&flap)).collect();
        motions.into_par_iter().map(|motion| root_slope(rotor, loads, motion)).collect()
    };
    (0..rotor.rotor().model().flaps.len()).map(of_flap).collect()
}

/// Refuses a case whose loads end below the orders that one blade unlike the others makes.
///
/// # Errors
/// [`FlightError::OutOfRange`].
pub(crate) fn check_orders(case: &Case) -> Result<(), FlightError> {
    let value = case.response.load_harmonics;
    if value < highest(case.rotor.blades) {
        return Err(FlightError::OutOfRange {
            what: "`response.load_harmonics` (per rev)",
            value: value as f64,
            expected: "twice the number of blades less one or more, for the loads of blades that are not alike",
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
    loads: &RootLoads<'_>,
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
        loads(still)
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
