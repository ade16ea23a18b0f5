//! What a wake wants to know of a response: circulation over the disk and where the blades are.

use crate::response::revolution::unit_weights;
use crate::response::wake_loading::{
    between, circulation, of_harmonics, over_panels, panel_means, resolved_harmonics, shares,
};
use crate::{Controls, ResponseError, Rotor, RotorSolution, RotorSolver};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::{HarmonicSeries, harmonic_waves, uniform_azimuths_rad};
use rotor_wake::{BladeLines, CirculationMap, CirculationSlope, MotionSlope, WakeRotor};
use std::collections::BTreeMap;

/// Speed across the chord that turns the sense of the circulation, tip speed: about the inflow.
const SMALL_SPEED: f64 = 0.04;
/// Harmonics of the flap bending that answers to the inflow.
const MOVING_HARMONICS: usize = 5;

impl RotorSolver {
    /// Bound circulation of a solution on the panels and azimuths of a wake.
    ///
    /// # Errors
    /// [`ResponseError::Wake`] if a value is not finite.
    pub fn circulation(
        &self,
        solution: &RotorSolution,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> Result<CirculationMap, ResponseError> {
        circulation(self.rotor(), &self.time, &solution.lifting, wake_rotor, azimuths)
    }

    /// Lift of the air per length of one blade on the panels and azimuths of a wake, along the shaft, up positive,
    /// `m0 Omega^2 R`, azimuth by azimuth: the mean over each panel. Its sum over the widths and mean over the azimuths,
    /// times the number of blades, is the thrust but for what the deflection of the blades turns of the other forces.
    pub fn thrust_per_length(
        &self,
        solution: &RotorSolution,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> Vec<f64> {
        let (rotor, along_shaft) = (self.rotor(), self.rotor().blade().precone.cos());
        let grid = (wake_rotor, azimuths);
        let up = over_panels(rotor, &self.time, &solution.lifting, grid, |l| along_shaft * l.lift);
        up.transpose().as_slice().to_vec()
    }

    /// How the circulation at the panels and azimuths of a wake answers to the inflow there: prompt lift and lags of the attached sections in the speed of the rigid blade, over tables too.
    ///
    /// ```text
    /// dGamma = -(1/2) c s K dlambda,      K = direct + sum over channels of gain P input      s = U / hypot(U, .04)
    /// ```
    /// between the ways in which inflow is read at stations and points and circulation at panels and azimuths. The blade
    /// answers by its flap bending, in closed form by harmonics.
    pub fn circulation_slope(
        &self,
        controls: &Controls,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> CirculationSlope {
        let (blade, time) = (self.rotor().blade(), &self.time);
        let first = self.air.first_station;
        let (x, air) = (&blade.grid().x()[first..], &blade.air[first..]);
        let (weights, psi) = (unit_weights(time), uniform_azimuths_rad(azimuths));
        let most = (azimuths - 1) / 2;
        let resolved = resolved_harmonics(time, &weights, most);
        let points = time.points();
        let read = DMatrix::from_fn(points.len(), azimuths, |p, i| {
            of_harmonics(most, points[p] - psi[i]) / azimuths as f64
        });
        let written = DMatrix::from_fn(azimuths, points.len(), |i, p| {
            weights[p] * of_harmonics(resolved, psi[i] - points[p])
        });
        let kept = x.partition_point(|x| *x <= blade.tip_loss);
        let at_station = |(s, mut lift): (usize, DMatrix<f64>)| {
            for (mut row, point) in lift.row_iter_mut().zip(points) {
                let speed = x[s] + self.advance_ratio * point.sin();
                row *= -0.5 * air[s].chord * speed / speed.hypot(SMALL_SPEED);
            }
            &written * (lift * &read)
        };
        let slopes: Vec<DMatrix<f64>> =
            self.air.lift_slopes().into_par_iter().take(kept).enumerate().map(at_station).collect();
        let panels = wake_rotor.stations();
        let mut blocks = BTreeMap::new();
        let means = panel_means(blade.grid(), x.len(), wake_rotor);
        for (from, row) in means.row_iter().enumerate() {
            let of_stations = row.iter().copied().enumerate().take(kept);
            for (s, share) in of_stations.filter(|(_, share)| *share != 0.0) {
                for (to, other) in shares(&panels, x[s]) {
                    let block = blocks
                        .entry((from, to))
                        .or_insert_with(|| DMatrix::zeros(azimuths, azimuths));
                    *block += &slopes[s] * (share * other);
                }
            }
        }
        let blocks = blocks.into_iter().map(|((from, to), block)| (from, to, block));
        let motion = self.motion_slope(&slopes, &panels, &psi);
        let twists: Vec<f64> =
            panels.iter().map(|r| between(blade.grid().x(), &blade.twist, *r)).collect();
        let roots =
            psi.iter().map(|psi| controls.root_pitch(self.root_pitch_rad(), *psi).angle_rad);
        let pitch_rad = roots.flat_map(|root| twists.iter().map(move |twist| root + twist));
        CirculationSlope { pitch_rad: pitch_rad.collect(), blocks: blocks.collect(), motion }
    }

    /// How the flap bending of a blade answers to the inflow at the panels and azimuths of a wake, by its harmonics, where
    /// the circulation of the stations answers by `slopes`; none where the blade has no periodic answer.
    ///
    /// ```text
    /// m (nu^2 - n^2) q_n = ( integral phi rho U Gamma dr )_n,      dlambda felt = phi q' + mu cos psi phi' q
    /// ```
    fn motion_slope(
        &self,
        slopes: &[DMatrix<f64>],
        panels: &[f64],
        psi: &[f64],
    ) -> Option<MotionSlope> {
        let (blade, azimuths) = (self.rotor().blade(), psi.len());
        let first = self.air.first_station;
        let (x, weight, air) = (blade.grid().x(), blade.grid().weight(), &blade.air);
        let most = MOVING_HARMONICS.min((azimuths - 1) / 2);
        let waves: Vec<Vec<f64>> =
            psi.iter().map(|psi| harmonic_waves(*psi, most).collect()).collect();
        let of_mode = 1 + 2 * most;
        let count = of_mode * blade.flap.value.len();
        // inflow that a coordinate makes where the shape has a value and a slope
        let felt = |i: usize, wave: usize, value: f64, slope: f64| {
            let n = wave.div_ceil(2) as f64;
            let rate = match wave {
                0 => 0.0,
                cosine if cosine % 2 == 1 => -n * waves[i][wave + 1],
                _ => n * waves[i][wave - 1],
            };
            value * rate + self.advance_ratio * psi[i].cos() * slope * waves[i][wave]
        };
        let felt_by = |i: usize, c: usize, at: &dyn Fn(&[f64]) -> f64| {
            let (value, slope) = (&blade.flap.value[c / of_mode], &blade.flap.slope[c / of_mode]);
            felt(i, c % of_mode, at(value), at(slope))
        };
        let mut stiffness = DMatrix::from_diagonal(&DVector::from_fn(count, |c, _| {
            let (mode, n) = (c / of_mode, (c % of_mode).div_ceil(2) as f64);
            blade.modal_masses[mode] * (blade.frequencies[mode].powi(2) - n * n)
        }));
        let mut read = DMatrix::zeros(count, azimuths * panels.len());
        let of_station = |(s, slope): (usize, &DMatrix<f64>)| {
            let at = first + s;
            let lift = weight[at] * air[at].density_chord / air[at].chord;
            let projected = DMatrix::from_fn(count, azimuths, |c, i| {
                let wave = c % of_mode;
                let mean = if wave == 0 { 1.0 } else { 2.0 } / azimuths as f64;
                let speed = x[at] + self.advance_ratio * psi[i].sin();
                mean * waves[i][wave] * blade.flap.value[c / of_mode][at] * lift * speed
            });
            let answer = projected * slope;
            let felt = DMatrix::from_fn(azimuths, count, |i, c| felt_by(i, c, &|shape| shape[at]));
            let work = &answer * felt;
            (answer, work)
        };
        let stations: Vec<_> = slopes.par_iter().enumerate().map(of_station).collect();
        for (s, (answer, work)) in stations.iter().enumerate() {
            stiffness -= work;
            for (to, share) in shares(panels, x[first + s]) {
                for (i, column) in answer.column_iter().enumerate() {
                    read.column_mut(i * panels.len() + to).axpy(share, &column, 1.0);
                }
            }
        }
        let coordinates = stiffness.lu().solve(&read)?;
        let inflow = DMatrix::from_fn(azimuths * panels.len(), count, |row, c| {
            let (i, panel) = (row / panels.len(), row % panels.len());
            felt_by(i, c, &|shape| between(x, shape, panels[panel]))
        });
        let is_finite = coordinates.iter().all(|value| value.is_finite());
        is_finite.then_some(MotionSlope { coordinates, inflow })
    }

    /// The lifting lines of blades deflected by modal motions ([`RotorSolution::modal`]) under pitch controls: quarter
    /// chord of the coned blade, displaced by flap and lag bending; the wake leaves at the trailing edge of the pitched,
    /// twisted section, three quarters of its own chord further back.
    pub fn blade_lines(
        &self,
        modal: &[HarmonicSeries],
        controls: &Controls,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> BladeLines {
        let psi = uniform_azimuths_rad(azimuths);
        let nodes = NodeShapes::new(self.rotor(), wake_rotor);
        let motion: Vec<Vec<f64>> =
            psi.iter().map(|&psi| modal.iter().map(|m| m.value(psi)).collect()).collect();
        BladeLines::deflected(wake_rotor, azimuths, |i, n| nodes.displacement(&motion[i], n))
            .with_trailing_edge(
                |n| nodes.edges[n],
                |i, n| {
                    let root = controls.root_pitch(self.root_pitch_rad(), psi[i]).angle_rad;
                    nodes.pitch_rad(root, &motion[i], n)
                },
            )
    }
}

/// Shapes of the modes at the nodes of a wake, and what else says where these are.
#[derive(Debug, Clone)]
pub(crate) struct NodeShapes {
    flap: Vec<Vec<f64>>,
    lag: Vec<Vec<f64>>,
    torsion: Vec<Vec<f64>>,
    twist: Vec<f64>,
    /// Height of the coned blade.
    coned: Vec<f64>,
    lead: f64,
    /// From the quarter chord to the trailing edge.
    pub(crate) edges: Vec<f64>,
}

impl NodeShapes {
    pub(crate) fn new(rotor: &Rotor, wake_rotor: &WakeRotor) -> Self {
        let (blade, model) = (rotor.blade(), rotor.model());
        let x = blade.grid().x();
        let at_nodes = |values: &[f64]| -> Vec<f64> {
            wake_rotor.nodes().iter().map(|&r| between(x, values, r)).collect()
        };
        let of_modes = |modes: &[Vec<f64>]| modes.iter().map(|m| at_nodes(m)).collect::<Vec<_>>();
        Self {
            flap: of_modes(&blade.flap.value),
            lag: of_modes(&blade.lag.value),
            torsion: of_modes(&blade.torsion.value),
            twist: at_nodes(&blade.twist),
            coned: wake_rotor.nodes().iter().map(|r| blade.precone * r).collect(),
            lead: blade.offsets.torque,
            edges: wake_rotor.nodes().iter().map(|r| 0.75 * model.chord_at(*r)).collect(),
        }
    }

    /// Up and toward the leading edge, unit `R`, of node `n` for modal coordinates.
    pub(crate) fn displacement(&self, q: &[f64], n: usize) -> [f64; 2] {
        let up = self.coned[n] + sum(&self.flap, q, n);
        [up, self.lead + sum(&self.lag, &q[self.flap.len()..], n)]
    }

    /// Pitch of the section at node `n`, rad.
    pub(crate) fn pitch_rad(&self, root_rad: f64, q: &[f64], n: usize) -> f64 {
        let twisting = self.flap.len() + self.lag.len();
        root_rad + self.twist[n] + sum(&self.torsion, &q[twisting..], n)
    }
}

/// What modes displace a node by.
fn sum(shapes: &[Vec<f64>], q: &[f64], n: usize) -> f64 {
    shapes.iter().zip(q).map(|(shape, q)| q * shape[n]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Condition, Discretisation, ResponseTolerances, Rotor, RotorModel};
    use rotor_fem::{BladeProperties, BladeSpec, TimeElements};
    use rotor_wake::{
        FlightState, InducedInflow, InflowMap, InflowModel, LinearInflow, RotorLoading, WakeError,
    };
    use std::sync::Arc;

    /// Largest amplitude that a unit harmonic `n` leaves at other harmonics up to `limit`, at the points of eight time
    /// elements.
    fn aliased(n: usize, limit: usize) -> f64 {
        let time = TimeElements::new(8, 5, 8).unwrap();
        let samples: Vec<f64> = time.points().iter().map(|psi| (n as f64 * psi).cos()).collect();
        let series = HarmonicSeries::project(time.points(), &unit_weights(&time), &samples, limit);
        let others = (1..=limit).filter(|k| *k != n).map(|k| series.harmonic(k).amplitude());
        others.fold(series.mean.abs(), f64::max)
    }

    /// Harmonics that are passed on come out as themselves; what the points do not tell apart comes out as others, and
    /// as large as it is.
    #[test]
    fn harmonics_beyond_the_time_elements_are_not_passed_on() {
        let time = TimeElements::new(8, 5, 8).unwrap();
        // what 72 azimuth steps of a wake could hold, and what 8 elements of 8 points resolve
        let all = 35;
        let limit = resolved_harmonics(&time, &unit_weights(&time), all);
        assert_eq!(limit, 15);
        assert_eq!(resolved_harmonics(&time, &unit_weights(&time), 11), 11);
        let kept = (1..=limit).map(|n| aliased(n, limit)).fold(0.0, f64::max);
        assert!(kept < 0.01, "{kept}");
        let beyond = (1..=all).map(|n| aliased(n, all)).fold(0.0, f64::max);
        assert!(beyond > 0.5, "{beyond}");
    }

    /// The paper's rotor in fast flight, its flaps at rest.
    fn forward() -> Condition {
        Condition {
            flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.08 },
            controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.02, theta1s_rad: -0.07 },
            flap_angles_rad: vec![HarmonicSeries::zero(0); 2],
            bank_rad: 0.0,
        }
    }

    /// The closed slope of the circulation against differences, the motion of the blade held; a slope without lags is
    /// far off.
    #[test]
    fn the_slope_of_the_circulation_is_that_of_differences() {
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default());
        let rotor = Arc::new(rotor.unwrap());
        let mut solver = RotorSolver::new(rotor, 0.3, ResponseTolerances::default()).unwrap();
        let condition = forward();
        let (azimuths, cutout) = (24, solver.rotor().model().root_cutout);
        let panels = WakeRotor::uniform(4, cutout, 12).unwrap();
        let even = InflowMap::new(&panels, vec![0.01; azimuths * panels.panels()]).unwrap();
        let across = even.clone().with_in_plane(vec![0.02; azimuths * panels.panels()]).unwrap();
        let [even, across] = [even, across].map(InducedInflow::Map);
        let model = LinearInflow::Prescribed { induced_inflow: 0.01 };
        let samples = solver.solve(&condition, &model, None).unwrap().orbit.sample(&solver.time);
        let of = |inflow: &InducedInflow| {
            let points = solver.point_inputs(&condition, inflow);
            let revolution = solver.rotor.system(&solver.air, points).revolution(&samples).unwrap();
            let lifting = revolution.lifting();
            circulation(&solver.rotor, &solver.time, &lifting, &panels, azimuths).unwrap()
        };
        let slope = solver.circulation_slope(&condition.controls, &panels, azimuths);
        let rest = of(&even);
        // air from the leading edge makes the blade faster: of U th - U_P, a third or less of U th, U th grows by 2 %
        let at = 6 * panels.panels() + 10;
        let grown = of(&across).values()[at] / rest.values()[at] - 1.0;
        assert!((0.04..0.15).contains(&grown), "{grown}");
        // the last where the flow turns round, which hardly answers, and whose sense is that of a small speed put in
        // its place
        let places = [(3, 2, 0.01), (10, 11, 0.01), (17, 6, 0.03), (6, 8, 0.01), (18, 1, 0.03)];
        for (i, to, bound) in places {
            let mut moved = even.parameters();
            moved[i * panels.panels() + to] += 1e-6;
            let moved = of(&even.with_parameters(&moved).unwrap());
            let (mut off, mut whole) = (0.0_f64, 0.0_f64);
            for from in 0..panels.panels() {
                let block = slope.blocks.iter().find(|b| (b.0, b.1) == (from, to));
                for k in 0..azimuths {
                    let at = k * panels.panels() + from;
                    let exact = (moved.values()[at] - rest.values()[at]) / 1e-6;
                    let closed = block.map_or(0.0, |(.., block)| block[(k, i)]);
                    whole = whole.max(exact.abs());
                    off = off.max((exact - closed).abs());
                }
            }
            println!("azimuth {i}, panel {to}: {:.1e} of {whole:.3}", off / whole);
            assert!(off <= bound * whole.max(0.07), "{off} of {whole}");
        }
    }

    /// An inflow that stays as it is.
    #[derive(Debug)]
    struct Held(InducedInflow);

    impl InflowModel for Held {
        fn name(&self) -> &'static str {
            "held"
        }

        fn induced(&self, _: &FlightState, _: &RotorLoading) -> Result<InducedInflow, WakeError> {
            Ok(self.0.clone())
        }
    }

