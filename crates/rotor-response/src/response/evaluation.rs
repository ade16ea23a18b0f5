//! The residual of a revolution, station by station: motion, flow, lags, loads and what they do on the modes, all
//! azimuth points side by side, so that what a station needs stays close together.

use crate::ResponseError;
use crate::response::evaluated::{Revolution, StationWork, Work};
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionLoads;
use crate::sections::flight_air::{Lags, LoadLaw, POINTS_TOGETHER};
use crate::structure::equations::{BladeState, Equations, SpanLoads, StationLoad};
use crate::structure::motion::{Foreshortening, ModalRows, Motion};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_fem::{ModalBlade, OrbitSamples, PeriodicSystem};

/// Stations that one thread takes together; their sum does not depend on the number of threads.
const STATIONS_TOGETHER: usize = 16;

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
        lags: Option<Lags>,
        work: &mut Work,
        out: Option<&mut DMatrix<f64>>,
    ) -> Result<Revolution, ResponseError> {
        let (blade, points) = (self.blade, self.points.len());
        let Work { rows, foreshortening, together } = work;
        rows.fill(samples);
        foreshortening.fill(blade, self.couplings, rows);
        let stations = blade.grid.len();
        let mut sections = vec![SectionLoads::default(); stations * points];
        together.resize_with(stations.div_ceil(STATIONS_TOGETHER), StationWork::default);
        let law = lags.map(|lags| LoadLaw { lags, ..self.load_law() });
        let summed = out.is_some() && blade.modal.is_none();
        let shared = (&*rows, &*foreshortening);
        let parts =
            together.par_iter_mut().zip(sections.par_chunks_mut(STATIONS_TOGETHER * points));
        let found: Vec<Result<(), ResponseError>> = parts
            .enumerate()
            .map(|(part, (own, sections))| {
                let first = part * STATIONS_TOGETHER;
                own.residual.clear();
                own.residual.resize(if summed { self.dof() * points } else { 0 }, 0.0);
                let mut sections = sections.chunks_exact_mut(points).enumerate();
                sections
                    .try_for_each(|(k, loads)| self.at_station(first + k, law, shared, own, loads))
            })
            .collect();
        found.into_iter().collect::<Result<(), ResponseError>>()?;
        let revolution = Revolution { first_station: self.air.first_station, points, sections };
        match (out, &blade.modal) {
            (Some(out), None) => {
                gather(together, out);
                out.gemm(1.0, &blade.root_spring, &samples.q, 1.0);
                out.gemm(1.0, self.damping, &samples.qd, 1.0);
            }
            (Some(out), Some(modal)) => {
                self.by_point(modal, samples, law.map(|_| &revolution), out);
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
        loads: &mut [SectionLoads],
    ) -> Result<(), ResponseError> {
        let StationWork { motion, flows, air, forces, residual } = own;
        let lifting = law.zip(i.checked_sub(self.air.first_station));
        if lifting.is_none() && residual.is_empty() {
            return Ok(());
        }
        motion.fill_station(self.blade, i, rows, foreshortening);
        let motion = &*motion;
        if let Some((law, station)) = lifting {
            flows.clear();
            flows.extend((0..loads.len()).map(|p| self.flow(p, i, (motion, p))));
            if law.lags == Lags::OfFlapChange {
                // the inputs of the flap are linear in its motion: along the direction they are their changes
                for flow in flows.iter_mut() {
                    flow.input[..2].fill(0.0);
                    flow.input_rate[..2].fill(0.0);
                }
            }
            self.air.loads(station, flows, law, air, loads)?;
        }
        if residual.is_empty() {
            return Ok(());
        }
        let (blade, couplings, mass) = (self.blade, self.couplings, self.mass);
        let at = |p: usize| {
            let load = match law {
                Some(_) => self.station_load(p, i, (motion, p), &loads[p]),
                None => StationLoad::default(),
            };
            (self.points[p].air.pitch, load)
        };
        let equations = Equations { blade, couplings, mass };
        equations.add_station(i, motion, (rows, foreshortening), at, (forces, residual));
        Ok(())
    }

    /// Residual of the moderately deflected blade, point by point.
    fn by_point(
        &self,
        modal: &ModalBlade,
        samples: &OrbitSamples,
        revolution: Option<&Revolution>,
        out: &mut DMatrix<f64>,
    ) {
        let equations = Equations { blade: self.blade, couplings: self.couplings, mass: self.mass };
        let columns = out.as_mut_slice().par_chunks_mut(self.dof()).with_min_len(POINTS_TOGETHER);
        let scratch = || (Motion::default(), SpanLoads::default(), Vec::new());
        columns.enumerate().for_each_init(scratch, |(motion, loads, sections), (p, column)| {
            motion.fill(self.blade, samples.at(p));
            loads.clear(self.blade.grid.len());
            if let Some(revolution) = revolution {
                sections.clear();
                sections.extend(revolution.at(p).copied());
                self.span_loads(p, motion, sections, loads);
            }
            let pitch = self.points[p].air.pitch;
            let state = BladeState { motion, pitch, loads };
            equations.moderate_residual(modal, state, samples.at(p), column);
        });
        out.gemm(1.0, self.damping, &samples.qd, 1.0);
    }
}

/// The residual of all stations, their parts added in order.
fn gather(together: &[StationWork], out: &mut DMatrix<f64>) {
    let (dof, points) = out.shape();
    for (p, column) in out.as_mut_slice().chunks_exact_mut(dof).enumerate() {
        for (j, value) in column.iter_mut().enumerate() {
            *value = together.iter().map(|part| part.residual[j * points + p]).sum();
        }
    }
}
