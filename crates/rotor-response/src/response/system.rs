//! The aeroelastic blade as a periodic system for the time elements.

use crate::ResponseError;
use crate::model::flap_inertia::FlapSection;
use crate::sections::air::{
    AirPoint, FlapAngle, SectionAxes, SectionFlow, SectionLoads, section_flow,
};
use crate::sections::flight_air::{FlightAir, LoadLaw, POINTS_TOGETHER};
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{BladeState, Equations, SpanLoads, StructureScratch};
use crate::structure::motion::Motion;
use crate::{Couplings, FlapMass};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_fem::{LocalTangent, OrbitMemory, OrbitSamples, PeriodicSystem};

/// Step of the one-sided differences of the Newton matrix. Only the speed of convergence depends on
/// it, never the solution.
const TANGENT_STEP: f64 = 1e-6;

/// What the air and the pilot do at one azimuth point.
#[derive(Debug, Clone)]
pub(crate) struct PointInput {
    pub(crate) air: AirPoint,
    /// Total inflow at the lifting stations, tip speed, down positive.
    pub(crate) inflow: Vec<f64>,
    /// Angle, rate and acceleration of each flap, rad.
    pub(crate) flap: Vec<FlapAngle>,
    /// Acceleration of gravity in the axes of the coned blade, `Omega^2 R`.
    pub(crate) gravity: [f64; 3],
}

/// One blade in one flight condition.
#[derive(Debug)]
pub(crate) struct ResponseSystem<'a> {
    pub(crate) blade: &'a ResponseBlade,
    pub(crate) couplings: Couplings,
    pub(crate) air: &'a FlightAir,
    pub(crate) points: Vec<PointInput>,
    /// Damping of the modes and of the lag damper.
    pub(crate) damping: &'a DMatrix<f64>,
    pub(crate) mass: &'a DMatrix<f64>,
}

/// Motion and air loads at every point of the revolution.
#[derive(Debug)]
pub(crate) struct Revolution {
    /// By point.
    pub(crate) motions: Vec<Motion>,
    /// Aerodynamic section loads, by point and lifting station.
    pub(crate) sections: Vec<Vec<SectionLoads>>,
}

/// Reusable arrays of one evaluation.
#[derive(Debug, Default)]
struct Scratch {
    structure: StructureScratch,
    loads: SpanLoads,
}

