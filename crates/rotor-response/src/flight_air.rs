//! Section coefficients and lag operators of one flight condition.
//!
//! Mach number and reduced time follow the tangential speed of the rigid blade, `x + mu sin psi`: the
//! elastic part of the speed changes them in second order only. That makes the lag states a linear
//! operator on the section inputs, solved once per flight condition.

use crate::air::{PromptCoefficients, SectionFlow, dot};
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

/// One lag channel of a station. Its input does not depend on the Mach number, its outputs do.
#[derive(Debug, Clone)]
struct StationLag {
    input: [f64; 4],
    /// Output and its gain at every point, for the outputs the channel has.
    gains: Vec<(usize, Vec<f64>)>,
    lag: PeriodicLag,
}

/// One station of the lifting part of the blade over the revolution.
#[derive(Debug, Clone)]
struct StationAir {
    /// Coefficients without delay and of apparent mass, by point.
    prompt: Vec<PromptCoefficients>,
    /// Gain of the settled lags, output by input, by point.
    settled: Vec<[[f64; 4]; 3]>,
    lags: Vec<StationLag>,
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
    pub(crate) fn prompt(&self, station: usize, point: usize) -> &PromptCoefficients {
        &self.stations[station].prompt[point]
    }

    /// Lag part of the three outputs at all lifting stations and points, `[point][station]`, for
    /// the flows `[point][station]`.
    pub(crate) fn lag_loads(&self, flows: &[Vec<SectionFlow>]) -> Vec<Vec<[f64; 3]>> {
        let points = flows.len();
        let mut out = vec![vec![[0.0; 3]; self.stations.len()]; points];
        let mut drive = vec![0.0; points];
        let mut state = Vec::with_capacity(points);
        for (s, station) in self.stations.iter().enumerate() {
            let mut sums = [(); 3].map(|()| vec![0.0; points]);
            for channel in &station.lags {
                for (d, flow) in drive.iter_mut().zip(flows) {
                    *d = dot(&channel.input, &flow[s].input);
                }
                channel.lag.periodic_state(&drive, &mut state);
                for (output, gains) in &channel.gains {
                    for ((sum, gain), x) in sums[*output].iter_mut().zip(gains).zip(&state) {
                        *sum += gain * x;
                    }
                }
            }
            for (p, loads) in out.iter_mut().enumerate() {
                loads[s] = [sums[0][p], sums[1][p], sums[2][p]];
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
            .map(|(station, flow)| {
                station.settled[point].each_ref().map(|row| dot(row, &flow.input))
            })
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
        let effectiveness = flap.map(|k| model.flaps[k].effectiveness).unwrap_or_default();
        let section_model = model.section_model.of_flap(FlapChord::new(chord_fraction)?)?;
        let coefficients = speeds
            .iter()
            .map(|speed| {
                let mach = Mach::limited(model.compressible_tip_mach() * speed, MACH_LIMIT)?;
                let section = section_model.coefficients(mach)?;
                Ok(section.with_flap_effectiveness(&effectiveness))
            })
            .collect::<Result<Vec<SectionCoefficients>, ResponseError>>()?;
        let channels = coefficients.first().map_or(0, |c| c.lags.len());
        let lags = (0..channels)
            .map(|c| StationLag::new(model, collocation, speeds, (&coefficients, c)))
            .collect::<Result<Vec<_>, _>>()?;
        let settled = coefficients
            .iter()
            .map(|k| {
                let mut gain = [[0.0; 4]; 3];
                for channel in &k.lags {
                    for (row, output) in gain.iter_mut().zip(channel.output) {
                        for (g, input) in row.iter_mut().zip(channel.input) {
                            *g += output * input;
                        }
                    }
                }
                gain
            })
            .collect();
        let prompt = coefficients
            .iter()
            .map(|k| PromptCoefficients { direct: k.direct, rate: k.rate })
            .collect();
        Ok(Self { prompt, settled, lags })
    }
}

impl StationLag {
    fn new(
        model: &RotorModel,
        collocation: &Collocation,
        speeds: &[f64],
        (coefficients, channel): (&[SectionCoefficients], usize),
    ) -> Result<Self, ResponseError> {
        let semichord = 0.5 * model.chord;
        let of = |k: &SectionCoefficients| k.lags[channel];
        let rates: Vec<f64> = speeds
            .iter()
            .zip(coefficients)
            .map(|(speed, k)| of(k).pole * (speed / semichord).max(SLOWEST_RATE))
            .collect();
        let gains = (0..3)
            .map(|output| {
                let along: Vec<f64> = coefficients.iter().map(|k| of(k).output[output]).collect();
                (output, along)
            })
            .filter(|(_, along)| along.iter().any(|gain| *gain != 0.0))
            .collect();
        let input = coefficients.first().map_or([0.0; 4], |k| of(k).input);
        Ok(Self { input, gains, lag: PeriodicLag::new(collocation, &rates)? })
    }
}
