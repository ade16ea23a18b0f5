//! Section coefficients and lag operators of one flight condition.
//!
//! Mach number and reduced time follow the tangential speed of the rigid blade, `x + mu sin psi`: the
//! elastic part of the speed changes them in second order only. That makes the lag states a linear
//! operator on the section inputs, solved once per flight condition.

use crate::air::{
    AirScales, PromptCoefficients, SectionFlow, SectionLoads, SectionPast, dot, section_loads,
};
use crate::blade::ResponseBlade;
use crate::lag::{Collocation, PeriodicLag};
use crate::nonlinear::{TabledStation, add_stall};
use crate::stall_history::StallHistory;
use crate::{ResponseError, RotorModel};
use flap_aero::{FlapChord, Mach, SectionCoefficients, StallSection};
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
    /// Whether the flap has no part in it; only of sections beyond linear theory.
    rigid: bool,
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
    tables: Option<TabledStation>,
    stall: Option<StallHistory>,
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
                let place = Place { station: x[i], flap: blade.flap_index[i] };
                StationAir::new(model, place, &collocation, (time.points(), &speeds))
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { first_station, stations })
    }

    /// First lifting station.
    pub(crate) fn first_station(&self) -> usize {
        self.first_station
    }

    /// Loads of a lifting station (counted from the first) at an azimuth point.
    pub(crate) fn loads(
        &self,
        scales: AirScales,
        (station, point): (usize, usize),
        flow: &SectionFlow,
        past: &SectionPast,
    ) -> SectionLoads {
        let station = &self.stations[station];
        let prompt = &station.prompt[point];
        let mut loads = match &station.tables {
            None => section_loads(scales, flow, prompt, past.lag),
            Some(tables) => tables.loads(point, scales, flow, (prompt, past)),
        };
        if station.stall.is_some() {
            add_stall(scales, flow, past.stall, &mut loads);
        }
        loads
    }

    /// Whether any section stalls dynamically: its loads are then not linear in the flap.
    pub(crate) fn stalls(&self) -> bool {
        self.stations.iter().any(|station| station.stall.is_some())
    }

    /// What the loads of a lifting station change by with the inputs of its flap, `flow` holding their
    /// changes and `lag` those of the lags; also of a section with tables, which know no flap.
    pub(crate) fn flap_slope(
        &self,
        scales: AirScales,
        (station, point): (usize, usize),
        flow: &SectionFlow,
        lag: [f64; 3],
    ) -> SectionLoads {
        let frictionless = AirScales { drag: 0.0, ..scales };
        section_loads(frictionless, flow, &self.stations[station].prompt[point], lag)
    }

    /// Loads of a station that has lost its lift to the tip: its drag at rest in the flow.
    pub(crate) fn drag_alone(
        &self,
        scales: AirScales,
        at: (usize, usize),
        flow: &SectionFlow,
    ) -> SectionLoads {
        let SectionFlow { u_t, sense, .. } = *flow;
        let still = SectionFlow { u_t, sense, ..SectionFlow::default() };
        let SectionLoads { fy, .. } = self.loads(scales, at, &still, &SectionPast::default());
        SectionLoads { fy, ..SectionLoads::default() }
    }

    /// What the past adds to the loads at all lifting stations and points, `[point][station]`, for the
    /// flows `[point][station]`.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn pasts(
        &self,
        flows: &[Vec<SectionFlow>],
    ) -> Result<Vec<Vec<SectionPast>>, ResponseError> {
        let points = flows.len();
        let mut out = vec![vec![SectionPast::default(); self.stations.len()]; points];
        let mut drive = vec![0.0; points];
        let mut state = Vec::with_capacity(points);
        for (s, station) in self.stations.iter().enumerate() {
            let mut sums = [(); 3].map(|()| vec![0.0; points]);
            let mut rigid_lift = vec![0.0; points];
            for channel in &station.lags {
                for (d, flow) in drive.iter_mut().zip(flows) {
                    *d = dot(&channel.input, &flow[s].input);
                }
                channel.lag.periodic_state(&drive, &mut state);
                for (output, gains) in &channel.gains {
                    for ((sum, gain), x) in sums[*output].iter_mut().zip(gains).zip(&state) {
                        *sum += gain * x;
                    }
                    if channel.rigid && *output == 0 {
                        for ((sum, gain), x) in rigid_lift.iter_mut().zip(gains).zip(&state) {
                            *sum += gain * x;
                        }
                    }
                }
            }
            let mut pasts: Vec<SectionPast> = (0..points)
                .map(|p| SectionPast {
                    lag: [sums[0][p], sums[1][p], sums[2][p]],
                    rigid_lift: rigid_lift[p],
                    ..SectionPast::default()
                })
                .collect();
            if let Some(stall) = &station.stall {
                stall.fill(|p| (&flows[p][s], &station.prompt[p]), &mut pasts)?;
            }
            for (row, past) in out.iter_mut().zip(pasts) {
                row[s] = past;
            }
        }
        Ok(out)
    }

    /// The same with every state settled on its input, for one point: what the Newton matrix uses.
    pub(crate) fn settled_pasts(&self, point: usize, flows: &[SectionFlow]) -> Vec<SectionPast> {
        self.stations
            .iter()
            .zip(flows)
            .map(|(station, flow)| {
                let gains = &station.settled[point];
                let [normal, rate, ..] = gains[0];
                let mut past = SectionPast {
                    lag: gains.each_ref().map(|row| dot(row, &flow.input)),
                    rigid_lift: normal * flow.input[0] + rate * flow.input[1],
                    ..SectionPast::default()
                };
                if let Some(stall) = &station.stall {
                    past.stall = stall.settled(point, flow, (&station.prompt[point], &past));
                }
                past
            })
            .collect()
    }
}

