//! The memory of the unsteady sections in the Newton matrix.
//!
//! ```text
//! d(lag part)_o(p) = sum_p' k_o0[p, p'] d(U alpha)(p') + k_o1[p, p'] d(c om)(p')
//! d(U alpha) = U_T dphi + th dU_T - dU_P          d(c om) = c (dphi' + dw_x + mu cos psi dphi_x)
//! dU_T, dU_P by differences of the flow (R.8)
//! dF_z = (1/2) rho c |U_T| d(lift)      dF_y = -(1/2) rho c s U_P d(lift)      dM = (1/2) rho c^2 |U_T| d(moment)
//! ```
//! projected on the modes. The axial part of the loads and, of the moderately deflected blade, its partner `-v_x w_x dF_z`, which it
//! cancels for a blade that turns about a hinge, are left out together. Changes of the speeds at which the lagged part acts are second order in the
//! angles and left out, as is the axial part of the loads: only the speed of convergence depends on this
//! matrix, never the solution.

use crate::response::system::ResponseSystem;
use crate::sections::air::SectionFlow;
use crate::sections::flight_air::StationMemory;
use crate::structure::motion::Motion;
use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;
use rotor_fem::{LagChannel, LagPlace, OrbitMemory, OrbitSamples, PeriodicSystem};
use std::ops::Range;

/// Step of the central differences of the inputs, which are quadratic in the motion but for third-order terms.
const INPUT_STEP: f64 = 1e-4;

/// A field of the motion.
type Field = fn(&mut Motion) -> &mut Vec<f64>;

/// Share of the two section inputs in displacement and rate of every mode, at one point and station:
/// the inputs by displacement, then by rate, one entry per mode.
struct InputSlopes {
    alpha: Vec<f64>,
    pitch_rate: Vec<f64>,
}

/// What the lag parts of lift and moment do on every mode, at one point and station.
struct LoadSlopes {
    lift: Vec<f64>,
    moment: Vec<f64>,
}

/// What one point of the past does at all others through the lags of all stations, a product of two factors.
///
/// ```text
/// d f[now, mode] / d (q, q')[then, place] = sum_s,i ( sum_o work_o[now, s, mode] k_oi[now, then] ) slope_i[then, s, place]
/// ```
struct Past {
    /// Shape (points x modes) x (stations x inputs).
    answers: DMatrix<f64>,
    /// Shape (stations x inputs) x (displacements and rates of the modes).
    inputs: DMatrix<f64>,
}

impl Past {
    fn new(
        then: usize,
        stations: &[Option<&StationMemory>],
        slopes: &[Vec<(InputSlopes, LoadSlopes)>],
        worked: &[Range<usize>; 2],
    ) -> Self {
        let (dof, points) = (worked[1].end, slopes.len());
        let with_lags: Vec<(usize, &StationMemory)> =
            stations.iter().enumerate().filter_map(|(s, memory)| Some((s, (*memory)?))).collect();
        let count = 2 * with_lags.len();
        let mut answers = DMatrix::zeros(dof * points, count);
        for (k, mut column) in answers.column_iter_mut().enumerate() {
            let (s, memory) = with_lags[k / 2];
            let at_points = column.as_mut_slice().chunks_exact_mut(dof);
            for ((now, answers), of_point) in at_points.enumerate().zip(slopes) {
                let (_, loads) = &of_point[s];
                let works = [&loads.lift, &loads.moment].into_iter().zip(worked);
                for (kernels, (work, modes)) in memory.kernels.iter().zip(works) {
                    let kernel = kernels[k % 2][(now, then)];
                    for (sum, work) in answers[modes.clone()].iter_mut().zip(&work[modes.clone()]) {
                        *sum += kernel * work;
                    }
                }
            }
        }
        let inputs = DMatrix::from_fn(count, 2 * dof, |k, place| {
            let (inputs, _) = &slopes[then][with_lags[k / 2].0];
            if k % 2 == 0 { inputs.alpha[place] } else { inputs.pitch_rate[place] }
        });
        Self { answers, inputs }
    }
}

