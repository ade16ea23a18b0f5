//! Section coefficients and lag operators of one flight condition.
//!
//! Mach number and reduced time follow the tangential speed of the rigid blade, `x + mu sin psi`: the
//! elastic part of the speed changes them in second order only. That makes the lag states a linear
//! operator on the section inputs, solved once per flight condition.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

mod memory;
mod passing;

/// Azimuth points, and stations, that one thread takes together at least: less would cost more to hand out.
pub(crate) const POINTS_TOGETHER: usize = 4;

pub(crate) use self::memory::StationMemory;
pub(crate) use self::passing::{LagSteps, PassingLags};
use crate::model::air_scales::{AirScales, sweep_cosine};

use crate::model::rotor_model::MACH_LIMIT;
use crate::sections::air::{
    Gains, PromptCoefficients, SectionFlow, SectionLoads, SectionPast, dot, gathered, in_lanes,
    section_loads, sense,
};
use crate::sections::fine_azimuth::{FineAzimuth, RigidSpeed};
use crate::sections::lag::Collocation;
use crate::sections::nonlinear::{TabledStation, add_stall};
use crate::sections::stall_history::StallHistory;
use crate::sections::station_lag::{CIRCULATORY_LIFT, RIGID_LIFT, SectionChannel, StationLag};
use crate::sections::station_lags::{LagScratch, StationLags};
use crate::structure::blade::ResponseBlade;
use crate::{ResponseError, ReverseFlow, RotorModel};
use flap_aero::{FlapChord, Mach, SectionCoefficients, StallSection};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use rotor_base::{LANES, Lanes};
use rotor_fem::TimeElements;
use std::sync::OnceLock;

/// The sections of one station at some azimuth points: those of a revolution, or those of all blades at an instant.
#[derive(Debug, Clone)]
struct StationAir {
    points: usize,
    /// Coefficients without delay and of apparent mass, by block of points.
    prompt: Vec<PromptCoefficients<Lanes>>,
    /// Gain of the settled lags, output by input, by block of points.
    settled: Vec<Gains<Lanes>>,
    channels: Channels,
    tables: Option<TabledStation>,
    stall: Option<StallHistory>,
}

/// The lag channels of a station.
#[derive(Debug, Clone)]
enum Channels {
    /// With their states over a revolution, one by one and as one operator.
    Round(Vec<StationLag>, StationLags),
    /// Whose states are brought along from instant to instant.
    Passing(Vec<SectionChannel>),
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
    /// What their lags remember, once a Newton matrix has asked.
    memories: OnceLock<Vec<Option<StationMemory>>>,
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
        Ok(Self { first_station, stations, memories: OnceLock::new() })
    }

    /// The section aerodynamics of all blades at one instant, in the order of their azimuths (rad).
    ///
    /// # Errors
    /// [`ResponseError`] of coefficients; [`ResponseError::Parameter`] for sections that stall dynamically.
    pub(crate) fn at_instant(
        model: &RotorModel,
        blade: &ResponseBlade,
        azimuths_rad: &[f64],
        advance_ratio: f64,
    ) -> Result<Self, ResponseError> {
        let x = blade.grid.x();
        let first_station = x.iter().take_while(|x| **x < blade.cutout).count();
        let stations = (first_station..x.len())
            .map(|i| {
                let AirScales { chord, sweep, .. } = blade.air[i];
                let across = sweep_cosine(sweep);
                let place = Place { station: x[i], flap: blade.flap_index[i], chord, across };
                let speed = RigidSpeed { station: x[i], advance_ratio, sweep, kinks: &[] };
                let speeds: Vec<f64> =
                    azimuths_rad.iter().map(|psi| speed.at(*psi).abs()).collect();
                let air = StationAir::new(model, place, None, azimuths_rad, &speeds)?;
                Ok(Station { air, fine: None })
            })
            .collect::<Result<Vec<_>, ResponseError>>()?;
        Ok(Self { first_station, stations, memories: OnceLock::new() })
    }

    /// Whether any section stalls dynamically: its loads are then not linear in the flap.
    pub(crate) fn stalls(&self) -> bool {
        self.stations.iter().any(|station| station.air.stall.is_some())
    }

    /// Number of lifting stations.
    pub(crate) fn stations(&self) -> usize {
        self.stations.len()
    }

    /// Loads of a lifting station at all points of the revolution, block by block, for the flows there.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn loads(
        &self,
        station: usize,
        flows: &[SectionFlow<Lanes>],
        law: LoadLaw<'_>,
        scratch: &mut AirScratch,
        out: &mut [SectionLoads<Lanes>],
    ) -> Result<(), ResponseError> {
        let (of, law) = (&self.stations[station], law.at(station));
        if law.settled {
            of.air.settled_loads(flows, law, scratch, out);
            return Ok(());
        }
        of.loads(flows, law, scratch, out)
    }
}

