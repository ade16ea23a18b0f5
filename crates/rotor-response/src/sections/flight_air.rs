//! Section coefficients and lag operators of one flight condition.
//!
//! Mach number and reduced time follow the tangential speed of the rigid blade, `x + mu sin psi`: the
//! elastic part of the speed changes them in second order only. That makes the lag states a linear
//! operator on the section inputs, solved once per flight condition.

mod memory;

/// Azimuth points, and stations, that one thread takes together at least: less would cost more to hand out.
pub(crate) const POINTS_TOGETHER: usize = 4;

pub(crate) use self::memory::StationMemory;
use crate::model::air_scales::{AirScales, sweep_cosine};

use crate::model::rotor_model::MACH_LIMIT;
use crate::sections::air::{
    PromptCoefficients, SectionFlow, SectionLoads, SectionPast, dot, section_loads, sense,
};
use crate::sections::fine_azimuth::{FineAzimuth, RigidSpeed};
use crate::sections::lag::{Collocation, PeriodicLag};
use crate::sections::nonlinear::{TabledStation, add_stall};
use crate::sections::stall_history::StallHistory;
use crate::structure::blade::ResponseBlade;
use crate::{ResponseError, ReverseFlow, RotorModel};
use flap_aero::{FlapChord, Mach, SectionCoefficients, StallSection};
use rayon::prelude::*;
use rotor_fem::TimeElements;

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
    /// Rate at every point, per rad.
    rates: Vec<f64>,
    lag: PeriodicLag,
}

/// The sections of one station at the azimuth points of a revolution.
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

/// A station at finer azimuth points.
#[derive(Debug, Clone)]
struct FineStation {
    azimuth: FineAzimuth,
    reverse_flow: ReverseFlow,
    /// Tangential speed of the rigid blade at the points.
    rigid_speeds: Vec<f64>,
    air: StationAir,
}

/// One station of the lifting part of the blade.
#[derive(Debug, Clone)]
struct Station {
    air: StationAir,
    /// What takes its place over a whole revolution, where the flow turns round inside a time element.
    fine: Option<FineStation>,
}

/// The section aerodynamics of one advance ratio, at every lifting station and azimuth point.
#[derive(Debug, Clone)]
pub(crate) struct FlightAir {
    /// First lifting station.
    pub(crate) first_station: usize,
    stations: Vec<Station>,
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
        let level = model.speeds_with_kinks();
        let stations = (first_station..x.len())
            .into_par_iter()
            .map(|i| {
                let AirScales { chord, sweep, .. } = blade.air[i];
                let across = sweep_cosine(sweep);
                let place = Place { station: x[i], flap: blade.flap_index[i], chord, across };
                let kinks: Vec<f64> = level.iter().map(|speed| speed / across).collect();
                let speed = RigidSpeed { station: x[i], advance_ratio, sweep, kinks: &kinks };
                Station::new(model, place, &speed, time, &collocation)
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { first_station, stations })
    }

    /// Whether any section stalls dynamically: its loads are then not linear in the flap.
    pub(crate) fn stalls(&self) -> bool {
        self.stations.iter().any(|station| station.air.stall.is_some())
    }

    /// Loads of all lifting stations over a revolution, for the flows, both `[point][station]`.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn loads(
        &self,
        flows: &[Vec<SectionFlow>],
        law: LoadLaw<'_>,
    ) -> Result<Vec<Vec<SectionLoads>>, ResponseError> {
        let of_station = |(s, station): (usize, &Station)| {
            let column: Vec<SectionFlow> = flows.iter().map(|row| row[s]).collect();
            station.loads(&column, law.at(s))
        };
        let stations = self.stations.par_iter().with_min_len(POINTS_TOGETHER).enumerate();
        let by_station = stations.map(of_station).collect::<Result<Vec<_>, _>>()?;
        let mut out = vec![Vec::with_capacity(self.stations.len()); flows.len()];
        for column in by_station {
            for (row, loads) in out.iter_mut().zip(column) {
                row.push(loads);
            }
        }
        Ok(out)
    }

    /// Loads of the lifting stations at one point with every state settled on its input: what the Newton
    /// matrix uses.
    pub(crate) fn settled_loads(
        &self,
        point: usize,
        flows: &[SectionFlow],
        law: LoadLaw<'_>,
    ) -> Vec<SectionLoads> {
        let at = |(s, (station, flow)): (usize, (&Station, &SectionFlow))| {
            let past = station.air.settled_past(point, flow);
            station.air.loads_at(point, flow, &past, law.at(s))
        };
        self.stations.iter().zip(flows).enumerate().map(at).collect()
    }
}