impl ResponseSystem<'_> {
    /// The part of the linearised residual that the settled lags leave out.
    ///
    /// `None` over tables, and where no section has lags.
    pub(crate) fn lag_memory(&self, samples: &OrbitSamples) -> Option<OrbitMemory> {
        let lost_from = self.load_law().lost_from;
        let memories = self.air.memories()?.iter().take(lost_from);
        let stations: Vec<Option<&StationMemory>> = memories.map(Option::as_ref).collect();
        if stations.iter().all(Option::is_none) {
            return None;
        }
        let (dof, points) = (self.dof(), self.points.len());
        let slopes: Vec<Vec<(InputSlopes, LoadSlopes)>> = (0..points)
            .into_par_iter()
            .map(|p| {
                let flows = self.flows(p, &self.motion(samples, p));
                let inputs = self.input_slopes(p, samples);
                let loads = flows.iter().take(stations.len()).enumerate();
                inputs.into_iter().zip(loads.map(|(s, flow)| self.load_slopes(s, flow))).collect()
            })
            .collect();
        let bending = self.blade.flap.count() + self.blade.lag.count();
        // the lift works on all modes if the axis is not where it attacks, the moment on torsion alone
        let centred = self.blade.air.iter().all(|scales| scales.centre == 0.0);
        let lifted = if centred { 0..bending } else { 0..dof };
        let worked = [lifted, bending..dof];
        let mut memory = OrbitMemory::zero(dof, points);
        let OrbitMemory { dq, dqd } = &mut memory;
        let size = dof * points * dof;
        let parts =
            dq.as_mut_slice().par_chunks_mut(size).zip(dqd.as_mut_slice().par_chunks_mut(size));
        parts.enumerate().for_each(|(then, (dq, dqd))| {
            let Past { answers, inputs } = Past::new(then, &stations, &slopes, &worked);
            for (out, places) in [(dq, 0), (dqd, dof)] {
                let mut out = DMatrixViewMut::from_slice(out, dof * points, dof);
                out.gemm(1.0, &answers, &inputs.columns(places, dof), 0.0);
            }
        });
        Some(memory)
    }

    /// The lags of all stations with what drives them and what they do, for the stability of blade and lags
    /// together; none over tables, with dynamic stall, and where no section has lags.
    pub(crate) fn lag_places(&self, samples: &OrbitSamples) -> Vec<LagPlace> {
        let Some(channels) = self.air.channels() else { return Vec::new() };
        let lost_from = self.load_law().lost_from;
        let dof = self.dof();
        let flows: Vec<Vec<SectionFlow>> = (0..self.points.len())
            .into_par_iter()
            .map(|p| self.flows(p, &self.motion(samples, p)))
            .collect();
        let by_point: Vec<Vec<InputSlopes>> =
            (0..self.points.len()).into_par_iter().map(|p| self.input_slopes(p, samples)).collect();
        let place = |(s, channels): (usize, Vec<LagChannel>)| {
            let (mut inputs, mut loads) = (Vec::new(), Vec::new());
            for (p, row) in flows.iter().enumerate() {
                let input = &by_point[p][s];
                let load = self.load_slopes(s, &row[s]);
                let both = [input.alpha.as_slice(), &input.pitch_rate].concat();
                inputs.push(DMatrix::from_row_slice(2, 2 * dof, &both));
                loads.push(DMatrix::from_column_slice(dof, 2, &[load.lift, load.moment].concat()));
            }
            LagPlace { inputs, loads, channels }
        };
        let known = channels.into_par_iter().enumerate().take(lost_from);
        known.filter(|(_, channels)| !channels.is_empty()).map(place).collect()
    }

    /// Slopes of the inputs of all lifting stations at a point: those in the fields of the motion, by differences, for the
    /// flow is quadratic in them, and the shapes that the modes have there.
    fn input_slopes(&self, point: usize, samples: &OrbitSamples) -> Vec<InputSlopes> {
        let (blade, dof, first) = (self.blade, self.dof(), self.air.first_station);
        let mut motion = self.motion(samples, point);
        let mut slopes: Vec<InputSlopes> = (0..self.air.stations())
            .map(|_| InputSlopes { alpha: vec![0.0; 2 * dof], pitch_rate: vec![0.0; 2 * dof] })
            .collect();
        let mut add = |of_field: &[[f64; 2]], place: usize, shape: &[f64]| {
            let stations = slopes.iter_mut().zip(of_field).zip(&shape[first..]);
            for ((slope, [alpha, pitch_rate]), shape) in stations {
                slope.alpha[place] += alpha * shape;
                slope.pitch_rate[place] += pitch_rate * shape;
            }
        };
        let (lag, torsion) = (blade.flap.count(), blade.flap.count() + blade.lag.count());
        let fields: [(Field, &[Vec<f64>], usize); 9] = [
            (|m| &mut m.w.value, &blade.flap.value, 0),
            (|m| &mut m.w.slope, &blade.flap.slope, 0),
            (|m| &mut m.w.rate, &blade.flap.value, dof),
            (|m| &mut m.v.value, &blade.lag.value, lag),
            (|m| &mut m.v.slope, &blade.lag.slope, lag),
            (|m| &mut m.v.rate, &blade.lag.value, dof + lag),
            (|m| &mut m.phi.value, &blade.torsion.value, torsion),
            (|m| &mut m.phi.slope, &blade.torsion.slope, torsion),
            (|m| &mut m.phi.rate, &blade.torsion.value, dof + torsion),
        ];
        for (field, shapes, place) in fields {
            let of_field = self.field_slopes(point, &mut motion, field);
            for (j, shape) in shapes.iter().enumerate() {
                add(&of_field, place + j, shape);
            }
        }
        if blade.modal.is_some() {
            // u and u' of the foreshortening hold what the slopes inboard do
            let [of_u, of_rate]: [Field; 2] = [|m| m.shortening_mut(0), |m| m.shortening_mut(1)];
            let [of_u, of_rate] =
                [of_u, of_rate].map(|field| self.field_slopes(point, &mut motion, field));
            for (d, shapes, place) in [(&motion.w, &blade.flap, 0), (&motion.v, &blade.lag, lag)] {
                for (j, shape) in shapes.slope.iter().enumerate() {
                    let [u, rate] = [&d.slope, &d.slope_rate].map(|along| {
                        let density: Vec<f64> =
                            shape.iter().zip(along).map(|(a, b)| -a * b).collect();
                        let mut integral = vec![0.0; density.len()];
                        blade.grid.integral_from_root(&density, &mut integral);
                        integral
                    });
                    add(&of_u, place + j, &u);
                    add(&of_rate, place + j, &rate);
                    add(&of_rate, dof + place + j, &u);
                }
            }
        }
        slopes
    }

    /// Slopes of the two inputs of all lifting stations at a point in a field of the motion there.
    fn field_slopes(&self, point: usize, motion: &mut Motion, field: Field) -> Vec<[f64; 2]> {
        let rest = field(motion).clone();
        let mut moved = |by: f64| {
            field(motion).iter_mut().zip(&rest).for_each(|(value, rest)| *value = rest + by);
            self.flows(point, motion)
        };
        let (above, below) = (moved(INPUT_STEP), moved(-INPUT_STEP));
        field(motion).clone_from(&rest);
        let slope = |(above, below): (&SectionFlow, &SectionFlow)| {
            let of = |k: usize| (above.input[k] - below.input[k]) / (2.0 * INPUT_STEP);
            [of(0), of(1)]
        };
        above.iter().zip(&below).map(slope).collect()
    }

    fn load_slopes(&self, lifting: usize, flow: &SectionFlow) -> LoadSlopes {
        let blade = self.blade;
        let i = self.air.first_station + lifting;
        let weight = blade.grid.weight()[i];
        let scales = blade.air[i];
        let half = 0.5 * scales.density_chord;
        let (fz, fy) = (half * flow.u_t.abs(), -half * flow.sense * flow.u_p);
        let (sin, cos) = flow.pitch.sin_cos();
        let about_axis = scales.centre * (fz * cos - fy * sin);
        let dof = self.dof();
        let mut slopes = LoadSlopes { lift: vec![0.0; dof], moment: vec![0.0; dof] };
        let families = [(&blade.flap, fz), (&blade.lag, fy), (&blade.torsion, about_axis)];
        let modes =
            families.into_iter().flat_map(|(of, work)| of.value.iter().map(move |m| (m, work)));
        for (slope, (mode, work)) in slopes.lift.iter_mut().zip(modes) {
            *slope = -weight * work * mode[i];
        }
        let bending = blade.flap.count() + blade.lag.count();
        for (slope, mode) in slopes.moment[bending..].iter_mut().zip(&blade.torsion.value) {
            *slope = -weight * fz * scales.chord * mode[i];
        }
        slopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Condition, Controls, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel,
        RotorSolver,
    };
    use rotor_base::HarmonicSeries;
    use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms};
    use rotor_wake::{FlightState, LinearInflow};
    use std::sync::Arc;

    /// Slopes of the inputs against differences of the whole motion, mode by mode.
    #[test]
    fn the_slopes_of_the_inputs_are_those_of_the_modes() {
        for couplings in [Couplings::Full, Couplings::Moderate(TorsionTerms::default())] {
            let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
            let model = RotorModel { couplings, ..RotorModel::paper_case() };
            let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default()).unwrap());
            let tolerances = ResponseTolerances::default();
            let mut solver = RotorSolver::new(rotor.clone(), 0.3, tolerances).unwrap();
            let condition = Condition {
                bank_rad: 0.0,
                flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
                controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
                flap_angles_rad: vec![HarmonicSeries::zero(0); 2],
            };
            let found = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
            let system = rotor.system(&solver.air, solver.point_inputs(&condition, &found.inflow));
            let samples = found.orbit.sample(&solver.time);
            let (dof, point) = (system.dof(), 19);
            let slopes = system.input_slopes(point, &samples);
            for place in 0..2 * dof {
                let flows = |by: f64| {
                    let mut moved = samples.clone();
                    let part = if place < dof { &mut moved.q } else { &mut moved.qd };
                    part[(place % dof, point)] += by;
                    system.flows(point, &system.motion(&moved, point))
                };
                let (above, below) = (flows(INPUT_STEP), flows(-INPUT_STEP));
                for (slope, (above, below)) in slopes.iter().zip(above.iter().zip(&below)) {
                    let of = |k: usize| (above.input[k] - below.input[k]) / (2.0 * INPUT_STEP);
                    let gap = (slope.alpha[place] - of(0)).abs();
                    assert!(gap < 1e-6, "{couplings:?} {place}: {gap:e} of {}", of(0));
                    assert!((slope.pitch_rate[place] - of(1)).abs() < 1e-9, "{place}");
                }
            }
        }
    }
}