    /// The closed slope of the circulation against differences, the blade answering: without its motion it is far off. Along
    /// the disk it leaves out what the speed does to the lift of the circulation that is there; with no pitch it would be off
    /// by all.
    #[test]
    fn the_slope_of_the_circulation_knows_how_the_blade_answers() {
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default());
        let rotor = Arc::new(rotor.unwrap());
        let solver = RotorSolver::new(rotor, 0.3, ResponseTolerances::default()).unwrap();
        let condition = forward();
        let (azimuths, cutout) = (24, solver.rotor().model().root_cutout);
        let panels = WakeRotor::uniform(4, cutout, 12).unwrap();
        let (count, psi) = (panels.panels(), uniform_azimuths_rad(azimuths));
        let map = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..azimuths * count).map(|at| of(at / count, at % count)).collect()
        };
        let even = InflowMap::new(&panels, map(&|_, _| 0.02)).unwrap();
        let even = InducedInflow::Map(even.with_in_plane(map(&|_, _| 0.0)).unwrap());
        let circulation = |inflow: InducedInflow| {
            let found = solver.clone().solve(&condition, &Held(inflow), None).unwrap();
            DVector::from_column_slice(
                solver.circulation(&found, &panels, azimuths).unwrap().values(),
            )
        };
        let rest = circulation(even.clone());
        let slope = solver.circulation_slope(&condition.controls, &panels, azimuths);
        let still = CirculationSlope { motion: None, ..slope.clone() };
        let r = panels.stations();
        let wave = |i: usize, s: usize, n: f64| r[s] * (n * psi[i]).cos();
        let none = vec![0.0; azimuths * count];
        // once and twice a revolution down through the disk, and along it
        let changes = [
            (map(&|i, s| wave(i, s, 1.0)), none.clone(), 0.16),
            (map(&|i, s| wave(i, s, 2.0)), none.clone(), 0.16),
            (none, map(&|i, s| wave(i, s, 1.0)), 0.7),
        ];
        for (down, along, bound) in changes {
            let step = 1e-4;
            let mut moved = even.parameters();
            for (value, change) in moved.iter_mut().zip(down.iter().chain(&along)) {
                *value += step * change;
            }
            let exact = (circulation(even.with_parameters(&moved).unwrap()) - &rest) / step;
            let felt = down.iter().zip(along.iter().zip(&slope.pitch_rad));
            let felt: Vec<f64> = felt.map(|(down, (along, pitch))| down - pitch * along).collect();
            let off = |slope: &CirculationSlope| {
                let closed = DVector::from_vec(slope.times(&felt, count));
                (closed - &exact).norm() / exact.norm()
            };
            println!("off by {:.3}, blades held by {:.3}", off(&slope), off(&still));
            assert!(off(&slope) < bound && off(&still) > 2.0 * bound);
        }
    }
}
