//! The aeroelastic blade as a periodic system for the time elements.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::ResponseError;
use crate::model::flap_inertia::FlapSection;
use crate::response::evaluated::{Revolution, Work};
use crate::sections::air::{
    AirPoint, FlapAngle, SectionAxes, SectionFlow, SectionLoads, gathered, section_flow,
};
use crate::sections::flight_air::{FlightAir, Lags, LoadLaw};
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{SpanLoads, StationLoad};
use crate::structure::motion::Motion;
use crate::{Couplings, FlapMass};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::{LANES, Lanes, Number};
use rotor_fem::{LocalTangent, OrbitMemory, OrbitSamples, PeriodicSystem, PitchMotion};

/// Step of the one-sided differences of the Newton matrix. Only the speed of convergence depends on
/// it, never the solution.
const TANGENT_STEP: f64 = 1e-6;

/// What the air and the pilot do at one azimuth point, or at several side by side.
#[derive(Debug, Clone)]
pub(crate) struct PointInput<T = f64> {
    pub(crate) air: AirPoint<T>,
    /// Total inflow at the lifting stations, down positive, and induced velocity in the plane of the disk from the
    /// leading to the trailing edge; tip speed.
    pub(crate) inflow: Vec<[T; 2]>,
    /// Angle, rate and acceleration of each flap, rad.
    pub(crate) flap: Vec<FlapAngle<T>>,
    /// Acceleration of gravity in the axes of the coned blade, `Omega^2 R`.
    pub(crate) gravity: [T; 3],
}

impl PointInput<Lanes> {
    /// Points side by side; the last one fills the rest.
    fn gather(points: &[PointInput]) -> Self {
        let of = |value: fn(&PointInput) -> f64| gathered(points, value);
        let first = &points[0];
        Self {
            air: AirPoint {
                sin: of(|p| p.air.sin),
                cos: of(|p| p.air.cos),
                advance_ratio: first.air.advance_ratio,
                pitch: PitchMotion {
                    angle_rad: of(|p| p.air.pitch.angle_rad),
                    rate: of(|p| p.air.pitch.rate),
                    acceleration: of(|p| p.air.pitch.acceleration),
                },
                reverse_flow: first.air.reverse_flow,
            },
            inflow: (0..first.inflow.len())
                .map(|s| std::array::from_fn(|c| gathered(points, |p| p.inflow[s][c])))
                .collect(),
            flap: (0..first.flap.len())
                .map(|k| std::array::from_fn(|c| gathered(points, |p| p.flap[k][c])))
                .collect(),
            gravity: std::array::from_fn(|k| gathered(points, |p| p.gravity[k])),
        }
    }
}

/// Inputs in blocks of lanes.
pub(crate) fn side_by_side(points: &[PointInput]) -> Vec<PointInput<Lanes>> {
    points.chunks(LANES).map(PointInput::gather).collect()
}

/// One blade in one flight condition.
#[derive(Debug)]
pub(crate) struct ResponseSystem<'a> {
    pub(crate) blade: &'a ResponseBlade,
    pub(crate) couplings: Couplings,
    pub(crate) air: &'a FlightAir,
    pub(crate) points: Vec<PointInput>,
    /// The same side by side.
    pub(crate) blocks: Vec<PointInput<Lanes>>,
    /// Damping of the modes and of the lag damper.
    pub(crate) damping: &'a DMatrix<f64>,
    pub(crate) mass: &'a DMatrix<f64>,
}

