//! The residual of a revolution, station by station: motion, flow, lags, loads and what they do on the modes, all
//! azimuth points side by side, so that what a station needs stays close together.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::ResponseError;
use crate::response::evaluated::{Revolution, StationWork, Work};
use crate::response::system::ResponseSystem;
use crate::sections::air::{SectionFlow, SectionLoads};
use crate::sections::flight_air::{Lags, LoadLaw};
use crate::structure::equations::{Applied, AppliedLoad, BlockLoad, Equations, StationLoad};
use crate::structure::motion::{Foreshortening, ModalRows, Motion};
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use rotor_base::{LANES, Lanes};
use rotor_fem::{ModalBlade, OrbitSamples, PeriodicSystem, PitchMotion};

/// Stations that one thread takes together; their sum does not depend on the number of threads.
const STATIONS_TOGETHER: usize = 16;
/// Blocks of points that one thread takes together.
const BLOCKS_TOGETHER: usize = 4;

impl ResponseSystem<'_> {
    /// Air loads over the whole revolution.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn revolution(&self, samples: &OrbitSamples) -> Result<Revolution, ResponseError> {
        self.evaluate(samples, Some(Lags::Followed), &mut Work::default(), None)
    }

    /// Air loads and, if asked for, the residual without the constant mass part; without lags there are no loads of air,
    /// flaps and weight.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn evaluate(
        &self,
        samples: &OrbitSamples,
        lags: Option<Lags<'_>>,
        work: &mut Work,
        out: Option<&mut DMatrix<f64>>,
    ) -> Result<Revolution, ResponseError> {
        let (blade, points) = (self.blade, self.points.len());
        let Work { rows, foreshortening, sections, together } = work;
        rows.fill(samples);
        foreshortening.fill(blade, self.couplings, rows);
        let stations = blade.grid.len();
        let (blocks, lanes) = (self.blocks.len(), rows.lanes());
        let mut sections = std::mem::take(sections);
        sections.clear();
        sections.resize(stations * blocks, SectionLoads::default());
        together.resize_with(stations.div_ceil(STATIONS_TOGETHER), StationWork::default);
        let law = lags.map(|lags| LoadLaw { lags, ..self.load_law() });
        let summed = out.is_some() && blade.modal.is_none();
        let applied = out.is_some() && blade.modal.is_some();
        let shared = (&*rows, &*foreshortening);
        let parts =
            together.par_iter_mut().zip(sections.par_chunks_mut(STATIONS_TOGETHER * blocks));
        let refused = parts
            .enumerate()
            .map(|(part, (own, sections))| {
                let first = part * STATIONS_TOGETHER;
                own.residual.clear();
                own.residual.resize(if summed { self.dof() * lanes } else { 0 }, 0.0);
                own.applied.clear();
                let mut sections = sections.chunks_exact_mut(blocks).enumerate();
                sections.try_for_each(|(k, loads)| {
                    let applied = if applied { blocks } else { 0 };
                    own.applied.resize(own.applied.len() + applied, AppliedLoad::default());
                    self.at_station(first + k, law, shared, own, loads)
                })
            })
            .find_map_first(Result::err);
        if let Some(error) = refused {
            return Err(error);
        }
        let revolution = Revolution { first_station: self.air.first_station, points, sections };
        match (out, &blade.modal) {
            (Some(out), None) => {
                gather(together, lanes, out);
                out.gemm(1.0, &blade.root_spring, &samples.q, 1.0);
                out.gemm(1.0, self.damping, &samples.qd, 1.0);
            }
            (Some(out), Some(modal)) => {
                self.by_block(modal, rows, together, out);
                out.gemm(1.0, self.damping, &samples.qd, 1.0);
            }
            (None, _) => {}
        }
        Ok(revolution)
    }

    /// Loads of one station at all points, and what it does on the modes if its sum has a place.
    fn at_station(
        &self,
        i: usize,
        law: Option<LoadLaw<'_>>,
        (rows, foreshortening): (&ModalRows, &Foreshortening),
        own: &mut StationWork,
        loads: &mut [SectionLoads<Lanes>],
    ) -> Result<(), ResponseError> {
        let StationWork { motion, flows, air, forces, residual, applied } = own;
        let lifting = law.zip(i.checked_sub(self.air.first_station));
        if lifting.is_none() && residual.is_empty() && applied.is_empty() {
            return Ok(());
        }
        motion.fill_station(self.blade, i, rows, foreshortening);
        let motion = &*motion;
        if let Some((law, station)) = lifting {
            Arch::new().dispatch(Flows { system: self, i, motion, out: flows });
            if law.lags == Lags::OfFlapChange {
                // the inputs of the flap are linear in its motion: along the direction they are their changes
                for flow in flows.iter_mut() {
                    flow.input[..2].fill(Lanes::default());
                    flow.input_rate[..2].fill(Lanes::default());
                }
            }
            self.air.loads(station, flows, law, air, loads)?;
        }
        let (blade, couplings, mass) = (self.blade, self.couplings, self.mass);
        let at = Loaded { system: self, i, motion, loads: law.is_some().then_some(&*loads) };
        if !applied.is_empty() {
            let last = applied.len() - self.blocks.len();
            let out = &mut applied[last..];
            Arch::new().dispatch(Applied { blade, i, motion, at, out });
            return Ok(());
        }
        if residual.is_empty() {
            return Ok(());
        }
        let equations = Equations { blade, couplings, mass };
        equations.add_station(i, motion, (rows, foreshortening), at, (forces, residual));
        Ok(())
    }

    /// Residual of the moderately deflected blade without damping, block by block of points.
    fn by_block(
        &self,
        modal: &ModalBlade,
        rows: &ModalRows,
        together: &[StationWork],
        out: &mut DMatrix<f64>,
    ) {
        let equations = Equations { blade: self.blade, couplings: self.couplings, mass: self.mass };
        let (dof, blocks) = (self.dof(), self.blocks.len());
        let columns = out.as_mut_slice().par_chunks_mut(dof * LANES);
        columns.with_min_len(BLOCKS_TOGETHER).enumerate().for_each(|(block, columns)| {
            let stations = together.iter().flat_map(|part| part.applied.chunks_exact(blocks));
            let loads: Vec<AppliedLoad> = stations.map(|station| station[block]).collect();
            let pitch = self.blocks[block].air.pitch;
            let left = equations.moderate_residual(modal, (rows, block), pitch, &loads);
            for (lane, column) in columns.chunks_exact_mut(dof).enumerate() {
                for (value, left) in column.iter_mut().zip(&left) {
                    *value = left.0[lane];
                }
            }
        });
    }
}

