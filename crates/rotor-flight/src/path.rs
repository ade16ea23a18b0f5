//! The rotor along a path of advance ratios, before and after a step of the thrust.

use crate::FlightError;
use crate::blades::{AskedBlade, OwnBlade, check_orders, highest};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_case::Case;
use rotor_study::{FlapAuthority, HUB_OUTPUTS, TrimmedRotor};
use std::collections::BTreeMap;

/// Where on its path a rotor is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlightState {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Part of the step of the thrust that is made, 0 to 1.
    pub thrust_share: f64,
}

/// Trims of a case at rising advance ratios, and at a second thrust if there is a step of it.
///
/// ```text
/// Z(mu, s, delta) = sum over the knots about (mu, s) of  w_k ( Z0_k + G_k delta ),
///                   w linear in mu and in the share s of the step, held beyond the ends
/// ```
/// Truth is this rotor, linear in the motion of the flaps. Blades that are not as the others ([`Self::with_blades`]) add what
/// they do otherwise.
#[derive(Debug, Clone)]
pub struct RotorPath {
    advance_ratios: Vec<f64>,
    /// Before the step of the thrust; after it, if there is one.
    rows: Vec<Vec<TrimmedRotor>>,
    blades: usize,
    /// Blades known one by one, and what they do at every trim.
    own_blades: Vec<KnownBlade>,
    own: Vec<Vec<Vec<OwnBlade>>>,
}

/// A blade that is known by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownBlade {
    /// Which one, from 0: it flies `2 pi blade / N_b` ahead of the azimuth of the rotor.
    pub blade: usize,
    /// Part of the motion of the others' flaps that its own make at the same voltages.
    pub flap_motion: f64,
}

impl RotorPath {
    /// Trims a case at advance ratios, each from the last.
    ///
    /// # Errors
    /// [`FlightError::OutOfRange`] unless there is one and they rise; [`FlightError::Trim`], [`FlightError::Response`],
    /// [`FlightError::WakeDiverged`].
    pub fn new(case: &Case, advance_ratios: &[f64]) -> Result<Self, FlightError> {
        let rises = advance_ratios.windows(2).all(|pair| pair[0] < pair[1]);
        if advance_ratios.is_empty() || !rises {
            let (what, value) = ("number of advance ratios", advance_ratios.len() as f64);
            return Err(FlightError::OutOfRange { what, value, expected: "1 or more that rise" });
        }
        let advance_ratios = advance_ratios.to_vec();
        let rows = vec![trims(case, &advance_ratios)?];
        let blades = case.rotor.blades;
        Ok(Self { advance_ratios, rows, blades, own_blades: vec![], own: vec![] })
    }