impl ResponseSystem<'_> {
    /// The same blade with other inputs.
    pub(crate) fn with_points(&self, points: Vec<PointInput>) -> Self {
        Self { blocks: side_by_side(&points), points, ..*self }
    }

    /// Flow at every lifting station for the motion held in `motion`.
    pub(crate) fn flows(&self, point: usize, motion: &Motion) -> Vec<SectionFlow> {
        let first = self.air.first_station;
        let input = &self.points[point];
        (first..first + self.air.stations()).map(|i| self.flow(input, i, (motion, i))).collect()
    }

    /// Flow at a lifting station, whose motion stands in a lane or a block of lanes.
    #[inline(always)]
    pub(crate) fn flow<T: Number>(
        &self,
        input: &PointInput<T>,
        i: usize,
        motion: (&Motion, usize),
    ) -> SectionFlow<T> {
        let delta = self.blade.flap_index[i].map_or([T::default(); 3], |flap| input.flap[flap]);
        let inflow = input.inflow[i - self.air.first_station];
        section_flow(self.blade, motion, &input.air, (i, inflow), delta)
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
            let at = (motion, i);
            let mut load = self.station_load(&self.points[point], i, at, section.unwrap_or(&still));
            if let Some(flap) = self.heavy_flap_load(point, i, at) {
                load.add(&flap);
            }
            out.set(i, &load);
        }
    }

    /// The same at one station, whose motion stands in a lane or a block of lanes, without
    /// [`heavy_flap_load`](Self::heavy_flap_load).
    ///
    /// ```text
    /// F_z += m_f X_f delta''     M += -(m_f (d + X_f) X_f + I_cg) delta'' - m_f (d + X_f) X_f delta
    /// ```
    /// Of a flap that is part of the blade only what its angle adds, in this first-order form.
    #[inline(always)]
    pub(crate) fn station_load<T: Number>(
        &self,
        input: &PointInput<T>,
        i: usize,
        (motion, lane): (&Motion, usize),
        section: &SectionLoads<T>,
    ) -> StationLoad<T> {
        let blade = self.blade;
        let [fy, fz] = SectionAxes::of(blade, motion, lane).force(section);
        let (moment, gravity) = (section.moment, input.gravity);
        let mut load = StationLoad { fy, fz, moment, gravity, ..StationLoad::default() };
        let centre = blade.mass_centre[i];
        if centre != 0.0 {
            let twist = input.air.pitch.angle_rad + blade.twist[i];
            let (sin, cos) = (twist + motion.phi.value::<T>(lane)).sin_cos();
            let [_, y, z] = gravity;
            load.moment += (cos * z - sin * y) * (blade.section_mass[i] * centre);
        }
        if let (Some(k), Some(inertia)) = (blade.flap_index[i], blade.flap_inertia[i])
            && inertia.mass == FlapMass::PartOfBlade
        {
            let [delta, _, acceleration] = input.flap[k];
            load.fz += acceleration * inertia.first_moment;
            load.moment -=
                acceleration * (inertia.arm_moment + inertia.own) + delta * inertia.arm_moment;
        }
        load
    }

    /// Of a flap that weighs beside the blade, all loads of its distance from the elastic axis at a station, whose motion
    /// stands in a lane; none where there is no such flap.
    pub(crate) fn heavy_flap_load(
        &self,
        point: usize,
        i: usize,
        motion: (&Motion, usize),
    ) -> Option<StationLoad> {
        let (k, inertia) = self.blade.flap_index[i].zip(self.blade.flap_inertia[i])?;
        (inertia.mass == FlapMass::AddedToBlade).then(|| {
            let loads = inertia.body.loads_off_axis(&self.flap_section(point, motion, i, k));
            let [axial, fy, fz] = loads.force;
            let (moment, slope) = (loads.twist, loads.slope);
            StationLoad { axial, fy, fz, moment, slope, gravity: [0.0; 3] }
        })
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

    fn recycle(&self, seen: Revolution, work: &mut Work) {
        work.sections = seen.sections;
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
        let along = self.with_points(self.points.iter().zip(flaps).map(along).collect());
        let mut slope = DMatrix::zeros(self.dof(), self.points.len());
        let lags = Some(Lags::OfFlapChange);
        along.evaluate(samples, lags, &mut Work::default(), Some(&mut slope))?;
        Ok(Some(slope - bare))
    }
}