/// Reusable arrays of one station.
#[derive(Debug, Default)]
pub(crate) struct AirScratch {
    pasts: Vec<SectionPast<Lanes>>,
    lags: LagScratch,
    fine: FineScratch,
}

/// Flows and loads of a station at its own points and at finer ones, each alone and side by side.
#[derive(Debug, Default)]
struct FineScratch {
    flows: Vec<SectionFlow>,
    finer: Vec<SectionFlow>,
    blocks: Vec<SectionFlow<Lanes>>,
    block_loads: Vec<SectionLoads<Lanes>>,
    finer_loads: Vec<SectionLoads>,
    loads: Vec<SectionLoads>,
}

/// How loads follow from the flow and its past.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadLaw<'a> {
    /// By lifting station.
    pub(crate) scales: &'a [AirScales],
    /// Lifting stations, counted from the first, from which on the tip takes the lift.
    pub(crate) lost_from: usize,
    pub(crate) lags: Lags<'a>,
}

/// How the states of the sections follow the flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Lags<'a> {
    /// Over the revolution.
    Followed,
    /// Settled on their inputs at the point: what the Newton matrix uses.
    Settled,
    /// Followed, the flows being changes of flows: loads are what the inputs of the flap change them by.
    OfFlapChange,
    /// From the instant before, by lifting station.
    Passing(&'a [LagSteps]),
}

