//! The rotor along a path of advance ratios, before and after a step of the thrust.

use crate::FlightError;
use crate::blades::{OneBlade, highest};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_study::case::Case;
use rotor_study::{FlapAuthority, HUB_OUTPUTS, TrimmedRotor};

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
/// Truth is this rotor, linear in the motion of the flaps.
#[derive(Debug, Clone)]
pub struct RotorPath {
    advance_ratios: Vec<f64>,
    /// Before the step of the thrust; after it, if there is one.
    rows: Vec<Vec<TrimmedRotor>>,
    blades: usize,
    /// What one flap (from 0) of one blade does at every trim, where it is asked for.
    one_blade: Option<(usize, Vec<Vec<OneBlade>>)>,
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
        Ok(Self { advance_ratios, rows, blades: case.rotor.blades, one_blade: None })
    }

    /// The same with a step of the thrust to that of another case, trimmed at the same advance ratios.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_thrust_step(mut self, after: &Case) -> Result<Self, FlightError> {
        self.rows.truncate(1);
        self.rows.push(trims(after, &self.advance_ratios)?);
        self.one_blade = None;
        Ok(self)
    }

    /// The same with what a flap (from 0) of one blade does to the hub when it moves otherwise than those of the others.
    ///
    /// # Errors
    /// [`FlightError::OutOfRange`] for a flap that there is not; [`FlightError::Response`].
    pub fn with_one_blade(mut self, flap: usize) -> Result<Self, FlightError> {
        let has_flap = |rotor: &TrimmedRotor| flap < rotor.rotor().model().flaps.len();
        if !self.rows.iter().flatten().all(has_flap) {
            let (what, value) = ("flap that fails on one blade (from 0)", flap as f64);
            return Err(FlightError::OutOfRange { what, value, expected: "one that there is" });
        }
        let at = |(&advance_ratio, rotor): (&f64, &TrimmedRotor)| {
            let found = OneBlade::new(rotor, flap);
            found.map_err(|source| FlightError::Response { advance_ratio, source })
        };
        let of_row =
            |row: &Vec<TrimmedRotor>| self.advance_ratios.iter().zip(row).map(at).collect();
        let found = self.rows.iter().map(of_row).collect::<Result<Vec<Vec<_>>, FlightError>>()?;
        self.one_blade = Some((flap, found));
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

    /// Hub loads at 1 to twice the blade number less one per rev, twelve each, that a flap (from 0) of one blade adds where it
    /// moves otherwise than that of the others, by so much, deg; nondimensional. Its inflow is that of the trim.
    ///
    /// # Errors
    /// [`FlightError::OneBlade`] for a flap that [`Self::with_one_blade`] was not asked for.
    pub fn one_blade_loads(
        &self,
        state: FlightState,
        flap: usize,
        change_deg: &HarmonicSeries,
    ) -> Result<Vec<f64>, FlightError> {
        let Some((_, known)) = self.one_blade.as_ref().filter(|(own, _)| *own == flap) else {
            return Err(FlightError::OneBlade { flap });
        };
        let mut loads = vec![0.0; highest(self.blades) * HUB_OUTPUTS];
        for ((row, k), weight) in self.about(state) {
            known[row][k].add(change_deg, weight, &mut loads);
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
