//! Section coefficients and lag operators of one flight condition.
//!
//! Mach number and reduced time follow the tangential speed of the rigid blade, `x + mu sin psi`: the
//! elastic part of the speed changes them in second order only. That makes the lag states a linear
//! operator on the section inputs, solved once per flight condition.

use crate::air::{SectionFlow, settled_lag};
use crate::blade::ResponseBlade;
use crate::lag::{Collocation, PeriodicLag};
use crate::{ResponseError, RotorModel};
use flap_aero::{FlapChord, Mach, SectionCoefficients};
use rayon::prelude::*;
use rotor_fem::TimeElements;

/// Largest local Mach number handed to the section models, where linear theory ends.
const MACH_LIMIT: f64 = 0.9;
/// Slowest reduced-time rate, in semichords per rad, so that a lag state crossing the reverse-flow
/// boundary still has an equation.
const SLOWEST_RATE: f64 = 1e-3;

/// One station of the lifting part of the blade over the revolution.
#[derive(Debug, Clone)]
struct StationAir {
    coefficients: Vec<SectionCoefficients>,
    lags: Vec<PeriodicLag>,
}

/// The section aerodynamics of one advance ratio, at every lifting station and azimuth point.
#[derive(Debug, Clone)]
pub(crate) struct FlightAir {
    first_station: usize,
    stations: Vec<StationAir>,
}

impl FlightAir {
    pub(crate) fn new(
        model: &RotorModel,
        blade: &ResponseBlade,
        time: &TimeElements,
        advance_ratio: f64,
    ) -> Result<Self, ResponseError> {
        let x = blade.grid.x();
        let first_station = x.iter().take_while(|x| **x < blade.cutout).count();
        let collocation = Collocation::new(time);
        let stations = (first_station..x.len())
            .into_par_iter()
            .map(|i| {
                let speeds: Vec<f64> =
                    time.points().iter().map(|p| (x[i] + advance_ratio * p.sin()).abs()).collect();
                StationAir::new(model, blade.flap_index[i], &collocation, &speeds)
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { first_station, stations })
    }

    /// First lifting station.
    pub(crate) fn first_station(&self) -> usize {
        self.first_station
    }

    /// Coefficients at a lifting station (counted from the first) and azimuth point.
    pub(crate) fn coefficients(&self, station: usize, point: usize) -> &SectionCoefficients {
        &self.stations[station].coefficients[point]
    }

    /// Lag part of the three outputs at all lifting stations and points, `[point][station]`, for
    /// the flows `[point][station]`.
    pub(crate) fn lag_loads(&self, flows: &[Vec<SectionFlow>]) -> Vec<Vec<[f64; 3]>> {
        let points = flows.len();
        let mut out = vec![vec![[0.0; 3]; self.stations.len()]; points];
        let mut drive = vec![0.0; points];
        let mut state = Vec::with_capacity(points);
        for (s, station) in self.stations.iter().enumerate() {
            for (c, lag) in station.lags.iter().enumerate() {
                for (p, d) in drive.iter_mut().enumerate() {
                    let channel = &station.coefficients[p].lags[c];
                    *d = channel.input.iter().zip(&flows[p][s].input).map(|(a, b)| a * b).sum();
                }
                lag.periodic_state(&drive, &mut state);
                for (p, x) in state.iter().enumerate() {
                    let gains = &station.coefficients[p].lags[c].output;
                    for (o, gain) in out[p][s].iter_mut().zip(gains) {
                        *o += gain * x;
                    }
                }
            }
        }
        out
    }

    /// The same with every lag state settled on its input, for one point: what the Newton matrix
    /// uses.
    pub(crate) fn settled_loads(&self, point: usize, flows: &[SectionFlow]) -> Vec<[f64; 3]> {
        self.stations
            .iter()
            .zip(flows)
            .map(|(station, flow)| settled_lag(&station.coefficients[point], &flow.input))
            .collect()
    }
}

impl StationAir {
    fn new(
        model: &RotorModel,
        flap: Option<usize>,
        collocation: &Collocation,
        speeds: &[f64],
    ) -> Result<Self, ResponseError> {
        let chord_fraction = flap.map_or(0.0, |k| model.flaps[k].chord_fraction);
        let flap_chord = FlapChord::new(chord_fraction)?;
        let coefficients = speeds
            .iter()
            .map(|speed| {
                let mach = Mach::limited(model.compressible_tip_mach() * speed, MACH_LIMIT)?;
                model.section_model.coefficients(mach, flap_chord)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let channels = coefficients.first().map_or(0, |c| c.lags.len());
        let semichord = 0.5 * model.chord;
        let lags = (0..channels)
            .map(|c| {
                let rates: Vec<f64> = speeds
                    .iter()
                    .zip(&coefficients)
                    .map(|(speed, k)| k.lags[c].pole * (speed / semichord).max(SLOWEST_RATE))
                    .collect();
                PeriodicLag::new(collocation, &rates)
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { coefficients, lags })
    }
}