impl ResponseSystem<'_> {
    /// Flow at every lifting station for the motion held in `motion`.
    pub(crate) fn flows(&self, point: usize, motion: &Motion) -> Vec<SectionFlow> {
        let input = &self.points[point];
        let first = self.air.first_station;
        input
            .inflow
            .iter()
            .enumerate()
            .map(|(s, &lambda)| {
                let station = first + s;
                let delta =
                    self.blade.flap_index[station].map_or([0.0; 3], |flap| input.flap[flap]);
                let at = (station, lambda);
                section_flow(self.blade, motion, &input.air, at, delta)
            })
            .collect()
    }

    /// Motion and air loads over the whole revolution.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`].
    pub(crate) fn revolution(&self, samples: &OrbitSamples) -> Result<Revolution, ResponseError> {
        let at = |p: usize| {
            let motion = self.motion(samples, p);
            let flows = self.flows(p, &motion);
            (motion, flows)
        };
        let points = (0..self.points.len()).into_par_iter().with_min_len(POINTS_TOGETHER);
        let (motions, flows): (Vec<Motion>, Vec<Vec<SectionFlow>>) = points.map(at).unzip();
        let sections = self.air.loads(&flows, self.load_law(false))?;
        Ok(Revolution { motions, sections })
    }

    /// The residual at every point of a revolution whose motion and air loads are known.
    pub(crate) fn residual_of(
        &self,
        revolution: &Revolution,
        samples: &OrbitSamples,
        out: &mut DMatrix<f64>,
    ) {
        self.by_point(out, |scratch, p, column| {
            let (motion, sections) = (&revolution.motions[p], &revolution.sections[p]);
            self.span_loads(p, motion, sections, &mut scratch.loads);
            self.project(p, motion, samples.at(p), scratch, column);
        });
    }

    /// Lets `write` fill the column of every point.
    fn by_point(
        &self,
        out: &mut DMatrix<f64>,
        write: impl Fn(&mut Scratch, usize, &mut [f64]) + Sync,
    ) {
        let columns = out.as_mut_slice().par_chunks_mut(self.dof()).with_min_len(POINTS_TOGETHER);
        columns
            .enumerate()
            .for_each_init(Scratch::default, |scratch, (p, column)| write(scratch, p, column));
    }

    /// Motion of the blade at one point.
    pub(crate) fn motion(&self, samples: &OrbitSamples, point: usize) -> Motion {
        let mut motion = Motion::default();
        motion.fill(self.blade, samples.at(point));
        motion
    }

    /// How section loads follow from flows, or with `changes` from what a flap changes them by.
    pub(crate) fn load_law(&self, changes: bool) -> LoadLaw<'_> {
        let lifting = &self.blade.grid.x()[self.air.first_station..];
        let lost_from = lifting.partition_point(|x| *x <= self.blade.tip_loss);
        LoadLaw { scales: &self.blade.air[self.air.first_station..], lost_from, changes }
    }

    /// Motion of the section at a station that carries flap `k`, and of the flap.
    pub(crate) fn flap_section(
        &self,
        point: usize,
        motion: &Motion,
        i: usize,
        k: usize,
    ) -> FlapSection {
        let (v, w, phi) = (&motion.v, &motion.w, &motion.phi);
        let pitch = self.points[point].air.pitch;
        FlapSection {
            x: self.blade.grid.x()[i],
            precone: self.blade.precone,
            v: [v.value[i] + self.blade.offsets.torque, v.rate[i], v.acceleration[i]],
            v_x: [v.slope[i], v.slope_rate[i], v.slope_acceleration[i]],
            w: [w.value[i], w.rate[i], w.acceleration[i]],
            w_x: [w.slope[i], w.slope_rate[i], w.slope_acceleration[i]],
            twist: [
                pitch.angle_rad + self.blade.twist[i] + phi.value[i],
                pitch.rate + phi.rate[i],
                pitch.acceleration + phi.acceleration[i],
            ],
            delta: self.points[point].flap[k],
        }
    }

    /// Aerodynamic loads plus the inertial loads of the flaps, at all stations.
    ///
    /// ```text
    /// F_z += m_f X_f delta''     M += -(m_f (d + X_f) X_f + I_cg) delta'' - m_f (d + X_f) X_f delta
    /// ```
    /// Of a flap that is part of the blade only what its angle adds, in this first-order form; of one
    /// that weighs beside it all loads of its distance from the elastic axis.
    pub(crate) fn span_loads(
        &self,
        point: usize,
        motion: &Motion,
        sections: &[SectionLoads],
        out: &mut SpanLoads,
    ) {
        out.clear(self.blade.grid.len());
        out.gravity = self.points[point].gravity;
        let first = self.air.first_station;
        for (s, load) in sections.iter().enumerate() {
            let axes = SectionAxes::of(self.blade, motion, first + s);
            [out.fy[first + s], out.fz[first + s]] = axes.force(load);
            out.moment[first + s] = load.moment;
        }
        let [_, y, z] = out.gravity;
        for (i, centre) in self.blade.mass_centre.iter().enumerate() {
            if *centre != 0.0 {
                let twist = self.points[point].air.pitch.angle_rad + self.blade.twist[i];
                let (sin, cos) = (twist + motion.phi.value[i]).sin_cos();
                let arm = self.blade.section_mass[i] * centre;
                out.moment[i] += arm * (cos * z - sin * y);
            }
        }
        for (i, flap) in self.blade.flap_index.iter().enumerate() {
            let (Some(k), Some(inertia)) = (*flap, self.blade.flap_inertia[i]) else { continue };
            match inertia.mass {
                FlapMass::PartOfBlade => {
                    let [delta, _, acceleration] = self.points[point].flap[k];
                    out.fz[i] += inertia.first_moment * acceleration;
                    out.moment[i] -= (inertia.arm_moment + inertia.own) * acceleration
                        + inertia.arm_moment * delta;
                }
                FlapMass::AddedToBlade => {
                    let section = self.flap_section(point, motion, i, k);
                    let loads = inertia.body.loads_off_axis(&section);
                    out.axial[i] += loads.force[0];
                    out.fy[i] += loads.force[1];
                    out.fz[i] += loads.force[2];
                    out.moment[i] += loads.twist;
                    out.slope[0][i] += loads.slope[0];
                    out.slope[1][i] += loads.slope[1];
                }
            }
        }
    }

    /// Generalised residual of one point, without the constant mass part.
    fn project(
        &self,
        point: usize,
        motion: &Motion,
        coordinates: [&[f64]; 3],
        scratch: &mut Scratch,
        out: &mut [f64],
    ) {
        let Scratch { structure, loads } = scratch;
        let pitch = self.points[point].air.pitch;
        let state = BladeState { motion, pitch, loads };
        let equations = Equations { blade: self.blade, couplings: self.couplings, mass: self.mass };
        equations.residual(state, coordinates, structure, out);
        for (o, row) in out.iter_mut().zip(self.damping.row_iter()) {
            *o += row.iter().zip(coordinates[1]).map(|(d, rate)| d * rate).sum::<f64>();
        }
    }

    /// Residual of one point with settled lag states, for the Newton matrix.
    fn settled_residual(
        &self,
        point: usize,
        coordinates: [&[f64]; 3],
        motion: &mut Motion,
        scratch: &mut Scratch,
    ) -> Vec<f64> {
        motion.fill(self.blade, coordinates);
        let flows = self.flows(point, motion);
        let sections = self.air.settled_loads(point, &flows, self.load_law(false));
        self.span_loads(point, motion, &sections, &mut scratch.loads);
        let mut out = vec![0.0; self.dof()];
        self.project(point, motion, coordinates, scratch, &mut out);
        out
    }

    fn tangent(&self, samples: &OrbitSamples, point: usize) -> LocalTangent {
        let n = self.dof();
        let state = samples.at(point);
        let (mut motion, mut scratch) = (Motion::default(), Scratch::default());
        let mut settled = |coordinates: [&[f64]; 3]| {
            self.settled_residual(point, coordinates, &mut motion, &mut scratch)
        };
        let base = settled(state);
        let mut derivatives = [0, 1, 2].map(|_| DMatrix::zeros(n, n));
        for (which, matrix) in derivatives.iter_mut().enumerate() {
            for j in 0..n {
                let mut moved = state[which].to_vec();
                moved[j] += TANGENT_STEP;
                let mut coordinates = state;
                coordinates[which] = &moved;
                let value = settled(coordinates);
                for i in 0..n {
                    matrix[(i, j)] = (value[i] - base[i]) / TANGENT_STEP;
                }
            }
        }
        let [dq, dqd, dqdd] = derivatives;
        LocalTangent { dq, dqd, dqdd }
    }
}

