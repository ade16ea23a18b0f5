//! The memory of the unsteady sections in the Newton matrix.
//!
//! ```text
//! d(lag part)_o(p) = sum_p' k_o0[p, p'] d(U alpha)(p') + k_o1[p, p'] d(c om)(p')
//! d(U alpha) = U_T dphi + th dU_T - dU_P          d(c om) = c (dphi' + dw_x)
//! dU_T = dv' + dv_x U_R      dU_P = dw' + dw_x U_R + e_d (dphi' + dw_x)
//! dF_z = (1/2) rho c |U_T| d(lift)      dF_y = -(1/2) rho c s U_P d(lift)      dM = (1/2) rho c^2 |U_T| d(moment)
//! ```
//! projected on the modes. Changes of the speeds at which the lagged part acts are second order in the
//! angles and left out, as is the axial part of the loads: only the speed of convergence depends on this
//! matrix, never the solution.

use crate::air::SectionFlow;
use crate::blade::ResponseBlade;
use crate::flight_air::StationMemory;
use crate::motion::Motion;
use crate::system::ResponseSystem;
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_fem::{OrbitMemory, OrbitSamples, PeriodicSystem};
use std::ops::Range;

/// Places of the modes of each family among the coordinates.
struct Modes {
    flap: Range<usize>,
    lag: Range<usize>,
    torsion: Range<usize>,
}

impl Modes {
    fn of(blade: &ResponseBlade) -> Self {
        let flap = 0..blade.flap.count();
        let lag = flap.end..flap.end + blade.lag.count();
        let torsion = lag.end..lag.end + blade.torsion.count();
        Self { flap, lag, torsion }
    }
}

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
                let mut motion = Motion::default();
                self.fill(&mut motion, samples, p);
                let flows = self.flows(p, &motion);
                let stations = flows.iter().take(stations.len()).enumerate();
                stations
                    .map(|(s, flow)| (self.input_slopes(p, s, flow), self.load_slopes(s, flow)))
                    .collect()
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
        let lifted = if self.scales.centre == 0.0 { 0..bending } else { 0..dof };
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

    fn input_slopes(&self, point: usize, lifting: usize, flow: &SectionFlow) -> InputSlopes {
        let (blade, air) = (self.blade, &self.points[point].air);
        let i = self.air.first_station() + lifting;
        let along = air.advance_ratio * air.cos + blade.offsets.torque;
        let (centre, chord) = (blade.offsets.aerodynamic_centre, self.scales.chord);
        let dof = self.dof();
        let mut slopes = InputSlopes { alpha: vec![0.0; 2 * dof], pitch_rate: vec![0.0; 2 * dof] };
        let modes = Modes::of(blade);
        for (j, mode) in modes.flap.clone().zip(&blade.flap.value) {
            let slope = blade.flap.slope[j - modes.flap.start][i];
            slopes.alpha[j] = -slope * (along + centre);
            slopes.alpha[dof + j] = -mode[i];
            slopes.pitch_rate[j] = chord * slope;
        }
        for (j, mode) in modes.lag.clone().zip(&blade.lag.value) {
            let slope = blade.lag.slope[j - modes.lag.start][i];
            slopes.alpha[j] = flow.pitch * slope * along;
            slopes.alpha[dof + j] = flow.pitch * mode[i];
        }
        for (j, mode) in modes.torsion.zip(&blade.torsion.value) {
            slopes.alpha[j] = flow.u_t * mode[i];
            slopes.alpha[dof + j] = -centre * mode[i];
            slopes.pitch_rate[dof + j] = chord * mode[i];
        }
        slopes
    }

    fn load_slopes(&self, lifting: usize, flow: &SectionFlow) -> LoadSlopes {
        let blade = self.blade;
        let i = self.air.first_station() + lifting;
        let weight = blade.grid.weight()[i];
        let half = 0.5 * self.scales.density_chord;
        let (fz, fy) = (half * flow.u_t.abs(), -half * flow.sense * flow.u_p);
        let (sin, cos) = flow.pitch.sin_cos();
        let about_axis = self.scales.centre * (fz * cos - fy * sin);
        let dof = self.dof();
        let mut slopes = LoadSlopes { lift: vec![0.0; dof], moment: vec![0.0; dof] };
        let modes = Modes::of(blade);
        for (j, mode) in modes.flap.zip(&blade.flap.value) {
            slopes.lift[j] = -weight * fz * mode[i];
        }
        for (j, mode) in modes.lag.zip(&blade.lag.value) {
            slopes.lift[j] = -weight * fy * mode[i];
        }
        for (j, mode) in modes.torsion.zip(&blade.torsion.value) {
            slopes.lift[j] = -weight * about_axis * mode[i];
            slopes.moment[j] = -weight * fz * self.scales.chord * mode[i];
        }
        slopes
    }
}