/// How loads follow from the flow and its past.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadLaw<'a> {
    /// By lifting station.
    pub(crate) scales: &'a [AirScales],
    /// Lifting stations, counted from the first, from which on the tip takes the lift.
    pub(crate) lost_from: usize,
    /// Whether flows are changes of flows: loads are then what the inputs of the flap change them by.
    pub(crate) changes: bool,
}

impl LoadLaw<'_> {
    fn at(self, station: usize) -> StationLaw {
        let lost = station >= self.lost_from;
        let kind = match (lost, self.changes) {
            (false, false) => Kind::Whole,
            (false, true) => Kind::FlapSlope,
            (true, false) => Kind::DragAlone,
            (true, true) => Kind::Nothing,
        };
        StationLaw { scales: self.scales[station], kind }
    }
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Whole,
    /// What the loads change by with the inputs of the flap; also of a section with tables, which know
    /// no flap.
    FlapSlope,
    /// A station that has lost its lift to the tip: its drag at rest in the flow.
    DragAlone,
    Nothing,
}

#[derive(Debug, Clone, Copy)]
struct StationLaw {
    scales: AirScales,
    kind: Kind,
}

impl Station {
    fn new(
        model: &RotorModel,
        place: Place,
        speed: &RigidSpeed<'_>,
        time: &TimeElements,
        collocation: &Collocation,
    ) -> Result<Self, ResponseError> {
        let speeds = |points: &[f64]| -> Vec<f64> { points.iter().map(|p| speed.at(*p)).collect() };
        let air = |collocation: &Collocation, points: &[f64]| {
            let magnitudes: Vec<f64> = speeds(points).iter().map(|u| u.abs()).collect();
            StationAir::new(model, place, collocation, points, &magnitudes)
        };
        let fine = |azimuth: FineAzimuth| {
            let collocation = collocation.on(&azimuth.half_widths);
            Ok::<_, ResponseError>(FineStation {
                reverse_flow: model.reverse_flow,
                rigid_speeds: speeds(&azimuth.points),
                air: air(&collocation, &azimuth.points)?,
                azimuth,
            })
        };
        Ok(Self {
            air: air(collocation, time.points())?,
            fine: FineAzimuth::new(time, speed).map(fine).transpose()?,
        })
    }

    fn loads(
        &self,
        flows: &[SectionFlow],
        law: StationLaw,
    ) -> Result<Vec<SectionLoads>, ResponseError> {
        let Some(fine) = &self.fine else { return self.air.loads(flows, law) };
        let mut flows = fine.azimuth.flows(flows);
        for (flow, rigid) in flows.iter_mut().zip(&fine.rigid_speeds) {
            flow.sense = sense(fine.reverse_flow, flow.u_t, flow.u_p, *rigid);
        }
        Ok(fine.azimuth.loads(&fine.air.loads(&flows, law)?))
    }
}

/// Where a station is, which flap it has, how wide it is (R), and the cosine of its sweep.
#[derive(Debug, Clone, Copy)]
struct Place {
    station: f64,
    flap: Option<usize>,
    chord: f64,
    across: f64,
}

impl StationAir {
    fn new(
        model: &RotorModel,
        Place { station, flap, chord, across }: Place,
        collocation: &Collocation,
        points: &[f64],
        speeds: &[f64],
    ) -> Result<Self, ResponseError> {
        let nonlinear = &model.nonlinear;
        let tip_mach = model.compressible_tip_mach() * across;
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
            .map(|c| {
                let mut lag = StationLag::new(collocation, speeds, &coefficients, c, chord)?;
                lag.rigid &= !nonlinear.is_linear();
                Ok(lag)
            })
            .collect::<Result<Vec<_>, ResponseError>>()?;
        let settled: Vec<[[f64; 4]; 3]> = coefficients
            .iter()
            .map(|k| {
                let gain = |o: usize, i: usize| {
                    k.lags.iter().fold(0.0, |sum, lag| sum + lag.output[o] * lag.input[i])
                };
                std::array::from_fn(|o| std::array::from_fn(|i| gain(o, i)))
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
            let semichord = 0.5 * chord;
            let over_tables = nonlinear.airfoils.is_some();
            Ok::<_, ResponseError>(StallHistory::new(
                station,
                semichord,
                sections,
                points,
                speeds,
                over_tables,
            ))
        });
        let (tables, stall) = (tables.transpose()?, stall.transpose()?);
        Ok(Self { prompt, settled, lags, tables, stall })
    }
}