/// Where a station is, and which flap it has.
#[derive(Debug, Clone, Copy)]
struct Place {
    station: f64,
    flap: Option<usize>,
}

impl StationAir {
    fn new(
        model: &RotorModel,
        Place { station, flap }: Place,
        collocation: &Collocation,
        (points, speeds): (&[f64], &[f64]),
    ) -> Result<Self, ResponseError> {
        let nonlinear = &model.nonlinear;
        let tip_mach = model.compressible_tip_mach();
        let chord_fraction = flap.map_or(0.0, |k| model.flaps[k].chord_fraction);
        let effectiveness = flap.map(|k| model.flaps[k].effectiveness).unwrap_or_default();
        let flap_chord = FlapChord::new(chord_fraction)?;
        let section_model = model.section_model.of_flap(flap_chord)?;
        let mach_of = |speed: f64| Mach::limited(tip_mach * speed, MACH_LIMIT);
        let coefficients = speeds
            .iter()
            .map(|speed| {
                let section = section_model.coefficients(mach_of(*speed)?)?;
                let section = section.with_flap_effectiveness(&effectiveness);
                Ok(if nonlinear.is_linear() { section } else { section.with_flap_apart() })
            })
            .collect::<Result<Vec<SectionCoefficients>, ResponseError>>()?;
        let channels = coefficients.first().map_or(0, |c| c.lags.len());
        let lags = (0..channels)
            .map(|c| StationLag::new(model, collocation, speeds, (&coefficients, c)))
            .collect::<Result<Vec<_>, _>>()?;
        let settled: Vec<[[f64; 4]; 3]> = coefficients
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
        let prompt: Vec<PromptCoefficients> = coefficients
            .iter()
            .map(|k| PromptCoefficients { direct: k.direct, rate: k.rate })
            .collect();
        let tables = nonlinear.airfoils.as_ref().map(|airfoils| {
            let at = |((speed, c), settled): ((&f64, &PromptCoefficients), &[[f64; 4]; 3])| {
                (tip_mach * speed, c.direct[0][0] + settled[0][0])
            };
            let points = speeds.iter().zip(&prompt).zip(&settled).map(at).collect();
            TabledStation::new(airfoils, station, points)
        });
        let stall = nonlinear.dynamic_stall.map(|stall| {
            let sections = speeds
                .iter()
                .map(|speed| {
                    let mach = mach_of(*speed)?;
                    let section = StallSection::new(mach, flap_chord, stall.parameters(mach))?;
                    Ok(section.with_flap_effectiveness(&effectiveness))
                })
                .collect::<Result<_, ResponseError>>()?;
            let place = (station, 0.5 * model.chord);
            let over_tables = nonlinear.airfoils.is_some();
            Ok::<_, ResponseError>(StallHistory::new(
                place,
                sections,
                (points, speeds),
                over_tables,
            ))
        });
        let (tables, stall) = (tables.transpose()?, stall.transpose()?);
        Ok(Self { prompt, settled, lags, tables, stall })
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
        let rigid = !model.nonlinear.is_linear() && input[2] == 0.0 && input[3] == 0.0;
        Ok(Self { input, gains, rigid, lag: PeriodicLag::new(collocation, &rates)? })
    }
}