impl<'a> LoadLaw<'a> {
    fn at(self, station: usize) -> StationLaw<'a> {
        let lost = station >= self.lost_from;
        let kind = match (lost, self.lags == Lags::OfFlapChange) {
            (false, false) => Kind::Whole,
            (false, true) => Kind::FlapSlope,
            (true, false) => Kind::DragAlone,
            (true, true) => Kind::Nothing,
        };
        let passing = match self.lags {
            Lags::Passing(steps) => Some(&steps[station]),
            _ => None,
        };
        let settled = self.lags == Lags::Settled;
        StationLaw { scales: self.scales[station], kind, settled, passing }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
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
struct StationLaw<'a> {
    scales: AirScales,
    kind: Kind,
    settled: bool,
    /// How the states have come from the instant before.
    passing: Option<&'a LagSteps>,
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
            StationAir::new(model, place, Some(collocation), points, &magnitudes)
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
        flows: &[SectionFlow<Lanes>],
        law: StationLaw<'_>,
        scratch: &mut AirScratch,
        out: &mut [SectionLoads<Lanes>],
    ) -> Result<(), ResponseError> {
        let Some(fine) = &self.fine else { return self.air.loads(flows, law, scratch, out) };
        let mut of = std::mem::take(&mut scratch.fine);
        of.flows.clear();
        of.flows.extend((0..self.air.points).map(|p| flows[p / LANES].lane(p % LANES)));
        fine.azimuth.flows(&of.flows, &mut of.finer);
        for (flow, rigid) in of.finer.iter_mut().zip(&fine.rigid_speeds) {
            flow.sense = sense(fine.reverse_flow, flow.u_t, flow.u_p, *rigid);
        }
        of.blocks.clear();
        of.blocks.extend(of.finer.chunks(LANES).map(SectionFlow::gather));
        of.block_loads.resize(of.blocks.len(), SectionLoads::default());
        let found = fine.air.loads(&of.blocks, law, scratch, &mut of.block_loads);
        of.finer_loads.clear();
        let finer = (0..of.finer.len()).map(|p| of.block_loads[p / LANES].lane(p % LANES));
        of.finer_loads.extend(finer);
        of.loads.resize(of.flows.len(), SectionLoads::default());
        fine.azimuth.loads(&of.finer_loads, &mut of.loads);
        for (out, loads) in out.iter_mut().zip(of.loads.chunks(LANES)) {
            *out = SectionLoads::gather(loads);
        }
        scratch.fine = of;
        found
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
        collocation: Option<&Collocation>,
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
        let count = coefficients.first().map_or(0, |c| c.lags.len());
        let channels = (0..count).map(|c| {
            let mut channel = SectionChannel::new(speeds, &coefficients, c, chord);
            channel.rigid &= !nonlinear.is_linear();
            channel
        });
        let channels = match collocation {
            None => Channels::Passing(channels.collect()),
            Some(collocation) => {
                let lags = channels.map(|channel| StationLag::new(collocation, channel));
                let lags = lags.collect::<Result<Vec<_>, ResponseError>>()?;
                let whole = StationLags::new(&lags, collocation.points());
                Channels::Round(lags, whole)
            }
        };
        let settled: Vec<Gains> = coefficients
            .iter()
            .map(|k| {
                let gain = |o: usize, i: usize| {
                    k.lags.iter().fold(0.0, |sum, lag| sum + lag.output[o] * lag.input[i])
                };
                std::array::from_fn(|o| std::array::from_fn(|i| gain(o, i)))
            })
            .collect();
        let direct: Vec<Gains> = coefficients.iter().map(|k| k.direct).collect();
        let mut rate: Vec<Gains> = coefficients.iter().map(|k| k.rate).collect();
        if rate.iter().flatten().flatten().all(|gain| *gain == 0.0) {
            rate.clear();
        }
        let tables = nonlinear.airfoils.as_ref().map(|airfoils| {
            let at = |((speed, c), settled): ((&f64, &Gains), &Gains)| {
                (tip_mach * speed, c[0][0] + settled[0][0])
            };
            let points = speeds.iter().zip(&direct).zip(&settled).map(at).collect();
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
        let has_waves = coefficients.first().is_some_and(SectionCoefficients::has_waves);
        let mut rates = in_lanes(&rate).into_iter();
        let prompt = in_lanes(&direct)
            .into_iter()
            .map(|direct| PromptCoefficients { direct, rate: rates.next(), has_waves })
            .collect();
        let (settled, points) = (in_lanes(&settled), points.len());
        Ok(Self { points, prompt, settled, channels, tables, stall })
    }
}

impl StationAir {
    /// Loads over a revolution, at the points of this station.
    fn loads(
        &self,
        flows: &[SectionFlow<Lanes>],
        law: StationLaw<'_>,
        scratch: &mut AirScratch,
        out: &mut [SectionLoads<Lanes>],
    ) -> Result<(), ResponseError> {
        let zero = Lanes::default();
        let still = |flow: &SectionFlow<Lanes>| {
            flow.input[2..] == [zero; 2] && flow.input_rate[2..] == [zero; 2]
        };
        if law.kind == Kind::FlapSlope && flows.iter().all(still) {
            out.fill(SectionLoads::default());
            return Ok(());
        }
        scratch.pasts.clear();
        scratch.pasts.resize(flows.len(), SectionPast::default());
        if let Kind::Whole | Kind::FlapSlope = law.kind {
            match (&self.channels, law.passing) {
                (Channels::Round(_, whole), _) => self.fill_pasts(whole, flows, scratch)?,
                (Channels::Passing(channels), Some(steps)) => {
                    steps.fill_pasts(channels, flows, &mut scratch.pasts);
                }
                (Channels::Passing(_), None) => {}
            }
        }
        Arch::new().dispatch(Loading { of: self, flows, pasts: &scratch.pasts, law, out });
        Ok(())
    }

    /// The same with every state settled on its input.
    fn settled_loads(
        &self,
        flows: &[SectionFlow<Lanes>],
        law: StationLaw<'_>,
        scratch: &mut AirScratch,
        out: &mut [SectionLoads<Lanes>],
    ) {
        scratch.pasts.clear();
        scratch.pasts.extend(flows.iter().enumerate().map(|(b, flow)| self.settled_past(b, flow)));
        Arch::new().dispatch(Loading { of: self, flows, pasts: &scratch.pasts, law, out });
    }

    #[inline(always)]
    fn loads_at(
        &self,
        block: usize,
        flow: &SectionFlow<Lanes>,
        past: &SectionPast<Lanes>,
        StationLaw { scales, kind, .. }: StationLaw<'_>,
    ) -> SectionLoads<Lanes> {
        let loads = match kind {
            Kind::Whole => self.whole_loads(block, scales, flow, past),
            Kind::FlapSlope => {
                let frictionless = AirScales { drag: 0.0, camber_moment: 0.0, ..scales };
                section_loads(frictionless, flow, &self.prompt[block], past)
            }
            Kind::DragAlone => {
                let SectionFlow { u_t, sense, .. } = *flow;
                let still = SectionFlow { u_t, sense, ..SectionFlow::default() };
                let past = SectionPast::default();
                let SectionLoads { fy, .. } = self.whole_loads(block, scales, &still, &past);
                SectionLoads { fy, ..SectionLoads::default() }
            }
            Kind::Nothing => SectionLoads::default(),
        };
        if scales.centre == 0.0 { loads } else { loads.about(scales.centre, flow.pitch) }
    }

    #[inline(always)]
    fn whole_loads(
        &self,
        block: usize,
        scales: AirScales,
        flow: &SectionFlow<Lanes>,
        past: &SectionPast<Lanes>,
    ) -> SectionLoads<Lanes> {
        if self.tables.is_none() && self.stall.is_none() {
            return section_loads(scales, flow, &self.prompt[block], past);
        }
        self.nonlinear_loads(block, scales, flow, past)
    }

    /// Loads over tables and with stall, lane by lane.
    fn nonlinear_loads(
        &self,
        block: usize,
        scales: AirScales,
        flows: &SectionFlow<Lanes>,
        pasts: &SectionPast<Lanes>,
    ) -> SectionLoads<Lanes> {
        let count = LANES.min(self.points - block * LANES);
        let loads: [SectionLoads; LANES] = std::array::from_fn(|k| {
            // lanes without a point take the loads of the last one
            let k = k.min(count - 1);
            let (flow, past) = (flows.lane(k), pasts.lane(k));
            let prompt = self.prompt[block].lane(k);
            let mut loads = match &self.tables {
                None => section_loads(scales, &flow, &prompt, &past),
                Some(tables) => tables.loads(block * LANES + k, scales, &flow, &prompt, &past),
            };
            if self.stall.is_some() {
                add_stall(scales, &flow, past.stall, &mut loads);
            }
            loads
        });
        SectionLoads::gather(&loads)
    }

    /// What the past adds to the loads at all points.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    fn fill_pasts(
        &self,
        whole: &StationLags,
        flows: &[SectionFlow<Lanes>],
        AirScratch { pasts, lags, .. }: &mut AirScratch,
    ) -> Result<(), ResponseError> {
        let write = |p: usize, output: usize, share: f64| {
            let past = &mut pasts[p / LANES];
            let row = match output {
                RIGID_LIFT => &mut past.rigid_lift,
                CIRCULATORY_LIFT => &mut past.circulatory_lift,
                _ => &mut past.lag[output],
            };
            row.0[p % LANES] = share;
        };
        whole.outputs(|p, input| flows[p / LANES].input[input].0[p % LANES], lags, write);
        let Some(stall) = &self.stall else { return Ok(()) };
        let at = |p: usize| (p / LANES, p % LANES);
        let mut alone: Vec<SectionPast> =
            (0..self.points).map(at).map(|(block, k)| pasts[block].lane(k)).collect();
        let drive = |p: usize| {
            let (block, k) = at(p);
            (flows[block].lane(k), self.prompt[block].lane(k))
        };
        stall.fill(drive, &mut alone)?;
        for (past, alone) in pasts.iter_mut().zip(alone.chunks(LANES)) {
            past.stall = std::array::from_fn(|c| gathered(alone, |of| of.stall[c]));
        }
        Ok(())
    }

    /// The same with every state settled on its input, for one block of points.
    fn settled_past(&self, block: usize, flow: &SectionFlow<Lanes>) -> SectionPast<Lanes> {
        let gains = &self.settled[block];
        let [normal, rate, ..] = gains[0];
        let lag = gains.each_ref().map(|row| dot(row, &flow.input));
        let mut past = SectionPast {
            lag,
            rigid_lift: normal * flow.input[0] + rate * flow.input[1],
            // waves have passed
            circulatory_lift: lag[0] + dot(&self.prompt[block].direct[0], &flow.input),
            ..SectionPast::default()
        };
        if let Some(stall) = &self.stall {
            let points = LANES.min(self.points - block * LANES);
            let added: Vec<[f64; 3]> = (0..points)
                .map(|k| {
                    let prompt = self.prompt[block].lane(k);
                    stall.settled(block * LANES + k, &flow.lane(k), &prompt, &past.lane(k))
                })
                .collect();
            past.stall = std::array::from_fn(|c| gathered(&added, |of| of[c]));
        }
        past
    }
}

/// Loads of a station from its flows and their past: a type of its own, for a closure would be called, not inlined, by
/// the function that is compiled for the vector unit.
struct Loading<'a> {
    of: &'a StationAir,
    flows: &'a [SectionFlow<Lanes>],
    pasts: &'a [SectionPast<Lanes>],
    law: StationLaw<'a>,
    out: &'a mut [SectionLoads<Lanes>],
}

impl WithSimd for Loading<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let blocks = self.out.iter_mut().zip(self.flows).zip(self.pasts).enumerate();
        for (block, ((loads, flow), past)) in blocks {
            *loads = self.of.loads_at(block, flow, past, self.law);
        }
    }
}