    /// The same with a step of the thrust to that of another case, trimmed at the same advance ratios.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_thrust_step(mut self, after: &Case) -> Result<Self, FlightError> {
        self.rows.truncate(1);
        self.rows.push(trims(after, &self.advance_ratios)?);
        (self.own_blades, self.own) = (vec![], vec![]);
        Ok(self)
    }

    /// The same with blades known one by one: those of the case that are unlike the rest, and those some flap of which moves
    /// otherwise than that of the others, as pairs of blade and flap, from 0.
    ///
    /// # Errors
    /// [`FlightError::OutOfRange`] for a blade or flap that there is not, and for loads of the case that end below twice the
    /// blade number; [`FlightError::Blade`], [`FlightError::Response`].
    pub fn with_blades(
        mut self,
        case: &Case,
        moved: &[(usize, usize)],
    ) -> Result<Self, FlightError> {
        check_orders(case)?;
        let mut asked: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &(blade, flap) in moved {
            for (what, value, count) in [
                ("blade that moves a flap by itself (from 0)", blade, self.blades),
                ("flap that one blade moves by itself (from 0)", flap, case.flaps.len()),
            ] {
                if value >= count {
                    let (value, expected) = (value as f64, "one that there is");
                    return Err(FlightError::OutOfRange { what, value, expected });
                }
            }
            asked.entry(blade).or_default().push(flap);
        }
        let unlike = &case.rotor.dissimilar_blades;
        for one in unlike {
            asked.insert(one.blade - 1, (0..case.flaps.len()).collect());
        }
        let place = |blade: usize| unlike.iter().position(|one| one.blade == blade + 1);
        let asked: Vec<AskedBlade> = asked
            .into_iter()
            .map(|(blade, flaps)| AskedBlade { blade, flaps, unlike: place(blade) })
            .collect();
        let known = |one: &AskedBlade| KnownBlade {
            blade: one.blade,
            flap_motion: one.unlike.map_or(1.0, |place| unlike[place].flap_motion),
        };
        self.own_blades = asked.iter().map(known).collect();
        let at = |(&advance_ratio, rotor): (&f64, &TrimmedRotor)| {
            let here = Case { advance_ratio, ..case.clone() };
            let solvers = rotor.unlike_solvers(&here);
            let solvers = solvers
                .map_err(|source| FlightError::Blade { advance_ratio, source: Box::new(source) })?;
            OwnBlade::all(rotor, &solvers, &asked)
                .map_err(|source| FlightError::Response { advance_ratio, source })
        };
        let of_row =
            |row: &Vec<TrimmedRotor>| self.advance_ratios.par_iter().zip(row).map(at).collect();
        self.own = self.rows.iter().map(of_row).collect::<Result<_, FlightError>>()?;
        Ok(self)
    }

    /// Hub loads at the blade number per rev for motions of the flaps, deg; cosine and sine of six, nondimensional.
    ///
    /// # Errors
    /// [`FlightError::Response`].
    pub fn loads(
        &self,
        state: FlightState,
        flaps_deg: &[HarmonicSeries],
    ) -> Result<[f64; HUB_OUTPUTS], FlightError> {
        let mut loads = [0.0; HUB_OUTPUTS];
        for (place, weight) in self.about(state) {
            let (at, rotor) = self.knot(place);
            let authority = authority(at, rotor)?;
            let own = rotor.trim().rotor.hub.harmonic(self.blades);
            let moved = flaps_deg.iter().enumerate();
            let parts = moved.map(|(flap, motion)| authority.loads(flap, motion));
            for part in std::iter::once(own).chain(parts) {
                for (load, part) in loads.iter_mut().zip(part) {
                    *load += weight * part;
                }
            }
        }
        Ok(loads)
    }

    /// Blades known one by one.
    pub fn own_blades(&self) -> &[KnownBlade] {
        &self.own_blades
    }

    /// Hub loads at 1 to twice the blade number less one per rev, twelve each, that the blades known one by one add to those of
    /// blades alike: `own_deg` are the motions of their flaps, in the order of [`Self::own_blades`], `like_deg` those of the
    /// others, deg; what is left out is at rest. Nondimensional; the inflow is that of the trim.
    ///
    /// # Errors
    /// [`FlightError::OwnBlade`] for motions of more blades than are known.
    pub fn own_blade_loads(
        &self,
        state: FlightState,
        like_deg: &[HarmonicSeries],
        own_deg: &[Vec<HarmonicSeries>],
    ) -> Result<Vec<f64>, FlightError> {
        let known = self.own_blades.len();
        if own_deg.len() > known {
            return Err(FlightError::OwnBlade { asked: own_deg.len(), known });
        }
        let mut loads = vec![0.0; highest(self.blades) * HUB_OUTPUTS];
        for ((row, k), weight) in self.about(state) {
            for (i, blade) in
                self.own.get(row).map_or(&[][..], |of_row| &of_row[k]).iter().enumerate()
            {
                let own_deg = own_deg.get(i).map_or(&[][..], Vec::as_slice);
                blade.add(own_deg, like_deg, weight, &mut loads);
            }
        }
        Ok(loads)
    }

    /// Number of blades.
    pub(crate) fn blades(&self) -> usize {
        self.blades
    }

    /// Mean power that the actuators of one blade give, none taken back, W; the mean of the knots by their weights.
    ///
    /// # Errors
    /// [`FlightError::Response`].
    pub fn power_watt(
        &self,
        state: FlightState,
        flaps_deg: &[HarmonicSeries],
    ) -> Result<f64, FlightError> {
        let flaps_deg: Vec<&HarmonicSeries> = flaps_deg.iter().collect();
        let each = self.about(state).map(|(place, weight)| {
            let (advance_ratio, rotor) = self.knot(place);
            let found = rotor.linear_power_watt(&flaps_deg);
            Ok(weight * found.map_err(|source| FlightError::Response { advance_ratio, source })?)
        });
        each.sum()
    }

    /// Advance ratios of the knots.
    pub fn advance_ratios(&self) -> &[f64] {
        &self.advance_ratios
    }

    /// Every trim with its place, before a step of the thrust and after it.
    pub(crate) fn rotors(&self) -> impl Iterator<Item = (FlightState, &TrimmedRotor)> {
        self.rows.iter().zip([0.0, 1.0]).flat_map(|(row, thrust_share)| {
            let places = self.advance_ratios.iter().zip(row);
            places.map(move |(&advance_ratio, rotor)| {
                (FlightState { advance_ratio, thrust_share }, rotor)
            })
        })
    }

    /// Advance ratio and rotor of a row and a knot.
    fn knot(&self, (row, k): (usize, usize)) -> (f64, &TrimmedRotor) {
        (self.advance_ratios[k], &self.rows[row][k])
    }

    /// The knots about a state: row and place in it, and the weight.
    fn about(&self, state: FlightState) -> impl Iterator<Item = ((usize, usize), f64)> + use<> {
        let share = if self.rows.len() > 1 { state.thrust_share } else { 0.0 };
        let columns = self.weights(state.advance_ratio);
        let rows = [1.0 - share, share].into_iter().take(self.rows.len()).enumerate();
        rows.flat_map(move |(row, of_row)| {
            columns.map(|(k, of_column)| ((row, k), of_row * of_column))
        })
        .filter(|(_, weight)| *weight > 0.0)
    }

    /// The two knots about an advance ratio with their weights.
    pub(crate) fn weights(&self, advance_ratio: f64) -> [(usize, f64); 2] {
        let knots = &self.advance_ratios;
        let above = knots.partition_point(|knot| *knot < advance_ratio);
        if above == 0 || above == knots.len() {
            let end = above.min(knots.len() - 1);
            return [(end, 1.0), (end, 0.0)];
        }
        let (low, high) = (knots[above - 1], knots[above]);
        let share = (advance_ratio - low) / (high - low);
        [(above - 1, 1.0 - share), (above, share)]
    }
}

fn authority(advance_ratio: f64, rotor: &TrimmedRotor) -> Result<&FlapAuthority, FlightError> {
    rotor.authority().map_err(|source| FlightError::Response { advance_ratio, source })
}

/// Trims at advance ratios, each from the last, all linearised.
fn trims(case: &Case, advance_ratios: &[f64]) -> Result<Vec<TrimmedRotor>, FlightError> {
    let mut rotors: Vec<TrimmedRotor> = Vec::with_capacity(advance_ratios.len());
    for &advance_ratio in advance_ratios {
        let here = Case { advance_ratio, ..case.clone() };
        let start = rotors.last().map(TrimmedRotor::trim);
        let rotor = TrimmedRotor::new(&here, start)
            .map_err(|source| FlightError::Trim { advance_ratio, source: Box::new(source) })?;
        if rotor.wake_diverged() {
            return Err(FlightError::WakeDiverged { advance_ratio });
        }
        rotors.push(rotor);
    }
    let each = rotors.par_iter().zip(advance_ratios);
    each.map(|(rotor, &at)| authority(at, rotor).map(|_| ())).collect::<Result<Vec<()>, _>>()?;
    Ok(rotors)
}