/// Flows of a station in all blocks of points: a type of its own, for a closure would be called, not inlined, by the
/// function that is compiled for the vector unit.
struct Flows<'a> {
    system: &'a ResponseSystem<'a>,
    i: usize,
    motion: &'a Motion,
    out: &'a mut Vec<SectionFlow<Lanes>>,
}

impl WithSimd for Flows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { system, i, motion, out } = self;
        out.resize(system.blocks.len(), SectionFlow::default());
        for (block, (flow, input)) in out.iter_mut().zip(&system.blocks).enumerate() {
            *flow = system.flow(input, i, (motion, block));
        }
    }
}

/// Pitch and loads of a station: none without loads of the air.
struct Loaded<'a> {
    system: &'a ResponseSystem<'a>,
    i: usize,
    motion: &'a Motion,
    loads: Option<&'a [SectionLoads<Lanes>]>,
}

impl BlockLoad for Loaded<'_> {
    #[inline(always)]
    fn at(&self, block: usize) -> (PitchMotion<Lanes>, StationLoad<Lanes>) {
        let Self { system, i, motion, loads } = *self;
        let input = &system.blocks[block];
        let mut load = StationLoad::default();
        if let Some(loads) = loads {
            load = system.station_load(input, i, (motion, block), &loads[block]);
            if system.blade.flaps_beside_blade() {
                self.add_heavy_flaps(block, &mut load);
            }
        }
        (input.air.pitch, load)
    }
}

impl Loaded<'_> {
    /// Adds what flaps that weigh beside the blade do, lane by lane.
    fn add_heavy_flaps(&self, block: usize, load: &mut StationLoad<Lanes>) {
        let points = self.system.points.len();
        for (k, point) in (block * LANES..points).take(LANES).enumerate() {
            if let Some(flap) = self.system.heavy_flap_load(point, self.i, (self.motion, point)) {
                load.axial.0[k] += flap.axial;
                load.fy.0[k] += flap.fy;
                load.fz.0[k] += flap.fz;
                load.moment.0[k] += flap.moment;
                for (slope, more) in load.slope.iter_mut().zip(flap.slope) {
                    slope.0[k] += more;
                }
            }
        }
    }
}

/// The residual of all stations, their parts added in order.
fn gather(together: &[StationWork], lanes: usize, out: &mut DMatrix<f64>) {
    let dof = out.nrows();
    for (p, column) in out.as_mut_slice().chunks_exact_mut(dof).enumerate() {
        for (j, value) in column.iter_mut().enumerate() {
            *value = together.iter().map(|part| part.residual[j * lanes + p]).sum();
        }
    }
}
