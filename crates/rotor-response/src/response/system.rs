//! The aeroelastic blade as a periodic system for the time elements.

use crate::ResponseError;
use crate::model::flap_inertia::FlapSection;
use crate::response::evaluated::{Revolution, Work};
use crate::sections::air::{
    AirPoint, FlapAngle, SectionAxes, SectionFlow, SectionLoads, section_flow,
};
use crate::sections::flight_air::{FlightAir, Lags, LoadLaw};
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{SpanLoads, StationLoad};
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

impl ResponseSystem<'_> {
    /// Flow at every lifting station for the motion held in `motion`.
    pub(crate) fn flows(&self, point: usize, motion: &Motion) -> Vec<SectionFlow> {
        let first = self.air.first_station;
        (first..first + self.air.stations()).map(|i| self.flow(point, i, (motion, i))).collect()
    }

    /// Flow at a lifting station, whose motion stands in a lane.
    #[inline]
    pub(crate) fn flow(&self, point: usize, i: usize, motion: (&Motion, usize)) -> SectionFlow {
        let input = &self.points[point];
        let delta = self.blade.flap_index[i].map_or([0.0; 3], |flap| input.flap[flap]);
        let lambda = input.inflow[i - self.air.first_station];
        section_flow(self.blade, motion, &input.air, (i, lambda), delta)
    }

    /// Motion of the blade at one point.
    pub(crate) fn motion(&self, samples: &OrbitSamples, point: usize) -> Motion {
        let mut motion = Motion::default();
        motion.fill(self.blade, samples.at(point));
        motion
    }

    /// How section loads follow from flows.
    pub(crate) fn load_law(&self) -> LoadLaw<'_> {
        let lifting = &self.blade.grid.x()[self.air.first_station..];
        let lost_from = lifting.partition_point(|x| *x <= self.blade.tip_loss);
        LoadLaw {
            scales: &self.blade.air[self.air.first_station..],
            lost_from,
            lags: Lags::Followed,
        }
    }

    /// Motion of the section at a station that carries flap `k`, and of the flap; the motion stands in a lane.
    pub(crate) fn flap_section(
        &self,
        point: usize,
        (motion, lane): (&Motion, usize),
        i: usize,
        k: usize,
    ) -> FlapSection {
        let (v, w, phi) = (&motion.v, &motion.w, &motion.phi);
        let pitch = self.points[point].air.pitch;
        FlapSection {
            x: self.blade.grid.x()[i],
            precone: self.blade.precone,
            v: [v.value[lane] + self.blade.offsets.torque, v.rate[lane], v.acceleration[lane]],
            v_x: [v.slope[lane], v.slope_rate[lane], v.slope_acceleration[lane]],
            w: [w.value[lane], w.rate[lane], w.acceleration[lane]],
            w_x: [w.slope[lane], w.slope_rate[lane], w.slope_acceleration[lane]],
            twist: [
                pitch.angle_rad + self.blade.twist[i] + phi.value[lane],
                pitch.rate + phi.rate[lane],
                pitch.acceleration + phi.acceleration[lane],
            ],
            delta: self.points[point].flap[k],
        }
    }

    /// Aerodynamic loads plus the inertial loads of the flaps, at all stations.
    pub(crate) fn span_loads(
        &self,
        point: usize,
        motion: &Motion,
        sections: &[SectionLoads],
        out: &mut SpanLoads,
    ) {
        out.clear(self.blade.grid.len());
        out.gravity = self.points[point].gravity;
        let still = SectionLoads::default();
        for i in 0..self.blade.grid.len() {
            let section = i.checked_sub(self.air.first_station).and_then(|s| sections.get(s));
            out.set(i, &self.station_load(point, i, (motion, i), section.unwrap_or(&still)));
        }
    }

    /// The same at one station, whose motion stands in a lane.
    ///
    /// ```text
    /// F_z += m_f X_f delta''     M += -(m_f (d + X_f) X_f + I_cg) delta'' - m_f (d + X_f) X_f delta
    /// ```
    /// Of a flap that is part of the blade only what its angle adds, in this first-order form; of one
    /// that weighs beside it all loads of its distance from the elastic axis.
    #[inline]
    pub(crate) fn station_load(
        &self,
        point: usize,
        i: usize,
        (motion, lane): (&Motion, usize),
        section: &SectionLoads,
    ) -> StationLoad {
        let (blade, input) = (self.blade, &self.points[point]);
        let [fy, fz] = SectionAxes::of(blade, motion, lane).force(section);
        let (moment, gravity) = (section.moment, input.gravity);
        let mut load = StationLoad { fy, fz, moment, gravity, ..StationLoad::default() };
        let centre = blade.mass_centre[i];
        if centre != 0.0 {
            let twist = input.air.pitch.angle_rad + blade.twist[i];
            let (sin, cos) = (twist + motion.phi.value[lane]).sin_cos();
            let [_, y, z] = gravity;
            load.moment += blade.section_mass[i] * centre * (cos * z - sin * y);
        }
        let (Some(k), Some(inertia)) = (blade.flap_index[i], blade.flap_inertia[i]) else {
            return load;
        };
        match inertia.mass {
            FlapMass::PartOfBlade => {
                let [delta, _, acceleration] = input.flap[k];
                load.fz += inertia.first_moment * acceleration;
                load.moment -=
                    (inertia.arm_moment + inertia.own) * acceleration + inertia.arm_moment * delta;
            }
            FlapMass::AddedToBlade => {
                let section = self.flap_section(point, (motion, lane), i, k);
                let loads = inertia.body.loads_off_axis(&section);
                load.axial += loads.force[0];
                load.fy += loads.force[1];
                load.fz += loads.force[2];
                load.moment += loads.twist;
                load.slope[0] += loads.slope[0];
                load.slope[1] += loads.slope[1];
            }
        }
        load
    }

    /// Linearisation of the residual with settled lag states at every point, by differences: there it depends on
    /// the motion of the point alone, so one revolution moves a coordinate at all points.
    fn tangents_by_differences(
        &self,
        samples: &OrbitSamples,
    ) -> Result<Vec<LocalTangent>, ResponseError> {
        let n = self.dof();
        let residual = |work: &mut Work, samples: &OrbitSamples| {
            let mut out = DMatrix::zeros(n, self.points.len());
            self.evaluate(samples, Some(Lags::Settled), work, Some(&mut out)).map(|_| out)
        };
        let base = residual(&mut Work::default(), samples)?;
        // sections without apparent mass do not ask for the accelerations: all at once tell
        let mut moved = samples.clone();
        moved.qdd.add_scalar_mut(TANGENT_STEP);
        let parts = if residual(&mut Work::default(), &moved)? == base { 2 } else { 3 };
        let slope = |work: &mut Work, column: usize| {
            let mut moved = samples.clone();
            let part = match column / n {
                0 => &mut moved.q,
                1 => &mut moved.qd,
                _ => &mut moved.qdd,
            };
            part.row_mut(column % n).add_scalar_mut(TANGENT_STEP);
            Ok((residual(work, &moved)? - &base) / TANGENT_STEP)
        };
        let slopes = (0..parts * n)
            .into_par_iter()
            .map_init(Work::default, slope)
            .collect::<Result<Vec<DMatrix<f64>>, ResponseError>>()?;
        let of = |p: usize, part: usize| {
            let slope = |i: usize, j: usize| slopes.get(part * n + j).map_or(0.0, |s| s[(i, p)]);
            DMatrix::from_fn(n, n, slope)
        };
        let at = |p: usize| LocalTangent { dq: of(p, 0), dqd: of(p, 1), dqdd: of(p, 2) };
        Ok((0..self.points.len()).map(at).collect())
    }
}