impl PeriodicSystem for ResponseSystem<'_> {
    type Error = ResponseError;
    type Seen = Revolution;

    fn dof(&self) -> usize {
        self.mass.nrows()
    }

    fn mass(&self) -> &DMatrix<f64> {
        self.mass
    }

    fn residual(
        &self,
        samples: &OrbitSamples,
        out: &mut DMatrix<f64>,
    ) -> Result<Revolution, Self::Error> {
        let revolution = self.revolution(samples)?;
        self.residual_of(&revolution, samples, out);
        Ok(revolution)
    }

    fn tangents(&self, samples: &OrbitSamples) -> Result<Vec<LocalTangent>, Self::Error> {
        Ok((0..self.points.len()).into_par_iter().map(|p| self.tangent(samples, p)).collect())
    }

    fn memory(&self, samples: &OrbitSamples) -> Result<Option<OrbitMemory>, Self::Error> {
        Ok(self.lag_memory(samples))
    }
}

impl ResponseSystem<'_> {
    /// What the residual is without loads of the air and of the flaps.
    pub(crate) fn unloaded(&self, samples: &OrbitSamples) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.dof(), self.points.len());
        self.by_point(&mut out, |scratch, p, bare| {
            scratch.loads.clear(self.blade.grid.len());
            self.project(p, &self.motion(samples, p), samples.at(p), scratch, bare);
        });
        out
    }

    /// Slope of the residual along a motion of the flaps given at every point, the motion of the blade
    /// held, in closed form:
    ///
    /// ```text
    /// dw = [0, 0, U_T d delta, c d delta'],   dx/dt = (|U|/b) pole (input . dw - x)
    /// dF = (1/2) rho c [ |U| (direct dw + sum output x) + b rate dw/dt ] + inertia of the flaps
    /// dR = R(dF) - R(0)
    /// ```
    /// the slopes of the section loads carried along the flow, whose lags the operator that is kept for
    /// them makes periodic; the residual is linear in its loads, and `bare` is [`unloaded`](Self::unloaded).
    ///
    /// `None` where the loads are not linear in the flap: sections that stall dynamically, flaps that
    /// weigh beside the blade.
    ///
    /// # Errors
    /// None that [`revolution`](Self::revolution) does not have.
    pub(crate) fn flap_slope(
        &self,
        samples: &OrbitSamples,
        bare: &DMatrix<f64>,
        flaps: &[Vec<FlapAngle>],
    ) -> Result<Option<DMatrix<f64>>, ResponseError> {
        if self.air.stalls() || self.blade.flaps_beside_blade() {
            return Ok(None);
        }
        let along = |(point, flap): (&PointInput, &Vec<FlapAngle>)| PointInput {
            flap: flap.clone(),
            // the weight does not change with the flaps
            gravity: [0.0; 3],
            ..point.clone()
        };
        let along =
            ResponseSystem { points: self.points.iter().zip(flaps).map(along).collect(), ..*self };
        let changed = |p: usize| {
            let motion = along.motion(samples, p);
            // the inputs of the flap are linear in its motion: along the direction they are their changes
            let mut changes = along.flows(p, &motion);
            for flow in &mut changes {
                flow.input[..2].fill(0.0);
                flow.input_rate[..2].fill(0.0);
            }
            (motion, changes)
        };
        let points = (0..self.points.len()).into_par_iter().with_min_len(POINTS_TOGETHER);
        let (motions, flows): (Vec<Motion>, Vec<Vec<SectionFlow>>) = points.map(changed).unzip();
        let sections = self.air.loads(&flows, self.load_law(true))?;
        let mut out = DMatrix::zeros(self.dof(), self.points.len());
        self.by_point(&mut out, |scratch, p, slope| {
            along.span_loads(p, &motions[p], &sections[p], &mut scratch.loads);
            self.project(p, &motions[p], samples.at(p), scratch, slope);
            for (slope, bare) in slope.iter_mut().zip(&bare.column(p)) {
                *slope -= bare;
            }
        });
        Ok(Some(out))
    }
}
