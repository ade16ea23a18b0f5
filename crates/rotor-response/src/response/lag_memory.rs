//! The memory of the unsteady sections in the Newton matrix.
//!
//! ```text
//! d(lag part)_o(p) = sum_p' k_o0[p, p'] d(U alpha)(p') + k_o1[p, p'] d(c om)(p')
//! d(U alpha) = U_T dphi + th dU_T - dU_P          d(c om) = c (dphi' + dw_x)
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
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_fem::{LagChannel, LagPlace, OrbitMemory, OrbitSamples, PeriodicSystem};

/// Step of the central differences of the inputs, which are quadratic in the motion but for third-order terms.
const INPUT_STEP: f64 = 1e-4;

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

impl ResponseSystem<'_> {
    /// The part of the linearised residual that the settled lags leave out.
    ///
    /// `None` over tables, and where no section has lags.
    pub(crate) fn lag_memory(&self, samples: &OrbitSamples) -> Option<OrbitMemory> {
        let mut stations = self.air.memories()?;
        let lost_from = self.load_law(false).lost_from;
        stations.truncate(lost_from);
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
        // column by column of the past: point `then`, its displacements and its rates
        let columns: Vec<[DMatrix<f64>; 2]> = (0..points)
            .into_par_iter()
            .map(|then| self.columns(then, &stations, &slopes))
            .collect();
        let mut memory = OrbitMemory::zero(dof, points);
        for (then, [dq, dqd]) in columns.into_iter().enumerate() {
            memory.dq.columns_mut(then * dof, dof).copy_from(&dq);
            memory.dqd.columns_mut(then * dof, dof).copy_from(&dqd);
        }
        Some(memory)
    }

    /// The lags of all stations with what drives them and what they do, for the stability of blade and lags
    /// together; none over tables, with dynamic stall, and where no section has lags.
    pub(crate) fn lag_places(&self, samples: &OrbitSamples) -> Vec<LagPlace> {
        let Some(channels) = self.air.channels() else { return Vec::new() };
        let lost_from = self.load_law(false).lost_from;
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

    /// The columns of one point of the past, by displacement and by rate; shape `dof points x dof`.
    fn columns(
        &self,
        then: usize,
        stations: &[Option<StationMemory>],
        slopes: &[Vec<(InputSlopes, LoadSlopes)>],
    ) -> [DMatrix<f64>; 2] {
        let (dof, points) = (self.dof(), self.points.len());
        let bending = self.blade.flap.count() + self.blade.lag.count();
        // the lift works on all modes if the axis is not where it attacks, the moment on torsion alone
        let centred = self.blade.air.iter().all(|scales| scales.centre == 0.0);
        let lifted = if centred { 0..bending } else { 0..dof };
        let worked = [lifted, bending..dof];
        let mut blocks = vec![0.0; points * dof * 2 * dof];
        let mut shares = vec![0.0; 2 * dof];
        for (s, station) in stations.iter().enumerate() {
            let Some(memory) = station else { continue };
            let (inputs, _) = &slopes[then][s];
            for (now, block) in blocks.chunks_exact_mut(dof * 2 * dof).enumerate() {
                let (_, loads) = &slopes[now][s];
                let works = [&loads.lift, &loads.moment].into_iter().zip(&worked);
                for (kernels, (load, modes)) in memory.kernels.iter().zip(works) {
                    let [alpha, rate] = kernels.each_ref().map(|k| k[(now, then)]);
                    let both = inputs.alpha.iter().zip(&inputs.pitch_rate);
                    for (share, (a, r)) in shares.iter_mut().zip(both) {
                        *share = alpha * a + rate * r;
                    }
                    let rows = block.chunks_exact_mut(2 * dof).zip(load);
                    for (row, work) in rows.skip(modes.start).take(modes.len()) {
                        for (entry, share) in row.iter_mut().zip(&shares) {
                            *entry += work * share;
                        }
                    }
                }
            }
        }
        let entry = |row: usize, column: usize| blocks[row * 2 * dof + column];
        [0, dof].map(|from| DMatrix::from_fn(dof * points, dof, |row, j| entry(row, from + j)))
    }

    /// Slopes of the inputs of all lifting stations at a point, by differences: the flow is quadratic in the motion.
    fn input_slopes(&self, point: usize, samples: &OrbitSamples) -> Vec<InputSlopes> {
        let dof = self.dof();
        let [q, qd, accelerations] = samples.at(point);
        let mut state = [q.to_vec(), qd.to_vec()];
        let mut motion = Motion::default();
        let mut flows = |[q, qd]: &[Vec<f64>; 2]| {
            motion.fill(self.blade, [q, qd, accelerations]);
            self.flows(point, &motion)
        };
        let none = || InputSlopes { alpha: vec![0.0; 2 * dof], pitch_rate: vec![0.0; 2 * dof] };
        let mut slopes: Vec<InputSlopes> = flows(&state).iter().map(|_| none()).collect();
        for j in 0..2 * dof {
            let at = state[j / dof][j % dof];
            let mut moved = |by: f64| {
                state[j / dof][j % dof] = at + by;
                flows(&state)
            };
            let (above, below) = (moved(INPUT_STEP), moved(-INPUT_STEP));
            state[j / dof][j % dof] = at;
            for ((slope, above), below) in slopes.iter_mut().zip(&above).zip(&below) {
                let of = |k: usize| (above.input[k] - below.input[k]) / (2.0 * INPUT_STEP);
                (slope.alpha[j], slope.pitch_rate[j]) = (of(0), of(1));
            }
        }
        slopes
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