impl StationAir {
    /// Loads over a revolution, at the points of this station.
    fn loads(
        &self,
        flows: &[SectionFlow],
        law: StationLaw,
    ) -> Result<Vec<SectionLoads>, ResponseError> {
        let still =
            |flow: &SectionFlow| flow.input[2..] == [0.0; 2] && flow.input_rate[2..] == [0.0; 2];
        if let Kind::FlapSlope = law.kind
            && flows.iter().all(still)
        {
            return Ok(vec![SectionLoads::default(); flows.len()]);
        }
        if let Kind::DragAlone | Kind::Nothing = law.kind {
            let past = SectionPast::default();
            let at = |(p, flow)| self.loads_at(p, flow, &past, law);
            return Ok(flows.iter().enumerate().map(at).collect());
        }
        let pasts = self.pasts(flows)?;
        let at = |(p, (flow, past))| self.loads_at(p, flow, past, law);
        Ok(flows.iter().zip(&pasts).enumerate().map(at).collect())
    }

    fn loads_at(
        &self,
        point: usize,
        flow: &SectionFlow,
        past: &SectionPast,
        StationLaw { scales, kind }: StationLaw,
    ) -> SectionLoads {
        let loads = match kind {
            Kind::Whole => self.whole_loads(point, scales, flow, past),
            Kind::FlapSlope => {
                let frictionless = AirScales { drag: 0.0, ..scales };
                section_loads(frictionless, flow, &self.prompt[point], past.lag)
            }
            Kind::DragAlone => {
                let SectionFlow { u_t, sense, .. } = *flow;
                let still = SectionFlow { u_t, sense, ..SectionFlow::default() };
                let past = SectionPast::default();
                let SectionLoads { fy, .. } = self.whole_loads(point, scales, &still, &past);
                SectionLoads { fy, ..SectionLoads::default() }
            }
            Kind::Nothing => SectionLoads::default(),
        };
        if scales.centre == 0.0 { loads } else { loads.about(scales.centre, flow.pitch) }
    }

    fn whole_loads(
        &self,
        point: usize,
        scales: AirScales,
        flow: &SectionFlow,
        past: &SectionPast,
    ) -> SectionLoads {
        let prompt = &self.prompt[point];
        let mut loads = match &self.tables {
            None => section_loads(scales, flow, prompt, past.lag),
            Some(tables) => tables.loads(point, scales, flow, prompt, past),
        };
        if self.stall.is_some() {
            add_stall(scales, flow, past.stall, &mut loads);
        }
        loads
    }

    /// What the past adds to the loads at all points.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    fn pasts(&self, flows: &[SectionFlow]) -> Result<Vec<SectionPast>, ResponseError> {
        let points = flows.len();
        let mut drive = vec![0.0; points];
        let mut state = Vec::with_capacity(points);
        let mut pasts = vec![SectionPast::default(); points];
        for channel in &self.lags {
            for (d, flow) in drive.iter_mut().zip(flows) {
                *d = dot(&channel.input, &flow.input);
            }
            channel.lag.periodic_state(&drive, &mut state);
            for (output, gains) in &channel.gains {
                for ((past, gain), x) in pasts.iter_mut().zip(gains).zip(&state) {
                    past.lag[*output] += gain * x;
                }
                if channel.rigid && *output == 0 {
                    for ((past, gain), x) in pasts.iter_mut().zip(gains).zip(&state) {
                        past.rigid_lift += gain * x;
                    }
                }
            }
        }
        if let Some(stall) = &self.stall {
            stall.fill(|p| (&flows[p], &self.prompt[p]), &mut pasts)?;
        }
        Ok(pasts)
    }

    /// The same with every state settled on its input, for one point.
    fn settled_past(&self, point: usize, flow: &SectionFlow) -> SectionPast {
        let gains = &self.settled[point];
        let [normal, rate, ..] = gains[0];
        let mut past = SectionPast {
            lag: gains.each_ref().map(|row| dot(row, &flow.input)),
            rigid_lift: normal * flow.input[0] + rate * flow.input[1],
            ..SectionPast::default()
        };
        if let Some(stall) = &self.stall {
            past.stall = stall.settled(point, flow, &self.prompt[point], &past);
        }
        past
    }
}

impl StationLag {
    fn new(
        collocation: &Collocation,
        speeds: &[f64],
        coefficients: &[SectionCoefficients],
        channel: usize,
        chord: f64,
    ) -> Result<Self, ResponseError> {
        let semichord = 0.5 * chord;
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
        let rigid = input[2] == 0.0 && input[3] == 0.0;
        let lag = PeriodicLag::new(collocation, &rates)?;
        Ok(Self { input, gains, rigid, rates, lag })
    }
}