impl PeriodicSystem for ResponseSystem<'_> {
    type Error = ResponseError;
    type Seen = Revolution;
    type Work = Work;

    fn dof(&self) -> usize {
        self.mass.nrows()
    }

    fn mass(&self) -> &DMatrix<f64> {
        self.mass
    }

    fn residual(
        &self,
        samples: &OrbitSamples,
        work: &mut Work,
        out: &mut DMatrix<f64>,
    ) -> Result<Revolution, Self::Error> {
        self.evaluate(samples, Some(Lags::Followed), work, Some(out))
    }

    fn tangents(&self, samples: &OrbitSamples) -> Result<Vec<LocalTangent>, Self::Error> {
        self.tangents_by_differences(samples)
    }

    fn memory(&self, samples: &OrbitSamples) -> Result<Option<OrbitMemory>, Self::Error> {
        Ok(self.lag_memory(samples))
    }
}

impl ResponseSystem<'_> {
    /// What the residual is without loads of the air and of the flaps.
    ///
    /// # Errors
    /// None but those of [`revolution`](Self::revolution).
    pub(crate) fn unloaded(&self, samples: &OrbitSamples) -> Result<DMatrix<f64>, ResponseError> {
        let mut out = DMatrix::zeros(self.dof(), self.points.len());
        self.evaluate(samples, None, &mut Work::default(), Some(&mut out)).map(|_| out)
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
        let mut slope = DMatrix::zeros(self.dof(), self.points.len());
        let lags = Some(Lags::OfFlapChange);
        along.evaluate(samples, lags, &mut Work::default(), Some(&mut slope))?;
        Ok(Some(slope - bare))
    }
}
